//! The closed form of arms whose last axes meet in one point.
//!
//! Pieper (The kinematics of manipulators under computer control, 1968): the
//! point where the axes of the wrist meet depends on the first three joints
//! only, so that their angles come first, and the wrist's from what turn is
//! left. Here the first axis is across the second and the third parallel to it
//! (the ortho-parallel base of Brandstoetter, Angerer, Hofbaur, 2014); offsets
//! between them and the angles within the wrist are free. The wrist's turns are
//! those of Paden and Kahan's subproblems, on the axes at zero, so that it does
//! not matter how the DH table was laid out. All is computed in a frame of the
//! arm's own: z along the first axis, y along the second.

use core::f64::consts::PI;

use nalgebra::{Matrix3, Matrix4, Rotation3, SVector, Vector3};

use super::base::{Base, Way};
use super::screws::{Axis, Turn, axes, meeting};
use super::target::{Orientation, Target, any_across, rotation, translation};
use super::turns::turns;
use robstiff::Robot;

/// An arm with a closed form: six axes with a spherical wrist, or five of which
/// the last two meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrist<const N: usize> {
    /// The arm's frame in the base frame.
    frame: Rotation3<f64>,
    origin: Vector3<f64>,
    /// At zero, in that frame.
    axes: [Axis; N],
    zero: Rotation3<f64>,
    base: Base,
    /// From the tool to where the axes of the wrist meet (m).
    to_center: Vector3<f64>,
    /// Whether all that is only nearly so.
    only_near: bool,
}

/// On which sides of its axes an arm is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    /// How far the wrist is ahead of the first axis (m): along second axis cross first.
    pub ahead: f64,
    /// The sine of the turn about the second axis from the upper arm to the line from the elbow to the
    /// wrist.
    pub bend: f64,
    /// The direction of the first axis in the base frame.
    pub first: Vector3<f64>,
    /// A point on the second axis at zero, in the base frame (m).
    pub shoulder: Vector3<f64>,
}

/// Axes apart by less than this times the reach count as meeting (m/m), and
/// angles off by less (rad) as right. What is left of that, such as the errors
/// of a measured DH table, is for the descent that follows.
const NEARLY: f64 = 0.02;

/// The same where nothing is left for the descent but rounding.
const EXACTLY: f64 = 1e-9;

impl<const N: usize> Wrist<N> {
    /// The closed form of a robot; `None` if it has none.
    pub fn of<R: Robot<N>>(robot: &R, reach: f64) -> Option<Self> {
        if !(5..=6).contains(&N) {
            return None;
        }
        let (axes, pose) = axes(robot)?;
        Self::of_axes(axes, &pose, |q| robot.transform(q), reach)
    }

    /// That of axes where all coordinates are zero, and the pose of the tool there; `whole` is its pose at any
    /// coordinates.
    pub fn of_axes(
        axes: [Axis; N],
        pose: &Matrix4<f64>,
        whole: impl Fn(&SVector<f64, N>) -> Matrix4<f64>,
        reach: f64,
    ) -> Option<Self> {
        let [first, second, third] = [0, 1, 2].map(|i| axes[i].direction);
        let (center, apart) = meeting(&axes[3], &axes[4])?;
        let off_last = axes[N - 1].direction.cross(&(center - axes[N - 1].point)).norm();
        let sixth_turns = N == 5 || axes[4].direction.cross(&axes[5].direction).norm() > NEARLY;
        let off = [first.dot(&second).abs(), second.cross(&third).norm(), apart.max(off_last) / reach];
        let off = off.into_iter().fold(0.0, f64::max);
        if off > NEARLY || !sixth_turns {
            return None;
        }
        let only_near = off > EXACTLY || strays(whole, &axes, pose) > EXACTLY * reach;
        let frame = Rotation3::face_towards(&first, &second);
        let origin = axes[0].point;
        let axes = axes.map(|axis| Axis {
            direction: frame.inverse() * axis.direction,
            point: frame.inverse() * (axis.point - origin),
        });
        let center = frame.inverse() * (center - origin);
        let base = Base::new(&axes[1], &axes[2], &center);
        let to_center = center - frame.inverse() * (translation(pose) - origin);
        Some(Self { frame, origin, axes, zero: frame.inverse() * rotation(pose), base, to_center, only_near })
    }

