//! The closed form of arms whose last axes meet in one point.
//!
//! Pieper (The kinematics of manipulators under computer control, 1968): the
//! point where the axes of the wrist meet depends on the first three joints
//! only, so that their angles come first, and the wrist's from what turn is
//! left. Here the first axis is across the second and the third parallel to it
//! (the ortho-parallel base of Brandstoetter, Angerer, Hofbaur, 2014); offsets
//! between them and the angles within the wrist are free. The angles themselves
//! are those of Paden and Kahan's subproblems, on the axes at zero, so that it
//! does not matter how the DH table was laid out.

use core::f64::consts::TAU;

use nalgebra::{Matrix3, Matrix4, SVector, Vector3};

use super::screws::{Axis, across, axes, meeting};
use super::target::{Orientation, Target, rotation, translation};
use crate::Robot;

/// An arm with a closed form: six axes with a spherical wrist, or five of which
/// the last two meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrist<const N: usize> {
    axes: [Axis; N],
    /// The tool's pose at zero.
    zero: Matrix4<f64>,
    /// The point where the wrist's axes meet, at zero (m).
    center: Vector3<f64>,
}

/// Axes apart by less than this times the reach count as meeting (m/m), and
/// angles off by less (rad) as right. What is left of that, such as the errors
/// of a measured DH table, is for the descent that follows.
const NEARLY: f64 = 0.02;

/// Turns about a free tool axis that are tried, where the place of the wrist
/// depends on it.
const TURNS: usize = 120;

/// The angles of the first three joints.
type Base = [f64; 3];

impl<const N: usize> Wrist<N> {
    /// The closed form of a robot; `None` if it has none.
    pub fn of<R: Robot<N>>(robot: &R, reach: f64) -> Option<Self> {
        if !(5..=6).contains(&N) {
            return None;
        }
        let (axes, zero) = axes(robot)?;
        let [first, second, third] = [0, 1, 2].map(|i| axes[i].direction);
        if first.dot(&second).abs() > NEARLY || second.cross(&third).norm() > NEARLY {
            return None;
        }
        let (center, apart) = meeting(&axes[3], &axes[4])?;
        let off_last = axes[N - 1].direction.cross(&(center - axes[N - 1].point)).norm();
        let sixth_turns = N == 5 || axes[4].direction.cross(&axes[5].direction).norm() > NEARLY;
        (apart.max(off_last) <= NEARLY * reach && sixth_turns).then_some(Self { axes, zero, center })
    }

    /// Candidates for a target, which need not be within limits and, where the
    /// target is out of reach or the closed form only near, not on it. Where a
    /// joint may stand anywhere it stands as in the seed.
    pub fn candidates(&self, target: &Target, seed: &SVector<f64, N>, mut found: impl FnMut(SVector<f64, N>)) {
        match &target.orientation {
            Orientation::Full(turn) => {
                let turn = turn.matrix() * rotation(&self.zero).matrix().transpose();
                let center = target.position + turn * (self.center - translation(&self.zero));
                self.base(&center, seed, |base| self.full(base, &turn, seed, &mut found));
            }
            Orientation::Axis { tool, direction } => {
                let tool = rotation(&self.zero) * tool.as_ref();
                let free = Axis { direction: direction.into_inner(), point: target.position };
                let to_center = self.center - translation(&self.zero);
                let off = tool.cross(&to_center).norm();
                let at_center = off <= 1e-9 * to_center.norm();
                if N == 5 && at_center {
                    let center = target.position + free.direction * tool.dot(&to_center);
                    self.base(&center, seed, |base| self.pointing(base, &tool, direction, seed, &mut found));
                } else {
                    self.about(&tool, &free, seed, &mut found);
                }
            }
        }
    }

    /// The first three joints for a place of the wrist: up to four ways.
    fn base(&self, center: &Vector3<f64>, seed: &SVector<f64, N>, mut found: impl FnMut(Base)) {
        let [first, second, third] = [self.axes[0], self.axes[1], self.axes[2]];
        let beside = second.direction.dot(&(self.center - first.point));
        let from_first = center - first.point;
        // The turn back to the plane in which the second and third joint move it.
        let shoulders = match first.angles_towards(&from_first, &second.direction, beside) {
            Some((back, _)) => back.map(|angle| -angle),
            None => [seed[0]; 2],
        };
        let flat = |vector: Vector3<f64>| vector - second.direction * second.direction.dot(&vector);
        let (upper, lower) = (flat(third.point - second.point), flat(self.center - third.point));
        for (which, q1) in shoulders.into_iter().enumerate() {
            if which == 1 && q1 == shoulders[0] {
                continue;
            }
            let wrist = flat(first.turn(&from_first, -q1) + first.point - second.point);
            let projection = 0.5 * (wrist.norm_squared() - upper.norm_squared() - lower.norm_squared());
            let elbows = match third.angles_towards(&lower, &upper, projection) {
                Some((angles, _)) => angles,
                None => [seed[2]; 2],
            };
            for (which, q3) in elbows.into_iter().enumerate() {
                if which == 1 && q3 == elbows[0] {
                    continue;
                }
                let arm = upper + third.turn(&lower, q3);
                let q2 = second.angle(&arm, &wrist).unwrap_or(seed[1]);
                found([q1, q2, q3]);
            }
        }
    }

    /// A vector of the base frame as the first three joints carry it back.
    fn carried_back(&self, base: &Base, vector: &Vector3<f64>) -> Vector3<f64> {
        (0..3).fold(*vector, |vector, i| self.axes[i].turn(&vector, -base[i]))
    }

