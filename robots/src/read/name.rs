//! Names of robots, which become names of types.

use crate::description::{Description, TAKEN};
use crate::document::Node;

impl Description {
    /// A free name for a robot's type that is like `text`, e.g. a file's name.
    pub fn name_like(text: &str) -> String {
        let words = text.split(|character: char| !character.is_ascii_alphanumeric());
        let camel: String = words
            .filter_map(|word| Some((word.chars().next()?.to_ascii_uppercase(), &word[1..])))
            .map(|(first, rest)| format!("{first}{rest}"))
            .collect();
        match camel.as_str() {
            free if is_type_name(free) => camel,
            "" | "Robot" => "MyRobot".to_owned(),
            _ => format!("Robot{camel}"),
        }
    }
}

pub(super) fn name(node: &Node) -> Option<String> {
    let name = node.text()?;
    if !is_type_name(name) {
        let why = if TAKEN.contains(&name) {
            "it becomes a Rust type, and the generated code uses this name itself: write another one"
        } else if !name.is_ascii() {
            "it becomes a Rust type, of ASCII letters and digits only: write it in upper camel case without others"
        } else {
            "it becomes a Rust type, so write it in upper camel case"
        };
        let help = format!("{why}, e.g. `{}`", Description::name_like(name));
        node.error(format!("`{name}` cannot name a robot"), help);
        return None;
    }
    Some(name.to_owned())
}

/// Whether a text is an upper camel case identifier that is free.
pub(super) fn is_type_name(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_uppercase())
        && name.chars().all(|character| character.is_ascii_alphanumeric())
        && !TAKEN.contains(&name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggests_names_that_are_names() {
        for (name, suggested) in [
            ("rv130-hsc", "Rv130Hsc"),
            ("6axis arm", "Robot6axisArm"),
            ("Self", "RobotSelf"),
            ("Robot", "MyRobot"),
            ("ü", "MyRobot"),
        ] {
            assert!(!is_type_name(name));
            assert_eq!(Description::name_like(name), suggested);
            assert!(is_type_name(suggested));
        }
    }
}
