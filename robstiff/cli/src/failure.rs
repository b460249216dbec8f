//! Why a command stops.

use std::fmt;
use std::path::Path;
use std::process::ExitCode;

use robstiff_identify::campaign::Campaign;
use robstiff_robots::{Diagnostics, ReadError};

/// Problems of a file that are shown: of those that readers record, enough to see what is wrong.
const MOST_SHOWN: usize = 10;

/// A failure that is explained to the person who ran the command.
#[derive(Debug)]
pub enum Failure {
    /// What was asked for cannot be done (exit code 1); the whole message.
    Explained(String),
    /// What was asked for makes no sense (exit code 2).
    Usage(String),
}

impl Failure {
    /// A failure from a sentence.
    pub fn new(sentence: impl fmt::Display) -> Self {
        Self::Explained(format!("error: {sentence}"))
    }

    /// A failure of what a campaign was asked for, which names its file.
    pub fn about(campaign: &Campaign) -> impl Fn(robstiff_identify::identify::Error) -> Self {
        move |error| Self::new(format_args!("{}: {error}", campaign.path.display()))
    }

    /// What is said where a file would be overwritten and `--force` is not given; `other` is
    /// what may be chosen instead.
    pub fn there_already(path: &Path, other: &str) -> Self {
        Self::new(format_args!(
            "{} is there already, and would be overwritten; choose another {other}, or say --force",
            path.display()
        ))
    }

    /// What the process exits with.
    pub fn code(&self) -> ExitCode {
        match self {
            Self::Explained(_) => ExitCode::from(1),
            Self::Usage(_) => ExitCode::from(2),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Explained(message) => f.write_str(message),
            Self::Usage(sentence) => write!(f, "error: {sentence}\n\nFor more information, try '--help'."),
        }
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        match error {
            ReadError::Invalid(problems) => problems.into(),
            // Readers' messages begin with `error:` themselves.
            error @ ReadError::Io { .. } => Self::Explained(error.to_string()),
        }
    }
}

impl From<robstiff_machining::path::Unsolved> for Failure {
    fn from(unsolved: robstiff_machining::path::Unsolved) -> Self {
        Self::Explained(unsolved.to_string())
    }
}

impl From<Diagnostics> for Failure {
    fn from(problems: Diagnostics) -> Self {
        let shown: Vec<String> = problems.iter().take(MOST_SHOWN).map(ToString::to_string).collect();
        let message = shown.join("\n\n");
        let all = problems.iter().count();
        let least = if problems.may_be_more() { "at least " } else { "" };
        Self::Explained(match all - shown.len() {
            0 => message,
            more => format!("{message}\n\nand {least}{more} more"),
        })
    }
}
