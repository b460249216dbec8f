//! A joint hardens or softens with its torque.

use std::rc::Rc;

use robstiff::Effect;
use robstiff::elements::{Torque, turn};
use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side};
use crate::model::term::Law;
use crate::model::{Parameter, Size, Term, Torques};

/// The kind.
pub static KIND: Kind = Kind {
    name: "stiffness_nonlinearity",
    side: Side::Robot,
    words: |place, numbers| {
        let softens = numbers.iter().any(|number| number.name == "added" && number.value < 0.0);
        format!("the {} of {} with torque", if softens { "softening" } else { "hardening" }, place.words())
    },
    explanation: "",
    offer,
};

/// Knees that are tried, over the largest torque.
const KNEES: [f64; 4] = [0.05, 0.12, 0.25, 0.5];

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    for joint in scene.turning().into_iter().filter(|&joint| scene.is_driven(joint)) {
        let of = |knee: f64| Effect::StiffnessNonlinearity { joint, added: 1.0, knee };
        let size = 0.5 * scene.compliance[joint - 1];
        let number = move |law| Parameter::new("added", "rad/Nm", Size::Of(size), Term::Law(joint, law));
        let written = move |added, knee| vec![Effect::StiffnessNonlinearity { joint, added, knee }];
        let forms = curves(scene, (&KIND, joint), &KNEES, |knee| law(of(knee)), number, written);
        offers.add(Part::Joint(joint), forms);
    }
}

/// The forms of a curve of a joint (from 1), by knees over its largest torque.
pub(super) fn curves(
    scene: &Scene<'_>,
    (kind, joint): (&'static Kind, usize),
    grid: &[f64],
    law: impl Fn(f64) -> Law,
    number: impl Fn(Law) -> Parameter,
    written: impl Fn(f64, f64) -> Vec<Effect> + Copy + 'static,
) -> Vec<Form> {
    let largest = scene.torque[joint - 1];
    let own: Vec<f64> = scene.found(kind.name, joint).collect();
    let all = grid.iter().map(|knee| (*knee, false)).chain(own.into_iter().map(|knee| (knee, true)));
    let form = |(share, between): (f64, bool)| {
        let knee = share * largest;
        let form = Form::new(format!("knee {share}"), vec![number(law(knee))]).with("knee", knee, "Nm");
        Form { between, ..form.written(move |v| written(v[0], knee)) }
    };
    all.map(form).collect()
}

/// The law of an effect, whose numbers are those of a unit, about what the gear carries before.
pub(super) fn law(effect: Effect) -> Law {
    Rc::new(move |torques: &Torques<'_>| {
        let of = |row: usize| {
            let torque = Torque { preload: torques.preload[row], load: torques.load[row] };
            turn(&effect, 0.0, torques.q[row], torque, [0.0; 3]).unwrap_or(0.0)
        };
        (0..torques.load.len()).map(of).collect()
    })
}
