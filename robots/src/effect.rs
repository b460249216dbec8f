//! The words of a description that the runtime shares: conventions, kinds of
//! joints, and the effects that measurements add to the joints' compliance.

/// Which of the two Denavit-Hartenberg conventions a table is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convention {
    /// `T_i = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i)`; joint `i` acts on the
    /// z axis of frame `i - 1`.
    Standard,
    /// `T_i = Rx(alpha_i) Tx(a_i) Rz(theta_i) Tz(d_i)` with the row's own
    /// alpha and a (those of the link before it); joint `i` acts on the z axis
    /// of frame `i`.
    Modified,
}

/// What a joint does along its axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Turns: the joint coordinate \[rad\] adds to theta.
    Revolute,
    /// Slides: the joint coordinate \[m\] adds to d.
    Prismatic,
}

/// An elastic effect besides the joints' own compliance, with its parameters.
///
/// Joints and links are counted from 1, as in the descriptions. The *joint
/// frame* of joint `i` is frame `i - 1` under the standard convention and
/// frame `i` under the modified one: the frame on whose z axis it acts. The
/// *flange frame* is frame `n`, before the tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effect {
    /// Tilt of a joint about the x and y axes of its joint frame (bearing,
    /// housing).
    TransverseCompliance {
        /// The joint, from 1.
        joint: usize,
        /// Tilt per moment, the same about x and y [rad/Nm].
        value: f64,
    },
    /// A uniform, round beam from the origin of joint frame `link` to the
    /// origin of joint frame `link + 1`.
    LinkCompliance {
        /// The link, from 1 to n - 1.
        link: usize,
        /// `L / EI` [rad/Nm].
        bending: f64,
        /// `L / GJ` [rad/Nm].
        torsion: f64,
    },
    /// Foundation and pedestal, at the origin of frame 0 (after the base
    /// placement). Its turn about z is that of a first joint on the same axis
    /// and is left to it.
    BaseCompliance {
        /// Tilt per moment about x and y of frame 0 [rad/Nm].
        tilt: f64,
        /// Displacement per force, the same in every direction [m/N].
        translation: f64,
    },
    /// Flange, spindle and tool, at the origin of the flange frame.
    ToolCompliance {
        /// Turn per moment, the same about every axis [rad/Nm].
        rotation: f64,
        /// Displacement per force, the same in every direction [m/N].
        translation: f64,
    },
    /// An off-diagonal entry of the joint compliance `H_q` (belts, wrist
    /// gearing); either sign, `|value| < sqrt(h_i h_j)`.
    JointCoupling {
        /// The two joints, from 1, the smaller first.
        joints: [usize; 2],
        /// `H_q[i, j] = H_q[j, i]` [rad/Nm] between two revolute joints.
        value: f64,
    },
    /// Hardening (positive) or softening (negative) of a joint with torque:
    /// the joint turns by `h tau + added tau / sqrt(1 + (tau / knee)^2)`, so
    /// its compliance falls from `h + added` without load to `h` far beyond
    /// the knee.
    StiffnessNonlinearity {
        /// The joint, from 1.
        joint: usize,
        /// What the unloaded joint's compliance has on top [rad/Nm];
        /// above `-h`.
        added: f64,
        /// The torque at which the change is half done \[Nm\], positive.
        knee: f64,
    },
}

impl Effect {
    /// The kind as descriptions and reports spell it, e.g.
    /// `transverse_compliance`.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::TransverseCompliance { .. } => "transverse_compliance",
            Self::LinkCompliance { .. } => "link_compliance",
            Self::BaseCompliance { .. } => "base_compliance",
            Self::ToolCompliance { .. } => "tool_compliance",
            Self::JointCoupling { .. } => "joint_coupling",
            Self::StiffnessNonlinearity { .. } => "stiffness_nonlinearity",
        }
    }

    /// Where the effect sits.
    pub const fn place(&self) -> Place {
        match *self {
            Self::TransverseCompliance { joint, .. } | Self::StiffnessNonlinearity { joint, .. } => Place::Joint(joint),
            Self::LinkCompliance { link, .. } => Place::Link(link),
            Self::BaseCompliance { .. } => Place::Base,
            Self::ToolCompliance { .. } => Place::Tool,
            Self::JointCoupling { joints, .. } => Place::Joints(joints),
        }
    }
}

/// The full name, `kind@at`.
impl core::fmt::Display for Effect {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{}@{}", self.kind(), self.place())
    }
}

/// Where an effect sits; displays as descriptions spell it (`joint 3`,
/// `joints 2,3`, `link 2`, `base`, `tool`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// One joint, from 1.
    Joint(usize),
    /// Two joints, from 1.
    Joints([usize; 2]),
    /// One link, from 1: the body between joints `i` and `i + 1`.
    Link(usize),
    /// The foundation.
    Base,
    /// The flange and what is mounted on it.
    Tool,
}

impl core::fmt::Display for Place {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Joint(i) => write!(f, "joint {i}"),
            Self::Joints([i, j]) => write!(f, "joints {i},{j}"),
            Self::Link(i) => write!(f, "link {i}"),
            Self::Base => f.write_str("base"),
            Self::Tool => f.write_str("tool"),
        }
    }
}
