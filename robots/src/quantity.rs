//! Quantities as people write them: a number in SI units, or `value unit`.

mod beginning;
mod wording;

use std::fmt;

use self::beginning::{fraction_of_pi, is_infinite_or_nan, is_more_of_it, leading_number};
use crate::units::{UNITS, Unit};
use crate::words::significant;

pub use crate::dimension::Dimension;

/// Why a text is not the quantity that is expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QuantityError {
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
}

impl fmt::Display for QuantityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.message, self.help)
    }
}

impl std::error::Error for QuantityError {}

fn error<T>(message: String, help: impl Into<String>) -> Result<T, QuantityError> {
    Err(QuantityError { message, help: help.into() })
}

fn find(name: &str, dimension: Dimension) -> Result<&'static Unit, QuantityError> {
    // Both micro signs are common on keyboards.
    let plain = name.replace(['µ', 'μ'], "u");
    // Some names are units of two dimensions: `N/mm` of a stiffness, and of a
    // force per length.
    if let Some(unit) = UNITS.iter().find(|unit| unit.name == plain && unit.dimension == dimension) {
        return Ok(unit);
    }
    match UNITS.iter().find(|unit| unit.name == plain) {
        Some(unit) => {
            let kind = match (unit.inverse, unit.dimension) {
                (true, Dimension::Compliance) => "a rotational stiffness",
                (true, _) => "a translational stiffness",
                (false, dimension) => dimension.name(),
            };
            error(format!("`{name}` is {kind}, {} is expected here", dimension.name()), dimension.help())
        }
        None => {
            let of_this = UNITS.iter().filter(|unit| unit.dimension == dimension);
            let meant = of_this.map(|unit| unit.name).find(|unit| unit.eq_ignore_ascii_case(&plain));
            let help = meant.map_or(String::new(), |meant| format!("did you mean `{meant}`? "));
            error(format!("unknown unit `{name}` for {}", dimension.name()), help + &dimension.help())
        }
    }
}

/// What to multiply a number in this unit by to have it in SI, e.g. 1e-6 for
/// `um`: for the columns of a table.
///
/// # Errors
/// A unit that is unknown, of another dimension, or a stiffness (which a factor
/// does not turn into a compliance).
pub fn scale(unit: &str, dimension: Dimension) -> Result<f64, QuantityError> {
    let found = find(unit.trim(), dimension)?;
    if found.inverse {
        let si = UNITS.iter().find(|unit| unit.dimension == dimension).map_or("", |unit| unit.name);
        return error(
            format!("`{}` is a stiffness, {} is expected here", found.name, dimension.name()),
            format!("give it in {si}"),
        );
    }
    Ok(found.times / found.per)
}

/// The largest quantity, in SI: sums and products of a few stay finite.
const MOST: f64 = 1e30;

/// What is smaller, in SI, is zero: nothing real is so small, and squares of what is left
/// are not zero.
const LEAST: f64 = 1e-30;

/// The number, in SI, if it is finite and no larger than 1e30; a negative zero, and what
/// is smaller than 1e-30, becomes zero.
///
/// # Errors
/// What is not finite, or larger.
pub fn finite(value: f64) -> Result<f64, QuantityError> {
    if !value.is_finite() {
        return error(
            format!("`{value}` is not finite"),
            "write a finite number; leave a field out where nothing is known",
        );
    }
    if value.abs() > MOST {
        return error(
            format!("`{}` in SI units is too large", significant(value)),
            format!("at most {MOST:e}; check the unit"),
        );
    }
    Ok(if value.abs() < LEAST { 0.0 } else { value })
}

/// The largest angle (rad): of larger ones rounding takes more and more of what is beyond
/// whole turns.
const MOST_ANGLE: f64 = 1e6;

/// The [`finite`] number, if it can be of this kind.
pub(crate) fn checked(value: f64, dimension: Dimension) -> Result<f64, QuantityError> {
    let value = finite(value)?;
    if dimension == Dimension::Angle && value.abs() > MOST_ANGLE {
        let turns = value.abs() / std::f64::consts::TAU;
        return error(
            format!(
                "{} rad is {turns:.1e} turns, and rounding leaves little of what is beyond them",
                significant(value)
            ),
            format!("at most {MOST_ANGLE:e} rad; check the unit"),
        );
    }
    Ok(value)
}

/// The shortest digits that read back as this number, with an exponent where there would be
/// many zeros.
pub fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

/// The text with the minus of the keyboard in place of the one that is printed, which is
/// what is copied from a page.
pub(crate) fn with_plain_minus(text: &str) -> String {
    text.replace('\u{2212}', "-")
}

