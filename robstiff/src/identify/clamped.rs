//! Compliances axis by axis, the procedure of Abele, Weigold and Rothenbücher
//! (CIRP Annals 56/1, 2007): one gear is loaded at a time, those before it are
//! clamped, and the compliance is the slope of deflection over torque.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::DMatrix;

use super::baseline::{Visibility, declared, with_values};
use super::{Error, Estimate, Identification, element_name, unit_of};
use crate::campaign::{Campaign, ClampedRow};

/// Identifies the compliances of the axes that were loaded. Where a joint is
/// compound, the measurement sees the sum of its parts, which keep their
/// proportion.
///
/// # Errors
/// An axis whose deflection goes against its torque; rows that load no axis.
pub fn identify(campaign: &Campaign, rows: &[ClampedRow]) -> Result<Identification, Error> {
    let own = declared(&campaign.robot);
    let mut values: Vec<f64> = own.iter().map(|number| number.value).collect();
    let mut estimates = Vec::new();
    for (i, number) in own.iter().enumerate() {
        let of_axis: Vec<&ClampedRow> =
            rows.iter().filter(|row| number.effect.is_none() && row.axis == i + 1).collect();
        let slope = slope(&of_axis);
        if let Some((value, _)) = slope {
            if value < 0.0 {
                let line = of_axis[0].line;
                return Err(Error(format!(
                    "axis {} deflects against its torque (rows from line {line}): check the signs",
                    i + 1
                )));
            }
            values[i] = value;
        }
        estimates.push(Estimate {
            name: element_name(&campaign.robot, number),
            declared: number.value,
            value: values[i],
            std: slope.and_then(|(_, std)| std),
            unit: unit_of(&campaign.robot, number.column),
            visibility: if slope.is_some() { Visibility::Seen } else { Visibility::Unseen },
            // A slope against the load is an error above.
            at_bound: false,
        });
    }
    if estimates.iter().all(|estimate| estimate.visibility != Visibility::Seen) {
        return Err(Error(String::from("no row loads its axis: every torque is zero")));
    }
    Ok(Identification {
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

/// The slope through the origin and its standard deviation from the scatter of
/// the rows (none from a single row); `None` where nothing was loaded.
fn slope(rows: &[&ClampedRow]) -> Option<(f64, Option<f64>)> {
    let squares: f64 = rows.iter().map(|row| row.torque * row.torque).sum();
    if squares == 0.0 {
        return None;
    }
    let slope = rows.iter().map(|row| row.torque * row.deflection).sum::<f64>() / squares;
    let left: f64 = rows.iter().map(|row| (row.deflection - slope * row.torque).powi(2)).sum();
    let std = (rows.len() > 1).then(|| (left / (rows.len() - 1) as f64 / squares).sqrt());
    Some((slope, std))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(torque: f64, deflection: f64) -> ClampedRow {
        ClampedRow { line: 2, axis: 1, torque, deflection }
    }

    #[test]
    fn the_slope_goes_through_the_origin() {
        let rows = [row(100.0, 3e-5), row(-200.0, -6e-5), row(300.0, 9e-5)];
        let (value, std) = slope(&rows.each_ref()).expect("loaded");
        assert!((value - 3e-7).abs() < 1e-18 && std.expect("three rows") < 1e-18);
        assert_eq!(slope(&[&row(100.0, 1e-5)]).expect("loaded").1, None);
        assert_eq!(slope(&[&row(0.0, 1e-5)]), None);
        assert_eq!(slope(&[]), None);
    }

    #[test]
    fn scatter_makes_the_standard_deviation() {
        // Residuals -1, 2, -1 about slope 2 at torques 1, 2, 3 would not be
        // orthogonal to the torques; 1, -2, 1 at torques 1, 2, 3 are.
        let rows = [row(1.0, 3.0), row(2.0, 2.0), row(3.0, 7.0)];
        let (value, std) = slope(&rows.each_ref()).expect("loaded");
        assert!((value - 2.0).abs() < 1e-12);
        assert!((std.expect("three rows") - (6.0_f64 / 2.0 / 14.0).sqrt()).abs() < 1e-12);
    }
}
