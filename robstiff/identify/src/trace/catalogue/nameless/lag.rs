//! A joint that lags: beside `h tau` it turns by `late L`, where `L` comes to the torque with
//! a time constant, `dL/dt = (tau - L) / constant`: grease and seals, a spring and a dashpot
//! side by side (Kelvin, Voigt) in line with the gear. Each visit begins at rest; the load
//! of a row is put on when the row before it was read.

use std::format;
use std::vec;
use std::vec::Vec;

use super::super::{Form, Kind, MORE_THAN_NONE, Number, Offers, Part, Scene, place_words};
use crate::campaign::Displacements;

/// The kind.
pub static KIND: Kind = Kind {
    name: "lag",
    of_rig: false,
    words: |found| {
        let unit = found.parameters.iter().find(|number| number.name == CONSTANT).map_or("", |number| number.unit);
        let plural = if unit == "row" { "s" } else { "" };
        let constant = found.value(CONSTANT);
        // Two digits at least; a grid that is searched tells no more.
        let decimals = (1.0 - constant.log10().floor()).clamp(0.0, 6.0) as usize;
        format!(
            "a lag of {}, which comes to rest with a time constant of {constant:.decimals$} {unit}{plural}",
            place_words(found)
        )
    },
    explanation: "",
    offer,
    on_axes: None,
};

const CONSTANT: &str = "constant";

/// The time constants tried, in steps from one row to the next. What has arrived long before the
/// next row looks like what sticks.
const CONSTANTS: [f64; 4] = [1.0, 2.0, 4.0, 8.0];

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let (_, pace) = scene.data.clock();
    if pace <= 0.0 {
        // One load a visit is as late everywhere.
        return;
    }
    let time = if scene.data.rows.iter().all(|row| row.time.is_some()) { "s" } else { "row" };
    let constants = CONSTANTS.map(|steps| steps * pace);
    let [first, .., last] = constants;
    for joint in (1..=scene.joints()).filter(|&joint| scene.largest_torque(joint).is_some()) {
        let unit = scene.compliance_unit(joint);
        let number = move |constant: f64| {
            Number::elastic("late", unit, MORE_THAN_NONE, move |point| {
                let late = arrived(point.data, &point.torques(joint), constant);
                point.of_joint(joint, |row| late[row])
            })
        };
        let forms = (0..).zip(constants).map(|(k, constant)| Form::of([k]).with(CONSTANT, constant, time));
        let forms = forms.map(|form| form.refined(move |constants| vec![number(constants[0])]));
        let forms = forms.map(|form| form.within([first, 2.0 * last])).collect();
        offers.add(Part::Joint(joint), constants.map(number).into(), forms);
    }
}

/// How much of the torque of each row has arrived when it is read.
fn arrived(data: &Displacements, torques: &[f64], constant: f64) -> Vec<f64> {
    let (clock, pace) = data.clock();
    let mut last = vec![None; data.visits.len()];
    let after = |(row, &torque): (usize, &f64)| {
        let last: &mut Option<(f64, f64)> = &mut last[data.rows[row].visit];
        let (since, stood) = last.unwrap_or((clock[row] - pace, 0.0));
        let held = (clock[row] - since).max(0.0);
        let stands = torque + (stood - torque) * (-held / constant).exp();
        *last = Some((clock[row], stands));
        stands
    };
    torques.iter().enumerate().map(after).collect()
}
