//! Numbers in sentences.

/// A count with its noun.
pub fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// A number that is above another, with the decimals that show it.
pub(crate) fn above(number: f64, other: f64) -> String {
    let rounded = (0..12).map(|decimals| format!("{number:.decimals$}"));
    let mut shows = rounded.filter(|text| text.parse::<f64>().is_ok_and(|shown| shown > other));
    shows.next().unwrap_or_else(|| number.to_string())
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
}
