//! Whether a robot chatters by mode coupling: two weak directions of the arm
//! that feed each other through the cutting force, at the low frequencies of the
//! arm's own modes.
//!
//! The model is that of Pan, Zhang, Zhu, Wang, Chatter analysis of robotic
//! machining process, Journal of Materials Processing Technology 173 (2006)
//! 301-309: `M x'' + C x' + K x = P x`, where `x` is the displacement of the
//! tool, `M`, `C`, `K` are the arm's mass, damping and stiffness there and `P` is
//! the change of the cutting force with the displacement, [`rank_one`] in the
//! paper (`-kp f n^T`), for an end mill its average over the teeth ([`process`]).
//! `P` grows with the depth of cut, and is not symmetric: where it makes two
//! modes meet, they flutter.
//!
//! # What this covers and what not
//! - The arm's elasticity at one pose, with one mass at the tool by the 3 x 3
//!   translational block of its compliance ([`Modes::new`]), or with the links'
//!   masses by all that yields ([`Modes::of_links`]): the TCP is free to turn.
//!   Directions in which it does not yield at all are rigid and take no part. Backlash and hardening have the slope that
//!   they have under the mean force of the cut, see [`over_feeds`] and
//!   [`compliance_under`](robstiff::elements::compliance_under): movements that cross
//!   the backlash are not small, and not looked at.
//! - No regenerative chatter: the surface left by the tooth before is taken to be
//!   even. That is the matter of the modes of spindle, tool and workpiece and of
//!   stability lobes, and needs their measured frequency responses. For the
//!   structural modes of arms at high spindle speeds see Cordes, Hintze, Altintas,
//!   Chatter stability in robotic milling, Robotics and Computer-Integrated
//!   Manufacturing 55 (2019) 11-18.
//! - Forces averaged over a revolution; no process damping, no controller.
//!
//! Forces are on the tool, lengths in m, masses in kg, all in the base frame.

mod feeds;
mod limit;
#[cfg(test)]
mod links_tests;
mod mass;
mod modes;
mod spectrum;
#[cfg(test)]
mod tests;

pub use feeds::{FeedLimit, best, feeds_in_plane, over_feeds, process, rank_one};
pub use limit::Limits;
pub use mass::{MassError, mass_of_first_mode};
pub use modes::{Modes, has_complex_pair};
