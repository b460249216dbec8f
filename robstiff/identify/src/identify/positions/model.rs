//! Where a description says that the point is which is read.

use std::vec::Vec;

use nalgebra::{Matrix4, SVector, Vector3, Vector6};
use robstiff_robots::Description;
use robstiff_robots::effect::gravity_sag::GRAVITY;

use crate::campaign::{PositionRow, Positions};
use robstiff::elements::deformed;
use robstiff::{Robot, with_robot};

/// A model of absolute positions.
#[derive(Clone, Debug)]
pub struct Model {
    /// The robot.
    pub description: Description,
    /// The point that is read, in the tool frame (m).
    pub marker: Vector3<f64>,
    /// Where the payload hangs, in the tool frame (m).
    pub hook: Vector3<f64>,
}

impl Model {
    /// A description as it is, and the points as the campaign says.
    pub fn new(description: &Description, data: &Positions) -> Self {
        Self { description: description.clone(), marker: data.measured_at.into(), hook: data.payload_at.into() }
    }

    /// The point at each row, in the base frame (m). The payload's weight, against z
    /// of the base frame, takes it where the arm carries it ([`deformed`]); the arm's
    /// own weight does so where the description says so (`gravity_sag`).
    pub fn points(&self, data: &Positions) -> Vec<Vector3<f64>> {
        with_robot!(&self.description, |robot| self.points_on(&robot, data))
    }

    fn points_on<const N: usize>(&self, robot: &impl Robot<N>, data: &Positions) -> Vec<Vector3<f64>> {
        let point = |row: &PositionRow| {
            let q = SVector::from_column_slice(&row.q);
            let tcp = match row.payload {
                0.0 => robot.transform(&q),
                _ => deformed(robot, &q, |tcp| self.weight(tcp, row), &mut robstiff::State::new()).tcp,
            };
            tcp.transform_point(&self.marker.into()).coords
        };
        data.rows.iter().map(point).collect()
    }

    /// The wrench of a payload at the TCP, in the base frame (N, Nm).
    fn weight(&self, tcp: &Matrix4<f64>, row: &PositionRow) -> Vector6<f64> {
        let force = Vector3::new(0.0, 0.0, -GRAVITY * row.payload);
        let moment = (tcp.fixed_view::<3, 3>(0, 0) * self.hook).cross(&force);
        Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
    }
}
