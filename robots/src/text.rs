//! Files as text.

mod lines;
pub(crate) mod shown;

use std::fs::{self, File, Metadata};
use std::io::{self, Read as _};
use std::path::Path;

use crate::diagnostic::{Diagnostic, Diagnostics, Line};
use crate::read_error::ReadError;

pub use lines::Lines;
pub use shown::{is_bidirectional, shown, shown_in_line};

/// The most bytes of a YAML document; the largest that people write have some ten thousand.
pub const MOST_OF_DOCUMENT: usize = 1 << 20;

/// The most bytes of a URDF file. It names its meshes and does not hold them.
pub const MOST_OF_URDF: usize = 16 << 20;

/// The most bytes of a table. Some million rows are less.
pub const MOST_OF_TABLE: usize = 256 << 20;

/// The text of a file with so many bytes at most.
///
/// # Errors
/// A file that cannot be read, as [`bytes`] has it; one that is not UTF-8, with the place where
/// it ceases to be.
pub fn read(path: &Path, most: usize) -> Result<String, ReadError> {
    let bytes = bytes(path, most).map_err(|error| ReadError::Io { path: path.to_owned(), error })?;
    decoded(&path.display().to_string(), bytes).map_err(ReadError::Invalid)
}

/// What is in a regular file with so many bytes at most.
///
/// # Errors
/// A file that cannot be read; one that is none, such as a folder, a pipe or a device, which
/// may never end; a larger one, of which no more is read.
pub fn bytes(path: &Path, most: usize) -> io::Result<Vec<u8>> {
    // Before it is opened: a pipe waits for its writer.
    check(&fs::metadata(path)?, most)?;
    let file = File::open(path)?;
    // By now another file may have the name.
    let found = file.metadata()?;
    check(&found, most)?;
    let mut bytes = Vec::with_capacity(usize::try_from(found.len()).unwrap_or_default());
    // It may grow, or not say how long it is.
    file.take(most as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > most { Err(too_large(most)) } else { Ok(bytes) }
}

fn check(found: &Metadata, most: usize) -> io::Result<()> {
    if found.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
    }
    if !found.is_file() {
        return Err(io::Error::other("it is a pipe or a device, and only regular files are read"));
    }
    if found.len() > most as u64 { Err(too_large(most)) } else { Ok(()) }
}

fn too_large(most: usize) -> io::Error {
    io::Error::new(io::ErrorKind::FileTooLarge, format!("it is {}", larger(most)))
}

/// `larger than 1 MiB, the most that is read`.
pub(crate) fn larger(most: usize) -> String {
    format!("larger than {} MiB, the most that is read of such a file", most >> 20)
}

/// The text of a file's bytes; `file` is the name that problems show.
///
/// # Errors
/// Where they are not UTF-8.
pub fn decoded(file: &str, bytes: Vec<u8>) -> Result<String, Diagnostics> {
    match String::from_utf8(bytes) {
        // Of a text in UTF-16 without a mark every other byte is a zero, which is UTF-8, too.
        Ok(text) if text.contains('\0') && utf_16(text.as_bytes()).is_some() => {
            Err(foreign(file, text.as_bytes(), text.len()).into())
        }
        Ok(text) => Ok(text),
        Err(error) => {
            let valid = error.utf8_error().valid_up_to();
            Err(foreign(file, &error.into_bytes(), valid).into())
        }
    }
}

/// What is said of bytes of which only the first ones are UTF-8.
fn foreign(file: &str, bytes: &[u8], valid: usize) -> Diagnostic {
    let help = "save the file as UTF-8";
    if let Some((text, is_marked)) = utf_16(bytes) {
        let first = text.lines().next().unwrap_or_default();
        let (line, place) = (Line { number: 1, text: first }, (1, first.chars().count()));
        let message = if is_marked { "this file is in UTF-16" } else { "this file looks like UTF-16" };
        return Diagnostic::new(file, line, place, message, help);
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

/// The text, where a byte order mark says that it is in UTF-16, or zeros in every other place
/// let one guess it; whether there is a mark is the second.
fn utf_16(bytes: &[u8]) -> Option<(String, bool)> {
    // Most characters of what people write for a program are ASCII.
    let mostly_zero =
        |from: usize| 4 * bytes.iter().skip(from).step_by(2).filter(|byte| **byte == 0).count() > bytes.len();
    let (unit, mark): (fn([u8; 2]) -> u16, usize) = match bytes {
        [0xff, 0xfe, ..] => (u16::from_le_bytes, 2),
        [0xfe, 0xff, ..] => (u16::from_be_bytes, 2),
        _ if mostly_zero(1) && !mostly_zero(0) => (u16::from_le_bytes, 0),
        _ if mostly_zero(0) && !mostly_zero(1) => (u16::from_be_bytes, 0),
        _ => return None,
    };
    let units: Vec<u16> = bytes[mark..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
    Some((String::from_utf16_lossy(&units), mark > 0))
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
        // Without the mark it is a guess; a byte beyond ASCII makes no difference.
        for (swap, name) in [(false, "Arm"), (true, "Arm"), (false, "Ä"), (true, "Ä")] {
            let bytes: Vec<u8> = format!("name: {name}\n")
                .encode_utf16()
                .flat_map(|unit| if swap { unit.to_be_bytes() } else { unit.to_le_bytes() })
                .collect();
            let told = decoded("arm.yaml", bytes).unwrap_err().to_string();
            let shown = format!("error: this file looks like UTF-16\n --> arm.yaml:1:1\n  |\n1 | name: {name}\n");
            assert!(told.starts_with(&shown) && told.ends_with("save the file as UTF-8"), "{told}");
        }
        assert_eq!(decoded("arm.yaml", "name: Ä".into()).as_deref(), Ok("name: Ä"));
    }

    #[test]
    fn no_more_of_a_file_is_read_than_may_be() {
        let path = std::env::temp_dir().join(format!("robstiff-text-{}", std::process::id()));
        // A file with a hole takes no room.
        File::create(&path).and_then(|file| file.set_len(1 << 40)).unwrap();
        let told = read(&path, 1 << 20).unwrap_err().to_string();
        assert!(told.ends_with("it is larger than 1 MiB, the most that is read of such a file"), "{told}");
        fs::write(&path, "name: A").unwrap();
        assert_eq!(read(&path, 7).unwrap(), "name: A");
        assert_eq!(bytes(&path, 6).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
        fs::remove_file(&path).unwrap();
        assert_eq!(read(&std::env::temp_dir(), 7).unwrap_err().to_string().rsplit(": ").next(), Some("it is a folder"));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn what_is_no_regular_file_is_not_opened() {
        for device in ["/dev/zero", "/dev/null"] {
            let Err(error) = bytes(Path::new(device), 1 << 20) else { panic!("{device} is no file") };
            assert!(error.to_string().contains("only regular files are read"), "{error}");
        }
        // Files that say that they are empty are read no further either.
        assert!(bytes(Path::new("/proc/self/environ"), 1 << 20).is_ok());
        assert!(bytes(Path::new("/proc/self/maps"), 8).is_err_and(|error| error.kind() == io::ErrorKind::FileTooLarge));
    }

    #[test]
    fn the_last_byte_of_a_file_may_be_the_wrong_one() {
        for bytes in [&b"\xff"[..], b"a\n\xe4", b"\xff\xfe", b"\xc3"] {
            assert!(decoded("x", bytes.to_vec()).unwrap_err().to_string().contains("UTF-"));
        }
    }
}
