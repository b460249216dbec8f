//! Which of the postures that reach a pose it is, as each maker says it.
//!
//! Six axes with a spherical wrist reach a pose in up to eight ways: the wrist ahead of the first
//! axis or behind it, the forearm bent forward or backward, and axis 5 one way or the other. All
//! makers let axis 2 lean forward where it counts up; that is what "ahead" is measured by.
//!
//! - KUKA, KSS 8.3, status and turn: S bit 0 behind, bit 1 bent forward, bit 2 axis 5 not above
//!   0; T bit `i - 1` axis `i` below 0.
//! - ABB, RAPID reference manual, confdata: cf1, cf4 and cf6 are quarter turns, counted down to the
//!   next whole one; cfx = 4 behind + 2 bent backward + 1 axis 5 below 0.
//! - FANUC, CONFIG: T ahead, B behind; U bent forward, D backward; N axis 5 below 0, F not below
//!   (as `tesseract_planning` of ROS-Industrial has the letters); whole turns of axes 1, 4 and 6,
//!   0 from -180 to 180 degrees.

use core::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{Isometry3, SVector};
use robstiff::{Generic, JointKind, Robot};
use robstiff_robots::description::ON_THE_LIMIT;

use super::nominal::Nominal;
use crate::inverse::{Inverse, Orientation, Sides, Target, Unreached};
use crate::program::{Configuration, Language};

/// What is within this of a boundary is on both sides of it (rad, and m at the first axis): digits
/// of files, and straight wrists.
const ON_BOTH: f64 = 1e-3;

/// What is within this of a boundary is on it: rounding.
const ROUNDING: f64 = 1e-9;

/// Whole turns that are tried, either way.
const MOST_TURNS: i32 = 3;

/// The nominal model, and how it is solved.
#[derive(Clone, Debug)]
pub struct Postures<'n, const N: usize> {
    /// The model.
    pub nominal: &'n Nominal<N>,
    inverse: Inverse<'n, Generic<N>, N>,
}

/// Why a position has no joint coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Unmatched {
    /// The nominal model does not reach it.
    Unreached(Unreached),
    /// Postures reach it, but not the one that the program asks for; theirs, in words.
    Otherwise(Vec<String>),
}

/// Where an arm is, in the words of the makers; what is above 0 is so.
struct Posture {
    /// The wrist ahead of the first axis (m).
    ahead: f64,
    /// The forearm bent forward (sine).
    bend: f64,
    /// What the pendant shows of the arm (rad).
    pendant: Vec<f64>,
}

impl<'n, const N: usize> Postures<'n, N> {
    /// The postures of a nominal model.
    pub fn new(nominal: &'n Nominal<N>) -> Self {
        Self { nominal, inverse: Inverse::new(&nominal.arm) }
    }

