//! What a simulated campaign can have that no description is told of: the
//! whole catalogue of effects, and things outside it.
//!
//! Names and parameters are those of the catalogue, so that what tracing says
//! can be held against them; the physics is that of [`arm`](super::arm) and
//! [`rig`](super::rig).

use robstiff_robots::{Effect, Link};

use super::outside::Outside;

/// Something hidden. Joints and links are counted from 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Hidden {
    /// An elastic effect that descriptions know.
    Elastic(Effect),
    /// A gear that goes half its gap to the side it is pushed to before it
    /// takes a load: `gap / 2 tau / sqrt(tau^2 + knee^2)` on top.
    LostMotion {
        /// The joint.
        joint: usize,
        /// From one side to the other (rad).
        gap: f64,
        /// The torque that closes most of it (Nm).
        knee: f64,
    },
    /// Play operators in line with a gear: `sum w P_r` on top, each
    /// `P = max(tau - r, min(tau + r, P before))`, all zero when the arm comes
    /// to a pose.
    Hysteresis {
        /// The joint.
        joint: usize,
        /// Each operator's radius `r` (Nm) and weight `w` (rad/Nm).
        operators: Vec<(f64, f64)>,
    },
    /// The joint's compliance times `1 + sum cos_m cos(m q) + sin_m sin(m q)`.
    PoseDependentCompliance {
        /// The joint.
        joint: usize,
        /// Of `cos q` and `cos 2q`.
        cos: [f64; 2],
        /// Of `sin q` and `sin 2q`.
        sin: [f64; 2],
    },
    /// The joint stands at `q + offset`.
    JointZeroOffset {
        /// The joint.
        joint: usize,
        /// (rad, or m for one that slides)
        offset: f64,
    },
    /// A number of the DH table is larger than declared.
    DhError {
        /// Which column.
        of: DhColumn,
        /// Which row.
        row: usize,
        /// By how much (m or rad).
        by: f64,
    },
    /// The joint stands at `q + sin sin(order q) + cos cos(order q)`.
    TransmissionError {
        /// The joint.
        joint: usize,
        /// Periods a turn.
        order: usize,
        /// (rad)
        sin: f64,
        /// (rad)
        cos: f64,
    },
    /// The links have a mass (and the tool, the last of them): the arm sags,
    /// loaded and unloaded. Gravity is 9.81 m/s^2 along -z of the base frame.
    GravitySag(Vec<Link>),
    /// The load cell sits turned: the load is the reading, turned by this
    /// rotation vector (rad).
    LoadCellMisalignment {
        /// In the frame it is mounted in.
        turn: [f64; 3],
        /// Where it is mounted.
        mount: Mount,
    },
    /// The load is the reading and this force (N).
    LoadCellBias {
        /// In the frame it is mounted in.
        force: [f64; 3],
        /// Where it is mounted.
        mount: Mount,
    },
    /// The load is the reading times `1 + scale`, forces and moments alike.
    LoadCellScale {
        /// Of the axes of the frame it is mounted in.
        scale: [f64; 3],
        /// Where it is mounted.
        mount: Mount,
    },
    /// The load does not act at the TCP but here (m), in the tool frame.
    LeverArm([f64; 3]),
    /// What is read is not where the file says but so far from there (m), in the tool frame.
    ReflectorOffset([f64; 3]),
    /// The measuring frame is turned: what is read is the displacement, turned
    /// by this rotation vector (rad).
    TrackerMisalignment([f64; 3]),
    /// What is read is longer by this share of itself (1).
    TrackerScale(f64),
    /// All links of the arm grow, by so much of themselves per unit of what it follows.
    Expansion {
        /// (1 per hour or kelvin)
        rate: f64,
        /// What it follows.
        follows: Follows,
    },
    /// What is read wanders off.
    ThermalDrift {
        /// By how much (m) per unit of what it follows, in the base frame.
        rate: [f64; 3],
        /// What it follows.
        follows: Follows,
    },
    /// The arm gives way further under a load that stays on: each step of the
    /// displacement grows by `share log10(1 + t / onset)` of itself in the time
    /// `t` since it was made; taken back, it recovers alike.
    Creep {
        /// Share of the displacement a decade.
        share: f64,
        /// When it is first felt (s).
        onset: f64,
    },
    /// Some readings are wild.
    Outliers {
        /// Probability of a row to be one.
        share: f64,
        /// They are off by 0.5 to 1.5 times this (m), in any direction.
        size: f64,
    },
    /// The robot shifts on its foundation at one moment and stays there.
    BaseSlip {
        /// In the base frame (m).
        shift: [f64; 3],
        /// About the origin of the base frame, a rotation vector (rad).
        turn: [f64; 3],
        /// When, as a share of the campaign's duration.
        when: f64,
    },
    /// The reflector slips in its nest on the tool at one moment and stays there.
    ReflectorSlip {
        /// In the tool frame (m).
        shift: [f64; 3],
        /// When, as a share of the campaign's duration.
        when: f64,
    },
    /// What the catalogue does not have.
    Outside(Outside),
}

