//! A flange, collet or tool holder that is loose in its seat along one of its axes: it goes by
//! half the gap to the side of the force, `gap / 2 f / sqrt(f^2 + knee^2)`.

use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;

use super::super::{Form, Kind, Number, Offers, Part, Scene};
use crate::identify::samples::{Sample, stack};

/// The kind.
pub static KIND: Kind = Kind {
    name: "loose_tool",
    of_rig: false,
    words: |_| "a flange or tool that is loose in its seat".into(),
    explanation: "",
    offer,
    on_axes: None,
};

/// The knees tried, as fractions of the largest force along the axis.
const KNEES: [f64; 3] = [1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0];

/// More than this is no tool that cuts (m).
const WIDEST: f64 = 2e-3;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let (mut numbers, mut forms) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        let along = |row: &Sample| push(row, axis).1;
        let largest = scene.samples.rows.iter().map(|row| along(row).abs()).fold(0.0, f64::max);
        if largest <= 0.0 {
            continue;
        }
        for knee in KNEES.map(|fraction| fraction * largest) {
            let number = move |knee: f64| {
                Number::elastic("gap", "m", [0.0, WIDEST], move |point| {
                    point.samples.stacked_by(|_, row| {
                        let (axis, force) = push(row, axis);
                        row.read(&stack(&(axis * (0.5 * force / force.hypot(knee))), &Vector3::zeros()))
                    })
                })
            };
            let form = Form::of([numbers.len()]).with("knee", knee, "N");
            forms.push(form.refined(move |knees| vec![number(knees[0])]));
            numbers.push(number(knee));
        }
    }
    if !forms.is_empty() {
        offers.add(Part::Tool, numbers, forms);
    }
}

/// An axis of the flange in the base frame, and the force along it (N).
fn push(row: &Sample, axis: usize) -> (Vector3<f64>, f64) {
    let axis: Vector3<f64> = row.flange.fixed_view::<3, 1>(0, axis).into_owned();
    (axis, axis.dot(&row.wrench.fixed_rows::<3>(0)))
}
