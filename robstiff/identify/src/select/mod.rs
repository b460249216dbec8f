//! Which candidates the readings ask for.
//!
//! - [`always`]: what is fitted whatever is found;
//! - [`layout`]: all parameters side by side, with the forms of all candidates;
//! - [`problem`]: the readings and columns at a linearisation point, and the evidence of sets;
//! - [`search`]: sets by adding, dropping, swapping and changing forms;
//! - [`engine`]: a campaign that is searched: what is read, its noise, where the model is linearised;
//! - [`solve`]: a set at its own optimum, by Gauss-Newton steps;
//! - [`sizes`]: sets weighed over how large effects are likely to be;
//! - [`passes`]: linearise, search, fit, learn the noise, and again;
//! - [`unseen`]: the error of a set on poses that are left out in turn;
//! - [`folds`]: the whole search repeated without some poses;
//! - [`classes`]: what these readings cannot tell apart.

pub mod always;
pub mod classes;
pub mod engine;
pub mod folds;
pub mod layout;
pub mod passes;
pub mod problem;
pub mod search;
pub mod sizes;
pub mod solve;
pub mod unseen;

pub use engine::Engine;
pub use layout::Layout;
pub use problem::{Problem, Set};
