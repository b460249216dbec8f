//! Files as text.

use crate::diagnostic::{Diagnostic, Diagnostics, Line};
use crate::read::ReadError;
use std::path::Path;

/// The text of a file.
///
/// # Errors
/// A file that cannot be read; one that is not UTF-8, with the place where it
/// ceases to be.
pub fn read(path: &Path) -> Result<String, ReadError> {
    let bytes = std::fs::read(path).map_err(|error| ReadError::Io { path: path.to_owned(), error })?;
    decoded(&path.display().to_string(), bytes).map_err(ReadError::Invalid)
}

/// The text of a file's bytes; `file` is the name that problems show.
///
/// # Errors
/// Where they are not UTF-8.
pub fn decoded(file: &str, bytes: Vec<u8>) -> Result<String, Diagnostics> {
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        foreign(file, &error.into_bytes(), valid).into()
    })
}

/// What is said of bytes of which only the first ones are UTF-8.
fn foreign(file: &str, bytes: &[u8], valid: usize) -> Diagnostic {
    let help = "save the file as UTF-8";
    if let Some(text) = utf_16(bytes) {
        let first = text.lines().next().unwrap_or_default();
        let (line, place) = (Line { number: 1, text: first }, (1, first.chars().count()));
        return Diagnostic::new(file, line, place, "this file is in UTF-16", help);
    }
    let (before, after) = bytes.split_at(valid);
    let number = 1 + before.iter().filter(|byte| **byte == b'\n').count();
    let start = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
    let end = after.iter().position(|byte| *byte == b'\n').map_or(bytes.len(), |at| valid + at);
    let column = 1 + String::from_utf8_lossy(&bytes[start..valid]).chars().count();
    let text = String::from_utf8_lossy(&bytes[start..end]);
    let message = format!("the byte 0x{:02x} here is not UTF-8", bytes[valid]);
    Diagnostic::new(file, Line { number, text: &text }, (column, 1), message, help)
}

/// The text, where a byte order mark says that it is in UTF-16.
fn utf_16(bytes: &[u8]) -> Option<String> {
    let unit: fn([u8; 2]) -> u16 = match bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => return None,
    };
    let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
    Some(String::from_utf16_lossy(&units))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_encodings_are_told_with_their_place() {
        let latin_1 = b"name: Arm\nsource: M\xfcller\njoints: [{}]\n";
        assert_eq!(
            decoded("arm.yaml", latin_1.to_vec()).unwrap_err().to_string(),
            "error: the byte 0xfc here is not UTF-8\n --> arm.yaml:2:10\n  |\n2 | source: M\u{fffd}ller\n  |          ^\n  \
             |\n  = help: save the file as UTF-8"
        );
        let units = |swap: bool| {
            "\u{feff}name: Ä\n"
                .encode_utf16()
                .flat_map(move |unit| if swap { unit.to_be_bytes() } else { unit.to_le_bytes() })
        };
        for swap in [false, true] {
            let told = decoded("arm.yaml", units(swap).collect()).unwrap_err().to_string();
            assert_eq!(
                told,
                "error: this file is in UTF-16\n --> arm.yaml:1:1\n  |\n1 | name: Ä\n  | ^^^^^^^\n  |\n  = help: save the file \
                 as UTF-8"
            );
        }
        assert_eq!(decoded("arm.yaml", "name: Ä".into()).as_deref(), Ok("name: Ä"));
    }

    #[test]
    fn the_last_byte_of_a_file_may_be_the_wrong_one() {
        for bytes in [&b"\xff"[..], b"a\n\xe4", b"\xff\xfe", b"\xc3"] {
            assert!(decoded("x", bytes.to_vec()).unwrap_err().to_string().contains("UTF-"));
        }
    }
}
