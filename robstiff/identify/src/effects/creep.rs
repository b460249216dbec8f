//! The arm goes on yielding under a load that stays on.

use std::rc::Rc;

use robstiff_robots::Place as Part;

use super::scene::What;
use super::{Form, Kind, Offers, Place, Scene, Side, near_found};
use crate::model::law::turns_on;
use crate::model::{Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "creep",
    side: Side::Rig,
    words: |place, _| match place {
        Place::Rig => "creep under load".into(),
        Place::Part(_) => format!("the creep of {} under load", place.words()),
    },
    explanation: "The arm, its mount or the ground goes on yielding under a load that stays. Wait the same time before \
        each reading, and write the time into the file.",
    offer,
};

/// The likely part by which a displacement grows over a factor of e in time (1).
const LIKELY: f64 = 0.05;

/// Times after which it is seen that are tried (s), and that of readings without a time.
const ONSETS: [f64; 3] = [3.0, 14.0, 60.0];
const A_READING: f64 = 60.0;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.visits >= scene.visit.len() {
        return;
    }
    match scene.what {
        What::Displacements => {
            let form = |onset: f64| {
                let grows = move |since: f64| (since / onset).ln_1p();
                let term = Term::Creep(Rc::new(grows));
                let share = Parameter::new("share", "1", Size::Of(LIKELY), term).nonnegative();
                Form::new(format!("onset {onset} s"), vec![share]).with("onset", onset, "s")
            };
            let between = near_found(scene, "onset", Place::Rig, form);
            offers.add(Place::Rig, ONSETS.into_iter().map(form).chain(between).collect());
        }
        What::Clamped => {
            let law = |joint: usize| turns_on(scene.compliance[joint - 1], |since| (since / A_READING).ln_1p());
            let of_all: Vec<_> = scene.joints().map(law).collect();
            let of_all = Term::Laws(Rc::new(move |joint: usize, torques| of_all[joint - 1](torques)));
            let form = |term| {
                let share = Parameter::new("share", "1", Size::Of(LIKELY), term).nonnegative();
                vec![Form::new("", vec![share])]
            };
            offers.add(Place::Rig, form(of_all));
            for &axis in &scene.axes {
                offers.add(Part::Joint(axis), form(Term::Law(axis, law(axis))));
            }
        }
        What::Positions => {}
    }
}
