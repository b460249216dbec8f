//! Compliances axis by axis, the procedure of Abele, Weigold and Rothenbücher
//! (CIRP Annals 56/1, 2007): one gear is loaded at a time, those before it are
//! clamped, and the compliance is the slope of deflection over torque.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::baseline::{Visibility, declared, with_values};
use super::uncertainty::{WITHIN, student};
use super::whitening::mean_share;
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
        let here = |row: &&ClampedRow| number.effect.is_none() && row.axis == i + 1;
        let of_axis: Vec<&ClampedRow> = rows.iter().filter(here).collect();
        let slope = slope(&of_axis);
        let work: f64 = rows.iter().filter(here).map(|row| row.torque * row.deflection).sum();
        if work < 0.0 {
            let line = of_axis[0].line;
            return Err(Error(format!(
                "axis {} deflects against its torque (rows from line {line}): check the signs",
                i + 1
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

/// The slope through the origin of rows that share one unloaded reading, and its
/// standard deviation from their scatter (none from a single row); `None` where
/// nothing was loaded. The standard deviation is told as
/// [`uncertainty`](super::uncertainty) tells it.
fn slope(rows: &[&ClampedRow]) -> Option<(f64, Option<f64>)> {
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
        (left / freedom / squares).sqrt() * student(freedom) / WITHIN
    });
    Some((slope, std))
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::campaign::made::normal;

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
        // 1, -2, 1 about slope 2 at torques 1, 2, 3: orthogonal to the torques, and
        // without a mean, so of it the unloaded reading has nothing. Of the torques'
        // 14 it takes 6^2 / (1 + 3). The quantile is that of two degrees of freedom.
        let rows = [row(1.0, 3.0), row(2.0, 2.0), row(3.0, 7.0)];
        let (value, std) = slope(&rows.each_ref()).expect("loaded");
        assert!((value - 2.0).abs() < 1e-12);
        let expected = (6.0_f64 / 2.0 / (14.0 - 9.0)).sqrt() * 4.302_652_73 / 1.959_963_98;
        assert!((std.expect("three rows") / expected - 1.0).abs() < 1e-8);
    }

    /// Whatever the number of rows, 1.96 standard deviations are the 95 % interval.
    #[test]
    fn intervals_hold_what_they_say() {
        let mut random = ChaCha8Rng::seed_from_u64(31);
        let runs = 2000;
        for torques in [&[400.0, 800.0][..], &[200.0, 400.0, 600.0], &[-800.0, -400.0, 200.0, 400.0, 600.0, 800.0]] {
            let within = (0..runs).filter(|_| {
                let unloaded = normal(&mut random);
                let mut read = |torque: &f64| row(*torque, 0.03 * torque + normal(&mut random) - unloaded);
                let rows: Vec<ClampedRow> = torques.iter().map(&mut read).collect();
                let (value, std) = slope(&rows.iter().collect::<Vec<_>>()).expect("loaded");
                (value - 0.03).abs() <= WITHIN * std.expect("two rows or more")
            });
            let share = within.count() as f64 / f64::from(runs);
            assert!((share - 0.95).abs() < 0.02, "{share} at {torques:?}");
        }
    }
}
