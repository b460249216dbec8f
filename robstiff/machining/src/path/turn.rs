//! The turn about the tool's axis, measured from a reference that goes along the path.
//!
//! The reference is a direction across the axis that turns with the axis and not about it (parallel
//! transport): it is defined wherever the axis points, and a tool at a constant turn moves no more than
//! it must. It does not know which way along the axis is named: a path of the tool's axis and one of its
//! reverse have the same turns, to the last digit.

use nalgebra::{Matrix3, Matrix4, Rotation3, Unit, Vector3, Vector6};

use super::{Goal, Known, Orientation, Waypoint};
use crate::inverse::Target;

/// The poses of a path with its turns free.
pub struct FreeTurns {
    /// The tool's axis in the TCP's frame, the one of both directions whose largest part is positive.
    tool: Vector3<f64>,
    /// A direction across it.
    across_tool: Vector3<f64>,
    points: Vec<Reference>,
    progress: Vec<f64>,
    /// The time (s) up to each point as far as it is known, and how many ways up to there have none.
    clock: Vec<(f64, usize)>,
    /// How fast each joint can move (rad/s); empty where that is not known.
    speeds: Vec<f64>,
    /// What acts on the tool at each point (N, Nm); empty where that is not known.
    forces: Vec<Vector6<f64>>,
}

/// A point of the path.
struct Reference {
    position: Vector3<f64>,
    /// Where the tool's axis points, in the base frame.
    along: Vector3<f64>,
    /// The direction across it from which turns count.
    across: Vector3<f64>,
}

impl FreeTurns {
    /// Those of a path; `None` if not all of its points leave the turn about one axis of the tool free. A way
    /// of `scale` (m) counts as an angle of 1 rad.
    pub fn of(points: &[Waypoint], scale: f64, known: &Known<'_>) -> Option<Self> {
        let mut tool: Option<Unit<Vector3<f64>>> = None;
        let mut references: Vec<Reference> = Vec::with_capacity(points.len());
        for point in points {
            let Goal::Tool(Target { position, orientation: Orientation::Axis { tool: axis, direction } }) = &point.goal
            else {
                return None;
            };
            if *tool.get_or_insert(*axis) != *axis || !position.iter().chain(direction.iter()).all(|x| x.is_finite()) {
                return None;
            }
            let along = direction.into_inner() * sign(axis);
            let across = references.last().map_or_else(|| across(&along), |last| transported(last, &along));
            references.push(Reference { position: *position, along, across });
        }
        let tool = tool.map(|tool| tool.into_inner() * sign(&tool))?;
        Some(Self {
            tool,
            across_tool: across(&tool),
            progress: progress(&references, scale),
            clock: clock(points, &references),
            points: references,
            speeds: known.speeds.to_vec(),
            forces: known.forces.to_vec(),
        })
    }

    /// The whole pose at a point and a turn (rad).
    pub fn target(&self, point: usize, turn: f64) -> Target {
        let Reference { position, along, across } = &self.points[point];
        let (sin, cos) = turn.sin_cos();
        let turned = across * cos + along.cross(across) * sin;
        let frame =
            |axis: &Vector3<f64>, across: &Vector3<f64>| Matrix3::from_columns(&[*axis, *across, axis.cross(across)]);
        let rotation = frame(along, &turned) * frame(&self.tool, &self.across_tool).transpose();
        Target { position: *position, orientation: Orientation::Full(Rotation3::from_matrix_unchecked(rotation)) }
    }

    /// The turn (rad) of a pose of the TCP at a point.
    pub fn turn_of(&self, point: usize, pose: &Matrix4<f64>) -> f64 {
        let Reference { along, across, .. } = &self.points[point];
        let turned = pose.fixed_view::<3, 3>(0, 0) * self.across_tool;
        along.cross(across).dot(&turned).atan2(across.dot(&turned))
    }

    /// How far the tool goes up to each point (rad).
    pub fn progress(&self) -> &[f64] {
        &self.progress
    }

    /// What acts on the tool at a point (N, Nm), where that is known and anything does.
    pub fn force(&self, point: usize) -> Option<&Vector6<f64>> {
        self.forces.get(point).filter(|force| **force != Vector6::zeros())
    }

    /// How much longer (s) than the feed allows a change of the joints takes from one point to another; 0 where
    /// no feed or no speed is known.
    pub fn late(&self, [from, to]: [usize; 2], change: &[f64]) -> f64 {
        let ((start, untimed), (end, untimed_too)) = (self.clock[from], self.clock[to]);
        if untimed != untimed_too {
            return 0.0;
        }
        let needed = change.iter().zip(&self.speeds).map(|(change, speed)| change.abs() / speed);
        (needed.fold(0.0, f64::max) - (end - start)).max(0.0)
    }
}

/// The sum up to each point of the angles of the axis and of the ways over a length (m).
fn progress(points: &[Reference], scale: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let steps = points.windows(2).map(|pair| {
        let angle = pair[0].along.cross(&pair[1].along).norm().atan2(pair[0].along.dot(&pair[1].along));
        sum += angle + (pair[1].position - pair[0].position).norm() / scale;
        sum
    });
    let steps: Vec<f64> = steps.collect();
    core::iter::once(0.0).chain(steps).collect()
}

/// The time (s) up to each point, and how many ways up to there have none: rapids, and those without a feed or
/// without a length.
fn clock(points: &[Waypoint], references: &[Reference]) -> Vec<(f64, usize)> {
    let mut at = (0.0, 0);
    let ways = points.windows(2).zip(references.windows(2)).map(|(points, references)| {
        let length = (references[1].position - references[0].position).norm();
        match points[1].feed.filter(|feed| !points[1].rapid && *feed > 0.0 && length > 0.0) {
            Some(feed) => at.0 += length / feed,
            None => at.1 += 1,
        }
        at
    });
    let ways: Vec<_> = ways.collect();
    core::iter::once((0.0, 0)).chain(ways).collect()
}

/// 1, or -1 where the largest part of a vector is negative.
fn sign(vector: &Vector3<f64>) -> f64 {
    vector[vector.iamax()].signum()
}

/// A unit vector across another: the axis that is farthest from it, projected.
fn across(vector: &Vector3<f64>) -> Vector3<f64> {
    let mut unit = Vector3::zeros();
    unit[vector.iamin()] = 1.0;
    (unit - vector * vector.dot(&unit)).normalize()
}

/// The reference of the next point: turned as the axis is, on the shortest way. If the axis turns round it
/// stays, for then that is a shortest way.
fn transported(last: &Reference, along: &Vector3<f64>) -> Vector3<f64> {
    let (turn, cos) = (last.along.cross(along), last.along.dot(along));
    let turned = last.across + turn.cross(&last.across) + turn.cross(&turn.cross(&last.across)) / (1.0 + cos).max(1e-9);
    // Rounding must not add up.
    let turned = turned - along * along.dot(&turned);
    Unit::try_new(turned, 0.1).map_or_else(|| across(along), Unit::into_inner)
}
