//! What is asked of what was accepted.

use std::fmt::Debug;

/// A text with other line breaks.
pub fn with_line_breaks_of_windows(text: &str) -> Option<String> {
    (!text.contains('\r')).then(|| text.replace('\n', "\r\n"))
}

/// Two readings of one text are the same.
///
/// # Panics
/// Where they are not.
pub fn assert_same<T: Debug>(what: &str, one: &T, other: &T) {
    let [one, other] = [one, other].map(|value| format!("{value:?}"));
    assert!(one == other, "{what}:\n{one}\nand\n{other}");
}
