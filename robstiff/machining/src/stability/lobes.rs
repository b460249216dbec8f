//! How deep a cut may be where each tooth meets the surface that the tooth before it has cut.

use core::f64::consts::{PI, TAU};

use nalgebra::Matrix3;

use super::response::{Response, Sample};
use super::{Limits, Modes};
use crate::golden::inner;

/// The damping ratio that stands for none: the limits are those of a damping that vanishes.
const VANISHING: f64 = 1e-8;
/// Without damping, what is below so many of the least depths at that ratio is zero.
const ZERO: f64 = 1e4;
/// Periods of the first mode between two teeth from which on the lobes are so dense that the
/// limit is that of any speed.
const DENSE: f64 = 300.0;
/// The same of the highest frequency that is looked at.
const DENSEST: f64 = 1e5;
/// Steps towards a crossing: secants, and a halving after every two of them.
const STEPS: usize = 180;
/// How close to its target a phase is when the steps end (rad).
const EXACT: f64 = 1e-11;
/// How close it is at least where it crosses (rad).
const MET: f64 = 1e-5;
/// Cuts by the golden section.
const CUTS: usize = 40;

/// The stability lobes of an arm in a cut: the depths that are not stable, by the time between
/// two teeth.
///
/// The model is `M x'' + C x' + K x = a P (x(t) - x(t - T))`: a depth `a`, a process `P`, 3 x 3
/// (N/m^2), and the time `T` between two teeth (s). With the frequency response `G(i w)` of the
/// tool a movement neither grows nor dies down where
/// `det(I - a P G(i w) (1 - exp(-i w T))) = 0`. For an eigenvalue `mu` of `G P` that is at
/// `a = 1 / (2 Re mu)`, and only at frequencies with `w T = pi + 2 arg mu + 2 pi k` (Altintas and
/// Budak, CIRP Annals 44/1 (1995) 357-362). Every eigenvalue is followed over all frequencies at
/// which the depth is not beyond the greatest. Where `w T - 2 arg mu` rises with the frequency, a
/// movement begins to grow beyond that depth; where it falls, one begins to die down.
#[derive(Clone, Debug, PartialEq)]
pub struct Lobes {
    response: Response,
    samples: Vec<Sample>,
    /// The first natural frequency (rad/s).
    first: f64,
    greatest: f64,
    /// From here on what has no mass chatters with any time between the teeth, at the latest.
    end: f64,
    /// The least depth that is a limit at some speed, at most `end`.
    least: f64,
    /// Whether that is one of a mode without damping, and so stands for zero.
    is_zero: bool,
}

/// Where a movement neither grows nor dies down.
struct Crossing {
    depth: f64,
    /// Whether it grows beyond that depth.
    is_growing: bool,
}

impl Lobes {
    /// The lobes of an arm with these modes and a process, 3 x 3 per depth (N/m^2), in the same
    /// frame, as [`process`](super::process) gives it, up to a greatest depth (m).
    ///
    /// Without damping the limits are those of a damping ratio that goes to zero. `None` where
    /// the process or the response to it is not finite, where it depends on displacements along
    /// three directions, and where the greatest depth is not above zero.
    pub fn new(modes: &Modes, process: &Matrix3<f64>, greatest: f64) -> Option<Self> {
        if !(greatest > 0.0 && greatest.is_finite()) {
            return None;
        }
        let response = Response::new(modes, process, VANISHING)?;
        // At high frequencies the response is that of what has no mass, with any phase of the delay.
        let massless = response.massless().complex_eigenvalues().iter().map(|value| value.re).fold(0.0, f64::max);
        let end = greatest.min(0.5 / massless);
        let samples = response.samples(0.5 / end)?;
        let first = modes.frequencies().first().copied().unwrap_or(0.0);
        let mut lobes = Self { response, samples, first, greatest, end, least: end, is_zero: false };
        lobes.least = lobes.lowest();
        lobes.is_zero = modes.damping().iter().any(|damping| *damping < VANISHING) && lobes.least < end;
        Some(lobes)
    }

