//! Text for people: numbers, and tables with aligned columns.

pub mod words;

use std::fmt;

pub use robstiff_robots::words::{and, count};

/// A number with so many significant digits, as short as it can be said.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "-".to_owned();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').expect("that is how the format writes it");
    let exponent: i32 = exponent.parse().expect("that is how the format writes it");
    if (-3..=4).contains(&exponent) {
        let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
        let plain = format!("{value:.decimals$}");
        return if plain.contains('.') { trimmed(&plain).to_owned() } else { plain };
    }
    let mantissa = if mantissa.contains('.') { trimmed(mantissa) } else { mantissa };
    format!("{mantissa}e{exponent}")
}

fn trimmed(number: &str) -> &str {
    number.trim_end_matches('0').trim_end_matches('.')
}

/// A change in percent, with its sign where it has one.
pub fn change(share: f64) -> String {
    match format!("{:+.0} %", share * 100.0).as_str() {
        "+0 %" | "-0 %" => "0 %".to_owned(),
        said => said.to_owned(),
    }
}

/// A number with so many decimals; what rounds to zero has no sign.
pub fn decimals(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "-".to_owned();
    }
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    }
}

/// A number with its standard deviation, to two digits of that:
/// `(6.31 ± 0.32)e-7`.
pub fn uncertain(value: f64, std: f64) -> String {
    if !(value.is_finite() && std.is_finite() && std > 0.0) {
        return significant(value, 4);
    }
    let exponent = value.abs().max(std).log10().floor();
    let scale = 10_f64.powf(-exponent);
    let suffix = if exponent == 0.0 { String::new() } else { format!("e{exponent}") };
    let decimals = 1.0 - (std * scale).log10().floor();
    if decimals > 5.0 {
        // Of which as many as are written would be zero.
        return format!("({} ± {})", significant(value, 5), significant(std, 2));
    }
    let decimals = decimals.clamp(0.0, 4.0) as usize;
    format!("({:.decimals$} ± {:.decimals$}){suffix}", value * scale, std * scale)
}

/// The same without a power of ten: `0.637 ± 0.032`.
pub fn plus_minus(value: f64, std: f64) -> String {
    if !(value.is_finite() && std.is_finite() && std > 0.0) {
        return significant(value, 4);
    }
    let decimals = 1.0 - std.log10().floor();
    if decimals > 7.0 {
        return format!("{} ± {}", significant(value, 7), significant(std, 2));
    }
    let decimals = decimals.clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$} ± {std:.decimals$}")
}

/// A quantity in SI as one says it in a workshop, with its standard deviation
/// where there is one: compliances in millionths, lengths in mm or um, angles
/// in deg or urad.
pub fn quantity(value: f64, std: Option<f64>, unit: &str) -> String {
    let large = value.abs().max(std.unwrap_or(0.0)) >= 1e-3;
    let (factor, shown) = match unit {
        "1" => (1.0, ""),
        "m" if large => (1e3, "mm"),
        "rad" if large => (1.0_f64.to_degrees(), "deg"),
        // Metres and radians, alone or over something.
        _ if unit.starts_with("m/") || unit.starts_with("rad/") || matches!(unit, "m" | "rad") => (1e6, unit),
        _ => (1.0, unit),
    };
    let number = plus_minus(value * factor, std.unwrap_or(f64::NAN) * factor);
    let micro = if factor == 1e6 { "u" } else { "" };
    format!("{number} {micro}{shown}").trim_end().to_owned()
}

/// Whether a number is a compliance, by its unit, and not a length or an angle.
pub fn is_compliance(unit: &str) -> bool {
    unit.contains('/')
}

/// A probability; what random signs of poses resolve has three decimals.
pub fn probability(p: f64) -> String {
    if p < 0.001 { "< 0.001".to_owned() } else { decimals(p, 3) }
}

/// The same in a sentence: `p < 0.001`, `p = 0.012`.
pub fn p_value(p: f64) -> String {
    let said = probability(p);
    if said.starts_with('<') { format!("p {said}") } else { format!("p = {said}") }
}

/// A sentence begins with a capital.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A length in m as micrometres without the unit.
pub fn micrometres(length: f64) -> String {
    decimals(length * 1e6, 1)
}

/// An error or noise (m) as micrometres without the unit: to two digits where it is
/// less than one, so that it shows what it falls by.
pub fn fine_micrometres(length: f64) -> String {
    let small = (1e-9..9.5e-7).contains(&length);
    if small { significant(length * 1e6, 2) } else { micrometres(length) }
}

/// How an error (m) changes, in micrometres without the unit: `falls from 17.4 to 12.1`. Errors that are
/// written alike stay, whatever their further digits do.
pub fn change_of_error(before: f64, after: f64) -> String {
    let [from, to] = [before, after].map(fine_micrometres);
    if from == to {
        return format!("stays at {to}");
    }
    let does = if after < before { "falls" } else { "rises" };
    format!("{does} from {from} to {to}")
}

/// A number with so many decimals as a field of a CSV file; empty where there is none.
pub fn cell(value: f64, decimals: usize) -> String {
    if value.is_finite() { self::decimals(value, decimals) } else { String::new() }
}

/// A text as a field of a CSV file.
pub fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// A table with aligned columns, indented by two.
pub struct Table {
    rows: Vec<Vec<String>>,
    left: usize,
}

impl Table {
    /// A table with a line of headings; the first `left` columns are words,
    /// the others numbers, which line up at the right.
    pub fn new<S: Into<String>>(left: usize, header: impl IntoIterator<Item = S>) -> Self {
        Self { rows: vec![header.into_iter().map(Into::into).collect()], left }
    }

