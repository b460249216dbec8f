//! What the checks look at: rows in the base frame, and the lines of loads at
//! each pose.

use std::vec::Vec;

use nalgebra::{Vector3, Vector6};

use crate::campaign::{Campaign, Displacements, Frame};
use crate::noise::samples::{Sample, Samples};
use crate::noise::straight::straightened;
use crate::noise::{Covariance, Tails, mean_share};

/// A load below this share of the largest at its pose is none.
pub const UNLOADED: f64 = 0.01;

/// Loads within this angle of each other (rad) pull along one line: a load
/// cell's own error.
const SAME_LINE: f64 = 0.0175;

/// A moment is none where its lever is below this (m).
const NO_LEVER: f64 = 1e-3;

/// A campaign of displacements, before any model of the robot is fitted: of the
/// robot only where its links are, and what is not linear of what it declares, the
/// second order of large deflections and laws of joints such as hysteresis, which
/// is taken from the readings.
pub struct Evidence<'c> {
    /// The campaign.
    pub campaign: &'c Campaign,
    /// The rows of the table.
    pub data: &'c Displacements,
    /// The rows in the base frame.
    pub samples: Samples,
    /// The noise of the readings.
    pub covariance: Covariance,
    /// The tails of the noise, where the readings say something of them.
    pub tails: Option<Tails>,
    /// The lines of loads, pose by pose.
    pub lines: Vec<Line>,
    /// The line that each row is on, by index.
    line_of: Vec<Option<usize>>,
    /// Rows without a load.
    pub unloaded: Vec<usize>,
    /// Each row's wrench about the point whose displacement is read, where its
    /// work is known: the moment is none, or the rotation is read.
    pub wrenches: Option<Vec<Vector6<f64>>>,
}

/// Rows of one pose under loads along one line.
#[derive(Clone, Debug)]
pub struct Line {
    /// The pose, by index.
    pub pose: usize,
    /// The campaign's rows, in its order.
    pub rows: Vec<usize>,
    /// The visit of each.
    pub visits: Vec<usize>,
    /// The unit vector of the force, that of the largest load.
    pub along: Vector3<f64>,
    /// The force of each row along it (N); negative the other way.
    pub loads: Vec<f64>,
}

/// Weights of a line's rows: what a quantity is of their readings.
#[derive(Clone, Debug)]
pub struct Contrast {
    /// A weight a row; the score is the sum of weighted readings.
    pub weights: Vec<f64>,
    /// What the score is for a unit of the quantity.
    pub information: f64,
}

impl<'c> Evidence<'c> {
    /// The evidence of a campaign of displacements.
    pub fn new(campaign: &'c Campaign, data: &'c Displacements) -> Self {
        let samples = straightened(&campaign.robot, data);
        let (covariance, tails) =
            Covariance::estimate_with_tails(&samples, data.measured_frame, campaign.noise, |_| true);
        let (lines, unloaded) = lines(&samples);
        let wrenches = wrenches(&samples);
        let mut line_of = std::vec![None; samples.rows.len()];
        for (index, line) in lines.iter().enumerate() {
            line.rows.iter().for_each(|&row| line_of[row] = Some(index));
        }
        Self { campaign, data, samples, covariance, tails, lines, line_of, unloaded, wrenches }
    }

    /// What was read of a row along a unit vector in the base frame (m).
    pub fn along(&self, row: usize, along: &Vector3<f64>) -> f64 {
        self.samples.rows[row].displacement.dot(along)
    }

    /// A row's reading: displacement (m) and rotation (rad), zero where none is
    /// read.
    pub fn reading(&self, row: usize) -> Vector6<f64> {
        let row = &self.samples.rows[row];
        let (d, r) = (row.displacement, row.rotation);
        Vector6::new(d.x, d.y, d.z, r.x, r.y, r.z)
    }

    /// The variance of a sum of readings of one pose, each along a vector of the base
    /// frame: what visits have in common is in all of them.
    pub fn variance(&self, weighed: impl Iterator<Item = (usize, Vector6<f64>)>) -> f64 {
        let measured = |(row, along): (usize, Vector6<f64>)| match self.data.measured_frame {
            Frame::Base => (row, along),
            Frame::Tool => {
                let turn = self.samples.rows[row].tcp.turn.transpose();
                let (d, r) = (turn * along.fixed_rows::<3>(0), turn * along.fixed_rows::<3>(3));
                (row, Vector6::new(d.x, d.y, d.z, r.x, r.y, r.z))
            }
        };
        let measured: Vec<(usize, Vector6<f64>)> = weighed.map(measured).collect();
        let of_axis = |axis: usize| {
            let weights: Vec<(usize, f64)> = measured.iter().map(|(row, along)| (*row, along[axis])).collect();
            self.covariance.variance(axis, &weights)
        };
        (0..self.covariance.axes()).map(of_axis).sum()
    }

    /// The line that a row is on.
    pub fn line_of(&self, row: usize) -> Option<&Line> {
        self.line_of[row].map(|index| &self.lines[index])
    }
}

