//! The load cell's zero is off: `b` acts on top of what the file says, constant
//! in the base frame or in the tool's.

use std::format;
use std::vec::Vec;

use super::{Form, Kind, Number, Offers, Place, Scene, WRENCH_STEP, frame_words};
use crate::trace::clamped::{Axes, AxisNumber, OnAxes, axes_column};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_cell_bias",
    of_rig: true,
    words: |found| match found.parameters.iter().any(|number| number.name == TORQUE) {
        true => "a bias of the torque".into(),
        false => format!("a bias of the load cell, constant in the {}", frame_words(found)),
    },
    explanation: "What acts is more than the file says, by the same at every load: the load cell was not tared, or the \
        weight of hook and cable is not in the file. Add these numbers, with their signs, to the loads in the file, or \
        tare it unloaded at the pose and measure anew.",
    offer,
    on_axes: Some(on_axes),
};

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    // A bias beyond the loads is no bias.
    let force = |row: &crate::identify::samples::Sample| row.wrench.fixed_rows::<3>(0).norm();
    let most = scene.samples.rows.iter().map(force).fold(0.0, f64::max);
    let number = |k: usize| {
        Number::of_setup(
            ["Fx", "Fy", "Fz"][k % 3],
            "N",
            most,
            move |setup, bias| {
                let cell = if k < 3 { &mut setup.in_base } else { &mut setup.in_tool };
                cell.bias[k % 3] += bias;
            },
            |point, enters| point.of_wrench(&**enters, WRENCH_STEP),
        )
    };
    let forms = [Form::of(0..3), Form::of(3..6).in_tool()].into();
    offers.add(Place::Rig, (0..6).map(number).collect(), forms);
}

/// Of a torque that is read: every axis stands aside by what it does to it.
fn on_axes(axes: &Axes) -> Vec<OnAxes> {
    let most = axes.loaded().map(|axis| axes.largest(axis)).fold(0.0, f64::max);
    let aside: Vec<(Vec<usize>, f64)> =
        axes.loaded().map(|axis| (axes.rows_of(axis), axes.compliance[axis - 1])).collect();
    let count = axes.rows.len();
    // All axes of a campaign turn, or all slide.
    let unit = axes.loaded().next().map_or("Nm", |axis| axes.torque_unit(axis));
    let numbers = [AxisNumber { name: TORQUE, unit, range: [-most, most] }].into();
    let bias = OnAxes::new(Place::Rig, numbers, &[], [Vec::new()].into(), move |_| {
        let of = |(rows, turn): &(Vec<usize>, f64)| axes_column(count, rows, rows.iter().map(|_| *turn));
        [aside.iter().map(of).sum()].into()
    });
    [bias].into()
}

const TORQUE: &str = "torque";