    /// Adds a row.
    pub fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |k: usize| self.rows.iter().filter_map(|row| row.get(k)).map(|cell| cell.chars().count()).max();
        let widths: Vec<usize> = (0..columns).map(|k| width(k).unwrap_or(0)).collect();
        for row in &self.rows {
            let mut line = String::new();
            for (k, cell) in row.iter().enumerate() {
                let width = widths[k];
                line += "  ";
                line += &if k < self.left { format!("{cell:<width$}") } else { format!("{cell:>width$}") };
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_holds_a_number_or_nothing() {
        let cells = [1.25, -0.0001, f64::INFINITY, f64::NEG_INFINITY, f64::NAN].map(|value| cell(value, 2));
        assert_eq!(cells, ["1.25", "0.00", "", "", ""]);
    }

    #[test]
    fn fields_with_commas_are_quoted() {
        assert_eq!(["p 1", "a,b", "say \"x\""].map(field), ["p 1", "\"a,b\"", "\"say \"\"x\"\"\""]);
    }

    #[test]
    fn an_error_that_is_written_alike_stays() {
        let change = |before: f64, after: f64| change_of_error(before * 1e-6, after * 1e-6);
        assert_eq!(change(233.9, 79.81), "falls from 233.9 to 79.8");
        assert_eq!(change(17.44, 17.36), "stays at 17.4");
        assert_eq!(change(17.36, 17.44), "stays at 17.4");
        assert_eq!(change(0.5, 0.71), "rises from 0.5 to 0.71");
    }

    #[test]
    fn probabilities_and_beginnings_of_sentences_are_words() {
        assert_eq!([1e-5, 0.0123, 1.0].map(p_value), ["p < 0.001", "p = 0.012", "p = 1.000"]);
        assert_eq!(["lost motion", "", "öl"].map(capital), ["Lost motion", "", "Öl"]);
    }

    #[test]
    fn what_has_not_changed_has_no_sign() {
        assert_eq!([0.314, -0.05, 0.001, -0.001].map(change), ["+31 %", "-5 %", "0 %", "0 %"]);
    }

    #[test]
    fn a_small_error_shows_what_it_falls_by() {
        let written = [2.338e-4, 9.96e-7, 9.4e-7, 8.61e-7, 5.2e-8, 0.0, f64::NAN];
        assert_eq!(written.map(fine_micrometres), ["233.8", "1.0", "0.94", "0.86", "0.052", "0.0", "-"]);
    }

    #[test]
    fn numbers_are_short() {
        let written = [2.97e-7, 0.012345, 1234.56, 3.367e6, 100.0, 0.0, -0.5, 10.0, f64::NAN, 99999.0];
        let shown = written.map(|value| significant(value, 3));
        assert_eq!(shown, ["2.97e-7", "0.0123", "1235", "3.37e6", "100", "0", "-0.5", "10", "-", "1e5"]);
    }

    #[test]
    fn uncertainty_sets_the_digits() {
        assert_eq!(uncertain(6.314e-7, 3.2e-8), "(6.31 ± 0.32)e-7");
        assert_eq!(uncertain(2.0, 0.5), "(2.00 ± 0.50)");
        assert_eq!(uncertain(-1e-8, 4e-7), "(-0.1 ± 4.0)e-7");
        assert_eq!(plus_minus(-251.3, 20.4), "-251 ± 20");
        assert_eq!(uncertain(3e-7, f64::NAN), "3e-7");
        assert_eq!(plus_minus(0.6314, 0.032), "0.631 ± 0.032");
        assert_eq!(plus_minus(4.9, 4.1), "4.9 ± 4.1");
        assert_eq!(plus_minus(0.3, f64::NAN), "0.3");
        // Digits that would all be zeros tell nothing.
        assert_eq!(uncertain(2.5e-7, 1e-13), "(2.5e-7 ± 1e-13)");
        assert_eq!(uncertain(2.5e-7, 3.2e-11), "(2.5000 ± 0.0003)e-7");
        assert_eq!(plus_minus(0.3, 1.2e-9), "0.3 ± 1.2e-9");
        assert_eq!(plus_minus(0.3, 2e-6), "0.300000 ± 0.000002");
    }

    #[test]
    fn quantities_are_in_units_of_the_workshop() {
        assert_eq!(quantity(6.314e-7, Some(3.2e-8), "rad/Nm"), "0.631 ± 0.032 urad/Nm");
        assert_eq!(quantity(-0.251, Some(0.020), "m"), "-251 ± 20 mm");
        assert_eq!(quantity(2e-5, Some(1e-6), "m"), "20.0 ± 1.0 um");
        assert_eq!(quantity(0.05, Some(0.0087), "rad"), "2.86 ± 0.50 deg");
        assert_eq!(quantity(127.0, None, "Nm"), "127 Nm");
        assert_eq!(quantity(0.25, None, "1"), "0.25");
        assert_eq!(quantity(3e-6, Some(1e-6), "m/h"), "3.0 ± 1.0 um/h");
    }

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(decimals(-0.0004, 3), "0.000");
        assert_eq!(decimals(-0.0006, 3), "-0.001");
    }

    #[test]
    fn columns_line_up() {
        let mut table = Table::new(1, ["axis", "um"]);
        table.row(["x", "10.5"]);
        table.row(["long name", "7"]);
        assert_eq!(table.to_string(), "  axis         um\n  x          10.5\n  long name     7\n");
    }

    #[test]
    fn lists_read_as_sentences() {
        let list = |items: &[&str]| and(&items.iter().map(|&item| item.to_owned()).collect::<Vec<_>>());
        assert_eq!([list(&[]), list(&["a"]), list(&["a", "b", "c"])], ["", "a", "a, b and c"]);
    }
}
