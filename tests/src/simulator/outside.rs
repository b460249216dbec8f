//! Things that robots and rigs do and no catalogue of effects has: tracing
//! must not give them another's name as the whole truth.

use super::gear::Gear;

/// Something outside the catalogue. Joints and links are counted from 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outside {
    /// Grease and seals: a spring and a dashpot side by side, in line with the
    /// gear. Readings are taken before it has arrived, so they depend on how
    /// long a load has been on.
    ViscousJoint {
        /// The joint.
        joint: usize,
        /// What it comes to in the end (rad/Nm).
        compliance: f64,
        /// Time constant (s).
        constant: f64,
    },
    /// A hose package that runs from the hall to the end of a link: a stretched
    /// spring beside the arm, which shares the load with it. It is not in
    /// series with anything, so it is no compliance of an element.
    Cable {
        /// The link whose frame it is tied to.
        link: usize,
        /// The other end, in the base frame (m).
        anchor: [f64; 3],
        /// (N/m)
        stiffness: f64,
        /// Its length (m) without force; it hangs loose where it is shorter.
        length: f64,
    },
    /// One link grows as the arm warms up, along itself, wherever that points.
    LinkGrowth {
        /// The link: the straight piece of this row of the DH table.
        link: usize,
        /// Strain per kelvin of the hall.
        per_kelvin: f64,
    },
    /// The robot stands on a mat that hardens: the tilt per moment `m` is
    /// `compliance / sqrt(1 + (m / knee)^2)`.
    SoftFoundation {
        /// Unloaded (rad/Nm).
        compliance: f64,
        /// (Nm)
        knee: f64,
    },
    /// The robot stands on a plate that yields more one way than the other: it tilts about x and y
    /// of the base frame, each by its own compliance.
    UnevenFoundation {
        /// About x and about y (rad/Nm).
        tilt: [f64; 2],
    },
    /// A gear beside a rod: the joint's compliance times
    /// `1 + cos cos(q) + sin sin(q)` with the angle `q` of another joint.
    CrossDependence {
        /// The joint.
        joint: usize,
        /// The other one.
        of: usize,
        /// Of the cosine.
        cos: f64,
        /// Of the sine.
        sin: f64,
    },
    /// A flange whose pin is loose in a slot: it goes half the gap along x of
    /// the flange frame, to the side of the force.
    LooseFlange {
        /// From one side to the other (m).
        gap: f64,
        /// The force that closes most of it (N).
        knee: f64,
    },
    /// A taper whose seat is worn: it turns by half the gap about x of the flange frame, to
    /// the side of the moment.
    LooseTaper {
        /// From one side to the other (rad).
        gap: f64,
        /// The moment that closes most of it (Nm).
        knee: f64,
    },
    /// Rollers with little preload: the bearing of a joint tilts about the axes across its own
    /// by `compliance / sqrt(1 + (m / knee)^2)` per moment `m`.
    HardeningBearing {
        /// The joint.
        joint: usize,
        /// Unloaded (rad/Nm).
        compliance: f64,
        /// (Nm)
        knee: f64,
    },
    /// Grease and belts soften with warmth: the joint's compliance times
    /// `1 + per_kelvin (T - T at the beginning)`.
    WarmingJoint {
        /// The joint.
        joint: usize,
        /// (1/K)
        per_kelvin: f64,
    },
    /// Flanks of a gear that differ: the joint turns by `added max(tau, 0)` besides.
    OneSided {
        /// The joint.
        joint: usize,
        /// (rad/Nm)
        added: f64,
    },
    /// A rope that is led round the arm: the cell reads `f (1 + gain q)` of a force `f` that acts.
    GainOfAngle {
        /// The joint whose coordinate `q` is.
        joint: usize,
        /// (1/rad)
        gain: f64,
    },
    /// A load cell whose line is bent: of a force `f` that acts it reads `f (1 - bend |f| / 1 kN)`.
    BentCell {
        /// What it reads too little of 1 kN, as a share.
        bend: f64,
    },
    /// Friction in the pulley between the load cell and the tool: the cell reads `f (1 + share)`
    /// while the load grows, `f (1 - share)` while it falls.
    LoadFriction {
        /// What holds back, as a share.
        share: f64,
    },
}

impl Outside {
    /// A name of its own.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::ViscousJoint { .. } => "viscous_joint",
            Self::Cable { .. } => "cable",
            Self::LinkGrowth { .. } => "link_growth",
            Self::SoftFoundation { .. } => "soft_foundation",
            Self::UnevenFoundation { .. } => "uneven_foundation",
            Self::CrossDependence { .. } => "cross_dependence",
            Self::LooseFlange { .. } => "loose_flange",
            Self::LooseTaper { .. } => "loose_taper",
            Self::HardeningBearing { .. } => "hardening_bearing",
            Self::WarmingJoint { .. } => "warming_joint",
            Self::OneSided { .. } => "one_sided_joint",
            Self::GainOfAngle { .. } => "gain_of_angle",
            Self::BentCell { .. } => "bent_cell",
            Self::LoadFriction { .. } => "load_friction",
        }
    }

    /// Where it is.
    pub fn place(&self) -> String {
        match self {
            Self::ViscousJoint { joint, .. }
            | Self::HardeningBearing { joint, .. }
            | Self::WarmingJoint { joint, .. }
            | Self::OneSided { joint, .. } => format!("joint {joint}"),
            Self::GainOfAngle { joint, .. } => format!("rig by {joint}"),
            Self::CrossDependence { joint, of, .. } => format!("joint {joint} by {of}"),
            Self::Cable { link, .. } | Self::LinkGrowth { link, .. } => format!("link {link}"),
            Self::SoftFoundation { .. } | Self::UnevenFoundation { .. } => "base".into(),
            Self::LooseFlange { .. } | Self::LooseTaper { .. } => "tool".into(),
            Self::BentCell { .. } | Self::LoadFriction { .. } => "rig".into(),
        }
    }

    /// Of which joint, from 0, it is a gear, where joints are so compliant.
    pub(super) fn gear(&self, compliances: &[f64]) -> Option<(usize, Gear)> {
        let (joint, gear) = match *self {
            Self::ViscousJoint { joint, compliance, constant } => (joint, Gear::Lag { compliance, constant }),
            Self::WarmingJoint { joint, per_kelvin } => {
                (joint, Gear::Warming { per_kelvin: per_kelvin * compliances[joint - 1] })
            }
            Self::OneSided { joint, added } => (joint, Gear::OneSided { added }),
            _ => return None,
        };
        Some((joint - 1, gear))
    }

    /// The numbers it is proportional to.
    pub(super) fn sizes(&mut self) -> Vec<&mut f64> {
        match self {
            Self::ViscousJoint { compliance, .. }
            | Self::SoftFoundation { compliance, .. }
            | Self::HardeningBearing { compliance, .. } => vec![compliance],
            Self::UnevenFoundation { tilt } => tilt.iter_mut().collect(),
            Self::Cable { stiffness, .. } => vec![stiffness],
            Self::LinkGrowth { per_kelvin, .. } | Self::WarmingJoint { per_kelvin, .. } => vec![per_kelvin],
            Self::CrossDependence { cos, sin, .. } => vec![cos, sin],
            Self::LooseFlange { gap, .. } | Self::LooseTaper { gap, .. } => vec![gap],
            Self::OneSided { added, .. } => vec![added],
            Self::GainOfAngle { gain, .. } => vec![gain],
            Self::BentCell { bend } => vec![bend],
            Self::LoadFriction { share } => vec![share],
        }
    }
}
