//! From functions to Rust: a type, and its `Robot` implementation.

mod body;
mod bound;
mod calculations;
mod facts;
mod fuse;
mod lines;
mod operation;
mod robot;
#[cfg(feature = "text")]
mod text;
mod turns;

pub use calculations::{functions, functions_in_columns};
pub use robot::{Origin, skeleton, tokens};
#[cfg(feature = "text")]
pub use text::source;

use proc_macro2::TokenStream;

/// The signature of a method of `Robot`, for a number of joints.
type Signature = fn(&TokenStream) -> TokenStream;
