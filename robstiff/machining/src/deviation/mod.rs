//! How far forces push the tool off its path, and what that does to the part.
//!
//! A [`Load`] says what acts on the tool at every point of a
//! [`SolvedPath`]: the force of a cut, turned by feed and
//! tool axis, or wrenches from a file. [`Deviation::of`] is where the tool is then;
//! [`Deviation::stretches`] says where a tolerance holds, [`blame()`] which joints and
//! effects the error comes from.
//!
//! # The error of the surface
//! What counts for the part is the displacement across the machined surface, along
//! the unit vector that points *into* the part: positive where the tool cuts too
//! deep, negative where it leaves material.
//! - [`Surface::Side`], a wall cut by the circumference: along `normal = feed x
//!   axis` where the wall is left of the tool (up milling), against it where it is
//!   right (down milling). A slot and a force from a file count along the normal.
//! - [`Surface::Face`], a floor cut by the tip: along the axis of the tool, from
//!   the spindle to the tip.
//!
//! # The force depends on the error
//! A tool that is pushed off a wall cuts a thinner slice and meets less force. The
//! force of a [`Cut`](crate::milling::Cut) follows the displacement with the slope
//! that the mechanistic model has against width and depth; tool and arm settle where
//! both agree. Forces from files stay as they are.
//!
//! All of it is static: the mean force, or with [`Load::with_revolution`] each force
//! of a revolution as if it stayed. An arm does not follow the teeth at high speed,
//! so that the latter is a bound, not a forecast.

mod blame;
mod contact;
#[cfg(test)]
mod engaged_tests;
mod load;
mod parts;
#[cfg(test)]
mod rapids_tests;
mod removal;
mod settle;
mod stretches;
mod table;
#[cfg(test)]
pub(crate) mod tests;

use nalgebra::{Vector3, Vector6};

use crate::path::SolvedPath;
use robstiff::{Robot, State};

pub use blame::blame;
pub use contact::{Contact, Load, Revolutions, Surface};
pub use load::{Operation, load_at_feeds, load_of_cut};
pub(crate) use parts::Yielding;
pub use parts::parts;
pub use removal::{removal_rate, width};
pub use settle::PulledIn;
pub(crate) use settle::{Stand, displaced, settle, turned};
pub use stretches::{Stretch, Summary};
pub use table::ForceTable;

/// Where the tool is under load, point by point.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// In the order of the path.
    pub points: Vec<DeviationPoint>,
}

/// Where the tool is under load at one point of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviationPoint {
    /// The line of the path's file, from 1.
    pub line: usize,
    /// The arc length (m).
    pub s: f64,
    /// The length of the path that it stands for (m), by which it counts in averages.
    pub length: f64,
    /// The wrench that acts, in the base frame (N, Nm).
    pub wrench: Vector6<f64>,
    /// How far the TCP is from the path, in the base frame (m, rad).
    pub displacement: Vector6<f64>,
    /// The same along feed, normal and axis (m), where there is a feed.
    pub components: Option<Vector3<f64>>,
    /// The same across the machined surface, into the part (m): the error of the
    /// surface, where there is one.
    pub error: Option<f64>,
    /// The error that is largest, either way, among the forces of a revolution (m);
    /// none where there is no force.
    pub peak: Option<f64>,
}

impl DeviationPoint {
    /// The distance of the TCP from the path (m).
    pub fn distance(&self) -> f64 {
        self.displacement.fixed_rows::<3>(0).norm()
    }

    /// Whether anything pushes the tool: not on the way to the cut, out of it and
    /// between cuts.
    pub fn in_cut(&self) -> bool {
        self.wrench != Vector6::zeros()
    }

    /// The error that a tolerance is compared with (m): the peak where it is known.
    /// None out of the cut: an arm with hysteresis is off there too, but no surface is
    /// made.
    pub fn judged(&self) -> Option<f64> {
        self.peak.or(self.error).filter(|_| self.in_cut())
    }
}

impl Deviation {
    /// The displacement along a path, the arm commanded as the path says. Joints
    /// with hysteresis follow the loads in the order of the path.
    ///
    /// # Errors
    /// The points at which arm and cut do not settle.
    ///
    /// # Panics
    /// If the load has another number of points than the path.
    pub fn of<const N: usize>(robot: &impl Robot<N>, path: &SolvedPath<N>, load: &Load) -> Result<Self, PulledIn> {
        let arm = vec![1.0; N + robot.effects().len()];
        let stands = displaced(robot, &[arm], path.points.iter().map(|point| point.q), path, load, |stand| *stand)?;
        let stands = stands.into_iter().flatten();
        let each = path.points.iter().zip(path.lengths()).zip(&load.contacts).zip(stands).enumerate();
        let points = each.map(|(i, (((point, length), contact), stand))| {
            let shift = stand.off.fixed_rows::<3>(0).into_owned();
            let error = contact.into.map(|into| into.dot(&shift));
            DeviationPoint {
                line: point.line,
                s: point.s,
                length,
                wrench: stand.wrench,
                displacement: stand.off,
                components: contact.frame.map(|frame| frame.components(&shift)),
                error,
                peak: error.and_then(|mean| peak(robot, &point.q, contact, mean, &load.revolution(i))),
            }
        });
        Ok(Self { points: points.collect() })
    }
}

/// The largest error under the forces of a revolution, each as if it stayed: what it moves
/// an arm by that was never loaded, less what the mean force does, beyond the error under
/// that, where arm and cut have settled.
fn peak<const N: usize>(
    robot: &impl Robot<N>,
    q: &nalgebra::SVector<f64, N>,
    contact: &Contact,
    mean: f64,
    revolution: &[Vector3<f64>],
) -> Option<f64> {
    // The forces of a revolution have no direction where their mean has none.
    let into = contact.into.filter(|_| contact.wrench != Vector6::zeros())?;
    if revolution.is_empty() {
        return None;
    }
    let arm = Yielding::of(robot, q).as_described();
    let under = |wrench: &Vector6<f64>| into.dot(&arm.deflection(wrench, &mut State::<N>::new()).fixed_rows::<3>(0));
    let under_mean = under(&contact.wrench);
    let error = |force: &Vector3<f64>| {
        let force = contact.turn * force;
        mean + (under(&Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0)) - under_mean)
    };
    revolution.iter().map(error).max_by(|one, other| one.abs().total_cmp(&other.abs()))
}
