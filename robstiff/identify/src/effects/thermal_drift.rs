//! The readings drift with the temperature or with the time.

use super::scene::What;
use super::{Form, Kind, Offers, Place, SHIFT, Scene, Side, three_readings};
use crate::model::{Parameter, Size};

/// The kind.
pub static KIND: Kind = Kind {
    name: "thermal_drift",
    side: Side::Rig,
    words: |_, _| "a drift of the readings".into(),
    explanation: "The readings move while nothing pulls: the robot or the stand of the tracker warms up, or settles. \
        Warm up before, read the unloaded arm at every visit, and mix the order of poses.",
    offer,
};

/// What readings are likely to drift by: over a kelvin (m), and over the campaign (m); and by how much
/// they are off where it begins (m).
const BY_KELVIN: f64 = 2.5e-5;
const BY_TIME: f64 = 1e-4;
const FROM: f64 = 5e-5;

/// Time constants of what settles that are tried, over the time of the campaign.
const SETTLES: [f64; 3] = [0.05, 0.15, 0.5];

/// The time constant over the time of the campaign.
const CONSTANT: &str = "constant";

/// Less warmth tells nothing (K).
const COLD: f64 = 0.2;

/// Fewer visits tell no drift from what is off at each.
pub(super) const FEWEST_VISITS: usize = 8;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what == What::Clamped {
        offers.add(Place::Rig, vec![of_clamped(scene)]);
        return;
    }
    if scene.visits < FEWEST_VISITS {
        return;
    }
    let offset = three_readings(["x0", "y0", "z0"], "m", FROM, |_| 1.0);
    let with = |label: &str, of: Vec<Parameter>| -> Vec<Form> {
        let mut forms = vec![Form::new(label, of.clone())];
        // Where absolute positions begin is where the robot stands.
        if scene.what != What::Positions {
            let of = of.into_iter().chain(offset.clone());
            forms.push(Form::new(format!("{label}, from elsewhere"), of.collect()));
        }
        forms
    };
    let mut forms = Vec::new();
    if scene.warmth > COLD {
        forms.extend(with("with the temperature", three_readings(SHIFT, "m/K", BY_KELVIN, |at| at.warmer)));
    }
    forms.extend(with("with the time", three_readings(SHIFT, "m", BY_TIME, |at| at.time)));
    let settling = |constant: f64| {
        let settled = move |at: &crate::model::At<'_>| -(-at.time / constant).exp_m1();
        let forms = with(&format!("settling within {constant}"), three_readings(SHIFT, "m", BY_TIME, settled));
        forms.into_iter().map(move |form| form.with(CONSTANT, constant, "1"))
    };
    forms.extend(SETTLES.into_iter().flat_map(settling));
    let found = scene.found(CONSTANT, Place::Rig).into_iter();
    forms.extend(found.flat_map(settling).map(|form| Form { between: true, ..form }));
    if scene.what == What::Positions && scene.warmth > COLD {
        forms.push(growth());
    }
    offers.add(Place::Rig, forms);
}

/// What a reading is likely to drift by while an axis is loaded (rad, m).
const OF_AXIS: f64 = 2e-5;

/// The reading of each clamped axis drifts alike, from its first load to the last of the longest sequence.
fn of_clamped(scene: &Scene<'_>) -> Form {
    let rows = |k: usize| scene.visit.iter().filter(|visit| **visit == k).count();
    let longest = 60.0 * (0..scene.axes.len()).map(rows).max().unwrap_or(1).max(2) as f64;
    let of = move |at: &crate::model::At<'_>| nalgebra::Vector3::x() * (at.in_visit / longest);
    let term = crate::model::Term::Reading(std::rc::Rc::new(of));
    let unit = if scene.axes.iter().all(|&axis| scene.turns(axis)) { "rad" } else { "m" };
    Form::new("", vec![Parameter::new("drift", unit, Size::Of(OF_AXIS), term)])
}

/// Everything grows with the warmth, away from the base.
fn growth() -> Form {
    let of = |at: &crate::model::At<'_>| at.stand.tcp.at * at.warmer;
    let term = crate::model::Term::Reading(std::rc::Rc::new(of));
    Form::new("growth", vec![Parameter::new("growth", "1/K", Size::Of(1.5e-5), term)])
}
