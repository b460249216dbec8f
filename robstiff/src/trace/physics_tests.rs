//! What is no physical model.

use super::bench::Bench;
use super::model::Named;
use crate::campaign::made::Plan;
use crate::identify::prepare::Prepared;

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
