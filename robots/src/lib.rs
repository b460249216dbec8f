//! Robot descriptions: what robstiff knows of a robot, and how it reads it.
//!
//! [`effect`] holds the catalogue of effects, with their physics, and the plain
//! types that the runtime shares (`no_std`, no allocation). With the feature
//! `read` (on by default) come the [`Description`] and what reads, checks and
//! writes one, with `urdf` what makes one from a URDF file, with `table` what reads a CSV
//! file of numbers.
#![cfg_attr(not(feature = "read"), no_std)]

pub mod angle;
pub mod dimension;
pub mod effect;

#[cfg(feature = "read")]
mod bare;
#[cfg(feature = "read")]
pub mod catalogue;
#[cfg(feature = "read")]
pub mod controller;
#[cfg(feature = "read")]
pub mod description;
#[cfg(feature = "read")]
pub mod diagnostic;
#[cfg(feature = "read")]
pub mod document;
#[cfg(feature = "read")]
mod placement;
#[cfg(feature = "read")]
pub mod quantity;
#[cfg(feature = "read")]
mod read;
#[cfg(feature = "read")]
mod read_error;
#[cfg(feature = "read")]
#[doc(hidden)]
pub mod samples;
#[cfg(feature = "schema")]
pub mod schema;
#[cfg(feature = "read")]
mod suggest;
#[cfg(feature = "table")]
pub mod table;
#[cfg(feature = "read")]
pub mod text;
#[cfg(feature = "read")]
mod units;
#[cfg(feature = "urdf")]
pub mod urdf;
#[cfg(feature = "read")]
mod warned;
#[cfg(feature = "read")]
pub mod words;
#[cfg(feature = "read")]
mod write;

#[cfg(feature = "read")]
pub use controller::{Controller, Pendant};
#[cfg(feature = "read")]
pub use description::{Description, Joint, Link, Part};
#[cfg(feature = "read")]
pub use diagnostic::{Diagnostic, Diagnostics, Line};
pub use effect::{Convention, DhEntry, Effect, JointKind, Place};
#[cfg(feature = "read")]
pub use placement::Placement;
#[cfg(feature = "read")]
pub use read::Outline;
#[cfg(feature = "read")]
pub use read_error::ReadError;
