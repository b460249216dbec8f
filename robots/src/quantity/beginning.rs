//! What a quantity begins with: a number, or a fraction of pi.

use std::f64::consts::PI;

/// The number at the start of a text and what follows it, blanks removed.
pub fn leading_number(text: &str) -> Option<(f64, &str)> {
    let bytes = text.as_bytes();
    let digits_from = |start: usize| start + bytes[start..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let mut end = digits_from(sign);
    if bytes.get(end) == Some(&b'.') {
        end = digits_from(end + 1);
    }
    if let Some(b'e' | b'E') = bytes.get(end) {
        let signed = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        // Without digits the `e` is no exponent.
        if digits_from(signed.min(bytes.len())) > signed {
            end = digits_from(signed);
        }
    }
    let number = text[..end].parse().ok()?;
    Some((number, text[end..].trim_start()))
}

/// The angle, and the unit behind it, where `[number [*]] pi [/ number]` stands.
pub fn fraction_of_pi(number: Option<f64>, rest: &str) -> Option<(f64, &str)> {
    let (factor, rest) = match number {
        Some(number) => (number, rest.strip_prefix('*').unwrap_or(rest).trim_start()),
        None => match rest.strip_prefix('-') {
            Some(rest) => (-1.0, rest.trim_start()),
            None => (1.0, rest.strip_prefix('+').unwrap_or(rest).trim_start()),
        },
    };
    let rest = rest.strip_prefix("pi").or_else(|| rest.strip_prefix('π'))?;
    if rest.starts_with(char::is_alphanumeric) {
        return None;
    }
    match rest.trim_start().strip_prefix('/') {
        Some(divisor) => {
            let (divisor, unit) = leading_number(divisor.trim_start())?;
            // By what is not finite everything is 0.
            let angle = if divisor.is_finite() { factor * PI / divisor } else { f64::NAN };
            Some((angle, unit))
        }
        None => Some((factor * PI, rest.trim_start())),
    }
}

/// Whether what follows a number is no unit, but a part of a number or of a formula.
pub fn is_more_of_it(rest: &str) -> bool {
    rest.starts_with(|first: char| first.is_ascii_digit() || ".,_*/+-".contains(first))
}

/// Whether a text is `inf` or `nan`, as floating-point numbers are written that are none.
pub fn is_infinite_or_nan(text: &str) -> bool {
    let word = text.split_whitespace().next().unwrap_or_default().trim_start_matches(['+', '-']);
    matches!(word.trim_start_matches('.').to_ascii_lowercase().as_str(), "inf" | "nan" | "infinity")
}
