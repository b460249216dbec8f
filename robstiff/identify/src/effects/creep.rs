//! The arm goes on yielding under a load that stays on.

use std::rc::Rc;

use robstiff_robots::Place as Part;

use super::scene::What;
use super::{Form, Kind, Offers, Place, Scene, Side};
use crate::model::{At, Parameter, Size, Term, Torques};

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

/// The time after which it is seen (s).
const ONSET: f64 = 60.0;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.visits >= scene.visit.len() {
        return;
    }
    match scene.what {
        What::Displacements => {
            let grows = |at: &At<'_>| (at.in_visit / ONSET).ln_1p();
            let share = Parameter::new("share", "1", Size::Of(LIKELY), Term::Gain(Rc::new(grows))).nonnegative();
            offers.add(Place::Rig, vec![Form::new("", vec![share])]);
        }
        What::Clamped => {
            let own = scene.compliance.clone();
            let law = move |joint: usize, torques: &Torques<'_>| crept(torques, own[joint - 1]);
            let share = Parameter::new("share", "1", Size::Of(LIKELY), Term::Laws(Rc::new(law))).nonnegative();
            offers.add(Place::Rig, vec![Form::new("", vec![share])]);
            for &axis in &scene.axes {
                let own = scene.compliance[axis - 1];
                let law = move |torques: &Torques<'_>| crept(torques, own);
                let share = Parameter::new("share", "1", Size::Of(LIKELY), Term::Law(axis, Rc::new(law))).nonnegative();
                offers.add(Part::Joint(axis), vec![Form::new("", vec![share])]);
            }
        }
        What::Positions => {}
    }
}

/// Every step of a load goes on turning the joint by the time since it was made.
fn crept(torques: &Torques<'_>, own: f64) -> Vec<f64> {
    let load = torques.load;
    let step = |k: usize| load[k] - if k == 0 { 0.0 } else { load[k - 1] };
    let grown = |row: usize| -> f64 {
        let since = |k: usize| (row - k + 1) as f64;
        (0..=row).map(|k| own * step(k) * since(k).ln_1p()).sum()
    };
    (0..load.len()).map(grown).collect()
}
