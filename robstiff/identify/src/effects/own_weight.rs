//! A joint gives way to the arm's own weight: it hangs below where its encoder says.
//!
//! How the weight is spread over the arm is not known. One number does for a guessed profile; three
//! for point masses at the elbow, the wrist and the tool; or the first moments of all links behind
//! the joint.

use std::rc::Rc;

use nalgebra::Vector3;
use robstiff_robots::Place as Part;

use super::scene::What;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{At, OfRow, Parameter, Size, Stand, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "own_weight",
    side: Side::Robot,
    words: |place, _| format!("the sag of {} under the arm's own weight", place.words()),
    explanation: "The links weigh on the joint, so the arm hangs below where its encoders say. A controller that knows \
        the masses corrects it; measurements from the encoders alone cannot show it.",
    offer,
};

/// How far the tool is likely to sag (m).
const LIKELY: f64 = 5e-4;
const LIKELY_MOMENT: f64 = 3e-4;

/// How the weight of an arm is spread over its links, from the first on, and what hangs at the tool.
const PROFILE: [f64; 8] = [0.35, 0.25, 0.2, 0.1, 0.05, 0.03, 0.02, 0.02];
const AT_TOOL: f64 = 0.03;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what != What::Positions {
        return;
    }
    for joint in scene.turning().into_iter().filter(|&joint| joint > 1) {
        let number = |name, size, of: OfRow| Parameter::new(name, "rad", Size::Moves(size), Term::Aside(joint, 2, of));
        let arm = number("sag", LIKELY, Rc::new(move |at: &At<'_>| profile(at.stand, joint))).nonnegative();
        let mass = |name, which: usize| {
            number(name, LIKELY, Rc::new(move |at: &At<'_>| about(at.stand, joint, &point(at.stand, which))))
        };
        let links = joint..=scene.kinds.len();
        let moment = |(link, axis): (usize, usize)| {
            let of = move |at: &At<'_>| {
                let frame = &at.stand.links[link - 1];
                turns(at.stand, joint, &frame.axis(axis))
            };
            number("moment", LIKELY_MOMENT, Rc::new(of))
        };
        let moments = links.flat_map(|link| (0..3).map(move |axis| (link, axis)));
        offers.add(
            Part::Joint(joint),
            vec![
                Form::new("profile", vec![arm]),
                Form::new("masses", vec![mass("elbow", 0), mass("wrist", 1), mass("tool", 2)]),
                Form::new("moments", moments.map(moment).collect()),
            ],
        );
    }
}

/// The torque about a joint's axis (from 1) of a unit force downwards at a lever from it, in the base
/// frame.
fn turns(stand: &Stand, joint: usize, lever: &Vector3<f64>) -> f64 {
    stand.joints[joint - 1].axis(2).dot(&lever.cross(&-Vector3::z()))
}

/// The same at a point (m).
fn about(stand: &Stand, joint: usize, point: &Vector3<f64>) -> f64 {
    turns(stand, joint, &(point - stand.joints[joint - 1].at))
}

/// The elbow, the wrist and the tool.
fn point(stand: &Stand, which: usize) -> Vector3<f64> {
    let last = stand.joints.len() - 1;
    match which {
        0 => stand.joints[last.min(2)].at,
        1 => stand.joints[last.min(4)].at,
        _ => stand.tcp.at,
    }
}

/// The lever of the guessed profile about a joint (from 1): its torque for a unit of weight (m), as a
/// vector in the base frame.
pub(super) fn moment(stand: &Stand, joint: usize) -> Vector3<f64> {
    let nodes: Vec<Vector3<f64>> =
        stand.joints.iter().map(|frame| frame.at).chain([stand.flange().at, stand.tcp.at]).collect();
    let from = stand.joints[joint - 1].at;
    let behind = (joint - 1..stand.joints.len()).map(|link| {
        let middle = 0.5 * (nodes[link] + nodes[link + 1]);
        (middle - from) * PROFILE.get(link).copied().unwrap_or(AT_TOOL)
    });
    let sum: Vector3<f64> = behind.sum::<Vector3<f64>>() + (stand.tcp.at - from) * AT_TOOL;
    sum.cross(&-Vector3::z())
}

/// The torque of the guessed profile about a joint's axis (from 1), for a unit of weight (m).
pub(super) fn profile(stand: &Stand, joint: usize) -> f64 {
    stand.joints[joint - 1].axis(2).dot(&moment(stand, joint))
}
