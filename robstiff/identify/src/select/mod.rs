//! Which candidates the readings ask for.
//!
//! - [`always`]: what is fitted whatever is found;
//! - [`layout`]: all parameters side by side, with the forms of all candidates;
//! - [`problem`]: the readings and columns at a linearisation point, and the evidence of sets;
//! - [`search`]: sets by adding, dropping, swapping and changing forms;
//! - [`engine`]: linearise, search, fit by Gauss-Newton steps, learn the noise, and again;
//! - [`folds`]: the whole search repeated without some poses;
//! - [`classes`]: what these readings cannot tell apart.

pub mod always;
pub mod classes;
pub mod engine;
pub mod folds;
pub mod layout;
pub mod problem;
pub mod search;

pub use engine::Engine;
pub use layout::Layout;
pub use problem::{Problem, Set};
