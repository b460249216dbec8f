//! Robot descriptions: what robstiff knows of a robot, and how it reads it.
//!
//! [`effect`] holds the plain types that the runtime shares (`no_std`, no
//! allocation). With the feature `read` (on by default) come the
//! [`Description`] and what reads, checks and writes one.
#![cfg_attr(not(feature = "read"), no_std)]

pub mod angle;
pub mod effect;

#[cfg(feature = "read")]
pub mod description;

#[cfg(feature = "read")]
pub use description::{Description, Joint, Link, Part, Placement};
pub use effect::{Convention, Effect, JointKind};