    /// Whether solutions need the descent: the axes do not quite lie as they
    /// should, or the joints do not quite turn by their coordinates.
    pub fn only_near(&self) -> bool {
        self.only_near
    }

    /// Candidates for a target, which need not be within limits and, where the
    /// target is out of reach or the closed form only near, not on it. Where a
    /// joint may stand anywhere it stands as in the seed.
    pub fn candidates(&self, target: &Target, seed: &SVector<f64, N>, mut found: impl FnMut(SVector<f64, N>)) {
        let position = self.frame.inverse() * (target.position - self.origin);
        match &target.orientation {
            Orientation::Full(turn) => {
                let turn = self.frame.inverse() * turn * self.zero.inverse();
                let center = position + turn * self.to_center;
                self.base.ways(&center, seed, |way| self.full(&way, turn.matrix(), seed, &mut found));
            }
            Orientation::Axis { tool, direction } => {
                let (tool, direction) = (self.zero * tool.as_ref(), self.frame.inverse() * direction.as_ref());
                let off = tool.cross(&self.to_center).norm();
                if N == 5 && off <= 1e-9 * self.to_center.norm() {
                    let center = position + direction * tool.dot(&self.to_center);
                    self.base.ways(&center, seed, |way| {
                        let to = way.carried_back(&direction);
                        self.pair(&tool, &to, seed, |q4, q5| found(way.with(&[q4, q5])));
                    });
                } else {
                    let onto = Rotation3::rotation_between(&tool, &direction)
                        .unwrap_or_else(|| Rotation3::new(any_across(&tool) * PI));
                    let free = Free { axis: Axis { direction, point: position }, onto: *onto.matrix() };
                    self.about(&free, seed, &mut found);
                }
            }
            // Where any turn will do there are too many to go through.
            Orientation::Free => {}
        }
    }

    /// On which sides of its axes the arm is.
    pub fn sides(&self, q: &SVector<f64, N>) -> Sides {
        let (ahead, bend) = self.base.sides(q[1], q[2]);
        let shoulder = self.origin + self.frame * self.axes[1].point;
        Sides { ahead, bend, first: self.frame * Vector3::z(), shoulder }
    }

    /// The sines of the angles from where the arm is singular, with the sign of the side: the shoulder, the
    /// elbow, the wrist.
    pub fn openness(&self, q: &SVector<f64, N>) -> [f64; 3] {
        let (ahead, bend) = self.base.sides(q[1], q[2]);
        let [fourth, fifth, last] = [3, 4, N - 1].map(|i| self.axes[i].direction);
        let last = self.axes[4].turn(&last, Turn::new(q[4]));
        let size = fourth.cross(&fifth).norm() * fifth.cross(&last).norm();
        let wrist = fourth.cross(&fifth).dot(&last) / size.max(f64::MIN_POSITIVE);
        [ahead / self.base.longest(), bend, wrist]
    }

    /// The first three joints.
    pub(super) fn base(&self) -> &Base {
        &self.base
    }

    /// The turn of the whole tool after a turn about the free axis, and where
    /// the axes of the wrist meet then.
    pub(super) fn freely_turned(&self, free: &Free, by: Turn) -> (Matrix3<f64>, Vector3<f64>) {
        let turn = free.axis.turn_all(&free.onto, by);
        (turn, free.axis.point + turn * self.to_center)
    }

    /// The fifth axis' part along the fourth after a turn of the whole tool,
    /// less what it has to be.
    pub(super) fn fifth_off(&self, way: &Way, turn: &Matrix3<f64>) -> f64 {
        let fifth = self.axes[4].direction;
        self.axes[3].direction.dot(&(way.carried_back(&(turn * fifth)) - fifth))
    }

