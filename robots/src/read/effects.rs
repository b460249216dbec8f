//! The effects of a description, and what physics asks of them.

use std::collections::HashMap;

use crate::bare::of_effect;
use crate::description::{Joint, Link, corrected, has_length, is_stroke};
use crate::document::{Map, Node};
use crate::effect::gravity_sag::GRAVITY;
use crate::effect::physics::{About, At, MOST_SAG, Parameter, Quantity, Range};
use crate::effect::{CATALOGUE, Convention, DhEntry, Effect, JointKind, Place};
use crate::suggest::{closest, list};
use crate::words;

use super::couplings::check_couplings;

/// What happens once, at some moment; a description holds what lasts.
const EVENTS: &[&str] = &["base_slip", "reflector_slip"];

/// Faults of the measurement (`@rig`), which are no part of a robot.
const OF_THE_RIG: &[&str] = &[
    "load_cell_misalignment",
    "load_cell_bias",
    "load_cell_scale",
    "lever_arm",
    "tracker_misalignment",
    "tracker_scale",
    "reflector_offset",
    "thermal_drift",
    "creep",
    "outliers",
];

/// What is known of the robot: not what has problems of its own.
pub(super) struct Arm<'a> {
    pub convention: Option<Convention>,
    pub joints: Option<&'a [Joint]>,
    pub links: Option<&'a [Link]>,
    /// How many joints there are, whatever their problems.
    pub count: Option<usize>,
}

/// Reads the effects, and checks them against what is known of the robot.
pub(super) fn effects(node: &Node, arm: &Arm<'_>) -> Option<Vec<Effect>> {
    let items = node.sequence()?;
    let read: Vec<Option<Effect>> = items.iter().map(|item| effect(item, arm)).collect();
    let mut firsts: HashMap<(&str, Place), usize> = HashMap::new();
    for (index, effect) in read.iter().enumerate() {
        let Some(effect) = effect else { continue };
        let first = *firsts.entry(effect.number()).or_insert(index);
        if first == index {
            continue;
        }
        let (message, help) = match read[first] {
            Some(other) if orders(&other) != orders(effect) => {
                (format!("`{effect}` has a second order, and a description takes one a joint"), "keep the larger")
            }
            Some(other) if other.kind() != effect.kind() => {
                (format!("`{effect}` is the same number as `{other}`"), "merge the two")
            }
            _ => (format!("the effect `{effect}` is given twice"), "merge the two"),
        };
        items[index].error(message, format!("the first is `{}`; {help}", items[first].path()));
    }
    if let Some(joints) = arm.joints {
        check_couplings(&items, &read, joints);
        // An effect that has problems of its own may correct any row.
        let all: Option<Vec<Effect>> = read.iter().copied().collect();
        let corrected = all.map(|all| corrected(joints, &all));
        if let (Some(convention), Some(joints)) = (arm.convention, &corrected) {
            check_links(&items, &read, convention, joints);
        }
        if let Some(links) = arm.links {
            check_weights(&items, &read, links);
            check_sag(&items, &read, corrected.as_deref(), links);
        }
    }
    read.into_iter().collect()
}

/// The order of an effect that has one: two of such effects at one joint are not the same
/// effect given twice, and cannot be merged.
fn orders(effect: &Effect) -> Option<f64> {
    match effect {
        Effect::TransmissionError { order, .. } => Some(*order),
        _ => None,
    }
}

