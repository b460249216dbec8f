//! What is no physical model, and what is said of it.

use std::vec;
use std::vec::Vec;

use super::bench::Bench;
use super::model::Named;
use super::tests::TILT_3;
use crate::Effect;
use crate::campaign::made::Plan;
use crate::identify::prepare::Prepared;
use crate::samples::five_axis;

/// Its numbers are shares of the joint's compliance.
#[test]
fn a_joint_without_compliance_has_none_that_varies() {
    let campaign = Plan::new(1).run();
    let prepared = Prepared::new(&campaign).expect("displacements");
    let bench = Bench::new(&campaign, &prepared).expect("every joint is seen");
    let setting = bench.at(&[]).expect("no effects");
    let name = "pose_dependent_compliance@joint 3";
    let candidate = bench.candidates().iter().position(|candidate| candidate.name() == name);
    let one = Named { candidate: candidate.expect("in the catalogue"), variant: 0 };
    let fit = setting.fit_loosely(&[one]).expect("the poses tell it").fit;
    let of = |own: f64| {
        let mut fit = fit.clone();
        let mut set = |column: usize, value: f64| {
            let at = fit.columns.iter().position(|of| *of == column).expect("of the model");
            fit.coefficients[at] = value;
        };
        // No angle is beyond 1.2 rad, where the cosine is positive.
        set(2, own);
        set(setting.variant(one).columns[0], 1e-7);
        set(setting.variant(one).columns[1], 0.0);
        setting.check_effect(&fit, one)
    };
    assert!(of(3e-7).is_ok());
    assert!(of(0.0).is_err_and(|why| why.starts_with("joint 3 ")));
}

/// The columns behind those of the joints are of the effects that are declared.
#[test]
fn what_would_be_negative_is_told_by_its_name() {
    let mut robot = five_axis();
    robot.effects.push(Effect::TransverseCompliance { joint: 3, value: 6e-7 });
    let hidden = vec![(TILT_3.0, -4.0 * TILT_3.1)];
    let campaign = Plan { robot, hidden, ..Plan::new(2) }.run();
    let prepared = Prepared::new(&campaign).expect("displacements");
    let bench = Bench::new(&campaign, &prepared).expect("joints are seen");
    let setting = bench.at(&[]).expect("no effects");
    let alone = (0..bench.candidates().len()).map(|candidate| Named { candidate, variant: 0 });
    let told: Vec<_> = alone.filter_map(|one| setting.fit(&[one]).err()).collect();
    assert!(told.iter().any(|why| why == "transverse_compliance@joint 3 would be negative"), "{told:?}");
    assert!(!told.iter().any(|why| why.starts_with("joint 6 ")), "{told:?}");
}
