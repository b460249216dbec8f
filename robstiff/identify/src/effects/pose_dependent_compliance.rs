//! A joint's compliance varies with its angle.

use std::rc::Rc;

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{Parameter, Size, Term, Torques};

/// The kind.
pub static KIND: Kind = Kind {
    name: "pose_dependent_compliance",
    side: Side::Robot,
    words: |place, _| format!("the compliance of {} that varies with its angle", place.words()),
    explanation: "",
    offer,
};

/// The likely part of the joint's compliance.
const LIKELY: f64 = 0.4;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if !scene.is_loaded() {
        return;
    }
    for joint in scene.turning().into_iter().filter(|&joint| scene.is_driven(joint)) {
        let own = scene.compliance[joint - 1];
        let wave = |name, order: f64, sine: bool| {
            let law = move |torques: &Torques<'_>| {
                let of = |(torque, q): (&f64, &f64)| {
                    let (s, c) = (order * q).sin_cos();
                    own * torque * if sine { s } else { c }
                };
                torques.load.iter().zip(torques.q).map(of).collect()
            };
            Parameter::new(name, "1", Size::Of(LIKELY), Term::Law(joint, Rc::new(law)))
        };
        let once = vec![wave("cos1", 1.0, false), wave("sin1", 1.0, true)];
        let twice = vec![wave("cos2", 2.0, false), wave("sin2", 2.0, true)];
        let both = once.iter().chain(&twice).cloned().collect();
        let written =
            move |cos1, sin1, cos2, sin2| vec![Effect::PoseDependentCompliance { joint, cos1, sin1, cos2, sin2 }];
        let forms = [
            Form::new("once a turn", once).written(move |v| written(v[0], v[1], 0.0, 0.0)),
            Form::new("twice a turn", twice).written(move |v| written(0.0, 0.0, v[0], v[1])),
            Form::new("both", both).written(move |v| written(v[0], v[1], v[2], v[3])),
        ];
        offers.add(Part::Joint(joint), forms.map(|form| form.share_of(joint)).to_vec());
    }
}
