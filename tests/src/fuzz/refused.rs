//! What is asked of a refusal.

use robstiff_robots::{Diagnostic, Diagnostics, ReadError};

/// What ends lines, in one format or another.
const BREAKS: [char; 5] = ['\n', '\r', '\u{85}', '\u{2028}', '\u{2029}'];

/// Each problem has a file of these, given with their texts, a line of it and a place in that
/// line, and says something. What is shown of them.
///
/// # Panics
/// Where one has not.
pub fn assert_places(problems: &Diagnostics, files: &[(&str, &str)]) -> String {
    for problem in problems.iter() {
        let Diagnostic { file, line, column, message, .. } = problem;
        let Some((_, text)) = files.iter().find(|(name, _)| name == file) else {
            panic!("no file is named {file:?}: {problem:?}");
        };
        // What is missing may be missing behind the last line break, and behind the end of a line.
        let lines = 1 + text.matches(BREAKS).count();
        assert!((1..=lines).contains(line), "line {line} of {lines}: {problem:?}");
        let columns = 1 + text.split('\n').map(|line| line.chars().count()).max().unwrap_or(0);
        assert!((1..=columns).contains(column), "column {column} of {columns}: {problem:?}");
        assert!(!message.trim().is_empty(), "{problem:?}");
    }
    assert!(problems.iter().next().is_some(), "refused without a reason");
    let shown = problems.to_string();
    assert!(shown.starts_with("error"), "{shown}");
    assert!(!shown.contains(|c: char| c.is_control() && c != '\n'), "{shown:?}");
    shown
}

/// The same where a file may be missing.
///
/// # Panics
/// Where a problem has no place, or an error no file.
pub fn assert_told(error: &ReadError, files: &[(&str, &str)]) -> String {
    match error {
        ReadError::Io { path, .. } => {
            let shown = error.to_string();
            assert!(shown.contains(&path.display().to_string()), "{shown}");
            shown
        }
        ReadError::Invalid(problems) => assert_places(problems, files),
    }
}
