//! Reading what acts and what is read.

use std::format;
use std::vec::Vec;

use robstiff_robots::Joint;
use robstiff_robots::document::{Map, Node};
use robstiff_robots::quantity::Dimension;

use super::super::{Measures, Pull, UnderForces, UnderPayloads};
use super::{computable, dimension, for_each_joint, noise, sigma};
use crate::campaign::Frame;
use crate::campaign::read::place;

/// What a scenario says of loads and instruments.
pub struct Measured {
    pub measures: Measures,
    pub wrench_at: [f64; 3],
    pub measured_at: [f64; 3],
    pub noise: [f64; 3],
    pub states_noise: bool,
}

/// Reads it, by the kind of the scenario.
pub fn measured(map: &Map<'_>, joints: &[Joint]) -> Option<Measured> {
    let places = [place(map, "wrench"), place(map, "measured")];
    let kinds = [("displacement", false), ("position", true)];
    let tracked = map.get("kind").map_or(Some(false), |node| node.choice(&kinds))?;
    let fields: &[&str] = match tracked {
        true => &["displacement", "repeatability", "stated"],
        false => &["displacement", "rotation", "encoders", "stated"],
    };
    let of_noise = map.require("noise", "noise: {displacement: 8 um}").and_then(|node| node.map(fields));
    let displacement = of_noise.as_ref().and_then(displacement_noise);
    let measures = match tracked {
        true => under_payloads(map, of_noise.as_ref()).map(Measures::Positions),
        false => under_forces(map, of_noise.as_ref(), joints, places.map(|place| Some(place?.0)))
            .map(Measures::Displacements),
    };
    let stated = of_noise?.get("stated").map_or(Some(true), |node| node.choice(&[("yes", true), ("no", false)]));
    let [wrench, measured] = places;
    Some(Measured {
        measures: measures?,
        wrench_at: wrench?.1,
        measured_at: measured?.1,
        noise: displacement?,
        states_noise: stated?,
    })
}

fn under_payloads(map: &Map<'_>, of_noise: Option<&Map<'_>>) -> Option<UnderPayloads> {
    let others = ["ramp", "force", "moment", "unloaded"];
    let fits = none_of(map, &others, "positions are read under payloads", "e.g. `payloads: [0 kg, 150 kg]`");
    let payloads = map.get("payloads").map_or(Some(std::vec![0.0]), |node| payloads(&node));
    let repeatability = of_noise?.get("repeatability").map_or(Some(0.0), |node| noise(&node, Dimension::Length));
    fits.then_some(UnderPayloads { payloads: payloads?, repeatability: repeatability? })
}

fn under_forces(
    map: &Map<'_>,
    of_noise: Option<&Map<'_>>,
    joints: &[Joint],
    frames: [Option<Frame>; 2],
) -> Option<UnderForces> {
    let fits = none_of(map, &["payloads"], "displacements are read under forces", "or is it `kind: position`?");
    let ramp = map.get("ramp").map_or(Some(std::vec![1.0]), |node| ramp(&node));
    let force = map
        .require("force", "force: {bounds: [500 N, 1300 N]}")
        .and_then(|node| pull(&node, Dimension::Force, "bounds: [500 N, 1300 N]"));
    let moment = map
        .get("moment")
        .map_or(Some(None), |node| pull(&node, Dimension::Torque, "bounds: [50 Nm, 200 Nm]").map(Some));
    let unloaded = [("shared", true), ("separate", false)];
    let shares_unloaded = map.get("unloaded").map_or(Some(true), |node| node.choice(&unloaded));
    let of_noise = of_noise?;
    let rotation = of_noise.get("rotation").map_or(Some(None), |node| noise(&node, Dimension::Angle).map(Some));
    let encoders = of_noise.get("encoders").map_or(Some(None), |node| encoder_noise(&node, joints).map(Some));
    let [wrench, measured] = frames;
    fits.then_some(UnderForces {
        ramp: ramp?,
        force: force?,
        moment: moment?,
        frames: [wrench?, measured?],
        rotation_noise: rotation?,
        encoder_noise: encoders?,
        shares_unloaded: shares_unloaded?,
    })
}

