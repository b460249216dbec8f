//! The elastic elements of a robot, one by one.
//!
//! Every elastic element adds a symmetric 6 x 6 matrix to the Cartesian
//! compliance, `h s s^T` for each of its elastic coordinates: `s` is the twist
//! of the tool centre point (TCP) when the coordinate moves by one, `h` its
//! compliance, and a wrench at the TCP moves it by `h s^T F`. A coordinate that
//! turns about an axis `a` through a point `o` has `s = [a x (p - o); a]` with
//! the TCP at `p`, one that slides along `a` has `s = [a; 0]`.
//!
//! The formulas of what is linear in the load are here once: the reference (`Generic`), the
//! shares that a report shows, and the regressors of an identification all come from
//! [`Geometry::unit_compliance`]. Those of gears that are not are with their effects
//! ([`Effect`]).

use core::fmt;

use nalgebra::{Matrix3, Matrix4, Matrix6, Matrix6x3, SVector, Vector3, Vector6};

use crate::{Convention, Effect, JointKind, Real, Robot};

#[cfg(feature = "generic")]
mod deformed;
mod laws;
#[cfg(all(test, feature = "generic"))]
mod tests;

#[cfg(feature = "generic")]
pub use deformed::{Deformed, Part, Rest, at_rest, deformed, displacement_at};
pub use laws::{
    Torque, commanded_rates, deviation, joint_turns, own_weight_torque, plays, share_of_preload, share_of_weight, turn,
    turn_about, turns_under,
};
pub use robstiff_robots::effect::physics::Spring;

/// Where the parts of a robot are in one pose; every frame a homogeneous
/// 4 x 4 matrix (lengths in m) in the base frame.
#[derive(Clone, Copy, Debug)]
pub struct Geometry<'a, T> {
    /// Frame 0, behind the base placement.
    pub base: Matrix4<T>,
    /// The joint frames in order: the frames on whose z axes the joints act.
    pub joint_frames: &'a [Matrix4<T>],
    /// Turning or sliding, a joint each.
    pub joint_kinds: &'a [JointKind],
    /// Frame n, before the tool.
    pub flange: Matrix4<T>,
    /// The tool centre point's frame.
    pub tcp: Matrix4<T>,
}

impl<T: Real> Geometry<'_, T> {
    /// The twist `[d; r]` of the TCP in the base frame per unit of a joint's
    /// coordinate: column `joint` (from 1) of the Jacobian, `[z x (p - o); z]`
    /// for a revolute joint and `[z; 0]` for a prismatic one.
    ///
    /// # Panics
    /// If there is no such joint.
    pub fn joint_twist(&self, joint: usize) -> Vector6<T> {
        let frame = &self.joint_frames[joint - 1];
        match self.joint_kinds[joint - 1] {
            JointKind::Revolute => self.lever(frame) * axis(frame, 2),
            JointKind::Prismatic => translations() * axis(frame, 2),
        }
    }

    /// What a spring of value 1 adds to the compliance at the TCP in the
    /// base frame, 6 x 6 symmetric; its units are those of a compliance over
    /// those of the spring.
    ///
    /// A link is a uniform round beam: it bends at every point `o(xi)` between
    /// its ends by the same compliance per length, and the integral of
    /// `s(xi) s(xi)^T` over `xi` from 0 to 1, with `s` linear in between, is
    /// `1/3 (s0 s0^T + s1 s1^T) + 1/6 (s0 s1^T + s1 s0^T)`. A link whose ends
    /// coincide has no direction and adds nothing.
    ///
    /// # Panics
    /// If there is no such joint or link.
    pub fn unit_compliance(&self, spring: Spring) -> Matrix6<T> {
        let outer = |s: Vector6<T>| s * s.transpose();
        match spring {
            Spring::Joint(joint) => outer(self.joint_twist(joint)),
            Spring::Transverse(joint) => self.tilt(&self.joint_frames[joint - 1]),
            Spring::LinkBending(link) => self.bending(link),
            Spring::LinkTorsion(link) => {
                let lever = self.lever(&self.joint_frames[link - 1]);
                lever * self.along_link(link) * lever.transpose()
            }
            Spring::BaseTilt => self.tilt(&self.base),
            Spring::BaseTranslation | Spring::ToolTranslation => translations() * translations().transpose(),
            Spring::ToolRotation => {
                let lever = self.lever(&self.flange);
                lever * lever.transpose()
            }
            Spring::Coupling([i, j]) => {
                let product = self.joint_twist(i) * self.joint_twist(j).transpose();
                product + product.transpose()
            }
        }
    }

    /// The twists at the TCP of turns about the base frame's axes through the
    /// origin of `frame`, a column each.
    fn lever(&self, frame: &Matrix4<T>) -> Matrix6x3<T> {
        let arm = origin(&self.tcp) - origin(frame);
        let mut lever = Matrix6x3::zeros();
        for k in 0..3 {
            let turn = Vector3::ith(k, T::one());
            lever.fixed_view_mut::<3, 1>(0, k).copy_from(&turn.cross(&arm));
            lever.fixed_view_mut::<3, 1>(3, k).copy_from(&turn);
        }
        lever
    }

    /// Tilt about the x and y axes of a frame, at its origin.
    fn tilt(&self, frame: &Matrix4<T>) -> Matrix6<T> {
        let lever = self.lever(frame);
        let (x, y) = (axis(frame, 0), axis(frame, 1));
        lever * (x * x.transpose() + y * y.transpose()) * lever.transpose()
    }

    /// `e e^T` for the unit vector `e` along a link; zero where the link has
    /// no length.
    fn along_link(&self, link: usize) -> Matrix3<T> {
        let along = origin(&self.joint_frames[link]) - origin(&self.joint_frames[link - 1]);
        let length_squared = along.dot(&along);
        // Exact: a row with d = a = 0 adds zeros to the origin before it.
        if length_squared == T::zero() {
            return Matrix3::zeros();
        }
        along * along.transpose() * length_squared.recip()
    }

    fn bending(&self, link: usize) -> Matrix6<T> {
        let along = self.along_link(link);
        if along == Matrix3::zeros() {
            return Matrix6::zeros();
        }
        // Summed over two directions u perpendicular to e, u u^T is I - e e^T.
        let across = Matrix3::identity() - along;
        let near = self.lever(&self.joint_frames[link - 1]);
        let far = self.lever(&self.joint_frames[link]);
        let ends = near * across * near.transpose() + far * across * far.transpose();
        let mixed = near * across * far.transpose();
        ends * T::of(1.0 / 3.0) + (mixed + mixed.transpose()) * T::of(1.0 / 6.0)
    }
}

