//! The turn about the tool's axis, planned along the whole path.
//!
//! At stations along the path all postures of turns all around are laid out, and the best way through
//! them is found by dynamic programming (Bellman 1957). One thing counts before the next, so that nothing
//! is weighed against anything else: the fewest changes of posture; the greatest distance from limits and
//! singular places at the worst station, as far as it is less than enough; the same at all others; where feeds
//! and speeds of the joints are known, the least time by which these are too slow; the least effort. That is the
//! movement of the joints, as the sum of their squares, and where forces are known how far they push the tool off,
//! as the square of its share in what turns and postures taken at random have: per radian of the path a radian of
//! the joints counts as much as that. Then the steps between the turns are halved about the way found.

use core::cmp::Ordering;

use nalgebra::SVector;

use super::stations::{self, FAR_ENOUGH, STEP, State, Station, TURNS, leads_to, turned};
use super::turn::FreeTurns;
use crate::inverse::Inverse;
use robstiff::Robot;

/// How often the steps between turns are halved, to half a degree: as the tool's axis is between
/// neighbouring points at most, and more than that nobody sees.
const HALVINGS: i32 = 4;

/// Efforts (rad) and times (s) that differ by less are the same: rounding is no reason to prefer one.
const SAME: f64 = 1e-6;

/// A planned path: a posture for each station.
pub struct Plan<const N: usize> {
    stops: Vec<Stop<N>>,
}

/// What a plan wants at a point.
pub struct Wanted<const N: usize> {
    /// The turn about the tool's axis (rad).
    pub turn: f64,
    /// A posture near it (rad).
    pub near: SVector<f64, N>,
    /// On which sides of its singular places the arm is.
    pub side: u8,
    /// Whether the arm changes its posture between the stations before and after it.
    pub changing: bool,
}

/// A station with its posture.
struct Stop<const N: usize> {
    point: usize,
    progress: f64,
    state: State<N>,
    /// Whether the arm changes its posture on the way there.
    changed: bool,
}

/// What a way up to a state costs, the first that differs decides.
#[derive(Clone, Copy, Debug)]
struct Cost {
    changes: usize,
    /// By how much its worst state is nearer than enough (deg).
    nearer: u8,
    /// The sum of the squares of that.
    near: u64,
    /// How much longer (s) than the feed allows the joints take.
    late: f64,
    /// The sum over the path of the squares of how far the joints move (rad per rad of the path) and of how far the
    /// force pushes the tool off (as a share of the root mean square over all states).
    effort: f64,
    /// How far it begins from the middle of the joints' ranges.
    begun: f64,
}

impl Cost {
    fn order(&self, other: &Self) -> Ordering {
        let whole = |cost: &Self| (cost.changes, cost.nearer, cost.near);
        let rounded = |one: f64, other: f64| (one / SAME).round().total_cmp(&(other / SAME).round());
        whole(self)
            .cmp(&whole(other))
            .then_with(|| rounded(self.late, other.late))
            .then_with(|| rounded(self.effort, other.effort))
            .then_with(|| self.begun.total_cmp(&other.begun))
    }
}

