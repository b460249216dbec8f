//! A joint whose compliance varies with its own coordinate (gears, gravity
//! compensator): it turns by `h (1 + cos1 cos q + sin1 sin q + cos2 cos 2q + sin2
//! sin 2q) tau`.

use std::format;
use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use super::{Form, Kind, Number, Offers, Part, Scene, place_words};

/// The kind.
pub static KIND: Kind = Kind {
    name: "pose_dependent_compliance",
    of_rig: false,
    words: |found| format!("the change of the compliance of {} with its own angle", place_words(found)),
    explanation: "",
    offer,
    on_axes: None,
};

const NAMES: [&str; 4] = ["cos1", "sin1", "cos2", "sin2"];

fn wave(k: usize, q: f64) -> f64 {
    let angle = if k < 2 { q } else { 2.0 * q };
    if k.is_multiple_of(2) { angle.cos() } else { angle.sin() }
}

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    for joint in (1..=scene.joints()).filter(|&joint| scene.turns(joint)) {
        if scene.largest_torque(joint).is_none() {
            offers.invisible(Part::Joint(joint));
            continue;
        }
        let number = |k: usize| {
            let any = [f64::NEG_INFINITY, f64::INFINITY];
            let number = Number::elastic(NAMES[k], "1", any, move |point| {
                let torques = point.torques(joint);
                point.of_joint(joint, |row| wave(k, point.data.rows[row].q[joint - 1]) * torques[row])
            });
            Number { share_of: Some(joint), ..number }
        };
        let forms = vec![Form::of([0, 1]), Form::of([2, 3]), Form::of([0, 1, 2, 3])];
        let numbers: Vec<Number> = (0..4).map(number).collect();
        // At the angles that were measured; elsewhere nothing is known of it.
        let angles: Vec<f64> = scene.data.rows.iter().map(|row| row.q[joint - 1]).collect();
        let check = move |numbers: &[(&str, f64)], of: &dyn Fn(usize) -> f64| {
            let part =
                |q: f64| move |(name, b): &(&str, f64)| NAMES.iter().position(|n| n == name).map(|k| b * wave(k, q));
            let at = |q: f64| of(joint) + numbers.iter().filter_map(part(q)).sum::<f64>();
            let physical = angles.iter().all(|&q| at(q) > 0.0);
            physical
                .then_some(())
                .ok_or_else(|| format!("joint {joint} would have a negative compliance at some angle"))
        };
        offers.add_checked(Part::Joint(joint), numbers, forms, Some(Rc::new(check)));
    }
}
