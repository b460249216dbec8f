//! Everything smooth that an arm could do and a model of its positions not say, as columns
//! of the regression in the frame that positions are read in.

use core::f64::consts::PI;
use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{DVector, Matrix3, Rotation3, Vector3};

use super::bench::{Bench, Model};
use super::frames::{Frames, frames};
use crate::campaign::{PositionRow, Positions};
use robstiff::JointKind;

/// The harmonics of a joint's coordinate that are looked for.
const HARMONICS: u8 = 6;

/// Payloads are of about this size (1/kg).
const HUNDRED_KILOGRAMS: f64 = 0.01;

/// The column of a campaign that says what the tool carries.
pub const PAYLOAD: &str = "payload";

/// So many moments are asked whether all readings are others from then on.
const MOMENTS: usize = 24;

/// Something smooth: the columns of the table that it depends on, and its columns of the
/// regression.
pub struct Smooth {
    pub of: Vec<String>,
    pub columns: Vec<DVector<f64>>,
}

/// All of it, where a model has the robot: of joints, of where is read, of moments, of
/// clocks.
pub fn everything(bench: &Bench<'_>, model: &Model) -> Vec<Smooth> {
    let data = bench.prepared.data;
    let state = &model.solved.state;
    let described = state.model(&bench.regression.start, &bench.regression.numbers);
    let phases =
        |(k, kind): (usize, JointKind)| phases(&data.rows.iter().map(|row| row.q[k]).collect::<Vec<f64>>(), kind);
    let seen = Seen {
        data,
        turn: state.registration.turn,
        points: described.points(data),
        joints: frames(&described.description, &data.rows),
        kinds: described.description.joints.iter().map(|joint| joint.kind).collect(),
        phases: described.description.joints.iter().map(|joint| joint.kind).enumerate().map(phases).collect(),
        tools: described.seen(data).into_iter().map(|seen| seen.tool).collect(),
    };
    let joints = (0..seen.kinds.len()).flat_map(|k| seen.of_joint(k));
    joints.chain(seen.of_place()).chain(seen.of_moments()).chain(seen.of_clocks()).collect()
}

/// Where a model has everything at the rows of a table.
struct Seen<'d> {
    data: &'d Positions,
    /// From the base to the frame that positions are read in.
    turn: Rotation3<f64>,
    /// Where the reflector is, in the base frame (m).
    points: Vec<Vector3<f64>>,
    joints: Vec<Frames>,
    kinds: Vec<JointKind>,
    /// Of each joint that moves, its coordinates as phases.
    phases: Vec<Option<Vec<f64>>>,
    /// The tool's axes in the base frame.
    tools: Vec<Matrix3<f64>>,
}

