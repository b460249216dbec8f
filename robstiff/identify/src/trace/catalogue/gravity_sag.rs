//! The arm sags under its own weight: every joint stands aside by `h_i g_i(q)`
//! of where its encoder says, which same-pose differences show only through
//! `d(H F)/dq`. `g_i` is the torque of the links' masses; `share` is how much
//! of it the controller does not correct.

use std::sync::Arc;
use std::vec;
use std::vec::Vec;

use nalgebra::{DVector, Matrix4, Point3};
use robstiff_robots::effect::gravity_sag::GRAVITY;
use robstiff_robots::{Convention, Link, Place as Part};

use super::{Form, Kind, Number, Offers, Scene};
use crate::identify::samples::{Sample, Samples};
use crate::identify::setup::{Setup, coordinate_entry};
use crate::trace::point::Point;
use robstiff::elements::own_weight_torque;

/// The kind.
pub static KIND: Kind = Kind {
    name: "gravity_sag",
    of_rig: false,
    words: |_| "the sag of the robot under its own weight".into(),
    explanation: "",
    offer,
    on_axes: None,
};

/// More of the sag than all of it twice over is something else.
pub const MOST: f64 = 2.0;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    if scene.description.links.iter().all(|link| link.mass == 0.0) {
        // Without masses nothing is known of the torques.
        return offers.invisible(Part::Robot);
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
        let length = point.samples.length();
        (1..=point.samples.joints()).fold(DVector::zeros(length), |sum, joint| {
            let entry = coordinate_entry(point.samples.joint_kinds[joint - 1]);
            sum + point.slope(joint, entry, |row| sag[row][joint - 1])
        })
    };
    let number = Number::of_setup("share", "1", MOST, enters, move |point, _| of(point));
    let number = Number { range: [0.0, MOST], ..number };
    offers.add(Part::Robot, vec![number], vec![Form::of([0])]);
}

/// The frames 1 to n that masses are given in.
fn link_frames(convention: Convention, samples: &Samples, row: &Sample) -> Vec<Matrix4<f64>> {
    match convention {
        Convention::Modified => row.joint_frames.to_vec(),
        Convention::Standard => row.joint_frames[1..samples.joints()].iter().copied().chain([row.flange]).collect(),
    }
}

/// The torque of the weights behind a joint (from 1) about it.
fn torque(samples: &Samples, row: &Sample, frames: &[Matrix4<f64>], links: &[Link], joint: usize) -> f64 {
    let (mut weight, mut moment) = (0.0, [0.0; 2]);
    for (link, frame) in links.iter().zip(frames).skip(joint - 1) {
        let centre = frame.transform_point(&Point3::from(link.center_of_mass));
        weight += GRAVITY * link.mass;
        moment = [0, 1].map(|k| moment[k] + GRAVITY * link.mass * centre[k]);
    }
    own_weight_torque(samples.joint_kinds[joint - 1], &row.joint_frames[joint - 1], weight, moment)
}