fn effect(node: &Node, arm: &Arm<'_>) -> Option<Effect> {
    let joints = arm.joints;
    let map = node.any_map("write e.g. `{kind: transverse_compliance, at: joint 3, value: 6.35e-7 rad/Nm}`")?;
    let about = kind(&map.require("kind", "kind: transverse_compliance")?)?;
    let names = || about.parameters.iter().map(|parameter| parameter.name);
    node.map(&["kind", "at"].into_iter().chain(names()).collect::<Vec<_>>())?;
    let place = map.require("at", &format!("at: {}", about.at.example())).and_then(|at| place(&at, about, arm.count));
    let may_be_left_out = about.parameters.iter().all(|parameter| parameter.default.is_some());
    if may_be_left_out && names().all(|name| map.get(name).is_none()) {
        let help = "a parameter left out is 0";
        node.error(format!("`{}` needs at least one of {}", about.kind, list(names())), help);
        return None;
    }
    // Every number is read before anything is given up, to report all problems;
    // the unit of some depends on the place.
    let numbers: Vec<Option<f64>> = about.parameters.iter().map(|parameter| number(&map, parameter, place)).collect();
    let numbers: Option<Vec<f64>> = numbers.into_iter().collect();
    let place = place?;
    if matches!(about.at, At::TurningJoint | At::TurningJoints) {
        revolute(&map, joints, place)?;
    }
    let effect = Effect::of_kind(about.kind, place, &numbers?).expect("a place and numbers of this kind");
    let compliance = match place {
        Place::Joint(joint) => joints.and_then(|joints| joints.get(joint - 1))?.compliance(),
        _ => 0.0,
    };
    if let Some(complaint) = effect.check(compliance) {
        let given = map.get(complaint.parameter);
        let asks = complaint.otherwise.filter(|_| given.is_none()).and_then(|name| Some((name, map.get(name)?)));
        match asks {
            // What was left out has no number that could be wrong.
            Some((name, asks)) => {
                asks.error(format!("`{name}` needs `{}`, which is missing", complaint.parameter), complaint.help);
            }
            None => given.as_ref().unwrap_or(node).error(complaint.message, complaint.help),
        }
        return None;
    }
    Some(effect)
}

/// A parameter, or its default.
fn number(map: &Map, parameter: &Parameter, place: Option<Place>) -> Option<f64> {
    let node = match parameter.default {
        None => map.require(parameter.name, &format!("{}: {}", parameter.name, parameter.example))?,
        Some(default) => match map.get(parameter.name) {
            None => return Some(default),
            Some(node) => node,
        },
    };
    // Without a place its own problem is told; the unit of most is known.
    let dimension = match (parameter.quantity, place) {
        (Quantity::Of(dimension), _) => dimension,
        (Quantity::Entry, place) => parameter.quantity.at(place?),
    };
    let value = match parameter.range {
        Range::Any | Range::Whole(_) => node.quantity(dimension),
        Range::NotNegative => node.nonnegative(dimension),
        Range::Positive => node.positive(dimension),
    }?;
    if let Range::Whole(most) = parameter.range
        && !parameter.range.contains(value)
    {
        node.error(
            format!("`{}` is a whole number from 1 to {most}", parameter.name),
            format!("e.g. `{}: {}`", parameter.name, parameter.example),
        );
        return None;
    }
    let value = if node.is_suspect() { of_effect(value, dimension) } else { Ok(value) };
    value.map_err(|error| node.error(error.message, error.help)).ok()
}

fn kind(node: &Node) -> Option<&'static About> {
    let name = node.text()?;
    if let Some(about) = CATALOGUE.iter().find(|about| about.kind == name) {
        return Some(about);
    }
    let kinds = || CATALOGUE.iter().map(|about| about.kind);
    let kinds_are = format!("the kinds are {}", list(kinds()));
    if OF_THE_RIG.contains(&name) {
        node.error(
            format!("`{name}` is a fault of the measurement (`@rig`), which is no part of a robot"),
            "leave it out: faults of the rig are reported and corrected for, never described",
        );
    } else if EVENTS.contains(&name) {
        node.error(
            format!("`{name}` happens at one moment of a measurement, and a description holds what lasts"),
            kinds_are,
        );
    } else {
        let help = closest(name, kinds()).map_or(String::new(), |meant| format!("did you mean `{meant}`? "));
        node.error(format!("unknown kind of effect `{name}`"), help + &kinds_are);
    }
    None
}

