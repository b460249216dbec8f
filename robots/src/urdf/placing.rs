//! Where the joints of a chain go so that it moves as a description does.
//!
//! A joint's frame lies on its axis; how it is turned about the axis, and where on it, makes no
//! difference to the motion. It does to what is drawn: meshes are given in that frame. So each
//! link is taken along by the link before it, tilted by the least turn onto the description's
//! axis, and, since a zero offset turns the link itself, turned about that axis until the next
//! axis is where the link has it, as near as can be. Along the axis of a joint that turns
//! nothing is shifted: a length displaces what is behind it. Behind a joint that slides it is
//! the other way round.

use core::f64::consts::{PI, TAU};

use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};

use super::read::exact_turn;
use crate::{Convention, Description, JointKind, Placement};

/// An axis in the base frame, at zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub kind: JointKind,
    /// A point on it (m); of a joint that slides any point.
    pub point: Vector3<f64>,
    /// Its direction, of length 1.
    pub direction: Vector3<f64>,
}

/// A chain at zero, in the base frame: axes and tip.
#[derive(Clone, Debug)]
pub(super) struct Posture {
    pub axes: Vec<Axis>,
    pub tip: Isometry3<f64>,
}

impl Posture {
    /// A description's, with its table as the effects correct it.
    pub(super) fn of(robot: &Description) -> Self {
        let turn = |rpy: [f64; 3]| UnitQuaternion::from_rotation_matrix(&exact(rpy));
        let step = |xyz: [f64; 3], rpy| Isometry3::from_parts(Translation3::from(Vector3::from(xyz)), turn(rpy));
        let placed = |at: &Placement| step(at.xyz, at.rpy);
        let mut frame = placed(&robot.base);
        let mut axes = Vec::new();
        for joint in robot.corrected_joints() {
            let along = step([0.0, 0.0, joint.d], [0.0, 0.0, joint.theta]);
            let across = step([joint.a, 0.0, 0.0], [joint.alpha, 0.0, 0.0]);
            if robot.convention == Convention::Modified {
                frame *= across;
            }
            let (point, direction) = (frame.translation.vector, frame.rotation * Vector3::z());
            axes.push(Axis { kind: joint.kind, point, direction });
            frame *= along;
            if robot.convention == Convention::Standard {
                frame *= across;
            }
        }
        Self { axes, tip: frame * placed(&robot.tool) }
    }
}

fn exact([roll, pitch, yaw]: [f64; 3]) -> Rotation3<f64> {
    Rotation3::from_matrix_unchecked(exact_turn(roll, pitch, yaw))
}

/// How each link moves, in the base frame at zero.
///
/// Between `from` and `to` only axes and tip count. The motion of the last link is the tip's
/// where `is_rigid`: nothing behind it could take up the rest.
pub(super) fn motions(from: &Posture, to: &Posture, is_rigid: bool) -> Vec<Isometry3<f64>> {
    let length = longest(from);
    let last = from.axes.len() - 1;
    let mut before = Isometry3::identity();
    let mut motions = Vec::new();
    for (index, (old, new)) in from.axes.iter().zip(&to.axes).enumerate() {
        if is_rigid && index == last {
            motions.push(to.tip * from.tip.inverse());
            break;
        }
        let point = before * nalgebra::Point3::from(old.point);
        let turned = least_turn(&(before.rotation * old.direction), &new.direction);
        let foot = match old.kind {
            JointKind::Revolute => new.point + new.direction * new.direction.dot(&(point.coords - new.point)),
            JointKind::Prismatic => point.coords,
        };
        let carried = Translation3::from(foot) * turned * Translation3::from(-point.coords) * before;
        let marks = (index + 1..=last + 1).map(|next| Mark::of(from, to, next));
        let motion = |q: f64| match old.kind {
            JointKind::Revolute => about(foot, &new.direction, q) * carried,
            JointKind::Prismatic => Translation3::from(new.direction * q) * carried,
        };
        let best = match old.kind {
            JointKind::Revolute => {
                marks.into_iter().find_map(|mark| best_turn(|q| mark.apart(&motion(q), length), length))
            }
            JointKind::Prismatic => marks.into_iter().find_map(|mark| best_shift(|q| mark.apart(&motion(q), length))),
        };
        before = motion(best.unwrap_or(0.0));
        motions.push(before);
    }
    motions
}

/// The least turn from one direction to another; to the opposite one about any axis across.
fn least_turn(from: &Vector3<f64>, to: &Vector3<f64>) -> UnitQuaternion<f64> {
    let axis = from.cross(to);
    let angle = axis.norm().atan2(from.dot(to));
    match axis.try_normalize(0.0) {
        Some(axis) => UnitQuaternion::new(axis * angle),
        None if angle == 0.0 => UnitQuaternion::identity(),
        None => UnitQuaternion::new(from.cross(&Vector3::ith(from.iamin(), 1.0)).normalize() * angle),
    }
}