impl Seen<'_> {
    /// A column by what each row moves by, in the base frame.
    fn stacked(&self, of: impl Fn(usize) -> Vector3<f64>) -> DVector<f64> {
        let moved = (0..self.points.len()).flat_map(|row| <[f64; 3]>::from(self.turn * of(row)));
        DVector::from_vec(moved.collect())
    }

    /// Three columns: each row moved along the axes of the base frame.
    fn along_axes(&self, by: impl Fn(usize) -> f64) -> Vec<DVector<f64>> {
        (0..3).map(|k| self.stacked(|row| Vector3::ith(k, by(row)))).collect()
    }

    /// What the reflector moves by at a row, in the base frame, where joint `k` stands aside
    /// about an axis of its frame: its own, the one across, the third.
    fn aside(&self, k: usize, axis: usize, row: usize) -> Vector3<f64> {
        let joints = &self.joints[row];
        let ((z, through), x) = (joints.axes[k], joints.across[k]);
        let axis = [z, x, z.cross(&x)][axis];
        match self.kinds[k] {
            JointKind::Revolute => axis.cross(&(self.points[row] - through)),
            JointKind::Prismatic => axis,
        }
    }

    /// Joint `k` aside as cosine and sine of a phase.
    fn waves(&self, k: usize, axis: usize, phase: impl Fn(usize) -> f64) -> Vec<DVector<f64>> {
        let wave = |of: fn(f64) -> f64| self.stacked(|row| self.aside(k, axis, row) * of(phase(row)));
        [f64::cos, f64::sin].map(wave).into()
    }

    /// Joint `k` aside: by the square of the payload, in proportion to a joint's coordinate,
    /// as harmonics of its own about any axis of its frame, as waves of its own and
    /// another's together.
    fn of_joint(&self, k: usize) -> Vec<Smooth> {
        let about_itself = |by: &dyn Fn(usize) -> f64| std::vec![self.stacked(|row| self.aside(k, 0, row) * by(row))];
        let with = |j: usize| if j == k { std::vec![joint(k)] } else { std::vec![joint(k), joint(j)] };
        let square = |row: usize| (self.data.rows[row].payload * HUNDRED_KILOGRAMS).powi(2);
        let mut all = std::vec![Smooth { of: std::vec![PAYLOAD.to_string()], columns: about_itself(&square) }];
        let moving = || self.phases.iter().enumerate().filter_map(|(j, phases)| Some((j, phases.as_ref()?)));
        for (j, along) in moving() {
            let middle = along.iter().sum::<f64>() / along.len() as f64;
            all.push(Smooth { of: with(j), columns: about_itself(&|row| along[row] - middle) });
        }
        let Some(own) = &self.phases[k] else { return all };
        for (axis, order) in (0..3).flat_map(|axis| (1..=HARMONICS).map(move |order| (axis, order))) {
            all.push(Smooth { of: with(k), columns: self.waves(k, axis, |row| f64::from(order) * own[row]) });
        }
        for (j, other) in moving().filter(|(j, _)| *j != k) {
            for sign in [-1.0, 1.0] {
                all.push(Smooth { of: with(j), columns: self.waves(k, 0, |row| own[row] + sign * other[row]) });
            }
        }
        all
    }

    /// What is read is aside by the square of where it is.
    fn of_place(&self) -> Vec<Smooth> {
        let moving: Vec<String> = (0..self.kinds.len()).filter(|&k| self.phases[k].is_some()).map(joint).collect();
        let middle = self.points.iter().sum::<Vector3<f64>>() / self.points.len().max(1) as f64;
        let squares = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].into_iter().map(|(i, j)| {
            let square = |row: usize| (self.points[row] - middle)[i] * (self.points[row] - middle)[j];
            Smooth { of: moving.clone(), columns: self.along_axes(square) }
        });
        squares.collect()
    }

    /// What is read, or the reflector on the tool, moved at some moment, once more than a
    /// model says: columns for few moments say that.
    fn of_moments(&self) -> Vec<Smooth> {
        let rows = self.points.len();
        let moments = (1..rows).step_by(rows.div_ceil(MOMENTS).max(1));
        let moved = moments.flat_map(|moment| {
            let shifts = self.along_axes(|row| if row < moment { 0.0 } else { 1.0 });
            let on_tool =
                |k: usize, row: usize| if row < moment { Vector3::zeros() } else { self.tools[row].column(k).into() };
            let on_tool = (0..3).map(|k| self.stacked(|row| on_tool(k, row))).collect();
            [shifts, on_tool].map(|columns| Smooth { of: std::vec!["row order".to_string()], columns })
        });
        moved.collect()
    }

    /// All moves with time, temperature or the order of rows, by powers of them.
    fn of_clocks(&self) -> Vec<Smooth> {
        let known = |of: &dyn Fn(usize, &PositionRow) -> Option<f64>| -> Option<Vec<f64>> {
            let values: Option<Vec<f64>> = self.data.rows.iter().enumerate().map(|(i, row)| of(i, row)).collect();
            phases(&values?, JointKind::Prismatic)
        };
        let clocks = [
            ("time", known(&|_, row| row.time)),
            ("temperature", known(&|_, row| row.temperature)),
            ("row order", known(&|i, _| Some(i as f64))),
        ];
        let mut all = Vec::new();
        for (name, clock) in clocks {
            let Some(clock) = clock else { continue };
            for power in 1..=3 {
                let columns = self.along_axes(|row| clock[row].powi(power));
                all.push(Smooth { of: std::vec![name.to_string()], columns });
            }
        }
        all
    }
}

/// The column of joint `k`'s coordinate.
fn joint(k: usize) -> String {
    format!("q{}", k + 1)
}

/// Values as phases of a wave: angles as they are, others as parts of half a turn.
/// `None` where they do not vary.
fn phases(values: &[f64], kind: JointKind) -> Option<Vec<f64>> {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let range = values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least;
    (range > 0.0).then(|| match kind {
        JointKind::Revolute => values.to_vec(),
        JointKind::Prismatic => values.iter().map(|value| PI * (value - least) / range).collect(),
    })
}
