//! From a robot description over symbolic expressions to unrolled Rust code.
//!
//! The way of the data, one module a step:
//!
//! 1. [`symbolic`]: the textbook's mathematics, run on symbols instead of
//!    numbers, builds
//! 2. a [`graph`] in which every expression ([`op`]) exists once, simplified as it is
//!    written down (`fold`, [`angle`]);
//! 3. a [`function`] is a graph with outputs: dead nodes are dropped, the cost
//!    counted, and it can be interpreted, which is how the generator is tested;
//! 4. what is in columns is scaled so that constants cost less (`scales`);
//! 5. [`emit`] turns functions into Rust tokens and readable source.
//!
//! The same description always gives the same code.

pub mod angle;
pub mod emit;
mod fold;
pub mod function;
pub mod graph;
pub mod op;
mod scales;
pub mod symbolic;

#[cfg(feature = "text")]
pub use emit::source;
pub use emit::{Origin, functions, functions_in_columns, skeleton, tokens};
pub use function::{Cost, Function};