impl<const N: usize> Plan<N> {
    /// Plans a path with stations at some of its points (from 0); from `start`, a posture and its turn (rad) at
    /// the first point, if that is given. `middle` is that of the joints' ranges. `None` where no station has a
    /// posture.
    pub fn of<R: Robot<N>>(
        (robot, inverse): (&R, &Inverse<'_, R, N>),
        path: &FreeTurns,
        points: impl Iterator<Item = usize>,
        start: Option<(&SVector<f64, N>, f64)>,
        middle: &SVector<f64, N>,
    ) -> Option<Self> {
        let first = start.map_or(0.0, |(_, turn)| turn);
        let around = || (0..TURNS).map(|k| first + STEP * k as f64);
        let places = inverse.carried_along(middle);
        let layer = |point: usize| {
            let states = match start {
                Some((q, turn)) if point == 0 => vec![stations::state(inverse, *q, turn)],
                _ => stations::states((robot, inverse), path, point, around(), &places),
            };
            Station { point, progress: path.progress()[point], states }
        };
        let layers: Vec<_> = points.map(layer).filter(|station| !station.states.is_empty()).collect();
        if layers.is_empty() {
            return None;
        }
        let usual = usual(&layers);
        let mut stops = best(inverse, path, &layers, middle, usual);
        for halving in 1..=HALVINGS {
            let step = STEP * 0.5_f64.powi(halving);
            let layers: Vec<_> = stops
                .iter()
                .map(|stop| {
                    let turns = [-step, 0.0, step].map(|by| stop.state.turn + by).into_iter();
                    let mut states = vec![stop.state];
                    if start.is_none() || stop.point > 0 {
                        let places = between(inverse, middle, &stop.state.q, 0.5_f64.powi(halving));
                        states = stations::states((robot, inverse), path, stop.point, turns, &places);
                        states.retain(|state| leads_to(inverse, &stop.state, state, 0.0));
                    }
                    if states.is_empty() {
                        states.push(stop.state);
                    }
                    Station { point: stop.point, progress: stop.progress, states }
                })
                .collect();
            stops = best(inverse, path, &layers, middle, usual);
        }
        Some(Self { stops })
    }

    /// What is wanted at every point, in the order of the path.
    pub fn along<R: Robot<N>>(&self, inverse: &Inverse<'_, R, N>, path: &FreeTurns) -> Vec<Wanted<N>> {
        let mut next = 0;
        let mut unwound = self.stops[0].state.q;
        let wanted = path.progress().iter().enumerate().map(|(point, at)| {
            while self.stops.get(next).is_some_and(|stop| stop.point <= point) {
                unwound += inverse.change(&unwound, &self.stops[next].state.q);
                next += 1;
            }
            let before = &self.stops[next.saturating_sub(1)];
            let State { turn, side, .. } = before.state;
            let Some(after) = self.stops.get(next).filter(|_| next > 0) else {
                return Wanted { turn, near: unwound, side, changing: false };
            };
            // Up to a change of posture the one before it is kept.
            if after.changed {
                return Wanted { turn, near: unwound, side, changing: before.point < point };
            }
            let share = (at - before.progress) / (after.progress - before.progress).max(f64::MIN_POSITIVE);
            let near = unwound + inverse.change(&before.state.q, &after.state.q) * share;
            Wanted { turn: turn + share * turned(turn, after.state.turn), near, side, changing: false }
        });
        wanted.collect()
    }
}

/// Places of the axis that carries the arm beside that of a posture, a share of a step away; the middle alone where
/// none does.
fn between<const N: usize, R: Robot<N>>(
    inverse: &Inverse<'_, R, N>,
    middle: &SVector<f64, N>,
    q: &SVector<f64, N>,
    share: f64,
) -> Vec<SVector<f64, N>> {
    let Some(step) = inverse.carrier_step() else { return vec![*middle] };
    [-1.0, 0.0, 1.0].map(|side| inverse.carried_to(middle, q[0] + side * share * step)).to_vec()
}

/// The best way through the stations: first with a margin as large as can be, up to enough, then with no more
/// than that asked for, so that a way that was worse up to somewhere may be better in all.
fn best<const N: usize, R: Robot<N>>(
    inverse: &Inverse<'_, R, N>,
    path: &FreeTurns,
    stations: &[Station<N>],
    middle: &SVector<f64, N>,
    usual: f64,
) -> Vec<Stop<N>> {
    let (stops, cost) = way(inverse, path, stations, middle, usual, FAR_ENOUGH);
    if cost.nearer == 0 { stops } else { way(inverse, path, stations, middle, usual, FAR_ENOUGH - cost.nearer).0 }
}

/// The mean square (m^2) of how far the forces push the tool off, over all states of stations where they do; not 0.
fn usual<const N: usize>(stations: &[Station<N>]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for state in stations.iter().flat_map(|station| &station.states).filter(|state| state.off > 0.0) {
        (sum, count) = (sum + state.off, count + 1.0);
    }
    if sum > 0.0 { sum / count } else { 1.0 }
}

fn way<const N: usize, R: Robot<N>>(
    inverse: &Inverse<'_, R, N>,
    path: &FreeTurns,
    stations: &[Station<N>],
    middle: &SVector<f64, N>,
    usual: f64,
    enough: u8,
) -> (Vec<Stop<N>>, Cost) {
    // Of each state the cost of the best way there, and which state that comes from.
    let mut ways: Vec<Vec<(Cost, usize)>> = Vec::with_capacity(stations.len());
    for (k, station) in stations.iter().enumerate() {
        let before = k.checked_sub(1).map(|k| (&stations[k], &ways[k]));
        let cheapest = before.map(|(_, ways)| cheapest(ways));
        let reached = station.states.iter().map(|state| {
            let own = |from: &Cost, late: f64, effort: f64| Cost {
                nearer: from.nearer.max(enough.saturating_sub(state.margin)),
                near: from.near + u64::from(FAR_ENOUGH - state.margin).pow(2),
                late: from.late + late,
                effort: from.effort + effort,
                ..*from
            };
            let (Some((last, ways)), Some(cheapest)) = (before, cheapest) else {
                let begun = inverse.change(middle, &state.q).norm_squared();
                return (own(&Cost { changes: 0, nearer: 0, near: 0, late: 0.0, effort: 0.0, begun }, 0.0, 0.0), 0);
            };
            let ahead = station.progress - last.progress;
            let step = ahead.max(f64::MIN_POSITIVE);
            let reach = |index: usize, before: &Cost, step: f64| {
                let change = inverse.change(&last.states[index].q, &state.q);
                let effort = inverse.as_angles(&change).norm_squared() / step + ahead * state.off / usual;
                own(before, path.late([last.point, station.point], change.as_slice()), effort)
            };
            // A change of posture may come from anywhere.
            let changed = Cost { changes: ways[cheapest].0.changes + 1, ..ways[cheapest].0 };
            let mut best = (reach(cheapest, &changed, STEP), cheapest);
            let from = last.states.partition_point(|from| from.side < state.side);
            for (index, from) in
                last.states.iter().enumerate().skip(from).take_while(|(_, from)| from.side == state.side)
            {
                if leads_to(inverse, from, state, step) {
                    let cost = reach(index, &ways[index].0, step);
                    if cost.order(&best.0) == Ordering::Less {
                        best = (cost, index);
                    }
                }
            }
            best
        });
        let reached = reached.collect();
        ways.push(reached);
    }
    let mut stops = Vec::with_capacity(stations.len());
    let mut index = ways.last().map_or(0, |ways| cheapest(ways));
    let cost = ways[ways.len() - 1][index].0;
    for (station, ways) in stations.iter().zip(&ways).rev() {
        let (point, progress) = (station.point, station.progress);
        stops.push((Stop { point, progress, state: station.states[index], changed: false }, ways[index].0.changes));
        index = ways[index].1;
    }
    stops.reverse();
    let changes: Vec<usize> = stops.iter().map(|(_, changes)| *changes).collect();
    let mut stops: Vec<Stop<N>> = stops.into_iter().map(|(stop, _)| stop).collect();
    for (stop, pair) in stops.iter_mut().skip(1).zip(changes.windows(2)) {
        stop.changed = pair[1] > pair[0];
    }
    (stops, cost)
}

/// Which way costs least, the first of equal ones.
fn cheapest(ways: &[(Cost, usize)]) -> usize {
    let least = (0..ways.len()).min_by(|&one, &other| ways[one].0.order(&ways[other].0));
    least.unwrap_or(0)
}
