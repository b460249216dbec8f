//! Elastostatics of robot arms: how far a tool gives way under a load, at every
//! pose, from a robot's description.
//!
//! [`robot!`] turns a description into code made for that robot; [`Generic`]
//! reads one at run time. Both are a [`Robot`], and everything else takes
//! either:
//!
//! ```
//! use robstiff::nalgebra::{SVector, Vector6};
//! use robstiff::Robot;
//!
//! robstiff::robot!("rv130hsc.yaml");
//!
//! let q = SVector::from([0.3, -0.4, 0.5, 0.0, 1.2]);
//! let wrench = Vector6::new(0.0, 400.0, -200.0, 0.0, 0.0, 0.0);
//! let deflection = Rv130hsc.deflection(&q, &wrench);
//! assert!((deflection - Rv130hsc.compliance(&q) * wrench).norm() < 1e-15);
//! ```
//!
//! - [`Robot`]: the trait, with terms, frames and units;
//! - [`elements`]: joints and effects one by one, and their share in the whole;
//! - [`analysis`]: stiffness, directional stiffness, principal directions;
//! - [`batch`]: slices of poses, several abreast; [`Lanes`] and [`Dual`]: vectors
//!   and derivatives through the same generated code;
//! - `campaign`, `triage`, `identify`, `trace` (feature `identify`): measured
//!   data, what they say without a model, the joint compliances that fit them,
//!   and the effects they show to be missing;
//! - `plan`, `simulate` (likewise): what to measure next, and campaigns on an arm
//!   that hides something, to try a measurement before making it;
//! - `inverse`, `path` (feature `machining`): the joint coordinates of a pose of
//!   the tool, and of a whole tool path;
//! - `milling`, `stability` (likewise): the force of an end mill, and the depths
//!   of cut at which the arm chatters by mode coupling;
//! - `map` (likewise): stiffness and deviation over joint space, planes and boxes,
//!   as a stream, and where a workpiece is best put;
//! - `deviation`, `compensation` (likewise): how far a cut pushes the tool off a
//!   path, and the path that makes up for it;
//! - `online` (likewise): correcting the joint targets while cutting.
//!
//! Without default features the crate is `no_std` and allocates nothing.
//!
//! Tracing and planning draw thousands of samples, which a build without optimisation takes
//! minutes for. A debug build is as quick with this in the `Cargo.toml` of the workspace:
//!
//! ```toml
//! [profile.dev.package.robstiff]
//! opt-level = 2
//! ```
#![no_std]

#[cfg(any(feature = "std", test))]
extern crate std;

// The code of `robot!` names this crate; the tests are in it.
#[cfg(test)]
extern crate self as robstiff;

pub mod analysis;
pub mod batch;
mod blocks;
#[cfg(feature = "identify")]
pub mod campaign;
mod columns;
#[cfg(feature = "machining")]
pub mod compensation;
#[cfg(feature = "machining")]
pub mod deviation;
mod dual;
pub mod elements;
#[cfg(feature = "generic")]
pub mod generic;
#[cfg(any(feature = "identify", feature = "machining"))]
mod golden;
#[cfg(feature = "identify")]
pub mod identify;
#[cfg(feature = "machining")]
pub mod inverse;
mod lanes;
#[cfg(feature = "machining")]
pub mod map;
#[cfg(feature = "machining")]
pub mod milling;
#[cfg(feature = "machining")]
pub mod online;
#[cfg(feature = "machining")]
pub mod path;
#[cfg(feature = "identify")]
pub mod plan;
#[cfg(feature = "identify")]
mod probability;
pub mod real;
pub mod robot;
#[cfg(all(test, feature = "generic"))]
mod samples;
#[cfg(feature = "identify")]
pub mod simulate;
#[cfg(feature = "machining")]
pub mod stability;
mod state;
#[cfg(any(feature = "identify", feature = "machining"))]
mod table;
#[cfg(feature = "identify")]
pub mod trace;
#[cfg(feature = "identify")]
pub mod triage;
mod trig;
#[cfg(feature = "identify")]
mod words;

pub use dual::Dual;
#[cfg(feature = "generic")]
pub use generic::{Generic, WrongJointCount};
pub use lanes::Lanes;
pub use real::Real;
pub use robot::{Cost, Robot, Statics, upper_triangle};
pub use robstiff_robots::{Convention, DhEntry, Effect, JointKind};
pub use state::State;

/// Generates a robot from its description, at compile time.
///
/// `robot!("rv130hsc.yaml")` finds the file next to the calling source file,
/// in the crate's manifest folder, in its `robots/`, or in the catalogue that
/// ships with robstiff, in this order; the ending `.yaml` may be left out. The
/// crate is built again when the file changes. A new file that comes before it in this
/// order, such as a copy of the catalogue's to edit, is only noticed once the source
/// that calls is touched, or with a `build.rs` that prints
/// `cargo:rerun-if-changed=robots`. It defines a unit struct named as
/// the description says, public unless a visibility precedes the file's name
/// (`robot!(pub(crate) "rv130hsc.yaml")`), with the description's numbers as
/// constants in SI units (`D1`, `A1` and `H1` are the lengths of the first row and
/// the compliance of the first joint), and implements [`Robot`] for it.
///
/// # Errors
/// A description with mistakes is a compile error that shows its own lines.
#[macro_export]
macro_rules! robot {
    ($($input:tt)*) => { $crate::__generate! { [$crate] $($input)* } };
}

#[doc(hidden)]
pub use robstiff_macros::robot as __generate;

/// Descriptions and the catalogue of robots.
pub use robstiff_robots as robots;

/// The linear algebra in this crate's interface.
pub use nalgebra;