/// The linear elements of an effect, with their compliances.
pub fn springs(effect: &Effect) -> impl Iterator<Item = (Spring, f64)> + use<> {
    let numbers = effect.numbers();
    effect.springs().map(move |(k, spring)| (spring, numbers[k]))
}

/// A robot's joint frames, kinds and ends in one pose, owned: what a
/// [`Geometry`] borrows.
#[derive(Clone, Debug)]
pub struct Pose<const N: usize, T> {
    base: Matrix4<T>,
    joint_frames: [Matrix4<T>; N],
    joint_kinds: [JointKind; N],
    flange: Matrix4<T>,
    tcp: Matrix4<T>,
}

impl<const N: usize, T: Real> Pose<N, T> {
    /// The pose of a robot, generated or generic, at joint coordinates `q`
    /// [rad or m].
    pub fn of<R: Robot<N>>(robot: &R, q: &SVector<T, N>) -> Self {
        let (base, links) = (robot.base().map(T::of), robot.link_frames(q));
        Self {
            base,
            joint_frames: joint_frames(robot.convention(), &base, &links),
            joint_kinds: robot.joint_kinds(),
            flange: links.last().copied().unwrap_or(base),
            tcp: robot.transform(q),
        }
    }

    /// The pose as slices.
    pub fn geometry(&self) -> Geometry<'_, T> {
        Geometry {
            base: self.base,
            joint_frames: &self.joint_frames,
            joint_kinds: &self.joint_kinds,
            flange: self.flange,
            tcp: self.tcp,
        }
    }
}

/// The joint frames among frames 0 to N: joint `i` acts on the z axis of frame
/// `i - 1` under the standard convention, of frame `i` under the modified one.
fn joint_frames<const N: usize, T: Real>(
    convention: Convention,
    base: &Matrix4<T>,
    links: &[Matrix4<T>; N],
) -> [Matrix4<T>; N] {
    core::array::from_fn(|i| match (convention, i) {
        (Convention::Standard, 0) => *base,
        (Convention::Standard, _) => links[i - 1],
        (Convention::Modified, _) => links[i],
    })
}

/// The frame in the base frame on whose z axis a joint (from 1) acts, 4 x 4.
///
/// # Panics
/// If there is no such joint.
pub fn joint_frame<const N: usize, T, R>(robot: &R, q: &SVector<T, N>, joint: usize) -> Matrix4<T>
where
    T: Real,
    R: Robot<N>,
{
    joint_frames(robot.convention(), &robot.base().map(T::of), &robot.link_frames(q))[joint - 1]
}

/// What an element of the compliance is; displays as `joint 3` or
/// `transverse_compliance@joint 3`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Element<'a> {
    /// A joint's own compliance, counted from 1.
    Joint(usize),
    /// An effect of the description.
    Effect(&'a Effect),
}

impl fmt::Display for Element<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joint(joint) => write!(f, "joint {joint}"),
            Self::Effect(effect) => effect.fmt(f),
        }
    }
}

