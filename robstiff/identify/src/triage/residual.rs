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
use super::{Raw, Unjudged};
use crate::noise::contrasts::{Chunk, Level, contrasts};
use crate::noise::samples::Samples;
use crate::words::micrometres;

/// A drift over its whole range below this share of a reading's noise does not
/// matter.
const MATTERS: f64 = 0.2;

const AXES: [&str; 3] = ["x", "y", "z"];

pub(super) fn time(evidence: &Evidence<'_>) -> Unjudged {
    let needs = "a column `time`, and several loads at each pose";
    let said = "readings drift (warming up, a sensor that creeps), or the base slipped";
    depends(evidence, |row| evidence.data.rows[row].time, "time", needs, said)
}

pub(super) fn temperature(evidence: &Evidence<'_>) -> Unjudged {
    let needs = "a column `temperature`, and several loads at each pose";
    let said = "the arm or what carries the sensor expands";
    depends(evidence, |row| evidence.data.rows[row].temperature, "temperature", needs, said)
}

pub(super) fn order(evidence: &Evidence<'_>) -> Unjudged {
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
) -> Unjudged {
    let samples = &evidence.samples;
    let column: Option<Vec<f64>> = (0..samples.rows.len()).map(of_row).collect();
    let Some(column) = column.filter(|column| range(column) > 0.0) else { return Err(String::from(needs)) };
    let mean = column.iter().sum::<f64>() / column.len() as f64;
    let courses = [column.iter().map(|value| value - mean).collect(), since_visit_began(samples, &column)];

    let readings = DMatrix::from_fn(samples.rows.len(), 3, |row, axis| samples.rows[row].displacement[axis]);
    let chunks = contrasts(samples, &readings, Level::Linear, |_| true, |_| false);
    let (mut witnesses, mut sums, mut information) = (Vec::new(), [0.0; 6], [0.0; 6]);
    for chunk in &chunks {
        let (scores, of_unit) = scored(chunk, &courses, evidence.covariance.shared);
        for k in 0..6 {
            sums[k] += scores[k];
            information[k] += of_unit[k];
        }
        let mut visits = chunk.visits.clone();
        visits.dedup();
        let pose = samples.rows[chunk.rows[0]].pose;
        witnesses.push(Witness { pose, visits, scores: scores.to_vec() });
    }
    let Some(flipped) = flip(&witnesses) else { return Err(String::from(needs)) };
    let (course, axis) = (flipped.strongest / 3, flipped.strongest % 3);
    let slope = sums[flipped.strongest] / information[flipped.strongest].max(f64::MIN_POSITIVE);
    let drift = slope * range(&courses[course]);
    let over = ["over the campaign", "within a visit"][course];
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
                AXES[axis]
            ),
        ],
    })
}

/// A column less what it was at the first row of each row's visit.
fn since_visit_began(samples: &Samples, column: &[f64]) -> Vec<f64> {
    let mut began: Vec<(usize, f64)> = Vec::new();
    let since = column.iter().zip(&samples.rows).map(|(value, row)| {
        match began.iter().rev().find(|(visit, _)| *visit == row.visit) {
            Some((_, start)) => value - start,
            None => {
                began.push((row.visit, *value));
                0.0
            }
        }
    });
    since.collect()
}

/// How much of each course is in what a pose's own response leaves, course by course and
/// axis by axis, and what one of the course's unit would give.
fn scored(chunk: &Chunk, courses: &[Vec<f64>; 2], shared: f64) -> ([f64; 6], [f64; 6]) {
    // What is left of readings and of features, whitened.
    let whitened = DMatrix::from_fn(chunk.rows.len(), chunk.shares.len(), |i, j| {
        chunk.basis[(i, j)] / (1.0 + shared * chunk.shares[j])
    });
    let left = &whitened * &chunk.values;
    let (mut scores, mut information) = ([0.0; 6], [0.0; 6]);
    for (kind, course) in courses.iter().enumerate() {
        let values: Vec<f64> = chunk.rows.iter().map(|&row| course[row]).collect();
        let contrast = |j: usize| (0..values.len()).map(|i| chunk.basis[(i, j)] * values[i]).sum::<f64>();
        let of_unit = (0..chunk.shares.len()).map(|j| contrast(j).powi(2) / (1.0 + shared * chunk.shares[j])).sum();
        for axis in 0..3 {
            scores[3 * kind + axis] = (0..values.len()).map(|i| values[i] * left[(i, axis)]).sum();
            information[3 * kind + axis] = of_unit;
        }
    }
    (scores, information)
}

fn range(column: &[f64]) -> f64 {
    let least = column.iter().copied().fold(f64::INFINITY, f64::min);
    let most = column.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most - least
}
