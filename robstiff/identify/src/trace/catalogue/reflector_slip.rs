//! The reflector moved on the tool at some moment: every reading from then on is of
//! another point, off by a shift in the tool frame. Absolute positions see that at once,
//! displacements where the unloaded reading was before it. A slip within a visit is
//! found with what is wrong in single visits; here are those that all later rows keep.

use std::format;
use std::vec::Vec;

use nalgebra::Vector3;

use super::{Form, Kind, Number, Offers, Place, SHIFT, Scene};
use crate::identify::samples::turn_of;
use crate::trace::slip::{Moment, SLIPPED_AT, Slipping};

/// The kind.
pub static KIND: Kind = Kind {
    name: "reflector_slip",
    of_rig: true,
    words: |found| format!("a slip of the reflector on the tool before line {}", found.value(SLIPPED_AT)),
    explanation: "The reflector moved in its nest, or the nest on the tool, between two readings. Fix it, and measure \
        the points anew from there on.",
    offer,
    on_axes: None,
};

/// A longer way is another place (m).
const MOST: f64 = 5e-3;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let moments = scene.moments.of(Slipping::Reflector);
    let shift = |(moment, k): (Moment, usize)| {
        Number::of_reading(SHIFT[k], "m", [-MOST, MOST], move |point| {
            let tool = |row: usize| turn_of(&point.samples.rows[row].tcp);
            point.of_reading(|row| if moment.has(row) { tool(row).column(k).into() } else { Vector3::zeros() })
        })
    };
    let numbers: Vec<Number> = moments.iter().flat_map(|&moment| (0..3).map(move |k| (moment, k))).map(shift).collect();
    let form = |(i, &moment): (usize, &Moment)| Form::of(3 * i..3 * i + 3).with(SLIPPED_AT, scene.line(moment), "1");
    offers.add(Place::Rig, numbers, moments.iter().enumerate().map(form).collect());
}
