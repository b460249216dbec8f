//! Simulated campaigns by the hundred, each with something hidden that is large
//! enough to matter or with nothing, traced, and judged by what is hidden.

pub mod alias;
pub mod case;
pub mod draw;
pub mod interval;
pub mod run;
pub mod table;
pub mod truths;
pub mod visible;

pub use case::{Case, Expected, Group, POSES, Ready, groups, shares};
pub use run::{Record, run, run_keeping};