    /// The depth up to which it is stable with any time between two teeth (m); `None` where that
    /// is beyond the greatest.
    pub fn at_any_speed(&self) -> Option<f64> {
        let least = if self.is_zero { 0.0 } else { self.least };
        Some(least).filter(|least| *least < self.greatest)
    }

    /// The depths that are not stable with a time between two teeth (s).
    ///
    /// With more than 300 periods of the first mode between two teeth, or 100,000 of the highest
    /// frequency at which the greatest depth could be a limit, the lobes are so
    /// dense that all depths beyond that of [`at_any_speed`](Self::at_any_speed) are called not
    /// stable. So they are where the time is not above zero.
    pub fn limits(&self, period: f64) -> Limits {
        let highest = self.samples.last().map_or(0.0, |sample| sample.frequency);
        let is_open = period * self.first <= DENSE * TAU && period * highest <= DENSEST * TAU;
        let found = if period > 0.0 && is_open { self.ranges(period) } else { None };
        let mut unstable: Vec<[f64; 2]> =
            found.unwrap_or_else(|| self.at_any_speed().map(|from| [from, self.greatest]).into_iter().collect());
        if let Some(first) = unstable.first_mut().filter(|first| self.is_zero && first[0] <= ZERO * self.least) {
            first[0] = 0.0;
        }
        Limits { greatest: self.greatest, unstable }
    }

    /// Where movements grow: as many as began to and did not end. `None` where more would end
    /// than began.
    fn ranges(&self, period: f64) -> Option<Vec<[f64; 2]>> {
        let mut crossings = self.crossings(period);
        crossings.sort_by(|one, other| one.depth.total_cmp(&other.depth));
        let (mut growing, mut ranges) = (0_usize, Vec::<[f64; 2]>::new());
        for Crossing { depth, is_growing } in crossings {
            if !is_growing {
                growing = growing.checked_sub(1)?;
            } else if growing == 0 {
                ranges.push([depth, self.greatest]);
                growing = 1;
            } else {
                growing += 1;
            }
            if let (0, Some(last)) = (growing, ranges.last_mut()) {
                last[1] = depth;
            }
        }
        if self.end < self.greatest {
            match ranges.last_mut().filter(|last| last[1] >= self.end) {
                Some(last) => last[1] = self.greatest,
                None => ranges.push([self.end, self.greatest]),
            }
        }
        Some(ranges)
    }

    /// Every depth below the end at which a movement begins to grow or to die down.
    fn crossings(&self, period: f64) -> Vec<Crossing> {
        let floor = 0.5 / self.end;
        let mut crossings = Vec::new();
        for branch in 0..2 {
            let phase = |sample: &Sample| phase(sample, branch, period);
            for pair in self.samples.windows(2) {
                if pair.iter().all(|sample| sample.value(branch).re < 0.9 * floor) {
                    continue;
                }
                let turns = [&pair[0], &pair[1]].map(|sample| (phase(sample) / TAU).floor() as i64);
                for turn in turns[0].min(turns[1]) + 1..=turns[0].max(turns[1]) {
                    let way = [&pair[0], &pair[1]];
                    crossings.extend(self.crossing(way, branch, period, TAU * turn as f64));
                }
            }
            for three in self.samples.windows(3) {
                if three.iter().all(|sample| sample.value(branch).re < 0.9 * floor) {
                    continue;
                }
                crossings.extend(self.turning(three, branch, period));
            }
        }
        crossings
    }

