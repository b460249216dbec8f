//! Measured data against the model of a robot arm.
//!
//! - [`campaign`]: the files: loads and what moved, absolute positions, clamped axes;
//! - [`triage`]: what the readings say without a model;
//! - [`predict`]: what a description says that they should be;
//! - [`identify`]: the joint compliances that fit them;
//! - [`trace`]: the effects that they show to be missing;
//! - [`plan`], [`simulate`]: what to measure next, and campaigns on an arm that hides something,
//!   to try a measurement before it is made.
//!
//! Tracing and planning take minutes in a build without optimisation. A debug build is as quick
//! with this in the `Cargo.toml` of the workspace:
//!
//! ```toml
//! [profile.dev.package.robstiff-identify]
//! opt-level = 2
//! ```

pub mod campaign;
mod effects;
mod fit;
pub mod identify;
mod judge;
mod model;
mod noise;
mod observe;
pub mod plan;
pub mod predict;
mod probability;
mod regression;
mod rounded;
mod select;
pub mod simulate;
pub mod trace;
pub mod triage;
mod words;

pub use rounded::rounded;
