//! Words that no reader of a URDF file knows: what is misspelt is left out like what a
//! reader has no use for, and the robot is another one.

use std::collections::HashSet;

use roxmltree::Node;

use super::read::Reader;
use crate::suggest::{closest, list};

/// The elements that are read whole, and the attributes that they may have.
const ATTRIBUTES: [(&str, &[&str]); 6] = [
    ("origin", &["xyz", "rpy"]),
    ("axis", &["xyz"]),
    ("limit", &["lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"]),
    ("mass", &["value"]),
    ("parent", &["link"]),
    ("child", &["link"]),
];

/// The elements inside others. Programs have elements of their own there, which pass.
const ELEMENTS: [(&str, &[&str]); 4] = [
    ("robot", &["link", "joint", "transmission", "material", "gazebo"]),
    ("link", &["inertial", "visual", "collision"]),
    ("inertial", &["origin", "mass", "inertia"]),
    ("joint", &["origin", "parent", "child", "axis", "limit", "mimic", "calibration", "dynamics", "safety_controller"]),
];

/// What is there once in the element it is in.
const ONCE: [&str; 7] = ["origin", "axis", "limit", "mass", "parent", "child", "inertial"];

impl Reader<'_> {
    /// The words of an element and of those in it that are read.
    pub(super) fn spelling(&mut self, node: Node<'_, '_>) {
        let tag = node.tag_name().name();
        let Some((_, known)) = ELEMENTS.iter().find(|(name, _)| *name == tag) else { return };
        let mut seen = HashSet::new();
        for child in node.children().filter(|child| child.is_element()) {
            let name = child.tag_name();
            // With a prefix it is an extension.
            if name.namespace() != node.tag_name().namespace() {
                continue;
            }
            let name = name.name();
            if !known.contains(&name) {
                self.perhaps_misspelt(child, tag, known);
            } else if ONCE.contains(&name) && !seen.insert(name) {
                let message = format!("`{tag}` has a second `{name}`");
                self.report(&child.range(), &message, "leave one of the two");
            }
            self.attributes(child);
        }
    }

    fn perhaps_misspelt(&mut self, child: Node<'_, '_>, tag: &str, known: &[&str]) {
        let name = child.tag_name().name();
        if let Some(near) = closest(name, known.iter().copied()) {
            let message = format!("`{tag}` has an unknown element `{name}`");
            self.report(&child.range(), &message, &format!("did you mean `{near}`?"));
        }
    }

    /// That an element which is read has none but its own attributes.
    fn attributes(&mut self, node: Node<'_, '_>) {
        let tag = node.tag_name().name();
        let Some((_, known)) = ATTRIBUTES.iter().find(|(name, _)| *name == tag) else { return };
        for attribute in node.attributes() {
            let name = attribute.name();
            if attribute.namespace().is_some() || known.contains(&name) {
                continue;
            }
            let help = match closest(name, known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("it may have {}", list(known.iter().copied())),
            };
            self.report(&attribute.range_qname(), &format!("`{tag}` has an unknown attribute `{name}`"), &help);
        }
    }
}
