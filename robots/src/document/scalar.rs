//! What a scalar of a YAML document is: the core schema of YAML 1.2.2, section 10.3.2, which
//! also has numbers in base 2 and with an underscore nowhere.

use super::content::Value;

/// The value of a scalar that is written without quotes.
pub(super) fn plain(text: &str) -> Value {
    match text {
        "" | "~" | "null" | "Null" | "NULL" => Value::Null,
        "true" | "True" | "TRUE" => Value::Bool(true),
        "false" | "False" | "FALSE" => Value::Bool(false),
        _ => number(text).unwrap_or_else(|| Value::Text(text.into())),
    }
}

fn number(text: &str) -> Option<Value> {
    let (sign, digits) = match text.as_bytes() {
        [b'-', ..] => (-1, &text[1..]),
        [b'+', ..] => (1, &text[1..]),
        _ => (1, text),
    };
    // A second sign makes a text of it.
    if digits.starts_with(['+', '-']) {
        return None;
    }
    let in_base = |prefix: &str, base| digits.strip_prefix(prefix).map(|digits| (digits, base));
    if let Some((digits, base)) = in_base("0x", 16).or_else(|| in_base("0o", 8)).or_else(|| in_base("0b", 2)) {
        let is_number = digits.starts_with(|first: char| first.is_digit(base));
        return is_number.then(|| i128::from_str_radix(digits, base).ok()).flatten().map(|value| whole(sign * value));
    }
    match digits {
        ".inf" | ".Inf" | ".INF" => return Some(Value::Number(f64::from(sign as i8) * f64::INFINITY)),
        ".nan" | ".NaN" | ".NAN" if digits.len() == text.len() => return Some(Value::Number(f64::NAN)),
        _ => {}
    }
    let is_whole = digits.bytes().all(|byte| byte.is_ascii_digit());
    // With a zero before it, it is an id and no number.
    if is_whole && digits.len() > 1 && digits.starts_with('0') {
        return None;
    }
    // As words they are no numbers, nor is what is too large for one.
    if !digits.starts_with(|first: char| first.is_ascii_digit() || first == '.') {
        return None;
    }
    let value = digits.parse::<i128>().ok().filter(|_| is_whole).map(|value| whole(sign * value));
    let real = || text.parse::<f64>().ok().filter(|value| value.is_finite()).map(Value::Number);
    value.or_else(real)
}

/// A whole number; beyond 64 bits it is rounded.
fn whole(value: i128) -> Value {
    i64::try_from(value).map_or(Value::Number(value as f64), Value::Integer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scalars_are_what_the_core_schema_says() {
        let said = |text: &str| format!("{:?}", plain(text));
        for (text, value) in [
            ("", "Null"),
            ("~", "Null"),
            ("true", "Bool(true)"),
            ("1", "Integer(1)"),
            ("-12", "Integer(-12)"),
            ("+3", "Integer(3)"),
            ("0x1F", "Integer(31)"),
            ("-0o17", "Integer(-15)"),
            ("0b101", "Integer(5)"),
            ("9223372036854775808", "Number(9.223372036854776e18)"),
            ("-0", "Integer(0)"),
            ("1.5", "Number(1.5)"),
            (".5", "Number(0.5)"),
            ("1.", "Number(1.0)"),
            ("-1e-7", "Number(-1e-7)"),
            (".inf", "Number(inf)"),
            ("-.INF", "Number(-inf)"),
            (".nan", "Number(NaN)"),
            ("1e400", "Text(\"1e400\")"),
            ("007", "Text(\"007\")"),
            ("--1", "Text(\"--1\")"),
            ("0x", "Text(\"0x\")"),
            ("0x+1", "Text(\"0x+1\")"),
            ("inf", "Text(\"inf\")"),
            ("nan", "Text(\"nan\")"),
            ("-", "Text(\"-\")"),
            (".", "Text(\".\")"),
            ("1_000", "Text(\"1_000\")"),
            ("yes", "Text(\"yes\")"),
            ("1 m", "Text(\"1 m\")"),
        ] {
            assert_eq!(said(text), value, "{text}");
        }
    }
}
