//! What is read moves while nothing is changed: with the time or the temperature, where
//! these are known, or as something that settles; all of it alike, or as an arm that grows
//! and a tool that does not.

use std::boxed::Box;
use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;

use super::offers::{Between, Form, Number, Offer, any};
use super::rig::{LONGEST, Rig, longer};
use crate::campaign::{PositionRow, Positions};
use crate::identify::positions::model::{Enters, Moved};
use crate::trace::catalogue::{SHIFT, THERMAL_DRIFT};
use crate::trace::found::{EffectParameter, Place};

/// No arm grows by more in a campaign, forty kelvin of aluminium (1).
const MOST_GROWTH: f64 = 1e-3;

/// Time constants of what settles that are tried, and the least and the most that are
/// looked for between them, as parts of the time that the campaign took: what takes longer
/// is a line.
const CONSTANTS: [f64; 4] = [1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0];
const SHORTEST: f64 = 1.0 / 64.0;
const SLOWEST: f64 = 1.0;

/// So many rows are read, one after another, before what settles is through with the most of it:
/// what has settled sooner is a constant, and a few rows beside it that may be wild.
const ROWS_SETTLING: usize = 4;

/// What the numbers of a motion do along a course.
type Along = Rc<dyn Fn(&[f64]) -> Vec<Enters>>;

/// Something that drifts, along a course that has a number a row.
struct Motion {
    names: &'static [&'static str],
    /// In all, a second, a kelvin.
    units: [&'static str; 3],
    /// It does not go farther.
    most: f64,
    along: Along,
}

impl Motion {
    /// Everything alike.
    fn shift() -> Self {
        Self {
            names: &SHIFT,
            units: ["m", "m/s", "m/K"],
            most: LONGEST,
            along: Rc::new(|course| shifted(course).into()),
        }
    }

    /// The arm, from frame 0 on.
    fn growth(rig: &Rig) -> Self {
        let spans = Rc::clone(&rig.spans);
        let along = Rc::new(move |course: &[f64]| vec![longer(&spans, course)]);
        Self { names: &["expansion"], units: ["1", "1/s", "1/K"], most: MOST_GROWTH, along }
    }

    /// Its numbers along a course, in one of the units.
    fn numbers(&self, course: &[f64], unit: usize) -> Vec<Number> {
        let (unit, most) = (self.units[unit], self.most / farthest(course));
        let number = |(&name, enters)| Number { name, unit, range: [-most, most], enters };
        self.names.iter().zip((self.along)(course)).map(number).collect()
    }

    /// Adds that it settles, `1 - exp(-time / constant)`.
    fn settles(&self, time: &Rc<[f64]>, numbers: &mut Vec<Number>, forms: &mut Vec<Form>) {
        let took = farthest(time);
        let shortest = shortest(time);
        let time = Rc::clone(time);
        let settled = Rc::new(move |constant: f64| -> Vec<f64> {
            time.iter().map(|time| -(-time / constant).exp_m1()).collect()
        });
        for constant in CONSTANTS.map(|part| part * took).into_iter().filter(|constant| *constant >= shortest) {
            let (first, own) = (numbers.len(), self.numbers(&settled(constant), 0));
            let (along, settled) = (Rc::clone(&self.along), Rc::clone(&settled));
            let enters = Rc::new(move |constant| along(&settled(constant)));
            let between = Between { range: [shortest, SLOWEST * took], whole: took, enters };
            let shape = vec![EffectParameter { name: "constant", value: constant, std: None, unit: "s" }];
            forms.push(Form { shape, between: Some(between), ..Form::of(first..first + own.len()) });
            numbers.extend(own);
        }
    }
}

impl Rig {
    /// A drift of what is read.
    pub fn drift(&self, data: &Positions) -> Option<Offer> {
        let motions = [Motion::shift(), Motion::growth(self)];
        let (mut numbers, mut forms) = (Vec::new(), Vec::new());
        let (time, temperature) = (above_least(data, |row| row.time), above_least(data, |row| row.temperature));
        for (unit, course) in [(1, &time), (2, &temperature)] {
            let Some(course) = course else { continue };
            let first = numbers.len();
            numbers.extend(motions.iter().flat_map(|motion| motion.numbers(course, unit)));
            forms.extend([first..first + 3, first + 3..first + 4, first..first + 4].map(Form::of));
        }
        if let Some(time) = time.map(Rc::<[f64]>::from) {
            motions.iter().for_each(|motion| motion.settles(&time, &mut numbers, &mut forms));
        }
        let (kind, place) = (&THERMAL_DRIFT, Place::Rig);
        (!forms.is_empty()).then_some(Offer { kind, place, numbers, forms, possible: any() })
    }
}

/// By how much something that all rows know is more than the least of it, if it changes.
fn above_least(data: &Positions, of: fn(&PositionRow) -> Option<f64>) -> Option<Vec<f64>> {
    let values: Vec<f64> = data.rows.iter().map(of).collect::<Option<_>>()?;
    let first = values.iter().copied().fold(f64::INFINITY, f64::min);
    let since: Vec<f64> = values.iter().map(|value| value - first).collect();
    (farthest(&since) > 0.0).then_some(since)
}

/// The shortest time constant that rows tell from a constant.
fn shortest(time: &[f64]) -> f64 {
    let mut moments = time.to_vec();
    moments.sort_by(f64::total_cmp);
    // Rows of one moment are one.
    moments.dedup();
    let settling = moments.get(ROWS_SETTLING).copied().unwrap_or(f64::INFINITY);
    settling.max(SHORTEST * farthest(time))
}

/// How far a course goes.
fn farthest(course: &[f64]) -> f64 {
    course.iter().copied().fold(0.0, f64::max)
}

/// What is read moves along each axis of the base frame, by so much in each row.
fn shifted(by_row: &[f64]) -> [Enters; 3] {
    let last = by_row.last().copied().unwrap_or_default();
    core::array::from_fn(|k| {
        Enters::Reading(Rc::new(Moved {
            rows: by_row.iter().map(|by| Vector3::ith(k, *by)).collect(),
            later: Box::new(move |_| Vector3::ith(k, last)),
        }))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Something that has settled by the second row is a constant, whatever part of the
    /// campaign that took.
    #[test]
    fn what_settles_takes_several_rows() {
        let even: Vec<f64> = (0..60).map(|row| 30.0 * f64::from(row)).collect();
        assert_eq!(shortest(&even), 120.0);
        // Payloads of a visit may be read at one moment.
        let loaded: Vec<f64> = (0..60).map(|row| 30.0 * f64::from(row / 3)).collect();
        assert_eq!(shortest(&loaded), 120.0);
        // Where rows are many, so is what a part of the campaign has.
        let many: Vec<f64> = (0..641).map(f64::from).collect();
        assert_eq!(shortest(&many), 10.0);
        assert_eq!(shortest(&[0.0, 1.0, 2.0]), f64::INFINITY);
    }
}
