//! What visits tell, against what visits told.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::Vector3;

use super::Adapter;
use crate::campaign::Frame;
use crate::campaign::made::{Plan, displacements};
use crate::identify::Visibility;
use crate::identify::column::Column;
use crate::identify::prepare::Prepared;
use crate::plan::plan;
use crate::plan::regressors::{Regressors, Visit};
use crate::trace::{Options, trace};
use robstiff::elements::Spring;

/// The visits of a campaign, proposed again, tell as much as they did, whether the rows of a
/// visit share an unloaded reading or each has its own, and whatever the noise of each axis.
#[test]
fn the_same_visits_again_tell_the_same() {
    let alike = Plan::new(5);
    let rotations = Some([3e-5, 3e-5, 6e-5]);
    for plan in [
        Plan { shares_unloaded: false, ..alike.clone() },
        Plan { noise: [5e-6, 1e-5, 2e-5], measured_frame: Frame::Tool, ..alike.clone() },
        Plan { rotation_noise: rotations, ..alike },
    ] {
        let shares_unloaded = plan.shares_unloaded;
        let campaign = plan.run();
        let prepared = Prepared::new(&campaign).expect("displacements");
        assert!(shares_unloaded == (prepared.covariance.shared > 0.5));
        let options = Options { draws: 99, ..Options::default() };
        let traced = trace(&campaign, &options, &|_| {}).expect("every joint is seen");
        let (adapter, _) = Adapter::new(&campaign, &prepared, &traced, &[]).expect("a model");
        let mut visits: Vec<Visit> = Vec::new();
        let mut last = None;
        for row in &displacements(&campaign).rows {
            if last.replace(row.visit) != Some(row.visit) {
                visits.push(Visit { q: row.q.clone(), loads: Vec::new() });
            }
            visits.last_mut().expect("it has just been begun").loads.push(row.wrench);
        }
        let known = adapter.known();
        let again = adapter.information(&visits, None).into_iter().fold(0.0 * &known, |sum, visit| sum + visit);
        for k in 0..known.nrows() {
            let ratio = again[(k, k)] / known[(k, k)];
            assert!((ratio - 1.0).abs() < 1e-9, "shared: {shares_unloaded}, column {k}: {ratio}");
        }
    }
}

/// A weight does not turn a joint whose axis is plumb, its cable that pulls aside does: with
/// what the load cell does not read, the joint is one more number of the model.
#[test]
fn a_joint_that_only_an_effect_turns_is_known_by_its_own_name() {
    let aside = |force| force + Vector3::new(60.0, -45.0, 20.0);
    let campaign = Plan { line: Some(-Vector3::z()), acts: aside, ..Plan::new(3) }.run();
    let options = Options { draws: 99, ..Options::default() };
    let traced = trace(&campaign, &options, &|_| {}).expect("most joints are seen");
    let [bias] = &traced.effects[..] else { panic!("{}", traced.why) };
    assert_eq!(bias.effect.to_string(), "load_cell_bias@rig");
    assert_eq!(traced.estimates_before[0].visibility, Visibility::Unseen);
    let planned = plan(&campaign, &traced, &crate::plan::Options { poses: 2, starts: 1, ..Default::default() });
    let planned = planned.expect("displacements");
    let of_joints = traced.estimates.iter().map(|estimate| (estimate.name.clone(), estimate.value, estimate.std));
    let of_bias = bias.effect.parameters.iter().filter(|number| number.std.is_some());
    let of_bias = of_bias.map(|number| (format!("load_cell_bias@rig {}", number.name), number.value, number.std));
    let told: Vec<(String, f64, Option<f64>)> = of_joints.chain(of_bias).collect();
    assert_eq!(planned.numbers.len(), told.len());
    for (name, value, std) in told {
        let number = planned.numbers.iter().find(|number| number.name == name);
        let number = number.unwrap_or_else(|| panic!("{name} is not among {:?}", planned.numbers));
        assert!((number.value / value - 1.0).abs() < 1e-3, "{name}: {value} {number:?}");
        // That of the trace asks the poses, too, how far they scatter.
        let ratio = number.now / std.expect("it is seen");
        assert!((0.3..3.0).contains(&ratio) && number.after < number.now, "{name}: {ratio} {number:?}");
    }
}

/// The one number of an effect goes by the effect's name, as in descriptions and in plans of
/// positions.
#[test]
fn the_only_number_of_an_effect_goes_by_its_name() {
    let hidden = std::vec![(Column::Spring(Spring::Coupling([2, 3])), 1e-7)];
    let campaign = Plan { hidden, ..Plan::new(4) }.run();
    let traced = trace(&campaign, &Options { draws: 199, ..Options::default() }, &|_| {}).expect("displacements");
    let named: Vec<String> = traced.effects.iter().map(|named| named.effect.to_string()).collect();
    assert_eq!(named, ["joint_coupling@joints 2,3"]);
    let planned = plan(&campaign, &traced, &crate::plan::Options { poses: 2, starts: 1, ..Default::default() });
    let numbers = planned.expect("displacements").numbers;
    assert!(numbers.iter().any(|number| number.name == named[0]), "{numbers:?}");
}
