//! What is told of numbers that the readings hardly show, of rows whose load is wrong, and of
//! campaigns in which all of the readings are off.

use std::string::ToString;
use std::vec;

use super::{Error, Estimate, Visibility, identify, off_by_one_factor};
use crate::Effect;
use crate::campaign::made::Plan;
use crate::campaign::{Campaign, Data};

/// Whether a number keeps its declared value, and it is said that it does not show.
fn is_kept(estimate: &Estimate) -> bool {
    let Estimate { value, declared, std, at_bound, .. } = *estimate;
    estimate.visibility == Visibility::Unseen && value == declared && std.is_none() && !at_bound
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
