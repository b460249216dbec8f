//! A robot's name and number of joints from a file that may be broken.

use crate::description::MOST_JOINTS;
use crate::document::{Content, too_deep, without_byte_order_mark};
use serde::de::{Deserializer, MapAccess, Visitor};
use std::fmt;

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
    if too_deep(text).is_some() {
        return outline;
    }
    // Where the syntax breaks, what came before it still counts.
    let _broken = serde_yaml::Deserializer::from_str(without_byte_order_mark(text)).deserialize_map(Top(&mut outline));
    outline
}

struct Top<'o>(&'o mut Outline);

impl<'de> Visitor<'de> for Top<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<(), A::Error> {
        while let Some((key, value)) = entries.next_entry::<Content, Content>()? {
            match (key, value) {
                (Content::Text(key), Content::Text(name)) if key == "name" => {
                    self.0.name = Some(name).filter(|name| super::is_type_name(name));
                }
                (Content::Text(key), Content::Sequence(joints)) if key == "joints" => {
                    self.0.joints = Some(joints.len()).filter(|count| (1..=MOST_JOINTS).contains(count));
                }
                _ => {}
            }
        }
        Ok(())
    }
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
