//! Hysteresis: the joint turns by `sum w_r P_r` on top of `h tau`, with play
//! operators `P_r(k) = max(tau - r, min(tau + r, P_r(k - 1)))` on its torque in
//! the order of the loads (Prandtl and Ishlinskii), linear in their weights.
//! Each visit begins at rest with its unloaded reading.

use std::format;
use std::vec;
use std::vec::Vec;

use super::{Form, Kind, Number, Offers, Part, Scene, place_words};
use crate::identify::column::Column;
use crate::trace::clamped::{Axes, AxisNumber, OnAxes, axes_column};
use robstiff::elements::Torque;

/// The kind.
pub static KIND: Kind = Kind {
    name: "hysteresis",
    of_rig: false,
    words: |found| format!("the hysteresis of {}", place_words(found)),
    explanation: "",
    offer,
    on_axes: Some(on_axes),
};

/// The radii tried, as fractions of the largest torque seen on the joint; up to
/// three of them together.
const RADII: [f64; 5] = [1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0];
const MOST: u32 = 3;

const NAMES: [&str; 3] = ["weight1", "weight2", "weight3"];
const OF_RADII: [&str; 3] = ["radius1", "radius2", "radius3"];

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for joint in 1..=scene.joints() {
        let Some(largest) = scene.largest_torque(joint) else {
            offers.invisible(Part::Joint(joint));
            continue;
        };
        if !is_told(scene, joint) {
            offers.invisible(Part::Joint(joint));
            continue;
        }
        let (unit, torque) = (scene.compliance_unit(joint), if scene.turns(joint) { "Nm" } else { "N" });
        let radii = RADII.map(|fraction| fraction * largest);
        let number = move |radius: f64| {
            Number::elastic("weight", unit, [0.0, f64::INFINITY], move |point| {
                let plays = point.samples.plays(joint, radius);
                point.of_joint(joint, |row| plays[row])
            })
        };
        let form = |set: u32| {
            let own: Vec<usize> = (0..RADII.len()).filter(|&k| set >> k & 1 == 1).collect();
            let form = Form { names: &NAMES, ..Form::of(own.iter().copied()) };
            let form = form.refined(move |radii| radii.iter().map(|&radius| number(radius)).collect());
            own.iter().zip(OF_RADII).fold(form, |form, (&k, name)| form.with(name, radii[k], torque))
        };
        let sets = (1..1_u32 << RADII.len()).filter(|set| set.count_ones() <= MOST);
        let numbers: Vec<Number> = radii.map(number).into();
        offers.add(Part::Joint(joint), numbers, sets.map(form).collect());
    }
}

/// Whether a campaign tells the hysteresis of a joint (from 1) from a dead zone: it does where
/// the torque goes back in a visit. A play operator that comes from rest is `tau - r` beyond
/// `r`, and a joint with some is softer at large torques, no more.
pub fn is_told(scene: &Scene<'_>, joint: usize) -> bool {
    let (torques, rows) = (scene.samples.torques(joint), &scene.data.rows);
    let mut visits = vec![Vec::new(); scene.data.visits.len()];
    rows.iter().zip(&torques).for_each(|(row, &torque)| visits[row.visit].push(torque));
    let largest = scene.largest_torque(joint).unwrap_or(0.0);
    visits.iter().any(|visit| goes_back(visit, largest))
}

/// Whether torques in the order of loading, from rest, go back by so much that the operator of
/// the smallest radius notices: by twice that.
fn goes_back(torques: &[f64], largest: f64) -> bool {
    let mut farthest = 0.0_f64;
    torques.iter().any(|&torque| {
        if torque * farthest >= 0.0 && torque.abs() >= farthest.abs() {
            farthest = torque;
        }
        (farthest - torque).abs() > 2.0 * RADII[0] * largest
    })
}

/// The same of a clamped axis.
pub fn is_told_on(axes: &Axes, axis: usize) -> bool {
    goes_back(&axes.torques(axis), axes.largest(axis))
}

/// An axis begins at rest; its rows follow each other.
fn on_axes(axes: &Axes) -> Vec<OnAxes> {
    let of = |axis: usize, radii: &[f64]| {
        let torques = axes.loads(axis);
        let (at, count) = (axes.rows_of(axis), axes.rows.len());
        let number = |name| AxisNumber { name, unit: axes.unit(axis), range: [0.0, f64::INFINITY] };
        let numbers = NAMES[..radii.len()].iter().copied().map(number).collect();
        let shape: Vec<_> = OF_RADII[..radii.len()].iter().map(|&name| (name, axes.torque_unit(axis))).collect();
        OnAxes::new(Part::Joint(axis), numbers, &shape, vec![radii.to_vec()], move |radii| {
            let of_radius = |&radius: &f64| {
                let play = Column::Play { joint: axis, operator: 0, radius };
                let mut state = 0.0;
                let after = |&torque: &f64| {
                    state = play.after(Torque::of(torque), state);
                    state
                };
                axes_column(count, &at, torques.iter().map(after))
            };
            radii.iter().map(of_radius).collect()
        })
    };
    let sets = || (1..1_u32 << RADII.len()).filter(|set| set.count_ones() <= MOST);
    let radii = |set: u32, largest: f64| -> Vec<f64> {
        (0..RADII.len()).filter(|&k| set >> k & 1 == 1).map(|k| RADII[k] * largest).collect()
    };
    let of_axis = |axis: usize| {
        let forms = sets().map(|set| of(axis, &radii(set, axes.largest(axis))));
        OnAxes::one_of(forms.collect())
    };
    axes.loaded().filter(|&axis| is_told_on(axes, axis)).filter_map(of_axis).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_torques_that_go_back_tell_a_play_from_a_dead_zone() {
        let back = |torques: &[f64]| goes_back(torques, 100.0);
        assert!(!back(&[]) && !back(&[100.0]) && !back(&[20.0, 50.0, 50.0, 100.0]) && !back(&[-20.0, -100.0]));
        assert!(!back(&[20.0, 100.0, 96.0]), "less than any operator notices");
        assert!(back(&[20.0, 100.0, 60.0]) && back(&[-100.0, -60.0]) && back(&[20.0, -20.0]));
    }
}
