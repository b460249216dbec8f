//! What tracing makes of files that say something else than what was measured.

use core::f64::consts::{FRAC_PI_2, PI};
use std::string::ToString;
use std::vec;
use std::vec::Vec;

use robstiff_robots::Convention;

use super::tests::{names, traced};
use super::{Trace, Verdict};
use crate::campaign::made::Plan;
use crate::campaign::made_positions::Plan as PositionPlan;
use crate::campaign::{Campaign, Data, Displacements, Frame, Observation, PositionRow};
use crate::identify::column::Column;
use crate::identify::misread::of_displacements;
use crate::identify::{identify, misread};
use robstiff::elements::Spring;
use robstiff_robots::samples::five_axis;

/// A campaign on whose rows a mistake is made.
fn with(seed: u64, mistake: impl Fn(&mut Observation)) -> Campaign {
    let mut campaign = Plan { poses: 24, ramp: vec![0.5, 1.0], ..Plan::new(seed) }.run();
    rows(&mut campaign).rows.iter_mut().for_each(mistake);
    campaign
}

fn rows(campaign: &mut Campaign) -> &mut Displacements {
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
    data
}

/// Nothing is told of the arm, and the mistake is.
fn tells(found: &Trace, mistake: &str) {
    assert_eq!((names(found), found.verdict), (vec![], Verdict::Insufficient), "{mistake}: {}", found.why);
    assert!(found.looks_like.iter().any(|words| words == mistake), "{mistake}: {:?}", found.looks_like);
    assert!(found.why.contains(mistake), "{mistake}: {}", found.why);
    assert_eq!(found.after, found.declared, "{mistake}");
}

#[test]
fn exchanged_and_reversed_columns_are_told() {
    tells(&traced(&with(1, |row| row.displacement.swap(0, 1))), "dx and dy exchanged");
    tells(&traced(&with(2, |row| row.displacement[2] *= -1.0)), "dz with the other sign");
    tells(&traced(&with(3, |row| row.wrench.swap(0, 2))), "Fx and Fz exchanged");
    tells(&traced(&with(4, |row| row.wrench[1] *= -1.0)), "Fy with the other sign");
    tells(&traced(&with(5, |row| row.displacement.rotate_left(1))), "dy, dz and dx where dx, dy and dz should be");
    tells(&traced(&with(6, |row| row.q.swap(1, 2))), "q2 and q3 exchanged");
}

/// Angles in another unit, all of them.
#[test]
fn angles_that_are_all_in_another_unit_are_told() {
    let all = |q: &mut [f64], factor: f64| q.iter_mut().for_each(|q| *q *= factor);
    let told = |campaign: &Campaign, words: &str| {
        tells(&traced(campaign), words);
        // Or every joint would be less than rigid, which it says instead.
        let Ok(found) = identify(campaign) else { return };
        assert!(misread(campaign, &found).is_some_and(|said| said.contains(words)), "{words}");
    };
    let [rad, deg] = ["all angles in rad where the header has deg", "all angles in deg where the header has rad"];
    for (factor, words) in [(PI / 180.0, rad), (180.0 / PI, deg)] {
        told(&with(1, |row| all(&mut row.q, factor)), words);
    }
}

/// A left-handed frame, and one that is turned, which is joint 1 counted from elsewhere.
#[test]
fn vectors_along_other_axes_are_told() {
    let mirrored = |row: &mut Observation| {
        row.wrench.swap(0, 1);
        row.displacement.swap(0, 1);
    };
    tells(&traced(&with(1, mirrored)), "all vectors along other axes, x and y exchanged");
    let turned = |vector: &mut [f64]| vector.swap(0, 1);
    let turned = with(2, |row| {
        for vector in [&mut row.wrench[..3], &mut row.displacement] {
            turned(vector);
            vector[0] *= -1.0;
        }
    });
    tells(&traced(&turned), "q1 less by 90 deg than the description counts");
}

#[test]
fn columns_in_other_units_are_told() {
    tells(&traced(&with(1, |row| row.wrench[1] /= 9.80665)), "Fy in kgf where the header has N");
    tells(&traced(&with(2, |row| row.displacement[0] *= 1e3)), "dx in a unit a thousandth of that of the header");
    tells(&traced(&with(3, |row| row.q[2] /= 0.9)), "q3 in gon where the header has deg");
}

#[test]
fn joints_that_are_counted_otherwise_are_told() {
    tells(&traced(&with(1, |row| row.q[3] *= -1.0)), "q4 counted the other way");
    let several = with(4, |row| [0, 3].into_iter().for_each(|joint| row.q[joint] *= -1.0));
    tells(&traced(&several), "q1 and q4 counted the other way");
    let from_elsewhere = "q2 less by 90 deg than the description counts";
    tells(&traced(&with(2, |row| row.q[1] -= FRAC_PI_2)), from_elsewhere);
    let from_the_floor = "q3 less by q2 than the description counts, as where it is counted from the floor";
    tells(&traced(&with(3, |row| row.q[2] -= row.q[1])), from_the_floor);
}

#[test]
fn other_frames_and_another_convention_are_told() {
    let mut campaign = with(1, |_| {});
    rows(&mut campaign).wrench_frame = Frame::Tool;
    tells(&traced(&campaign), "forces in the other frame, base or tool, than the campaign says");
    rows(&mut campaign).wrench_frame = Frame::Base;
    campaign.robot.convention = Convention::Modified;
    tells(&traced(&campaign), "the DH table in the other convention than the description says");
}

