//! JSON that is always valid: what is not finite is null.

use robstiff::nalgebra::{Dim, Matrix, RawStorage};
use serde_json::Value;

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

    #[test]
    fn what_is_not_finite_is_null() {
        let value = matrix(&Matrix2::new(1.5, f64::NAN, f64::INFINITY, 0.0));
        assert_eq!(value.to_string(), "[[1.5,null],[null,0.0]]");
    }
}
