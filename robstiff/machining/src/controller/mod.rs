//! What a controller makes of positions, and what it is to be given for joint coordinates.
//!
//! A controller solves poses with its [`Nominal`] model: the maker's table, without what
//! measurements have found. So a pose that is to bring the real arm to joint coordinates is the
//! one at which the nominal model has them: `pose = FK_nominal(q)`, in the work frame, with the
//! tool. [`Postures`] adds which of the postures it is ([`Configuration`](crate::program::Configuration)),
//! and goes the way back.
//!
//! [`compose()`] makes a program of a path, [`Followed`] takes the motions of a program to joint
//! coordinates, and back with those that are corrected.

mod compose;
mod follow;
mod nominal;
mod posture;
mod split;
#[cfg(test)]
mod tests;

pub use compose::{Composed, Order, Sent, Targets, Uncomposable, compose};
pub use follow::{Followed, Frames, Stop};
pub use nominal::{NoNominal, Nominal, isometry, isometry_of, placement};
pub use posture::{Postures, Unmatched, said};
pub use split::files;
