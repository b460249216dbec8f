//! Five axes and a free turn about a tool's axis that does not go through the
//! wrist: the turns at which the wrist can take the tool.
//!
//! For each turn the first three joints put the wrist where it must be, in up to
//! four ways. What is then wrong with the fifth axis, its part along the fourth,
//! has to vanish: its zeros are looked for between turns all around, in each way
//! on its own and up to where the way ends because the wrist is out of reach.

use core::f64::consts::TAU;

use nalgebra::SVector;

use super::screws::Turn;
use super::wrist::{Free, Wrist};
use crate::golden::inner;

/// Steps all around for five, each of which may be halved so often while its
/// middle is so far from a straight line.
const STEPS: usize = 36;
const HALVINGS: usize = 7;
const BENT: f64 = 0.02;

/// Samples next to an end of the reach, where what is wrong goes with the root
/// of the distance.
const NEXT_TO_END: usize = 6;

/// Cuts of a step, to rounding.
const CUTS: usize = 60;

/// A turn that is wrong by less is worth a try.
const NEARLY_RIGHT: f64 = 1e-6;

/// A lowest place between two turns is looked for where a parabola has it below
/// this.
const LOW: f64 = 0.05;

/// What is wrong at a turn about the tool's axis (rad), and how far the wrist is
/// out of reach there, below zero where it is not.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sample {
    angle: f64,
    wrong: f64,
    beyond: f64,
}

impl<const N: usize> Wrist<N> {
    /// Candidates at every turn at which the fifth axis is in its place.
    pub(super) fn sweep(&self, free: &Free, seed: &SVector<f64, N>, found: &mut impl FnMut(SVector<f64, N>)) {
        // All four ways at once, as they have much in common.
        let ways = |angle: f64| {
            let (turn, center) = self.freely_turned(free, Turn::new(angle));
            let (shoulders, near) = self.base().shoulders(&center, seed[0]);
            let [one, other] = shoulders.map(|first| {
                let (elbows, short) = self.base().elbows(&center, first, seed);
                elbows.map(|way| Sample { angle, wrong: self.fifth_off(&way, &turn), beyond: near.max(short) })
            });
            [one[0], one[1], other[0], other[1]]
        };
        let samples = all_around(&ways);
        for index in 0..4 {
            let way = |angle: f64| {
                let (turn, center) = self.freely_turned(free, Turn::new(angle));
                let (shoulders, near) = self.base().shoulders(&center, seed[0]);
                let (elbows, short) = self.base().elbows(&center, shoulders[index / 2], seed);
                (turn, elbows[index % 2], near.max(short))
            };
            let sample = |angle: f64| {
                let (turn, way, beyond) = way(angle);
                Sample { angle, wrong: self.fifth_off(&way, &turn), beyond }
            };
            for angle in zeros(samples.iter().map(|ways| ways[index]), &sample) {
                let (turn, way, _) = way(angle);
                self.full(&way, &turn, seed, found);
            }
        }
    }
}

/// Samples of all ways all around, closer where one is far from a straight line;
/// a little more than once, for lowest places at the first.
fn all_around(function: &impl Fn(f64) -> [Sample; 4]) -> Vec<[Sample; 4]> {
    let step = TAU / STEPS as f64;
    let mut last = function(0.0);
    let mut samples = Vec::with_capacity(4 * STEPS);
    samples.push(last);
    for k in 1..=STEPS + 1 {
        let next = function(step * k as f64);
        refine([&last, &next], HALVINGS, function, &mut samples);
        last = next;
    }
    samples
}

/// Adds what is needed between two samples, and the second of them.
fn refine(
    [one, other]: [&[Sample; 4]; 2],
    halvings: usize,
    function: &impl Fn(f64) -> [Sample; 4],
    samples: &mut Vec<[Sample; 4]>,
) {
    if halvings > 0 {
        let middle = function(0.5 * (one[0].angle + other[0].angle));
        let asks = |way: usize| {
            let (one, middle, other) = (one[way], middle[way], other[way]);
            let [first, between, second] = [one, middle, other].map(|sample| sample.beyond);
            // Between two of them it may go in and out of reach.
            let may_turn = first.abs().min(between.abs()).min(second.abs()) < (first + second - 2.0 * between).abs();
            let bent = (middle.wrong - 0.5 * (one.wrong + other.wrong)).abs() > BENT;
            (first * second > 0.0 && may_turn) || (first <= 0.0 && second <= 0.0 && bent)
        };
        if (0..4).any(asks) {
            refine([one, &middle], halvings - 1, function, samples);
            refine([&middle, other], halvings - 1, function, samples);
            return;
        }
        samples.push(middle);
    }
    samples.push(*other);
}

