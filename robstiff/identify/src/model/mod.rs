//! The world that a campaign is compared with: the arm of the description, the rig that loads and
//! reads it, and everything about both that can be off.
//!
//! - [`arm`]: where the parts of the arm stand;
//! - [`spring`]: what yields in proportion to the load;
//! - [`rig`]: where loads act and what is read, in which frame;
//! - [`weight`]: what the arm weighs on itself;
//! - [`law`]: what yields otherwise;
//! - [`term`]: what one number does to the world, and what it is likely to be;
//! - [`described`]: what a description declares, in such numbers.

pub mod arm;
pub mod described;
pub mod law;
pub mod rig;
pub mod spring;
pub mod term;
pub mod weight;

pub use arm::{Arm, Frame, Stand};
pub use rig::Rig;
pub use spring::Spring;
pub use term::{At, EachRow, OfRow, Parameter, Sign, Size, Term, Torques};
pub use weight::Weight;

/// The arm and the rig.
#[derive(Clone, Debug)]
pub struct World {
    /// The arm.
    pub arm: Arm,
    /// The rig.
    pub rig: Rig,
}
