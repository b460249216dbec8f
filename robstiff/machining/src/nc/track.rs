//! What moves are made of, and how they are split.

use std::collections::VecDeque;

use nalgebra::{Unit, Vector3};

use super::arc::Arc;
use super::machine::{Angles, Machine};
use super::moves::Move;

/// A move is split into no more parts than these.
pub const MOST_PARTS: f64 = 1e5;

/// Between two points the tool's axis is within this angle of the plane of both (rad).
const AXIS: f64 = 2e-3;

/// How fast a move is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// As fast as the machine can.
    Rapid,
    /// The programmed point moves with a speed (m/s); where only axes turn, they do with so many
    /// rad/s.
    Speed(f64, f64),
    /// It takes a time (s).
    Time(f64),
}

/// What is the same for all parts of a move.
#[derive(Clone, Copy, Debug)]
pub struct Common {
    /// The line (from 1).
    pub line: usize,
    /// How fast.
    pub pace: Pace,
    /// The spindle's speed (rad/s).
    pub spindle: f64,
    /// The tool.
    pub tool: Option<u32>,
}

/// Which way a programmed point goes.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// Straight between two points (m).
    Line(Vector3<f64>, Vector3<f64>),
    /// Along an arc.
    Arc(Arc),
}

impl Shape {
    fn at(&self, part: f64) -> Vector3<f64> {
        match self {
            Self::Line(_, to) if part >= 1.0 => *to,
            Self::Line(from, to) => from.lerp(to, part),
            Self::Arc(arc) => arc.at(part),
        }
    }

    fn length(&self) -> f64 {
        match self {
            Self::Line(from, to) => (to - from).norm(),
            Self::Arc(arc) => arc.length(),
        }
    }
}

/// How the tool's axis goes.
#[derive(Clone, Copy, Debug)]
pub enum Turn<'m> {
    /// From one direction straight to another.
    Axis(Unit<Vector3<f64>>, Unit<Vector3<f64>>),
    /// By a machine's axes, the point being the tip on the workpiece.
    Tcp(&'m Machine, Angles, Angles),
    /// By a machine's axes, the point being where the machine is sent.
    Sent(&'m Machine, Angles, Angles),
}

impl Turn<'_> {
    /// The tip and the axis.
    fn at(&self, part: f64, point: Vector3<f64>) -> (Vector3<f64>, Unit<Vector3<f64>>) {
        let between = |from: &Angles, to: &Angles| {
            if part >= 1.0 { *to } else { core::array::from_fn(|i| from[i] + (to[i] - from[i]) * part) }
        };
        match self {
            Self::Axis(_, to) if part >= 1.0 => (point, *to),
            Self::Axis(from, to) => (point, from.try_slerp(to, part, 1e-9).unwrap_or(*to)),
            Self::Tcp(machine, from, to) => (point, machine.axis(between(from, to))),
            Self::Sent(machine, from, to) => {
                let angles = between(from, to);
                (machine.tip(point, angles), machine.axis(angles))
            }
        }
    }

    /// The angle that all axes turn by together (rad).
    fn angle(&self) -> f64 {
        match self {
            Self::Axis(from, to) => from.angle(to),
            Self::Tcp(_, from, to) | Self::Sent(_, from, to) => {
                from.iter().zip(to).map(|(from, to)| (to - from).abs()).sum()
            }
        }
    }
}

/// In how many parts a move is within the tolerance (m).
///
/// A curve is off its chord by less than h^2 / 8 times its second derivative. That of the axis is
/// below w^2 where the machine's axes turn by w together; that of a tip which the table carries
/// at a distance r while the machine goes v is below w^2 r + 2 w v.
fn parts(shape: &Shape, turn: &Turn<'_>, tolerance: f64) -> f64 {
    let of_arc = match shape {
        Shape::Line(..) => 1.0,
        Shape::Arc(arc) => arc.parts(tolerance),
    };
    let angle = turn.angle();
    let of_turn = match turn {
        _ if angle == 0.0 => 1.0,
        Turn::Axis(..) => 1.0,
        Turn::Tcp(..) => angle / (8.0 * AXIS).sqrt(),
        Turn::Sent(machine, ..) => {
            let reach = [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| machine.reach(&shape.at(part)));
            let reach = reach.into_iter().fold(0.0, f64::max) + 0.25 * shape.length();
            let bend = angle * angle * reach + 2.0 * angle * shape.length();
            (bend / (8.0 * tolerance)).sqrt().max(angle / (8.0 * AXIS).sqrt())
        }
    };
    of_arc.max(of_turn.ceil())
}

/// Splits a move into straight ones behind those in a queue. Where the start is not known it is
/// one point, the end.
///
/// # Errors
/// The number of parts, where that is beyond [`MOST_PARTS`].
pub fn split(
    moves: &mut VecDeque<Move>,
    common: Common,
    shape: &Shape,
    turn: &Turn<'_>,
    is_first: bool,
    tolerance: f64,
) -> Result<(), f64> {
    let Common { line, pace, spindle, tool } = common;
    let count = if is_first { 1.0 } else { parts(shape, turn, tolerance) };
    if count > MOST_PARTS {
        return Err(count);
    }
    let (length, angle) = (shape.length(), turn.angle());
    let whole = match pace {
        Pace::Rapid => None,
        Pace::Time(time) => Some(time),
        Pace::Speed(speed, _) if length > 0.0 => Some(length / speed),
        Pace::Speed(_, rate) => Some(angle / rate),
    };
    let (mut last, _) = turn.at(0.0, shape.at(0.0));
    for part in 1..=count as usize {
        let part = part as f64 / count;
        let (point, axis) = turn.at(part, shape.at(part));
        let duration = whole.map(|whole| whole / count).filter(|_| !is_first);
        let is_sent = matches!(turn, Turn::Sent(..)) && angle > 0.0;
        let feed = match pace {
            Pace::Rapid => None,
            _ if is_first => None,
            // As the program says it, without rounding.
            Pace::Speed(speed, _) if length > 0.0 && !is_sent => Some(speed),
            _ => duration.map(|duration| (point - last).norm() / duration).filter(|feed| *feed > 0.0),
        };
        // Nobody knows the way to the first point, and nothing is cut on it.
        let rapid = is_first || pace == Pace::Rapid;
        moves.push_back(Move { line, point, axis, rapid, feed, duration, spindle, tool });
        last = point;
    }
    Ok(())
}