    /// The crossing between two samples, at one of which the phase is at most `target` and at the
    /// other above it.
    fn crossing(&self, [from, to]: [&Sample; 2], branch: usize, period: f64, target: f64) -> Option<Crossing> {
        let off = |sample: &Sample| phase(sample, branch, period) - target;
        let is_growing = off(to) > off(from);
        let (mut low, mut high, mut last) = (from.clone(), to.clone(), from.clone());
        let (mut offs, mut side) = ([off(from), off(to)], None);
        for step in 0..STEPS {
            let share = if step % 3 == 2 { 0.5 } else { offs[0] / (offs[0] - offs[1]) };
            let at = low.frequency + share * (high.frequency - low.frequency);
            if !(at > low.frequency && at < high.frequency) && share != 0.5 {
                continue;
            }
            last = self.response.next(&low, at);
            let now = off(&last);
            if now.abs() <= EXACT || at <= low.frequency || at >= high.frequency {
                break;
            }
            let is_low = (now < 0.0) == is_growing;
            // An end that stays twice counts for less (Illinois).
            let stays = if side == Some(is_low) { 0.5 } else { 1.0 };
            side = Some(is_low);
            if is_low {
                (low, offs) = (last.clone(), [now, stays * offs[1]]);
            } else {
                (high, offs) = (last.clone(), [stays * offs[0], now]);
            }
        }
        let depth = 0.5 / last.value(branch).re;
        // Two eigenvalues that change places are not a crossing.
        let is_met = off(&last).abs() <= MET;
        (is_met && depth > 0.0 && depth < self.end).then_some(Crossing { depth, is_growing })
    }

    /// The two crossings next to a sample at which the phase turns round, where between its
    /// neighbours it just gets past the next full turn.
    fn turning(&self, three: &[Sample], branch: usize, period: f64) -> Vec<Crossing> {
        let [before, at, after] = [0, 1, 2].map(|k| phase(&three[k], branch, period));
        let sign = if at >= before && at >= after { 1.0 } else { -1.0 };
        let rise = (sign * (at - before)).min(sign * (at - after));
        let reach = (sign * (at - before)).max(sign * (at - after));
        let target = TAU * if sign > 0.0 { (at / TAU).floor() + 1.0 } else { (at / TAU).floor() };
        if rise < 0.0 || sign * (target - at) > reach {
            return Vec::new();
        }
        let look = |frequency: f64| {
            let from = if frequency < three[1].frequency { &three[0] } else { &three[1] };
            self.response.next(from, frequency)
        };
        let height = |sample: &Sample| sign * phase(sample, branch, period);
        let (mut low, mut high) = (three[0].frequency, three[2].frequency);
        let mut cuts = inner(low, high).map(look);
        for _ in 0..CUTS {
            if height(&cuts[0]) > height(&cuts[1]) {
                high = cuts[1].frequency;
                cuts = [look(inner(low, high)[0]), cuts[0].clone()];
            } else {
                low = cuts[0].frequency;
                cuts = [cuts[1].clone(), look(inner(low, high)[1])];
            }
        }
        let top = &cuts[0];
        if height(top) <= sign * target {
            return Vec::new();
        }
        let sides = [[&three[0], top], [top, &three[2]]];
        sides.into_iter().filter_map(|side| self.crossing(side, branch, period, target)).collect()
    }

    /// The least depth that is a limit at some speed, at most the end.
    fn lowest(&self) -> f64 {
        let real = |frequency: f64, from: &Sample, branch: usize| self.response.next(from, frequency).value(branch).re;
        let mut most: f64 = 0.5 / self.end;
        for branch in 0..2 {
            let at = |sample: &Sample| sample.value(branch).re;
            for three in self.samples.windows(3) {
                if at(&three[1]) < at(&three[0]) || at(&three[1]) < at(&three[2]) || at(&three[1]) < 0.5 * most {
                    continue;
                }
                let (mut low, mut high) = (three[0].frequency, three[2].frequency);
                for _ in 0..CUTS {
                    let [one, other] = inner(low, high);
                    let [left, right] = [one, other].map(|frequency| real(frequency, &three[1], branch));
                    if left > right { high = other } else { low = one }
                }
                most = most.max(real(0.5 * (low + high), &three[1], branch));
            }
            most = self.samples.iter().map(at).fold(most, f64::max);
        }
        0.5 / most
    }
}

/// `w T - pi - 2 arg mu`: a multiple of a full turn where a movement neither grows nor dies down.
fn phase(sample: &Sample, branch: usize, period: f64) -> f64 {
    sample.frequency * period - PI - 2.0 * sample.phases[branch]
}
