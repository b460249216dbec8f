//! A chain as a standard Denavit-Hartenberg table.
//!
//! Frame `i` has its z axis on the axis of joint `i + 1` and its x axis on the
//! common normal from the axis before (Denavit and Hartenberg 1955; Paul 1981).
//! Where the convention leaves a choice, the offset `d` is 0, a prismatic axis
//! passes through the frame before it, and the last frame is turned towards the
//! tip's.

use core::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

use super::Chain;
use crate::angle::snapped;
use crate::{Convention, Description, Joint, JointKind, Link, Placement};

/// Axes with a smaller sine between them (rad) are parallel.
const PARALLEL: f64 = 1e-9;

/// Lengths are rounded to this (m): a product of turns by 90 degrees leaves
/// some 1e-16.
const ROUNDED: f64 = 1e12;

/// A frame under construction.
#[derive(Clone, Copy)]
struct Frame {
    origin: Vector3<f64>,
    x: Vector3<f64>,
    z: Vector3<f64>,
}

impl Frame {
    fn isometry(&self) -> Isometry3<f64> {
        let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[self.x, self.z.cross(&self.x), self.z]));
        Isometry3::from_parts(Translation3::from(self.origin), UnitQuaternion::from_rotation_matrix(&turn))
    }
}

impl Chain {
    /// The chain as a description: standard convention, limits and masses kept,
    /// every joint rigid, because a URDF file says nothing of compliances.
    pub fn description(&self) -> Description {
        // Joint frames and axes at zero.
        let mut frame = Isometry3::identity();
        let mut axes: Vec<(Vector3<f64>, Vector3<f64>)> = Vec::new();
        let mut places = Vec::new();
        for joint in &self.joints {
            frame *= joint.before;
            axes.push((frame.translation.vector, frame.rotation * joint.axis.into_inner()));
            places.push(frame);
        }
        let tip = frame * self.end;
        let count = axes.len();

        let mut current = first_frame(axes[0], self.joints[0].kind);
        let base = current.isometry();
        let (mut joints, mut links) = (Vec::new(), Vec::new());
        for (i, joint) in self.joints.iter().enumerate() {
            let next = if i + 1 < count {
                let (point, z) = axes[i + 1];
                let slides = self.joints[i + 1].kind == JointKind::Prismatic;
                // A prismatic axis has a direction only.
                next_frame(&current, if slides { current.origin } else { point }, z)
            } else {
                last_frame(&current, &tip)
            };
            let apart = next.origin - current.origin;
            joints.push(Joint {
                kind: joint.kind,
                theta: angle(turned(&current.x, &next.x, &current.z)),
                d: length(apart.dot(&current.z)),
                a: length(apart.dot(&next.x)),
                alpha: angle(turned(&current.z, &next.z, &next.x)),
                limits: joint.limits,
                compliance: Vec::new(),
            });
            if let Some(&(mass, center)) = self.bodies.get(i) {
                let center = next.isometry().inverse() * places[i] * nalgebra::Point3::from(center);
                links.push(Link { mass, center_of_mass: [center.x, center.y, center.z].map(length) });
            }
            current = next;
        }
        Description {
            name: Description::name_like(&self.robot),
            description: String::new(),
            source: String::new(),
            convention: Convention::Standard,
            base: placement(&base),
            joints,
            tool: placement(&(current.isometry().inverse() * tip)),
            links,
            effects: Vec::new(),
            controller: None,
        }
    }
}

/// Frame 0: on the first axis next to the base's origin, its x axis as near to
/// the base's as can be.
fn first_frame((point, z): (Vector3<f64>, Vector3<f64>), kind: JointKind) -> Frame {
    let origin = match kind {
        JointKind::Revolute => point - z * z.dot(&point),
        JointKind::Prismatic => Vector3::zeros(),
    };
    let flat = |vector: Vector3<f64>| (vector - z * z.dot(&vector)).try_normalize(0.1);
    let x = flat(Vector3::x()).or_else(|| flat(Vector3::y())).unwrap_or_else(Vector3::x);
    Frame { origin, x, z }
}

/// The frame on the next axis, a point and a direction.
fn next_frame(current: &Frame, point: Vector3<f64>, z: Vector3<f64>) -> Frame {
    let apart = point - current.origin;
    let normal = current.z.cross(&z);
    let sine = normal.norm();
    if sine < PARALLEL {
        // Any common normal will do: the one through the frame.
        let across = apart - current.z * current.z.dot(&apart);
        let a = across.norm();
        let x = if a * ROUNDED > 1.0 { across / a } else { current.x };
        return Frame { origin: current.origin + across, x, z };
    }
    let normal = normal / sine;
    let along = apart.cross(&z).dot(&normal) / sine;
    let foot = current.origin + current.z * along;
    let a = (point - foot).dot(&normal);
    // Of the two directions the one along the link; between axes that meet the
    // one that turns less.
    let x = if a.abs() * ROUNDED > 1.0 {
        normal * a.signum()
    } else if within_half_turn(turned(&current.x, &normal, &current.z)) {
        normal
    } else {
        -normal
    };
    Frame { origin: foot + normal * a, x, z }
}

/// Frame n: turned to the tip's as far as a row of the table can.
fn last_frame(current: &Frame, tip: &Isometry3<f64>) -> Frame {
    let tip_z = tip.rotation * Vector3::z();
    let apart = tip.translation.vector - current.origin;
    let origin = current.origin + current.z * current.z.dot(&apart);
    if current.z.cross(&tip_z).norm() < PARALLEL {
        return Frame { origin, x: tip.rotation * Vector3::x(), z: tip_z };
    }
    Frame { origin, ..*current }
}

/// The angle from one vector to another about an axis across both.
fn turned(from: &Vector3<f64>, to: &Vector3<f64>, axis: &Vector3<f64>) -> f64 {
    axis.dot(&from.cross(to)).atan2(from.dot(to))
}

/// Whether an angle is in (-90, 90] degrees, with some slack.
fn within_half_turn(angle: f64) -> bool {
    -FRAC_PI_2 + 1e-6 < angle && angle <= FRAC_PI_2 + 1e-6
}

fn length(value: f64) -> f64 {
    // A negative zero is written as one.
    (value * ROUNDED).round() / ROUNDED + 0.0
}

fn angle(value: f64) -> f64 {
    let value = snapped(value) + 0.0;
    // Either is half a turn.
    if value == -PI { PI } else { value }
}

fn placement(frame: &Isometry3<f64>) -> Placement {
    let turn = frame.rotation.to_rotation_matrix();
    let level = turn[(0, 0)].hypot(turn[(1, 0)]);
    let pitch = (-turn[(2, 0)]).atan2(level);
    let [roll, yaw] = if level < 1e-9 {
        // Pointing up or down, roll and yaw are one turn.
        [(-turn[(1, 2)]).atan2(turn[(1, 1)]), 0.0]
    } else {
        [turn[(2, 1)].atan2(turn[(2, 2)]), turn[(1, 0)].atan2(turn[(0, 0)])]
    };
    let translation = frame.translation.vector;
    Placement { xyz: [translation.x, translation.y, translation.z].map(length), rpy: [roll, pitch, yaw].map(angle) }
}
