//! From functions to Rust: a type, and its `Robot` implementation.

mod body;
mod bound;
mod calculations;
mod facts;
mod fuse;
mod lines;
mod operation;
mod reader;
mod robot;
mod signature;
#[cfg(feature = "text")]
mod text;
mod turns;

pub use calculations::{functions, functions_in_columns};
pub use robot::{Origin, skeleton, tokens};
#[cfg(feature = "text")]
pub use text::source;