/// A column of the DH table in which an error is not one of the joint's zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DhColumn {
    /// The length along x.
    A,
    /// The offset along z.
    D,
    /// The twist about x.
    Alpha,
}

/// Where a load cell is mounted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mount {
    /// On the ground: its axes are those of the base frame.
    Ground,
    /// On the tool, with whose frame it turns.
    Tool,
}

/// What a drift follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Follows {
    /// Time, per hour.
    Time,
    /// The temperature in the hall, per kelvin.
    Temperature,
    /// `1 - exp(-t / constant)`, of a constant in seconds.
    Settling(f64),
}

impl From<Effect> for Hidden {
    fn from(effect: Effect) -> Self {
        Self::Elastic(effect)
    }
}

impl Hidden {
    /// The catalogue's name of the kind; that of a thing outside it is its own.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Elastic(effect) => effect.kind(),
            Self::LostMotion { .. } => "lost_motion",
            Self::Hysteresis { .. } => "hysteresis",
            Self::PoseDependentCompliance { .. } => "pose_dependent_compliance",
            Self::JointZeroOffset { .. } => "joint_zero_offset",
            Self::DhError { .. } => "dh_error",
            Self::TransmissionError { .. } => "transmission_error",
            Self::GravitySag(_) => "gravity_sag",
            Self::LoadCellMisalignment { .. } => "load_cell_misalignment",
            Self::LoadCellBias { .. } => "load_cell_bias",
            Self::LoadCellScale { .. } => "load_cell_scale",
            Self::LeverArm(_) => "lever_arm",
            Self::ReflectorOffset(_) => "reflector_offset",
            Self::TrackerMisalignment(_) => "tracker_misalignment",
            Self::TrackerScale(_) => "tracker_scale",
            Self::Expansion { .. } | Self::ThermalDrift { .. } => "thermal_drift",
            Self::Creep { .. } => "creep",
            Self::Outliers { .. } => "outliers",
            Self::BaseSlip { .. } => "base_slip",
            Self::ReflectorSlip { .. } => "reflector_slip",
            Self::Outside(outside) => outside.kind(),
        }
    }

    /// Where it sits, as the catalogue writes it.
    pub fn place(&self) -> String {
        match self {
            Self::Elastic(effect) => effect.place().to_string(),
            Self::LostMotion { joint, .. }
            | Self::Hysteresis { joint, .. }
            | Self::PoseDependentCompliance { joint, .. }
            | Self::JointZeroOffset { joint, .. }
            | Self::TransmissionError { joint, .. } => format!("joint {joint}"),
            Self::DhError { of, row, .. } => match of {
                DhColumn::A => format!("a{row}"),
                DhColumn::D => format!("d{row}"),
                DhColumn::Alpha => format!("alpha{row}"),
            },
            Self::GravitySag(_) => "robot".into(),
            Self::BaseSlip { .. } => "base".into(),
            Self::Outside(outside) => outside.place(),
            _ => "rig".into(),
        }
    }

    /// The full name, `kind@at`.
    pub fn name(&self) -> String {
        format!("{}@{}", self.kind(), self.place())
    }

    /// Its numbers by the names that descriptions and traces use, in SI units;
    /// those that are not compared are left out.
    pub fn parameters(&self) -> Vec<(String, f64)> {
        let named = |numbers: &[(&str, f64)]| numbers.iter().map(|&(name, value)| (name.to_string(), value)).collect();
        let axes = |name: &str, values: &[f64; 3]| {
            ["x", "y", "z"].iter().zip(values).map(|(axis, &value)| (format!("{name}{axis}"), value)).collect()
        };
        match self {
            Self::Elastic(effect) => {
                numbers(&mut { *effect }).into_iter().map(|(name, value)| (name.to_string(), *value)).collect()
            }
            Self::LostMotion { gap, knee, .. } => named(&[("gap", *gap), ("knee", *knee)]),
            Self::PoseDependentCompliance { cos, sin, .. } => {
                named(&[("cos1", cos[0]), ("sin1", sin[0]), ("cos2", cos[1]), ("sin2", sin[1])])
            }
            Self::JointZeroOffset { offset, .. } => named(&[("offset", *offset)]),
            Self::DhError { by, .. } => named(&[("value", *by)]),
            Self::TransmissionError { sin, cos, .. } => named(&[("sin", *sin), ("cos", *cos)]),
            Self::LoadCellMisalignment { turn, .. } | Self::TrackerMisalignment(turn) => axes("r", turn),
            Self::LoadCellBias { force, .. } => axes("F", force),
            Self::LoadCellScale { scale, .. } => axes("s", scale),
            Self::LeverArm(at) | Self::ReflectorOffset(at) => axes("", at),
            Self::TrackerScale(scale) => named(&[("scale", *scale)]),
            Self::Expansion { rate, .. } => named(&[("expansion", *rate)]),
            Self::ThermalDrift { rate, .. } => axes("d", rate),
            Self::Creep { share, .. } => named(&[("share", *share)]),
            Self::BaseSlip { shift, turn, .. } => {
                axes("d", shift).into_iter().chain(axes("r", turn)).collect::<Vec<_>>()
            }
            Self::ReflectorSlip { shift, .. } => axes("d", shift),
            Self::Hysteresis { operators, .. } => {
                let numbered = operators.iter().enumerate().flat_map(|(index, &(radius, weight))| {
                    [(format!("radius{}", index + 1), radius), (format!("weight{}", index + 1), weight)]
                });
                numbered.collect()
            }
            Self::GravitySag(_) | Self::Outliers { .. } | Self::Outside(_) => Vec::new(),
        }
    }

    /// The same of another size: everything that it is proportional to, times
    /// `factor`. Knees, radii, moments and time constants stay.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        let numbers: Vec<&mut f64> = match &mut scaled {
            Self::Elastic(effect) => {
                numbers(effect).into_iter().filter(|(name, _)| *name != "knee").map(|(_, value)| value).collect()
            }
            Self::LostMotion { gap, .. } => vec![gap],
            Self::Hysteresis { operators, .. } => operators.iter_mut().map(|(_, weight)| weight).collect(),
            Self::PoseDependentCompliance { cos, sin, .. } => cos.iter_mut().chain(sin).collect(),
            Self::JointZeroOffset { offset, .. } => vec![offset],
            Self::DhError { by, .. } => vec![by],
            Self::TransmissionError { sin, cos, .. } => vec![sin, cos],
            Self::GravitySag(links) => links.iter_mut().map(|link| &mut link.mass).collect(),
            Self::LoadCellMisalignment { turn: three, .. }
            | Self::LoadCellBias { force: three, .. }
            | Self::LoadCellScale { scale: three, .. }
            | Self::LeverArm(three)
            | Self::ReflectorOffset(three)
            | Self::TrackerMisalignment(three)
            | Self::ThermalDrift { rate: three, .. }
            | Self::ReflectorSlip { shift: three, .. } => three.iter_mut().collect(),
            Self::TrackerScale(one) | Self::Expansion { rate: one, .. } | Self::Creep { share: one, .. } => vec![one],
            Self::Outliers { size, .. } => vec![size],
            Self::BaseSlip { shift, turn, .. } => shift.iter_mut().chain(turn).collect(),
            Self::Outside(outside) => outside.sizes(),
        };
        numbers.into_iter().for_each(|number| *number *= factor);
        scaled
    }

    /// Whether it is a fault of the measurement and not of the robot.
    pub fn is_of_the_rig(&self) -> bool {
        self.place() == "rig"
    }
}

