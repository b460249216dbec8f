//! Slips beside poses held out, and slips that are not the only one.

use std::string::ToString;
use std::vec;

use nalgebra::Vector3;

use super::tests::{names, six_axis, traced};
use crate::campaign::made_positions::Plan;
use crate::campaign::{Holdout, PositionRow};
use crate::identify::holdout::training;
use crate::trace::Verdict;

/// Moves readings from some rows on, each by what comes to it then.
fn moved(shifts: &[(usize, [f64; 3])]) -> impl FnMut(usize, &mut PositionRow) {
    move |row: usize, read: &mut PositionRow| {
        let shift: Vector3<f64> =
            shifts.iter().filter(|(from, _)| row >= *from).map(|(_, by)| Vector3::from(*by)).sum();
        read.position = (Vector3::from(read.position) + shift).into();
    }
}

/// No row fitted to says on which side of a slip rows held out next to it are: they judge
/// nothing.
#[test]
fn rows_held_out_beside_a_slip_do_not_judge_it() {
    for seed in 1..5 {
        let plan = Plan::new(six_axis(), seed);
        let holdout = Some(Holdout { fraction: 0.25, seed });
        let fitted_to = training(plan.poses, holdout);
        // Of two such rows the slip is between.
        let between = (10..plan.poses - 10).find(|&row| !fitted_to[row - 1] && !fitted_to[row]);
        let moment = between.expect("neighbours among fifteen of sixty");
        let mut campaign = plan.run_with(moved(&[(moment, [1e-3, 0.0, -2e-4])]));
        campaign.holdout = holdout;
        let trace = traced(&campaign);
        assert_eq!((names(&trace), trace.verdict), (vec!["base_slip@base".to_string()], Verdict::Explained));
        // The header is line 1.
        assert!(trace.undecided.contains(&(moment + 1)) && trace.undecided.contains(&(moment + 2)));
        assert!(trace.undecided.len() < 8 && trace.after.holdout_rms < 5e-5, "{:?}", trace.after);
    }
}

/// A name says one moment: of a base that was put back the other is told, and no drift.
#[test]
fn a_slip_that_goes_back_is_not_explained_by_one() {
    let there = [3e-4, -2e-4, 1e-4];
    for seed in 1..4 {
        let back = there.map(|by: f64| -by);
        let trace = traced(&Plan::new(six_axis(), seed).run_with(moved(&[(20, there), (37, back)])));
        assert_eq!((trace.verdict, names(&trace)), (Verdict::Partial, vec!["base_slip@base".to_string()]));
        let line = if trace.effects[0].effect.value("line") == 22.0 { 39 } else { 22 };
        assert_eq!(trace.looks_like, [std::format!("another slip of the base before line {line}")]);
    }
}

/// Neither is one that comes three times.
#[test]
fn slips_time_and_again_are_structure() {
    for seed in 1..4 {
        let slips = [(14, [3e-4, 0.0, 0.0]), (29, [-3e-4, 3e-4, 0.0]), (44, [0.0, -3e-4, 3e-4])];
        let trace = traced(&Plan::new(six_axis(), seed).run_with(moved(&slips)));
        assert!(matches!(trace.verdict, Verdict::Partial | Verdict::Unexplained), "{} {:?}", trace.why, names(&trace));
    }
}

/// A tracker that stands elsewhere for some of the rows leaves more than noise.
#[test]
fn a_tracker_that_moved_in_between_is_told() {
    let moved = |row: usize, read: &mut PositionRow| {
        if row >= 30 {
            let [x, y, z] = read.position;
            read.position = [0.6 * x - 0.8 * y + 1.0, 0.8 * x + 0.6 * y, z];
        }
    };
    let trace = traced(&Plan::new(six_axis(), 1).run_with(moved));
    assert_eq!(trace.verdict, Verdict::Insufficient);
    assert!(trace.why.ends_with("or a tracker that moved in between"), "{}", trace.why);
}
