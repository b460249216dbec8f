//! How a table is written: what separates its columns, and whether its decimal sign is a comma.
//!
//! Spreadsheets of half the world separate columns by semicolons, for the comma is their decimal
//! sign. What is copied out of one is separated by tabs. Both are taken where only one reading
//! is possible.

use std::borrow::Cow;

/// How a table is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Form {
    /// What separates the columns.
    pub separator: char,
    /// The first number with a decimal comma, with its line, where the numbers have one.
    pub comma: Option<(usize, String)>,
}

/// What can be understood in two ways.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ambiguous {
    /// The line, from 1.
    pub line: usize,
    /// The field in that line; `usize::MAX` for all of it.
    pub field: usize,
    /// What is ambiguous.
    pub message: String,
    /// What would not be.
    pub help: String,
}

impl Default for Form {
    fn default() -> Self {
        Self { separator: ',', comma: None }
    }
}

/// What columns may be separated by, with its name.
const SEPARATORS: [(char, &str); 3] = [(',', "commas"), (';', "semicolons"), ('\t', "tabs")];

/// Columns whose cells are names and clock times, and say nothing of numbers.
const NO_NUMBERS: [&str; 3] = ["pose", "visit", "time"];

impl Form {
    /// That of a text.
    ///
    /// # Errors
    /// A text that can be read in two ways, with the place where they differ.
    pub fn of(text: &str) -> Result<Self, Ambiguous> {
        let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
        let Some((number, header)) = lines.next() else { return Ok(Self::default()) };
        let there: Vec<(char, &str)> =
            SEPARATORS.into_iter().filter(|&(separator, _)| fields(header, separator).len() > 1).collect();
        let separator = match there[..] {
            // One column, or none that can be told.
            [] | [(',', _)] => return Ok(Self::default()),
            [(separator, _)] => separator,
            _ => {
                // Of several, the one that divides every row as it does the header.
                let rows: Vec<&str> = lines.clone().map(|(_, line)| line).collect();
                let divides = |&&(separator, _): &&(char, &str)| {
                    let count = fields(header, separator).len();
                    rows.iter().all(|row| fields(row, separator).len() == count)
                };
                let fitting: Vec<&(char, &str)> = there.iter().filter(divides).collect();
                match fitting[..] {
                    [(separator, _)] => *separator,
                    // The fault is in the rows, and is found there.
                    [] if there[0].0 == ',' && rows_have_only_commas(&rows) => ',',
                    _ => return Err(separated_by(number, &there)),
                }
            }
        };
        if separator == ',' {
            return Ok(Self::default());
        }
        let is_name = |name: &str| NO_NUMBERS.contains(&name.split('[').next().unwrap_or_default().trim());
        let skipped: Vec<bool> = fields(header, separator).into_iter().map(is_name).collect();
        let cells = lines.flat_map(|(line, row)| {
            let cells = fields(row, separator).into_iter().enumerate();
            cells.map(move |(field, cell)| (line, field, cell))
        });
        let cells = cells.filter(|&(_, field, _)| !skipped.get(field).copied().unwrap_or_default());
        let (mut commas, mut points) = (Signs::default(), Signs::default());
        for (line, field, cell) in cells {
            if is_number_with(cell, ',') {
                commas.take(line, field, cell);
            } else if is_number_with(cell, '.') {
                points.take(line, field, cell);
            }
        }
        // A tab goes with a point as well as with a comma, and says nothing of thousands.
        let of_thousands = match (&commas.first, &points.first) {
            (Some(_), _) => commas.only_thousands.then_some((&commas, ',', '.')),
            (None, Some(_)) if separator == ';' => points.only_thousands.then_some((&points, '.', ',')),
            _ => None,
        };
        if let Some((signs, sign, other)) = of_thousands
            && let Some((line, field, cell)) = &signs.first
        {
            return Err(thousands((*line, *field), cell, [sign, other]));
        }
        Ok(Self { separator, comma: commas.first.map(|(line, _, cell)| (line, cell)) })
    }

    /// A cell as a number is written here, with a point.
    pub fn with_point<'c>(&self, cell: &'c str) -> Cow<'c, str> {
        match self.comma {
            Some(_) if is_number_with(cell, ',') => Cow::Owned(cell.replacen(',', ".", 1)),
            _ => Cow::Borrowed(cell),
        }
    }

    /// What is wrong with a number whose decimal sign is a point, where others have a comma, and what
    /// would be right.
    pub fn mixed(&self, cell: &str) -> Option<[String; 2]> {
        let (line, other) = self.comma.as_ref()?;
        is_number_with(cell, '.').then(|| {
            [
                format!("`{cell}` has a point, and `{other}` on line {line} a decimal comma"),
                format!("write all numbers with one decimal sign: `{}`", cell.replacen('.', ",", 1)),
            ]
        })
    }
}

/// The numbers of a file with one decimal sign.
struct Signs {
    /// The first, with its line and field.
    first: Option<(usize, usize, String)>,
    /// Whether every one of them could be a whole number whose thousands are set apart.
    only_thousands: bool,
}

impl Default for Signs {
    fn default() -> Self {
        Self { first: None, only_thousands: true }
    }
}

