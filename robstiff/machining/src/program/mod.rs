//! Robot programs: what a controller runs, written and read.
//!
//! A [`Program`] is a list of [`Instruction`]s. [`write()`] makes the text files of a
//! controller of it, [`read`] makes a [`Document`] of such files: the program, the
//! texts, and where each number of a position stands in them. So a program that
//! exists is changed in place: [`Document::with_positions`] replaces numbers and
//! leaves every other byte as it was.
//!
//! Positions are what the controller is given: poses in its work frame, which its
//! nominal model solves, or angles as its pendant shows them. The `controller` of a
//! description leads from there to joint coordinates.
//!
//! Sources of the formats: KUKA System Software 8.3, Operating and Programming
//! Instructions for System Integrators (KRL syntax, status and turn); ABB Technical
//! reference manual, RAPID Instructions, Functions and Data types, 3HAC16581
//! (robtarget, confdata, speeddata, zonedata); FANUC R-30iB operator's manual
//! B-83284EN (motion instructions, CONFIG) and ASCII program files as controllers
//! print them; Universal Robots, The URScript Programming Language for e-Series
//! (movej, movel, movep, set_tcp, pose_trans).

pub mod angles;
mod document;
pub mod krl;
pub mod ls;
mod order;
pub mod rapid;
mod source;
#[cfg(test)]
mod tests;
pub mod ur;
mod writing;

use nalgebra::Isometry3;
use robstiff_robots::Diagnostics;

pub use document::{Document, Shared};
pub use writing::Unwritable;

/// A robot program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// Its name, as the controller calls it.
    pub name: String,
    /// What it does, in order.
    pub instructions: Vec<Instruction>,
}

/// One instruction of a program.
#[derive(Clone, Debug, PartialEq)]
pub enum Instruction {
    /// From here on the TCP's frame is this one in the flange.
    Tool(Frame),
    /// From here on poses are given in this frame.
    Work(Frame),
    /// A motion.
    Move(Move),
    /// A motion that is kept as it is: no joint or linear one, or its position is
    /// known at run time alone.
    KeptMove {
        /// Which of the files that were read, from 0.
        file: usize,
        /// The line of the file, from 1.
        line: usize,
        /// The text.
        text: String,
        /// Why it is kept.
        why: String,
    },
    /// Anything else, as the file has it: outputs, the spindle, conditions, comments.
    Statement {
        /// The line of the file, from 1; 0 for one that was not read.
        line: usize,
        /// The text, as a line of the language has it; FANUC's without number and `;`.
        text: String,
    },
}

impl Instruction {
    /// A statement in the language of the controller.
    pub fn statement(text: impl Into<String>) -> Self {
        Self::Statement { line: 0, text: text.into() }
    }
}

/// A frame that the controller knows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Its name or number; empty where it has none.
    pub name: String,
    /// Where it stands (m): a tool in the flange, a work frame in the controller's
    /// world. `None` where the controller alone knows.
    pub pose: Option<Isometry3<f64>>,
}

/// How the tool gets to a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// All joints move in proportion.
    Joint,
    /// The TCP moves along a line.
    Linear,
}

/// A motion to a position.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// Which of the files that were read, from 0.
    pub file: usize,
    /// The line of the file, from 1; 0 for one that was not read.
    pub line: usize,
    /// How the tool gets there.
    pub motion: Motion,
    /// Where to.
    pub position: Position,
    /// The name of the point; `None` for one that has none.
    pub point: Option<String>,
    /// How fast; `None` where the program does not say it.
    pub speed: Option<Speed>,
    /// How near the tool passes.
    pub zone: Zone,
    /// What else the motion's line says, in the language of the controller.
    pub options: String,
}

impl Move {
    /// A motion that stops at a position without a name.
    pub fn to(motion: Motion, position: Position) -> Self {
        Self { file: 0, line: 0, motion, position, point: None, speed: None, zone: Zone::Fine, options: String::new() }
    }
}

/// A position as the controller is given it.
#[derive(Clone, Debug, PartialEq)]
pub struct Position {
    /// Where the arm is to be.
    pub target: Target,
    /// Coordinates of further axes, in the unit that the file gives them in (mm or
    /// degrees); `None` for an axis that is not there.
    pub external: Vec<Option<f64>>,
}

