//! Reading a description: every rule of the schema, every problem of a file at
//! once.

mod controller;
mod couplings;
mod effects;
mod name;
mod outline;

pub use outline::Outline;

use crate::angle::snapped;
use crate::description::{Description, Joint, Link, MOST_JOINTS, Part};
use crate::diagnostic::Diagnostics;
use crate::document::{Document, Map, Node};
use crate::effect::{Convention, Effect, JointKind};
use crate::placement::Placement;
use crate::quantity::Dimension;
use crate::read_error::ReadError;
use crate::text;
use crate::words::count;
use name::name;
use std::path::Path;

impl Description {
    /// Reads a description from a file.
    ///
    /// # Errors
    /// A file that cannot be read, and everything [`parse`](Self::parse) finds.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        Self::parse(&path.display().to_string(), &text::read(path, text::MOST_OF_DOCUMENT)?).map_err(ReadError::Invalid)
    }

    /// Reads a description; `file` is the name that problems show.
    ///
    /// # Errors
    /// All that is wrong with the text, each problem with its place.
    pub fn parse(file: &str, text: &str) -> Result<Self, Diagnostics> {
        let document = Document::parse(file, text)?.wary();
        let description = description(&document.root());
        document.finish(description)
    }

    /// Reads a list of effects in another document, written as descriptions
    /// write it, against the joints of this robot; what is wrong is reported
    /// there.
    pub fn read_effects(&self, node: &Node<'_>) -> Option<Vec<Effect>> {
        // These come on top of the robot's own.
        let joints = self.corrected_joints();
        let (joints, links) = (Some(&joints[..]), Some(&self.links[..]));
        let arm = effects::Arm { convention: Some(self.convention), joints, links, count: Some(self.joints.len()) };
        effects::effects(node, &arm)
    }

    /// What can be told of a robot from a text that may be broken anywhere.
    pub fn outline(text: &str) -> Outline {
        outline::outline(text)
    }
}

/// The fields of a description.
pub(crate) const ROBOT: [&str; 10] =
    ["name", "description", "source", "convention", "base", "joints", "tool", "links", "effects", "controller"];

/// Those of a joint.
pub(crate) const JOINT: [&str; 7] = ["type", "theta", "d", "a", "alpha", "limits", "compliance"];

/// Those of a link.
pub(crate) const LINK: [&str; 2] = ["mass", "center_of_mass"];

/// Those of a controller.
pub(crate) const CONTROLLER: [&str; 4] = ["joints", "world", "flange", "nominal"];

/// Those of a joint as its pendant shows it.
pub(crate) const PENDANT: [&str; 3] = ["sign", "offset", "add"];

/// Those of a placement.
pub(crate) const PLACEMENT: [&str; 2] = ["xyz", "rpy"];

/// `None` with the problem reported where the file is a campaign.
fn refuse_campaign(root: &Node) -> Option<()> {
    let Some(map) = root.is_map().then(|| root.any_map("")).flatten() else { return Some(()) };
    let there = |field: &str| map.get(field).is_some();
    if there("observations") && !there("joints") {
        let robot = map.get("robot").and_then(|node| node.as_text().map(str::to_owned));
        let robot = robot.map(|robot| format!(", here `{robot}`")).unwrap_or_default();
        let help = format!("give the robot's description, which the campaign names under `robot:`{robot}");
        root.error("this is a campaign, and no robot's description", help);
        return None;
    }
    Some(())
}

