//! Without a name: readings that grow or shrink with the place where they are read.

use std::rc::Rc;

use nalgebra::Vector3;

use super::scene::What;
use super::{Form, Kind, Offers, Place, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "grows_with_place",
    side: Side::Unnamed,
    words: |_, _| {
        "readings that change with the place (a force or a measurement that depends on where the arm is)".into()
    },
    explanation: "Nothing in the catalogue is like this. Check cables, hoses and the line of sight of the instrument.",
    offer,
};

/// The likely part over a metre (1), and what positions are likely to bend by over a square metre (m).
const LIKELY: f64 = 0.05;
const LIKELY_BEND: f64 = 2e-4;

const NAMES: [&str; 3] = ["x", "y", "z"];

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    match scene.what {
        What::Displacements => {
            let share = |k: usize| {
                let grows = move |at: &At<'_>| at.place[k];
                Parameter::new(NAMES[k], "1/m", Size::Of(LIKELY), Term::Gain(Rc::new(grows)))
            };
            offers.add(Place::Rig, vec![Form::new("", (0..3).map(share).collect())]);
        }
        What::Positions => {
            let products = (0..3).flat_map(|a| (a..3).map(move |b| (a, b)));
            let bend = |(a, b): (usize, usize)| {
                let along = move |k: usize| {
                    let of = move |at: &At<'_>| Vector3::ith(k, at.place[a] * at.place[b]);
                    Parameter::new("bend", "1/m", Size::Of(LIKELY_BEND), Term::Reading(Rc::new(of)))
                };
                (0..3).map(along).collect::<Vec<_>>()
            };
            offers.add(Place::Rig, vec![Form::new("", products.flat_map(bend).collect())]);
        }
        What::Clamped => {}
    }
}
