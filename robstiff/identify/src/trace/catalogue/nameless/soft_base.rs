//! A mat or anchors under the foot that harden: it tilts by `tilt m / sqrt(1 + (|m| / knee)^2)`
//! about the axes across that of joint 1, under the moment `m` about them.

use std::vec;

use nalgebra::Vector3;

use super::super::{Form, Kind, MORE_THAN_NONE, Number, Offers, Part, Scene};
use crate::identify::samples::{Sample, stack};

/// The kind.
pub static KIND: Kind = Kind {
    name: "hardening_base",
    of_rig: false,
    words: |_| "a foundation that hardens with the load".into(),
    explanation: "",
    offer,
    on_axes: None,
};

/// The knees tried, as fractions of the largest moment.
const KNEES: [f64; 4] = [1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0];

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let largest = scene.samples.rows.iter().map(|row| moment(row).norm()).fold(0.0, f64::max);
    if largest <= 0.0 {
        return;
    }
    let knees = KNEES.map(|fraction| fraction * largest);
    let number = |knee: f64| {
        Number::elastic("tilt", "rad/Nm", MORE_THAN_NONE, move |point| {
            point.samples.stacked_by(|_, row| {
                let moment = moment(row);
                let turn = moment / (moment.norm() / knee).hypot(1.0);
                row.read(&stack(&turn.cross(&lever(row)), &turn))
            })
        })
    };
    let forms = (0..).zip(knees).map(|(k, knee)| Form::of([k]).with("knee", knee, "Nm"));
    let forms = forms.map(|form| form.refined(move |knees| vec![number(knees[0])])).collect();
    offers.add(Part::Base, knees.map(number).into(), forms);
}

/// From the foot to the TCP (m).
pub fn lever(row: &Sample) -> Vector3<f64> {
    (row.tcp - row.base).fixed_view::<3, 1>(0, 3).into_owned()
}

/// The moment at the foot about the axes of frame 0 that lie in the floor, in the base frame (Nm).
pub fn moment(row: &Sample) -> Vector3<f64> {
    let [force, moment] = [0, 3].map(|k| row.wrench.fixed_rows::<3>(k).into_owned());
    let whole = moment + lever(row).cross(&force);
    let up: Vector3<f64> = row.base.fixed_view::<3, 1>(0, 2).into_owned();
    whole - up * up.dot(&whole)
}
