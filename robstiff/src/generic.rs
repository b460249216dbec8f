//! Robots read at run time.

use std::fmt;
use std::string::String;
use std::vec::Vec;

use nalgebra::{Matrix4, Matrix6, SMatrix, SVector, Vector6};
use robstiff_robots::angle::{quarter_turns, sin_cos_of_turns};
use robstiff_robots::words::count;
use robstiff_robots::{Description, Joint, Placement};

use crate::elements::{Pose, Torque, contributions, deviation, plays, springs, turn};
use crate::{Convention, Effect, JointKind, Real, Robot, State};
use weight::Weight;

#[cfg(test)]
mod tests;
#[cfg(test)]
mod turns_tests;
mod weight;

/// A robot with `N` joints, built from a [`Description`] at run time.
///
/// It computes the way the textbooks write it down: 4 x 4 matrices multiplied
/// from the base to the tool, the Jacobian from axes and lever arms, the
/// compliance as the sum of its elements' 6 x 6 matrices. That makes it slower
/// than generated code and independent of it: generated code is tested against
/// this.
#[derive(Clone, Debug, PartialEq)]
pub struct Generic<const N: usize> {
    name: String,
    convention: Convention,
    base: Matrix4<f64>,
    joints: [Row; N],
    tool: Matrix4<f64>,
    compliance: SVector<f64, N>,
    effects: Vec<Effect>,
    weight: Option<Weight<N>>,
}

/// One row of the DH table: `motion(q) * still`, of the modified convention `still * motion(q)`.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    kind: JointKind,
    limits: Option<[f64; 2]>,
    moves_first: bool,
    still: Matrix4<f64>,
}

/// Evaluates an expression with a robot whose number of joints is known only at
/// run time: `with_robot!(&description, |robot| expression)`, where `robot` is
/// a `Generic<N>` for the `N` the description has. The expression is compiled
/// for every `N` from 1 to 8, so let it call a generic function. The description
/// is evaluated once.
///
/// # Panics
/// On a description that was not read but built, with no or more than eight
/// joints.
///
/// ```
/// use robstiff::Robot;
/// use robstiff::nalgebra::SVector;
/// use robstiff::robots::{Description, catalogue};
///
/// fn reach<const N: usize>(robot: &impl Robot<N>) -> f64 {
///     robot.transform(&SVector::<f64, N>::zeros()).fixed_view::<3, 1>(0, 3).norm()
/// }
///
/// let text = catalogue::find("staubli-rx160").unwrap();
/// let description = Description::parse("staubli-rx160.yaml", text).unwrap();
/// assert!(robstiff::with_robot!(&description, |robot| reach(&robot)) > 1.0);
/// ```
#[macro_export]
macro_rules! with_robot {
    ($description:expr, |$robot:ident| $body:expr) => {
        $crate::with_robot!($description, |$robot| $body, 1 2 3 4 5 6 7 8)
    };
    ($description:expr, |$robot:ident| $body:expr, $($count:literal)+) => {
        // A match, since what the description borrows from may be made in passing.
        match $description {
            description => match description.joints.len() {
                $($count => {
                    let $robot = $crate::Generic::<$count>::new(description).expect("this arm has the same count");
                    $body
                })+
                count => panic!("a robot has one to eight joints, this one has {count}"),
            },
        }
    };
}

/// A description has another number of joints than the type it was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongJointCount {
    /// The type's number of joints.
    pub expected: usize,
    /// The description's.
    pub found: usize,
}

impl fmt::Display for WrongJointCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let expected = count(self.expected, "joint");
        write!(f, "a robot with {expected} was asked for, the description has {}", self.found)
    }
}

impl core::error::Error for WrongJointCount {}

impl<const N: usize> Generic<N> {
    /// The robot that a description describes.
    ///
    /// The description is taken to be one that its reader accepted; an effect
    /// at a joint that is not there panics when it is first computed.
    ///
    /// # Errors
    /// [`WrongJointCount`] if the description does not have `N` joints.
    pub fn new(description: &Description) -> Result<Self, WrongJointCount> {
        let found = description.joints.len();
        if found != N {
            return Err(WrongJointCount { expected: N, found });
        }
        let joints = description.corrected_joints();
        Ok(Self {
            name: description.name.clone(),
            convention: description.convention,
            base: placement(&description.base),
            joints: core::array::from_fn(|i| Row::new(description.convention, &joints[i])),
            tool: placement(&description.tool),
            compliance: SVector::from_fn(|i, _| description.joints[i].compliance()),
            effects: description.effects.clone(),
            weight: Weight::of(description),
        })
    }
}

