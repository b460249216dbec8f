//! Which names matter: those with a number that is other than zero, and without which the error
//! would be larger.

use super::found::EffectParameter;
use crate::identify::uncertainty::WITHIN;

/// An effect that lowers the error by less than this share of the noise does not matter.
const MATTERS: f64 = 0.1;

/// Whether an effect is worth a name: of its numbers that it is proportional to, `sizes`, the 95 %
/// interval of one does not include zero, and with it the error (rms) is lower by so much of the
/// noise of a reading. `lowers` is by how much it is, in the unit of the noise.
pub fn matters<'a>(sizes: impl IntoIterator<Item = &'a EffectParameter>, lowers: f64, noise: f64) -> bool {
    let is_distinct = |number: &EffectParameter| number.std.is_none_or(|std| number.value.abs() > WITHIN * std);
    sizes.into_iter().any(is_distinct) && lowers >= MATTERS * noise
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_other_than_zero_and_lowers_the_error() {
        let number = |value: f64, std| EffectParameter { name: "h", value, std, unit: "1" };
        let sure = number(-15.0, Some(7.0));
        assert!(matters([&sure], 0.2, 1.0) && !matters([&sure], 0.05, 1.0));
        let unsure = number(-15.0, Some(15.0));
        assert!(!matters([&unsure], 0.2, 1.0) && matters([&unsure, &sure], 0.2, 1.0));
        assert!(matters([&number(1.0, None)], 0.2, 1.0));
    }
}
