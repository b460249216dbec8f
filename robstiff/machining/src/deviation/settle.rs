//! Where arm and cut come to rest.

use nalgebra::{Matrix3, Matrix4, Rotation3, SVector, Vector3, Vector6};

use super::contact::{Contact, Load};
use super::parts::Yielding;
use crate::inverse::Target;
use crate::path::{SolvedPath, lines};
use robstiff::{Robot, State};

/// Arm and cut have settled where a step is below this (m).
const SETTLED: f64 = 1e-12;

/// Steps until they must have.
const MOST_STEPS: usize = 100;

/// Halvings of a step that leads no closer.
const MOST_HALVINGS: usize = 10;

/// Doublings of a brake that does not hold.
const MOST_DOUBLINGS: i32 = 40;

/// Forces change by this share of themselves (and of 1 N) for the slope of the arm.
const CHANGE: f64 = 1e-6;

/// Points at which arm and cut do not settle: the force grows faster with the
/// displacement than the arm resists, or jumps with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PulledIn {
    /// Their lines in the path's file.
    pub lines: Vec<usize>,
}

impl core::fmt::Display for PulledIn {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "arm and cut do not settle: the force grows faster with the displacement than the arm resists, on {}",
            lines(self.lines.iter().copied())
        )
    }
}

impl core::error::Error for PulledIn {}

/// The tool at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stand {
    /// The wrench that acts (N, Nm).
    pub wrench: Vector6<f64>,
    /// The deflection of the arm (m, rad).
    pub deflection: Vector6<f64>,
    /// How far the TCP is from the path (m, rad).
    pub off: Vector6<f64>,
}

/// Where the tool comes to rest when the arm without load stands at `pose` and
/// the path is at `wanted`. `yields` is the deflection under a wrench. `None` where
/// it does not come to rest.
pub(crate) fn settle(
    pose: &Matrix4<f64>,
    wanted: &Matrix4<f64>,
    contact: &Contact,
    yields: impl Fn(&Vector6<f64>) -> Vector6<f64>,
) -> Option<Stand> {
    let aside = translation(pose) - translation(wanted);
    let under = |off: &Vector3<f64>| {
        let force = contact.response * off;
        contact.wrench + Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0)
    };
    let finish = |wrench: Vector6<f64>| {
        let deflection = yields(&wrench);
        let turn = Target::pose(wanted).apart(&turned(pose, &deflection)).1;
        let shift = aside + deflection.fixed_rows::<3>(0);
        Stand { wrench, deflection, off: Vector6::new(shift.x, shift.y, shift.z, -turn.x, -turn.y, -turn.z) }
    };
    if contact.response == Matrix3::zeros() {
        return Some(finish(contact.wrench));
    }
    let unbalanced = |off: &Vector3<f64>| aside + yields(&under(off)).fixed_rows::<3>(0) - off;
    let mut off = aside;
    for _ in 0..MOST_STEPS {
        let rest = unbalanced(&off);
        // The slope under the present load: with backlash an arm is many times
        // softer about none.
        let slope = Matrix3::identity() - compliance(&yields, &under(&off)) * contact.response;
        // Where the force outgrows the arm, Newton's step leads back against the force.
        // The tool goes on with it, and rests where the arm is stiffer: a step of
        // implicit Euler, as long as the slope allows.
        let braked = |brake: f64| slope + Matrix3::identity() * brake;
        let brakes = (0..MOST_DOUBLINGS).map(|k| 0.5 * 2.0_f64.powi(k));
        let brake = core::iter::once(0.0).chain(brakes).find(|brake| stable(&braked(*brake)))?;
        let mut step = braked(2.0 * brake).try_inverse()? * rest;
        if brake == 0.0 {
            if step.norm() < SETTLED {
                return Some(finish(under(&(off + step))));
            }
            // Kinks and bends of the arm make whole steps miss.
            let closer = |step: &Vector3<f64>| unbalanced(&(off + step)).norm() < rest.norm();
            for _ in 0..MOST_HALVINGS {
                if closer(&step) {
                    break;
                }
                step *= 0.5;
            }
        }
        off += step;
    }
    None
}

