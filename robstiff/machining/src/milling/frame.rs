//! The directions of a cut in another frame.

use nalgebra::{Matrix3, Vector3, Vector6};

/// The three unit vectors along which a cut has its forces, in the robot's base
/// frame (or any other that they are given in).
///
/// `feed`, `normal = feed x axis` and `axis` are perpendicular to each other and
/// in this order left-handed, as in Altintas' formulas, where the axial force is
/// positive out of the holder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutFrame {
    /// Where the tool moves relative to the workpiece.
    pub feed: Vector3<f64>,
    /// To the left of the feed, looked at from the spindle.
    pub normal: Vector3<f64>,
    /// From the spindle to the tip of the tool.
    pub axis: Vector3<f64>,
}

/// What the sine of the angle between feed and axis must exceed to have a
/// direction across: half a degree. What is less in a path that plunges is rounding.
const ACROSS: f64 = 0.01;

impl CutFrame {
    /// The frame of a tool axis (from the spindle to the tip) and a feed, of any
    /// length. Of a feed that is not perpendicular to the axis, the part that is
    /// counts; `None` where there is none, or less than half a degree of it: a tool
    /// that plunges, or a vector of zero length.
    pub fn new(axis: &Vector3<f64>, feed: &Vector3<f64>) -> Option<Self> {
        let axis = axis.try_normalize(0.0)?;
        let feed = feed.try_normalize(0.0)?;
        let across = feed - axis * axis.dot(&feed);
        let feed = across.try_normalize(ACROSS)?;
        Some(Self { feed, normal: feed.cross(&axis), axis })
    }

    /// A force with components along feed, normal and axis, in the frame that
    /// this one is given in (N).
    pub fn force(&self, force: &Vector3<f64>) -> Vector3<f64> {
        self.matrix() * force
    }

    /// The same as a wrench `[f; m]` at the tip of the tool (N, Nm): where the
    /// tip is the TCP, the wrench that [`Robot`](robstiff::Robot) takes. The moment
    /// is zero; that the force acts half the depth above the tip and the spindle's
    /// own torque are left out.
    pub fn wrench(&self, force: &Vector3<f64>) -> Vector6<f64> {
        let force = self.force(force);
        Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0)
    }

    /// The components along feed, normal and axis of a force in the frame that
    /// this one is given in (N).
    pub fn components(&self, force: &Vector3<f64>) -> Vector3<f64> {
        self.matrix().transpose() * force
    }

    /// The three vectors as columns; orthogonal, with determinant -1.
    pub fn matrix(&self) -> Matrix3<f64> {
        Matrix3::from_columns(&[self.feed, self.normal, self.axis])
    }
}
