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
//!
//! Measured data are in `robstiff-identify` (the joint compliances that fit them, the effects
//! they show to be missing, what to measure next), machining is in `robstiff-machining` (tool
//! paths, milling forces, deviation and compensation, stability, maps).
//!
//! Without default features the crate is `no_std` and allocates nothing.
#![no_std]

#[cfg(any(feature = "std", test))]
extern crate std;

// The code of `robot!` names this crate; the tests are in it.
#[cfg(test)]
extern crate self as robstiff;

pub mod analysis;
pub mod batch;
mod blocks;
mod columns;
mod dual;
pub mod elements;
#[cfg(feature = "generic")]
pub mod generic;
mod lanes;
pub mod real;
pub mod robot;
#[cfg(all(test, feature = "generic"))]
mod samples;
mod state;
mod trig;

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
