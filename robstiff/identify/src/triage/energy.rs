//! Energy: a load that is put on does work on the arm, `F . d > 0`. A line whose
//! work is below zero by more than its noise (Student's t, over all lines) has
//! readings of something else.

use std::format;
use std::string::String;

use nalgebra::Vector6;
use statrs::distribution::{ContinuousCDF, Normal};

use super::evidence::Evidence;
use super::{Raw, Unjudged};
use crate::probability::student_tail;
use crate::words::count;

pub(super) fn check(evidence: &Evidence<'_>) -> Unjudged {
    let Some(wrenches) = &evidence.wrenches else {
        return Err(String::from("read the displacement where the force acts, or the rotation as well"));
    };
    let shared = evidence.covariance.shared;
    let declared = evidence.campaign.noise.displacement;
    let reading = evidence.covariance.reading();
    let (mut least, mut negative, mut sum) = (f64::INFINITY, 0, 0.0);
    for line in &evidence.lines {
        let slope = line.slope(shared);
        let load = line.unit_load(wrenches);
        let moved = line.rows.iter().zip(&slope.weights).map(|(&row, w)| evidence.reading(row) * *w);
        let work = load.dot(&moved.sum::<Vector6<f64>>());
        // Where only the noise is declared, that; it is what weighs the readings.
        let noise = evidence.variance(line.weighed(&slope.weights, load)).sqrt();
        negative += usize::from(work < 0.0);
        least = least.min(work / noise);
        sum += work;
    }
    let lines = evidence.lines.len();
    if lines == 0 {
        return Err(String::from("rows with a load"));
    }
    let tail = match (reading, declared) {
        (Some(_), _) => student_tail(-least, evidence.covariance.freedom as f64),
        (None, Some(_)) => Some(Normal::standard().cdf(least)),
        (None, None) => None,
    };
    let mean = 1e6 * sum / lines as f64;
    Ok(Raw {
        statistic: negative as f64,
        unit: "loads that the arm moves against",
        p_value: tail.map(|tail| (tail * lines as f64).min(1.0)),
        matters_from: 1.0,
        witnesses: lines,
        said: [
            match (negative, tail) {
                (0, _) => format!("Every load does work on the arm, {mean:.3} um/N on average."),
                (_, Some(_)) => {
                    format!("No load does work below zero by more than its noise, {mean:.3} um/N on average.")
                }
                (_, None) => format!(
                    "Under {} the arm moves against the load; without a known noise nothing says whether that is more \
                     than noise.",
                    count(negative, "load")
                ),
            },
            format!(
                "Under {} of {lines} the arm moves against the load, beyond the noise. An arm that is pushed does not \
                 come along: a sign, a frame or a unit of the forces or of the displacements is wrong, or rows are \
                 mixed up.",
                count(negative, "load")
            ),
        ],
    })
}
