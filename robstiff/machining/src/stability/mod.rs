//! Whether a robot chatters in a cut, at the low frequencies of the arm's own modes.
//!
//! The model is `M x'' + C x' + K x = P (x(t) - x(t - T))`, where `x` is the displacement of the
//! tool, `M`, `C`, `K` are the arm's mass, damping and stiffness there, `T` is the time between
//! two teeth, and `P` is the change of the cutting force with the thickness of the chip: for an
//! end mill its average over the teeth ([`process`]; Altintas and Budak, Analytical prediction of
//! stability lobes in milling, CIRP Annals 44/1 (1995) 357-362). `P` grows with the depth of cut.
//! A tooth that cuts into the waves of the tooth before meets a chip that is thicker only by what
//! the tool has moved since ([`Lobes`]). Cordes, Hintze, Altintas, Chatter stability in robotic
//! milling, Robotics and Computer-Integrated Manufacturing 55 (2019) 11-18, look at the modes of
//! arms in this way.
//!
//! Where the teeth pass far quicker than the arm moves, `x(t) - x(t - T)` is `T x'`: the cut damps
//! the arm, or feeds it, and is no spring.
//!
//! # Without delay
//! Pan, Zhang, Zhu, Wang, Chatter analysis of robotic machining process, Journal of Materials
//! Processing Technology 173 (2006) 301-309, leave the tooth before out:
//! `M x'' + C x' + K x = P x`, [`rank_one`] in the paper (`-kp f n^T`). `P` is not symmetric:
//! where it makes two modes meet, they flutter (mode coupling). [`Modes::limits`] has that for
//! comparison; the two rank the feeds differently.
//!
//! # What this covers and what not
//! - The arm's elasticity at one pose, with one mass at the tool by the 3 x 3
//!   translational block of its compliance ([`Modes::new`]), or with the links'
//!   masses by all that yields ([`Modes::of_links`]): the TCP is free to turn. Or as a modal
//!   test finds them, each with its damping ([`Modes::measured`]), or as they are fitted to the frequency
//!   responses of such a test ([`responses`]).
//!   Directions in which it does not yield at all are rigid and take no part. Backlash and hardening have the slope that
//!   they have under the mean force of the cut, see [`over_feeds`] and
//!   [`compliance_under`](robstiff::elements::compliance_under): movements that cross
//!   the backlash are not small, and not looked at.
//! - Not the modes of spindle, tool and workpiece, which decide at higher frequencies: their
//!   lobes need their measured frequency responses.
//! - Forces averaged over a revolution: the teeth pass far quicker than the modes move. No
//!   process damping, no controller; all teeth cut, evenly spaced.
//!
//! Forces are on the tool, lengths in m, masses in kg, times in s, all in the base frame.

pub mod along;
#[cfg(test)]
mod delay_tests;
mod feeds;
mod file;
#[cfg(test)]
mod file_tests;
mod limit;
#[cfg(test)]
mod links_tests;
mod lobes;
#[cfg(test)]
mod lobes_tests;
mod mass;
mod measured;
#[cfg(test)]
mod measured_tests;
mod modes;
mod response;
pub mod responses;
#[cfg(test)]
mod responses_tests;
#[cfg(feature = "schema")]
pub mod schema;
mod spectrum;
#[cfg(test)]
mod tests;

pub use feeds::{FeedLimit, best, feeds_in_plane, over_feeds, process, rank_one};
pub use file::{ModesFile, ModesFrame};
pub use limit::Limits;
pub use lobes::Lobes;
pub use mass::{MassError, mass_of_first_mode};
pub use measured::{MeasuredMode, Spring};
pub use modes::{Modes, has_complex_pair};
