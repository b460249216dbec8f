//! The effects of a description, and what physics asks of them.

use crate::description::Joint;
use crate::document::{Map, Node};
use crate::effect::{Effect, JointKind, Place};
use crate::quantity::Dimension;
use crate::suggest::{closest, list};

/// The kinds a description may hold, with what each needs.
const KINDS: &[(&str, &[&str])] = &[
    ("transverse_compliance", &["value"]),
    ("link_compliance", &["bending", "torsion"]),
    ("base_compliance", &["tilt", "translation"]),
    ("tool_compliance", &["rotation", "translation"]),
    ("joint_coupling", &["value"]),
    ("stiffness_nonlinearity", &["added", "knee"]),
];

/// Kinds that are known, but that no description can hold yet.
const NOT_YET: &[&str] = &[
    "lost_motion",
    "hysteresis",
    "pose_dependent_compliance",
    "joint_zero_offset",
    "dh_error",
    "transmission_error",
    "gravity_sag",
    "base_slip",
];

/// Faults of the measurement (`@rig`), which are no part of a robot.
const OF_THE_RIG: &[&str] = &[
    "load_cell_misalignment",
    "load_cell_bias",
    "load_cell_scale",
    "lever_arm",
    "tracker_misalignment",
    "thermal_drift",
    "creep",
    "outliers",
];

/// Reads the effects. Without the joints (because they have problems of their
/// own) only their count is checked against.
pub(super) fn effects(node: &Node, joints: Option<&[Joint]>, count: Option<usize>) -> Option<Vec<Effect>> {
    let items = node.sequence()?;
    let read: Vec<Option<Effect>> = items.iter().map(|item| effect(item, joints, count)).collect();
    for (index, effect) in read.iter().enumerate() {
        let Some(effect) = effect else { continue };
        let same = |other: &&Option<Effect>| other.is_some_and(|other| other.to_string() == effect.to_string());
        if let Some(first) = read[..index].iter().position(|other| same(&other)) {
            items[index].error(
                format!("the effect `{effect}` is given twice"),
                format!("the first is `{}`; merge the two", items[first].path()),
            );
        }
    }
    if let Some(joints) = joints {
        check_couplings(&items, &read, joints);
    }
    read.into_iter().collect()
}

fn effect(node: &Node, joints: Option<&[Joint]>, count: Option<usize>) -> Option<Effect> {
    let map = node.any_map("write e.g. `{kind: transverse_compliance, at: joint 3, value: 6.35e-7 rad/Nm}`")?;
    let (kind, parameters) = kind(&map.require("kind", "kind: transverse_compliance")?)?;
    node.map(&[&["kind", "at"], parameters].concat())?;
    let place = map.require("at", &format!("at: {}", example_place(kind))).and_then(|at| place(&at, kind, count));
    let stated = |name| map.require(name, &format!("{name}: 6.35e-7 rad/Nm"));
    let compliance = |name| left_out_or(&map, name, |node| node.nonnegative(Dimension::Compliance));
    let translation = || left_out_or(&map, "translation", |node| node.nonnegative(Dimension::LinearCompliance));
    if parameters.len() > 1 && kind != "stiffness_nonlinearity" && parameters.iter().all(|name| map.get(name).is_none())
    {
        node.error(
            format!("`{kind}` needs at least one of {}", list(parameters.iter().copied())),
            "a parameter left out is 0",
        );
        return None;
    }
    let effect = match kind {
        "transverse_compliance" => {
            let value = stated("value").and_then(|node| node.nonnegative(Dimension::Compliance));
            let Place::Joint(joint) = place? else { return None };
            Effect::TransverseCompliance { joint, value: value? }
        }
        "link_compliance" => {
            let (bending, torsion) = (compliance("bending"), compliance("torsion"));
            let Place::Link(link) = place? else { return None };
            Effect::LinkCompliance { link, bending: bending?, torsion: torsion? }
        }
        "base_compliance" => {
            let (tilt, translation) = (compliance("tilt"), translation());
            place?;
            Effect::BaseCompliance { tilt: tilt?, translation: translation? }
        }
        "tool_compliance" => {
            let (rotation, translation) = (compliance("rotation"), translation());
            place?;
            Effect::ToolCompliance { rotation: rotation?, translation: translation? }
        }
        "joint_coupling" => {
            let value = stated("value").and_then(|node| node.quantity(Dimension::Compliance));
            let Place::Joints(pair) = place? else { return None };
            revolute(&map, joints, &pair)?;
            Effect::JointCoupling { joints: pair, value: value? }
        }
        _ => {
            let added = stated("added").and_then(|node| node.quantity(Dimension::Compliance));
            let knee = map.require("knee", "knee: 500 Nm").and_then(|node| node.positive(Dimension::Torque));
            let Place::Joint(joint) = place? else { return None };
            revolute(&map, joints, &[joint])?;
            softening(&map, joints, joint, added?)?;
            Effect::StiffnessNonlinearity { joint, added: added?, knee: knee? }
        }
    };
    Some(effect)
}

