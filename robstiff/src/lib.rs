//! Elastostatics of robot arms.
#![no_std]

#[cfg(feature = "std")]
extern crate std;

pub mod analysis;
#[cfg(feature = "identify")]
pub mod campaign;
pub mod elements;
#[cfg(feature = "generic")]
pub mod generic;
pub mod real;
pub mod robot;
#[cfg(all(test, feature = "generic"))]
mod samples;

#[cfg(feature = "generic")]
pub use generic::{Generic, WrongJointCount};
pub use real::Real;
pub use robot::Robot;
pub use robstiff_robots::{Convention, Effect, JointKind};

/// The linear algebra in this crate's interface.
pub use nalgebra;
