//! The deflection depends on the order of the loads: play operators between torque and turn.

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side, about_weight, near_found};
use crate::model::law::play;
use crate::model::{Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "hysteresis",
    side: Side::Robot,
    words: |place, _| format!("the hysteresis of {}", place.words()),
    explanation: "",
    offer,
};

/// Radii that are tried, over the largest torque; and of three operators together.
const RADII: [f64; 4] = [0.04, 0.08, 0.14, 0.25];
const THREE: [f64; 3] = [0.05, 0.15, 0.35];

/// The names of the numbers.
const WEIGHTS: [&str; 3] = ["weight1", "weight2", "weight3"];
const NAMES: [&str; 3] = ["radius1", "radius2", "radius3"];

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    // A visit of one load has no order.
    if scene.visits >= scene.visit.len() {
        return;
    }
    for joint in scene.turning().into_iter().filter(|&joint| scene.is_driven(joint)) {
        let largest = scene.torque[joint - 1];
        let size = 0.5 * scene.compliance[joint - 1];
        let form = |radii: &[f64]| {
            let weight = |(k, radius): (usize, &f64)| {
                let term = Term::Law(joint, play(radius * largest));
                Parameter::new(WEIGHTS[k], "rad/Nm", Size::Of(size), term).nonnegative()
            };
            let label: Vec<String> = radii.iter().map(|radius| format!("radius {radius}")).collect();
            let form = Form::new(label.join(", "), radii.iter().enumerate().map(weight).collect());
            let radii: Vec<f64> = radii.iter().map(|radius| radius * largest).collect();
            let form = radii.iter().enumerate().fold(form, |form, (k, radius)| form.with(NAMES[k], *radius, "Nm"));
            form.written(move |weights| written(joint, &radii, weights))
        };
        let grid = RADII.iter().map(|radius| form(&[*radius])).chain([form(&THREE)]);
        let between = near_found(scene, NAMES[0], Part::Joint(joint), |radius| form(&[radius / largest]));
        offers.add(Part::Joint(joint), about_weight(scene, grid.chain(between).collect()));
    }
}

/// Operators without weight have no part.
fn written(joint: usize, radii: &[f64], weights: &[f64]) -> Vec<Effect> {
    let mut own: Vec<(f64, f64)> =
        radii.iter().copied().zip(weights.iter().copied()).filter(|(_, w)| *w > 0.0).collect();
    own.resize(3, (0.0, 0.0));
    let [(radius1, weight1), (radius2, weight2), (radius3, weight3)] = own[..] else { return Vec::new() };
    if weight1 == 0.0 {
        return Vec::new();
    }
    vec![Effect::Hysteresis { joint, radius1, weight1, radius2, weight2, radius3, weight3 }]
}
