//! Laws of joints: how far one turns under its torque, where that is not linear.

use std::rc::Rc;

use robstiff::Effect;
use robstiff::elements::{Torque, turn};

use super::Torques;
use super::term::Law;

/// The play operator of a radius (Nm). Each visit begins on an arm at rest.
pub fn play(radius: f64) -> Law {
    Rc::new(move |torques: &Torques<'_>| {
        let visits = torques.visit.iter().max().map_or(0, |last| last + 1);
        let mut states: Vec<Option<f64>> = vec![None; visits];
        let after = |(row, &load): (usize, &f64)| {
            let rest = torques.preload[row];
            // Where it rests under the arm's own weight.
            let settled = 0_f64.min(rest + radius).max(rest - radius);
            let before = states[torques.visit[row]].unwrap_or(settled);
            let state = before.min(rest + load + radius).max(rest + load - radius);
            states[torques.visit[row]] = Some(state);
            state - settled
        };
        torques.load.iter().enumerate().map(after).collect()
    })
}

/// A law about all of the weight that a gear carries, where a description declares no preload.
pub fn under_weight(law: Law) -> Law {
    Rc::new(move |torques: &Torques<'_>| law(&Torques { preload: torques.weight, ..*torques }))
}

/// The law of an effect that does not depend on the order of loads and whose number is one.
pub fn unit_law(effect: Effect) -> Law {
    Rc::new(move |torques: &Torques<'_>| {
        let of = |row: usize| {
            let torque = Torque { preload: torques.preload[row], load: torques.load[row] };
            turn(&effect, 0.0, torques.q[row], torque, [0.0; 3]).unwrap_or(0.0)
        };
        (0..torques.load.len()).map(of).collect()
    })
}
