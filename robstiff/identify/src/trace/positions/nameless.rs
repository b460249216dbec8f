//! What arms are known to have that positions show and the catalogue has no name for: an
//! encoder with a scale of its own, a joint that another one takes along, [weight](super::weight)
//! that the description does not know, a coupling of joints that share no drive; a slip after another, as of a base or a reflector that
//! somebody put back.
//!
//! No description has a word for any of it, so none is ever named; it is what names are held
//! [against](super::beyond).

use std::format;
use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use robstiff_robots::Description;
use robstiff_robots::effect::Place as Part;

use super::offers::{Form, Number, Offer, any, stray_couplings};
use super::rig::Rig;
use super::weight::{self, WEIGHT};
use crate::campaign::Positions;
use crate::identify::positions::model::{ANGLE_STEP, Enters, Follower, Model};
use crate::trace::catalogue::{Candidate, Kind, STRAY_COUPLING, place_words};
use crate::trace::found::EffectParameter;
use crate::trace::slip::{SLIPPED_AT, Slipping};
use crate::trace::wander::AGAIN;
use robstiff::JointKind;

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

/// A second slip of the base, and of the reflector: a name says one moment.
pub static BASE_AGAIN: Kind = Kind {
    name: "base_slip_again",
    of_rig: true,
    words: |found| format!("{AGAIN} of the base before line {}", found.value(SLIPPED_AT)),
    ..FOLLOWER
};
pub static REFLECTOR_AGAIN: Kind = Kind {
    name: "reflector_slip_again",
    of_rig: true,
    words: |found| format!("{AGAIN} of the reflector on the tool before line {}", found.value(SLIPPED_AT)),
    ..FOLLOWER
};

/// What slips a second time by a candidate, if anything does.
pub fn again(candidate: &Candidate) -> Option<Slipping> {
    let seconds = [(&BASE_AGAIN, Slipping::Base), (&REFLECTOR_AGAIN, Slipping::Reflector)];
    seconds.into_iter().find(|(second, _)| candidate.kind == *second).map(|(_, first)| first)
}

/// The joint that is followed, and whether that is the joint itself.
pub const OF: &str = "of";
const OWN: &str = "own";

/// More than this share is another gear (rad or m, by rad or m).
const MOST: f64 = 0.1;

/// Whether a candidate has no name.
pub fn is_nameless(candidate: &Candidate) -> bool {
    [&FOLLOWER, &WEIGHT, &STRAY_COUPLING].contains(&candidate.kind) || again(candidate).is_some()
}

/// Everything that has no name; second slips where `slipped` is whether there may have been
/// a first one.
pub fn offers(robot: &Description, data: &Positions, rig: &Rig, slipped: impl Fn(Slipping) -> bool) -> Vec<Offer> {
    let base = || rig.slip_of_base(data).map(|first| Offer { kind: &BASE_AGAIN, ..first });
    let reflector = || rig.slip_of_reflector(data).map(|first| Offer { kind: &REFLECTOR_AGAIN, ..first });
    let base = slipped(Slipping::Base).then(base).flatten();
    let reflector = slipped(Slipping::Reflector).then(reflector).flatten();
    let followers = (1..=robot.joints.len()).filter_map(|joint| follower(robot, data, joint));
    let stray = stray_couplings(robot, data);
    base.into_iter().chain(reflector).chain(followers).chain(weight::offers(robot, data, rig)).chain(stray).collect()
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
