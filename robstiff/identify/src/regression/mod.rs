//! Readings against columns, under noise that the rows of a pose share.
//!
//! - [`dense`]: factors of small matrices;
//! - [`noise`]: what a reading is off by, and what of it the rows of a visit and of a pose share;
//! - [`encoders`]: the same of encoders behind gears;
//! - [`tails`]: which rows are far off, and how little they weigh;
//! - [`gram`]: everything that a fit needs to know of the rows, group by group of poses;
//! - [`evidence`]: how well some columns account for the readings, with all values of their
//!   numbers weighed by what these are likely to be.

pub mod dense;
pub mod encoders;
pub mod evidence;
pub mod gram;
pub mod noise;
pub mod tails;

pub use evidence::{Fit, NoisePrior, Prior, Scales};
pub use gram::{Gram, Grams};
