//! Proportionality: the displacement along the load is `k x (1 + c |x| / X)` for
//! loads `x` along one line up to `X`; `c` is zero for anything linear. It is
//! estimated free of `k`, one `c` for all lines, each weighed by its stroke.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::evidence::Evidence;
use super::randomisation::{Witness, flip};
use super::{Raw, Unjudged};
use crate::words::percent;

/// What measurement errors of the force and of the second order may make of it.
const MATTERS: f64 = 0.01;

pub(super) fn check(evidence: &Evidence<'_>) -> Unjudged {
    let shared = evidence.covariance.shared;
    let (mut score, mut information) = (0.0, 0.0);
    let mut witnesses = Vec::new();
    for line in &evidence.lines {
        let largest = line.largest();
        let shape: Vec<f64> = line.loads.iter().map(|load| load * load.abs() / largest).collect();
        let Some(contrast) = line.beyond_linear(&shape, shared) else { continue };
        let read = |weights: &[f64]| -> f64 {
            line.rows.iter().zip(weights).map(|(&row, weight)| weight * evidence.along(row, &line.along)).sum()
        };
        let stroke = read(&line.slope(shared).weights);
        let one = stroke * read(&contrast.weights);
        score += one;
        information += stroke * stroke * contrast.information;
        witnesses.push(Witness { pose: line.pose, visits: line.visits.clone(), scores: std::vec![one] });
    }
    let Some(flipped) = flip(&witnesses) else {
        return Err(String::from(
            "loads along one line in three steps or more, the smallest below 3 % of the rated torque, at 12 poses or more",
        ));
    };
    let curvature = score / information;
    let grows = if curvature > 0.0 { "softens" } else { "hardens" };
    Ok(Raw {
        statistic: 100.0 * curvature,
        unit: "% of the compliance",
        p_value: Some(flipped.p_value),
        matters_from: 100.0 * MATTERS,
        witnesses: flipped.witnesses,
        said: [
            format!("The displacement grows in proportion to the load, to {}.", percent(curvature.abs().max(MATTERS))),
            format!(
                "The arm {grows} with the load: its compliance changes by {} up to the full load. That points to \
                 gears (lost motion, a stiffness that changes with torque) or to play, and not to bearings or links.",
                percent(curvature)
            ),
        ],
    })
}
