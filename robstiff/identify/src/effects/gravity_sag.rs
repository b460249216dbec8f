//! The arm hangs down under the weight of links whose masses the description has, and a controller
//! does not correct for it.

use std::rc::Rc;

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::scene::What;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "gravity_sag",
    side: Side::Robot,
    words: |_, _| "the sag of the arm under its own weight".into(),
    explanation: "",
    offer,
};

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what != What::Positions || !scene.weight.is_known() {
        return;
    }
    let (weight, kinds, compliance) = (scene.weight.clone(), scene.kinds.clone(), scene.compliance.clone());
    let of = move |at: &At<'_>, joint: usize| compliance[joint - 1] * weight.torque(at.stand, &kinds, joint - 1);
    let share = Parameter::new("share", "1", Size::Of(1.0), Term::Asides(Rc::new(of))).nonnegative();
    offers.add(Part::Robot, vec![Form::new("", vec![share]).written(|v| vec![Effect::GravitySag { share: v[0] }])]);
}