    /// Why the makers' words for postures do not fit the arm; `None` where they do.
    pub fn unfit(&self) -> Option<&'static str> {
        match N {
            6 | 7 if self.inverse.has_closed_form() => None,
            6 => {
                Some("its axes are not those of an arm with a spherical wrist, an axis and two parallel ones across it")
            }
            _ => Some("it has not six axes, and no such arm that a first one carries"),
        }
    }

    /// How many joints carry the arm: a rail or a turntable is one, and a further axis of the controller's.
    pub fn carriers(&self) -> usize {
        self.inverse.carriers()
    }

    /// Which posture joint coordinates are, in the words of a language's controller; `None` where
    /// they do not [fit](Self::unfit).
    pub fn configuration(&self, q: &SVector<f64, N>, language: Language) -> Option<Configuration> {
        let Posture { ahead, bend, pendant } = self.posture(q)?;
        let wrist = pendant[4];
        let below = |value: f64| value < -ROUNDING;
        Some(match language {
            Language::Krl => {
                let bit = |is: bool, place: usize| u32::from(is) << place;
                let status = bit(below(ahead), 0) | bit(!below(bend), 1) | bit(wrist <= ROUNDING, 2);
                let turn = pendant.iter().enumerate().map(|(i, angle)| bit(below(*angle), i)).sum();
                Configuration::Kuka { status: Some(status), turn: Some(turn) }
            }
            Language::Rapid => {
                let quarters = |i: usize| ((pendant[i] + ROUNDING) / FRAC_PI_2).floor() as i32;
                let x = 4 * i32::from(below(ahead)) + 2 * i32::from(below(bend)) + i32::from(below(wrist));
                Configuration::Abb([quarters(0), quarters(3), quarters(5), x])
            }
            Language::Ls => Configuration::Fanuc {
                flip: !below(wrist),
                left: None,
                up: !below(bend),
                front: !below(ahead),
                turns: [0, 3, 5].map(|i| turns(pendant[i])),
            },
            // It has no words for postures.
            Language::Ur => return None,
        })
    }

    /// The joint coordinates (rad or m) at which the TCP is in a pose of the base frame (m), the
    /// tool given in the controller's flange: of the posture that the configuration asks for, and
    /// of those the nearest to some coordinates. Five axes keep the direction of the flange's z
    /// axis, fewer the position.
    ///
    /// # Errors
    /// Why there are none.
    pub fn solve(
        &self,
        pose: &Isometry3<f64>,
        tool: &Isometry3<f64>,
        configuration: Option<&Configuration>,
        near: &SVector<f64, N>,
    ) -> Result<SVector<f64, N>, Unmatched> {
        let target = self.target(pose, tool);
        let nearest = self.inverse.nearest(&target, near).map_err(Unmatched::Unreached)?;
        let Some(asked) = configuration.filter(|_| self.unfit().is_none()) else { return Ok(nearest) };
        if self.is(&nearest, asked) {
            return Ok(nearest);
        }
        let all = self.inverse.all(&target, near).map_err(Unmatched::Unreached)?;
        let turned = all.iter().filter_map(|q| self.turned(q, asked, near));
        let best = turned.min_by(|one, other| (one - near).norm().total_cmp(&(other - near).norm()));
        best.ok_or_else(|| {
            let language = language(asked);
            let found = all.iter().filter_map(|q| self.configuration(q, language));
            Unmatched::Otherwise(found.map(|found| said(&found)).collect())
        })
    }

    /// Whether joint coordinates are of the posture that a configuration asks for; on a boundary
    /// they are of both.
    pub fn is(&self, q: &SVector<f64, N>, asked: &Configuration) -> bool {
        let Some(posture) = self.posture(q) else { return true };
        posture.is_of(asked) && posture.pendant.iter().enumerate().all(|(i, angle)| turns_by(asked, i, *angle))
    }

    fn posture(&self, q: &SVector<f64, N>) -> Option<Posture> {
        if !(6..=7).contains(&N) {
            return None;
        }
        let carriers = self.carriers();
        let Sides { ahead, bend, first, shoulder } = self.inverse.sides(q)?;
        let base = self.nominal.arm.base();
        let origin = base.fixed_view::<3, 1>(0, 3).into_owned();
        // Up is where the shoulder is, however the table counts the first joint; where it is level
        // with the base, along its z axis.
        let height = first.dot(&(shoulder - origin));
        let up = if height.abs() > ON_BOTH { height } else { first.dot(&base.fixed_view::<3, 1>(0, 2)) };
        let forward = if self.nominal.controller.joints[carriers + 1].reversed { -1.0 } else { 1.0 };
        let pendant = self.nominal.pendant(q).split_off(carriers);
        Some(Posture { ahead: forward * up.signum() * ahead, bend: forward * bend, pendant })
    }

    fn target(&self, pose: &Isometry3<f64>, tool: &Isometry3<f64>) -> Target {
        let flange = pose * self.nominal.tool_of_arm(tool).inverse();
        let whole = Target::pose(&flange.to_homogeneous());
        let axis = nalgebra::Vector3::z_axis();
        match N {
            6.. => whole,
            5 => Target::axis(whole.position, axis, flange.rotation * axis),
            _ => Target { orientation: Orientation::Free, ..whole },
        }
    }

    /// The coordinates by whole turns of their joints, so that they are of the posture; `None` where
    /// they cannot be.
    fn turned(&self, q: &SVector<f64, N>, asked: &Configuration, near: &SVector<f64, N>) -> Option<SVector<f64, N>> {
        if !self.posture(q)?.is_of(asked) {
            return None;
        }
        let (kinds, limits) = (self.nominal.arm.joint_kinds(), self.nominal.arm.limits());
        let carriers = self.carriers();
        let mut turned = *q;
        for i in carriers..N {
            let within = |value: f64| {
                limits[i].is_none_or(|[low, high]| (low - ON_THE_LIMIT..=high + ON_THE_LIMIT).contains(&value))
            };
            let most = if kinds[i] == JointKind::Revolute { MOST_TURNS } else { 0 };
            let values = (-most..=most).map(|turns| q[i] + TAU * f64::from(turns));
            let fits = values.filter(|value| {
                let mut with = turned;
                with[i] = *value;
                within(*value) && turns_by(asked, i - carriers, self.nominal.pendant(&with)[i])
            });
            turned[i] = fits.min_by(|one, other| (one - near[i]).abs().total_cmp(&(other - near[i]).abs()))?;
        }
        Some(turned)
    }
}

