//! The robot, or what measures it, shifted at some moment: every reading after
//! it that is held against an unloaded reading from before it has the shift.
//! A slip within a visit is found with what is wrong in single visits; here are
//! those that all later rows keep, of which the unloaded readings know nothing.

use std::format;
use std::vec::Vec;

use nalgebra::Vector3;

use super::{Form, Kind, Number, Offers, Part, SHIFT, Scene, TURN};
use crate::identify::samples::stack;
use crate::trace::clamped::{Axes, OnAxes, SLIPPED_AXIS};
use crate::trace::slip::{Moment, SLIPPED_AT, Slipping};

/// The kind.
pub static KIND: Kind = Kind {
    name: "base_slip",
    // A shift of the whole robot is no property of it.
    of_rig: true,
    words: |found| {
        let (line, axis) = (found.value(SLIPPED_AT), found.value(SLIPPED_AXIS));
        match axis > 0.0 {
            true => format!("a slip of the base, the clamp or the gauge under axis {axis} before line {line}"),
            false => format!("a slip of the base before line {line}"),
        }
    },
    explanation: "Robot, tool, clamp, gauge or tracker moved on its mount between two readings, or yielded there for \
        good. Tighten it, and read the unloaded arm anew after the slip. Before the first row of a clamped axis, its \
        unloaded reading may be off.",
    offer,
    on_axes: Some(on_axes),
};

/// At so many of the moments, the first, the robot may have turned as well.
pub const LIKELY: usize = 3;

/// A longer way is a move (m), a larger turn a fall (rad).
const MOST: f64 = 5e-3;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let shift = |(moment, k): (Moment, usize)| {
        Number::of_reading(SHIFT[k], "m", [-MOST, MOST], move |point| {
            point.of_reading(|row| if moment.has(row) { Vector3::ith(k, 1.0) } else { Vector3::zeros() })
        })
    };
    // About the origin of the base frame, by a small turn.
    let turn = |(moment, k): (Moment, usize)| {
        Number::of_reading(TURN[k], "rad", [-MOST, MOST], move |point| {
            point.samples.stacked_by(|row, sample| {
                let turn = if moment.has(row) { Vector3::ith(k, 1.0) } else { Vector3::zeros() };
                let at = sample.tcp.fixed_view::<3, 1>(0, 3) + sample.marker;
                stack(&(sample.seen * turn.cross(&at)), &(sample.seen * turn))
            })
        })
    };
    let three = |&moment: &Moment| (0..3).map(move |k| (moment, k));
    let moments = scene.moments.of(Slipping::Base);
    let likely = &moments[..LIKELY.min(moments.len())];
    let shifts = moments.iter().flat_map(three).map(shift);
    let numbers: Vec<Number> = shifts.chain(likely.iter().flat_map(three).map(turn)).collect();
    let turns = 3 * moments.len();
    let form = |(i, &moment): (usize, &Moment)| Form::of(3 * i..3 * i + 3).with(SLIPPED_AT, scene.line(moment), "1");
    let mut forms: Vec<Form> = moments.iter().enumerate().map(form).collect();
    forms.extend(likely.iter().enumerate().map(|(i, &moment)| {
        let own = (3 * i..3 * i + 3).chain(turns + 3 * i..turns + 3 * i + 3);
        Form::of(own).with(SLIPPED_AT, scene.line(moment), "1")
    }));
    offers.add(Part::Base, numbers, forms);
}

/// What moves while an axis is loaded shifts the rows that are left of it: the next is read from
/// an unloaded reading of its own. One row alone is a wild one. All rows of an axis are shifted
/// where its own unloaded reading is off, besides which it may slip.
fn on_axes(axes: &Axes) -> Vec<OnAxes> {
    let of_axis = |axis: usize| {
        let moments = 1..axes.rows_of(axis).len().saturating_sub(1);
        let off = (!moments.is_empty()).then(|| OnAxes::slip(axes, axis, 0, MOST));
        off.into_iter().chain(OnAxes::one_of(moments.map(|from| OnAxes::slip(axes, axis, from, MOST)).collect()))
    };
    axes.loaded().flat_map(of_axis).collect()
}
