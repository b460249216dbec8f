//! The arm sags under its own weight: every joint stands aside by `h_i g_i(q)`
//! of where its encoder says, which same-pose differences show only through
//! `d(H F)/dq`. `g_i` is the torque of the links' masses; `share` is how much
//! of it the controller does not correct.

use std::sync::Arc;
use std::vec;
use std::vec::Vec;

use nalgebra::{DVector, Vector3};
use robstiff_robots::{Convention, Link};

use super::{Form, Kind, Number, Offers, Place, Scene};
use crate::JointKind;
use crate::identify::samples::{Sample, Samples};
use crate::identify::setup::{Setup, coordinate_entry};
use crate::trace::point::Point;

/// The kind.
pub static KIND: Kind = Kind {
    name: "gravity_sag",
    of_rig: false,
    words: |_| "the sag of the robot under its own weight".into(),
    explanation: "The links weigh on the joints, so the arm hangs below where its encoders say. A controller that \
        knows the masses corrects it; measurements from the encoders alone cannot show it.",
    offer,
    on_axes: None,
};

/// Standard gravity (m/s^2), along -z of the base frame.
const GRAVITY: f64 = 9.80665;

/// More of the sag than all of it twice over is something else.
const MOST: f64 = 2.0;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    if scene.description.links.iter().all(|link| link.mass == 0.0) {
        // Without masses nothing is known of the torques.
        return offers.invisible(Place::Robot);
    }
    let of_row = |row: &Sample| -> Vec<f64> {
        let frames = link_frames(scene.description.convention, scene.samples, row);
        let torque = |joint| torque(scene.samples, row, &frames, &scene.description.links, joint);
        (1..=scene.joints()).map(|joint| scene.compliance[joint - 1] * torque(joint)).collect()
    };
    let sag: Arc<Vec<Vec<f64>>> = Arc::new(scene.samples.rows.iter().map(of_row).collect());
    let enters = {
        let sag = Arc::clone(&sag);
        move |setup: &mut Setup, share: f64| {
            let before = setup.sag.as_ref().map_or(0.0, |(share, _)| *share);
            setup.sag = Some((before + share, Arc::clone(&sag)));
        }
    };
    let of = move |point: &Point<'_>| {
        let length = point.samples.rows.len() * point.samples.axes;
        (1..=point.samples.joints()).fold(DVector::zeros(length), |sum, joint| {
            let entry = coordinate_entry(point.samples.joint_kinds[joint - 1]);
            sum + point.slope(joint, entry, |row| sag[row][joint - 1])
        })
    };
    let number = Number::of_setup("share", "1", MOST, enters, move |point, _| of(point));
    let number = Number { range: [0.0, MOST], ..number };
    offers.add(Place::Robot, vec![number], vec![Form::of([0])]);
}

/// The frames 1 to n that masses are given in.
fn link_frames(convention: Convention, samples: &Samples, row: &Sample) -> Vec<nalgebra::Matrix4<f64>> {
    match convention {
        Convention::Modified => row.joint_frames.to_vec(),
        Convention::Standard => row.joint_frames[1..samples.joints()].iter().copied().chain([row.flange]).collect(),
    }
}

/// The torque of the weights behind a joint (from 1) about it.
fn torque(samples: &Samples, row: &Sample, frames: &[nalgebra::Matrix4<f64>], links: &[Link], joint: usize) -> f64 {
    let frame = &row.joint_frames[joint - 1];
    let axis: Vector3<f64> = frame.fixed_view::<3, 1>(0, 2).into_owned();
    let through: Vector3<f64> = frame.fixed_view::<3, 1>(0, 3).into_owned();
    let of_link = |(link, frame): (&Link, &nalgebra::Matrix4<f64>)| {
        let centre = frame.transform_point(&Vector3::from(link.center_of_mass).into()).coords;
        let weight = Vector3::new(0.0, 0.0, -GRAVITY * link.mass);
        match samples.joint_kinds[joint - 1] {
            JointKind::Revolute => axis.dot(&(centre - through).cross(&weight)),
            JointKind::Prismatic => axis.dot(&weight),
        }
    };
    links.iter().zip(frames).skip(joint - 1).map(of_link).sum()
}
