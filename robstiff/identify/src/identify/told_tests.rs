//! What is told of numbers that the readings hardly show, of rows whose load is wrong, and of
//! campaigns in which all of the readings are off.

use std::format;
use std::string::ToString;
use std::vec;
use std::vec::Vec;

use robstiff_robots::{Description, catalogue};

use super::{Error, Estimate, Identification, Visibility, identify, off_by_one_factor};
use crate::campaign::made::{Plan, campaign};
use crate::campaign::{Campaign, Data, Noise, Observation};
use crate::simulate::{Scenario, simulate};
use robstiff::Effect;

/// What a robot of the catalogue with a tool gives whose middle is next to the last axis, which
/// forces on it hardly turn.
fn measured(robot: &str, scenario: &str) -> Campaign {
    let text = catalogue::find(robot).expect("in the catalogue");
    let mut robot = Description::parse("robot.yaml", text).expect("of the catalogue");
    robot.tool.xyz = [5e-3, 0.0, 0.2];
    let scenario = Scenario::parse("try.yaml", scenario, &robot).expect("a scenario");
    let simulated = simulate(&robot, &scenario).expect("it can be measured");
    let noise = Noise { displacement: Some(8e-6), rotation: None };
    Campaign { noise, ..campaign(robot, simulated.data) }
}

/// Whether a number keeps its declared value, and it is said that it does not show.
fn is_kept(estimate: &Estimate) -> bool {
    let Estimate { value, declared, std, at_bound, .. } = *estimate;
    estimate.visibility == Visibility::Unseen && value == declared && std.is_none() && !at_bound
}

/// A bearing that tilts is in the readings of all poses, and a joint that forces hardly turn would
/// need thousands of times its compliance to make up for it.
#[test]
fn what_the_description_lacks_makes_no_compliance() {
    let (mut kept, seeds) = (0, 1..=8);
    for seed in seeds {
        let scenario = format!(
            "name: tilt\nseed: {seed}\nposes: {{count: 40, floor: 100 mm, column: 600 mm}}\nvisits: 2\n\
             ramp: [0.35, 0.7, 1]\nforce: {{bounds: [500 N, 1.3 kN]}}\nnoise: {{displacement: 8 um}}\nscatter: 0.2\n\
             hidden:\n  effects:\n    - {{kind: transverse_compliance, at: joint 3, value: 6e-7 rad/Nm}}\n"
        );
        let found = identify(&measured("kuka-kr270-r2700", &scenario)).expect("joints are seen");
        let last = &found.estimates[5];
        assert!(is_kept(last), "{seed}: {last:?}");
        kept += 1;
        // The tilt is in all rows of its poses, and no load is wrong.
        assert!(found.left_out.is_empty(), "{seed}: {:?}", found.left_out);
        assert!(found.estimates[..3].iter().all(|joint| joint.std.is_some()), "{seed}: {:?}", found.estimates);
    }
    assert_eq!(kept, 8);
}

/// Of a joint that a payload hardly turns zero fits no better than what is declared.
#[test]
fn a_joint_is_rigid_only_where_the_declared_compliance_does_not_fit() {
    for seed in 1..=8 {
        let scenario = format!(
            "kind: position\nseed: {seed}\nposes: {{count: 30, floor: 200 mm}}\npayloads: [0 kg, 150 kg]\n\
             measured: {{at: [40 mm, 0 mm, 110 mm]}}\nnoise: {{displacement: 20 um, repeatability: 20 um}}\nscatter: 0.3\n"
        );
        let found = identify(&measured("kuka-kr270-r2700", &scenario)).expect("joints are seen");
        let clipped = found.estimates.iter().find(|joint| joint.at_bound);
        assert!(clipped.is_none() && is_kept(&found.estimates[5]), "{seed}: {:?}", found.estimates);
    }
    // Rigid as far as such a campaign can say, and declared as a joint that it would see.
    let mut plan = Plan::new(3);
    let right = plan.robot.clone();
    plan.robot.joints[3].compliance.iter_mut().for_each(|part| part.value *= 1e-6);
    let found = identify(&Campaign { robot: right, ..plan.run() }).expect("joints are seen");
    let joint = &found.estimates[3];
    assert!(joint.visibility == Visibility::Seen && joint.value < 0.02 * joint.declared, "{joint:?}");
}

/// The identification of a campaign of which one row's force is not what the file says.
fn with_wrong_force(plan: &Plan, row: usize, wrong: impl Fn(&mut Observation)) -> (usize, Identification) {
    let mut campaign = plan.run();
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements were planned") };
    wrong(&mut data.rows[row]);
    let line = data.rows[row].line;
    (line, identify(&campaign).expect("all joints are seen"))
}

