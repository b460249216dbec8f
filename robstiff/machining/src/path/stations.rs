//! The stations of a path at which the turn about the tool's axis is planned, and the postures there.

use core::f64::consts::TAU;

use nalgebra::SVector;

use super::turn::FreeTurns;
use crate::inverse::Inverse;
use robstiff::Robot;

/// Turns about the tool's axis that are tried at a station: 10 degrees apart.
pub const TURNS: usize = 36;

/// The step between them (rad). Stations are as far apart, by the progress of the path.
pub const STEP: f64 = TAU / TURNS as f64;

/// From station to station a turn changes by a step, or so often as fast as the tool goes.
const FASTEST: f64 = 2.0;

/// The most stations, so that the longest path's fit in memory: they are farther apart then, and with an axis that
/// carries the arm by as many times as it has places.
const MOST: usize = 5000;

/// A joint this far (deg) from its limits, and the arm from where it is singular, is far enough: a
/// correction and the errors of setting up the workpiece stay well below.
pub const FAR_ENOUGH: u8 = 10;

/// A station.
pub struct Station<const N: usize> {
    /// The point of the path (from 0).
    pub point: usize,
    /// How far along it is (rad).
    pub progress: f64,
    /// The postures, those of one side together.
    pub states: Vec<State<N>>,
}

/// A posture at a station.
#[derive(Clone, Copy, Debug)]
pub struct State<const N: usize> {
    /// Joint coordinates (rad), as the closed form gives them.
    pub q: SVector<f64, N>,
    /// The turn about the tool's axis (rad).
    pub turn: f64,
    /// On which sides of its singular places the arm is.
    pub side: u8,
    /// How far it is from the nearest limit and singular place: whole degrees, [`FAR_ENOUGH`] at most.
    pub margin: u8,
    /// The square of how far (m) the force at the station pushes the tool off; 0 where none is known.
    pub off: f64,
}

/// The points that are stations: one a step, both ends of a longer chord, the first and the last.
pub fn points(progress: &[f64], places: usize) -> Vec<usize> {
    let Some((last, length)) = progress.len().checked_sub(1).zip(progress.last()) else { return Vec::new() };
    let step = STEP.max(length * places as f64 / MOST as f64);
    let mut chosen = vec![0];
    for i in 1..=last {
        let from = chosen[chosen.len() - 1];
        if progress[i] - progress[from] > step && i - 1 > from {
            chosen.push(i - 1);
        }
        if i == last || progress[i] - progress[chosen[chosen.len() - 1]] > step {
            chosen.push(i);
        }
    }
    chosen
}

/// The postures at a point of the path, each at one of the turns and with the axis that carries the arm, if any does,
/// as in one of the `places`.
pub fn states<const N: usize, R: Robot<N>>(
    (robot, inverse): (&R, &Inverse<'_, R, N>),
    path: &FreeTurns,
    point: usize,
    turns: impl Iterator<Item = f64>,
    places: &[SVector<f64, N>],
) -> Vec<State<N>> {
    let mut states = Vec::new();
    for turn in turns {
        for place in places {
            inverse.postures(&path.target(point, turn), place, |q| {
                let off = path.force(point).map(|force| robot.deflection(&q, force).fixed_rows::<3>(0).norm_squared());
                states.push(State { off: off.unwrap_or(0.0), ..state(inverse, q, turn) });
            });
        }
    }
    states.sort_by_key(|state| state.side);
    states
}

/// A posture at a turn, without a force.
pub fn state<const N: usize, R: Robot<N>>(inverse: &Inverse<'_, R, N>, q: SVector<f64, N>, turn: f64) -> State<N> {
    State { q, turn, side: inverse.side(&q), margin: margin(inverse, &q), off: 0.0 }
}

/// Whether one posture leads to another without a change, the tool going by so much (rad) on the way: on the
/// same side of all singular places, no joint by half a turn, the tool about its axis and the axis that carries the
/// arm by not too much.
pub fn leads_to<const N: usize, R: Robot<N>>(
    inverse: &Inverse<'_, R, N>,
    one: &State<N>,
    other: &State<N>,
    progress: f64,
) -> bool {
    one.side == other.side
        && turned(one.turn, other.turn).abs() <= STEP.max(FASTEST * progress) + 1e-9
        && is_carried_on(inverse, one, other, progress)
        && inverse.is_within_half_a_turn(&one.q, &other.q)
}

/// Whether the axis that carries the arm goes from one place to the next, or so often as fast as the tool.
fn is_carried_on<const N: usize, R: Robot<N>>(
    inverse: &Inverse<'_, R, N>,
    one: &State<N>,
    other: &State<N>,
    progress: f64,
) -> bool {
    let Some(step) = inverse.carrier_step() else { return true };
    let change = inverse.change(&one.q, &other.q);
    change[0].abs() <= step * (1.0 + 1e-9) || inverse.as_angles(&change)[0].abs() <= FASTEST * progress
}

/// The turn from one to another on the shorter way (rad).
pub fn turned(from: f64, to: f64) -> f64 {
    to - from - TAU * ((to - from) / TAU).round()
}

/// How far a posture is from the nearest limit and singular place: whole degrees, [`FAR_ENOUGH`] at most.
pub fn margin<const N: usize, R: Robot<N>>(inverse: &Inverse<'_, R, N>, q: &SVector<f64, N>) -> u8 {
    let singular = inverse.openness(q).unwrap_or([1.0; 3]).into_iter().map(|sine| sine.abs().min(1.0).asin());
    let least = singular.chain(inverse.to_limits(q)).fold(f64::INFINITY, f64::min).to_degrees();
    // What is a whole number but for rounding is that number.
    (least + 1e-6).clamp(0.0, f64::from(FAR_ENOUGH)) as u8
}