fn description(root: &Node) -> Option<Description> {
    refuse_campaign(root)?;
    let map = root.map(&ROBOT)?;
    // Everything is read before anything is given up, to report all problems.
    let name = map.require("name", "name: Rv130hsc").and_then(|node| name(&node));
    let text = |field| map.get(field).map_or(Some(String::new()), |node| node.text().map(str::to_owned));
    let (summary, source) = (text("description"), text("source"));
    let convention = map
        .require("convention", "convention: standard")
        .and_then(|node| node.choice(&[Convention::Standard, Convention::Modified].map(|one| (one.word(), one))));
    let base = optional(&map, "base", Placement::read);
    let joints = map.require("joints", "joints: [{theta: 0 deg, d: 865 mm, alpha: -90 deg}, ..]");
    let count = joints.as_ref().filter(|node| node.is_sequence()).and_then(|node| Some(node.sequence()?.len()));
    let joints = joints.and_then(|node| self::joints(&node));
    let tool = optional(&map, "tool", Placement::read);
    let links = optional(&map, "links", |node| links(node, count));
    let arm = effects::Arm { convention, joints: joints.as_deref(), links: links.as_deref(), count };
    let effects = optional(&map, "effects", |node| effects::effects(node, &arm));
    let controller =
        map.get("controller").map_or(Some(None), |node| controller::controller(&node, joints.as_deref()).map(Some));
    Some(Description {
        name: name?,
        description: summary?,
        source: source?,
        convention: convention?,
        base: base?,
        joints: joints?,
        tool: tool?,
        links: links?,
        effects: effects?,
        controller: controller?,
    })
}

/// A field that may be left out and then has its type's zero.
fn optional<T: Default>(map: &Map, field: &str, read: impl FnOnce(&Node) -> Option<T>) -> Option<T> {
    map.get(field).map_or(Some(T::default()), |node| read(&node))
}

/// Every item of a list, read; `None` if any failed.
fn every<T>(items: &[Node], read: impl FnMut(&Node) -> Option<T>) -> Option<Vec<T>> {
    let read: Vec<Option<T>> = items.iter().map(read).collect();
    read.into_iter().collect()
}

impl Placement {
    /// Reads `{xyz: [..], rpy: [..]}`, each of them zero where it is left out; `None`
    /// with the mistakes reported to the document.
    pub fn read(node: &Node) -> Option<Self> {
        let map = node.map(&PLACEMENT)?;
        let xyz = optional(&map, "xyz", |node| node.quantities(Dimension::Length));
        let rpy = optional(&map, "rpy", |node| node.quantities(Dimension::Angle));
        Some(Self { xyz: xyz?, rpy: rpy?.map(snapped) })
    }
}

fn joints(node: &Node) -> Option<Vec<Joint>> {
    let items = node.sequence()?;
    let is_robot = (1..=MOST_JOINTS).contains(&items.len());
    if !is_robot {
        node.error(
            format!("a robot has 1 to {MOST_JOINTS} joints, not {}", items.len()),
            "give one DH row a joint, from the base to the flange",
        );
    }
    every(&items, joint).filter(|_| is_robot)
}

fn joint(node: &Node) -> Option<Joint> {
    let map = node.map(&JOINT)?;
    let kind = map.get("type").map_or(Some(JointKind::Revolute), |node| {
        node.choice(&[("revolute", JointKind::Revolute), ("prismatic", JointKind::Prismatic)])
    });
    let angle = |field| optional(&map, field, |node| node.quantity(Dimension::Angle).map(snapped));
    let length = |field| optional(&map, field, |node| node.quantity(Dimension::Length));
    let (theta, d, a, alpha) = (angle("theta"), length("d"), length("a"), angle("alpha"));
    // Without the kind, the dimensions of the rest are unknown.
    let kind = kind?;
    let limits = map.get("limits").map_or(Some(None), |node| limits(&node, kind).map(Some));
    let compliance = optional(&map, "compliance", |node| compliance(node, kind));
    Some(Joint { kind, theta: theta?, d: d?, a: a?, alpha: alpha?, limits: limits?, compliance: compliance? })
}

fn limits(node: &Node, kind: JointKind) -> Option<[f64; 2]> {
    let limits = match kind {
        JointKind::Revolute => node.quantities(Dimension::Angle)?.map(snapped),
        JointKind::Prismatic => node.quantities(Dimension::Length)?,
    };
    if limits[0] >= limits[1] {
        node.error("the lower limit is not below the upper one", "write `[lower, upper]`");
        return None;
    }
    Some(limits)
}