fn about(point: Vector3<f64>, direction: &Vector3<f64>, angle: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::new(direction * angle);
    Isometry3::from_parts(Translation3::from(point - turn * point), turn)
}

/// The longest way from one joint to the next, or to the tip (m): with it angles are weighed
/// against lengths.
fn longest(posture: &Posture) -> f64 {
    let points = posture.axes.iter().map(|axis| axis.point).chain([posture.tip.translation.vector]);
    let points: Vec<Vector3<f64>> = points.collect();
    let longest = points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).fold(0.0, f64::max);
    if longest > 0.0 { longest } else { 1.0 }
}

/// What a link is placed by: an axis or the tip behind it, as the link has it and where it is to be.
enum Mark {
    Axis(Axis, Axis),
    Tip(Isometry3<f64>, Isometry3<f64>),
}

impl Mark {
    fn of(from: &Posture, to: &Posture, index: usize) -> Self {
        match (from.axes.get(index), to.axes.get(index)) {
            (Some(&old), Some(&new)) => Self::Axis(old, new),
            _ => Self::Tip(from.tip, to.tip),
        }
    }

    /// How far a motion leaves it from its place (m^2), with directions at a length (m).
    fn apart(&self, motion: &Isometry3<f64>, length: f64) -> f64 {
        match self {
            Self::Axis(old, new) => {
                let off = motion * nalgebra::Point3::from(old.point) - nalgebra::Point3::from(new.point);
                let across = match old.kind {
                    JointKind::Revolute => off - new.direction * new.direction.dot(&off),
                    JointKind::Prismatic => Vector3::zeros(),
                };
                across.norm_squared()
                    + (motion.rotation * old.direction - new.direction).norm_squared() * length * length
            }
            Self::Tip(old, new) => {
                let reached = motion * old;
                let turned =
                    reached.rotation.to_rotation_matrix().matrix() - new.rotation.to_rotation_matrix().matrix();
                let off = reached.translation.vector - new.translation.vector;
                off.norm_squared() + turned.norm_squared() * length * length / 2.0
            }
        }
    }
}

/// An arm of less than this part of the longest link determines no turn: a small error of the
/// table would be a large one of the angle.
const SHORT: f64 = 0.1;

/// The turn (rad) with the least of a sum of squares that is a trigonometric polynomial of the
/// second degree; nothing where it hardly depends on the turn.
fn best_turn(apart: impl Fn(f64) -> f64, length: f64) -> Option<f64> {
    // As many samples as determine it, and some more.
    const SAMPLES: usize = 8;
    let angle = |index: usize, count: usize| TAU * index as f64 / count as f64;
    let samples: [f64; SAMPLES] = core::array::from_fn(|index| apart(angle(index, SAMPLES)));
    let part = |order: f64, function: fn(f64) -> f64| {
        let term = |(index, value): (usize, &f64)| value * function(order * angle(index, SAMPLES));
        samples.iter().enumerate().map(term).sum::<f64>() * 2.0 / SAMPLES as f64
    };
    let [(c1, s1), (c2, s2)] = [1.0, 2.0].map(|order| (part(order, f64::cos), part(order, f64::sin)));
    let value = |q: f64| c1 * q.cos() + s1 * q.sin() + c2 * (2.0 * q).cos() + s2 * (2.0 * q).sin();
    const STEPS: usize = 720;
    let values = (0..STEPS).map(|index| value(angle(index, STEPS)));
    let (mut best, mut least, mut most) = (0.0, value(0.0), value(0.0));
    for (index, value) in values.enumerate() {
        if value < least {
            (best, least) = (angle(index, STEPS), value);
        }
        most = most.max(value);
    }
    if most - least < 4.0 * (SHORT * length).powi(2) {
        return None;
    }
    for _ in 0..20 {
        let slope = -c1 * best.sin() + s1 * best.cos() - 2.0 * c2 * (2.0 * best).sin() + 2.0 * s2 * (2.0 * best).cos();
        let bend = -c1 * best.cos() - s1 * best.sin() - 4.0 * c2 * (2.0 * best).cos() - 4.0 * s2 * (2.0 * best).sin();
        if bend <= 0.0 {
            break;
        }
        best -= (slope / bend).clamp(-0.01, 0.01);
    }
    Some(if best > PI { best - TAU } else { best })
}

/// The shift (m) with the least of a sum of squares; nothing where it hardly depends on it.
fn best_shift(apart: impl Fn(f64) -> f64) -> Option<f64> {
    let [before, here, behind] = [-1.0, 0.0, 1.0].map(apart);
    let bend = (before + behind) / 2.0 - here;
    (bend > SHORT * SHORT).then(|| (before - behind) / 4.0 / bend)
}
