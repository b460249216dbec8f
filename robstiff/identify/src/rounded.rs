//! Fitted numbers with as many digits as they mean.

use robstiff::Effect;
use robstiff_robots::Description;
use robstiff_robots::effect::physics::{Parameter, Range};
use robstiff_robots::quantity::{Dimension, parse};

/// Significant digits of fitted compliances and of the numbers of effects. No campaign shows four.
const DIGITS: usize = 6;

/// Fitted lengths are whole multiples of this (m): no tracker reads a hundredth of it.
const LENGTH: f64 = 1e-8;

/// Decimals of fitted angles in degrees: at a reach of 3 m the last moves the tool by 50 nm.
const DECIMALS: usize = 6;

/// A fitted description with its numbers rounded, but for those that are as declared.
#[must_use]
pub fn rounded(mut fitted: Description, declared: &Description) -> Description {
    for (joint, before) in fitted.joints.iter_mut().zip(&declared.joints) {
        for (number, before) in [(&mut joint.d, before.d), (&mut joint.a, before.a)] {
            keep_or(number, before, |length| (length / LENGTH).round() * LENGTH);
        }
        for (number, before) in [(&mut joint.theta, before.theta), (&mut joint.alpha, before.alpha)] {
            keep_or(number, before, in_degrees);
        }
        let was = |k: usize| before.compliance.get(k).map_or(0.0, |part| part.value);
        for (k, part) in joint.compliance.iter_mut().enumerate() {
            keep_or(&mut part.value, was(k), significant);
        }
    }
    for effect in fitted.effects.iter_mut().filter(|effect| !declared.effects.contains(effect)) {
        let round = |(parameter, value): (&Parameter, f64)| match parameter.range {
            Range::Whole(_) => value,
            _ => significant(value),
        };
        let numbers: Vec<f64> = effect.parameters().map(round).collect();
        if let Some(rounded) = Effect::of_kind(effect.kind(), effect.place(), &numbers) {
            *effect = rounded;
        }
    }
    fitted
}

fn keep_or(number: &mut f64, declared: f64, round: impl Fn(f64) -> f64) {
    if *number != declared {
        *number = round(*number);
    }
}

/// The angle (rad) that is read from its degrees with [`DECIMALS`].
fn in_degrees(angle: f64) -> f64 {
    parse(&format!("{:.DECIMALS$} deg", angle.to_degrees()), Dimension::Angle).unwrap_or(angle)
}

/// The number with [`DIGITS`] significant digits.
fn significant(number: f64) -> f64 {
    format!("{number:.*e}", DIGITS - 1).parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use robstiff_robots::samples;

    use super::*;

    #[test]
    fn what_was_fitted_has_few_digits_and_what_was_declared_all_of_its_own() {
        let declared = samples::five_axis();
        let mut fitted = declared.clone();
        fitted.joints[0].compliance[0].value = 2.571_234_567_89e-7;
        fitted.joints[1].a += 1.234_567_891_23e-5;
        fitted.joints[2].theta += 3.3e-5;
        let rounded = rounded(fitted.clone(), &declared);
        let yaml = rounded.to_yaml();
        assert!(yaml.contains("compliance: 2.57123e-7 rad/Nm"), "{yaml}");
        assert_eq!(rounded.joints[3..], declared.joints[3..]);
        assert!((rounded.joints[1].a - fitted.joints[1].a).abs() <= 0.5 * LENGTH * 1.001);
        assert!((rounded.joints[2].theta - fitted.joints[2].theta).abs().to_degrees() <= 0.501e-6);
        // No number has a tail of digits.
        let longest = yaml.split(|c: char| !c.is_ascii_digit() && c != '.').map(str::len).max();
        assert!(longest <= Some(12), "{yaml}");
    }
}