/// Reads `value unit`, or a number in SI, or for an angle a fraction of pi
/// (`pi/2`, `-3*pi/4`, `2pi`), into SI units.
///
/// # Errors
/// What is no number, not finite, above 1e30 in SI units, or has a unit that does
/// not fit; a stiffness of zero where a compliance is expected.
pub fn parse(text: &str, dimension: Dimension) -> Result<f64, QuantityError> {
    let text = with_plain_minus(text);
    let text = text.trim();
    let not_a_number = || {
        let help = match dimension {
            Dimension::Angle if text.contains("pi") => "as in `pi/2`, `-3*pi/4` or `2*pi`".to_owned(),
            _ if text.contains(',') => format!("a decimal point, not a comma: {}", dimension.help()),
            _ => dimension.help(),
        };
        error(format!("`{text}` is not {}", dimension.name()), help)
    };
    let (number, rest) = match leading_number(text) {
        Some((number, rest)) => (Some(number), rest),
        None => (None, text),
    };
    let (value, unit) = match fraction_of_pi(number, rest) {
        Some((value, unit)) => {
            if dimension != Dimension::Angle {
                return error(format!("`{text}` is an angle, {} is expected here", dimension.name()), dimension.help());
            }
            if !matches!(unit, "" | "rad") && !is_more_of_it(unit) {
                return error(format!("a fraction of pi is in rad, not in `{unit}`"), "e.g. `pi/2`");
            }
            (value, unit)
        }
        None => match number {
            Some(number) => (number, rest),
            None if is_infinite_or_nan(text) => return error(format!("`{text}` is not finite"), dimension.help()),
            None => return not_a_number(),
        },
    };
    if is_more_of_it(unit) {
        return not_a_number();
    }
    if !value.is_finite() {
        return error(format!("`{text}` is not finite"), dimension.help());
    }
    if unit.is_empty() {
        return checked(value, dimension);
    }
    let unit = find(unit, dimension)?;
    if !unit.inverse {
        return checked(in_si(value, unit), dimension);
    }
    if value == 0.0 {
        return error("a stiffness of zero has no compliance".into(), "a rigid joint has no `compliance` at all");
    }
    finite(unit.per / (value * unit.times))
}

