//! Numbers in sentences.

/// A count with its noun.
pub fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// Items as a sentence lists them: `a, b and c`.
pub fn and(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [start @ .., last] => format!("{} and {last}", start.join(", ")),
    }
}

/// A number that is above another, with the decimals that show it.
pub(crate) fn above(number: f64, other: f64) -> String {
    let rounded = (0..12).map(|decimals| format!("{number:.decimals$}"));
    let mut shows = rounded.filter(|text| text.parse::<f64>().is_ok_and(|shown| shown > other));
    shows.next().unwrap_or_else(|| number.to_string())
}

/// A number for people who may copy it: with the nine digits that say it as well as all that a
/// sum of decimals leaves, an exponent, and no zeros at the end.
pub(crate) fn significant(number: f64) -> String {
    let rounded = format!("{number:.8e}").parse::<f64>();
    format!("{:e}", rounded.unwrap_or(number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_above_is_shown_above() {
        for (number, shown) in [(17.46, "17"), (5.6, "6"), (5.4, "5.4"), (5.0004, "5.0004"), (1e30, "1e30")] {
            assert_eq!(above(number, 5.0).parse::<f64>(), shown.parse::<f64>());
        }
    }

    #[test]
    fn rounding_is_not_shown() {
        assert_eq!(significant(1.9e-7 + 1.22e-7), "3.12e-7");
        assert_eq!([-4e-7, 0.0, 1.0 / 3.0, 1e30].map(significant), ["-4e-7", "0e0", "3.33333333e-1", "1e30"]);
    }
}