/// Whether a tool that is pushed aside comes back: all eigenvalues of what it meets,
/// the share that the force does not take over, have positive real parts (Hurwitz).
fn stable(slope: &Matrix3<f64>) -> bool {
    let (trace, determinant) = (slope.trace(), slope.determinant());
    let minors = (trace * trace - (slope * slope).trace()) / 2.0;
    trace > 0.0 && determinant > 0.0 && trace * minors > determinant
}

/// How the deflection grows with the force about a wrench (m/N), by central
/// differences.
fn compliance(yields: &impl Fn(&Vector6<f64>) -> Vector6<f64>, wrench: &Vector6<f64>) -> Matrix3<f64> {
    let change = CHANGE * (1.0 + wrench.fixed_rows::<3>(0).norm());
    let column = |axis: usize| {
        let by = Vector6::ith(axis, change);
        ((yields(&(wrench + by)) - yields(&(wrench - by))) / (2.0 * change)).fixed_rows::<3>(0).into_owned()
    };
    Matrix3::from_columns(&[0, 1, 2].map(column))
}

/// What is of interest where the tool comes to rest, at every point of a path under load, the arm commanded
/// to other postures or the path's own: for each of the arms whose joints and then effects (in the order of
/// [`parts`](super::parts())) are softer by factors. Joints with hysteresis follow the loads in the order of the path.
pub(crate) fn displaced<const N: usize, T>(
    robot: &impl Robot<N>,
    arms: &[Vec<f64>],
    commanded: impl Iterator<Item = SVector<f64, N>>,
    path: &SolvedPath<N>,
    load: &Load,
    of: impl Fn(&Stand) -> T,
) -> Result<Vec<Vec<T>>, PulledIn> {
    assert_eq!(load.contacts.len(), path.points.len(), "a contact for every point of the path");
    let mut before = vec![State::<N>::new(); arms.len()];
    let mut found: Vec<Vec<T>> = arms.iter().map(|_| Vec::with_capacity(path.points.len())).collect();
    let mut lines = Vec::new();
    for ((q, point), contact) in commanded.zip(&path.points).zip(&load.contacts) {
        let (pose, yielding) = (robot.transform(&q), Yielding::of(robot, &q));
        let mut settles = true;
        for ((factors, state), found) in arms.iter().zip(&mut before).zip(&mut found) {
            let arm = yielding.softened(factors);
            match settle(&pose, &point.pose, contact, |wrench| arm.deflection(wrench, &mut state.clone())) {
                Some(stand) => {
                    arm.deflection(&stand.wrench, state);
                    found.push(of(&stand));
                }
                None => settles = false,
            }
        }
        if !settles {
            lines.push(point.line);
        }
    }
    if lines.is_empty() { Ok(found) } else { Err(PulledIn { lines }) }
}

/// A pose of the TCP moved by a displacement in the base frame (m, rad).
pub(crate) fn turned(pose: &Matrix4<f64>, displacement: &Vector6<f64>) -> Matrix4<f64> {
    let turn = Rotation3::new(displacement.fixed_rows::<3>(3).into_owned());
    let mut moved = *pose;
    let rotation = turn.matrix() * pose.fixed_view::<3, 3>(0, 0);
    moved.fixed_view_mut::<3, 3>(0, 0).copy_from(&rotation);
    let position = translation(pose) + displacement.fixed_rows::<3>(0);
    moved.fixed_view_mut::<3, 1>(0, 3).copy_from(&position);
    moved
}

fn translation(pose: &Matrix4<f64>) -> Vector3<f64> {
    pose.fixed_view::<3, 1>(0, 3).into_owned()
}