/// The numbers of an elastic effect by the names that traces use.
fn numbers(effect: &mut Effect) -> Vec<(&'static str, &mut f64)> {
    match effect {
        Effect::TransverseCompliance { value, .. } => vec![("h", value)],
        Effect::LinkCompliance { bending, torsion, .. } => vec![("bending", bending), ("torsion", torsion)],
        Effect::BaseCompliance { tilt, translation } => vec![("tilt", tilt), ("translation", translation)],
        Effect::ToolCompliance { rotation, translation } => vec![("rotation", rotation), ("translation", translation)],
        Effect::JointCoupling { value, .. } => vec![("value", value)],
        Effect::StiffnessNonlinearity { added, knee, .. } => vec![("added", added), ("knee", knee)],
        other => unreachable!("the simulator has a variant of its own for {other}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_are_those_of_the_catalogue() {
        let knee = Hidden::from(Effect::StiffnessNonlinearity { joint: 2, added: 2e-7, knee: 300.0 });
        assert_eq!(knee.name(), "stiffness_nonlinearity@joint 2");
        let numbers = |hidden: &Hidden| hidden.parameters().into_iter().map(|(_, value)| value).collect::<Vec<f64>>();
        // The knee is no size.
        assert_eq!(numbers(&knee.scaled(0.5)), [1e-7, 300.0]);
        let plays = Hidden::Hysteresis { joint: 3, operators: vec![(10.0, 1e-8), (30.0, 2e-8)] };
        assert_eq!(numbers(&plays.scaled(2.0)), [10.0, 2e-8, 30.0, 4e-8]);
        assert_eq!(plays.parameters()[3].0, "weight2");
        let twist = Hidden::DhError { of: DhColumn::Alpha, row: 2, by: 1e-3 };
        assert_eq!((twist.name().as_str(), twist.is_of_the_rig()), ("dh_error@alpha2", false));
        assert!(Hidden::LeverArm([0.1; 3]).is_of_the_rig());
        let cable = Outside::Cable { link: 3, anchor: [1.0; 3], stiffness: 1e5, length: 0.3 };
        assert_eq!(Hidden::Outside(cable).scaled(2.0).name(), "cable@link 3");
    }
}
