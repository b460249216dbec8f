//! The arm goes on yielding under its load: what a model's elastic effects do
//! grows by `share log(1 + t / tau)` with the time since the visit began, or
//! with the number of rows where the file tells no time.

use std::vec::Vec;

use nalgebra::DVector;

use super::{Form, Kind, Number, Offers, Place, Scene};
use crate::identify::samples::since;

/// The kind.
pub static KIND: Kind = Kind {
    name: "creep",
    of_rig: true,
    words: |_| "creep under load".into(),
    offer,
};

/// The times tried at which it begins, as shares of the longest visit.
const BEGINNINGS: [f64; 3] = [0.01, 0.1, 1.0];

/// Beyond this share it is no creep (1).
const MOST: f64 = 0.3;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let since = since(scene.data);
    let longest = since.iter().copied().fold(0.0, f64::max);
    if longest == 0.0 {
        return offers.invisible(Place::Rig);
    }
    let unit = if scene.data.rows.iter().all(|row| row.time.is_some()) { "s" } else { "row" };
    let beginnings = BEGINNINGS.map(|share| share * longest);
    let number = |tau: f64| {
        let since = since.clone();
        let number = Number::of_setup(
            "share",
            "1",
            MOST,
            move |setup, share| {
                // Two at once do not occur: a candidate has one of its forms.
                setup.creep = [setup.creep[0] + share, tau];
            },
            move |point, _| {
                let axes = point.samples.axes;
                DVector::from_fn(point.elastic.len(), |i, _| {
                    let row = i / axes;
                    point.elastic[i] / point.samples.rows[row].growth * (since[row] / tau).ln_1p()
                })
            },
        );
        Number { range: [0.0, MOST], ..number }
    };
    let numbers: Vec<Number> = beginnings.map(number).into();
    let forms = (0..).zip(beginnings).map(|(k, tau)| Form::of([k]).with("tau", tau, unit)).collect();
    offers.add(Place::Rig, numbers, forms);
}
