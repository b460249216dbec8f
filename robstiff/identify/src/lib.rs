//! Measured data against the model of a robot arm.
//!
//! - [`campaign`]: the files: loads and what moved, absolute positions, clamped axes;
//! - [`triage`]: what the readings say without a model;
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
#[allow(dead_code)]
mod effects;
mod golden;
pub mod identify;
#[allow(dead_code)]
mod judge;
#[allow(dead_code)]
mod model;
#[allow(dead_code)]
mod observe;
#[allow(dead_code, unused_imports)]
mod outcome;
pub mod plan;
mod probability;
#[allow(dead_code)]
mod regression;
#[allow(dead_code)]
mod select;
pub mod simulate;
pub mod trace;
pub mod triage;
mod words;
