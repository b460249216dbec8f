//! Numbers without a unit that are certainly not in SI.

use crate::dimension::Dimension;
use crate::quantity::QuantityError;
use crate::words::above;
use std::f64::consts::PI;

/// Two turns either way, more than the joints of an arm make (rad).
const MOST_ANGLE: f64 = 4.0 * PI;

/// Longer than any arm, and than the rails that arms stand on (m).
const MOST_LENGTH: f64 = 50.0;

/// Nothing that is so soft is a robot's; a stiffness always is more than 1
/// [rad/Nm or m/N].
const MOST_COMPLIANCE: f64 = 1.0;

/// More than an effect turns anything (rad): eleven degrees.
const MOST_ANGLE_OF_EFFECT: f64 = 0.2;

/// Longer than an effect moves anything (m).
const MOST_LENGTH_OF_EFFECT: f64 = 0.5;

/// The number of an effect that was written without a unit, if it is as small in SI as what
/// a robot does beside what it should.
pub(crate) fn of_effect(value: f64, dimension: Dimension) -> Result<f64, QuantityError> {
    let (most, usual) = match dimension {
        Dimension::Angle => (MOST_ANGLE_OF_EFFECT, "deg"),
        Dimension::Length => (MOST_LENGTH_OF_EFFECT, "mm"),
        _ => return Ok(value),
    };
    if value.abs() <= most {
        return Ok(value);
    }
    let si = dimension.unit();
    Err(QuantityError {
        message: format!("{value} {si} is much for an effect, more than {most} {si}"),
        help: format!("in {usual}? write `{value} {usual}`, or the unit if it is `{value} {si}`"),
    })
}

/// The number that was written without a unit, if a robot can have it in SI.
pub(crate) fn in_si(value: f64, dimension: Dimension) -> Result<f64, QuantityError> {
    let most = match dimension {
        Dimension::Angle => MOST_ANGLE,
        Dimension::Length => MOST_LENGTH,
        Dimension::Compliance | Dimension::LinearCompliance => MOST_COMPLIANCE,
        _ => return Ok(value),
    };
    if value.abs() <= most {
        return Ok(value);
    }
    let number = if value.abs() < 1e5 { value.to_string() } else { format!("{value:e}") };
    let si = dimension.unit();
    let (message, help) = match dimension {
        Dimension::Angle => (
            format!("{number} rad is {} turns, more than two", above(value.abs() / (2.0 * PI), 2.0)),
            format!("write `{number} deg`, or the unit if it is `{number} rad`"),
        ),
        Dimension::Length => (
            format!("{number} m is longer than a robot"),
            format!("in mm? write `{number} mm`, or the unit if it is `{number} m`"),
        ),
        _ => {
            let stiffness = if dimension == Dimension::Compliance { "3e6 Nm/rad" } else { "20 N/um" };
            (
                format!("{number} {si} is no compliance of a robot"),
                format!("a stiffness needs its unit, e.g. `{stiffness}`"),
            )
        }
    };
    Err(QuantityError { message, help })
}
