//! A gear or belt that gives way more as it warms up: the joint turns by `h (1 + share T) tau`
//! with the temperature `T` above that of the first row, or with the time.

use std::format;
use std::rc::Rc;
use std::vec::Vec;

use super::super::{Form, Kind, Number, Offers, Part, Scene, place_words};

/// The kind.
pub static KIND: Kind = Kind {
    name: "warm_compliance",
    of_rig: false,
    words: |found| format!("a compliance of {} that changes as it warms up", place_words(found)),
    explanation: "",
    offer,
    on_axes: None,
};

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let rows = &scene.data.rows;
    let since_the_first = |values: Vec<f64>| -> Rc<[f64]> { values.iter().map(|value| value - values[0]).collect() };
    let temperature: Option<Vec<f64>> = rows.iter().map(|row| row.temperature).collect();
    let (clock, _) = scene.data.clock();
    let hours = clock.iter().map(|time| time / 3600.0).collect();
    let courses: Vec<(&str, Rc<[f64]>)> = temperature
        .map(|kelvin| ("1/K", since_the_first(kelvin)))
        .into_iter()
        .chain([("1/h", since_the_first(hours))])
        .collect();
    for joint in (1..=scene.joints()).filter(|&joint| scene.largest_torque(joint).is_some()) {
        let number = |(unit, course): &(&'static str, Rc<[f64]>)| {
            let course = Rc::clone(course);
            let number = Number::elastic("share", unit, [f64::NEG_INFINITY, f64::INFINITY], move |point| {
                let torques = point.torques(joint);
                point.of_joint(joint, |row| course[row] * torques[row])
            });
            Number { share_of: Some(joint), ..number }
        };
        let forms = (0..courses.len()).map(|k| Form::of([k])).collect();
        offers.add(Part::Joint(joint), courses.iter().map(number).collect(), forms);
    }
}
