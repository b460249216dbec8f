//! Triage of clamped axes. Each axis is a line of loads of its own; its rows may
//! share an unloaded reading, so every axis has a free offset, and what is asked
//! is asked beyond that and a slope. Few axes leave no signs to flip: the tests
//! are F tests and take the rows' own noise to be normal and alike within an axis.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::{Raw, Unjudged};
use crate::campaign::{Campaign, ClampedRow};
use crate::probability::{fisher_tail, student_tail};
use crate::words::percent;

/// What measurement errors of the torque may make of it.
const MATTERS: f64 = 0.01;

/// The checks that make sense of clamped axes.
pub(super) fn checks(campaign: &Campaign, rows: &[ClampedRow]) -> Vec<(&'static str, &'static str, Unjudged)> {
    let axes: Vec<Axis> = (1..=campaign.robot.joints.len()).filter_map(|axis| Axis::new(axis, rows)).collect();
    std::vec![
        ("proportionality", "does the deflection grow in proportion to the torque?", proportionality(&axes)),
        ("reversal", "do opposite torques give opposite deflections?", reversal(&axes)),
        ("energy", "does every torque do work on the axis?", energy(&axes)),
        ("order", "does what is left depend on the order of rows?", order(&axes)),
    ]
}

/// The rows of an axis.
struct Axis {
    number: usize,
    torques: Vec<f64>,
    deflections: DVector<f64>,
    /// In the file.
    places: Vec<f64>,
}

/// A further number of an axis beyond offset and slope.
struct Further {
    axis: usize,
    /// Over the slope's part at the largest torque.
    share: f64,
    /// What it takes from the squares, over their mean left.
    ratio: f64,
    freedom: usize,
}

impl Further {
    /// The finding of it, with what to say where the axes are all right, and of
    /// this one where it is not.
    fn said_of(&self, unit: &'static str, p_value: f64, witnesses: usize, holds: &str, fails: String) -> Raw {
        Raw {
            statistic: 100.0 * self.share,
            unit,
            p_value: Some(p_value),
            matters_from: 100.0 * MATTERS,
            witnesses,
            said: [String::from(holds), fails],
        }
    }
}

impl Axis {
    fn new(number: usize, rows: &[ClampedRow]) -> Option<Self> {
        let (places, mine): (Vec<f64>, Vec<&ClampedRow>) =
            rows.iter().enumerate().filter(|(_, row)| row.axis == number).map(|(k, row)| (k as f64, row)).unzip();
        (!mine.is_empty()).then(|| Self {
            number,
            torques: mine.iter().map(|row| row.torque).collect(),
            deflections: DVector::from_iterator(mine.len(), mine.iter().map(|row| row.deflection)),
            places,
        })
    }

    fn largest(&self) -> f64 {
        self.torques.iter().fold(0.0, |largest, torque| torque.abs().max(largest))
    }

