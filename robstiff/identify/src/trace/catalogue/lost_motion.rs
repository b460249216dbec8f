//! Lost motion: the steep part of a gear about zero torque. The joint turns by
//! `gap / 2 tau / sqrt(tau^2 + knee^2)` on top of `h tau`, a smooth sign of the
//! torque whose knee is well below the loads. That is what hardening does,
//! `added = gap / (2 knee)`: which it is, the knee says, and between them it may
//! be either.

use std::format;
use std::vec::Vec;

use super::{Form, Kind, Number, Offers, Part, Scene, place_words};
use crate::identify::column::Column;
use crate::trace::clamped::{Axes, AxisNumber, OnAxes};

/// The kind.
pub static KIND: Kind = Kind {
    name: "lost_motion",
    of_rig: false,
    words: |found| format!("the lost motion of {} about zero torque", place_words(found)),
    explanation: "",
    offer,
    on_axes: Some(on_axes),
};

/// The knees tried, as fractions of the largest torque that the gear carries: lost
/// motion is over below some 3 % of what a gear is made for.
pub const KNEES: [f64; 3] = [1.0 / 64.0, 1.0 / 32.0, 1.0 / 16.0];

/// Knees that may be either's, as fractions of the largest torque. What is over
/// by 3 % of the rated torque has a knee of half that; above it, a gear may be one
/// that hardens at once, and what it is rated for is known from the largest torque
/// by a factor at best. From half a step above the grid on it only hardens.
pub const EITHER: [f64; 2] = [1.0 / 64.0, 1.0 / 6.0];

/// A gap of a degree is a gear that is broken (rad); on a sliding joint (m).
pub const WIDEST: f64 = 0.0175;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for joint in 1..=scene.joints() {
        let Some(largest) = scene.largest_carried(joint) else {
            offers.invisible(Part::Joint(joint));
            continue;
        };
        let [gap, torque] = if scene.turns(joint) { ["rad", "Nm"] } else { ["m", "N"] };
        let number = move |knee: f64| {
            Number::elastic("gap", gap, [0.0, WIDEST], move |point| point.samples.column(Column::Gap { joint, knee }))
        };
        let knees = KNEES.map(|fraction| fraction * largest);
        let forms = (0..).zip(knees).map(|(k, knee)| Form::of([k]).with("knee", knee, torque));
        let forms = forms.map(|form| form.refined(move |knees| [number(knees[0])].into()));
        let forms = forms.map(|form| form.within([0.0, EITHER[1] * largest])).collect();
        let numbers: Vec<Number> = knees.map(number).into();
        offers.add(Part::Joint(joint), numbers, forms);
    }
}

fn on_axes(axes: &Axes) -> Vec<OnAxes> {
    let of = |axis: usize| {
        let number = AxisNumber { name: "gap", unit: axes.turn_unit(axis), range: [0.0, WIDEST] };
        let curve = |joint: usize, knee: f64| Column::Gap { joint, knee };
        OnAxes::with_knee(axes, axis, number, [&KNEES, &[0.0, EITHER[1]]], curve)
    };
    axes.loaded().map(of).collect()
}