    /// The turn that is left to the wrist.
    fn left(&self, base: &Base, turn: &Matrix3<f64>) -> Matrix3<f64> {
        Matrix3::from_columns(&[0, 1, 2].map(|k| self.carried_back(base, &turn.column(k).into_owned())))
    }

    /// The wrist for a turn of the whole tool.
    fn full(&self, base: Base, turn: &Matrix3<f64>, seed: &SVector<f64, N>, found: &mut impl FnMut(SVector<f64, N>)) {
        let left = self.left(&base, turn);
        if N == 6 {
            let last = self.axes[N - 1];
            self.pair(&last.direction, &(left * last.direction), seed, |q4, q5| {
                // What the last joint makes of a vector across its axis.
                let turned = left * across(&last);
                let back = self.axes[4].turn(&self.axes[3].turn(&turned, -q4), -q5);
                let q6 = last.angle(&across(&last), &back).unwrap_or(seed[N - 1]);
                found(together(base, &[q4, q5, q6]));
            });
        } else {
            let (fourth, fifth) = (self.axes[3], self.axes[4]);
            let q4 = fourth.angle(&fifth.direction, &(left * fifth.direction)).unwrap_or(seed[3]);
            let back = fourth.turn(&(left * across(&fifth)), -q4);
            let q5 = fifth.angle(&across(&fifth), &back).unwrap_or(seed[4]);
            found(together(base, &[q4, q5]));
        }
    }

    /// The wrist of five axes that points the tool somewhere.
    fn pointing(
        &self,
        base: Base,
        tool: &Vector3<f64>,
        direction: &Vector3<f64>,
        seed: &SVector<f64, N>,
        found: &mut impl FnMut(SVector<f64, N>),
    ) {
        self.pair(tool, &self.carried_back(&base, direction), seed, |q4, q5| found(together(base, &[q4, q5])));
    }

    /// The fourth and fifth joint that bring one vector to another: two ways.
    fn pair(&self, from: &Vector3<f64>, to: &Vector3<f64>, seed: &SVector<f64, N>, mut found: impl FnMut(f64, f64)) {
        let (fourth, fifth) = (self.axes[3], self.axes[4]);
        let angles = match fifth.angles_towards(from, &fourth.direction, fourth.direction.dot(to)) {
            Some((angles, _)) => angles,
            None => [seed[4]; 2],
        };
        for q5 in angles {
            let q4 = fourth.angle(&fifth.turn(from, q5), to).unwrap_or(seed[3]);
            found(q4, q5);
        }
    }

    /// A free turn about the tool's axis that moves the wrist: turns all around
    /// are tried. Six axes can take every one of them; five only those between
    /// which what keeps the fifth axis from its place changes its sign, or comes
    /// near zero.
    fn about(&self, tool: &Vector3<f64>, free: &Axis, seed: &SVector<f64, N>, found: &mut impl FnMut(SVector<f64, N>)) {
        let onto = nalgebra::Rotation3::rotation_between(tool, &free.direction)
            .unwrap_or_else(|| nalgebra::Rotation3::new(super::target::any_across(tool) * core::f64::consts::PI));
        let turned = |angle: f64| {
            let columns = [0, 1, 2].map(|k| free.turn(&onto.matrix().column(k).into_owned(), angle));
            let turn = Matrix3::from_columns(&columns);
            (turn, free.point + turn * (self.center - translation(&self.zero)))
        };
        let step = TAU / TURNS as f64;
        if N == 6 {
            for k in 0..TURNS {
                let (turn, center) = turned(step * k as f64);
                self.base(&center, seed, |base| self.full(base, &turn, seed, found));
            }
            return;
        }
        // What is wrong with the fifth axis after the base's four ways.
        let wrong = |angle: f64| {
            let (turn, center) = turned(angle);
            let (mut values, mut count) = ([f64::NAN; 4], 0);
            self.base(&center, seed, |base| {
                let fifth = self.axes[4].direction;
                let now = self.left(&base, &turn) * fifth;
                values[count] = self.axes[3].direction.dot(&(now - fifth));
                count += 1;
            });
            values
        };
        let near = |angle: f64, way: usize, found: &mut dyn FnMut(SVector<f64, N>)| {
            let (turn, center) = turned(angle);
            let mut count = 0;
            self.base(&center, seed, |base| {
                if count == way {
                    self.full(base, &turn, seed, &mut |q| found(q));
                }
                count += 1;
            });
        };
        let mut last = [wrong(-2.0 * step), wrong(-step)];
        for k in 0..TURNS {
            let angle = step * k as f64;
            let now = wrong(angle);
            for way in 0..4 {
                let [before, middle, here] = [last[0][way], last[1][way], now[way]];
                if middle * here <= 0.0 {
                    let share = middle / (middle - here);
                    near(angle - step + step * if share.is_finite() { share } else { 0.5 }, way, found);
                } else if middle.abs() <= before.abs() && middle.abs() <= here.abs() && before * middle > 0.0 {
                    // The parabola through the three: where it is zero, or lowest.
                    let (slope, bend) = (0.5 * (here - before), 0.5 * (here + before) - middle);
                    let root = (slope * slope - 4.0 * bend * middle).max(0.0).sqrt();
                    for share in [0.5 * (-slope - root) / bend, 0.5 * (-slope + root) / bend] {
                        if share.abs() <= 1.0 {
                            near(angle - step + step * share, way, found);
                        }
                    }
                }
            }
            last = [last[1], now];
        }
    }
}

fn together<const N: usize>(base: Base, wrist: &[f64]) -> SVector<f64, N> {
    SVector::from_iterator(base.into_iter().chain(wrist.iter().copied()))
}