/// What each joint and then each effect gives to the 6 x 6 compliance at the
/// TCP in the base frame (m/N, m/Nm, rad/N, rad/Nm by block), in the order of
/// the description; of a nonlinear effect the tangent in the unloaded state, of a
/// kinematic one nothing. The sum is [`Robot::compliance`].
pub fn contributions<'r, const N: usize, T, R>(
    robot: &'r R,
    q: &SVector<T, N>,
) -> impl Iterator<Item = (Element<'r>, Matrix6<T>)> + use<'r, N, T, R>
where
    T: Real,
    R: Robot<N>,
{
    contributions_under(robot, q, &Vector6::zeros())
}

/// The 6 x 6 compliance at the TCP in the base frame (m/N, m/Nm, rad/N, rad/Nm by
/// block) for small changes about a wrench `[f; m]` there (N, Nm), at joint
/// coordinates `q` [rad or m]: [`Robot::compliance`] with every law of a joint at
/// the joint's torque instead of without load. Backlash is then on one flank, and
/// hysteresis, within whose radii small changes turn back, adds nothing.
pub fn compliance_under<const N: usize, T, R>(robot: &R, q: &SVector<T, N>, wrench: &Vector6<T>) -> Matrix6<T>
where
    T: Real,
    R: Robot<N>,
{
    contributions_under(robot, q, wrench).fold(Matrix6::zeros(), |sum, (_, part)| sum + part)
}

/// What each joint and then each effect gives to the compliance under a wrench, as
/// [`contributions`] are of that without load; the sum is [`compliance_under`].
pub fn contributions_under<'r, const N: usize, T, R>(
    robot: &'r R,
    q: &SVector<T, N>,
    wrench: &Vector6<T>,
) -> impl Iterator<Item = (Element<'r>, Matrix6<T>)> + use<'r, N, T, R>
where
    T: Real,
    R: Robot<N>,
{
    let (pose, q) = (Pose::of(robot, q), *q);
    let torques = robot.preload(&q) + robot.joint_torques(&q, wrench);
    let (own, effects) = (robot.joint_compliance(), robot.effects());
    (0..N + effects.len()).map(move |k| {
        let geometry = pose.geometry();
        let Some(k) = k.checked_sub(N) else {
            return (Element::Joint(k + 1), geometry.unit_compliance(Spring::Joint(k + 1)) * T::of(own[k]));
        };
        let slope = |joint: usize| turn_about(&effects[k], T::of(own[joint - 1]), q[joint - 1], torques[joint - 1]);
        (Element::Effect(&effects[k]), with_law(&geometry, &effects[k], slope))
    })
}

/// The springs of an effect and, where it is the law of a joint (from 1), this
/// slope of it (rad/Nm).
fn with_law<T: Real>(
    geometry: &Geometry<'_, T>,
    effect: &Effect,
    slope: impl FnOnce(usize) -> Option<T>,
) -> Matrix6<T> {
    let sum = springs(effect)
        .fold(Matrix6::zeros(), |sum, (spring, value)| sum + geometry.unit_compliance(spring) * T::of(value));
    let law = effect.row().and_then(|joint| Some(geometry.unit_compliance(Spring::Joint(joint)) * slope(joint)?));
    law.map_or(sum, |law| sum + law)
}

/// Which share of the displacement along a force comes from one element,
/// `u^T C_k u / u^T H u`: its compliance `part`, that of the robot `whole`, the
/// force along `direction` (of any length) in the base frame. Negative where a
/// coupling or softening takes away; `None` where the robot does not yield that
/// way at all.
pub fn share_along<T: Real>(part: &Matrix6<T>, whole: &Matrix6<T>, direction: &Vector3<T>) -> Option<T> {
    let along = |compliance: &Matrix6<T>| direction.dot(&(translational_block(compliance) * direction));
    ratio(along(part), along(whole))
}

/// Which share of the trace of the translational block (the displacement per
/// force, averaged over all directions) comes from one element; `None` where
/// the robot does not yield to forces at all.
pub fn share_of_translation<T: Real>(part: &Matrix6<T>, whole: &Matrix6<T>) -> Option<T> {
    let trace = |compliance: &Matrix6<T>| compliance[(0, 0)] + compliance[(1, 1)] + compliance[(2, 2)];
    ratio(trace(part), trace(whole))
}

fn ratio<T: Real>(part: T, whole: T) -> Option<T> {
    (whole != T::zero()).then(|| part * whole.recip())
}

fn translational_block<T: Real>(compliance: &Matrix6<T>) -> Matrix3<T> {
    compliance.fixed_view::<3, 3>(0, 0).into_owned()
}

/// The twists of translations along the base frame's axes, a column each.
fn translations<T: Real>() -> Matrix6x3<T> {
    Matrix6x3::identity()
}

fn axis<T: Real>(frame: &Matrix4<T>, k: usize) -> Vector3<T> {
    frame.fixed_view::<3, 1>(0, k).into_owned()
}

fn origin<T: Real>(frame: &Matrix4<T>) -> Vector3<T> {
    axis(frame, 3)
}
