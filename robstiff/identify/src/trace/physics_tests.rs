//! What is no physical model, and what is said of it.

use std::format;
use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::DMatrix;
use robstiff_robots::{Description, catalogue};

use super::bench::Bench;
use super::model::Named;
use super::report::named::{effects, unseen_rms};
use super::search::Outcome;
use super::tests::TILT_3;
use super::{Options, Verdict};
use crate::campaign::made::Plan;
use crate::identify::prepare::Prepared;
use robstiff::Effect;
use robstiff_robots::samples::five_axis;

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

/// A force through its axis does not turn it, whatever its gear does.
#[test]
fn a_joint_without_load_shows_nothing_of_its_gear() {
    let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
    let robot = Description::parse("kuka-kr270-r2700.yaml", text).expect("a description");
    let campaign = Plan { robot, ..Plan::new(1) }.run();
    let prepared = Prepared::new(&campaign).expect("displacements");
    let bench = Bench::new(&campaign, &prepared).expect("the others are seen");
    for kind in ["stiffness_nonlinearity", "lost_motion", "hysteresis", "pose_dependent_compliance"] {
        let of = |joint: usize| bench.invisible.contains(&format!("{kind}@joint {joint}"));
        assert!(of(6) && !of(2), "{kind}");
    }
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

/// Two effects that make up for each other, of which neither is possible alone.
#[test]
fn an_effect_that_is_not_possible_alone_is_told_with_the_error_of_all() {
    let campaign = Plan::new(1).run();
    let prepared = Prepared::new(&campaign).expect("displacements");
    let bench = Bench::new(&campaign, &prepared).expect("every joint is seen");
    let setting = bench.at(&[]).expect("no effects");
    let is_part = |one: &Named| {
        ["transverse_compliance", "link_compliance"].contains(&bench.candidates()[one.candidate].kind.name)
    };
    let parts = (0..bench.candidates().len()).map(|candidate| Named { candidate, variant: 0 }).filter(is_part);
    let both: Vec<Named> = parts.filter(|&one| unseen_rms(&bench, &[one], &[]).is_none()).take(2).collect();
    let model = setting.fit_loosely(&both).expect("the poses tell them apart");
    let spread = DMatrix::zeros(model.fit.columns.len(), model.fit.columns.len());
    let mut outcome = Outcome::nothing(model.clone(), Verdict::Partial, String::new());
    outcome.selection.p_values = vec![0.0; 2];
    let options = Options { draws: 99, ..Options::default() };
    let told = effects(&bench, &setting, &model, &outcome, (&spread, &[], &[]), (&[], 1.5e-5), &options);
    assert_eq!(told.iter().map(|named| named.holdout_rms).collect::<Vec<f64>>(), [1.5e-5; 2]);
}
