//! Everything random of a scenario, each from a stream of its own.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{SVector, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;

use super::{Poses, Pull, Scenario};
use crate::Robot;
use crate::campaign::{Displacements, Observation};
use crate::identify::Error;

/// The streams of a seed.
#[derive(Clone, Copy)]
enum Stream {
    Poses,
    Loads,
    Noise,
    Scatter,
    Encoders,
}

fn stream(scenario: &Scenario, stream: Stream) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(scenario.seed);
    random.set_stream(stream as u64);
    random
}

/// Draws of one pose before the working region counts as out of reach.
const TRIES: usize = 10_000;

/// From one row to the next (s).
const PACE: f64 = 60.0;

/// Takes the parts of the joints' compliances off their declared values.
pub fn scatter(scenario: &Scenario, robot: &mut Description) {
    let mut random = stream(scenario, Stream::Scatter);
    for part in robot.joints.iter_mut().flat_map(|joint| &mut joint.compliance) {
        part.value *= 1.0 + scenario.scatter * (2.0 * random.random::<f64>() - 1.0);
    }
}

/// The rows of a scenario, with nothing read yet.
///
/// # Errors
/// No pose in the working region.
pub fn loads(robot: &Description, scenario: &Scenario) -> Result<Displacements, Error> {
    let poses = poses(robot, scenario)?;
    let mut random = stream(scenario, Stream::Loads);
    let mut rows = Vec::with_capacity(poses.len() * scenario.visits * scenario.ramp.len());
    for (pose, q) in poses.iter().enumerate() {
        for of_pose in 0..scenario.visits {
            let visit = pose * scenario.visits + of_pose;
            let force = greatest(&scenario.force, visit, &mut random);
            let moment =
                scenario.moment.as_ref().map_or_else(Vector3::zeros, |pull| greatest(pull, visit, &mut random));
            for share in &scenario.ramp {
                let (force, moment) = (force * *share, moment * *share);
                rows.push(Observation {
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
                    rotation: scenario.rotation_noise.map(|_| [0.0; 3]),
                });
            }
        }
    }
    let names = |count: usize| (1..=count).map(|number| number.to_string()).collect::<Vec<String>>();
    Ok(Displacements {
        wrench_frame: scenario.wrench.0,
        wrench_at: scenario.wrench.1,
        measured_frame: scenario.measured.0,
        measured_at: scenario.measured.1,
        poses: names(poses.len()),
        visits: names(poses.len() * scenario.visits),
        rows,
    })
}

fn poses(robot: &Description, scenario: &Scenario) -> Result<Vec<Vec<f64>>, Error> {
    let (count, within, floor, column) = match &scenario.poses {
        Poses::Listed(poses) => return Ok(poses.clone()),
        Poses::Drawn { count, within, floor, column } => (*count, within, *floor, *column),
    };
    let mut random = stream(scenario, Stream::Poses);
    let [foot_x, foot_y, foot_z] = robot.base.xyz;
    let is_inside = |[x, y, z]: [f64; 3]| {
        floor.is_none_or(|floor| z - foot_z >= floor)
            && column.is_none_or(|column| (x - foot_x).hypot(y - foot_y) >= column)
    };
    let mut pose = || {
        for _ in 0..TRIES {
            let q: Vec<f64> = within.iter().map(|&[low, high]| random.random_range(low..=high)).collect();
            if is_inside(tool_centre_point(robot, &q)) {
                return Ok(q);
            }
        }
        Err(Error(format!(
            "none of {TRIES} poses drawn within the joints' limits keeps the tool within the working region of `poses`"
        )))
    };
    (0..count).map(|_| pose()).collect()
}

/// Where the tool centre point is, in the base frame (m).
fn tool_centre_point(robot: &Description, q: &[f64]) -> [f64; 3] {
    crate::with_robot!(robot, |robot| position(&robot, q))
}

fn position<const N: usize>(robot: &impl Robot<N>, q: &[f64]) -> [f64; 3] {
    let transform = robot.transform(&SVector::<f64, N>::from_column_slice(q));
    transform.fixed_view::<3, 1>(0, 3).into_owned().into()
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

/// Adds the noise of the loaded reading, and takes that of the unloaded one
/// away: the visit's or the row's own.
pub fn noise(scenario: &Scenario, data: &mut Displacements) {
    let mut random = stream(scenario, Stream::Noise);
    let turn = scenario.rotation_noise.unwrap_or(0.0);
    let [x, y, z] = scenario.noise;
    // Six draws a reading whatever is measured: rotations leave the rest as is.
    let mut reading = || [x, y, z, turn, turn, turn].map(|sigma| sigma * normal(&mut random));
    let (mut unloaded, mut visit) = ([0.0; 6], None);
    for row in &mut data.rows {
        if visit != Some(row.visit) || !scenario.shares_unloaded {
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
pub fn encoder_noise(scenario: &Scenario, data: &mut Displacements) {
    let mut random = stream(scenario, Stream::Encoders);
    let sigmas = scenario.encoder_noise.iter().flatten();
    for row in &mut data.rows {
        for (angle, sigma) in row.encoders.iter_mut().flatten().zip(sigmas.clone()) {
            *angle += sigma * normal(&mut random);
        }
    }
}

/// A standard normal variate (Box and Muller).
fn normal(random: &mut ChaCha8Rng) -> f64 {
    // The logarithm needs a number above zero.
    let radius = (-2.0 * (1.0 - random.random::<f64>()).ln()).sqrt();
    radius * (core::f64::consts::TAU * random.random::<f64>()).cos()
}