/// Whether a scenario has none of the fields of another kind; reports those that it has.
fn none_of(map: &Map<'_>, fields: &[&str], why: &str, help: &str) -> bool {
    let found: Vec<Node<'_>> = fields.iter().filter_map(|field| map.get(field)).collect();
    found.iter().for_each(|node| node.error(why, help));
    found.is_empty()
}

fn payloads(node: &Node<'_>) -> Option<Vec<f64>> {
    let items = node.sequence()?;
    if items.is_empty() {
        node.error("at least one payload is expected here", "e.g. `[0 kg, 150 kg]`");
        return None;
    }
    let payloads: Vec<Option<f64>> = items.iter().map(|item| sigma(item, Dimension::Mass)).collect();
    payloads.into_iter().collect()
}

fn ramp(node: &Node<'_>) -> Option<Vec<f64>> {
    let items = node.sequence()?;
    if items.is_empty() {
        node.error("at least one load is expected here", "e.g. `[0.35, 0.7, 1, 0.7, 0.35]`");
        return None;
    }
    let share = |item: &Node<'_>| {
        let share = item.quantity(Dimension::Number)?;
        if share.abs() > 1.0 {
            item.error("a share of the visit's greatest load is between -1 and 1", "e.g. `0.35`");
            return None;
        }
        Some(share)
    };
    let shares: Vec<Option<f64>> = items.iter().map(share).collect();
    shares.into_iter().collect()
}

fn pull(node: &Node<'_>, dimension: Dimension, example: &str) -> Option<Pull> {
    let map = node.map(&["bounds", "directions"])?;
    let bounds = map.require("bounds", example).and_then(|node| {
        let [low, high] = node.quantities::<2>(dimension)?;
        if !(0.0..=high).contains(&low) {
            node.error("the bounds are of a size: zero or more, the lower one first", format!("e.g. `{example}`"));
            return None;
        }
        computable(&node, high)?;
        Some([low, high])
    });
    let directions = map.get("directions").map_or(Some(Vec::new()), |node| {
        let items = node.sequence()?;
        let direction = |item: &Node<'_>| {
            let direction = item.quantities::<3>(Dimension::Number)?;
            if direction == [0.0; 3] {
                item.error("this is no direction", "e.g. `[0, 0, -1]`, of any length but zero");
                return None;
            }
            Some(direction)
        };
        let directions: Vec<Option<[f64; 3]>> = items.iter().map(direction).collect();
        directions.into_iter().collect()
    });
    Some(Pull { bounds: bounds?, directions: directions? })
}

fn displacement_noise(of_noise: &Map<'_>) -> Option<[f64; 3]> {
    let node = of_noise.require("displacement", "displacement: 8 um")?;
    if !node.is_sequence() {
        return noise(&node, Dimension::Length).map(|sigma| [sigma; 3]);
    }
    // Says what is wrong with the list itself.
    node.quantities::<3>(Dimension::Length)?;
    let sigmas: Vec<Option<f64>> = node.sequence()?.iter().map(|item| noise(item, Dimension::Length)).collect();
    sigmas.into_iter().collect::<Option<Vec<f64>>>()?.try_into().ok()
}

/// One sigma for all joints, where all are of one kind, or one for each.
fn encoder_noise(node: &Node<'_>, joints: &[Joint]) -> Option<Vec<f64>> {
    if node.is_sequence() {
        let items = for_each_joint(node, joints)?;
        let sigmas: Vec<Option<f64>> =
            items.iter().zip(joints).map(|(item, joint)| noise(item, dimension(joint))).collect();
        return sigmas.into_iter().collect();
    }
    let kind = dimension(joints.first()?);
    if joints.iter().any(|joint| dimension(joint) != kind) {
        node.error("some joints turn, some slide", "give one sigma for each joint, e.g. `[20 urad, 5 um, ..]`");
        return None;
    }
    let sigma = noise(node, kind)?;
    Some(joints.iter().map(|_| sigma).collect())
}
