//! What does not go together in a cell and a path.

use core::f64::consts::TAU;

use nalgebra::Vector3;

use super::parts::{Cell, Tool};
use crate::path::{Goal, SolvedPath, ToolPath};

/// Speeds that differ by less are the same.
const ROUNDING: f64 = 1e-6;

/// Where a joint would have to move faster than it can.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TooFast {
    /// The joint (from 1).
    pub joint: usize,
    /// The line of the path to whose point it moves fastest.
    pub line: usize,
    /// How fast (rad/s or m/s).
    pub speed: f64,
    /// How fast it can (rad/s or m/s).
    pub most: f64,
    /// How many points it does not get to with their feed.
    pub points: usize,
}

/// Whether a speed is beyond what is possible, by more than rounding; both in one unit.
pub fn is_too_fast(speed: f64, most: f64) -> bool {
    speed > most * (1.0 + ROUNDING)
}

impl Cell {
    /// What a path asks of the spindle and the stock that they do not have; `path` is as its file gives
    /// it, in the work frame.
    pub fn doubts(&self, path: &ToolPath, tool: Option<&Tool>) -> Vec<String> {
        [self.spindle_speed(path), self.misses_stock(path, tool)].into_iter().flatten().collect()
    }

    fn spindle_speed(&self, path: &ToolPath) -> Option<String> {
        let [least, most] = self.spindle.as_ref()?.speeds?;
        let range = least * (1.0 - ROUNDING)..=most * (1.0 + ROUNDING);
        let turning = path.points.iter().filter(|point| !point.rapid);
        let mut speeds =
            turning.filter_map(|point| Some((point.line, point.spindle.filter(|speed| *speed != 0.0)?.abs())));
        let (line, speed) = speeds.find(|(_, speed)| !range.contains(speed))?;
        let [speed, least, most] = [speed, least, most].map(|speed| (speed * 60.0 / TAU).round());
        Some(format!(
            "{}:{line}: the program's spindle turns with {speed} rpm, that of {} with {least} to {most} rpm",
            path.file, self.file
        ))
    }

    fn misses_stock(&self, path: &ToolPath, tool: Option<&Tool>) -> Option<String> {
        let [from, to] = self.stock?;
        let radius = tool.and_then(|tool| tool.diameter).unwrap_or(0.0) / 2.0;
        let is_in =
            |at: &Vector3<f64>| (0..3).all(|axis| (from[axis] - radius..=to[axis] + radius).contains(&at[axis]));
        let mut cutting = path.points.iter().filter(|point| !point.rapid).filter_map(|point| match &point.goal {
            Goal::Tool(target) => Some(target.position),
            Goal::Joints(_) => None,
        });
        let first = cutting.next()?;
        if is_in(&first) || cutting.any(|at| is_in(&at)) {
            return None;
        }
        Some(format!(
            "no point of {} lies in the `stock` of {}: is that along the axes of the work frame, and from its zero?",
            path.file, self.file
        ))
    }

    /// The joints that a path with these feeds moves faster than they can: between two points all joints
    /// move evenly. Rapids, and points without a feed, say nothing.
    pub fn too_fast<const N: usize>(&self, solved: &SolvedPath<N>) -> Vec<TooFast> {
        let mut found: Vec<TooFast> = Vec::new();
        for pair in solved.points.windows(2) {
            let [before, point] = pair else { continue };
            let Some(feed) = point.feed.filter(|feed| *feed > 0.0 && !point.rapid) else { continue };
            let time = (point.s - before.s).abs() / feed;
            if time == 0.0 {
                continue;
            }
            for (index, &most) in self.joint_speeds.iter().enumerate().take(N) {
                let speed = (point.q[index] - before.q[index]).abs() / time;
                if !is_too_fast(speed, most) {
                    continue;
                }
                let fast = TooFast { joint: index + 1, line: point.line, speed, most, points: 1 };
                match found.iter_mut().find(|known| known.joint == index + 1) {
                    Some(known) if known.speed < speed => *known = TooFast { points: known.points + 1, ..fast },
                    Some(known) => known.points += 1,
                    None => found.push(fast),
                }
            }
        }
        found.sort_by_key(|fast| fast.joint);
        found
    }
}