fn left_out_or(map: &Map, name: &str, read: impl FnOnce(&Node) -> Option<f64>) -> Option<f64> {
    map.get(name).map_or(Some(0.0), |node| read(&node))
}

fn kind(node: &Node) -> Option<(&'static str, &'static [&'static str])> {
    let name = node.text()?;
    if let Some(kind) = KINDS.iter().find(|(kind, _)| *kind == name) {
        return Some(*kind);
    }
    let kinds = || KINDS.iter().map(|(kind, _)| *kind);
    let kinds_are = format!("the kinds are {}", list(kinds()));
    if OF_THE_RIG.contains(&name) {
        node.error(
            format!("`{name}` is a fault of the measurement (`@rig`), which is no part of a robot"),
            "leave it out: faults of the rig are reported and corrected for, never described",
        );
    } else if NOT_YET.contains(&name) {
        node.error(format!("`{name}` is not supported in a description yet"), kinds_are);
    } else {
        let help = closest(name, kinds()).map_or(String::new(), |meant| format!("did you mean `{meant}`? "));
        node.error(format!("unknown kind of effect `{name}`"), help + &kinds_are);
    }
    None
}

fn example_place(kind: &str) -> &'static str {
    match kind {
        "link_compliance" => "link 2",
        "base_compliance" => "base",
        "tool_compliance" => "tool",
        "joint_coupling" => "\"joints 2,3\"",
        _ => "joint 3",
    }
}

/// The place of an effect of this kind, on the robot.
fn place(node: &Node, kind: &str, count: Option<usize>) -> Option<Place> {
    let text = node.text()?;
    let place = match parse_place(text) {
        Some(place) if fits(kind, place) => place,
        _ => {
            let help = format!("write e.g. `at: {}`", example_place(kind));
            node.error(format!("`{kind}` cannot sit at `{text}`"), help);
            return None;
        }
    };
    let (what, numbers, most) = match place {
        Place::Joint(joint) => ("joint", [joint, joint], count),
        Place::Joints(joints) => ("joint", joints, count),
        Place::Link(link) => ("link", [link, link], count.map(|count| count.saturating_sub(1))),
        Place::Base | Place::Tool => return Some(place),
    };
    if let (Some(most), Some(count)) = (most, count)
        && let Some(wrong) = numbers.into_iter().find(|number| !(1..=most).contains(number))
    {
        let help = match (what, most) {
            ("link", 0) => "link i is the body between joints i and i + 1".to_owned(),
            ("link", _) => format!("links count from 1 to {most}; link i is the body between joints i and i + 1"),
            _ => format!("joints count from 1 to {most}"),
        };
        node.error(format!("there is no {what} {wrong} in a robot of {count} joints"), help);
        return None;
    }
    if matches!(place, Place::Joints([i, j]) if i == j) {
        node.error("a coupling needs two different joints", "e.g. `at: \"joints 2,3\"`");
        return None;
    }
    Some(place)
}

