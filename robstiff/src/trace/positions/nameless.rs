//! What arms are known to have that positions show and the catalogue has no name for: an
//! encoder with a scale of its own, a joint that another one takes along.
//!
//! No description has a word for any of it, so none is ever named; it is what names are held
//! [against](super::beyond).

use std::format;
use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use robstiff_robots::Description;
use robstiff_robots::effect::Place as Part;

use super::offers::{Form, Number, Offer, any};
use crate::JointKind;
use crate::campaign::Positions;
use crate::identify::positions::model::{ANGLE_STEP, Enters, Follower, Model};
use crate::trace::catalogue::{Candidate, Kind, place_words};
use crate::trace::found::EffectParameter;

/// A joint that goes by so much of its own coordinate, or of another's, farther than it reads.
pub static FOLLOWER: Kind = Kind {
    name: "follower",
    of_rig: false,
    words: |found| match (found.value(OWN), found.value(OF)) {
        (1.0, _) => format!("an encoder of {} that has a scale of its own", place_words(found)),
        (_, other) => format!("{} going along with joint {other}", place_words(found)),
    },
    explanation: "",
    offer: |_, _| {},
    on_axes: None,
};

/// The joint that is followed, and whether that is the joint itself.
pub const OF: &str = "of";
const OWN: &str = "own";

/// More than this share is another gear (rad or m, by rad or m).
const MOST: f64 = 0.1;

/// Whether a candidate has no name.
pub fn is_nameless(candidate: &Candidate) -> bool {
    candidate.kind == &FOLLOWER
}

/// Everything that has no name.
pub fn offers(robot: &Description, data: &Positions) -> Vec<Offer> {
    (1..=robot.joints.len()).filter_map(|joint| follower(robot, data, joint)).collect()
}

/// A joint that follows, one or another or itself; counted from where that is zero, or from
/// the middle of where it goes.
fn follower(robot: &Description, data: &Positions, joint: usize) -> Option<Offer> {
    let (mut numbers, mut forms) = (vec![], vec![]);
    for of in 1..=robot.joints.len() {
        let Some(middle) = middle(data, of) else { continue };
        for from in [0.0, middle] {
            let enters = move |model: &mut Model, share| model.followers.push(Follower { joint, of, from, share });
            let mark = |name, value| EffectParameter { name, value, std: None, unit: "1" };
            let marks = vec![mark(OF, of as f64), mark(OWN, f64::from(u8::from(of == joint)))];
            forms.push(Form { marks, ..Form::of([numbers.len()]) });
            numbers.push(Number {
                name: "share",
                unit: "1",
                range: [-MOST, MOST],
                enters: Enters::Model(Rc::new(enters), ANGLE_STEP),
            });
        }
    }
    let place = Part::Joint(joint).into();
    (!forms.is_empty()).then_some(Offer { kind: &FOLLOWER, place, numbers, forms, possible: any() })
}

/// The mean of a joint's coordinate, if that varies.
pub fn middle(data: &Positions, joint: usize) -> Option<f64> {
    let q = |row: usize| data.rows[row].q[joint - 1];
    let varies = (1..data.rows.len()).any(|row| q(row) != q(0));
    varies.then(|| (0..data.rows.len()).map(q).sum::<f64>() / data.rows.len() as f64)
}

/// How far from the mean of its coordinate (rad or m) a joint may be where what follows it
/// adds nothing: wherever its encoder, or the gear, counts from.
pub fn reach(robot: &Description, data: &Positions, joint: usize) -> f64 {
    let from = middle(data, joint).unwrap_or_default();
    let farthest = data.rows.iter().map(|row| (row.q[joint - 1] - from).abs()).fold(0.0, f64::max);
    let turn = if robot.joints[joint - 1].kind == JointKind::Revolute { core::f64::consts::PI } else { 0.0 };
    from.abs() + farthest.max(turn)
}
