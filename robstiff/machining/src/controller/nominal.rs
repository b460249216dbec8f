//! The model that a controller solves with.

use nalgebra::{Isometry3, Matrix4, Rotation3, SVector, Translation3, UnitQuaternion};
use robstiff::{Generic, Robot};
use robstiff_robots::{Controller, Description, JointKind, Placement};

use crate::program::angles::to_abc;

/// The model that a controller solves with: the table of its description without effects, and
/// without a tool.
#[derive(Clone, Debug)]
pub struct Nominal<const N: usize> {
    pub(super) arm: Generic<N>,
    pub(super) controller: Controller,
    /// The controller's world in the base frame, and its flange in the flange frame.
    world: Isometry3<f64>,
    flange: Isometry3<f64>,
}

/// Why there is no nominal model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoNominal {
    /// The description does not say what the pendant shows.
    NoController,
    /// The nominal description has joints in another number, or another kind.
    OtherJoints {
        /// What it has.
        nominal: String,
        /// What the robot has.
        robot: String,
    },
}

impl core::fmt::Display for NoNominal {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NoController => f.write_str(
                "the description has no `controller`: write how the pendant counts each joint, or `controller: {}` if \
                 it shows the joint coordinates and the controller solves with this table",
            ),
            Self::OtherJoints { nominal, robot } => {
                write!(f, "the nominal description has the joints {nominal}, the robot {robot}: they must be the same")
            }
        }
    }
}

impl core::error::Error for NoNominal {}

impl<const N: usize> Nominal<N> {
    /// The model of a robot's controller. `nominal` is the description that its `controller`
    /// names; without one it is the robot's table. Effects, tool and compliances have no part in
    /// it. Where a nominal joint has no limits, they are the robot's.
    ///
    /// # Errors
    /// Why there is none.
    ///
    /// # Panics
    /// If the robot has not `N` joints.
    pub fn new(robot: &Description, nominal: Option<&Description>) -> Result<Self, NoNominal> {
        let controller = robot.controller.clone().ok_or(NoNominal::NoController)?;
        let mut model = nominal.unwrap_or(robot).clone();
        let [ours, theirs] = [robot, &model].map(|of| of.joints.iter().map(|joint| joint.kind).collect::<Vec<_>>());
        if ours != theirs {
            return Err(NoNominal::OtherJoints { nominal: listed(&theirs), robot: listed(&ours) });
        }
        model.effects.clear();
        model.links.clear();
        model.tool = Placement::default();
        for (joint, of_robot) in model.joints.iter_mut().zip(&robot.joints) {
            joint.limits = joint.limits.or(of_robot.limits);
            joint.compliance.clear();
        }
        let arm = Generic::new(&model).expect("it has as many joints as the robot");
        let [world, flange] = [&controller.world, &controller.flange].map(isometry);
        Ok(Self { arm, controller, world, flange })
    }

    /// The TCP's frame in the base frame (m) at joint coordinates (rad or m), as the controller
    /// has it; the tool is given in the controller's flange.
    pub fn pose(&self, q: &SVector<f64, N>, tool: &Isometry3<f64>) -> Isometry3<f64> {
        isometry_of(&self.arm.transform(q)) * self.flange * tool
    }

    /// A frame in the controller's world that is given in the base frame.
    pub fn in_world(&self, frame: &Isometry3<f64>) -> Isometry3<f64> {
        self.world.inverse() * frame
    }

    /// A frame in the base frame that is given in the controller's world.
    pub fn in_base(&self, frame: &Isometry3<f64>) -> Isometry3<f64> {
        self.world * frame
    }

    /// A tool in the controller's flange that a description gives in its flange frame.
    pub fn tool(&self, tool: &Placement) -> Isometry3<f64> {
        self.flange.inverse() * isometry(tool)
    }

    /// A tool in the flange frame of the description that is given in the controller's flange.
    pub fn tool_of_arm(&self, tool: &Isometry3<f64>) -> Isometry3<f64> {
        self.flange * tool
    }

    /// What the pendant shows at joint coordinates (rad or m).
    pub fn pendant(&self, q: &SVector<f64, N>) -> Vec<f64> {
        self.controller.q_to_pendant(q.as_slice())
    }

    /// The joint coordinates (rad or m) at which the pendant shows these; `None` for another
    /// number of them.
    pub fn joints(&self, pendant: &[f64]) -> Option<SVector<f64, N>> {
        (pendant.len() == N).then(|| SVector::from_column_slice(&self.controller.pendant_to_q(pendant)))
    }
}

fn listed(kinds: &[JointKind]) -> String {
    let letters = kinds.iter().map(|kind| if *kind == JointKind::Revolute { "turning" } else { "sliding" });
    letters.collect::<Vec<_>>().join(", ")
}

/// A placement as a motion (m).
pub fn isometry(placement: &Placement) -> Isometry3<f64> {
    let ([x, y, z], [roll, pitch, yaw]) = (placement.xyz, placement.rpy);
    Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_euler_angles(roll, pitch, yaw))
}

/// A motion (m) as a placement.
pub fn placement(motion: &Isometry3<f64>) -> Placement {
    let [yaw, pitch, roll] = to_abc(&motion.rotation);
    Placement { xyz: motion.translation.vector.into(), rpy: [roll, pitch, yaw] }
}

/// A homogeneous matrix as a motion (m).
pub fn isometry_of(pose: &Matrix4<f64>) -> Isometry3<f64> {
    let turn = Rotation3::from_matrix_unchecked(pose.fixed_view::<3, 3>(0, 0).into_owned());
    let at = pose.fixed_view::<3, 1>(0, 3).into_owned();
    Isometry3::from_parts(Translation3::from(at), UnitQuaternion::from_rotation_matrix(&turn))
}
