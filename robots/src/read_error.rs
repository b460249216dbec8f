//! Why a file could not be read.

use std::fmt;
use std::io;
use std::path::PathBuf;

use crate::diagnostic::Diagnostics;
use crate::text::shown::shown_in_line;

/// Why a description could not be read.
#[derive(Debug)]
pub enum ReadError {
    /// The file could not be read.
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        error: io::Error,
    },
    /// The file was read, but is not what it should be.
    Invalid(Diagnostics),
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io { path, .. } if path.as_os_str() == "-" => {
                f.write_str("error: `-` does not stand for standard input; name a file")
            }
            Self::Io { path, error } => {
                write!(f, "error: cannot read {}: {error}", shown_in_line(&path.display().to_string()))
            }
            Self::Invalid(problems) => problems.fmt(f),
        }
    }
}

impl std::error::Error for ReadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io { error, .. } => Some(error),
            Self::Invalid(problems) => Some(problems),
        }
    }
}
