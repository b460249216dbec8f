//! Solving a tool path: with planned turns, or each point from the posture at the one before.

use nalgebra::{Matrix4, SVector, Unit, Vector3};
use robstiff_robots::description::ON_THE_LIMIT;
use robstiff_robots::{Diagnostic, Diagnostics, Line};

use super::planned::planned;
use super::seeds::spread;
use super::steps::{Followed, Rank, follow, position};
use super::turn::FreeTurns;
use super::{Goal, Known, Orientation, PathPoint, SolvedPath, ToolPath, Unreached, Unsolved};
use crate::inverse::{Inverse, Target};
use robstiff::Robot;

/// Points that are shown with their line and why they cannot be reached or corrected.
pub(crate) const MOST_SHOWN: usize = 10;

/// Largest changes of a joint that differ by less are the same (rad or m).
const SAME_CHANGE: f64 = 1e-6;

impl ToolPath {
    /// The joint coordinates of every point, within the limits.
    ///
    /// Where all points leave the turn about the tool's axis free, and the arm has six axes and a closed
    /// form, the turn is planned along the whole path (`path/plan.rs`): such that all points are
    /// reached, with the fewest changes of posture, then away from limits and singular places, then with the
    /// least movement of the joints.
    ///
    /// Else, and where that leaves anything to wish for, each point is solved nearest to the one before it.
    /// Up to 16 postures at the first point are followed along the path, one of each
    /// branch of the inverse kinematics, and where the turn about the tool's axis is
    /// free several of a long one. The one is kept that reaches most points, changes
    /// its posture least often, and moves its joints least at a time; of those that
    /// are equal in this the one nearest to the middle of the joints' ranges. The plan is kept where it is
    /// no worse.
    ///
    /// With a `start` (rad or m) the first point is solved nearest to it.
    ///
    /// # Errors
    /// The points that cannot be reached, all of them.
    ///
    /// # Panics
    /// If the path was read for an arm with another number of joints.
    pub fn solve<const N: usize, R: Robot<N>>(
        &self,
        robot: &R,
        start: Option<&SVector<f64, N>>,
    ) -> Result<SolvedPath<N>, Unsolved> {
        self.solve_knowing(robot, start, &Known::default())
    }

    /// The same where more is known: where turns are planned, the time by which the joints are too slow for the feed
    /// counts before their movement, and how far forces push the tool off with it.
    ///
    /// # Errors
    /// As [`solve`](Self::solve).
    ///
    /// # Panics
    /// As [`solve`](Self::solve).
    pub fn solve_knowing<const N: usize, R: Robot<N>>(
        &self,
        robot: &R,
        start: Option<&SVector<f64, N>>,
        known: &Known<'_>,
    ) -> Result<SolvedPath<N>, Unsolved> {
        let inverse = Inverse::new(robot);
        let Some(plan) = planned(robot, &inverse, &self.points, start, &middle(robot), known) else {
            return self.finish(robot, self.stepwise(robot, &inverse, start));
        };
        let planned = follow(robot, &self.points, |i, last| match (&self.points[i].goal, &plan.postures[i]) {
            (_, Some(q)) => Ok(*q),
            // Another turn may do where the planned one does not.
            (Goal::Tool(target), None) => inverse.nearest(target, last.unwrap_or(&plan.wanted[i].near)),
            (Goal::Joints(q), None) => allowed(robot, SVector::from_column_slice(q)),
        });
        let rank = |of: &Followed<N>| Rank::of(of, robot, &inverse, &plan.path);
        let planned_rank = rank(&planned);
        if planned_rank == Rank::BEST {
            return self.finish(robot, planned);
        }
        let stepwise = self.stepwise(robot, &inverse, start);
        self.finish(robot, if planned_rank <= rank(&stepwise) { planned } else { stepwise })
    }

    /// Whether its turns about the tool's axis are planned: all are free, and the arm takes every one.
    pub fn is_planned<const N: usize, R: Robot<N>>(&self, robot: &R) -> bool {
        let inverse = Inverse::new(robot);
        inverse.takes_every_turn() && FreeTurns::of(&self.points, inverse.scale(), &Known::default()).is_some()
    }