fn fits(kind: &str, place: Place) -> bool {
    match kind {
        "link_compliance" => matches!(place, Place::Link(_)),
        "base_compliance" => place == Place::Base,
        "tool_compliance" => place == Place::Tool,
        "joint_coupling" => matches!(place, Place::Joints(_)),
        _ => matches!(place, Place::Joint(_)),
    }
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
        _ => None,
    }
}

/// That the joints an effect sits at turn.
fn revolute(map: &Map, joints: Option<&[Joint]>, numbers: &[usize]) -> Option<()> {
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

/// That a joint that softens with torque keeps a positive compliance without it.
fn softening(map: &Map, joints: Option<&[Joint]>, joint: usize, added: f64) -> Option<()> {
    let compliance = joints.and_then(|joints| joints.get(joint - 1))?.compliance();
    if added <= -compliance {
        map.get("added")?.error(
            format!("without load, joint {joint} would have no compliance left: {compliance:e} {added:+e} rad/Nm"),
            format!("`added` must be above -{compliance:e} rad/Nm"),
        );
        return None;
    }
    Some(())
}

/// That the joints' compliance matrix `H_q` with all couplings in it is
/// positive definite: a load can do no negative work on the robot. The diagonal
/// is the joints' least compliance over all torques.
fn check_couplings(items: &[Node], effects: &[Option<Effect>], joints: &[Joint]) {
    let mut least: Vec<f64> = joints.iter().map(Joint::compliance).collect();
    for effect in effects.iter().flatten() {
        if let Effect::StiffnessNonlinearity { joint, added, .. } = effect {
            least[joint - 1] += added.min(0.0);
        }
    }
    // H_q scaled to a diagonal of ones, so that no product underflows.
    let count = joints.len();
    let mut scaled: Vec<Vec<f64>> =
        (0..count).map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let mut last = None;
    for (item, effect) in items.iter().zip(effects) {
        let Some(Effect::JointCoupling { joints: [i, j], value }) = effect else { continue };
        let bound = least[i - 1].sqrt() * least[j - 1].sqrt();
        if value.abs() < bound {
            scaled[j - 1][i - 1] = value / bound;
            last = Some(item);
            continue;
        }
        let field = item.any_map("").and_then(|map| map.get("value"));
        field.as_ref().unwrap_or(item).error(
            format!("the coupling must be weaker than sqrt(h_{i} h_{j}) = {bound:.3e} rad/Nm"),
            if bound == 0.0 { "a rigid joint cannot be coupled" } else { "else a load could do negative work" },
        );
        return;
    }
    if let (Some(last), false) = (last, is_positive_definite(&mut scaled)) {
        last.error(
            "the couplings are too strong together: the joints' compliance matrix is not positive definite",
            "weaken one of them, else a load could do negative work",
        );
    }
}

/// Cholesky decomposition in place, of the lower triangle.
fn is_positive_definite(matrix: &mut [Vec<f64>]) -> bool {
    for i in 0..matrix.len() {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let rest = matrix[i][j] - sum;
            if i == j && rest <= 0.0 {
                return false;
            }
            matrix[i][j] = if i == j { rest.sqrt() } else { rest / matrix[j][j] };
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_is_positive_definite_or_not() {
        let mut weak = vec![vec![1.0], vec![0.7, 1.0], vec![0.7, 0.7, 1.0]];
        assert!(is_positive_definite(&mut weak));
        let mut strong = vec![vec![1.0], vec![0.7, 1.0], vec![0.7, -0.7, 1.0]];
        assert!(!is_positive_definite(&mut strong));
    }

    #[test]
    fn places_read_as_they_are_written() {
        for place in [Place::Joint(3), Place::Joints([2, 3]), Place::Link(1), Place::Base, Place::Tool] {
            assert_eq!(parse_place(&place.to_string()), Some(place));
        }
        assert_eq!(parse_place("joints 3, 2"), Some(Place::Joints([2, 3])));
        for text in ["joint", "joint x", "joints 2", "base 1", "rig", ""] {
            assert_eq!(parse_place(text), None);
        }
    }
}
