//! A robot's name and number of joints from a file that may be broken.

use super::name::is_type_name;
use crate::description::MOST_JOINTS;
use crate::document::{Value, fields_before_the_break};

/// What can be told of a robot whose description cannot be read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outline {
    /// The name, if there is one that can name a Rust type.
    pub name: Option<String>,
    /// How many joints there are, if that can be told and a robot may have so
    /// many.
    pub joints: Option<usize>,
}

pub(super) fn outline(text: &str) -> Outline {
    let mut outline = Outline::default();
    // Where the syntax breaks, what came before it still counts.
    for (key, content) in fields_before_the_break(text) {
        match (key.text(), &content.value) {
            (Some("name"), Value::Text(name)) => {
                outline.name = Some(name.to_string()).filter(|name| is_type_name(name));
            }
            (Some("joints"), Value::Sequence(joints)) => {
                outline.joints = Some(joints.len()).filter(|count| (1..=MOST_JOINTS).contains(count));
            }
            _ => {}
        }
    }
    outline
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tells_what_stands_before_the_break() {
        let known = Outline { name: Some("Arm".into()), joints: Some(2) };
        assert_eq!(outline("name: Arm\njoints: [{alhpa: 3}, {}]\n"), known);
        assert_eq!(outline("name: Arm\njoints: [{}, {}]\ntool: {xyz: [\n"), known);
        assert_eq!(outline("name: Arm\njoints: [{}, {\n"), Outline { joints: None, ..known });
        for text in ["", "- 1", "name: an arm\njoints: []", "{", "name: 3"] {
            assert_eq!(outline(text), Outline::default());
        }
    }
}
