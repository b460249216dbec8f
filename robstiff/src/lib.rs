//! Elastostatics of robot arms.
#![no_std]

#[cfg(feature = "std")]
extern crate std;

#[cfg(feature = "identify")]
pub mod campaign;
pub mod real;
pub mod robot;

pub use real::Real;
pub use robot::Robot;
pub use robstiff_robots::{Convention, Effect, JointKind};

/// The linear algebra in this crate's interface.
pub use nalgebra;
