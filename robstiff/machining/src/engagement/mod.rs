//! What is cut where: the engagement of an end mill along a path, from the stock as it then is.
//!
//! The [`Stock`] is a prism along z, held as heights over a grid: what is below an overhang is not known. A
//! [`Cutter`] (flat, bull nose or ball nose) goes along the [`Step`]s of a path with its axis along z.
//! [`Survey::new`] says of each segment what it meets, then cuts it away.
//!
//! # Angles
//! Material that is cut away on a short stretch was met at the angle `phi` where the circumference of the tool passes
//! it. With `n` its distance along the normal of the cut, `cos phi = n / r`, wherever it is along the
//! feed. So volumes by `n`, over length and width, are the axial depth by angle ([`Bite`]): any number
//! of arcs, each with its depth ([`Sector`]). On a corner or a ball, `r` is the radius of the slice.
//! The volume is exact, so that the mean tangential force is.
//!
//! # Errors of the grid
//! A cell is cut where its middle is. The grid's pitch is a fiftieth of the smallest tool's radius. Where that needs more
//! than 4e7 cells it is coarser, up to a twentieth; beyond it is an error. A wall is within half a pitch of its
//! place. The grid is turned against x and y, so that a wall along these crosses cells at every
//! offset, and its mean place is much closer.
//!
//! # What it does not know
//! - Segments on which the tool's axis is not along z (0.2 degrees) are [`Met::Tilted`]; they cut nothing.
//! - What the flat of the tip removes on the way down has no force ([`Segment::by_tip`]).
//! - What is met is the mean over a stretch of four to eight cells; shorter segments share theirs.
//! - The tool removes what it sweeps as if it were where the path says.

mod bite;
mod cuts;
mod cutter;
mod heights;
mod route;
mod stock;
mod survey;
#[cfg(test)]
mod tests;

pub use bite::{Bite, Sector};
pub use cutter::Cutter;
pub use heights::{FINE, TooLarge};
pub use route::steps;
pub use stock::Stock;
pub use survey::{Met, Segment, Step, Stretch, Survey};
