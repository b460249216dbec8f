//! What the writers share.

use std::fmt;

use super::{Instruction, Program, TextFile};

/// An instruction that a language cannot express.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unwritable {
    /// Its number in the program, from 1; 0 for the program itself.
    pub instruction: usize,
    /// What is wrong, and what would be right.
    pub why: String,
}

impl fmt::Display for Unwritable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.instruction {
            0 => f.write_str(&self.why),
            number => write!(f, "instruction {number}: {}", self.why),
        }
    }
}

impl std::error::Error for Unwritable {}

/// A number with so many decimals; a zero has no sign.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|byte| matches!(byte, b'0' | b'.')) => digits.to_owned(),
        _ => text,
    }
}

/// A number with at most so many decimals, and none that is a zero at the end.
pub(super) fn short(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    if !text.contains('.') {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Whether a name is letters, digits and `_`, begins with a letter, and has at most so many.
pub(super) fn is_name(name: &str, most: usize) -> bool {
    name.starts_with(|first: char| first.is_ascii_alphabetic())
        && name.len() <= most
        && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}

/// Calls a writer for each instruction and collects what it cannot express.
pub(super) fn each(program: &Program, mut write: impl FnMut(&Instruction) -> Result<(), String>) -> Vec<Unwritable> {
    (1..)
        .zip(&program.instructions)
        .filter_map(|(number, instruction)| Some(Unwritable { instruction: number, why: write(instruction).err()? }))
        .collect()
}

/// The files, if nothing was wrong.
pub(super) fn finish(files: Vec<TextFile>, wrong: Vec<Unwritable>) -> Result<Vec<TextFile>, Vec<Unwritable>> {
    if wrong.is_empty() { Ok(files) } else { Err(wrong) }
}

/// `None` for a name that is one, else what would be right.
pub(super) fn wrong_name(name: &str, most: usize) -> Option<Unwritable> {
    (!is_name(name, most)).then(|| Unwritable {
        instruction: 0,
        why: format!(
            "`{name}` is no name of a program: write letters, digits and `_`, a letter first, at most {most} characters"
        ),
    })
}
