//! The readings drift, in a direction of its own, with the time or the
//! temperature: since the visit's unloaded reading where each visit has its
//! own, or since the campaign began where none is taken again.

use std::vec::Vec;

use nalgebra::Vector3;

use super::{Form, IN_BASE, Kind, Number, Offers, Place, Scene};
use crate::campaign::{Displacements, Observation};

/// The kind.
pub static KIND: Kind = Kind {
    name: "thermal_drift",
    of_rig: true,
    words: |_| "a drift of the readings".into(),
    offer,
};

/// More than this over a campaign is a mishap (m).
const MOST: f64 = 5e-3;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let clocks = clocks(scene.data);
    let number = |(k, clock): (usize, &Clock)| {
        let largest = clock.values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let (values, most) = (clock.values.clone(), MOST / largest);
        Number::of_reading(IN_BASE[k], clock.unit, [-most, most], move |point| {
            point.of_reading(|row| Vector3::ith(k, values[row]))
        })
    };
    let numbers: Vec<Number> =
        clocks.iter().flat_map(|clock| (0..3).map(move |k| (k, clock))).map(number).collect();
    let forms = (0..clocks.len()).map(|clock| Form::of(3 * clock..3 * clock + 3)).collect();
    offers.add(Place::Rig, numbers, forms);
}

/// What a drift may go with, by row.
struct Clock {
    values: Vec<f64>,
    unit: &'static str,
}

fn clocks(data: &Displacements) -> Vec<Clock> {
    let known = |of: fn(&Observation) -> Option<f64>| -> Option<Vec<f64>> { data.rows.iter().map(of).collect() };
    let order = || (0..data.rows.len()).map(|row| row as f64).collect::<Vec<f64>>();
    let sources = [
        (known(|row| row.time).map(|time| (time, "m/s")).or_else(|| Some((order(), "m/row")))),
        known(|row| row.temperature).map(|temperature| (temperature, "m/K")),
    ];
    let mut clocks: Vec<Clock> = Vec::new();
    for (values, unit) in sources.into_iter().flatten() {
        let mut first = std::vec![None; data.visits.len()];
        let since = |row: usize| values[row] - *first[data.rows[row].visit].get_or_insert(values[row]);
        let in_visit: Vec<f64> = (0..values.len()).map(since).collect();
        let step = pace(data, &values);
        // The unloaded reading came as long before the first as the others
        // after each other; or just before it.
        let with_step = in_visit.iter().map(|value| value + step).collect();
        let whole = values.iter().map(|value| value - values[0]).collect();
        for values in [with_step, in_visit, whole] {
            let varies = values.iter().any(|value: &f64| value.abs() > 0.0);
            let known = clocks.iter().any(|clock| clock.values == values);
            if varies && !known {
                clocks.push(Clock { values, unit });
            }
        }
    }
    clocks
}

/// The median step from one row of a visit to the next.
fn pace(data: &Displacements, values: &[f64]) -> f64 {
    let pairs = (1..values.len()).filter(|&row| data.rows[row].visit == data.rows[row - 1].visit);
    let mut steps: Vec<f64> = pairs.map(|row| values[row] - values[row - 1]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(0.0)
}
