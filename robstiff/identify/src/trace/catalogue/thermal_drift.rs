//! The readings drift, in a direction of its own, with the time, with the
//! temperature, or as something that settles; since the visit's unloaded reading
//! where each visit takes its own, or since the campaign began where none is
//! taken again. Where the unloaded readings were taken in a round before, they
//! have drifted among themselves by what no row tells; an offset, and what grows
//! from visit to visit up to its third power, take most of that up. What they do
//! not, of a drift with a temperature that nobody wrote down then, makes its rate
//! and all else less sure: by as much as temperatures do that went up and down as
//! those of the rows did, at any other part of the campaign.

use std::rc::Rc;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Vector3};

use super::{Form, Kind, Number, Offers, Place, SHIFT, Scene};
use crate::campaign::{Displacements, apart};
use crate::trace::clamped::{Axes, AxisNumber, OnAxes, axes_column};
use crate::trace::found::{EffectParameter, Found};

/// The kind.
pub static KIND: Kind = Kind {
    name: "thermal_drift",
    of_rig: true,
    words: |found| if stands_still(found) { "an offset of the readings" } else { "a drift of the readings" }.into(),
    explanation: "The readings move while nothing pulls: the robot or the stand of the tracker warms up, or settles. \
        Warm up before, read the unloaded arm at every visit, and mix the order of poses.",
    offer,
    on_axes: Some(on_axes),
};

/// More than this over a campaign is a mishap (m); of an axis that turns (rad).
const MOST: f64 = 5e-3;
const MOST_TURN: f64 = 5e-3;

/// Numbers within so many standard deviations of zero are none.
const NONE: f64 = 2.0;

/// Whether readings are off that do not drift: their rates are zero, and with them all that
/// grows, but not the offset.
fn stands_still(found: &Found) -> bool {
    let is_one_of =
        |names: &[&[&str; 3]], number: &EffectParameter| names.iter().any(|names| names.contains(&number.name));
    let is_none = |number: &&EffectParameter| number.std.is_some_and(|std| number.value.abs() < NONE * std);
    let mut moves = found.parameters.iter().filter(|number| is_one_of(&[&SHIFT, &BY_VISIT, &SQUARED, &CUBED], number));
    let mut offsets = found.parameters.iter().filter(|number| is_one_of(&[&OFFSET], number));
    moves.all(|number| is_none(&number)) && offsets.any(|number| !is_none(&number))
}

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let mut numbers: Vec<Number> = Vec::new();
    let mut add = |three: Vec<Number>| -> Vec<usize> {
        numbers.extend(three);
        (numbers.len() - 3..numbers.len()).collect()
    };
    let offset = add(three(OFFSET, "m", &std::vec![1.0; scene.data.rows.len()]));
    let visits: Vec<f64> = scene.data.rows.iter().map(|row| row.visit as f64).collect();
    let order = add(three(BY_VISIT, "m/visit", &visits));
    // From -1 to 1 over the campaign.
    let middle = 0.5 * (scene.data.visits.len() - 1) as f64;
    let power =
        |power: i32| -> Vec<f64> { visits.iter().map(|visit| (visit / middle.max(1.0) - 1.0).powi(power)).collect() };
    let squared = add(three(SQUARED, "m", &power(2)));
    let cubed = add(three(CUBED, "m", &power(3)));
    let mut forms: Vec<Form> = Vec::new();
    let (clock_of, _) = scene.data.clock();
    for course in courses(scene.data) {
        let since = |before: &Rc<Vec<f64>>| {
            let (at, before, law, unit) = (Rc::clone(&course.at), Rc::clone(before), course.law, course.unit);
            move |constant: f64| {
                let moved =
                    at.iter().zip(before.iter()).map(|(&at, &before)| law(at, constant) - law(before, constant));
                three(SHIFT, unit, &moved.collect::<Vec<f64>>())
            }
        };
        let mut form = |before: &Rc<Vec<f64>>| {
            let own = add(since(before)(course.settles.unwrap_or_default()));
            let form = Form::of(own);
            let Some(constant) = course.settles else { return form };
            let of = since(before);
            let [least, .., most] = CONSTANTS;
            form.with("constant", constant, "s").refined(move |shape| of(shape[0])).within([0.5 * least, 2.0 * most])
        };
        let whole = form(&Rc::new(std::vec![course.begins; course.at.len()]));
        let with = |more: &[&Vec<usize>]| {
            let mut form = whole.clone();
            form.numbers.extend(more.iter().copied().flatten());
            form
        };
        forms.push(form(&course.before_visit));
        if course.told {
            forms.extend([with(&[]), with(&[&offset]), with(&[&offset, &order])]);
        } else {
            let untold = elsewhen(scene.data, &clock_of, &course.at);
            let slow = with(&[&offset, &order, &squared, &cubed]);
            forms.push(slow.unsure(move |point, numbers| {
                let rate = Vector3::from_column_slice(&numbers[..3]);
                untold.iter().map(|warmth| point.of_reading(|row| rate * -warmth[row])).collect()
            }));
        }
        forms.extend(course.before_round.as_ref().map(form));
    }
    offers.add(Place::Rig, numbers, forms);
}