/// Where the arm is to be.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Angles as the pendant shows them (rad), one a joint.
    Joints(Vec<f64>),
    /// The TCP's frame in the work frame (m), and which of the postures that reach it.
    Pose(Isometry3<f64>, Option<Configuration>),
}

impl From<Target> for Position {
    fn from(target: Target) -> Self {
        Self { target, external: Vec::new() }
    }
}

/// Which posture reaches a pose, as each maker says it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Configuration {
    /// KUKA status and turn, as bits.
    Kuka {
        /// Bit 0: overhead; bit 1: elbow; bit 2: sign of axis 5.
        status: Option<u32>,
        /// Bit i - 1 is set where axis i is negative.
        turn: Option<u32>,
    },
    /// ABB: the quarter turns of axes 1, 4 and 6, and cfx.
    Abb([i32; 4]),
    /// FANUC: the letters and the turns of axes 1, 4 and 6.
    Fanuc {
        /// Wrist flipped (F), else N.
        flip: bool,
        /// Arm to the left (L) or right (R), where the arm has this letter.
        left: Option<bool>,
        /// Elbow up (U), else D.
        up: bool,
        /// Arm to the front (T), else to the back (B).
        front: bool,
        /// Full turns.
        turns: [i32; 3],
    },
}

/// A speed.
#[derive(Clone, Debug, PartialEq)]
pub enum Speed {
    /// Of the TCP (m/s).
    Tool(f64),
    /// Of the joint that moves most (rad/s).
    Joints(f64),
    /// As a share of the fastest, from 0 to 1.
    Share(f64),
    /// A name that the program does not declare, or a form that is kept as it is.
    Named(String),
}

/// How near the tool passes a position.
#[derive(Clone, Debug, PartialEq)]
pub enum Zone {
    /// It stops there.
    Fine,
    /// It leaves the path at this distance (m).
    Within(f64),
    /// A share from 0 to 1, which means something else for each controller.
    Share(f64),
    /// A name that the program does not declare.
    Named(String),
}

/// The languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// KUKA Robot Language: `.src` and `.dat`.
    Krl,
    /// ABB RAPID: `.mod`.
    Rapid,
    /// FANUC TP programs as text: `.ls`.
    Ls,
    /// Universal Robots' URScript: `.script`.
    Ur,
}

impl Language {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Krl, Self::Rapid, Self::Ls, Self::Ur];

    /// The language of a file by the end of its name.
    pub fn of_file(name: &str) -> Option<Self> {
        let (_, end) = name.rsplit_once('.')?;
        match end.to_ascii_lowercase().as_str() {
            "src" | "dat" | "sub" => Some(Self::Krl),
            "mod" | "modx" | "prg" => Some(Self::Rapid),
            "ls" => Some(Self::Ls),
            "script" | "urscript" => Some(Self::Ur),
            _ => None,
        }
    }

    /// The word for it in options.
    pub fn word(self) -> &'static str {
        match self {
            Self::Krl => "krl",
            Self::Rapid => "rapid",
            Self::Ls => "ls",
            Self::Ur => "ur",
        }
    }
}

/// A text file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextFile {
    /// Its name.
    pub name: String,
    /// What it says.
    pub text: String,
}

/// Reads the files of a program.
///
/// The first is the program; those behind it, as the `.dat` of a `.src`, are looked
/// up for points and for routines that it calls.
///
/// # Errors
/// All that is wrong with the files, each problem at its place. What is no motion is
/// no problem: it is kept as it is.
pub fn read(language: Language, files: Vec<TextFile>) -> Result<Document, Diagnostics> {
    match language {
        Language::Krl => krl::read(files),
        Language::Rapid => rapid::read(files),
        Language::Ls => ls::read(files),
        Language::Ur => ur::read(files),
    }
}

/// Writes the files of a program, with what the language sets by default.
///
/// # Errors
/// The instructions that the language cannot express.
pub fn write(language: Language, program: &Program) -> Result<Vec<TextFile>, Vec<Unwritable>> {
    match language {
        Language::Krl => krl::write(program, &krl::Options::default()),
        Language::Rapid => rapid::write(program),
        Language::Ls => ls::write(program),
        Language::Ur => ur::write(program),
    }
}
