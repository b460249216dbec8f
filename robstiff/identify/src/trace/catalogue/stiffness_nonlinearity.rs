//! Hardening or softening of a joint with torque: it turns by `added tau /
//! sqrt(1 + (tau / knee)^2)` on top of `h tau`.

use std::format;
use std::rc::Rc;
use std::vec::Vec;

use super::lost_motion::EITHER;
use super::{Form, Kind, Number, Offers, Part, Scene, place_words};
use crate::identify::column::Column;
use crate::trace::clamped::{Axes, AxisNumber, OnAxes};

/// The kind.
pub static KIND: Kind = Kind {
    name: "stiffness_nonlinearity",
    of_rig: false,
    words: |found| {
        let change = if found.value("added") < 0.0 { "softening" } else { "hardening" };
        format!("the {change} of {} with torque", place_words(found))
    },
    explanation: "",
    offer,
    on_axes: Some(on_axes),
};

/// The knees tried, as fractions of the largest torque that the gear carries. A
/// knee above it bends too little to be told from a joint; a change that is
/// over before the loads begin is a step at zero torque, which is
/// `lost_motion` and has the knees below.
pub const KNEES: [f64; 4] = [1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0, 1.0];

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for joint in 1..=scene.joints() {
        let Some(largest) = scene.largest_carried(joint) else {
            offers.invisible(Part::Joint(joint));
            continue;
        };
        let unit = scene.compliance_unit(joint);
        let number = move |knee: f64| {
            Number::elastic("added", unit, [f64::NEG_INFINITY, f64::INFINITY], move |point| {
                point.samples.column(Column::Knee { joint, knee })
            })
        };
        let knees = KNEES.map(|fraction| fraction * largest);
        let torque = if scene.turns(joint) { "Nm" } else { "N" };
        let forms = (0..).zip(knees).map(|(k, knee)| Form::of([k]).with("knee", knee, torque));
        let forms = forms.map(|form| form.refined(move |knees| [number(knees[0])].into()));
        let forms = forms.map(|form| form.within([EITHER[0] * largest, f64::INFINITY])).collect();
        let check = move |numbers: &[(&str, f64)], of: &dyn Fn(usize) -> f64| {
            (numbers[0].1 > -of(joint))
                .then_some(())
                .ok_or_else(|| format!("the unloaded joint {joint} would have a negative compliance"))
        };
        let numbers: Vec<Number> = knees.map(number).into();
        offers.add_checked(Part::Joint(joint), numbers, forms, Some(Rc::new(check)));
    }
}

fn on_axes(axes: &Axes) -> Vec<OnAxes> {
    let of = |axis: usize| {
        let range = [-axes.compliance[axis - 1], f64::INFINITY];
        let number = AxisNumber { name: "added", unit: axes.unit(axis), range };
        let curve = |joint: usize, knee: f64| Column::Knee { joint, knee };
        OnAxes::with_knee(axes, axis, number, [&KNEES, &[EITHER[0], f64::INFINITY]], curve)
    };
    axes.loaded().map(of).collect()
}