/// A fit to such files is worth nothing, and identification says so.
#[test]
fn identification_tells_of_mistakes() {
    let told = |campaign: &Campaign| misread(campaign, &identify(campaign).expect("joints are seen"));
    assert_eq!(told(&with(1, |_| {})), None);
    let exchanged = told(&with(1, |row| row.displacement.swap(0, 1))).expect("it is told");
    let said = "The files may say something else than what was measured: dx and dy exchanged; with that undone ";
    assert!(exchanged.starts_with(said), "{exchanged}");
    let mut positions = PositionPlan { payloads: vec![0.0, 100.0], ..PositionPlan::new(five_axis(), 1) }.run();
    assert_eq!(told(&positions), None);
    let Data::Position(data) = &mut positions.data else { unreachable!("positions") };
    data.rows.iter_mut().for_each(|row| row.q[3] *= -1.0);
    assert!(told(&positions).is_some_and(|said| said.contains("q4 counted the other way")));
}

/// What an arm lacks, in the catalogue or not, is no mistake.
#[test]
fn files_that_are_right_are_believed() {
    let tilt = Plan { hidden: vec![(Column::Spring(Spring::Transverse(3)), 2e-6)], ..Plan::new(1) };
    let found = traced(&tilt.run());
    assert_eq!(found.verdict, Verdict::Explained, "{}", found.why);
    for seed in 0..4 {
        // The faster, the more: no arm does that.
        let found = traced(&with(seed, |row| {
            let size = row.wrench[0].hypot(row.wrench[2]) / 1e3;
            row.displacement[1] += 3e-4 * (size * size + row.q[0] * row.q[3]);
        }));
        assert_ne!(found.verdict, Verdict::Insufficient, "seed {seed}: {}", found.why);
        assert!(!found.why.contains("something else"), "seed {seed}: {}", found.why);
    }
}

/// Each is undone by what it says, and none is another's alias on every robot.
#[test]
fn every_mistake_is_another() {
    let campaign = with(1, |_| {});
    let Data::Displacement(data) = &campaign.data else { unreachable!("displacements") };
    let undone: Vec<_> = of_displacements(&campaign.robot)
        .iter()
        .map(|mistake| {
            let (robot, data) = mistake.undone(&campaign.robot, data);
            (robot, std::format!("{:?}", (data.wrench_frame, data.measured_frame, data.rows)), mistake.to_string())
        })
        .collect();
    for (k, (robot, rows, words)) in undone.iter().enumerate() {
        for (other_robot, other_rows, other) in &undone[..k] {
            assert!(robot != other_robot || rows != other_rows, "{words} is {other}");
            assert_ne!(words, other);
        }
    }
}

/// Positions with a mistake on their rows.
#[test]
fn mistakes_in_positions_are_told() {
    let told = |mistake: &dyn Fn(&mut PositionRow), words: &str| {
        let mut campaign = PositionPlan::new(five_axis(), 1).run();
        let Data::Position(data) = &mut campaign.data else { unreachable!("positions") };
        data.rows.iter_mut().for_each(mistake);
        tells(&traced(&campaign), words);
    };
    told(&|row| row.q[3] *= -1.0, "q4 counted the other way");
    told(&|row| row.q[1] /= 0.9, "q2 in gon where the header has deg");
    told(&|row| row.q.swap(1, 2), "q2 and q3 exchanged");
    told(&|row| row.position.swap(0, 1), "px, py and pz of the other hand, one with the other sign or two exchanged");
    told(&|row| row.position[2] *= 10.0, "pz in a unit a tenth of that of the header");
}

/// Numbers that identification refuses for their unit tell tracing nothing of the arm, either.
#[test]
fn numbers_in_another_unit_are_told_as_identification_does() {
    let refused = |campaign: &Campaign, unit: &str| {
        let why = identify(campaign).expect_err("it refuses another unit").to_string();
        let found = traced(campaign);
        assert_eq!((names(&found), found.verdict, found.why.as_str()), (vec![], Verdict::Insufficient, why.as_str()));
        assert!(why.contains(unit) && found.description == campaign.robot, "{why}");
        assert_eq!(found.after, found.declared);
    };
    let displacements = with(1, |row| row.displacement = row.displacement.map(|length| 1e3 * length));
    refused(&displacements, "a displacement in um taken for mm");
    let mut positions = PositionPlan::new(five_axis(), 1).run();
    let Data::Position(data) = &mut positions.data else { unreachable!("positions") };
    data.rows.iter_mut().for_each(|row| row.position = row.position.map(|length| 1e3 * length));
    refused(&positions, "positions in mm taken for m");
}

/// What an arm lacks besides is left where a mistake is undone, too: no effect that fits better as
/// the files are is named for it.
#[test]
fn mistakes_are_told_of_arms_that_lack_something_besides() {
    for seed in [2, 3, 5] {
        let hidden = vec![(Column::Spring(Spring::Transverse(3)), 6e-7)];
        let mut campaign = Plan { poses: 24, ramp: vec![0.5, 1.0], hidden, ..Plan::new(seed) }.run();
        rows(&mut campaign).rows.iter_mut().for_each(|row| row.q.swap(1, 2));
        let found = traced(&campaign);
        assert_eq!((names(&found), found.verdict), (vec![], Verdict::Unexplained), "{}", found.why);
        assert_eq!(found.looks_like, ["q2 and q3 exchanged"], "{}", found.why);
    }
}
