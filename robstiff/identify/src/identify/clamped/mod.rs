//! Compliances axis by axis, the procedure of Abele, Weigold and Rothenbücher
//! (CIRP Annals 56/1, 2007): one gear is loaded at a time, those before it are
//! clamped, and the compliance is the slope of deflection over torque.

pub mod regression;
pub mod rounding;
#[cfg(test)]
mod tests;
pub mod wild;

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use robstiff_robots::Description;
use robstiff_robots::effect::physics::PLAYS;

use self::regression::torques;
use self::rounding::of_rounding;
use super::baseline::{Visibility, declared, with_values};
use super::readable::is_readable;
use super::uncertainty::{WITHIN, student};
use super::whitening::mean_share;
use super::{Error, Estimate, Identification, element_name, unit_of};
use crate::campaign::{Campaign, ClampedRow};
use robstiff::elements::{Torque, plays, turn};
use robstiff::{Effect, JointKind};

/// Identifies the compliances of the axes that were loaded, beside the laws of
/// joints that the description declares, from the rows that belong to the others.
/// Where a joint is compound, the measurement sees the sum of its parts, which keep
/// their proportion.
///
/// # Errors
/// An axis whose deflection goes against its torque; rows that load no axis, or one only once;
/// declared effects that do not go with the compliances found.
pub fn identify(campaign: &Campaign, rows: &[ClampedRow]) -> Result<Identification, Error> {
    if rows.iter().all(|row| row.deflection == 0.0) {
        return Err(Error::NotShown(String::from(
            "every deflection is zero: nothing was read of how the axes give way",
        )));
    }
    let less = without_laws(&campaign.robot, rows);
    let mut left_out: Vec<usize> = [JointKind::Revolute, JointKind::Prismatic]
        .iter()
        .flat_map(|&kind| wild_of(&campaign.robot, &less, kind))
        .collect();
    left_out.sort_unstable();
    let found = slopes(campaign, rows, &left_out)?;
    enough(rows)?;
    if is_readable(&found.description) { Ok(found) } else { Err(Error::NoDescription) }
}

/// The same of all rows but those `left_out`, by index.
///
/// # Errors
/// An axis whose deflection goes against its torque; rows that load no axis.
pub fn slopes(campaign: &Campaign, rows: &[ClampedRow], left_out: &[usize]) -> Result<Identification, Error> {
    let own = declared(&campaign.robot);
    let less = without_laws(&campaign.robot, rows);
    let kept: Vec<&ClampedRow> =
        less.iter().enumerate().filter(|(row, _)| !left_out.contains(row)).map(|(_, row)| row).collect();
    let rounding = of_rounding(rows);
    let mut values: Vec<f64> = own.iter().map(|number| number.value).collect();
    let mut estimates = Vec::new();
    for (i, number) in own.iter().enumerate() {
        let here = |row: &&ClampedRow| number.effect.is_none() && row.axis == i + 1;
        let of_axis: Vec<&ClampedRow> = kept.iter().copied().filter(here).collect();
        let rounding = rounding.get(i).copied().unwrap_or(0.0);
        let slope = slope(&of_axis, rounding);
        let read: Vec<&ClampedRow> = rows.iter().filter(here).collect();
        if goes_against(&read, rounding) {
            return Err(Error::AgainstTheLoads(format!(
                "axis {} deflects against its torque (rows from line {}): check the signs",
                i + 1,
                read[0].line
            )));
        }
        let clipped = slope.is_some_and(|(value, _)| value < 0.0);
        if let Some((value, _)) = slope {
            values[i] = value.max(0.0);
        }
        estimates.push(Estimate {
            name: element_name(&campaign.robot, number),
            declared: number.value,
            value: values[i],
            std: slope.filter(|_| !clipped).and_then(|(_, std)| std),
            unit: unit_of(&campaign.robot, number.column),
            visibility: if slope.is_some() { Visibility::Seen } else { Visibility::Unseen },
            at_bound: clipped && number.value > 0.0,
            confounded_with: Vec::new(),
        });
    }
    if estimates.iter().all(|estimate| estimate.visibility != Visibility::Seen) {
        return Err(Error::NotShown(String::from("no row loads its axis: every torque is zero")));
    }
    Ok(Identification {
        left_out: left_out.iter().map(|&row| rows[row].line).collect(),
        description: with_values(&campaign.robot, &values),
        correlation: DMatrix::identity(estimates.len(), estimates.len()),
        estimates,
        rows: rows.len(),
        poses: 0,
        noise: None,
        covariance: None,
        rms_declared: None,
        rms: None,
    })
}