/// Of a wrong force no other reading of its pose can say that it is, for what a pose's readings
/// are free in is the response to it.
#[test]
fn a_row_with_a_wrong_force_is_left_out() {
    let tilted = vec![Effect::TransverseCompliance { joint: 3, value: 1e-7 }];
    let plans = [
        Plan::new(1),
        Plan { hidden: tilted, ..Plan::new(2) },
        Plan { visits: 1, ramp: vec![1.0], ..Plan::new(3) },
        Plan { rotation_noise: Some([5e-5; 3]), ..Plan::new(4) },
    ];
    for (k, plan) in plans.iter().enumerate() {
        let right = identify(&plan.run()).expect("all joints are seen");
        assert!(right.left_out.is_empty(), "{k}: {:?}", right.left_out);
        for row in [1, 7, 22] {
            let largest =
                |row: &Observation| (0..3).max_by(|&a, &b| row.wrench[a].abs().total_cmp(&row.wrench[b].abs()));
            let times = |times: f64| {
                move |row: &mut Observation| {
                    let axis = largest(row).expect("three axes");
                    row.wrench[axis] *= times;
                }
            };
            for wrong in [1e3, 10.0, -1.0] {
                let (line, found) = with_wrong_force(plan, row, times(wrong));
                assert_eq!(found.left_out, [line], "{k}: row {row} times {wrong}");
                for (right, found) in right.estimates.iter().zip(&found.estimates) {
                    let off = (right.value - found.value).abs();
                    assert!(right.std.is_some_and(|std| off < std), "{k}: row {row} times {wrong}: {found:?}");
                }
            }
        }
    }
}

/// Several hide each other.
#[test]
fn rows_with_wrong_forces_are_left_out_together() {
    let mut campaign = Plan::new(5).run();
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements were planned") };
    let rows = [3, 60, 150, 333];
    rows.iter().for_each(|&row| data.rows[row].wrench[row % 3] *= 1e3);
    let lines: Vec<usize> = rows.iter().map(|&row| data.rows[row].line).collect();
    assert_eq!(identify(&campaign).expect("all joints are seen").left_out, lines);
}

/// What rounding adds to the declared noise stays with the rows that are left.
#[test]
fn a_wrong_force_takes_no_rounding_from_the_noise() {
    let mut campaign = Plan::new(6).run();
    campaign.noise.displacement = Some(2e-6);
    let rows = |campaign: &mut Campaign, change: &dyn Fn(&mut [Observation])| match &mut campaign.data {
        Data::Displacement(data) => change(&mut data.rows),
        _ => unreachable!("displacements were planned"),
    };
    let rounded = |row: &mut Observation| row.displacement = row.displacement.map(|x| (x * 1e5).round() / 1e5);
    rows(&mut campaign, &|rows| rows.iter_mut().for_each(rounded));
    let right = identify(&campaign).expect("all joints are seen").noise.expect("it is declared");
    rows(&mut campaign, &|rows| rows[7].wrench[0] *= 1e3);
    let found = identify(&campaign).expect("all joints are seen");
    assert_eq!((found.left_out.len(), found.noise), (1, Some(right)));
    assert!(right.0 > 2e-6, "{right:?}");
}

/// A campaign with other forces, or displacements.
fn scaled(force: f64, displacement: f64) -> Campaign {
    Plan::new(1).run_with(|_, row| {
        row.wrench = row.wrench.map(|load| force * load);
        row.displacement = row.displacement.map(|read| displacement * read);
    })
}

/// No robot is a thousand times as compliant as it is said to be.
#[test]
fn a_unit_that_was_taken_for_another_is_refused() {
    for (force, told) in [
        (1e-3, "1000 times as compliant as declared: a force in kN taken for N, or a displacement in um taken for mm,"),
        (1e3, "1000 times as stiff as declared: a force in N taken for kN, or a displacement in mm taken for um,"),
        (
            1e-6,
            "1000000 times as compliant as declared: a force in MN taken for N, or a displacement in um taken for m,",
        ),
    ] {
        let why = identify(&scaled(force, 1.0)).expect_err("in another unit");
        assert!(matches!(&why, Error::OtherUnit(why) if why.contains(told)), "{why}");
        assert!(why.to_string().contains("as `Fx [N]` or `dx [um]` does"), "{why}");
    }
    // What lies between no units is told, and no more.
    let campaign = scaled(5e-3, 1.0);
    assert!(off_by_one_factor(&campaign, &identify(&campaign).expect("no unit").estimates).is_some());
}

#[test]
fn displacements_that_are_all_zero_are_said_to_be() {
    let mut campaign = Plan::new(1).run();
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements were planned") };
    data.rows.iter_mut().for_each(|row| row.displacement = [0.0; 3]);
    let why = identify(&campaign).expect_err("nothing was read");
    assert!(matches!(&why, Error::NotShown(why) if why.contains("every displacement is zero")), "{why}");
}

/// Rotations whose weight only a fit tells: of a curve that no load asks for there is no fit.
#[test]
fn a_declared_number_that_nothing_shows_refuses_no_campaign() {
    let mut plan = Plan { visits: 1, ramp: vec![1.0], rotation_noise: Some([5e-5; 3]), ..Plan::new(2) };
    // What forces at the tool do not turn.
    plan.robot.joints[4].a = 0.0;
    let mut campaign = plan.run();
    campaign.robot.effects.push(Effect::StiffnessNonlinearity { joint: 5, added: 1e-8, knee: 50.0 });
    let found = identify(&campaign).expect("three joints are seen");
    assert!(found.estimates[..3].iter().all(|joint| joint.visibility == Visibility::Seen), "{:?}", found.estimates);
    assert!(found.estimates[4..].iter().all(is_kept), "{:?}", found.estimates);
}
