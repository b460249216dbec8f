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
    // Of one axis alone both are the same.
    let own = all.iter().filter(|&&axis| all.len() > 1 && is_told(&axes.torques(axis)));
    let own = own.map(|&axis| of_axes(axes, Part::Joint(axis).into(), &[axis]));
    core::iter::once(of_axes(axes, Place::Rig, &all)).chain(own).collect()
}

/// Whether the rows of an axis tell its creep from a gear that softens: under loads that only
/// rise both are curves of the torque.
fn is_told(torques: &[f64]) -> bool {
    torques.windows(2).any(|two| two[1].abs() <= two[0].abs() || two[0] * two[1] < 0.0)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_loads_that_rest_or_go_back_tell_the_creep_of_an_axis() {
        assert!(!is_told(&[]) && !is_told(&[100.0]) && !is_told(&[20.0, 50.0, 100.0]) && !is_told(&[-20.0, -100.0]));
        assert!(is_told(&[20.0, 100.0, 60.0]) && is_told(&[50.0, 50.0]) && is_told(&[-20.0, 100.0]));
    }

    /// Every step goes on growing by the time since it was made.
    #[test]
    fn steps_grow_from_when_they_were_made() {
        let [one, two] = [1.0, 2.0].map(|rows: f64| (1.0 + rows / 0.5).log10());
        let grown = grown(&[2.0, 1.0], 0.5);
        assert!((grown[0] - 2.0 * one).abs() < 1e-12 && (grown[1] - (2.0 * two - one)).abs() < 1e-12, "{grown:?}");
    }
}
