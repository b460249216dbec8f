//! What may be said of what was found.
//!
//! - [`thresholds`]: every number that decides, with its reason;
//! - [`gates`]: what a class of effects must pass to be named;
//! - [`verdict`]: the conclusion, and why.

pub mod gates;
pub mod thresholds;
pub mod verdict;
