//! Arms with a closed form that a first axis carries: on a rail, or on a turntable.
//!
//! With that axis at any coordinate the others have the closed form of the arm where it then stands.

use nalgebra::{Isometry3, Matrix4, SVector, Translation3, Unit, UnitQuaternion, Vector3};

use super::screws::{Axis, axes_behind};
use super::target::{Target, translation};
use super::wrist::{Sides, Wrist};
use robstiff::{JointKind, Robot};

/// The closed form of a robot.
#[derive(Clone, Debug)]
pub enum Closed<const N: usize> {
    /// Of five or six axes: its own.
    Own(Wrist<N>),
    /// Of seven: that of the six that the first one carries.
    Carried(Carrier, Box<Wrist<6>>),
}

/// The axis that carries an arm.
#[derive(Clone, Debug)]
pub struct Carrier {
    kind: JointKind,
    /// At zero, in the base frame.
    axis: Axis,
    /// Whether it moves the arm only nearly as its coordinate says.
    only_near: bool,
}

/// Carried arms stray by less than this (m, rad) where the first joint moves by its coordinate.
const EXACTLY: f64 = 1e-9;

impl<const N: usize> Closed<N> {
    /// That of a robot of a size (m); `None` if it has none.
    pub fn of<R: Robot<N>>(robot: &R, reach: f64) -> Option<Self> {
        if N != 7 {
            return Wrist::of(robot, reach).map(Self::Own);
        }
        let (axes, pose) = axes_behind::<N, 6, R>(robot, 1)?;
        let whole = |q: &SVector<f64, 6>| robot.transform(&behind(0.0, q));
        let wrist = Wrist::of_axes(axes, &pose, whole, reach)?;
        Some(Self::Carried(Carrier::of(robot, reach), Box::new(wrist)))
    }

    /// Whether the first axis carries the arm.
    pub fn is_carried(&self) -> bool {
        matches!(self, Self::Carried(..))
    }

    /// Whether solutions need the descent.
    pub fn only_near(&self) -> bool {
        match self {
            Self::Own(wrist) => wrist.only_near(),
            Self::Carried(carrier, wrist) => carrier.only_near || wrist.only_near(),
        }
    }

    /// Candidates for a target; where the arm is carried, with the first axis as in the seed.
    pub fn candidates(&self, target: &Target, seed: &SVector<f64, N>, mut found: impl FnMut(SVector<f64, N>)) {
        match self {
            Self::Own(wrist) => wrist.candidates(target, seed, found),
            Self::Carried(carrier, wrist) => {
                let at = seed[0];
                let target = target.placed(&carrier.motion(-at));
                wrist.candidates(&target, &arm(seed), |q| found(behind(at, &q)));
            }
        }
    }

    /// On which sides of its axes the arm is; where it is carried, as it stands with the first axis at zero.
    pub fn sides(&self, q: &SVector<f64, N>) -> Sides {
        match self {
            Self::Own(wrist) => wrist.sides(q),
            Self::Carried(_, wrist) => wrist.sides(&arm(q)),
        }
    }

    /// The sines of the angles from where the arm is singular.
    pub fn openness(&self, q: &SVector<f64, N>) -> [f64; 3] {
        match self {
            Self::Own(wrist) => wrist.openness(q),
            Self::Carried(_, wrist) => wrist.openness(&arm(q)),
        }
    }
}

impl Carrier {
    fn of<const N: usize, R: Robot<N>>(robot: &R, reach: f64) -> Self {
        let zero = SVector::<f64, N>::zeros();
        let (pose, jacobian) = (robot.transform(&zero), robot.jacobian(&zero));
        let [velocity, turn] = [0, 3].map(|row| Vector3::from(jacobian.fixed_view::<3, 1>(row, 0)));
        let kind = robot.joint_kinds()[0];
        let direction = if kind == JointKind::Revolute { turn } else { velocity };
        let axis = Axis { direction, point: translation(&pose) + direction.cross(&velocity) };
        let mut carrier = Self { kind, axis, only_near: false };
        let strays = |k: usize| {
            let q = SVector::<f64, 6>::from_fn(|i, _| 2.5 * ((k * N + i) as f64 * 1.7).sin());
            let at = 0.7 * k as f64 - 2.0;
            let apart = robot.transform(&behind::<N>(at, &q)) - carrier.motion(at) * robot.transform(&behind(0.0, &q));
            apart.amax() > EXACTLY * reach.max(1.0)
        };
        carrier.only_near = (1..=4).any(strays);
        carrier
    }

    /// What it moves the arm by from zero (rad or m).
    fn motion(&self, by: f64) -> Matrix4<f64> {
        let Axis { direction, point } = self.axis;
        let direction = Unit::new_normalize(direction);
        match self.kind {
            JointKind::Prismatic => Matrix4::new_translation(&(direction.into_inner() * by)),
            JointKind::Revolute => {
                let turn = UnitQuaternion::from_axis_angle(&direction, by);
                Isometry3::from_parts(Translation3::from(point - turn * point), turn).to_homogeneous()
            }
        }
    }
}

/// The coordinates of the arm alone.
fn arm<const N: usize>(q: &SVector<f64, N>) -> SVector<f64, 6> {
    SVector::from_fn(|i, _| q[i + 1])
}

/// Those of all axes.
fn behind<const N: usize>(first: f64, q: &SVector<f64, 6>) -> SVector<f64, N> {
    SVector::from_fn(|i, _| if i == 0 { first } else { q[i - 1] })
}
