//! Planes and boxes of positions.

use core::ops::Range;

use nalgebra::{Isometry3, Point3, Rotation3, SVector, Unit, Vector3};

use super::{Axis, Column, Evaluate, Measure, Poses, Space};
use crate::inverse::{Inverse, Orientation, Target};
use robstiff::{JointKind, Robot};

/// How the tool stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    /// The tool's axis in the TCP's frame.
    pub axis: Unit<Vector3<f64>>,
    /// Its direction in the frame of the positions.
    pub direction: Unit<Vector3<f64>>,
    /// Turns of the tool about that direction to choose from (rad), counted from
    /// the orientation that is the smallest turn from that of the frame; empty,
    /// where any will do.
    pub turns: Vec<f64>,
}

impl Tool {
    /// The orientations to choose from.
    fn orientations(&self) -> Vec<Orientation> {
        if self.turns.is_empty() {
            return vec![Orientation::Axis { tool: self.axis, direction: self.direction }];
        }
        let upright = Rotation3::rotation_between(&self.axis, &self.direction).unwrap_or_else(|| {
            // Upside down, about whichever axis is across: y, or x for a tool along y.
            let across = if self.axis.y.abs() > 0.5 { Vector3::x_axis() } else { Vector3::y_axis() };
            Rotation3::from_axis_angle(&across, core::f64::consts::PI)
        });
        let turned = |turn: &f64| Orientation::Full(Rotation3::from_axis_angle(&self.direction, *turn) * upright);
        self.turns.iter().map(turned).collect()
    }
}

/// A grid of positions of the TCP, with joint coordinates from inverse kinematics.
///
/// Of the turns that the tool may take, and of the postures of the arm, each cell
/// has the one where the measure is best. Where any turn will do and the arm has six
/// axes or more, its postures have no end, and each cell has the one that is nearest
/// to its neighbour's along x. Behind the measure's columns come the
/// turn, where there is a choice, and the joint coordinates.
pub struct CartesianSpace<'r, R, const N: usize> {
    axes: [Axis; 3],
    /// Where the positions are counted from, in the base frame.
    frame: Isometry3<f64>,
    tool: Tool,
    /// In the base frame.
    orientations: Vec<Orientation>,
    inverse: Inverse<'r, R, N>,
    seed: SVector<f64, N>,
    kinds: [JointKind; N],
}

const JOINTS: [&str; 8] = ["q1", "q2", "q3", "q4", "q5", "q6", "q7", "q8"];
const DEGREES: f64 = 180.0 / core::f64::consts::PI;

impl<'r, R: Robot<N> + Sync, const N: usize> CartesianSpace<'r, R, N> {
    /// The space of positions along x, y and z (m) of the base frame, where the tool
    /// stands as it says. Of joint coordinates that are a whole turn apart, a posture has those
    /// nearest to the middle of the joints' ranges.
    pub fn new(robot: &'r R, axes: [Axis; 3], tool: Tool) -> Self {
        let limits = robot.limits();
        let middle = |i: usize| limits[i].map_or(0.0, |[low, high]| 0.5 * (low + high));
        Self {
            axes,
            frame: Isometry3::identity(),
            orientations: tool.orientations(),
            tool,
            inverse: Inverse::new(robot),
            seed: SVector::from_fn(|i, _| middle(i)),
            kinds: robot.joint_kinds(),
        }
    }

    /// The same with positions and tool in a frame of their own, a workpiece's,
    /// which is given in the base frame. What is computed of a cell stays in the
    /// base frame.
    pub fn in_frame(mut self, frame: Isometry3<f64>) -> Self {
        let turn = frame.rotation.to_rotation_matrix();
        self.orientations = self.tool.orientations().into_iter().map(|one| one.turned(&turn)).collect();
        Self { frame, ..self }
    }

    /// In the base frame.
    fn position(&self, cell: usize) -> Vector3<f64> {
        let at = self.indices(cell);
        (self.frame * Point3::from(core::array::from_fn(|k| self.axes[k].values[at[k]]))).coords
    }

    /// The joint coordinates that bring the tool to a cell, with the number of the
    /// turn.
    fn candidates(&self, cell: usize, seed: &SVector<f64, N>) -> Vec<(usize, SVector<f64, N>)> {
        let position = self.position(cell);
        let mut found = Vec::new();
        for (turn, &orientation) in self.orientations.iter().enumerate() {
            let target = Target { position, orientation };
            let solutions = match orientation {
                // More axes than a free turn leaves conditions have no end of solutions: the
                // one nearest to the neighbour.
                Orientation::Axis { .. } if N > 5 => self.inverse.nearest(&target, seed).into_iter().collect(),
                _ => self.inverse.all(&target, seed).unwrap_or_default(),
            };
            found.extend(solutions.into_iter().map(|q| (turn, q)));
        }
        found
    }
}

impl<R: Robot<N> + Sync, const N: usize> Space<N> for CartesianSpace<'_, R, N> {
    fn axes(&self) -> &[Axis] {
        &self.axes
    }

    fn columns(&self) -> Vec<Column> {
        let turn = (self.orientations.len() > 1).then_some(Column { name: "turn", unit: "deg", scale: DEGREES });
        let joint = |i: usize| match self.kinds[i] {
            JointKind::Revolute => Column { name: JOINTS[i.min(7)], unit: "deg", scale: DEGREES },
            JointKind::Prismatic => Column { name: JOINTS[i.min(7)], unit: "mm", scale: 1e3 },
        };
        turn.into_iter().chain((0..N).map(joint)).collect()
    }

    fn compute(&self, robot: &impl Evaluate<N>, measure: &Measure, cells: Range<usize>) -> Vec<Vec<f64>> {
        let (mut owners, mut poses) = (Vec::new(), Vec::new());
        // What the tool leaves free stays near the neighbour's; the first cell of a
        // row begins anew, so that no cell depends on how the map is cut.
        let row = self.axes[0].values.len();
        let mut seed = self.seed;
        for cell in cells.start - cells.start % row..cells.end {
            if cell % row == 0 {
                seed = self.seed;
            }
            if cell < cells.start && !self.tool.turns.is_empty() {
                continue;
            }
            let found = self.candidates(cell, &seed);
            if let (true, Some((_, q))) = (self.tool.turns.is_empty(), found.first()) {
                seed = *q;
            }
            if cell >= cells.start {
                owners.extend(found.iter().map(|(turn, _)| (cell - cells.start, *turn)));
                poses.extend(found.into_iter().map(|(_, q)| q));
            }
        }
        let computed = measure.compute(robot, Poses::List(&poses));
        let mut best: Vec<Option<usize>> = vec![None; cells.len()];
        for (i, &(cell, _)) in owners.iter().enumerate() {
            let better = best[cell].is_none_or(|k| measure.is_clearly_worse(computed[0][k], computed[0][i]));
            if better && !computed[0][i].is_nan() {
                best[cell] = Some(i);
            }
        }
        let pick = |value: &dyn Fn(usize) -> f64| best.iter().map(|i| i.map_or(f64::NAN, value)).collect::<Vec<_>>();
        let mut columns: Vec<Vec<f64>> = computed.iter().map(|column| pick(&|i| column[i])).collect();
        if self.orientations.len() > 1 {
            columns.push(pick(&|i| self.tool.turns[owners[i].1]));
        }
        columns.extend((0..N).map(|joint| pick(&|i| poses[i][joint])));
        columns
    }

    /// Whole rows, and few: inverse kinematics takes long.
    fn chunk(&self) -> usize {
        let row = self.axes[0].values.len().max(1);
        row * (1024 / row).max(1)
    }
}
