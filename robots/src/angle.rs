//! Exact angles: a multiple of 90 degrees has sine and cosine 0 or +-1, never
//! 6e-17.

use core::f64::consts::FRAC_PI_2;

/// How near to a multiple of 90 degrees an angle counts as that multiple (rad).
pub const SNAP: f64 = 1e-9;

/// The number of quarter turns, reduced to `0..4`, if `angle` (rad) is within
/// [`SNAP`] of a multiple of 90 degrees.
pub fn quarter_turns(angle: f64) -> Option<u8> {
    let turns = angle / FRAC_PI_2;
    // `f64::round` is not in core; descriptions hold no angle beyond 2^52 turns.
    let nearest = (turns + if turns < 0.0 { -0.5 } else { 0.5 }) as i64;
    let off = turns - nearest as f64;
    (off.abs() * FRAC_PI_2 <= SNAP).then(|| nearest.rem_euclid(4) as u8)
}

/// Sine and cosine of a whole number of quarter turns, exact.
pub const fn sin_cos_of_turns(turns: u8) -> (f64, f64) {
    match turns % 4 {
        0 => (0.0, 1.0),
        1 => (1.0, 0.0),
        2 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snaps_only_what_is_near() {
        for turns in -9..9_i64 {
            let angle = turns as f64 * FRAC_PI_2;
            assert_eq!(quarter_turns(angle + 0.9e-9), Some(turns.rem_euclid(4) as u8));
            assert_eq!(quarter_turns(angle - 0.9e-9), Some(turns.rem_euclid(4) as u8));
            assert_eq!(quarter_turns(angle + 1.2e-9), None);
        }
    }

    #[test]
    fn quarter_turns_have_the_sines_of_their_angles() {
        for turns in 0..4_u8 {
            let (s, c) = sin_cos_of_turns(turns);
            let angle = f64::from(turns) * FRAC_PI_2;
            assert!((s - libm_sin(angle)).abs() < 1e-15 && (c - libm_sin(angle + FRAC_PI_2)).abs() < 1e-15);
        }
    }

    fn libm_sin(x: f64) -> f64 {
        extern crate std;
        std::primitive::f64::sin(x)
    }
}
