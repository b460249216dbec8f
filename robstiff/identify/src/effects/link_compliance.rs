//! A link bends, and twists.

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side};
use crate::model::spring::Spring;
use crate::model::{Arm, Parameter};

/// The kind.
pub static KIND: Kind = Kind {
    name: "link_compliance",
    side: Side::Robot,
    words: |place, _| format!("the bending and torsion of {}", place.words()),
    explanation: "",
    offer,
};

/// A link that is shorter than this is a housing (m).
const SHORTEST: f64 = 0.05;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if !scene.is_loaded() {
        return;
    }
    let arm = Arm::of(scene.robot);
    let joints = arm.stand(&vec![0.0; arm.joints()], &[]).joints;
    let lengths: Vec<f64> = joints.windows(2).map(|two| (two[1].at - two[0].at).norm()).collect();
    for link in scene.joints().take(scene.kinds.len() - 1) {
        if lengths[link - 1] < SHORTEST || !scene.turns(link) {
            continue;
        }
        let size = 0.5 * scene.middle;
        let bending = || Parameter::compliance("bending", "rad/Nm", size, Spring::Bending(link));
        let torsion = Parameter::compliance("torsion", "rad/Nm", size, Spring::Torsion(link));
        let written = move |bending, torsion| vec![Effect::LinkCompliance { link, bending, torsion }];
        offers.add(
            Part::Link(link),
            vec![
                Form::new("bending", vec![bending()]).written(move |v| written(v[0], 0.0)),
                Form::new("both", vec![bending(), torsion]).written(move |v| written(v[0], v[1])),
            ],
        );
    }
}