    /// Each point nearest to the one before.
    pub(super) fn stepwise<const N: usize, R: Robot<N>>(
        &self,
        robot: &R,
        inverse: &Inverse<'_, R, N>,
        start: Option<&SVector<f64, N>>,
    ) -> Followed<N> {
        let middle = middle(robot);
        let seeds = match (start, self.points.first().map(|point| &point.goal)) {
            (Some(start), _) => std::vec![*start],
            (None, Some(Goal::Tool(target))) => match inverse.all(target, &middle) {
                Ok(all) => spread(&all),
                Err(_) => std::vec![middle],
            },
            (None, _) => std::vec![middle],
        };
        let followed = seeds.iter().map(|seed| {
            follow(robot, &self.points, |i, last| match &self.points[i].goal {
                Goal::Tool(target) => inverse.nearest(target, last.unwrap_or(seed)),
                Goal::Joints(q) => allowed(robot, SVector::from_column_slice(q)),
            })
        });
        let best = followed.min_by(|one, other| {
            let rank = |of: &Followed<N>| (of.postures.iter().filter(|q| q.is_err()).count(), of.jumps.len());
            // Rounding is no reason to prefer one; the first is the nearest to the middle.
            let moves = |of: &Followed<N>| (of.largest / SAME_CHANGE).round();
            rank(one).cmp(&rank(other)).then(moves(one).total_cmp(&moves(other)))
        });
        best.expect("there is at least one seed")
    }

    fn finish<const N: usize, R: Robot<N>>(&self, robot: &R, followed: Followed<N>) -> Result<SolvedPath<N>, Unsolved> {
        let missed: Vec<(usize, Unreached)> = self
            .points
            .iter()
            .zip(&followed.postures)
            .filter_map(|(point, q)| q.err().map(|why| (point.line, self.but_for_the_turn(robot, &point.goal, why))))
            .collect();
        let shown = missed.iter().take(MOST_SHOWN).map(|(line, why)| self.problem(*line, why)).collect();
        if let Some(problems) = Diagnostics::new(shown) {
            let of_joints = self.gives_joints();
            return Err(Unsolved { points: missed, of: self.points.len(), problems, of_joints });
        }
        let postures: Vec<SVector<f64, N>> = followed.postures.into_iter().flatten().collect();
        let poses: Vec<Matrix4<f64>> = postures.iter().map(|q| robot.transform(q)).collect();
        let positions: Vec<Vector3<f64>> = poses.iter().map(position).collect();
        let rapid = |i: usize| self.points[i].rapid;
        let (lengths, tangents) = (arc_lengths(&positions), tangents(&positions, rapid));
        let points = self.points.iter().enumerate().map(|(i, point)| PathPoint {
            line: point.line,
            q: postures[i],
            pose: poses[i],
            tangent: tangents[i],
            s: point.s.unwrap_or(lengths[i]),
            feed: point.feed,
            rapid: point.rapid,
            spindle: point.spindle,
            tool: point.tool,
            width: point.width,
            depth: point.depth,
        });
        Ok(SolvedPath { points: points.collect(), jumps: followed.jumps.into_iter().map(|(_, jump)| jump).collect() })
    }

    /// Why a point is not reached; that is the turn about the tool's axis, where five axes
    /// get there with another.
    fn but_for_the_turn<const N: usize, R: Robot<N>>(&self, robot: &R, goal: &Goal, why: Unreached) -> Unreached {
        let Goal::Tool(Target { position, orientation: Orientation::Full(turn) }) = goal else { return why };
        if N != 5 {
            return why;
        }
        let any = Target::axis(*position, self.tool, turn * self.tool);
        match Inverse::new(robot).nearest(&any, &middle(robot)) {
            Ok(_) => Unreached::TurnAboutTool,
            Err(_) => why,
        }
    }

