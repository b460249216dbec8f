//! From functions to Rust: a type, and its `Robot` implementation.

mod body;
mod facts;
mod functions;
mod fuse;
mod names;
mod operation;
mod robot;
#[cfg(feature = "text")]
mod text;
mod turns;

pub use robot::{Origin, skeleton, tokens};
#[cfg(feature = "text")]
pub use text::source;
