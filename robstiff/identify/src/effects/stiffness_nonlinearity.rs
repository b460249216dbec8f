//! A joint hardens or softens with its torque.

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side, about_weight, near_found};
use crate::model::law::unit_law;
use crate::model::term::Law;
use crate::model::{Parameter, Size, Term};

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
        let size = 0.5 * scene.compliance[joint - 1];
        let number = move |law| Parameter::new("added", "rad/Nm", Size::Of(size), Term::Law(joint, law));
        let of = move |added, knee| Effect::StiffnessNonlinearity { joint, added, knee };
        let forms = curves(scene, joint, &KNEES, number, of);
        offers.add(Part::Joint(joint), forms);
    }
}

/// The torque from which on a joint yields otherwise.
const KNEE: &str = "knee";

/// The forms of a curve of a joint (from 1), by knees over its largest torque.
pub(super) fn curves(
    scene: &Scene<'_>,
    joint: usize,
    grid: &[f64],
    number: impl Fn(Law) -> Parameter,
    of: impl Fn(f64, f64) -> Effect + Copy + 'static,
) -> Vec<Form> {
    let largest = scene.torque[joint - 1];
    let form = |knee: f64| {
        let label = format!("knee {} of the largest torque", knee / largest);
        let form = Form::new(label, vec![number(unit_law(of(1.0, knee)))]).with(KNEE, knee, "Nm");
        form.written(move |v| vec![of(v[0], knee)])
    };
    let between = near_found(scene, KNEE, Part::Joint(joint), form);
    about_weight(scene, grid.iter().map(|share| form(share * largest)).chain(between).collect())
}
