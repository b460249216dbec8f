//! Backlash: the steep part about zero torque.

use robstiff::Effect;
use robstiff_robots::Place as Part;

use std::rc::Rc;

use super::own_weight::profile;
use super::scene::What;
use super::stiffness_nonlinearity::curves;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "lost_motion",
    side: Side::Robot,
    words: |place, _| format!("the lost motion (backlash) of {}", place.words()),
    explanation: "",
    offer,
};

/// Knees that are tried, over the largest torque.
const KNEES: [f64; 3] = [0.008, 0.02, 0.05];

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    for joint in scene.turning() {
        let mut forms = Vec::new();
        if scene.is_driven(joint) {
            forms.extend(under_loads(scene, joint));
        }
        if scene.what == What::Positions {
            forms.push(under_weight(joint));
        }
        offers.add(Part::Joint(joint), forms);
    }
}

/// The loads take the joint (from 1) from one flank to the other.
fn under_loads(scene: &Scene<'_>, joint: usize) -> Vec<Form> {
    let size = 0.2 * scene.compliance[joint - 1] * scene.torque[joint - 1];
    let number = move |law| Parameter::new("gap", "rad", Size::Of(size), Term::Law(joint, law)).nonnegative();
    curves(scene, joint, &KNEES, number, move |gap, knee| Effect::LostMotion { joint, gap, knee })
}

/// The weight of the arm rests on one flank of a gear or on the other, and the joint (from 1) stands
/// aside by half the gap.
fn under_weight(joint: usize) -> Form {
    let of = move |at: &At<'_>| {
        // Where the torque is small against that of a level arm, the joint floats.
        let torque = profile(at.stand, joint);
        0.5 * torque / torque.hypot(FLOATS)
    };
    let term = Term::Aside(joint, 2, Rc::new(of));
    Form::new("under weight", vec![Parameter::new("gap", "rad", Size::Of(2e-4), term).nonnegative()])
}

/// The part of a unit weight at a lever of a metre below which a gear is loose (m).
const FLOATS: f64 = 0.03;
