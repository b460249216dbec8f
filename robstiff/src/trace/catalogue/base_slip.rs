//! The robot, or what measures it, shifted at some moment: every reading after
//! it that is held against an unloaded reading from before it has the shift.
//! A slip within a visit is found with what is wrong in single visits; here are
//! those that all later rows keep, of which the unloaded readings know nothing.

use std::format;
use std::vec::Vec;

use nalgebra::Vector3;

use super::{Form, IN_BASE, Kind, Number, Offers, Place, Scene};

/// The kind.
pub static KIND: Kind = Kind {
    name: "base_slip",
    // A shift of the whole robot is no property of it.
    of_rig: true,
    words: |found| format!("a slip of the base before line {}", found.value("line")),
    offer,
};

/// A longer way is a move (m).
const MOST: f64 = 5e-3;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let number = |(moment, k): (usize, usize)| {
        Number::of_reading(IN_BASE[k], "m", [-MOST, MOST], move |point| {
            point.of_reading(|row| if row >= moment { Vector3::ith(k, 1.0) } else { Vector3::zeros() })
        })
    };
    let numbers: Vec<Number> = scene.moments.iter().flat_map(|&m| (0..3).map(move |k| (m, k))).map(number).collect();
    let form = |(i, &moment): (usize, &usize)| {
        Form::of(3 * i..3 * i + 3).with("line", scene.data.rows[moment].line as f64, "1")
    };
    let forms: Vec<Form> = scene.moments.iter().enumerate().map(form).collect();
    if !forms.is_empty() {
        offers.add(Place::Base, numbers, forms);
    }
}