impl Line {
    /// The wrench of a newton along it: of its largest load, whose direction is best known.
    pub fn unit_load(&self, wrenches: &[Vector6<f64>]) -> Vector6<f64> {
        let largest = (0..self.rows.len()).max_by(|&a, &b| self.loads[a].abs().total_cmp(&self.loads[b].abs()));
        largest.map_or_else(Vector6::zeros, |k| wrenches[self.rows[k]] / self.loads[k])
    }

    /// The largest load (N).
    pub fn largest(&self) -> f64 {
        self.loads.iter().fold(0.0, |largest, load| load.abs().max(largest))
    }

    /// The weights by which readings give the slope over the load, by
    /// generalised least squares through the origin (1/N).
    pub fn slope(&self, shared: f64) -> Contrast {
        let loads = self.whitened(&self.loads, shared);
        let information: f64 = loads.iter().map(|load| load * load).sum();
        let weights = self.whitened(&loads, shared).into_iter().map(|weight| weight / information).collect();
        Contrast { weights, information }
    }

    /// The line's rows, each with its weight along a vector.
    pub fn weighed(&self, weights: &[f64], along: Vector6<f64>) -> impl Iterator<Item = (usize, Vector6<f64>)> {
        self.rows.iter().zip(weights).map(move |(&row, weight)| (row, along * *weight))
    }

    /// The weights by which readings give the part that goes with `shape`, a
    /// number a row, beyond what is linear in the load; `None` where the loads do
    /// not tell the two apart.
    pub fn beyond_linear(&self, shape: &[f64], shared: f64) -> Option<Contrast> {
        let (loads, shape) = (self.whitened(&self.loads, shared), self.whitened(shape, shared));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let part = dot(&loads, &shape) / dot(&loads, &loads);
        let beyond: Vec<f64> = shape.iter().zip(&loads).map(|(shape, load)| shape - part * load).collect();
        let information = dot(&beyond, &beyond);
        (information > 1e-4 * dot(&shape, &shape))
            .then(|| Contrast { weights: self.whitened(&beyond, shared), information })
    }

    /// One number a row, whitened like readings.
    fn whitened(&self, values: &[f64], shared: f64) -> Vec<f64> {
        let of_visit = |visit: usize| (0..self.rows.len()).filter(move |&k| self.visits[k] == visit);
        let taken = |k: usize| {
            let count = of_visit(self.visits[k]).count();
            mean_share(count, shared) / count as f64 * of_visit(self.visits[k]).map(|other| values[other]).sum::<f64>()
        };
        (0..self.rows.len()).map(|k| values[k] - taken(k)).collect()
    }
}

/// The lines of loads, those of the largest loads first at each pose; and the
/// rows without a load.
fn lines(samples: &Samples) -> (Vec<Line>, Vec<usize>) {
    let mut poses: Vec<Vec<usize>> = std::vec![Vec::new(); samples.poses];
    for (i, row) in samples.rows.iter().enumerate() {
        poses[row.pose].push(i);
    }
    let (mut all, mut unloaded) = (Vec::new(), Vec::new());
    for (pose, rows) in poses.into_iter().enumerate() {
        let size = |row: &usize| samples.rows[*row].wrench.norm();
        let largest = rows.iter().map(size).fold(0.0, f64::max);
        let (mut loaded, without): (Vec<usize>, Vec<usize>) =
            rows.into_iter().partition(|row| size(row) > UNLOADED * largest);
        unloaded.extend(without);
        while let Some(&first) = loaded.iter().max_by(|a, b| size(a).total_cmp(&size(b))) {
            let direction = samples.rows[first].wrench.normalize();
            let beside = |row: &usize| {
                let wrench = &samples.rows[*row].wrench;
                (wrench - direction * wrench.dot(&direction)).norm() <= SAME_LINE * wrench.norm()
            };
            let (mine, others): (Vec<usize>, Vec<usize>) = loaded.into_iter().partition(beside);
            loaded = others;
            let force = |row: &usize| samples.rows[*row].wrench.fixed_rows::<3>(0).into_owned();
            let Some(along) = force(&first).try_normalize(f64::MIN_POSITIVE) else { continue };
            let loads = mine.iter().map(|row| force(row).dot(&along)).collect();
            let visits = mine.iter().map(|&row| samples.rows[row].visit).collect();
            all.push(Line { pose, rows: mine, visits, along, loads });
        }
    }
    (all, unloaded)
}

fn wrenches(samples: &Samples) -> Option<Vec<Vector6<f64>>> {
    let about_marker = |row: &Sample| {
        let force: Vector3<f64> = row.wrench.fixed_rows::<3>(0).into_owned();
        let moment = row.wrench.fixed_rows::<3>(3) - row.marker.cross(&force);
        Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
    };
    let all: Vec<Vector6<f64>> = samples.rows.iter().map(about_marker).collect();
    let free = |wrench: &Vector6<f64>| wrench.fixed_rows::<3>(3).norm() <= NO_LEVER * wrench.fixed_rows::<3>(0).norm();
    (samples.axes > 3 || all.iter().all(free)).then_some(all)
}
