//! Without a name: the compliance of a main axis varies with the angle of another.

use std::rc::Rc;

use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{Parameter, Size, Term, Torques};

/// The kind.
pub static KIND: Kind = Kind {
    name: "depends_on_other",
    side: Side::Unnamed,
    words: |place, _| format!("a compliance of {} that varies with the angle of another joint", place.words()),
    explanation: "Nothing in the catalogue is like this: a rod beside the arm, a balancer, a hose package that pulls.",
    offer,
};

/// The likely part of the joint's compliance.
const LIKELY: f64 = 0.3;

/// The main axes: these carry the arm.
const MAIN: usize = 3;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if !scene.has_loads() {
        return;
    }
    let main: Vec<usize> = scene.turning().into_iter().take(MAIN).collect();
    for &joint in main.iter().filter(|&&joint| scene.is_driven(joint)) {
        let form = |other: usize| {
            let own = scene.compliance[joint - 1];
            let wave = |name, sine: bool| {
                let law = move |torques: &Torques<'_>| {
                    let of = |(torque, q): (&f64, &f64)| own * torque * if sine { q.sin() } else { q.cos() };
                    torques.load.iter().zip(&torques.all[other - 1]).map(of).collect()
                };
                Parameter::new(name, "1", Size::Of(LIKELY), Term::Law(joint, Rc::new(law)))
            };
            Form::new(format!("joint {other}"), vec![wave("cos", false), wave("sin", true)])
        };
        let others = main.iter().copied().filter(|&other| other != joint);
        offers.add(Part::Joint(joint), others.map(|other| form(other).share_of(joint)).collect());
    }
}
