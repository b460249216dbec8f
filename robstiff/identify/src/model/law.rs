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

/// What a change of the load goes on to make of what it made at once, by the time since it was put on: the share that
/// each row of a visit has in what a row yields further, by their numbers. A load is put on when the row before was
/// read; the first, as long before its row as the second row is after it.
pub fn shares_since(visit: &[usize], in_visit: &[f64], grows: &dyn Fn(f64) -> f64) -> Vec<Vec<(usize, f64)>> {
    let visits = visit.iter().max().map_or(0, |last| last + 1);
    let mut rows: Vec<Vec<usize>> = vec![Vec::new(); visits];
    visit.iter().enumerate().for_each(|(row, &visit)| rows[visit].push(row));
    let mut shares = vec![Vec::new(); visit.len()];
    for rows in rows {
        let read: Vec<f64> = rows.iter().map(|&row| in_visit[row]).collect();
        let first = read.get(1).map_or(A_MINUTE, |second| second - read[0]);
        let put_on = |k: usize| if k == 0 { read[0] - first } else { read[k - 1] };
        for (k, &row) in rows.iter().enumerate() {
            let grown = |of: usize| if of > k { 0.0 } else { grows(read[k] - put_on(of)) };
            // A load's change is in from its row on, and out from the next load's on.
            shares[row] = (0..=k).map(|of| (rows[of], grown(of) - grown(of + 1))).collect();
        }
    }
    shares
}

/// How long a load stays on where nothing is known of it (s).
const A_MINUTE: f64 = 60.0;

/// A joint of a compliance that goes on turning under its load.
pub fn turns_on(compliance: f64, grows: impl Fn(f64) -> f64 + 'static) -> Law {
    Rc::new(move |torques: &Torques<'_>| {
        let shares = shares_since(torques.visit, torques.in_visit, &grows);
        let turn = |of: &Vec<(usize, f64)>| of.iter().map(|(row, share)| compliance * share * torques.load[*row]).sum();
        shares.iter().map(turn).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Two loads of one visit: the first step lasts on while the second is new. Each visit starts unloaded.
    #[test]
    fn every_step_of_a_load_has_its_own_time() {
        let (visit, in_visit) = ([0, 0, 0, 1], [0.0, 10.0, 20.0, 0.0]);
        let load = [100.0, 300.0, 300.0, 50.0];
        let further = |row: usize| -> f64 {
            shares_since(&visit, &in_visit, &|t| t)[row].iter().map(|(of, share)| share * load[*of]).sum()
        };
        assert_eq!(further(0), 100.0 * 10.0);
        assert_eq!(further(1), 100.0 * 20.0 + 200.0 * 10.0);
        assert_eq!(further(2), 100.0 * 30.0 + 200.0 * 20.0);
        assert_eq!(further(3), 50.0 * A_MINUTE);
    }
}
