//! Reversal: the part of the displacement that does not change sign with the
//! load, `g |x|` on each axis of the base and of the tool, for loads `x` both ways
//! along one line.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::Vector3;

use super::evidence::Evidence;
use super::randomisation::{Witness, flip};
use super::{Raw, Unjudged};
use crate::words::percent;

const MATTERS: f64 = 0.01;

const AXES: [&str; 6] =
    ["x of the base", "y of the base", "z of the base", "x of the tool", "y of the tool", "z of the tool"];

pub(super) fn check(evidence: &Evidence<'_>) -> Unjudged {
    let shared = evidence.covariance.shared;
    let (mut witnesses, mut even, mut whole) = (Vec::new(), [(0.0, 0.0); 6], (0.0, 0.0));
    for line in &evidence.lines {
        let both = line.loads.iter().any(|load| *load > 0.0) && line.loads.iter().any(|load| *load < 0.0);
        let shape: Vec<f64> = line.loads.iter().map(|load| load.abs()).collect();
        let Some(contrast) = line.beyond_linear(&shape, shared).filter(|_| both) else { continue };
        let read = |weights: &[f64]| -> Vector3<f64> {
            line.rows.iter().zip(weights).map(|(&row, w)| evidence.samples.rows[row].displacement * *w).sum()
        };
        let base = read(&contrast.weights);
        let tool = evidence.samples.rows[line.rows[0]].tcp.turn.transpose() * base;
        let scores = [base.x, base.y, base.z, tool.x, tool.y, tool.z];
        for (sum, score) in even.iter_mut().zip(scores) {
            *sum = (sum.0 + score, sum.1 + contrast.information);
        }
        whole = (whole.0 + read(&line.slope(shared).weights).norm(), whole.1 + 1.0);
        witnesses.push(Witness { pose: line.pose, visits: line.visits.clone(), scores: scores.to_vec() });
    }
    let Some(flipped) = flip(&witnesses) else {
        return Err(String::from("at 12 poses or more, each load once more the other way"));
    };
    let (score, information) = even[flipped.strongest];
    let share = score / information / (whole.0 / whole.1);
    Ok(Raw {
        statistic: 100.0 * share,
        unit: "% of the displacement",
        p_value: Some(flipped.p_value),
        matters_from: 100.0 * MATTERS,
        witnesses: flipped.witnesses,
        said: [
            format!("Opposite loads give opposite displacements, to {}.", percent(share.abs().max(MATTERS))),
            format!(
                "Part of the displacement along {} ({} of it) does not turn round with the load. That points to gears \
                 that their own weight has already wound up, to a biased load cell, or to a contact on one side.",
                AXES[flipped.strongest],
                percent(share.abs())
            ),
        ],
    })
}
