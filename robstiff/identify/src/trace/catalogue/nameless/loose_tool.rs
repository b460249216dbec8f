//! A flange, collet, taper or tool holder that is loose in its seat: along or about one of its
//! axes it goes by half the gap to the side of the load, `gap / 2 f / sqrt(f^2 + knee^2)`, where
//! `f` is the force along the axis or the moment about it.

use std::vec;
use std::vec::Vec;

use nalgebra::{Vector3, Vector6};

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

/// The knees tried, as fractions of the largest load along or about the axis.
const KNEES: [f64; 3] = [1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0];

/// A load along or about an axis that is less than this fraction of the largest wrench (N, Nm)
/// is rounding.
const NONE: f64 = 1e-6;

/// A way in which a seat can be loose, with the units of its gap and its knee.
#[derive(Clone, Copy)]
struct Way {
    /// The twist of the TCP with a unit of it, for an axis of the flange.
    twist: fn(&Sample, usize) -> Vector6<f64>,
    units: [&'static str; 2],
    /// More than this is no tool that cuts (m or rad).
    widest: f64,
}

const WAYS: [Way; 2] =
    [Way { twist: slide, units: ["m", "N"], widest: 2e-3 }, Way { twist: tilt, units: ["rad", "Nm"], widest: 1e-2 }];

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let (mut numbers, mut forms) = (Vec::new(), Vec::new());
    let wrench = scene.samples.rows.iter().map(|row| row.wrench.norm()).fold(0.0, f64::max);
    for way in WAYS {
        for axis in 0..3 {
            let load = |row: &Sample| (way.twist)(row, axis).dot(&row.wrench).abs();
            let largest = scene.samples.rows.iter().map(load).fold(0.0, f64::max);
            if largest <= NONE * wrench {
                continue;
            }
            for knee in KNEES.map(|fraction| fraction * largest) {
                let form = Form::of([numbers.len()]).with("knee", knee, way.units[1]);
                forms.push(form.refined(move |knees| vec![gap(way, axis, knees[0])]));
                numbers.push(gap(way, axis, knee));
            }
        }
    }
    if !forms.is_empty() {
        offers.add(Part::Tool, numbers, forms);
    }
}

/// A gap along or about an axis of the flange.
fn gap(Way { twist, units, widest }: Way, axis: usize, knee: f64) -> Number {
    Number::elastic("gap", units[0], [0.0, widest], move |point| {
        point.samples.stacked_by(|_, row| {
            let twist = twist(row, axis);
            let load = twist.dot(&row.wrench);
            row.read(&(twist * (0.5 * load / load.hypot(knee))))
        })
    })
}

/// Along an axis of the flange.
fn slide(row: &Sample, axis: usize) -> Vector6<f64> {
    stack(&along(row, axis), &Vector3::zeros())
}

/// About an axis of the flange, in its origin.
fn tilt(row: &Sample, axis: usize) -> Vector6<f64> {
    let (axis, lever) = (along(row, axis), row.tcp - row.flange);
    stack(&axis.cross(&lever.fixed_view::<3, 1>(0, 3).into_owned()), &axis)
}

/// An axis of the flange in the base frame.
fn along(row: &Sample, axis: usize) -> Vector3<f64> {
    row.flange.fixed_view::<3, 1>(0, axis).into_owned()
}
