//! A link that grows as the arm warms up, along itself, wherever that points: the TCP moves by
//! `growth` times the course of the time or the temperature since the unloaded reading, in the
//! direction in which the link's lengths `a` and `d` move it, in proportion to these.

use std::format;
use std::rc::Rc;
use std::vec::Vec;

use nalgebra::Vector3;
use robstiff_robots::Convention;

use super::super::thermal_drift::{CONSTANTS, Course, courses};
use super::super::{Form, Kind, Number, Offers, Part, Scene};
use crate::identify::setup::Setup;

/// The kind.
pub static KIND: Kind = Kind {
    name: "link_growth",
    of_rig: false,
    words: |found| format!("a growth of {} with warmth or time", found.place()),
    explanation: "",
    offer,
    on_axes: None,
};

/// Step of the differences, a part of the link's length.
const STEP: f64 = 1e-4;

/// A part of its length by which no link grows in a campaign.
const MOST: f64 = 5e-3;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let courses = courses(scene.data);
    for (index, joint) in scene.description.joints.iter().enumerate() {
        if joint.a.hypot(joint.d) == 0.0 {
            continue;
        }
        let along = direction(scene, index);
        let (mut numbers, mut forms) = (Vec::new(), Vec::new());
        for course in &courses {
            offer_course(scene, course, &along, &mut numbers, &mut forms);
        }
        offers.add(place(scene.description.convention, index), numbers, forms);
    }
}

/// What has the lengths of a row of the table, from 0: in the modified convention the link
/// before its joint, of the first joint the base.
fn place(convention: Convention, row: usize) -> Part {
    match (convention, row) {
        (Convention::Standard, _) => Part::Link(row + 1),
        (Convention::Modified, 0) => Part::Base,
        (Convention::Modified, _) => Part::Link(row),
    }
}

/// How the TCP moves in the base frame as a link, from 0, grows by its own length, by row (m).
fn direction(scene: &Scene<'_>, link: usize) -> Rc<[Vector3<f64>]> {
    let joint = &scene.description.joints[link];
    let [there, back] = [STEP, -STEP].map(|step| {
        let mut setup = Setup::as_declared(scene.joints());
        setup.table[link][1] = step * joint.d;
        setup.table[link][2] = step * joint.a;
        scene.samples.with_setup(scene.description, scene.data, &setup)
    });
    let moved = there.rows.iter().zip(&back.rows).map(|(there, back)| {
        let moved = (there.tcp - back.tcp) / (2.0 * STEP);
        moved.fixed_view::<3, 1>(0, 3).into_owned()
    });
    moved.collect()
}

/// The forms of a course: since the visit's own unloaded reading, since one at the beginning, or,
/// where nobody wrote down how warm it was at the unloaded readings, since something that changed
/// slowly from visit to visit.
fn offer_course(
    scene: &Scene<'_>,
    course: &Course,
    along: &Rc<[Vector3<f64>]>,
    numbers: &mut Vec<Number>,
    forms: &mut Vec<Form>,
) {
    let mut add = |name, values: Rc<[f64]>| {
        numbers.push(number(name, course.unit, values, along));
        numbers.len() - 1
    };
    let since = |before: &Rc<Vec<f64>>| {
        let (at, before, law) = (Rc::clone(&course.at), Rc::clone(before), course.law);
        move |constant: f64| -> Rc<[f64]> {
            at.iter().zip(before.iter()).map(|(&at, &before)| law(at, constant) - law(before, constant)).collect()
        }
    };
    let whole = Rc::new(std::vec![course.begins; course.at.len()]);
    let befores = [Some(&course.before_visit), course.before_round.as_ref(), Some(&whole)];
    let mut last = 0;
    for before in befores.into_iter().flatten() {
        last = add("growth", since(before)(course.settles.unwrap_or_default()));
        let form = Form::of([last]);
        forms.push(match course.settles {
            None => form,
            Some(constant) => {
                let (of, along, unit) = (since(before), Rc::clone(along), course.unit);
                let refined = move |shape: &[f64]| std::vec![number("growth", unit, of(shape[0]), &along)];
                let [least, .., most] = CONSTANTS;
                form.with("constant", constant, "s").refined(refined).within([0.5 * least, 2.0 * most])
            }
        });
    }
    if !course.told {
        let middle = 0.5 * (scene.data.visits.len() - 1) as f64;
        let place = |row: usize| scene.data.rows[row].visit as f64 / middle.max(1.0) - 1.0;
        let power = |power: i32| (0..scene.data.rows.len()).map(|row| place(row).powi(power)).collect();
        let slow = (0..=3).map(|k| add("visit", power(k))).collect::<Vec<usize>>();
        forms.push(Form::of([last].into_iter().chain(slow)));
    }
}

/// By so much, a number a row, along a direction a row.
fn number(name: &'static str, unit: &'static str, values: Rc<[f64]>, along: &Rc<[Vector3<f64>]>) -> Number {
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let most = MOST / largest.max(f64::MIN_POSITIVE);
    let along = Rc::clone(along);
    Number::of_reading(name, unit, [-most, most], move |point| point.of_reading(|row| along[row] * values[row]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As a description counts its links.
    #[test]
    fn lengths_are_of_the_link_that_has_them() {
        assert_eq!([0, 2].map(|row| place(Convention::Standard, row)), [Part::Link(1), Part::Link(3)]);
        assert_eq!([0, 2].map(|row| place(Convention::Modified, row)), [Part::Base, Part::Link(2)]);
    }
}
