//! A foundation that tilts more about one of its axes than about the other, as a plate on two beams
//! or a pedestal that is wider one way: about x and y of frame 0, each by a compliance of its own.

use std::vec;

use nalgebra::Vector3;

use super::super::{Form, Kind, MORE_THAN_NONE, Number, Offers, Part, Scene};
use super::soft_base::{lever, moment};
use crate::identify::samples::stack;

/// The kind.
pub static KIND: Kind = Kind {
    name: "uneven_base",
    of_rig: false,
    words: |_| "a foundation that tilts more about one axis than about the other".into(),
    explanation: "",
    offer,
    on_axes: None,
};

fn offer(_: &Scene<'_>, offers: &mut Offers<'_>) {
    let tilt = |name: &'static str, axis: usize| {
        Number::elastic(name, "rad/Nm", MORE_THAN_NONE, move |point| {
            point.samples.stacked_by(|_, row| {
                let about: Vector3<f64> = row.base.fixed_view::<3, 1>(0, axis).into_owned();
                let turn = about * about.dot(&moment(row));
                row.read(&stack(&turn.cross(&lever(row)), &turn))
            })
        })
    };
    let shift = |name: &'static str, axis: usize| {
        Number::elastic(name, "m/N", MORE_THAN_NONE, move |point| {
            point.samples.stacked_by(|_, row| {
                let along: Vector3<f64> = row.base.fixed_view::<3, 1>(0, axis).into_owned();
                let force = row.wrench.fixed_rows::<3>(0).into_owned();
                row.read(&stack(&(along * along.dot(&force)), &Vector3::zeros()))
            })
        })
    };
    let numbers = vec![tilt("tilt_x", 0), tilt("tilt_y", 1), shift("x", 0), shift("y", 1), shift("z", 2)];
    // About one axis alone, about both, and with the shifts that go with it.
    let forms = [&[0][..], &[1], &[0, 1], &[0, 1, 2, 3, 4]].map(|of| Form::of(of.iter().copied()));
    offers.add(Part::Base, numbers, forms.into());
}