/// By so much, a number a row, in each direction of the base frame.
fn three(name: [&'static str; 3], unit: &'static str, values: &[f64]) -> Vec<Number> {
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let most = MOST / largest.max(f64::MIN_POSITIVE);
    let values: Rc<[f64]> = values.into();
    let number = |k: usize| {
        let values = Rc::clone(&values);
        Number::of_reading(name[k], unit, [-most, most], move |point| {
            point.of_reading(|row| Vector3::ith(k, values[row]))
        })
    };
    (0..3).map(number).collect()
}

const OFFSET: [&str; 3] = ["offset_x", "offset_y", "offset_z"];
const BY_VISIT: [&str; 3] = ["visit_x", "visit_y", "visit_z"];
const SQUARED: [&str; 3] = ["square_x", "square_y", "square_z"];
const CUBED: [&str; 3] = ["cube_x", "cube_y", "cube_z"];

/// Time constants tried of what settles, the shortest first (s).
pub const CONSTANTS: [f64; 3] = [1800.0, 3600.0, 7200.0];

/// What a drift may follow.
pub struct Course {
    /// The time or the temperature, by row.
    pub at: Rc<Vec<f64>>,
    /// The same at the unloaded reading of the row's visit, taken one step before
    /// its first row.
    pub before_visit: Rc<Vec<f64>>,
    /// The same where all unloaded readings were taken in a round before the
    /// first row, where there was time for that.
    pub before_round: Option<Rc<Vec<f64>>>,
    /// Whether the file tells how far it was whenever a reading was taken.
    pub told: bool,
    /// The same at the beginning of the campaign.
    pub begins: f64,
    /// How far the drift is, with a time constant.
    pub law: fn(f64, f64) -> f64,
    /// The unit of a rate.
    pub unit: &'static str,
    /// The time constant, where it settles.
    pub settles: Option<f64>,
}

/// What readings may drift with.
pub fn courses(data: &Displacements) -> Vec<Course> {
    let (clock, pace) = data.clock();
    let timed = data.rows.iter().all(|row| row.time.is_some());
    let first = |values: &[f64], step: &dyn Fn(usize) -> f64| -> Rc<Vec<f64>> {
        let mut first = std::vec![None; data.visits.len()];
        let before = |row: usize| *first[data.rows[row].visit].get_or_insert_with(|| values[row] - step(row));
        Rc::new((0..values.len()).map(before).collect())
    };
    let round = round(data, &clock, pace).filter(|_| timed).map(Rc::new);
    let before_visit = first(&clock, &|_| pace);
    // A file that tells the time tells it from the beginning on.
    let begins = if timed { 0.0_f64.min(clock[0]) } else { clock[0] };
    let clock = Rc::new(clock);
    let of_time = |law: fn(f64, f64) -> f64, unit, settles| Course {
        at: Rc::clone(&clock),
        before_visit: Rc::clone(&before_visit),
        before_round: round.clone(),
        told: true,
        begins,
        law,
        unit,
        settles,
    };
    let mut courses = match timed {
        true => std::vec![of_time(|time, _| time / 3600.0, "m/h", None)],
        false => std::vec![of_time(|row, _| row, "m/row", None)],
    };
    if timed {
        let settling = |&constant: &f64| of_time(|time, constant| -(-time / constant).exp_m1(), "m", Some(constant));
        courses.extend(CONSTANTS.iter().map(settling));
    }
    let temperature: Option<Vec<f64>> = data.rows.iter().map(|row| row.temperature).collect();
    if let Some(values) = temperature {
        // One step before the first row it was about as much colder as the
        // next is warmer.
        let slope = |row: usize| match values.get(row + 1) {
            Some(next) if data.rows[row + 1].visit == data.rows[row].visit => next - values[row],
            _ => 0.0,
        };
        courses.push(Course {
            before_visit: first(&values, &slope),
            before_round: None,
            told: false,
            begins: values[0],
            at: Rc::new(values),
            law: |warmth, _| warmth,
            unit: "m/K",
            settles: None,
        });
    }
    courses
}

/// The place of each visit among those that have rows, in the order in which they begin, from 0;
/// and how many these are.
fn in_order(data: &Displacements) -> (Vec<usize>, usize) {
    let mut place = std::vec![None; data.visits.len()];
    let mut count = 0;
    for row in &data.rows {
        if place[row.visit].is_none() {
            place[row.visit] = Some(count);
            count += 1;
        }
    }
    (place.into_iter().map(Option::unwrap_or_default).collect(), count)
}

/// When the unloaded reading of each row's visit was taken, if all were in a
/// round just before the first row, in the order of the visits, as far apart as
/// rows are.
fn round(data: &Displacements, clock: &[f64], pace: f64) -> Option<Vec<f64>> {
    let (place, count) = in_order(data);
    let pace = apart(clock, pace);
    let begin = clock[0] - pace * (count + 1) as f64;
    // Rounding aside, not before the clock was started.
    let started = begin > -1e-6 * clock.last()?.abs();
    let time = |row: &crate::campaign::Observation| begin + pace * (place[row.visit] + 1) as f64;
    started.then(|| data.rows.iter().map(time).collect())
}

/// Parts of the campaign that a round of unloaded readings is laid to.
const PARTS: usize = 24;

/// How warm the unloaded reading of each row's visit may have been, had the round
/// been at another part of the campaign, in the order of the visits and as far
/// apart as rows are, but for what grows slowly; the campaign goes round. Empty
/// where there is no clock.
fn elsewhen(data: &Displacements, clock: &[f64], warmth: &[f64]) -> Vec<Vec<f64>> {
    let (place, _) = in_order(data);
    let span = clock[clock.len() - 1] - clock[0];
    let Some(warmth) = wiggle(clock, warmth, span) else { return Vec::new() };
    let pace = span / (clock.len() - 1) as f64;
    let at = |time: f64| {
        let time = clock[0] + (time - clock[0]).rem_euclid(span);
        let next = clock.partition_point(|&known| known <= time).clamp(1, clock.len() - 1);
        let (from, to) = (clock[next - 1], clock[next]);
        let share = if to > from { (time - from) / (to - from) } else { 0.0 };
        warmth[next - 1] + share * (warmth[next] - warmth[next - 1])
    };
    let part = |part: usize| {
        let begin = clock[0] + span * part as f64 / PARTS as f64;
        data.rows.iter().map(|row| at(begin + pace * place[row.visit] as f64)).collect()
    };
    (0..PARTS).map(part).collect()
}

/// What the third power of time leaves of a temperature: what grows slowly is
/// taken up from visit to visit.
fn wiggle(clock: &[f64], warmth: &[f64], span: f64) -> Option<Vec<f64>> {
    if span <= 0.0 {
        return None;
    }
    let powers = DMatrix::from_fn(clock.len(), 4, |row, k| (2.0 * (clock[row] - clock[0]) / span - 1.0).powi(k as i32));
    let warmth = DVector::from_column_slice(warmth);
    let slow = powers.clone().svd(true, true).solve(&warmth, 1e-9).ok()?;
    Some((warmth - powers * slow).as_slice().to_vec())
}

/// From row to row since the unloaded reading of an axis, on all alike.
fn on_axes(axes: &Axes) -> Vec<OnAxes> {
    let count = axes.rows.len();
    let since: DVector<f64> = axes
        .loaded()
        .map(|axis| {
            let rows = axes.rows_of(axis);
            axes_column(count, &rows, rows.iter().map(|row| (row - rows[0] + 1) as f64))
        })
        .sum();
    // All axes of a campaign turn, or all slide.
    let turns = axes.loaded().all(|axis| axes.turn_unit(axis) == "rad");
    let (unit, over_all) = if turns { ("rad/row", MOST_TURN) } else { ("m/row", MOST) };
    let most = over_all / since.max().max(1.0);
    let numbers = [AxisNumber { name: "rate", unit, range: [-most, most] }].into();
    [OnAxes::new(Place::Rig, numbers, &[], [Vec::new()].into(), move |_| [since.clone()].into())].into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_offset_alone_is_no_drift() {
        let number = |name, value| EffectParameter { name, value, std: Some(1e-6), unit: "m" };
        let words = |rate: f64, offset: f64| {
            let rates = SHIFT.map(|name| number(name, rate));
            let offsets = OFFSET.map(|name| number(name, offset));
            Found::new(&KIND, Place::Rig, rates.into_iter().chain(offsets).collect()).words()
        };
        assert_eq!(words(5e-7, 1.5e-3), "an offset of the readings");
        assert_eq!(words(5e-6, 1.5e-3), "a drift of the readings");
        assert_eq!(words(5e-6, 0.0), "a drift of the readings");
    }
}
