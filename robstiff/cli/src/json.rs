//! JSON that is always valid: what is not finite is null.

use std::io::{self, Write};

use robstiff::nalgebra::{Dim, Matrix, RawStorage};
use serde_json::Value;

/// A document whose long lists are made while they are written: as values they would take many times what the
/// file does.
pub enum Lazy<'a> {
    /// What is there.
    Value(Value),
    /// An object, its fields in order.
    Fields(Vec<(&'static str, Lazy<'a>)>),
    /// A list of so many values.
    List(usize, Box<dyn Fn(usize) -> Value + 'a>),
}

impl<'a> Lazy<'a> {
    /// A list with a value for each item.
    pub fn list<T>(items: &'a [T], value: impl Fn(&T) -> Value + 'a) -> Self {
        Self::List(items.len(), Box::new(move |i| value(&items[i])))
    }

    /// Writes it as [`document`] does.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        self.write_within(out, "")?;
        writeln!(out)
    }

    fn write_within(&self, out: &mut impl Write, indent: &str) -> io::Result<()> {
        let inner = format!("{indent}  ");
        // No line ends in a string: JSON has them as `\n`.
        let pretty = |value: &Value, indent: &str| format!("{value:#}").replace('\n', &format!("\n{indent}"));
        match self {
            Self::Value(value) => write!(out, "{}", pretty(value, indent)),
            Self::Fields(fields) => {
                for (i, (name, field)) in fields.iter().enumerate() {
                    write!(out, "{}\n{inner}\"{name}\": ", if i == 0 { "{" } else { "," })?;
                    field.write_within(out, &inner)?;
                }
                if fields.is_empty() { write!(out, "{{}}") } else { write!(out, "\n{indent}}}") }
            }
            Self::List(0, _) => write!(out, "[]"),
            Self::List(count, value) => {
                for i in 0..*count {
                    write!(out, "{}\n{inner}{}", if i == 0 { "[" } else { "," }, pretty(&value(i), &inner))?;
                }
                write!(out, "\n{indent}]")
            }
        }
    }
}

impl From<Value> for Lazy<'_> {
    fn from(value: Value) -> Self {
        Self::Value(value)
    }
}

/// A number; null where there is none.
pub fn number(value: f64) -> Value {
    // serde_json does the same, but by accident of its data model.
    if value.is_finite() { Value::from(value) } else { Value::Null }
}

/// A matrix as a list of its rows.
pub fn matrix<R: Dim, C: Dim, S: RawStorage<f64, R, C>>(matrix: &Matrix<f64, R, C, S>) -> Value {
    matrix.row_iter().map(|row| numbers(row.iter().copied())).collect()
}

/// A list of numbers.
pub fn numbers(values: impl IntoIterator<Item = f64>) -> Value {
    values.into_iter().map(number).collect()
}

/// A document as a file holds it.
pub fn document(value: &Value) -> String {
    format!("{value:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use robstiff::nalgebra::Matrix2;
    use serde_json::json;

    #[test]
    fn what_is_made_while_it_is_written_is_the_same_document() {
        let numbers = [1.5, 2.5];
        let value = |number: &f64| json!({"number": number, "text": "a\nb", "none": []});
        let none: &[f64] = &[];
        let lazy = Lazy::Fields(vec![
            ("name", json!("it").into()),
            ("of", Lazy::Fields(vec![("all", Lazy::list(&numbers, value)), ("none", Lazy::list(none, value))])),
            ("empty", Lazy::Fields(Vec::new())),
            ("rest", json!({"a": [1, {}]}).into()),
        ]);
        let all: Vec<Value> = numbers.iter().map(value).collect();
        let whole = json!({"name": "it", "of": {"all": all, "none": []}, "empty": {}, "rest": {"a": [1, {}]}});
        let mut written = Vec::new();
        lazy.write(&mut written).unwrap();
        assert_eq!(String::from_utf8(written).unwrap(), document(&whole));
    }

    #[test]
    fn what_is_not_finite_is_null() {
        let value = matrix(&Matrix2::new(1.5, f64::NAN, f64::INFINITY, 0.0));
        assert_eq!(value.to_string(), "[[1.5,null],[null,0.0]]");
    }
}
