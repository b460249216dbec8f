//! Why a target is not reached, in words.

use core::fmt;

use super::Remaining;
use robstiff::JointKind;

/// Why there is no solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unreached {
    /// The target is further away than the arm is long in any posture.
    OutOfReach {
        /// What is left in the posture that comes nearest.
        remaining: Remaining,
    },
    /// The arm gets there, but only with a joint beyond its limits.
    OutsideLimits {
        /// The joint that is furthest outside in the posture that is least so
        /// (from 1).
        joint: usize,
        /// Turning or sliding.
        kind: JointKind,
        /// Where it would have to stand (rad or m).
        coordinate: f64,
        /// Its limits (rad or m).
        limits: [f64; 2],
    },
    /// No start came to the target; where the arm has no closed form there
    /// might be a solution yet.
    NotConverged {
        /// What is left in the posture that came nearest.
        remaining: Remaining,
    },
    /// The arm has five axes and gets there with the tool at another turn about its axis:
    /// told of the points of a path, whose file says which axis that is.
    TurnAboutTool,
    /// The target or the seed has a number that is not finite.
    NotFinite,
}

impl fmt::Display for Unreached {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let left = |f: &mut fmt::Formatter<'_>, remaining: &Remaining| {
            // What is small has digits, too: a miss of 0.000 mm is none.
            let [mm, deg] = [remaining.distance * 1e3, remaining.angle.to_degrees()].map(|miss| match miss {
                0.0005.. | 0.0 => format!("{miss:.3}"),
                _ => format!("{miss:.1e}"),
            });
            write!(f, "{mm} mm and {deg} deg")
        };
        match self {
            Self::OutOfReach { remaining } => {
                f.write_str("out of reach: the nearest posture misses it by ")?;
                left(f, remaining)
            }
            Self::OutsideLimits { joint, kind, coordinate, limits } => {
                let (unit, name) = match kind {
                    JointKind::Revolute => (1_f64.to_radians(), "deg"),
                    JointKind::Prismatic => (1e-3, "mm"),
                };
                let [at, low, high] = [coordinate / unit, limits[0] / unit, limits[1] / unit];
                write!(
                    f,
                    "outside the limits of joint {joint}: it would have to stand at {at:.2} {name}, \
                     its limits are [{low:.2}, {high:.2}] {name}"
                )
            }
            Self::NotConverged { remaining } => {
                f.write_str("no posture was found; the nearest misses it by ")?;
                left(f, remaining)
            }
            Self::TurnAboutTool => {
                f.write_str("five axes hold the direction of the tool's axis only, not the turn about it")
            }
            Self::NotFinite => f.write_str("the target or the seed has a number that is not finite"),
        }
    }
}

impl core::error::Error for Unreached {}
