//! Compliances axis by axis, the procedure of Abele, Weigold and Rothenbücher
//! (CIRP Annals 56/1, 2007): one gear is loaded at a time, those before it are
//! clamped, and the compliance is the slope of deflection over torque.

mod rounding;
#[cfg(test)]
mod tests;

use nalgebra::DMatrix;
use robstiff_robots::Description;
use robstiff_robots::effect::physics::PLAYS;

use self::rounding::{loaded, of_rounding};
use super::fitted::estimate;
use super::{Error, Estimate, Identification, Visibility};
use crate::campaign::{Campaign, ClampedRow, Data};
use crate::fit::case::Case;
use crate::fit::estimate::{name, with_value};
use crate::fit::own::Alone;
use crate::fit::readable::is_readable;
use crate::model::described::{Declared, declared};
use robstiff::Effect;
use robstiff::elements::{Torque, plays, turn};

/// Identifies the compliances of the axes that were loaded, beside the laws of joints that the description
/// declares: each axis by itself, with the noise of its own rows. Where a joint is compound, the measurement
/// sees the sum of its parts, which keep their proportion.
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
    let loaded = loaded(rows);
    if loaded.is_empty() {
        return Err(Error::NotShown(String::from("no row loads its axis: every torque is zero")));
    }
    let robot = &campaign.robot;
    let own = declared(robot);
    let held = |number: &Declared| Estimate {
        name: name(robot, number),
        declared: number.parameter.mean,
        value: number.parameter.mean,
        std: None,
        unit: number.parameter.unit,
        visibility: Visibility::Unseen,
        at_bound: false,
    };
    let mut found = Identification {
        description: robot.clone(),
        estimates: own.iter().map(held).collect(),
        correlation: DMatrix::identity(own.len(), own.len()),
        rows: rows.len(),
        poses: 0,
        noise: None,
        scatter: None,
        left_out: Vec::new(),
        rms_declared: None,
        rms: None,
    };
    let rounding = of_rounding(rows);
    for axis in loaded {
        let of_axis: Vec<ClampedRow> = rows.iter().filter(|row| row.axis == axis).copied().collect();
        if goes_against(&of_axis, rounding[axis - 1]) {
            return Err(Error::AgainstTheLoads(format!(
                "axis {axis} deflects against its torque (rows from line {}): check the signs",
                of_axis[0].line
            )));
        }
        add(&mut found, &own, &Campaign { data: Data::Clamped(of_axis), ..campaign.clone() }, rounding[axis - 1])?;
    }
    enough(rows)?;
    found.left_out.sort_unstable();
    if is_readable(&found.description) { Ok(found) } else { Err(Error::NoDescription) }
}

/// Adds what the rows of one axis say; `least` is the variance of their rounding.
fn add(found: &mut Identification, own: &[Declared], campaign: &Campaign, least: f64) -> Result<(), Error> {
    let case = Case::new(campaign, &campaign.robot);
    let alone = Alone::fitted(&case, &campaign.robot, least).ok_or(Error::NotFinite)?;
    let place = |number: &Declared| own.iter().position(|of| of.what == number.what);
    let places: Vec<Option<usize>> = alone.own.iter().map(place).collect();
    let correlation = alone.correlation();
    for (k, at) in places.iter().enumerate().filter_map(|(k, at)| Some((k, (*at)?))) {
        let mut estimate = estimate(&campaign.robot, &alone, k);
        if let Visibility::Confounded(others) = &mut estimate.visibility {
            *others = others.iter().filter_map(|&other| places[other]).collect();
        }
        found.estimates[at] = estimate;
        for (other, place) in places.iter().enumerate() {
            if let Some(place) = *place {
                found.correlation[(at, place)] = correlation[(k, other)];
            }
        }
    }
    for k in alone.seen() {
        found.description = with_value(found.description.clone(), &alone.own[k], alone.value(k));
    }
    let lines = &case.observation.readings().lines;
    found.left_out.extend(alone.outliers().iter().map(|&row| lines[row]));
    Ok(())
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

/// Whether an axis deflects against its torque: a sign is wrong in most of its rows, an outlying reading
/// in one. Of an axis that does not move, readings may be a step off on either side; `rounding` is
/// their variance by that.
fn goes_against(rows: &[ClampedRow], rounding: f64) -> bool {
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
