//! The mathematics, on symbols.
//!
//! - [`chain`](mod@chain): a description as elementary steps from base to TCP;
//! - [`forward`](mod@forward): frames and levers, from the base to the TCP;
//! - [`kinematics`]: transform, frames, Jacobian, torques and deflection;
//! - [`compliance`](mod@compliance): the Cartesian compliance, carried from the TCP to the
//!   base.

pub mod chain;
pub mod compliance;
pub mod elastic;
pub mod forward;
pub mod kinematics;
pub mod vector;

pub use chain::{Step, Tilt, chain};
pub use compliance::compliance;
pub use elastic::Elastic;
pub use forward::{Forward, forward};
pub use kinematics::{deflection, jacobian, joint_torques, link_frames, transform};