    fn problem(&self, line: usize, why: &Unreached) -> Diagnostic {
        let help = match why {
            Unreached::OutsideLimits { .. } if self.gives_joints() => {
                "change the joint coordinate, or widen `limits` if they are too tight"
            }
            Unreached::TurnAboutTool => "give the columns `ux,uy,uz` in place of the full orientation",
            Unreached::OutsideLimits { .. } => {
                "move the workpiece, turn the tool, or widen `limits` if they are too tight"
            }
            Unreached::NotFinite => "",
            _ => "move the workpiece nearer, or turn the tool",
        };
        self.diagnostic(line, why.to_string(), help)
    }

    /// A problem with a line of the file (from 1).
    pub fn diagnostic(&self, line: usize, message: String, help: &str) -> Diagnostic {
        Diagnostic::of_line(&self.file, Line { number: line, text: self.line(line) }, message, help)
    }
}

/// The middle of the joints' ranges.
fn middle<const N: usize, R: Robot<N>>(robot: &R) -> SVector<f64, N> {
    SVector::from_iterator(robot.limits().map(|limits| match limits {
        Some([low, high]) => 0.5 * (low + high),
        None => 0.0,
    }))
}

fn allowed<const N: usize, R: Robot<N>>(robot: &R, q: SVector<f64, N>) -> Result<SVector<f64, N>, Unreached> {
    let kinds = robot.joint_kinds();
    let outside = |(i, limits): (usize, Option<[f64; 2]>)| {
        let limits = limits?;
        let is_inside = (limits[0] - ON_THE_LIMIT..=limits[1] + ON_THE_LIMIT).contains(&q[i]);
        (!is_inside).then_some(Unreached::OutsideLimits { joint: i + 1, kind: kinds[i], coordinate: q[i], limits })
    };
    robot.limits().into_iter().enumerate().find_map(outside).map_or(Ok(q), Err)
}

/// The sum of the chords up to each point (m).
fn arc_lengths(positions: &[Vector3<f64>]) -> Vec<f64> {
    let mut length = 0.0;
    let mut last = positions.first();
    let sum = positions.iter().map(|position| {
        length += last.map_or(0.0, |last| (position - last).norm());
        last = Some(position);
        length
    });
    sum.collect()
}

/// What the sum of two unit vectors must exceed to be a direction between them: they are less
/// than 174 degrees apart.
const TURNS_BACK: f64 = 0.1;

/// The feed directions; points in one place share theirs. Rapids are no feeds, and give a direction
/// only between rapids.
fn tangents(positions: &[Vector3<f64>], rapid: impl Fn(usize) -> bool) -> Vec<Option<Unit<Vector3<f64>>>> {
    let chord = |i: usize| {
        let direction = Unit::try_new(positions[i + 1] - positions[i], 1e-12);
        direction.map(|direction| (direction, rapid(i + 1)))
    };
    let count = positions.len();
    let mut arriving = std::vec![None; count];
    for i in 1..count {
        arriving[i] = chord(i - 1).or(arriving[i - 1]);
    }
    let mut leaving = std::vec![None; count];
    for i in (0..count.saturating_sub(1)).rev() {
        leaving[i] = chord(i).or(leaving[i + 1]);
    }
    type Direction = Option<(Unit<Vector3<f64>>, bool)>;
    let between = |(arriving, leaving): (Direction, Direction)| {
        let of = |direction: Direction| direction.map(|(direction, _)| direction);
        let (before, after) = match (arriving, leaving) {
            (Some((before, false)), Some((_, true))) => return Some(before),
            (Some((_, true)), Some((after, false))) => return Some(after),
            (Some((before, _)), Some((after, _))) => (before, after),
            _ => return of(leaving).or(of(arriving)),
        };
        // Where the path turns back there is nothing halfway, but for rounding of the file.
        Unit::try_new(before.into_inner() + after.into_inner(), TURNS_BACK).or(Some(after))
    };
    arriving.into_iter().zip(leaving).map(between).collect()
}
