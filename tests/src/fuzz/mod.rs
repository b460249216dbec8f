//! Targets of fuzzing: what reads files that others wrote, and what may be asked of it whatever
//! is in them.
//!
//! A target is a plain function of bytes that panics where something is wrong. The test `fuzz`
//! calls it with texts of the target's [grammar], and with those that are kept in
//! `tests/fuzz/corpus`, [mutated]. `tests/fuzz` calls the same functions from libFuzzer, which
//! looks for inputs that reach code nothing has reached before.
//!
//! Every target asks this: nothing panics. What is refused is refused with the file, a line and a
//! column that it has, and a message. The same bytes give the same answer twice. What is
//! written of an accepted text is read back as the same.

mod accepted;
mod campaigns;
mod cuts;
mod descriptions;
pub mod grammar;
mod maps;
pub mod mutated;
mod paths;
mod refused;
mod sections;
mod tables;
mod urdf;

use grammar::Grammar;

/// What is fuzzed.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name, that of its folder in the corpus, too.
    pub name: &'static str,
    /// What is to hold for any bytes.
    ///
    /// # Errors
    /// What is said where they are refused.
    ///
    /// # Panics
    /// Where it does not hold.
    pub check: fn(&[u8]) -> Result<(), String>,
    /// Texts that it may accept.
    pub grammar: &'static Grammar,
}

/// All of them.
pub const TARGETS: [Target; 7] = [
    Target { name: "descriptions", check: descriptions::check, grammar: descriptions::GRAMMAR },
    Target { name: "campaigns", check: campaigns::check, grammar: campaigns::GRAMMAR },
    Target { name: "tables", check: tables::check, grammar: tables::GRAMMAR },
    Target { name: "paths", check: paths::check, grammar: paths::GRAMMAR },
    Target { name: "urdf", check: urdf::check, grammar: urdf::GRAMMAR },
    Target { name: "cuts", check: cuts::check, grammar: cuts::GRAMMAR },
    Target { name: "maps", check: maps::check, grammar: maps::GRAMMAR },
];

/// A target by its name.
///
/// # Panics
/// Where there is none.
pub fn target(name: &str) -> Target {
    TARGETS.into_iter().find(|target| target.name == name).unwrap_or_else(|| panic!("no target is named {name}"))
}
