//! The judge: a robot arm as rigid bodies and springs, loaded, solved for its
//! equilibrium in the deformed shape, and measured with noise.
//!
//! Nothing here linearises. Every spring is a finite turn or slide in the chain
//! of transforms, and the load acts where the deformed arm has carried the tool
//! centre point (TCP). What the library predicts with Jacobians can so be held
//! against something that has none. Only the words of a description are shared
//! ([`robstiff_robots`]), no formula.
//!
//! Units are SI; wrenches, displacements and rotations are given in the base
//! (world) frame, the one that [`Description::base`] places frame 0 in.
//!
//! [`Description::base`]: robstiff_robots::Description::base

mod arm;
mod arms;
mod campaign;
#[cfg(test)]
mod campaign_tests;
mod clamped;
mod encoders;
mod equilibrium;
mod files;
mod frame;
mod gear;
mod hidden;
#[cfg(test)]
mod hidden_tests;
mod noise;
mod outside;
mod positions;
mod rig;
#[cfg(test)]
mod rig_tests;
mod sight;
mod spring;
#[cfg(test)]
mod tests;

pub use arm::{Arm, GRAVITY, SEGMENTS};
pub use arms::{five_axis, six_axis};
pub use campaign::{Row, Scenario, Simulated, scattered};
pub use clamped::Axes;
pub use encoders::Encoders;
pub use equilibrium::{Equilibrium, PosedArm};
pub use gear::{Memory, Moment};
pub use hidden::{DhColumn, Follows, Hidden, Mount};
pub use outside::Outside;
pub use positions::Positions;