impl Signs {
    fn take(&mut self, line: usize, field: usize, cell: &str) {
        self.first.get_or_insert_with(|| (line, field, cell.to_owned()));
        self.only_thousands &= may_be_thousands(cell);
    }
}

fn rows_have_only_commas(rows: &[&str]) -> bool {
    rows.iter().all(|row| !row.contains([';', '\t']))
}

fn separated_by(line: usize, there: &[(char, &str)]) -> Ambiguous {
    let names: Vec<&str> = there.iter().map(|&(_, name)| name).collect();
    Ambiguous {
        line,
        field: usize::MAX,
        message: format!("the header has {}: which of them separate the columns?", names.join(" and ")),
        help: "separate the columns by one of them, and put a name that has it in quotes".to_owned(),
    }
}

fn thousands((line, field): (usize, usize), cell: &str, [sign, other]: [char; 2]) -> Ambiguous {
    let whole = cell.replacen(sign, "", 1);
    let decimal = cell.replacen(sign, ".", 1);
    Ambiguous {
        line,
        field,
        message: format!("`{cell}` may be {decimal} or {whole}, and so may all numbers with a `{sign}` in this file"),
        help: format!(
            "write one of them with other than three decimals, e.g. `{cell}0`, or all with `{}`",
            cell.replacen(sign, &other.to_string(), 1)
        ),
    }
}

/// The fields of a line, without blanks and quotes about them.
fn fields(line: &str, separator: char) -> Vec<&str> {
    let (mut quoted, mut start, mut found) = (false, 0, Vec::new());
    for (at, character) in line.char_indices() {
        match character {
            '"' => quoted = !quoted,
            _ if character == separator && !quoted => {
                found.push(&line[start..at]);
                start = at + character.len_utf8();
            }
            _ => {}
        }
    }
    found.push(&line[start..]);
    found.into_iter().map(|field| field.trim().trim_matches('"').trim()).collect()
}

/// Whether a cell is a number with this decimal sign, and no other sign that could be one.
fn is_number_with(cell: &str, sign: char) -> bool {
    let other = if sign == ',' { '.' } else { ',' };
    let is_written = cell.bytes().all(|byte| byte.is_ascii_digit() || b"+-.,eE".contains(&byte));
    is_written
        && cell.matches(sign).count() == 1
        && !cell.contains(other)
        && cell.replacen(sign, ".", 1).parse::<f64>().is_ok()
}

/// Whether a number with one sign could be a whole one: one to three digits, not 0 before all, then
/// the sign and three more.
fn may_be_thousands(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['+', '-']);
    let Some((before, behind)) = digits.split_once([',', '.']) else { return false };
    let are_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    (1..=3).contains(&before.len())
        && !before.starts_with('0')
        && behind.len() == 3
        && are_digits(before)
        && are_digits(behind)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> (char, bool) {
        let form = Form::of(text).expect("one way to read it");
        (form.separator, form.comma.is_some())
    }

    #[test]
    fn separators_and_decimal_signs_are_recognised() {
        assert_eq!(of("pose,q1\n1,0.5\n"), (',', false));
        assert_eq!(of("\npose;q1\n1;0,5\n"), (';', true));
        assert_eq!(of("pose;q1\n1;0.5\n"), (';', false));
        assert_eq!(of("pose\tq1\n1\t0.5\n"), ('\t', false));
        assert_eq!(of("pose\tq1\n1\t-1,5e-3\n"), ('\t', true));
        // Ids and clocks are no numbers.
        assert_eq!(of("pose;time;q1\n1,2;12:00:01,5;0.5\n"), (';', false));
        // A name may have a comma; the rows say what it is.
        assert_eq!(of("Kraft, x [N];q1\n12;0,5\n13;1\n"), (';', true));
        assert_eq!(of("pose,a;b\n1,2\n"), (',', false));
        assert_eq!(of("\"a;b\",c\n1,2\n"), (',', false));
        assert_eq!(of(""), (',', false));
    }

    #[test]
    fn what_can_be_read_in_two_ways_is_said() {
        let said = |text: &str| Form::of(text).expect_err("two ways").message;
        assert_eq!(
            said("pose;F\n1;12,345\n2;1,250\n"),
            "`12,345` may be 12.345 or 12345, and so may all numbers with a `,` in this file"
        );
        assert!(said("pose;F\n1;1.000\n").starts_with("`1.000` may be 1.000 or 1000"));
        assert_eq!(of("pose;F\n1;12,345\n2;0,250\n"), (';', true));
        assert_eq!(of("pose\tF\n1\t1.000\n"), ('\t', false));
        let both = "the header has commas and semicolons: which of them separate the columns?";
        assert_eq!(said("a,b;c,d\n1;2\n3,4,5\n"), both);
    }

    #[test]
    fn a_point_among_commas_is_said() {
        let form = Form::of("pose;q1\n1;0,5\n2;1.5\n").expect("semicolons");
        assert_eq!(form.with_point("0,5"), "0.5");
        assert_eq!(form.with_point("1,234,567"), "1,234,567");
        let [message, help] = form.mixed("1.5").expect("a point");
        assert_eq!(message, "`1.5` has a point, and `0,5` on line 2 a decimal comma");
        assert!(help.ends_with("`1,5`"));
        assert_eq!(form.mixed("15"), None);
    }
}