fn compliance(node: &Node, kind: JointKind) -> Option<Vec<Part>> {
    let dimension = kind.compliance();
    if !node.is_map() {
        return Some(vec![Part { name: String::new(), value: node.nonnegative(dimension)? }]);
    }
    let help = "name the parts, which add up, e.g. `{gear: 1.9e-7 rad/Nm, belt: 1.22e-7 rad/Nm}`";
    let map = node.any_map(help)?;
    let parts: Vec<Option<Part>> = map
        .fields()
        .map(|(name, node)| {
            if name.is_empty() {
                node.error("a part of a compliance needs a name", help);
                return None;
            }
            Some(Part { name: name.to_owned(), value: node.nonnegative(dimension)? })
        })
        .collect();
    if parts.is_empty() {
        node.error("a compliance has at least one part", "a rigid joint has no `compliance` at all");
        return None;
    }
    parts.into_iter().collect()
}

fn links(node: &Node, joints: Option<usize>) -> Option<Vec<Link>> {
    let items = node.sequence()?;
    let wrong = joints.filter(|joints| *joints != items.len());
    if let Some(joints) = wrong {
        node.error(
            format!("a robot of {} has one body for each joint; `links` gives {}", count(joints, "joint"), items.len()),
            "give the body that moves with each joint, `{}` where nothing is known, or leave `links` out",
        );
    }
    let links = every(&items, |node| {
        let map = node.map(&LINK)?;
        let mass = optional(&map, "mass", |node| node.nonnegative(Dimension::Mass));
        let center_of_mass = optional(&map, "center_of_mass", |node| node.quantities(Dimension::Length));
        Some(Link { mass: mass?, center_of_mass: center_of_mass? })
    });
    links.filter(|_| wrong.is_none())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn with_its_unit_a_number_may_be_any() {
        let text = "name: Arm\nconvention: standard\njoints:\n  - {theta: 90 rad, limits: [-4*pi, 6*pi], compliance: 3 rad/Nm}\n  \
                    - {type: prismatic, a: 50, limits: [0, 80 m], alpha: 12.5, compliance: 1}\n";
        Description::parse("arm.yaml", text).unwrap_or_else(|problems| panic!("{problems}"));
    }

    /// What comes on top of a robot is held against its links as they are.
    #[test]
    fn effects_on_top_see_the_corrected_table() {
        let text = "name: Arm\nconvention: standard\njoints: [{compliance: 1e-7 rad/Nm}, {a: 1 m}]\n\
                    effects: [{kind: dh_error, at: a1, value: 1 mm}]\n";
        let arm = Description::parse("arm.yaml", text).unwrap_or_else(|problems| panic!("{problems}"));
        let document = Document::parse("more.yaml", "[{kind: link_compliance, at: link 1, bending: 1e-7 rad/Nm}]\n");
        let document = document.unwrap_or_else(|problems| panic!("{problems}"));
        let effects = arm.read_effects(&document.root());
        assert_eq!(document.finish(effects).unwrap_or_else(|problems| panic!("{problems}")).len(), 1);
    }

    /// What is in proportion to a compliance may wait for it to be identified; and a joint may
    /// be identified as rigid.
    #[test]
    fn shares_of_no_compliance_are_read() {
        let text = "name: Arm\nconvention: standard\njoints: [{a: 1 m}]\nlinks: [{mass: 9 kg}]\neffects:\n  \
                    - {kind: pose_dependent_compliance, at: joint 1, cos1: 0.2}\n  \
                    - {kind: gravity_sag, at: robot, share: 1}\n";
        let arm = Description::parse("arm.yaml", text).unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(arm.effects.len(), 2);
    }

    /// The sum of no numbers is a negative zero, which is written as one.
    #[test]
    fn a_rigid_joint_has_no_sign() {
        let text = "name: Arm\nconvention: standard\njoints: [{a: 1 m}]\n";
        let arm = Description::parse("arm.yaml", text).unwrap_or_else(|problems| panic!("{problems}"));
        assert!(arm.joints[0].compliance().is_sign_positive());
    }
}
