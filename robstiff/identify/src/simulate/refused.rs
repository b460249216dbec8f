//! What of a scenario cannot be simulated, and where the scenario says it.

use core::fmt;
use std::format;
use std::string::{String, ToString};

use robstiff_robots::Diagnostics;
use robstiff_robots::document::{Document, Map, Node};

/// The part of a scenario that something is wrong with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The working region of its poses.
    Region,
    /// A hidden effect, from 0.
    Hidden(usize),
    /// By how much joints are off.
    Scatter,
    /// What acts.
    Loads,
}

/// A scenario that was read, and cannot be simulated.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused {
    /// The part.
    pub part: Part,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
}

impl Refused {
    /// The problem at its place in the scenario's text; `file` is the name that is shown.
    pub fn located(&self, file: &str, text: &str) -> Diagnostics {
        let document = match Document::parse(file, text) {
            Ok(document) => document,
            Err(problems) => return problems,
        };
        let Self { part, message, help } = self;
        let root = document.root();
        let place = root.any_map("").and_then(|map| part.place(&map));
        place.unwrap_or(root).error(message.as_str(), help.as_str());
        match document.finish::<()>(None) {
            Err(problems) => problems,
            Ok(()) => unreachable!("a problem was reported"),
        }
    }
}

impl Part {
    fn place<'d>(self, map: &Map<'d>) -> Option<Node<'d>> {
        match self {
            Self::Region => {
                let poses = map.get("poses")?;
                let region = |name: &str| poses.any_map("")?.get(name);
                region("floor").or_else(|| region("column")).or(Some(poses))
            }
            Self::Hidden(index) => map.get("hidden")?.any_map("")?.get("effects")?.sequence()?.into_iter().nth(index),
            Self::Scatter => map.get("scatter"),
            Self::Loads => ["force", "moment", "payloads"].into_iter().find_map(|name| map.get(name)),
        }
    }
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.message, self.help)
    }
}

impl core::error::Error for Refused {}

/// A truth that is no robot: the first of its problems, told of what the scenario says.
/// `declared` effects come before those that are hidden.
pub fn no_robot(problems: &Diagnostics, declared: usize) -> Refused {
    let first = problems.iter().next();
    let (path, message) =
        first.map_or((String::new(), String::new()), |problem| (problem.path.clone(), problem.message.clone()));
    let effect = path.strip_prefix("effects[").and_then(|rest| rest.split(']').next()?.parse::<usize>().ok());
    let part = effect.and_then(|effect| effect.checked_sub(declared)).map_or(Part::Scatter, Part::Hidden);
    Refused {
        part,
        message: format!("no robot can be like this, once its joints are scattered: {message}"),
        help: "make it less, or `scatter` less".to_string(),
    }
}
