//! What a campaign can show.

use std::collections::BTreeSet;

use robstiff::JointKind;
use robstiff_robots::Description;

use super::Place;
use crate::model::Weight;

/// The compliance of a joint that nothing is known of (rad/Nm).
const LIKELY: f64 = 3e-7;

/// Moments of a slip that are tried, and how many visits stand on either side of one.
const MOMENTS: usize = 20;
const FEWEST_ASIDE: usize = 3;

/// What a campaign reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// Displacements under loads.
    Displacements,
    /// Absolute positions.
    Positions,
    /// Clamped axes.
    Clamped,
}

/// Shapes beyond the grids: knees, radii, times and moments near those of a model that was found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shapes {
    /// Numbers that are chosen and not fitted: their name, where, and what they are. What has a number of the same name
    /// at a place looks alike, so all of them are offered there.
    pub numbers: Vec<(&'static str, Place, f64)>,
    /// Rows from which on something slipped.
    pub moments: BTreeSet<usize>,
}

/// The campaign that candidates are looked for in.
#[derive(Clone, Debug)]
pub struct Scene<'c> {
    /// The description as declared.
    pub robot: &'c Description,
    /// What is read.
    pub what: What,
    /// Turning or sliding, a joint each.
    pub kinds: Vec<JointKind>,
    /// The likely compliance of each joint (rad/Nm or m/N): as declared, else as fitted.
    pub compliance: Vec<f64>,
    /// The middle one of the first three that turn (rad/Nm).
    pub middle: f64,
    /// The largest torque of the loads on each joint (Nm or N); zero where no row loads it.
    pub torque: Vec<f64>,
    /// The largest force (N); zero where nothing loads the arm.
    pub force: f64,
    /// The masses of the links.
    pub weight: Weight,
    /// The lines of the rows.
    pub lines: Vec<usize>,
    /// The visit of each row.
    pub visit: Vec<usize>,
    /// How many visits there are.
    pub visits: usize,
    /// Over how many kelvin the temperature goes; zero where it is not given.
    pub warmth: f64,
    /// Shapes that are offered beside those of the grids.
    pub shapes: Shapes,
    /// The axes (from 1) that are loaded one by one.
    pub axes: Vec<usize>,
}

impl Scene<'_> {
    /// Finds the middle one of the compliances of the first three joints that turn.
    pub fn learn_middle(&mut self) {
        let mut first: Vec<f64> = self.turning().into_iter().take(3).map(|joint| self.compliance[joint - 1]).collect();
        first.sort_by(f64::total_cmp);
        self.middle = first.get(first.len() / 2).copied().filter(|h| *h > 0.0).unwrap_or(LIKELY);
    }

    /// The joints, from 1.
    pub fn joints(&self) -> impl Iterator<Item = usize> + use<> {
        1..=self.kinds.len()
    }

    /// Whether a joint (from 1) turns.
    pub fn turns(&self, joint: usize) -> bool {
        self.kinds[joint - 1] == JointKind::Revolute
    }

    /// The joints that turn, from 1.
    pub fn turning(&self) -> Vec<usize> {
        self.joints().filter(|&joint| self.turns(joint)).collect()
    }

    /// What is likely of the compliance of a bearing at a joint (rad/Nm).
    pub fn likely(&self, joint: usize) -> f64 {
        if self.turns(joint) { self.compliance[joint - 1] } else { self.middle }
    }

    /// Whether loads are measured, or payloads hang on the tool.
    pub fn is_loaded(&self) -> bool {
        self.force > 0.0 && self.what != What::Clamped
    }

    /// Whether loads are measured.
    pub fn has_loads(&self) -> bool {
        self.what == What::Displacements
    }

    /// Whether the loads of a joint (from 1) are seen to turn it.
    pub fn is_driven(&self, joint: usize) -> bool {
        self.torque[joint - 1] > 0.0
    }

    /// Whether gears may carry a weight: the description knows masses and declares no preload by them.
    pub fn may_preload(&self) -> bool {
        self.what != What::Clamped && self.weight.is_known() && self.weight.preload == 0.0
    }

    /// The unit of the compliance of a joint (from 1).
    pub fn unit(&self, joint: usize) -> &'static str {
        if self.turns(joint) { "rad/Nm" } else { "m/N" }
    }

    /// What a number that is chosen and not fitted may be at a place beside what a grid has of it.
    pub fn found(&self, number: &'static str, place: impl Into<Place>) -> Vec<f64> {
        let place = place.into();
        let own = |(of, at, _): &&(&str, Place, f64)| *of == number && *at == place;
        self.shapes.numbers.iter().filter(own).map(|(_, _, shape)| *shape).collect()
    }

    /// The rows from which on something may have slipped: the first rows of some twenty visits, and
    /// those near moments that were found. A part of the visits stands on either side and shows it.
    pub fn moments(&self) -> Vec<(usize, bool)> {
        let begins = (1..self.visit.len()).filter(|&row| self.visit[row] != self.visit[row - 1]);
        let begins: Vec<usize> = begins.collect();
        let step = (begins.len() / MOMENTS).max(FEWEST_ASIDE);
        let grid: Vec<usize> = begins.iter().copied().skip(step - 1).step_by(step).collect();
        let (Some(&first), Some(&last)) =
            (begins.get(FEWEST_ASIDE - 1), begins.len().checked_sub(FEWEST_ASIDE).and_then(|at| begins.get(at)))
        else {
            return Vec::new();
        };
        let grid: Vec<usize> = grid.into_iter().filter(|row| (first..=last).contains(row)).collect();
        let near = self.shapes.moments.iter().filter(|row| !grid.contains(row) && (first..=last).contains(row));
        grid.iter().map(|row| (*row, false)).chain(near.map(|row| (*row, true))).collect()
    }

    /// The line of a row.
    pub fn line(&self, row: usize) -> f64 {
        self.lines[row.min(self.lines.len() - 1)] as f64
    }
}