/// Where something is wrong no more: between samples, up to the ends of what is
/// in reach, and where it only touches zero.
fn zeros(samples: impl Iterator<Item = Sample>, function: &impl Fn(f64) -> Sample) -> Vec<f64> {
    let mut zeros = Vec::new();
    for run in runs(samples, function) {
        for pair in run.windows(2) {
            if pair[0].wrong * pair[1].wrong <= 0.0 {
                zeros.push(crossing(pair[0], pair[1], function, |sample| sample.wrong).angle);
            }
        }
        for three in run.windows(3) {
            touching([three[0], three[1], three[2]], function, &mut zeros);
        }
        let ends = [run.first(), run.last()].into_iter().flatten();
        zeros.extend(ends.filter(|end| end.wrong.abs() < NEARLY_RIGHT).map(|end| end.angle));
    }
    zeros
}

/// The samples within reach, each row of them up to its ends.
fn runs(samples: impl Iterator<Item = Sample>, function: &impl Fn(f64) -> Sample) -> Vec<Vec<Sample>> {
    let mut runs: Vec<Vec<Sample>> = Vec::new();
    let mut last: Option<Sample> = None;
    for sample in samples {
        // From where one ends or begins on.
        let end = |inside: Sample, outside: Sample| {
            let end = crossing(inside, outside, function, |sample| sample.beyond);
            let root = |j: usize| (j as f64 / NEXT_TO_END as f64).powi(2);
            let next = (1..NEXT_TO_END).map(move |j| end.angle + (inside.angle - end.angle) * root(j));
            core::iter::once(end).chain(next.map(function)).collect::<Vec<_>>()
        };
        match (last.filter(|last| last.beyond <= 0.0), sample.beyond <= 0.0) {
            (None, true) => {
                let mut run = last.map_or_else(Vec::new, |last| end(sample, last));
                run.push(sample);
                runs.push(run);
            }
            (Some(_), true) => runs.last_mut().expect("it has begun").push(sample),
            (Some(last), false) => runs.last_mut().expect("it has begun").extend(end(last, sample).into_iter().rev()),
            (None, false) => {}
        }
        last = Some(sample);
    }
    runs
}

/// Where a part of the samples is zero between values of opposite sign: regula
/// falsi as in Illinois (Dowell, Jarratt 1971).
fn crossing(one: Sample, other: Sample, function: &impl Fn(f64) -> Sample, part: impl Fn(&Sample) -> f64) -> Sample {
    let (mut one, mut other) = ((one.angle, part(&one)), (other.angle, part(&other)));
    let mut sample = function(other.0);
    for _ in 0..CUTS {
        let share = one.1 / (one.1 - other.1);
        let angle = one.0 + (other.0 - one.0) * if share.is_finite() { share } else { 0.5 };
        sample = function(angle);
        let value = part(&sample);
        if value == 0.0 || (angle - other.0).abs() < 1e-15 {
            break;
        }
        if value * other.1 < 0.0 {
            one = other;
        } else {
            one.1 *= 0.5;
        }
        other = (angle, value);
    }
    sample
}

/// The zeros on both sides of the place between three samples where what is wrong
/// comes nearest to zero, or that place if it touches it: by the golden section.
fn touching([one, middle, other]: [Sample; 3], function: &impl Fn(f64) -> Sample, zeros: &mut Vec<f64>) {
    let sign = middle.wrong.signum();
    let [left, low, right] = [one, middle, other].map(|sample| sign * sample.wrong);
    if left < low || right < low {
        return;
    }
    let (before, after) = (middle.angle - one.angle, other.angle - middle.angle);
    // The parabola through the three, from the middle one.
    let (back, ahead) = ((left - low) / before, (right - low) / after);
    let bend = (back + ahead) / (before + after);
    let slope = (ahead * before - back * after) / (before + after);
    if low - 0.25 * slope * slope / bend > LOW {
        return;
    }
    let (mut from, mut to) = (one.angle, other.angle);
    let mut lowest = middle;
    for _ in 0..CUTS {
        let cuts = inner(from, to).map(function);
        let [first, second] = cuts.map(|sample| sign * sample.wrong);
        lowest = cuts[usize::from(second < first)];
        // As flat as that it does not get to zero.
        if (first - second).abs() < 1e-3 * first.min(second) {
            break;
        }
        if first.min(second) <= 0.0 {
            let cut = |end| crossing(end, lowest, function, |sample| sample.wrong).angle;
            zeros.extend([cut(one), cut(other)]);
            return;
        }
        if first < second { to = cuts[1].angle } else { from = cuts[0].angle }
    }
    if lowest.wrong.abs() < NEARLY_RIGHT {
        zeros.push(lowest.angle);
    }
}
