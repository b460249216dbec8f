//! Reading how the controller sees the robot.

use super::{CONTROLLER, PENDANT, every, optional};
use crate::angle::snapped;
use crate::controller::{Controller, Pendant};
use crate::description::Joint;
use crate::document::Node;
use crate::effect::JointKind;
use crate::placement::Placement;
use crate::quantity::Dimension;
use crate::words::count;

/// Reads it; of joints that could not be read nothing is asked.
pub(super) fn controller(node: &Node<'_>, robot: Option<&[Joint]>) -> Option<Controller> {
    let map = node.map(&CONTROLLER)?;
    let joints = match (map.get("joints"), robot) {
        (Some(node), _) => joints(&node, robot),
        (None, Some(robot)) => Some(vec![Pendant::default(); robot.len()]),
        (None, None) => None,
    };
    let world = optional(&map, "world", Placement::read);
    let flange = optional(&map, "flange", Placement::read);
    let nominal = map.get("nominal").map_or(Some(None), |node| nominal(&node).map(Some));
    Some(Controller { joints: joints?, world: world?, flange: flange?, nominal: nominal? })
}

fn nominal(node: &Node<'_>) -> Option<String> {
    let path = node.text()?;
    if path.is_empty() {
        node.error("the path of a description is expected here", "e.g. `nominal: maker.yaml`, from this file");
        return None;
    }
    Some(path.to_owned())
}

fn joints(node: &Node<'_>, robot: Option<&[Joint]>) -> Option<Vec<Pendant>> {
    let items = node.sequence()?;
    let wrong = robot.filter(|robot| robot.len() != items.len());
    if let Some(robot) = wrong {
        node.error(
            format!("the robot has {}; the controller gives {}", count(robot.len(), "joint"), items.len()),
            "give one a joint, `{}` where the pendant shows the coordinate itself",
        );
        return None;
    }
    let mut index = 0;
    every(&items, |node| {
        index += 1;
        pendant(node, index, robot)
    })
}

/// The joint with this number (from 1).
fn pendant(node: &Node<'_>, joint: usize, robot: Option<&[Joint]>) -> Option<Pendant> {
    let map = node.map(&PENDANT)?;
    let sign = map.get("sign").map_or(Some(1.0), |node| {
        let sign = node.quantity(Dimension::Number)?;
        if sign.abs() != 1.0 {
            node.error("a sign is 1 or -1", "write `sign: -1` where the two count in opposite directions");
            return None;
        }
        Some(sign)
    });
    // Without the robot, the dimensions are unknown.
    let kind = robot.map(|robot| robot[joint - 1].kind);
    let offset = map.get("offset").map_or(Some(0.0), |node| match kind? {
        JointKind::Revolute => node.quantity(Dimension::Angle).map(snapped),
        JointKind::Prismatic => node.quantity(Dimension::Length),
    });
    let add = optional(&map, "add", |node| add(node, joint, robot));
    Some(Pendant { reversed: sign? < 0.0, offset: offset?, add: add? })
}

fn add(node: &Node<'_>, joint: usize, robot: Option<&[Joint]>) -> Option<Vec<(usize, f64)>> {
    let help = "name the pendant's coordinate of a joint before it and its factor, e.g. `add: {t2: 1}`";
    let map = node.any_map(help)?;
    let parts: Vec<Option<(usize, f64)>> = map
        .fields()
        .map(|(name, node)| {
            let other = name.strip_prefix('t').and_then(|digits| digits.parse::<usize>().ok());
            let Some(other) = other.filter(|other| (1..joint).contains(other) && name == format!("t{other}")) else {
                node.error(format!("`{name}` is no coordinate of a joint before joint {joint}"), help);
                return None;
            };
            let factor = node.quantity(Dimension::Number)?;
            if factor == 0.0 {
                node.error("a factor of 0 adds nothing", "leave it out");
                return None;
            }
            if robot.is_some_and(|robot| robot[other - 1].kind != robot[joint - 1].kind) {
                node.error("a joint that turns adds nothing to one that slides, and vice versa", "leave it out");
                return None;
            }
            Some((other, factor))
        })
        .collect();
    if parts.is_empty() {
        node.error("nothing is added", help);
        return None;
    }
    parts.into_iter().collect()
}
