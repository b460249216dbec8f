//! Exact angles: a multiple of 90 degrees has sine and cosine 0 or +-1, never
//! 6e-17.

use core::f64::consts::FRAC_PI_2;

/// How near to a multiple of 90 degrees an angle counts as that multiple (rad).
pub const SNAP: f64 = 1e-9;

/// The number of quarter turns, reduced to `0..4`, if `angle` (rad) is within
/// [`SNAP`] of a multiple of 90 degrees.
pub fn quarter_turns(angle: f64) -> Option<u8> {
    whole_turns(angle).map(|turns| turns.rem_euclid(4) as u8)
}

/// The multiple of 90 degrees within [`SNAP`] of `angle` (rad) if there is
/// one, else `angle` itself.
pub fn snapped(angle: f64) -> f64 {
    whole_turns(angle).map_or(angle, |turns| turns as f64 * FRAC_PI_2)
}

/// The number of quarter turns if `angle` is one within [`SNAP`].
fn whole_turns(angle: f64) -> Option<i64> {
    let turns = angle / FRAC_PI_2;
    // `f64::round` is not in core; descriptions hold no angle beyond 2^52 turns.
    let nearest = (turns + if turns < 0.0 { -0.5 } else { 0.5 }) as i64;
    let off = turns - nearest as f64;
    (off.abs() * FRAC_PI_2 <= SNAP).then_some(nearest)
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
    fn a_snapped_angle_is_the_exact_multiple() {
        assert_eq!(snapped(-FRAC_PI_2 + 0.9e-9), -FRAC_PI_2);
        assert_eq!(snapped(5.0 * FRAC_PI_2 - 0.9e-9), 5.0 * FRAC_PI_2);
        assert_eq!(snapped(1.2e-9), 1.2e-9);
    }

    #[test]
    fn quarter_turns_have_the_sines_of_their_angles() {
        for turns in 0..4_u8 {
            let (s, c) = sin_cos_of_turns(turns);
            let angle = f64::from(turns) * FRAC_PI_2;
            assert!((s - sin(angle)).abs() < 1e-15 && (c - sin(angle + FRAC_PI_2)).abs() < 1e-15);
        }
    }

    fn sin(x: f64) -> f64 {
        extern crate std;
        std::primitive::f64::sin(x)
    }
}