/// Refuses an axis that is read only once: its slope would have no uncertainty.
fn enough(rows: &[ClampedRow]) -> Result<(), Error> {
    let once = |row: &&ClampedRow| rows.iter().filter(|other| other.axis == row.axis).count() == 1;
    let Some(row) = rows.iter().find(|row| row.torque != 0.0 && once(row)) else { return Ok(()) };
    Err(Error::NotShown(format!(
        "one row (line {}) cannot tell how sure the compliance of axis {} is: load every axis at least twice",
        row.line, row.axis
    )))
}

/// The outlying rows of the axes of one kind, by index: radians and metres have no noise in common.
fn wild_of(robot: &Description, rows: &[ClampedRow], kind: JointKind) -> Vec<usize> {
    let at: Vec<usize> = (0..rows.len()).filter(|&row| robot.joints[rows[row].axis - 1].kind == kind).collect();
    let own: Vec<ClampedRow> = at.iter().map(|&row| rows[row]).collect();
    // What is left may be a curve of a gear.
    let wild = wild::wild_rows(&own, &torques(&own), false, &wild::Room::new(rows));
    wild.map_or_else(Vec::new, |(wild, _)| wild.into_iter().map(|row| at[row]).collect())
}

/// Whether an axis deflects against its torque: a sign is wrong in most of its rows, an outlying reading
/// in one. Of an axis that does not move, readings may be a step off on either side; `rounding` is
/// their variance by that.
fn goes_against(rows: &[&ClampedRow], rounding: f64) -> bool {
    let against = rows.iter().filter(|row| row.torque * row.deflection < 0.0).count();
    let a_step = (12.0 * rounding).sqrt() * (1.0 + 1e-9);
    2 * against > rows.len() && rows.iter().any(|row| row.deflection.abs() > a_step)
}

/// The rows less what laws of joints do that the description declares, each axis
/// beginning at rest; but for a compliance that varies with the axis's angle,
/// which such rows do not tell. Torques (Nm) stay, deflections (rad) are what is
/// left.
pub fn without_laws(robot: &Description, rows: &[ClampedRow]) -> Vec<ClampedRow> {
    let mut states = std::vec![[0.0; PLAYS]; robot.joints.len()];
    let less = |row: &ClampedRow| {
        let (joint, mut less) = (row.axis - 1, *row);
        for effect in robot.effects.iter().filter(|effect| effect.row() == Some(row.axis)) {
            if matches!(effect, Effect::PoseDependentCompliance { .. }) {
                continue;
            }
            // Where the axis stood, and so what weighed on it, the rows do not tell.
            let torque = Torque::of(row.torque);
            states[joint] = plays(effect, torque, states[joint]);
            let own = robot.joints[joint].compliance();
            less.deflection -= turn(effect, own, 0.0, torque, states[joint]).unwrap_or(0.0);
        }
        less
    };
    rows.iter().map(less).collect()
}

/// The slope through the origin of rows that share one unloaded reading, and its
/// standard deviation from their scatter (none from a single row), which is taken for no
/// less than some variance; `None` where nothing was loaded. The standard deviation is told
/// as [`uncertainty`](super::uncertainty) tells it.
fn slope(rows: &[&ClampedRow], least: f64) -> Option<(f64, Option<f64>)> {
    let share = mean_share(rows.len(), 1.0) / rows.len().max(1) as f64;
    let whitened = |of: fn(&ClampedRow) -> f64| {
        let values = DVector::from_iterator(rows.len(), rows.iter().map(|row| of(row)));
        let sum = values.sum();
        values.add_scalar(-share * sum)
    };
    let (torques, deflections) = (whitened(|row| row.torque), whitened(|row| row.deflection));
    let squares = torques.norm_squared();
    if squares == 0.0 {
        return None;
    }
    let slope = torques.dot(&deflections) / squares;
    let freedom = rows.len() as f64 - 1.0;
    let std = (freedom > 0.0).then(|| {
        let left = (deflections - slope * torques).norm_squared();
        let scatter = left / freedom * (student(freedom) / WITHIN).powi(2);
        (scatter.max(least) / squares).sqrt()
    });
    Some((slope, std))
}