/// A number in a unit, as the number nearest to what is written: `-572.3 mm` is -0.5723, which a
/// quotient of two numbers is not always.
fn in_si(value: f64, unit: &Unit) -> f64 {
    let power = unit.per.log10().round() as i32;
    let is_shifted = unit.times == 1.0 && power > 0 && 10_f64.powi(power) == unit.per;
    let shifted = is_shifted.then(|| format!("{value}e-{power}").parse().ok()).flatten();
    shifted.unwrap_or(value * unit.times / unit.per)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn message(text: &str, dimension: Dimension) -> String {
        parse(text, dimension).expect_err(text).message
    }

    #[test]
    fn units_are_exact_where_they_can_be() {
        use Dimension::*;
        for (text, dimension, si) in [
            ("865 mm", Length, 0.865),
            ("3 um", Length, 3e-6),
            ("3 µm", Length, 3e-6),
            ("-1.5e3mm", Length, -1.5),
            ("-572.3 mm", Length, -0.5723),
            ("6.9 mm", Length, 0.0069),
            ("0.41", Length, 0.41),
            ("+.5 m", Length, 0.5),
            ("180 deg", Angle, PI),
            ("\u{2212}180\u{a0}deg", Angle, -PI),
            ("2.5e\u{2212}7 rad/Nm", Compliance, 2.5e-7),
            ("60 arcmin", Angle, PI / 180.0),
            ("3600 arcsec", Angle, PI / 180.0),
            ("50 urad", Angle, 5e-5),
            ("2.97e-7 rad/Nm", Compliance, 2.97e-7),
            ("0.5 urad/Nm", Compliance, 5e-7),
            ("4e6 Nm/rad", Compliance, 2.5e-7),
            ("4000 kNm/rad", Compliance, 2.5e-7),
            ("4 MNm/rad", Compliance, 2.5e-7),
            ("20 N/um", LinearCompliance, 5e-8),
            ("20000 N/mm", LinearCompliance, 5e-8),
            ("2e7 N/m", LinearCompliance, 5e-8),
            ("5 um/N", LinearCompliance, 5e-6),
            ("2 kN", Force, 2000.0),
            ("2 kNm", Torque, 2000.0),
            ("350 kg", Mass, 350.0),
            ("5 ms", Time, 5e-3),
            ("1200 mm/min", Speed, 0.02),
            ("15 Hz", Frequency, 15.0),
            ("2 mm/s/N", Mobility, 2e-3),
            ("2 g/N", Accelerance, 19.6133),
            ("0.1 mm/tooth", FeedPerTooth, 1e-4),
            ("0.1 mm", FeedPerTooth, 1e-4),
            ("631 N/mm2", Pressure, 6.31e8),
            ("13 N/mm", LineForce, 13e3),
            ("21.5 C", Temperature, 21.5),
            ("0.25", Number, 0.25),
        ] {
            assert_eq!(parse(text, dimension), Ok(si), "{text}");
        }
        let from_arcmin = parse("1000 Nm/arcmin", Dimension::Compliance).unwrap();
        assert!((from_arcmin * 1000.0 * 10_800.0 / PI - 1.0).abs() < 1e-15);
        let from_deg = parse("1000 Nm/deg", Dimension::Compliance).unwrap();
        assert!((from_deg * 1000.0 * 180.0 / PI - 1.0).abs() < 1e-15);
        for text in ["30 rpm", "180 deg/s"] {
            assert!((parse(text, Dimension::RotationalSpeed).unwrap() / PI - 1.0).abs() < 1e-15, "{text}");
        }
    }

    #[test]
    fn angles_of_more_turns_than_count_are_refused() {
        assert_eq!(parse("1e6 rad", Dimension::Angle), Ok(1e6));
        for text in ["-2e6 rad", "1e30 deg", "1e7*pi"] {
            assert!(message(text, Dimension::Angle).contains(" turns, and rounding leaves little"), "{text}");
        }
        assert_eq!(parse("2e6 m", Dimension::Length), Ok(2e6));
    }

    #[test]
    fn what_nothing_real_is_as_small_as_is_zero() {
        for text in ["1e-31 m", "-1e-31", "-0", "5e-324 mm"] {
            let read = parse(text, Dimension::Length).unwrap();
            assert!(read == 0.0 && read.is_sign_positive(), "{text}");
        }
        assert_eq!(parse("-1e-30 m", Dimension::Length), Ok(-1e-30));
        assert_eq!(parse("1e40 Nm/rad", Dimension::Compliance), Ok(0.0));
    }

    #[test]
    fn fractions_of_pi_are_angles() {
        for (text, angle) in [
            ("pi", PI),
            ("-pi/2", -FRAC_PI_2),
            ("- pi / 2", -FRAC_PI_2),
            ("+pi/2 rad", FRAC_PI_2),
            ("3*pi/4", 3.0 * PI / 4.0),
            ("3 * pi / 4", 3.0 * PI / 4.0),
            ("2pi", 2.0 * PI),
            ("-0.5 π", -FRAC_PI_2),
            ("\u{2212}pi/2", -FRAC_PI_2),
        ] {
            assert_eq!(parse(text, Dimension::Angle), Ok(angle), "{text}");
        }
        for text in ["pie", "pi/x", "pi/", "pi*2", "1/2*pi", "p", "3*"] {
            assert_eq!(message(text, Dimension::Angle), format!("`{text}` is not an angle"));
        }
        for text in ["pi/1e999", "pi/0"] {
            assert_eq!(message(text, Dimension::Angle), format!("`{text}` is not finite"));
        }
        assert_eq!(message("pi deg", Dimension::Angle), "a fraction of pi is in rad, not in `deg`");
        assert!(parse("pi*2", Dimension::Angle).unwrap_err().help.contains("`2*pi`"));
    }

    #[test]
    fn errors_tell_apart_what_is_wrong() {
        use Dimension::*;
        assert_eq!(message("3 furlong", Length), "unknown unit `furlong` for a length");
        for (text, dimension, meant) in [
            ("3 Deg", Angle, "did you mean `deg`? "),
            ("3 MM", Length, "did you mean `mm`? "),
            ("3 µM", Length, "did you mean `um`? "),
            ("3 MM", Angle, "write "),
        ] {
            let help = parse(text, dimension).expect_err(text).help;
            assert!(help.starts_with(meant), "{help}");
        }
        assert_eq!(message("3 mm", Angle), "`mm` is a length, an angle is expected here");
        assert_eq!(
            message("3 N/um", Compliance),
            "`N/um` is a translational stiffness, a rotational compliance is expected here"
        );
        assert_eq!(message("3 m", Number), "`m` is a length, a number is expected here");
        assert_eq!(message("three", Number), "`three` is not a number");
        assert_eq!(message("1,5 mm", Length), "`1,5 mm` is not a length");
        for text in ["-.inf m", "nan", "1e999", "infinity", "1e-320 Nm/rad"] {
            assert!(message(text, Compliance).ends_with("is not finite"), "{text}");
        }
        assert_eq!(message("0 Nm/rad", Compliance), "a stiffness of zero has no compliance");
        for text in ["", "-", "+", ".", "e", "e5", "1e", "é", "1é", "--1", "1 2"] {
            parse(text, Length).expect_err(text);
        }
    }

    #[test]
    fn columns_have_factors() {
        assert_eq!(scale("um", Dimension::Length), Ok(1e-6));
        assert_eq!(scale(" deg ", Dimension::Angle), Ok(PI / 180.0));
        assert_eq!(scale("kN", Dimension::Force), Ok(1e3));
        assert!(scale("N", Dimension::Length).is_err());
        assert!(scale("furlong", Dimension::Length).is_err());
        assert_eq!(
            scale("Nm/rad", Dimension::Compliance).unwrap_err().message,
            "`Nm/rad` is a stiffness, a rotational compliance is expected here"
        );
    }
}