/// The place of an effect of this kind, on the robot.
fn place(node: &Node, about: &About, count: Option<usize>) -> Option<Place> {
    let Some(text) = node.as_text() else {
        let help = match (meant(node).as_deref(), about.at) {
            (Some([joint]), At::Joint | At::TurningJoint) => format!("write `at: joint {joint}`"),
            (Some([i, j]), At::TurningJoints) => format!("write `at: \"joints {i},{j}\"`"),
            (Some([link]), At::Link) => format!("write `at: link {link}`"),
            _ => format!("write e.g. `at: {}`", about.at.example()),
        };
        node.expected("a place", help);
        return None;
    };
    let place = match parse_place(text) {
        Some(place) if about.at.takes(place) => place,
        _ => {
            let help = format!("write e.g. `at: {}`", about.at.example());
            node.error(format!("`{}` cannot sit at `{text}`", about.kind), help);
            return None;
        }
    };
    let (what, numbers, most) = match place {
        Place::Joint(joint) => ("joint", [joint, joint], count),
        Place::Joints(joints) => ("joint", joints, count),
        Place::Link(link) => ("link", [link, link], count.map(|count| count.saturating_sub(1))),
        Place::Entry(entry) => ("row", [entry.row(), entry.row()], count),
        Place::Base | Place::Tool | Place::Robot => return Some(place),
    };
    if let (Some(most), Some(count)) = (most, count)
        && let Some(wrong) = numbers.into_iter().find(|number| !(1..=most).contains(number))
    {
        let help = match (what, most) {
            ("link", 0) => "link i is the body between joints i and i + 1".to_owned(),
            ("link", _) => format!("links count from 1 to {most}; link i is the body between joints i and i + 1"),
            _ => format!("{what}s count from 1 to {most}"),
        };
        node.error(format!("there is no {what} {wrong} in a robot of {}", words::count(count, "joint")), help);
        return None;
    }
    if matches!(place, Place::Joints([i, j]) if i == j) {
        node.error("a coupling needs two different joints", "e.g. `at: \"joints 2,3\"`");
        return None;
    }
    Some(place)
}

/// The whole numbers that stand alone where a place is expected.
fn meant(node: &Node) -> Option<Vec<i64>> {
    if !node.is_sequence() {
        return Some(vec![node.as_integer()?]);
    }
    node.sequence()?.iter().map(Node::as_integer).collect()
}

fn parse_place(text: &str) -> Option<Place> {
    let (word, numbers) = text.trim().split_once(' ').unwrap_or((text.trim(), ""));
    let number = |text: &str| text.trim().parse::<usize>().ok();
    match word {
        "joint" => Some(Place::Joint(number(numbers)?)),
        "link" => Some(Place::Link(number(numbers)?)),
        "joints" => {
            let (i, j) = numbers.split_once(',')?;
            let (i, j) = (number(i)?, number(j)?);
            Some(Place::Joints([i.min(j), i.max(j)]))
        }
        "base" if numbers.is_empty() => Some(Place::Base),
        "tool" if numbers.is_empty() => Some(Place::Tool),
        "robot" if numbers.is_empty() => Some(Place::Robot),
        _ if numbers.is_empty() => Some(Place::Entry(parse_entry(word)?)),
        _ => None,
    }
}

/// `a2`, `alpha1`.
fn parse_entry(word: &str) -> Option<DhEntry> {
    let digits = word.find(|character: char| character.is_ascii_digit())?;
    let (column, row) = (&word[..digits], word[digits..].parse().ok()?);
    let entries = [DhEntry::A(row), DhEntry::Alpha(row), DhEntry::D(row), DhEntry::Theta(row)];
    entries.into_iter().find(|entry| entry.column() == column)
}

/// That the joints an effect sits at turn.
fn revolute(map: &Map, joints: Option<&[Joint]>, place: Place) -> Option<()> {
    let numbers = match place {
        Place::Joint(joint) => vec![joint],
        Place::Joints(pair) => pair.to_vec(),
        _ => Vec::new(),
    };
    let sliding = |number: &&usize| {
        joints.and_then(|joints| joints.get(**number - 1)).is_some_and(|joint| joint.kind == JointKind::Prismatic)
    };
    if let Some(number) = numbers.iter().find(sliding) {
        map.get("at")?.error(
            format!("joint {number} is prismatic, and this effect needs revolute joints"),
            "choose joints that turn, or leave the effect out",
        );
        return None;
    }
    Some(())
}