impl Posture {
    /// Whether it is the one that a configuration asks for, whole turns aside.
    fn is_of(&self, asked: &Configuration) -> bool {
        let side = |value: f64, above: bool| if above { value > -ON_BOTH } else { value < ON_BOTH };
        let Self { ahead, bend, pendant } = self;
        let wrist = pendant[4];
        match asked {
            // The bits above say how the point was taught.
            Configuration::Kuka { status: Some(bits), .. } => {
                side(*ahead, bits & 1 == 0) && side(*bend, bits & 2 != 0) && side(wrist, bits & 4 == 0)
            }
            Configuration::Kuka { status: None, .. } => true,
            Configuration::Abb([.., x]) => {
                side(*ahead, x & 4 == 0) && side(*bend, x & 2 == 0) && side(wrist, x & 1 == 0)
            }
            Configuration::Fanuc { flip, up, front, .. } => {
                side(*ahead, *front) && side(*bend, *up) && side(wrist, *flip)
            }
        }
    }
}

/// Whether the pendant's angle of joint `i` (from 0) is in the turn that a configuration asks for.
fn turns_by(asked: &Configuration, i: usize, angle: f64) -> bool {
    let in_range = |from: f64, to: f64| (from - ON_BOTH..=to + ON_BOTH).contains(&angle);
    let of_three = |all: &[i32]| [0, 3, 5].iter().position(|joint| *joint == i).map(|place| f64::from(all[place]));
    match asked {
        Configuration::Kuka { turn: None, .. } => true,
        Configuration::Kuka { turn: Some(bits), .. } => {
            let below = i < 6 && bits & (1 << i) != 0;
            if below { angle < ON_BOTH } else { angle > -ON_BOTH }
        }
        Configuration::Abb(parts) => {
            of_three(parts).is_none_or(|quarter| in_range(quarter * FRAC_PI_2, (quarter + 1.0) * FRAC_PI_2))
        }
        Configuration::Fanuc { turns, .. } => {
            of_three(turns).is_none_or(|turn| in_range((turn - 0.5) * TAU, (turn + 0.5) * TAU))
        }
    }
}

/// Whole turns of an angle (rad): 0 from -180 to 180 degrees.
fn turns(angle: f64) -> i32 {
    let turns = (angle.abs() / TAU + 0.5 - ROUNDING).floor() as i32;
    if angle < 0.0 { -turns } else { turns }
}

fn language(of: &Configuration) -> Language {
    match of {
        Configuration::Kuka { .. } => Language::Krl,
        Configuration::Abb(_) => Language::Rapid,
        Configuration::Fanuc { .. } => Language::Ls,
    }
}

/// A configuration as its controller writes it.
pub fn said(configuration: &Configuration) -> String {
    match configuration {
        Configuration::Kuka { status, turn } => {
            let part = |name: &str, bits: &Option<u32>| bits.map(|bits| format!("{name} {bits}"));
            [part("S", status), part("T", turn)].into_iter().flatten().collect::<Vec<_>>().join(", ")
        }
        Configuration::Abb([one, four, six, x]) => format!("[{one},{four},{six},{x}]"),
        Configuration::Fanuc { flip, left, up, front, turns: [one, four, six] } => {
            let letter = |is: bool, yes: &'static str, no: &'static str| if is { yes } else { no };
            let left = left.map_or("", |left| letter(left, "L ", "R "));
            let (flip, up, front) = (letter(*flip, "F", "N"), letter(*up, "U", "D"), letter(*front, "T", "B"));
            format!("'{flip} {left}{up} {front}, {one}, {four}, {six}'")
        }
    }
}

impl core::fmt::Display for Unmatched {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Unreached(why) => write!(f, "the nominal model of the controller does not get there: {why}"),
            Self::Otherwise(found) => {
                write!(f, "no posture that the program asks for gets there; those that do have {}", found.join("; "))
            }
        }
    }
}

impl core::error::Error for Unmatched {}
