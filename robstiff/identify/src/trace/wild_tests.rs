//! What tracing makes of readings that do not belong.

use std::vec;

use super::tests::{SIGMA, TILT_3, campaign, names, traced};
use super::*;
use crate::campaign::made::Plan;
use crate::campaign::{Data, Holdout};
use robstiff_robots::samples::five_axis;

/// A campaign with a shift (standard deviations) along z in some of its rows.
fn shifted(hidden: &[(crate::identify::column::Column, f64)], rows: &[usize], shift: f64) -> Campaign {
    let mut campaign = campaign(&five_axis(), 24, hidden, 3);
    if let Data::Displacement(data) = &mut campaign.data {
        rows.iter().for_each(|&row| data.rows[row].displacement[2] += shift * SIGMA);
    }
    campaign
}

/// Wild rows are told by their lines, and do not vote for an effect.
#[test]
fn wild_rows_are_told_and_left_out() {
    let found = traced(&shifted(&[TILT_3], &[11, 90, 203], 60.0));
    assert_eq!(names(&found), ["transverse_compliance@joint 3", "outliers@rig"]);
    assert_eq!(found.effects[1].lines, [13, 92, 205]);
    let h = &found.effects[0].effect.parameters[0];
    assert!((h.value - TILT_3.1).abs() < 4.0 * h.std.expect("a compliance has one"), "{h:?}");
}

/// However far off: a reading of metres moves the whole fit, and the others would look wild.
#[test]
fn a_row_that_moves_the_whole_fit_is_told() {
    for shift in [3e3, 3e5] {
        let found = traced(&shifted(&[TILT_3], &[11], shift));
        assert_eq!(names(&found), ["transverse_compliance@joint 3", "outliers@rig"]);
        assert_eq!((found.verdict, &found.effects[1].lines), (Verdict::Explained, &vec![13]));
    }
}

/// Rows that stand out from noise, but not from what structure might leave, are no structure:
/// the other readings of their own pose contradict them.
#[test]
fn rows_that_their_own_pose_contradicts_are_no_structure() {
    let found = traced(&shifted(&[], &[11, 90, 203], 12.0));
    assert_eq!((names(&found), found.verdict), (vec!["outliers@rig".into()], Verdict::Explained));
    assert_eq!(found.effects[0].lines, [13, 92, 205]);
}

/// One load at each of few poses, of which nothing but a fit tells the noise; a row is off
/// along z by so much (m).
fn one_load(poses: usize, seed: u64, off: Option<(usize, f64)>) -> Campaign {
    let mut campaign =
        Plan { poses, visits: 1, ramp: vec![1.0], shares_unloaded: false, noise: [SIGMA; 3], ..Plan::new(seed) }.run();
    if let (Data::Displacement(data), Some((row, off))) = (&mut campaign.data, off) {
        data.rows[row].displacement[2] += off;
    }
    campaign
}

/// Where no other reading at its pose contradicts it, a row of few moves the fit and hides in
/// what that leaves of all others.
#[test]
fn a_row_alone_at_its_pose_cannot_hide() {
    for (seed, off) in (1..=6).flat_map(|seed| [6e-4, 5e-3].map(|off| (seed, off))) {
        let found = traced(&one_load(15, seed, Some((3, off))));
        let told = (names(&found), found.verdict);
        // One load a pose, and no noise declared: nothing but the fit says how large it is.
        assert_eq!(told, (vec!["outliers@rig".into()], Verdict::Partial), "{off} m, seed {seed}: {}", found.why);
        assert_eq!(found.effects[0].lines, [5], "{off} m, seed {seed}");
    }
}

/// Each is judged by how well the others say what it is.
#[test]
fn rows_alone_at_their_poses_that_are_right_are_not_wild() {
    for (seed, poses) in (1..=10).flat_map(|seed| [12, 15, 20].map(|poses| (seed, poses))) {
        let found = traced(&one_load(poses, seed, None));
        assert_eq!((names(&found), found.verdict), (vec![], Verdict::Adequate), "{poses} poses, seed {seed}");
    }
}

/// A wild reading in a pose held out says nothing against the model.
#[test]
fn wild_rows_of_poses_held_out_are_told_too() {
    let holdout = Some(Holdout { fraction: 0.25, seed: 1 });
    let whole = Campaign { holdout, ..shifted(&[TILT_3], &[], 0.0) };
    let Data::Displacement(data) = &whole.data else { unreachable!("displacements") };
    let without = traced(&whole);
    let is_held_out = |row: &usize| without.held_out.contains(&data.poses[data.rows[*row].pose]);
    let row = (0..data.rows.len()).filter(is_held_out).nth(7).expect("a quarter of the rows");
    let found = traced(&Campaign { holdout, ..shifted(&[TILT_3], &[row], 15.0) });
    assert_eq!(names(&found), ["transverse_compliance@joint 3", "outliers@rig"]);
    assert_eq!((found.verdict, &found.effects[1].lines), (Verdict::Explained, &vec![row + 2]));
    // It does not reach the fit; the error there has it in, by what the fit predicts.
    assert_eq!(found.estimates, without.estimates);
    assert!(found.after.holdout_rms > without.after.holdout_rms);
}