/// That links which yield are beams, of joints that have been corrected.
fn check_links(items: &[Node], effects: &[Option<Effect>], convention: Convention, joints: &[Joint]) {
    for (item, effect) in items.iter().zip(effects) {
        let Some(Place::Link(link)) = effect.map(|effect| effect.place()) else { continue };
        let message = if is_stroke(convention, joints, link) {
            format!("link {link} is nothing but a stroke: where that is 0, the link is no beam")
        } else if !has_length(convention, joints, link) {
            format!("link {link} has no length, and what is no beam neither bends nor twists")
        } else {
            continue;
        };
        let at = item.any_map("").and_then(|map| map.get("at"));
        at.as_ref()
            .unwrap_or(item)
            .error(message, "describe what yields there as `transverse_compliance` of a joint beside it");
    }
}

/// That the weights which a sag or a preload comes of are known.
fn check_weights(items: &[Node], effects: &[Option<Effect>], links: &[Link]) {
    if links.iter().any(|link| link.mass != 0.0) {
        return;
    }
    for (item, effect) in items.iter().zip(effects) {
        let message = match effect {
            Some(Effect::GravitySag { .. }) => "an arm without masses does not sag",
            Some(Effect::GravityPreload { .. }) => "an arm without masses does not preload its gears",
            _ => continue,
        };
        item.error(message, "give `links`, with the mass and centre of mass of the body that moves with each joint");
    }
}

/// That a sag is small; of joints that have been corrected, if they could be.
fn check_sag(items: &[Node], effects: &[Option<Effect>], joints: Option<&[Joint]>, links: &[Link]) {
    for (item, effect) in items.iter().zip(effects) {
        let Some(Effect::GravitySag { share }) = effect else { continue };
        let Some(joints) = joints else { continue };
        let largest = (0..joints.len()).filter(|&joint| joints[joint].kind == JointKind::Revolute);
        let largest = largest.map(|joint| (joint + 1, share * most_sag(joints, links, joint)));
        let Some((joint, sag)) = largest.max_by(|(_, one), (_, other)| one.total_cmp(other)) else { continue };
        if sag.is_infinite() {
            item.error(
                format!("nothing bounds by how much joint {joint} sags: a joint behind it slides without limits"),
                "give every joint that slides its `limits`, e.g. `limits: [0 m, 1.5 m]`",
            );
        } else if sag > MOST_SAG {
            let most = MOST_SAG * 1e3;
            item.error(
                format!("joint {joint} could sag by {} mrad, more than {most} mrad", words::above(sag * 1e3, most)),
                "check the masses, the joint's compliance, and the limits of joints that slide",
            );
        }
    }
}

/// A bound of how far a joint (from 0) yields to the whole weight behind it
/// (rad): the arm stretched out level.
fn most_sag(joints: &[Joint], links: &[Link], joint: usize) -> f64 {
    let mut reach = 0.0;
    let mut torque = 0.0;
    for (row, link) in joints.iter().zip(links).skip(joint) {
        let slide = match (row.kind, row.limits) {
            (JointKind::Revolute, _) => 0.0,
            (JointKind::Prismatic, None) => f64::INFINITY,
            (JointKind::Prismatic, Some([low, high])) => low.abs().max(high.abs()),
        };
        reach += row.a.hypot(row.d.abs() + slide);
        let [x, y, z] = link.center_of_mass;
        if link.mass > 0.0 {
            torque += link.mass * GRAVITY * (reach + x.hypot(y).hypot(z));
        }
    }
    match joints[joint].compliance() {
        0.0 => 0.0,
        compliance => compliance * torque,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_read_as_they_are_written() {
        let entries = [DhEntry::A(2), DhEntry::Alpha(1), DhEntry::D(4), DhEntry::Theta(3)].map(Place::Entry);
        let places = [Place::Joint(3), Place::Joints([2, 3]), Place::Link(1), Place::Base, Place::Tool, Place::Robot];
        for place in places.into_iter().chain(entries) {
            assert_eq!(parse_place(&place.to_string()), Some(place));
        }
        assert_eq!(parse_place("joints 3, 2"), Some(Place::Joints([2, 3])));
        for text in ["joint", "joint x", "joints 2", "base 1", "rig", "", "a", "b2", "a2 3", "2"] {
            assert_eq!(parse_place(text), None);
        }
    }
}
