//! What tracing makes of readings that do not belong.

use std::vec;

use super::tests::{SIGMA, TILT_3, campaign, names, traced};
use super::*;
use crate::campaign::{Data, Holdout};
use crate::samples::five_axis;

/// A campaign with a shift (standard deviations) along z in some of its rows.
fn shifted(hidden: &[(crate::identify::samples::Column, f64)], rows: &[usize], shift: f64) -> Campaign {
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
    // It reaches neither the fit nor the error there.
    assert_eq!(found.estimates, without.estimates);
    assert!((found.after.holdout_rms / without.after.holdout_rms - 1.0).abs() < 0.1);
}
