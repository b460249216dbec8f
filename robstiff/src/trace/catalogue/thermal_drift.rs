//! The readings drift, in a direction of its own, with the time, with the
//! temperature, or as something that settles; since the visit's unloaded reading
//! where each visit takes its own, or since the campaign began where none is
//! taken again. Where the unloaded readings were taken in a round before, they
//! have drifted among themselves by what no row tells; an offset, and one that
//! grows from visit to visit, take that up.

use std::vec::Vec;

use nalgebra::Vector3;

use super::{Form, Kind, Number, Offers, Place, SHIFT, Scene};
use crate::campaign::Displacements;
use crate::trace::point::clock;

/// The kind.
pub static KIND: Kind = Kind {
    name: "thermal_drift",
    of_rig: true,
    words: |_| "a drift of the readings".into(),
    explanation: "The readings move while nothing pulls: the robot or the stand of the tracker warms up, or settles. \
        Warm up before, read the unloaded arm at every visit, and mix the order of poses.",
    offer,
};

/// More than this over a campaign is a mishap (m).
const MOST: f64 = 5e-3;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let mut numbers: Vec<Number> = Vec::new();
    let mut three = |name: [&'static str; 3], values: Vec<f64>, unit: &'static str| -> Vec<usize> {
        let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let most = MOST / largest.max(f64::MIN_POSITIVE);
        let number = |k: usize| {
            let values = values.clone();
            Number::of_reading(name[k], unit, [-most, most], move |point| {
                point.of_reading(|row| Vector3::ith(k, values[row]))
            })
        };
        numbers.extend((0..3).map(number));
        (numbers.len() - 3..numbers.len()).collect()
    };
    let offset = three(OFFSET, std::vec![1.0; scene.data.rows.len()], "m");
    let visits = scene.data.rows.iter().map(|row| row.visit as f64).collect();
    let order = three(BY_VISIT, visits, "m/visit");
    let mut forms: Vec<Form> = Vec::new();
    for course in courses(scene.data) {
        let from = |before: &[f64]| course.values.iter().zip(before).map(|(value, before)| value - before).collect();
        let in_visit = three(SHIFT, from(&course.before_visit), course.unit);
        let whole = three(SHIFT, from(&std::vec![course.begins; course.values.len()]), course.unit);
        let with = |more: &[&Vec<usize>]| {
            let form = Form::of(whole.iter().chain(more.iter().copied().flatten()).copied());
            course.settles.map_or(form.clone(), |constant| form.with("constant", constant, "s"))
        };
        forms.extend([Form::of(in_visit), with(&[]), with(&[&offset]), with(&[&offset, &order])]);
        if let Some(before) = &course.before_round {
            let in_round = three(SHIFT, from(before), course.unit);
            let form = Form::of(in_round);
            forms.push(course.settles.map_or(form.clone(), |constant| form.with("constant", constant, "s")));
        }
    }
    offers.add(Place::Rig, numbers, forms);
}

const OFFSET: [&str; 3] = ["offset_x", "offset_y", "offset_z"];
const BY_VISIT: [&str; 3] = ["visit_x", "visit_y", "visit_z"];

/// Time constants tried of what settles (s).
const CONSTANTS: [f64; 3] = [1800.0, 3600.0, 7200.0];

/// What a drift may follow, by row.
struct Course {
    values: Vec<f64>,
    /// At the unloaded reading of the row's visit, taken one step before its
    /// first row.
    before_visit: Vec<f64>,
    /// At the unloaded reading of the row's visit, all of which were taken in a
    /// round before the first row, where there was time for that.
    before_round: Option<Vec<f64>>,
    /// At the beginning of the campaign.
    begins: f64,
    unit: &'static str,
    /// The time constant, where it settles.
    settles: Option<f64>,
}

fn courses(data: &Displacements) -> Vec<Course> {
    let (clock, pace) = clock(data);
    let timed = data.rows.iter().all(|row| row.time.is_some());
    let first = |values: &[f64], step: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let mut first = std::vec![None; data.visits.len()];
        let before = |row: usize| *first[data.rows[row].visit].get_or_insert_with(|| values[row] - step(row));
        (0..values.len()).map(before).collect()
    };
    let round = round(data, &clock, pace).filter(|_| timed);
    let of_time = |law: &dyn Fn(f64) -> f64, unit, settles| Course {
        before_round: round.as_ref().map(|times| times.iter().map(|&time| law(time)).collect()),
        values: clock.iter().map(|&time| law(time)).collect(),
        before_visit: first(&clock, &|_| pace).into_iter().map(law).collect(),
        // A file that tells the time tells it from the beginning on.
        begins: law(if timed { 0.0_f64.min(clock[0]) } else { clock[0] }),
        unit,
        settles,
    };
    let hours = if timed { 1.0 / 3600.0 } else { 1.0 };
    let mut courses = std::vec![of_time(&|time| time * hours, if timed { "m/h" } else { "m/row" }, None)];
    if timed {
        let settling = |&constant: &f64| of_time(&|time: f64| -(-time / constant).exp_m1(), "m", Some(constant));
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
        let before_visit = first(&values, &slope);
        let begins = values[0];
        courses.push(Course { before_visit, before_round: None, begins, values, unit: "m/K", settles: None });
    }
    courses
}

/// When the unloaded reading of each row's visit was taken, if all were in a
/// round just before the first row, in the order of the visits, as far apart as
/// rows are.
fn round(data: &Displacements, clock: &[f64], pace: f64) -> Option<Vec<f64>> {
    let mut place = std::vec![None; data.visits.len()];
    let mut count = 0;
    for row in &data.rows {
        place[row.visit].get_or_insert_with(|| {
            count += 1;
            count
        });
    }
    // Where every row is a visit, no two rows of one tell how far apart.
    let pace = if pace > 0.0 { pace } else { (clock.last()? - clock[0]) / (clock.len().max(2) - 1) as f64 };
    let begin = clock[0] - pace * (count + 1) as f64;
    // Rounding aside, not before the clock was started.
    let started = begin > -1e-6 * clock.last()?.abs();
    let time = |row: &crate::campaign::Observation| begin + pace * place[row.visit].unwrap_or(0) as f64;
    started.then(|| data.rows.iter().map(time).collect())
}