impl<const N: usize> Generic<N> {
    /// The frames behind the joints, which stand at these coordinates.
    fn frames_behind<T: Real>(&self, stand: &SVector<T, N>) -> [Matrix4<T>; N] {
        let mut frame = self.base.map(T::of);
        core::array::from_fn(|i| {
            frame = self.joints[i].behind(frame, stand[i]);
            frame
        })
    }

    /// Where the joints stand at their coordinates, but for a sag and for whole turns.
    fn upright<T: Real>(&self, q: &SVector<T, N>) -> SVector<T, N> {
        SVector::from_fn(|i, _| {
            let aside = self.effects.iter().filter(|effect| effect.row() == Some(i + 1));
            let aside = aside.filter_map(|effect| deviation(effect, q[i]));
            let coordinate = match self.joints[i].kind {
                JointKind::Revolute => q[i].wrapped(),
                JointKind::Prismatic => q[i],
            };
            aside.fold(coordinate, |sum, aside| sum + aside)
        })
    }

    /// A share of what the arm's own weight puts on the joints.
    fn carried<T: Real>(&self, weight: &Weight<N>, share: f64, upright: &[Matrix4<T>; N]) -> SVector<T, N> {
        weight.torques(self.convention, self.joint_kinds(), &self.base, upright) * T::of(share)
    }
}

impl Row {
    fn new(convention: Convention, joint: &Joint) -> Self {
        let z = rotation_z(sin_cos(joint.theta)) * translation([0.0, 0.0, joint.d]);
        // A rotation about x and a translation along it commute.
        let x = translation([joint.a, 0.0, 0.0]) * rotation_x(sin_cos(joint.alpha));
        // So do a turn about z and a slide along it, the joint's motion among them.
        let still = match convention {
            Convention::Standard => z * x,
            Convention::Modified => x * z,
        };
        Self { kind: joint.kind, limits: joint.limits, moves_first: convention == Convention::Standard, still }
    }

    /// The frame behind this row, of the one before it and the joint coordinate.
    fn behind<T: Real>(&self, before: Matrix4<T>, q: T) -> Matrix4<T> {
        let still = self.still.map(T::of);
        if self.moves_first { self.moved(before, q) * still } else { self.moved(before * still, q) }
    }

    /// A frame turned about its z axis, or slid along it: of the columns only those that change.
    fn moved<T: Real>(&self, mut frame: Matrix4<T>, q: T) -> Matrix4<T> {
        match self.kind {
            JointKind::Revolute => {
                let (s, c) = q.sin_cos();
                for row in 0..3 {
                    let (x, y) = (frame[(row, 0)], frame[(row, 1)]);
                    frame[(row, 0)] = x * c + y * s;
                    frame[(row, 1)] = y * c - x * s;
                }
            }
            JointKind::Prismatic => {
                for row in 0..3 {
                    let slide = frame[(row, 2)] * q;
                    frame[(row, 3)] += slide;
                }
            }
        }
        frame
    }
}

impl<const N: usize> Robot<N> for Generic<N> {
    fn name(&self) -> &str {
        &self.name
    }

    fn convention(&self) -> Convention {
        self.convention
    }

    fn joint_kinds(&self) -> [JointKind; N] {
        core::array::from_fn(|i| self.joints[i].kind)
    }

    fn joint_compliance(&self) -> SVector<f64, N> {
        self.compliance
    }

    fn limits(&self) -> [Option<[f64; 2]>; N] {
        core::array::from_fn(|i| self.joints[i].limits)
    }

    fn effects(&self) -> &[Effect] {
        &self.effects
    }

    fn base(&self) -> Matrix4<f64> {
        self.base
    }

    fn tool(&self) -> Matrix4<f64> {
        self.tool
    }

    fn transform<T: Real>(&self, q: &SVector<T, N>) -> Matrix4<T> {
        self.link_frames(q).last().copied().unwrap_or(self.base.map(T::of)) * self.tool.map(T::of)
    }

