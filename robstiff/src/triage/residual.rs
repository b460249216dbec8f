//! Does what is left depend on time, temperature or order? What is left is what
//! each pose's own linear response leaves of its readings; of each column both its
//! course over the campaign and its course since the visit began, when the unloaded
//! reading was taken, on each axis. What goes with the load's direction, which
//! differs from pose to pose, is not asked here: gears that are not linear would
//! pass for drift.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::DMatrix;

use super::evidence::Evidence;
use super::randomisation::{Witness, flip};
use super::{Raw, Verdict};
use crate::identify::covariance::contrasts::{Level, contrasts};
use crate::words::micrometres;

/// A drift over its whole range below this share of a reading's noise does not
/// matter.
const MATTERS: f64 = 0.2;

const AXES: [&str; 3] = ["x", "y", "z"];

pub(super) fn time(evidence: &Evidence<'_>) -> Verdict {
    let needs = "a column `time`, and several loads at each pose";
    let said = "readings drift (warming up, a sensor that creeps), or the base slipped";
    depends(evidence, |row| evidence.data.rows[row].time, "time", needs, said)
}

pub(super) fn temperature(evidence: &Evidence<'_>) -> Verdict {
    let needs = "a column `temperature`, and several loads at each pose";
    let said = "the arm or what carries the sensor expands";
    depends(evidence, |row| evidence.data.rows[row].temperature, "temperature", needs, said)
}

pub(super) fn order(evidence: &Evidence<'_>) -> Verdict {
    let needs = "several loads at each pose";
    let said = "readings drift, or the base or the sensor settles";
    depends(evidence, |row| Some(row as f64), "the order of rows", needs, said)
}

fn depends(
    evidence: &Evidence<'_>,
    of_row: impl Fn(usize) -> Option<f64>,
    name: &str,
    needs: &str,
    points: &str,
) -> Verdict {
    let samples = &evidence.samples;
    let column: Option<Vec<f64>> = (0..samples.rows.len()).map(of_row).collect();
    let Some(column) = column.filter(|column| varies(column)) else { return Err(String::from(needs)) };
    let mean = column.iter().sum::<f64>() / column.len() as f64;
    let mut first: Vec<(usize, f64)> = Vec::new();
    let since: Vec<f64> = (0..column.len())
        .map(|row| {
            let visit = samples.rows[row].visit;
            match first.iter().rev().find(|(known, _)| *known == visit) {
                Some((_, start)) => column[row] - start,
                None => {
                    first.push((visit, column[row]));
                    0.0
                }
            }
        })
        .collect();
    let course: Vec<f64> = column.iter().map(|value| value - mean).collect();

    let readings = DMatrix::from_fn(samples.rows.len(), 3, |row, axis| samples.rows[row].displacement[axis]);
    let chunks = contrasts(samples, &readings, Level::Linear, |_| true, |_| false);
    let shared = evidence.covariance.shared;
    let (mut witnesses, mut sums, mut information) = (Vec::new(), [0.0; 6], [0.0; 6]);
    for chunk in &chunks {
        // What is left of readings and of features, whitened.
        let whitened = DMatrix::from_fn(chunk.rows.len(), chunk.shares.len(), |i, j| {
            chunk.basis[(i, j)] / (1.0 + shared * chunk.shares[j])
        });
        let left = &whitened * &chunk.values;
        let mut scores = Vec::with_capacity(6);
        for (kind, feature) in [&course, &since].into_iter().enumerate() {
            let values: Vec<f64> = chunk.rows.iter().map(|&row| feature[row]).collect();
            let contrast = |j: usize| (0..values.len()).map(|i| chunk.basis[(i, j)] * values[i]).sum::<f64>();
            let of_unit: f64 =
                (0..chunk.shares.len()).map(|j| contrast(j).powi(2) / (1.0 + shared * chunk.shares[j])).sum();
            for axis in 0..3 {
                scores.push((0..values.len()).map(|i| values[i] * left[(i, axis)]).sum());
                information[3 * kind + axis] += of_unit;
            }
        }
        sums.iter_mut().zip(&scores).for_each(|(sum, score): (&mut f64, &f64)| *sum += score);
        let mut visits = chunk.visits.clone();
        visits.dedup();
        witnesses.push(Witness { pose: samples.rows[chunk.rows[0]].pose, visits, scores });
    }
    let Some(flipped) = flip(&witnesses) else { return Err(String::from(needs)) };
    let feature = if flipped.strongest < 3 { &course } else { &since };
    let range = feature.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - feature.iter().copied().fold(f64::INFINITY, f64::min);
    let drift = sums[flipped.strongest] / information[flipped.strongest].max(f64::MIN_POSITIVE) * range;
    let over = if flipped.strongest < 3 { "over the campaign" } else { "within a visit" };
    let matters = MATTERS * evidence.covariance.reading().unwrap_or(0.0);
    Ok(Raw {
        statistic: 1e6 * drift,
        unit: "um over the range",
        p_value: Some(flipped.p_value),
        matters_from: 1e6 * matters,
        witnesses: flipped.witnesses,
        said: [
            format!("What each pose's own linear response leaves does not depend on {name}."),
            format!(
                "What each pose's own linear response leaves depends on {name}: {} along {} {over}. That points to the \
                 measurement: {points}.",
                micrometres(drift.abs()),
                AXES[flipped.strongest % 3]
            ),
        ],
    })
}

fn varies(column: &[f64]) -> bool {
    let least = column.iter().copied().fold(f64::INFINITY, f64::min);
    let most = column.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most > least
}
