//! Of a clamped axis: its unloaded reading is off, from the first row on or from a later one.

use std::rc::Rc;

use robstiff_robots::Place as Part;

use super::base_slip::FROM;
use super::scene::What;
use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "unloaded_reading",
    side: Side::Rig,
    words: |place, _| format!("an unloaded reading of {} that is off", place.words()),
    explanation: "The angle that the axis has without a load is not the one that was taken as zero, or the dial shifted \
        between two rows. Read the unloaded axis before and after every load.",
    offer,
};

/// The likely part of the axis's stroke.
const LIKELY: f64 = 0.05;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if scene.what != What::Clamped {
        return;
    }
    for (k, &axis) in scene.axes.iter().enumerate() {
        let rows: Vec<usize> = (0..scene.visit.len()).filter(|&row| scene.visit[row] == k).collect();
        let size = LIKELY * scene.compliance[axis - 1] * scene.torque[axis - 1];
        let form = |&from: &usize| {
            let own = rows.clone();
            let of = move |at: &At<'_>| {
                let after = at.row >= from && own.contains(&at.row);
                nalgebra::Vector3::x() * if after { 1.0 } else { 0.0 }
            };
            let unit = if scene.turns(axis) { "rad" } else { "m" };
            let shift = Parameter::new("offset", unit, Size::Of(size), Term::Reading(Rc::new(of)));
            Form::new(format!("from row {from}"), vec![shift]).with(FROM, scene.line(from), "1")
        };
        // One row alone at the end is an outlier.
        let last = rows.len().saturating_sub(1);
        offers.add(Part::Joint(axis), rows.iter().take(last).map(form).collect());
    }
}