    /// The number of a further shape; `None` where the rows do not tell it from
    /// an offset and a slope, or have no torque.
    fn further(&self, shape: impl Fn(usize) -> f64) -> Option<Further> {
        let (rows, largest) = (self.torques.len(), self.largest());
        // An axis without a torque has no slope, and no decomposition ends.
        if largest == 0.0 {
            return None;
        }
        let design = DMatrix::from_fn(rows, 3, |i, k| match k {
            0 => 1.0,
            1 => self.torques[i] / largest,
            _ => shape(i),
        });
        let freedom = rows.checked_sub(3).filter(|&freedom| freedom > 0)?;
        let svd = design.clone().svd(true, true);
        let least = svd.singular_values.iter().copied().fold(f64::INFINITY, f64::min);
        if least <= 1e-3 * svd.singular_values.max() {
            return None;
        }
        let fitted = svd.solve(&self.deflections, 0.0).ok()?;
        let left = (&self.deflections - &design * &fitted).norm_squared() / freedom as f64;
        let spread = design.tr_mul(&design).try_inverse()?[(2, 2)];
        Some(Further {
            axis: self.number,
            share: fitted[2] / fitted[1],
            ratio: fitted[2] * fitted[2] / spread / left.max(f64::MIN_POSITIVE),
            freedom,
        })
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The axis on which a further number stands out most, with the probability of
/// that on any (F, times the number of axes).
fn strongest(found: Vec<Further>) -> Option<(Further, f64, usize)> {
    let axes = found.len();
    let p_value = |further: &Further| fisher_tail(further.ratio, [1.0, further.freedom as f64]).unwrap_or(1.0);
    let found = found.into_iter().map(|further| (p_value(&further), further));
    let (p, further) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((further, (p * axes as f64).min(1.0), axes))
}

fn proportionality(axes: &[Axis]) -> Unjudged {
    let curved = |axis: &Axis| {
        let largest = axis.largest();
        axis.further(|i| axis.torques[i] * axis.torques[i].abs() / (largest * largest))
    };
    let Some((found, p_value, witnesses)) = strongest(axes.iter().filter_map(curved).collect()) else {
        return Err(String::from("four torques or more on an axis, one below 3 % of the rated"));
    };
    let changes = if found.share > 0.0 { "softens" } else { "hardens" };
    Ok(found.said_of(
        "% of the compliance",
        p_value,
        witnesses,
        "The deflections grow in proportion to the torques as far as one can tell.",
        format!(
            "Axis {} {changes} with the torque, by {} up to the largest: lost motion or a gear that is not linear.",
            found.axis,
            percent(found.share.abs())
        ),
    ))
}

fn reversal(axes: &[Axis]) -> Unjudged {
    let both = |axis: &&Axis| axis.torques.iter().any(|t| *t > 0.0) && axis.torques.iter().any(|t| *t < 0.0);
    let even = |axis: &Axis| {
        let largest = axis.largest();
        axis.further(|i| axis.torques[i].abs() / largest)
    };
    let Some((found, p_value, witnesses)) = strongest(axes.iter().filter(both).filter_map(even).collect()) else {
        return Err(String::from("torques both ways on an axis, four or more"));
    };
    Ok(found.said_of(
        "% of the compliance",
        p_value,
        witnesses,
        "Opposite torques give opposite deflections as far as one can tell.",
        format!(
            "Axis {} gives way by {} more one way than the other: preload, or a contact on one side.",
            found.axis,
            percent(2.0 * found.share.abs())
        ),
    ))
}

fn order(axes: &[Axis]) -> Unjudged {
    let trend = |axis: &Axis| {
        let middle = mean(&axis.places);
        // Rows of other axes may stand between.
        let from_first_to_last = axis.places.last()? - axis.places.first()? + 1.0;
        axis.further(|i| (axis.places[i] - middle) / from_first_to_last)
    };
    let Some((found, p_value, witnesses)) = strongest(axes.iter().filter_map(trend).collect()) else {
        return Err(String::from("four torques or more on an axis, not in rising order"));
    };
    Ok(found.said_of(
        "% of the deflection",
        p_value,
        witnesses,
        "What is left does not depend on the order of rows as far as one can tell.",
        format!(
            "What is left of axis {} depends on the order of rows: readings drift, or the gear creeps.",
            found.axis
        ),
    ))
}

/// The slope of every axis beside its offset, one-sided (Student's t, times the number of axes).
fn energy(axes: &[Axis]) -> Unjudged {
    let slope = |axis: &Axis| {
        let torques = DVector::from_column_slice(&axis.torques).add_scalar(-mean(&axis.torques));
        let deflections = axis.deflections.add_scalar(-axis.deflections.mean());
        let squares = torques.norm_squared();
        let freedom = axis.torques.len().checked_sub(2).filter(|&freedom| freedom > 0 && squares > 0.0)?;
        let slope = torques.dot(&deflections) / squares;
        let left = (deflections - &torques * slope).norm_squared() / freedom as f64;
        let t = slope / (left / squares).sqrt().max(f64::MIN_POSITIVE);
        Some((student_tail(-t, freedom as f64)?, slope, axis.number))
    };
    let found: Vec<(f64, f64, usize)> = axes.iter().filter_map(slope).collect();
    let Some(&(p, _, number)) = found.iter().min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Err(String::from("three torques or more on an axis, not all alike"));
    };
    let negative = found.iter().filter(|(_, slope, _)| *slope < 0.0).count();
    Ok(Raw {
        statistic: negative as f64,
        unit: "axes that turn against the torque",
        p_value: Some((p * found.len() as f64).min(1.0)),
        matters_from: 1.0,
        witnesses: found.len(),
        said: [
            String::from("No axis turns against its torque beyond the noise."),
            format!("Axis {number} turns against its torque: a sign or a unit is wrong, or rows are mixed up."),
        ],
    })
}
