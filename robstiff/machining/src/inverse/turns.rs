//! Turns all around about a tool's axis.

use core::f64::consts::TAU;

/// Turns about a free tool axis that six axes try.
const TURNS: usize = 120;

/// Turns all around (rad).
pub fn turns() -> impl Iterator<Item = f64> {
    (0..TURNS).map(|k| TAU * k as f64 / TURNS as f64)
}
