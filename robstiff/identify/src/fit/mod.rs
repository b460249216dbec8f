//! A campaign as a fit, and what it says of the description's own numbers.
//!
//! - [`case`]: what a campaign reads, and what it can show;
//! - [`own`]: the description's own numbers fitted alone, those that do not show held as declared;
//! - [`estimate`]: numbers with their uncertainty;
//! - [`noise`]: where the noise of a reading is known from.
//! - [`readable`]: numbers that a description takes.

pub mod case;
pub mod estimate;
pub mod noise;
pub mod own;
pub mod readable;
