//! Displacements under forces.

use std::vec::Vec;

use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;
use robstiff_robots::quantity::finite;

use super::draw::{PACE, Stream, names, stream};
use super::{Pull, Scenario, UnderForces};
use crate::campaign::{AXES, Displacements, Observation as Row};
use crate::observe::displacement::Displacement;
use crate::observe::encoders::Encoders;
use crate::observe::{Observation, as_declared};
use crate::probability::normal;

/// The displacements of a scenario at some poses, with noise.
pub fn measured(truth: &Description, scenario: &Scenario, under: &UnderForces, poses: &[Vec<f64>]) -> Displacements {
    let mut data = loads(scenario, under, poses);
    deflect(truth, under, &mut data);
    add_noise(scenario, under, &mut data);
    add_encoder_noise(scenario, under, &mut data);
    data
}

/// Whether a campaign may have all numbers of a row.
pub fn is_readable(row: &Row) -> bool {
    let read = row.displacement.iter().chain(row.rotation.iter().flatten()).chain(row.encoders.iter().flatten());
    row.wrench.iter().chain(&row.q).chain(read).all(|value| finite(*value).is_ok())
}

/// The rows, with nothing read yet.
fn loads(scenario: &Scenario, under: &UnderForces, poses: &[Vec<f64>]) -> Displacements {
    let mut random = stream(scenario, Stream::Loads);
    let mut rows = Vec::with_capacity(poses.len() * scenario.visits * under.ramp.len());
    for (pose, q) in poses.iter().enumerate() {
        for of_pose in 0..scenario.visits {
            let visit = pose * scenario.visits + of_pose;
            let force = greatest(&under.force, visit, &mut random);
            let moment = under.moment.as_ref().map_or_else(Vector3::zeros, |pull| greatest(pull, visit, &mut random));
            for share in &under.ramp {
                let (force, moment) = (force * *share, moment * *share);
                // What is read unloaded before every load is loaded anew with each.
                let visit = if under.shares_unloaded { visit } else { rows.len() };
                rows.push(Row {
                    line: rows.len() + 2,
                    pose,
                    visit,
                    time: Some(PACE * (rows.len() + 1) as f64),
                    temperature: None,
                    q: q.clone(),
                    wrench: [force.x, force.y, force.z, moment.x, moment.y, moment.z],
                    displacement: [0.0; 3],
                    encoders: None,
                    motors: None,
                    rotation: under.rotation_noise.map(|_| [0.0; 3]),
                });
            }
        }
    }
    let [wrench_frame, measured_frame] = under.frames;
    Displacements {
        wrench_frame,
        wrench_at: scenario.wrench_at,
        measured_frame,
        measured_at: scenario.measured_at,
        directions: AXES.to_vec(),
        poses: names(poses.len()),
        visits: names(if under.shares_unloaded { poses.len() * scenario.visits } else { rows.len() }),
        rows,
    }
}

/// The greatest force or moment of a visit.
fn greatest(pull: &Pull, visit: usize, random: &mut ChaCha8Rng) -> Vector3<f64> {
    // Drawn even where it is listed, so that the sizes stay the same.
    let drawn = Vector3::from_fn(|_, _| normal(random));
    let direction = match pull.directions.as_slice() {
        [] => drawn,
        listed => Vector3::from(listed[visit % listed.len()]),
    };
    unit(direction) * random.random_range(pull.bounds[0]..=pull.bounds[1])
}

/// The direction of a vector of any length: as long as a scenario may have them,
/// squares of components are no numbers or nothing.
fn unit(vector: Vector3<f64>) -> Vector3<f64> {
    let size = vector.amax();
    if (1e-100..1e100).contains(&size) { vector.normalize() } else { (vector / size).normalize() }
}

/// Sets what an exact instrument reads in every row. The rows of a visit are one load sequence, on a robot
/// that was never loaded.
fn deflect(truth: &Description, under: &UnderForces, data: &mut Displacements) {
    let encoders = match under.encoder_noise {
        Some(_) => Encoders::of_all(truth.joints.len(), data.rows.len()),
        None => Encoders::default(),
    };
    let (read, width) = {
        let observation = Displacement::reading(truth, data, encoders);
        (as_declared(&observation, observation.world(), truth), observation.readings().width)
    };
    for (row, read) in data.rows.iter_mut().zip(read.as_slice().chunks(width)) {
        row.displacement = core::array::from_fn(|k| read[k]);
        row.rotation = row.rotation.map(|_| core::array::from_fn(|k| read[3 + k]));
        row.encoders = under.encoder_noise.is_some().then(|| {
            let turns = &read[width - row.q.len()..];
            row.q.iter().zip(turns).map(|(q, turn)| q + turn).collect()
        });
    }
}

/// Adds the noise of the loaded reading, and takes that of the visit's unloaded one
/// away.
fn add_noise(scenario: &Scenario, under: &UnderForces, data: &mut Displacements) {
    let mut random = stream(scenario, Stream::Noise);
    let turn = under.rotation_noise.unwrap_or(0.0);
    let [x, y, z] = scenario.noise;
    // Six draws a reading whatever is measured: rotations leave the rest as is.
    let mut reading = || [x, y, z, turn, turn, turn].map(|sigma| sigma * normal(&mut random));
    let (mut unloaded, mut visit) = ([0.0; 6], None);
    for row in &mut data.rows {
        if visit != Some(row.visit) {
            unloaded = reading();
            visit = Some(row.visit);
        }
        let loaded = reading();
        let read = row.displacement.iter_mut().chain(row.rotation.iter_mut().flatten());
        for ((value, loaded), unloaded) in read.zip(loaded).zip(unloaded) {
            *value += loaded - unloaded;
        }
    }
}

/// Adds the noise of the encoders.
fn add_encoder_noise(scenario: &Scenario, under: &UnderForces, data: &mut Displacements) {
    let mut random = stream(scenario, Stream::Encoders);
    let sigmas = under.encoder_noise.iter().flatten();
    for row in &mut data.rows {
        for (angle, sigma) in row.encoders.iter_mut().flatten().zip(sigmas.clone()) {
            *angle += sigma * normal(&mut random);
        }
    }
}
