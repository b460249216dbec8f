//! Absolute positions under payloads.

use std::vec::Vec;

use nalgebra::{Isometry3, Vector3};
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;
use robstiff_robots::quantity::finite;

use super::draw::{PACE, Stream, names, stream};
use super::{Scenario, UnderPayloads};
use crate::campaign::{PositionRow, Positions};
use crate::observe::position::Position;
use crate::probability::normal;

/// How far the tracker stands from the robot, along each axis, on average (m).
const DISTANCE: f64 = 3.0;

/// The positions of a scenario at some poses, with noise, as a tracker reads them that
/// stands anywhere. The robot goes through all poses, then through all again.
pub fn measured(truth: &Description, scenario: &Scenario, under: &UnderPayloads, poses: &[Vec<f64>]) -> Positions {
    let visits = scenario.visits * poses.len();
    let mut data = Positions {
        payload_at: scenario.wrench_at,
        measured_at: scenario.measured_at,
        poses: names(poses.len()),
        visits: names(visits),
        rows: Vec::with_capacity(visits * under.payloads.len()),
    };
    for visit in 0..visits {
        for &payload in &under.payloads {
            let row = data.rows.len();
            data.rows.push(PositionRow {
                line: row + 2,
                pose: visit % poses.len(),
                visit,
                time: Some(PACE * (row + 1) as f64),
                temperature: None,
                q: poses[visit % poses.len()].clone(),
                position: [0.0; 3],
                payload,
            });
        }
    }
    read(truth, scenario, under, &mut data);
    data
}

/// Whether a campaign may have all numbers of a row.
pub fn is_readable(row: &PositionRow) -> bool {
    row.q.iter().chain(&row.position).all(|value| finite(*value).is_ok())
}

/// Sets what the tracker reads in every row.
fn read(truth: &Description, scenario: &Scenario, under: &UnderPayloads, data: &mut Positions) {
    let mut random = stream(scenario, Stream::Tracker);
    let turn = vector(&mut random, [1.0; 3]);
    let tracker = Isometry3::new(vector(&mut random, [DISTANCE; 3]), turn);
    let points = Position::new(truth, data).points(truth);
    let mut random = stream(scenario, Stream::Noise);
    let (mut visit, mut comes_to) = (None, Vector3::zeros());
    for (row, point) in data.rows.iter_mut().zip(points) {
        if visit != Some(row.visit) {
            (visit, comes_to) = (Some(row.visit), vector(&mut random, [under.repeatability; 3]));
        }
        let placed = tracker.transform_point(&(point + comes_to).into()).coords;
        row.position = (placed + vector(&mut random, scenario.noise)).into();
    }
}

/// Three normal variates, one sigma of each.
fn vector(random: &mut ChaCha8Rng, sigmas: [f64; 3]) -> Vector3<f64> {
    Vector3::from(sigmas.map(|sigma| sigma * normal(random)))
}
