//! Reciprocity (Betti): a linear elastic arm moves under a unit of load 1 along
//! load 2 as far as under a unit of load 2 along load 1, `F1 . d2 = F2 . d1`.
//!
//! Two tests, the smaller p-value twice: against the noise of the readings (F;
//! violations that look different at each pose), and by random signs of poses, of
//! violations alike in the base or in the tool, as those of a turned sensor are:
//! it makes the compliance `H R`, whose skew part has the vector `w` with
//! `F1 . d2 - F2 . d1 = w . (F1 x F2)`.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::{Vector3, Vector6};

use super::evidence::{Evidence, Line};
use super::randomisation::{Witness, flip};
use super::{Raw, Unjudged};
use crate::probability::fisher_tail;
use crate::words::percent;

const MATTERS: f64 = 0.01;

/// The sine of the smallest angle between two loads that are compared.
const APART: f64 = 0.3;

/// A line as a load and what it moves.
struct Response {
    load: Vector6<f64>,
    /// Per newton (m/N, rad/N).
    moved: Vector6<f64>,
    /// What that is of each row's reading (1/N).
    weights: Vec<f64>,
}

pub(super) fn check(evidence: &Evidence<'_>) -> Unjudged {
    let Some(wrenches) = &evidence.wrenches else {
        return Err(String::from("read the displacement where the force acts, or the rotation as well"));
    };
    let shared = evidence.covariance.shared;
    let response = |line: &Line| {
        let weights = line.slope(shared).weights;
        let moved = line.rows.iter().zip(&weights).map(|(&row, w)| evidence.reading(row) * *w).sum();
        Response { load: line.unit_load(wrenches), moved, weights }
    };
    let (mut witnesses, mut squares, mut pairs) = (Vec::new(), 0.0, 0_usize);
    let (mut differences, mut sizes) = (0.0, 0.0);
    for of_pose in evidence.lines.chunk_by(|a, b| a.pose == b.pose) {
        // The lines of a pose two by two, each once, so that pairs are independent.
        for pair in of_pose.chunks_exact(2) {
            let [one, other] = [response(&pair[0]), response(&pair[1])];
            let cross = pair[0].along.cross(&pair[1].along);
            if cross.norm() < APART {
                continue;
            }
            let difference = one.load.dot(&other.moved) - other.load.dot(&one.moved);
            let there = pair[1].weighed(&other.weights, one.load);
            let back = pair[0].weighed(&one.weights, -other.load);
            let noise = evidence.variance(there.chain(back));
            squares += difference * difference / noise;
            pairs += 1;
            differences += difference * difference - noise;
            sizes +=
                0.5 * (one.moved.fixed_rows::<3>(0).norm_squared() + other.moved.fixed_rows::<3>(0).norm_squared());
            let tool: Vector3<f64> = evidence.samples.rows[pair[0].rows[0]].tcp.turn.transpose() * cross;
            witnesses.push(Witness {
                pose: pair[0].pose,
                visits: pair.iter().flat_map(|line| line.visits.clone()).collect(),
                scores: cross.iter().chain(tool.iter()).map(|component| difference * component).collect(),
            });
        }
    }
    let flipped = flip(&witnesses);
    let of_size = evidence.covariance.reading().and_then(|_| {
        let freedom = (evidence.covariance.axes() * evidence.covariance.freedom) as f64;
        fisher_tail(squares / pairs as f64, [pairs as f64, freedom])
    });
    let p_values = [flipped.map(|flipped| flipped.p_value), of_size];
    let asked = p_values.iter().flatten().count();
    let least = p_values.into_iter().flatten().fold(f64::INFINITY, f64::min);
    if pairs == 0 || asked == 0 {
        return Err(String::from("two loads in different directions at one pose, at 12 poses or more"));
    }
    let share = (differences.max(0.0) / sizes).sqrt();
    Ok(Raw {
        statistic: 100.0 * share,
        unit: "% of the displacement",
        p_value: Some((least * asked as f64).min(1.0)),
        matters_from: 100.0 * MATTERS,
        witnesses: pairs,
        said: [
            format!("Loads and displacements are reciprocal (Betti), to {}.", percent(share.max(MATTERS))),
            format!(
                "Loads and displacements are not reciprocal (Betti): what one load does along another differs from the \
                 reverse by {} of the displacement. No linear spring does that: gears are not linear (lost motion, a \
                 stiffness that changes with torque), or there is friction, or the frame or the point of the forces or \
                 of the displacements is not what the file says.",
                percent(share)
            ),
        ],
    })
}
