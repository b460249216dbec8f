//! Sines and cosines from a table of the circle.
//!
//! For the vectors of AVX2, of whose angles each looks up its own place. Where
//! polynomials for a quarter turn take half the time of a trace, near a place of the
//! table two coefficients do or none, and nothing is left to exchange or to negate:
//!
//! 1. `k` is the multiple of the table's step nearest to the angle, by a number so large
//!    that only whole ones fit, and `r = x - k step` (the step in two parts);
//! 2. the last bits of `k` find `S/2` and `C/2`, halves of its sine and cosine;
//! 3. `sin r = r + r z P(z)` with `z = r^2`, and `t = 2 tan(r/2)`: up to `r^6` it is
//!    `sin r + r z / 4`, which is enough for what it is multiplied by;
//! 4. `sin x = S + sin r (C - t S/2)` and `cos x = C - sin r (S + t C/2)`, because
//!    `1 - cos r = sin r tan(r/2)`.
//!
//! Domain, error and symmetries are those of the module above. Finding `k` is a pass of
//! its own over the angles of all joints: parts of a vector come back from the cache some
//! time after it is written, and meanwhile the processor would wait. Gain:
//! `benches/README.md`. Without this, [`sin_cos_each`](super::sin_cos_each) is what remains.

pub(crate) mod double;
pub(crate) mod single;

/// Sine and cosine so many quarter turns further, less than four.
const fn turned(sin: f64, cos: f64, quarters: usize) -> [f64; 2] {
    match quarters {
        0 => [sin, cos],
        1 => [cos, -sin],
        2 => [-sin, -cos],
        _ => [-cos, sin],
    }
}