    /// The wrist for a turn of the whole tool.
    pub(super) fn full(
        &self,
        way: &Way,
        turn: &Matrix3<f64>,
        seed: &SVector<f64, N>,
        found: &mut impl FnMut(SVector<f64, N>),
    ) {
        // What is left to the wrist, of a vector.
        let left = |vector: &Vector3<f64>| way.carried_back(&(turn * vector));
        let [fourth, fifth, last] = [self.axes[3], self.axes[4], self.axes[N - 1]];
        let across = any_across(&last.direction);
        let turned = left(&across);
        if N == 6 {
            self.pair(&last.direction, &left(&last.direction), seed, |q4, q5| {
                // What the last joint makes of a vector across its axis.
                let back = fifth.turn(&fourth.turn(&turned, q4.inverse()), q5.inverse());
                let q6 = last.turn_between(&across, &back).unwrap_or_else(|| Turn::new(seed[N - 1]));
                found(way.with(&[q4, q5, q6]));
            });
        } else {
            let q4 = fourth.turn_between(&fifth.direction, &left(&fifth.direction));
            let q4 = q4.unwrap_or_else(|| Turn::new(seed[3]));
            let back = fourth.turn(&turned, q4.inverse());
            let q5 = fifth.turn_between(&across, &back).unwrap_or_else(|| Turn::new(seed[4]));
            found(way.with(&[q4, q5]));
        }
    }

    /// The fourth and fifth joint that bring one vector to another: two ways.
    fn pair(&self, from: &Vector3<f64>, to: &Vector3<f64>, seed: &SVector<f64, N>, mut found: impl FnMut(Turn, Turn)) {
        let (fourth, fifth) = (self.axes[3], self.axes[4]);
        let turns = match fifth.turns_towards(from, &fourth.direction, fourth.direction.dot(to)) {
            Some(turns) => turns,
            None => [Turn::new(seed[4]); 2],
        };
        for q5 in turns {
            let q4 = fourth.turn_between(&fifth.turn(from, q5), to).unwrap_or_else(|| Turn::new(seed[3]));
            found(q4, q5);
        }
    }

    /// A free turn about the tool's axis that moves the wrist: six axes can take
    /// every one of them, and turns all around are tried; five take only some.
    fn about(&self, free: &Free, seed: &SVector<f64, N>, found: &mut impl FnMut(SVector<f64, N>)) {
        if N == 5 {
            self.sweep(free, seed, found);
            return;
        }
        for angle in turns() {
            let (turn, center) = self.freely_turned(free, Turn::new(angle));
            self.base.ways(&center, seed, |way| self.full(&way, &turn, seed, found));
        }
    }
}

/// The tool's axis, where the turn about it is free, in the arm's frame.
pub(super) struct Free {
    /// Where it is to be.
    axis: Axis,
    /// One of the turns that bring it there from zero.
    onto: Matrix3<f64>,
}

/// How far turns about the axes at zero take the tool from where the robot has
/// it (m, and rad alike), at some postures.
fn strays<const N: usize>(
    whole: impl Fn(&SVector<f64, N>) -> Matrix4<f64>,
    axes: &[Axis; N],
    zero: &Matrix4<f64>,
) -> f64 {
    let stray = |k: usize| {
        let q = SVector::<f64, N>::from_fn(|i, _| 2.5 * ((k * N + i) as f64 * 1.7).sin());
        let (mut place, mut turn) = (translation(zero), *rotation(zero).matrix());
        for (axis, &angle) in axes.iter().zip(&q).rev() {
            let by = Turn::new(angle);
            place = axis.turn(&(place - axis.point), by) + axis.point;
            turn = axis.turn_all(&turn, by);
        }
        let pose = whole(&q);
        (translation(&pose) - place).norm().max((rotation(&pose).matrix() - turn).norm())
    };
    (1..=8).map(stray).fold(0.0, f64::max)
}
