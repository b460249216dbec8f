//! What holds for the motions of a program until it is set again.

use std::collections::HashMap;

use nalgebra::Isometry3;

use super::aggregate::{Aggregate, Before};
use crate::program::{Frame, Motion, Speed, Zone};

/// What holds at a line.
#[derive(Default)]
pub(super) struct State {
    pub(super) before: Before,
    pub(super) tool: Option<Frame>,
    pub(super) work: Option<Frame>,
    /// `TOOL_DATA` and `BASE_DATA`, as far as the program sets them.
    pub(super) tools: HashMap<i64, Isometry3<f64>>,
    pub(super) works: HashMap<i64, Isometry3<f64>>,
    pub(super) line_speed: Option<Speed>,
    pub(super) joint_speed: Option<Speed>,
    /// `$APO.CDIS` (m), `.CVEL` and `.CPTP` (shares).
    pub(super) distance: Option<f64>,
    pub(super) velocity: Option<f64>,
    pub(super) joints: Option<f64>,
    /// The distances of the `LDAT` and the `PDAT` that the next motion takes.
    pub(super) next_distance: Option<f64>,
    pub(super) next_joints: Option<f64>,
}

/// Which of the two frames.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Which {
    Tool,
    Work,
}

impl State {
    /// The frame with a number.
    pub(super) fn frame(&self, which: Which, number: i64) -> Frame {
        let known = if which == Which::Tool { &self.tools } else { &self.works };
        let pose = if number == 0 { Some(Isometry3::identity()) } else { known.get(&number).copied() };
        Frame { name: number.to_string(), pose }
    }

    /// What a motion does by `C_DIS` and the like, as words in upper case.
    pub(super) fn zone(&self, motion: Motion, words: &[String]) -> Zone {
        let Some(first) = words.first() else { return Zone::Fine };
        let zone = match (first.as_str(), motion) {
            ("C_PTP", _) => self.joints.map(Zone::Share),
            ("C_DIS" | "C_SPL", _) => self.distance.map(Zone::Within),
            ("C_VEL", Motion::Linear) => self.velocity.map(Zone::Share),
            _ => None,
        };
        zone.unwrap_or_else(|| Zone::Named(words.join(" ")))
    }

    /// Takes the distances of an `LDAT` or a `PDAT`.
    pub(super) fn take(&mut self, data: &Aggregate, motion: Motion) {
        let distance = data.number("APO_DIST");
        match motion {
            Motion::Linear => self.next_distance = distance.map(|mm| mm * 1e-3),
            Motion::Joint => self.next_joints = distance.map(|percent| percent * 1e-2),
        }
    }
}
