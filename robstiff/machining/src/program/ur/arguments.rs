//! The arguments of a call.

use std::ops::Range;

/// An argument: its name where it has one, and the bytes of its value.
pub(super) struct Argument<'t> {
    pub(super) name: Option<&'t str>,
    pub(super) value: Range<usize>,
}

/// The arguments of the call whose `(` is the byte `open` of a text, which ends at `end`, and the byte
/// behind its `)`; `None` where that is missing.
pub(super) fn arguments(text: &str, open: usize, end: usize) -> Option<(Vec<Argument<'_>>, usize)> {
    let (mut depth, mut quoted, mut start, mut parts) = (0_usize, false, open + 1, Vec::new());
    for (at, letter) in text[open..end].char_indices() {
        let at = open + at;
        match letter {
            '"' => quoted = !quoted,
            _ if quoted => {}
            '(' | '[' => depth += 1,
            ')' | ']' => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    parts.push(start..at);
                    let arguments = parts.into_iter().map(|part| argument(text, part));
                    return Some((arguments.collect(), at + 1));
                }
            }
            ',' if depth == 1 => {
                parts.push(start..at);
                start = at + 1;
            }
            _ => {}
        }
    }
    None
}

fn argument(text: &str, bytes: Range<usize>) -> Argument<'_> {
    let part = &text[bytes.clone()];
    let (name, value) = match part.split_once('=') {
        Some((name, value)) if is_word(name.trim()) && !value.starts_with('=') => (Some(name.trim()), value),
        _ => (None, part),
    };
    let start = bytes.end - value.trim_start().len();
    Argument { name, value: start..start + value.trim().len() }
}

fn is_word(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}