    fn link_frames<T: Real>(&self, q: &SVector<T, N>) -> [Matrix4<T>; N] {
        let stand = self.upright(q);
        let upright = self.frames_behind(&stand);
        let Some((weight, share)) = self.weight.as_ref().and_then(|weight| Some((weight, weight.sag?))) else {
            return upright;
        };
        let sag = self.carried(weight, share, &upright).component_mul(&self.compliance.map(T::of));
        self.frames_behind(&(stand + sag))
    }

    fn jacobian<T: Real>(&self, q: &SVector<T, N>) -> SMatrix<T, 6, N> {
        let pose = Pose::of(self, q);
        let mut jacobian: SMatrix<T, 6, N> = SMatrix::zeros();
        for i in 0..N {
            jacobian.set_column(i, &pose.geometry().joint_twist(i + 1));
        }
        jacobian
    }

    fn compliance<T: Real>(&self, q: &SVector<T, N>) -> Matrix6<T> {
        contributions(self, q).fold(Matrix6::zeros(), |sum, (_, part)| sum + part)
    }

    fn deflection<T: Real>(&self, q: &SVector<T, N>, wrench: &Vector6<T>) -> Vector6<T> {
        self.deflection_with(q, wrench, &mut State::new())
    }

    fn deflection_with<T: Real>(&self, q: &SVector<T, N>, wrench: &Vector6<T>, state: &mut State<N, T>) -> Vector6<T> {
        let pose = Pose::of(self, q);
        let geometry = pose.geometry();
        let (mut deflection, preload) = (Vector6::zeros(), self.preload(q));
        for i in 0..N {
            let twist = geometry.joint_twist(i + 1);
            deflection += twist * (twist.dot(wrench) * T::of(self.compliance[i]));
        }
        for effect in &self.effects {
            for (spring, value) in springs(effect) {
                deflection += geometry.unit_compliance(spring) * wrench * T::of(value);
            }
            let Some(i) = effect.row().map(|joint| joint - 1) else { continue };
            let twist = geometry.joint_twist(i + 1);
            let torque = Torque { preload: preload[i], load: twist.dot(wrench) };
            state.plays[i] = plays(effect, torque, state.plays[i]);
            if let Some(turn) = turn(effect, T::of(self.compliance[i]), q[i], torque, state.plays[i]) {
                deflection += twist * turn;
            }
        }
        deflection
    }

    fn joint_torques<T: Real>(&self, q: &SVector<T, N>, wrench: &Vector6<T>) -> SVector<T, N> {
        self.jacobian(q).transpose() * wrench
    }

    fn preload<T: Real>(&self, q: &SVector<T, N>) -> SVector<T, N> {
        let weight = self.weight.as_ref().and_then(|weight| Some((weight, weight.preload?)));
        weight.map_or_else(SVector::zeros, |(weight, share)| {
            self.carried(weight, share, &self.frames_behind(&self.upright(q)))
        })
    }
}

/// `Rz(yaw) Ry(pitch) Rx(roll)` about the origin at `xyz`.
fn placement(placement: &Placement) -> Matrix4<f64> {
    let [roll, pitch, yaw] = placement.rpy.map(sin_cos);
    translation(placement.xyz) * rotation_z(yaw) * rotation_y(pitch) * rotation_x(roll)
}

/// Sine and cosine of a constant of the description, exact at the multiples of
/// 90 degrees.
fn sin_cos(angle: f64) -> (f64, f64) {
    quarter_turns(angle).map_or_else(|| Real::sin_cos(angle), sin_cos_of_turns)
}

fn translation([x, y, z]: [f64; 3]) -> Matrix4<f64> {
    let (o, i) = (0.0, 1.0);
    Matrix4::new(i, o, o, x, o, i, o, y, o, o, i, z, o, o, o, i)
}

fn rotation_x((s, c): (f64, f64)) -> Matrix4<f64> {
    let (o, i) = (0.0, 1.0);
    Matrix4::new(i, o, o, o, o, c, -s, o, o, s, c, o, o, o, o, i)
}

fn rotation_y((s, c): (f64, f64)) -> Matrix4<f64> {
    let (o, i) = (0.0, 1.0);
    Matrix4::new(c, o, s, o, o, i, o, o, -s, o, c, o, o, o, o, i)
}

fn rotation_z((s, c): (f64, f64)) -> Matrix4<f64> {
    let (o, i) = (0.0, 1.0);
    Matrix4::new(c, -s, o, o, s, c, o, o, o, o, i, o, o, o, o, i)
}
