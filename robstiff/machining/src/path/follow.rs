//! Solving a tool path: each point from the posture at the one before.

use nalgebra::{Matrix4, Rotation3, SVector, Unit, UnitQuaternion, Vector3};
use robstiff_robots::description::ON_THE_LIMIT;
use robstiff_robots::{Diagnostic, Diagnostics, Line};

use super::planned::planned;
use super::seeds::spread;
use super::stations::{FAR_ENOUGH, margin};
use super::{Goal, Jump, Orientation, PathPoint, SolvedPath, ToolPath, Unreached, Unsolved, Waypoint};
use crate::inverse::{Inverse, Target};
use robstiff::{JointKind, Robot};

/// Points that are shown with their line and why they cannot be reached or corrected.
pub(crate) const MOST_SHOWN: usize = 10;

/// Largest changes of a joint that differ by less are the same (rad or m).
const SAME_CHANGE: f64 = 1e-6;

/// One posture a point, or why there is none.
pub(super) struct Followed<const N: usize> {
    postures: Vec<Result<SVector<f64, N>, Unreached>>,
    jumps: Vec<Jump>,
    /// Those of the jumps that take the arm to another side of its singular places.
    changes: usize,
    /// The largest change of a joint between neighbours (rad or m).
    largest: f64,
}

#[cfg(test)]
impl<const N: usize> Followed<N> {
    pub(super) fn postures(&self) -> impl Iterator<Item = Result<SVector<f64, N>, Unreached>> {
        self.postures.iter().copied()
    }

    pub(super) fn changes(&self) -> usize {
        self.changes
    }
}

/// How good a way is, the least the best.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Rank {
    /// Points that are not reached.
    missed: usize,
    /// Jumps to another side of the arm's singular places, or by half a turn of a joint.
    changes: usize,
    /// By how much (deg) the worst posture is nearer to a limit or a singular place than enough.
    nearer: u8,
    /// All jumps: the points of a path may be so far apart that the tool leaves it without a change.
    jumps: usize,
}

impl Rank {
    const BEST: Self = Self { missed: 0, changes: 0, nearer: 0, jumps: 0 };

    fn of<const N: usize, R: Robot<N>>(followed: &Followed<N>, inverse: &Inverse<'_, R, N>) -> Self {
        let reached = followed.postures.iter().flatten();
        let nearer = reached.map(|q| FAR_ENOUGH - margin(inverse, q)).max().unwrap_or(FAR_ENOUGH);
        let missed = followed.postures.iter().filter(|q| q.is_err()).count();
        Self { missed, changes: followed.changes, nearer, jumps: followed.jumps.len() }
    }
}

impl ToolPath {
    /// The joint coordinates of every point, within the limits.
    ///
    /// Where all points leave the turn about the tool's axis free, and the arm has six axes and a closed
    /// form, the turn is planned along the whole path (see [`plan`](super::plan)): such that all points are
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
        let inverse = Inverse::new(robot);
        let planned = planned(robot, &inverse, &self.points, start, &middle(robot)).map(|postures| {
            let followed =
                follow(robot, &inverse, &self.points, |i, last| match (&self.points[i].goal, &postures[i]) {
                    (_, Some(q)) => Ok(*q),
                    // Another turn may do where the planned one does not.
                    (Goal::Tool(target), None) => inverse.nearest(target, last.unwrap_or(&postures.near(i))),
                    (Goal::Joints(q), None) => allowed(robot, SVector::from_column_slice(q)),
                });
            (Rank::of(&followed, &inverse), followed)
        });
        let followed = match planned {
            Some((rank, planned)) if rank == Rank::BEST => planned,
            Some((rank, planned)) => {
                let stepwise = self.stepwise(robot, &inverse, start);
                if rank <= Rank::of(&stepwise, &inverse) { planned } else { stepwise }
            }
            None => self.stepwise(robot, &inverse, start),
        };
        self.finish(robot, followed)
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
            follow(robot, inverse, &self.points, |i, last| match &self.points[i].goal {
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
        Ok(SolvedPath { points: points.collect(), jumps: followed.jumps })
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

/// Follows a path; `reach` gives the posture at a point (from 0) after that at the last one reached.
fn follow<const N: usize, R: Robot<N>>(
    robot: &R,
    inverse: &Inverse<'_, R, N>,
    points: &[Waypoint],
    reach: impl Fn(usize, Option<&SVector<f64, N>>) -> Result<SVector<f64, N>, Unreached>,
) -> Followed<N> {
    let mut followed =
        Followed { postures: Vec::with_capacity(points.len()), jumps: Vec::new(), changes: 0, largest: 0.0 };
    let mut last: Option<(usize, SVector<f64, N>, Matrix4<f64>)> = None;
    for (i, point) in points.iter().enumerate() {
        let reached = reach(i, last.as_ref().map(|(_, q, _)| q));
        followed.postures.push(reached);
        // After a point that is not reached, the next is nearest to the last that is.
        let Ok(q) = reached else { continue };
        let pose = robot.transform(&q);
        if let Some((line, before, from)) = &last {
            let change = q - before;
            followed.largest = followed.largest.max(change.amax());
            if let Some(jump) = jump(robot, [*line, point.line], before, &change, [from, &pose]) {
                let same = inverse.side(before) == inverse.side(&q) && inverse.is_within_half_a_turn(before, &q);
                followed.changes += usize::from(!same);
                followed.jumps.push(jump);
            }
        }
        last = Some((point.line, q, pose));
    }
    followed
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

/// A change of posture, if it is one: halfway in joint coordinates the tool is
/// off the middle by more than half of its own way (and 1 mm), or of its own
/// turn (and 5 degrees).
fn jump<const N: usize, R: Robot<N>>(
    robot: &R,
    lines: [usize; 2],
    before: &SVector<f64, N>,
    change: &SVector<f64, N>,
    [from, to]: [&Matrix4<f64>; 2],
) -> Option<Jump> {
    let halfway = robot.transform(&(before + change * 0.5));
    let way = (position(to) - position(from)).norm();
    let [first, last] = [from, to].map(orientation);
    let middle = Target {
        position: (position(from) + position(to)) * 0.5,
        orientation: Orientation::Full(first.try_slerp(&last, 0.5, 1e-9).unwrap_or(first).to_rotation_matrix()),
    };
    let off = middle.remaining(&halfway);
    let (turn, slack) = (first.angle_to(&last), 5_f64.to_radians());
    if off.distance <= 0.5 * way + 1e-3 && off.angle <= 0.5 * turn + slack {
        return None;
    }
    let turning = robot.joint_kinds();
    // A slide moves as far as a turn at the arm's end.
    let size = |i: usize| if turning[i] == JointKind::Revolute { change[i].abs() } else { change[i].abs() * 2.0 };
    let joint = (0..N).max_by(|&one, &other| size(one).total_cmp(&size(other)))?;
    Some(Jump { lines, joint: joint + 1, change: change[joint], off })
}

fn position(pose: &Matrix4<f64>) -> Vector3<f64> {
    pose.fixed_view::<3, 1>(0, 3).into_owned()
}

fn orientation(pose: &Matrix4<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(pose.fixed_view::<3, 3>(0, 0).into_owned()))
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
