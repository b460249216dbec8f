//! The arm goes on yielding under a load that stays on: every step of the
//! displacement grows by `share log10(1 + t / onset)` of itself in the time `t`
//! since it was made, and recovers alike; in rows where the file tells no time.

use core::f64::consts::LN_10;
use std::format;
use std::vec::Vec;

use super::{Form, Kind, Number, Offers, Part, Place, Scene, place_words};
use crate::trace::clamped::{Axes, AxisNumber, OnAxes, axes_column};

/// The kind.
pub static KIND: Kind = Kind {
    name: "creep",
    of_rig: true,
    words: |found| match found.place() {
        Place::Rig => "creep under load".into(),
        Place::Part(_) => format!("the creep of {} under load", place_words(found)),
    },
    explanation: "The arm, its mount or the ground goes on yielding under a load that stays. Wait the same time \
        before each reading, and write the time into the file.",
    offer,
    on_axes: Some(on_axes),
};

/// The onsets tried, in steps from one row to the next.
const ONSETS: [f64; 4] = [1.0 / 20.0, 1.0 / 6.0, 1.0 / 2.0, 2.0];

/// How far from the middle of these, in logarithms, an onset is as a rule: a
/// third of the grid's width.
const LIKELY: f64 = 1.2;

/// Beyond this share a decade it is no creep (1).
const MOST: f64 = 0.4;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let (_, pace) = scene.data.clock();
    if pace <= 0.0 {
        // One load a visit grows alike everywhere, as all compliances would.
        return offers.invisible(Place::Rig);
    }
    let unit = if scene.data.rows.iter().all(|row| row.time.is_some()) { "s" } else { "row" };
    let onsets = ONSETS.map(|share| share * pace);
    let number = move |onset: f64| {
        let number = Number::of_setup(
            "share",
            "1",
            MOST,
            // Two at once do not occur: a candidate has one of its forms.
            move |setup, share| setup.creep = [setup.creep[0] + share, onset],
            move |point, _| point.crept(&point.elastic, onset),
        );
        Number { range: [0.0, MOST], creeps: false, ..number }
    };
    let numbers: Vec<Number> = onsets.map(number).into();
    let forms = (0..).zip(onsets).map(|(k, onset)| Form::of([k]).with("onset", onset, unit));
    let forms = forms.map(|form| form.refined(move |onsets| [number(onsets[0])].into()));
    // Long after the onset a share and an onset are the joints' compliances with
    // another share and onset.
    let [first, .., last] = onsets;
    let forms = forms.map(|form| form.within([0.5 * first, 2.0 * last]).likely((first * last).sqrt(), LIKELY));
    let forms = forms.collect();
    offers.add(Place::Rig, numbers, forms);
}

/// All axes creep alike, or one by a share of its own; in rows, the file tells no time.
fn on_axes(axes: &Axes) -> Vec<OnAxes> {
    let all: Vec<usize> = axes.loaded().collect();
    let own = all.iter().map(|&axis| of_axes(axes, Part::Joint(axis).into(), &[axis]));
    // Of one axis alone both are the same.
    core::iter::once(of_axes(axes, Place::Rig, &all)).chain(own.filter(|_| all.len() > 1)).collect()
}

/// What creeps by one share.
fn of_axes(axes: &Axes, place: Place, which: &[usize]) -> OnAxes {
    let turns = |&axis: &usize| (axes.rows_of(axis), axes.turns(axis));
    let turns: Vec<(Vec<usize>, Vec<f64>)> = which.iter().map(turns).collect();
    let count = axes.rows.len();
    let numbers = [AxisNumber { name: "share", unit: "1", range: [0.0, MOST] }].into();
    let onsets = ONSETS.map(|onset| std::vec![onset]).into();
    let [first, .., last] = ONSETS;
    let crept = OnAxes::new(place, numbers, &[("onset", "row")], onsets, move |shape| {
        let columns = turns.iter().map(|(rows, turns)| axes_column(count, rows, grown(turns, shape[0])));
        [columns.sum()].into()
    });
    crept.within([0.5 * first, 2.0 * last]).likely([(first * last).sqrt(), LIKELY])
}

/// What turns that are made in one row after the other have grown by in each, at a share of 1.
fn grown(turns: &[f64], onset: f64) -> Vec<f64> {
    // A load is put on when the row before it was read.
    let since: Vec<f64> = (1..=turns.len()).map(|rows| (rows as f64 / onset).ln_1p() / LN_10).collect();
    let before = core::iter::once(&0.0).chain(turns);
    let steps: Vec<f64> = turns.iter().zip(before).map(|(turn, before)| turn - before).collect();
    let in_row = |k: usize| steps[..=k].iter().rev().zip(&since).map(|(step, since)| step * since).sum();
    (0..turns.len()).map(in_row).collect()
}
