//! Return to zero: what is left of the displacement when the load is gone, along
//! the last load and on each axis of the base.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::evidence::Evidence;
use super::randomisation::{Witness, flip};
use super::{Raw, Unjudged};
use crate::words::micrometres;

/// What matters, against the noise of a reading.
const MATTERS: f64 = 0.1;

const WHERE: [&str; 4] = ["along the last load", "along x of the base", "along y of the base", "along z of the base"];

pub(super) fn check(evidence: &Evidence<'_>) -> Unjudged {
    let mut witnesses = Vec::new();
    let (mut sums, mut strokes) = ([0.0; 4], 0.0);
    for &row in &evidence.unloaded {
        let here = &evidence.samples.rows[row];
        let before = (0..row).rev().filter(|&other| evidence.samples.rows[other].visit == here.visit);
        let mut loaded = before.filter_map(|other| Some((other, evidence.line_of(other)?)));
        let Some((last, line)) = loaded.next() else { continue };
        let along = line.along * evidence.samples.rows[last].wrench.fixed_rows::<3>(0).dot(&line.along).signum();
        let d = here.displacement;
        let scores = [d.dot(&along), d.x, d.y, d.z];
        sums.iter_mut().zip(scores).for_each(|(sum, score)| *sum += score);
        strokes += evidence.along(last, &along).abs();
        witnesses.push(Witness { pose: here.pose, visits: std::vec![here.visit], scores: scores.to_vec() });
    }
    let Some(flipped) = flip(&witnesses) else {
        return Err(String::from("the unloaded arm read once more at the end of each visit, as a row of its own"));
    };
    let left = sums[flipped.strongest] / witnesses.len() as f64;
    let noise = evidence.covariance.reading().unwrap_or(0.0);
    let points = match flipped.strongest {
        0 if left > 0.0 => "friction holds part of the displacement, or the arm creeps",
        0 => "the readings move against the load with time, or the last load was not the largest",
        _ => "the readings drift, or what carries the sensor moved",
    };
    let matters = (MATTERS * noise).max(1e-3 * strokes / witnesses.len() as f64);
    Ok(Raw {
        statistic: 1e6 * left,
        unit: "um",
        p_value: Some(flipped.p_value),
        matters_from: 1e6 * matters,
        witnesses: flipped.witnesses,
        said: [
            format!("Without a load the arm is where it was, to {}.", micrometres(left.abs().max(matters))),
            format!(
                "When the load is gone, {} are left {}: {points}.",
                micrometres(left.abs()),
                WHERE[flipped.strongest]
            ),
        ],
    })
}
