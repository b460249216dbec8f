//! What visits show, against what campaigns did.

use nalgebra::{DMatrix, DVector};
use robstiff::Effect;
use robstiff_robots::Description;
use robstiff_robots::effect::gravity_sag::GRAVITY;
use robstiff_robots::samples::five_axis;

use super::{Rigged, Shown};
use crate::campaign::made::campaign;
use crate::campaign::{Campaign, Data, Frame, Noise};
use crate::observe::Observation;
use crate::observe::displacement::Displacement;
use crate::plan::regressors::{Regressors, Visit};
use crate::plan::{Criterion, Group, MARGIN, Options, Outlook, Plan, plan, plan_between};
use crate::simulate::{Measures, Poses, Pull, Scenario, UnderForces, UnderPayloads, simulate};
use crate::trace::{self, Trace};

const NOISE: f64 = 1e-5;

const TILT: Effect = Effect::TransverseCompliance { joint: 3, value: 6e-7 };

fn robot() -> Description {
    let mut robot = five_axis();
    robot.joints.iter_mut().for_each(|joint| joint.limits = Some([-1.5, 1.5]));
    robot
}

fn drawn(count: usize) -> Poses {
    Poses::Drawn { count, within: vec![[-1.2, 1.2]; 5], floor: None, column: None }
}

/// Forces in all directions.
fn forces() -> UnderForces {
    UnderForces {
        ramp: vec![0.5, 1.0],
        force: Pull { bounds: [800.0, 1200.0], directions: Vec::new() },
        moment: None,
        frames: [Frame::Base; 2],
        rotation_noise: None,
        encoder_noise: None,
        shares_unloaded: true,
    }
}

fn measured(hidden: &[Effect], poses: Poses, measures: Measures) -> Campaign {
    let robot = robot();
    let scenario = Scenario {
        name: "planned".into(),
        seed: 3,
        poses,
        visits: 1,
        measures,
        wrench_at: [0.0, 0.0, 0.2],
        measured_at: [0.0, 0.0, 0.2],
        noise: [NOISE; 3],
        states_noise: true,
        hidden: hidden.to_vec(),
        scatter: 0.2,
        holdout: None,
    };
    let data = simulate(&robot, &scenario).expect("measured").data;
    Campaign { noise: Noise { displacement: Some(NOISE), rotation: None }, ..campaign(robot, data) }
}

fn traced(campaign: &Campaign) -> Trace {
    trace::trace(campaign, &trace::Options { folds: 2, ..Default::default() }, &|_| {}).expect("traced")
}

/// A trace that says nothing of effects.
fn silent(campaign: &Campaign) -> Trace {
    let mut trace = traced(campaign);
    trace.effects.clear();
    trace.suspected.clear();
    trace
}

/// Few poses, found quickly.
const OPTIONS: Options = Options {
    poses: 4,
    criterion: Criterion::Compound,
    seed: 1,
    candidates: 40,
    starts: 1,
    force: None,
    moment: None,
    floor: None,
    margin: MARGIN,
};

fn between(campaign: &Campaign, rivals: &[Effect], options: Options) -> Plan {
    let names = rivals.iter().map(ToString::to_string).collect();
    plan_between(campaign, &silent(campaign), &[Group { named: None, names }], &options).expect("planned")
}

/// The visits of a campaign.
fn visits(campaign: &Campaign) -> Vec<Visit> {
    let rows: Vec<(usize, &Vec<f64>, [f64; 6])> = match &campaign.data {
        Data::Displacement(data) => data.rows.iter().map(|row| (row.visit, &row.q, row.wrench)).collect(),
        Data::Position(data) => {
            let weight = |payload: f64| [0.0, 0.0, -GRAVITY * payload, 0.0, 0.0, 0.0];
            data.rows.iter().map(|row| (row.visit, &row.q, weight(row.payload))).collect()
        }
        Data::Clamped(_) => unreachable!("none are made here"),
    };
    let mut visits: Vec<Visit> = Vec::new();
    let mut last = None;
    for (visit, q, load) in rows {
        if last.replace(visit) != Some(visit) {
            visits.push(Visit { q: q.clone(), loads: Vec::new() });
        }
        visits.last_mut().expect("it has just been begun").loads.push(load);
    }
    visits
}

/// The visits of a campaign, proposed again, tell as much as they did, but for the rows that it takes
/// for outlying in part.
#[test]
fn the_same_visits_again_tell_the_same() {
    let alone = UnderForces { ramp: vec![1.0], ..forces() };
    let turns = UnderForces { rotation_noise: Some(3e-5), frames: [Frame::Base, Frame::Tool], ..forces() };
    let payloads = UnderPayloads { payloads: vec![0.0, 100.0], repeatability: 0.0 };
    for measures in [
        Measures::Displacements(forces()),
        Measures::Displacements(alone),
        Measures::Displacements(turns),
        Measures::Positions(payloads),
    ] {
        let campaign = measured(&[], drawn(20), measures);
        let (shown, _) = Shown::new(&campaign, &silent(&campaign), &[]).expect("a model");
        let likely = shown.likely();
        let known = shown.known() - &likely;
        let again: DMatrix<f64> = shown.information(&visits(&campaign), None).into_iter().sum();
        for (i, j) in (0..known.nrows()).flat_map(|i| (0..known.ncols()).map(move |j| (i, j))) {
            let scale = (known[(i, i)] * known[(j, j)]).sqrt();
            let off = (known[(i, j)] - again[(i, j)]).abs();
            // Far less than is likely beforehand is nothing.
            let nothing = 1e-6 * (likely[(i, i)] * likely[(j, j)]).sqrt();
            assert!(off <= 0.01 * scale + nothing, "{i} {j}: {} {}", known[(i, j)], again[(i, j)]);
        }
    }
}

/// A visit's information is that of what a campaign with its rows reads more for a little more of each
/// number.
#[test]
fn information_is_that_of_differences_of_readings() {
    let campaign = measured(&[TILT], drawn(14), Measures::Displacements(forces()));
    let group = Group { named: None, names: vec![TILT.to_string(), "lever_arm@rig".into()] };
    let (shown, rivals) = Shown::new(&campaign, &traced(&campaign), &[group]).expect("a model");
    assert_eq!(rivals.pairs.len(), 1);
    let visit = Visit {
        q: vec![0.3, -0.2, 0.5, 0.7, -0.4],
        loads: vec![[300.0, 200.0, -100.0, 20.0, 0.0, 0.0], [-400.0, 500.0, 600.0, 0.0, 0.0, 30.0]],
    };
    let Data::Displacement(data) = shown.data(core::slice::from_ref(&visit), &Rigged::default()) else { panic!() };
    let observation = Displacement::new(&campaign.robot, &data);
    let source = &shown.source;
    let column = |&which: &usize| -> DVector<f64> {
        let value = source.values[which];
        let step = if source.parameters[which].unit == "m" { 1e-4 } else { 1e-8 };
        let read = |by: f64| {
            let mut values = source.values.clone();
            values[which] = value + by;
            observation.predict(&shown.world, &source.parameters, &values)
        };
        (read(step) - read(-step)) / (2.0 * step)
    };
    let columns: Vec<DVector<f64>> = source.kept.iter().map(column).collect();
    let columns = DMatrix::from_columns(&columns);
    assert_eq!(shown.noise.growth, 0.0);
    // Both rows share an unloaded reading; forces are those of the discrepancy.
    let force = |row: usize| nalgebra::Vector3::from_column_slice(&visit.loads[row][..3]) / shown.end.load;
    let covariance = DMatrix::from_fn(6, 6, |i, j| {
        let (a, b) = (i / 3, j / 3);
        let same = if i % 3 == j % 3 { 1.0 } else { 0.0 };
        let own = if i == j { 1.0 } else { 0.0 };
        own + same * (shown.noise.shared + shown.kappa * force(a).dot(&force(b)))
    });
    let expected = columns.tr_mul(&covariance.cholesky().expect("positive").solve(&columns));
    let found = shown.information(&[visit], None).pop().expect("one visit");
    for (i, j) in (0..found.nrows()).flat_map(|i| (0..found.ncols()).map(move |j| (i, j))) {
        let scale = (expected[(i, i)] * expected[(j, j)]).sqrt();
        // Beyond first order joints carry loads on other levers: some 0.2 % of a displacement.
        assert!((found[(i, j)] - expected[(i, j)]).abs() <= 0.01 * scale, "{i} {j}");
    }
}

/// Each measurement tells two effects further apart, and makes every number better known.
#[test]
fn a_plan_separates_two_effects() {
    let bending = Effect::LinkCompliance { link: 3, bending: 3e-7, torsion: 0.0 };
    let campaign = measured(&[TILT], drawn(14), Measures::Displacements(forces()));
    let found = between(&campaign, &[TILT, bending], OPTIONS);
    let [pair] = &found.pairs[..] else { panic!("{:?}", found.pairs) };
    assert!(pair.outlook == Outlook::Separable && pair.after > pair.now && pair.angle > 0.01, "{pair:?}");
    assert!(found.proposals.iter().all(|planned| planned.separates == Some(0)));
    let mut last = pair.now;
    for planned in &found.proposals {
        assert!(planned.separation[0] >= last);
        last = planned.separation[0];
    }
    assert!((last - pair.after).abs() < 1e-6 * last);
    assert!(found.numbers.iter().all(|number| number.after <= number.now));
}

/// A base that shifts is a spindle that shifts, whatever is read.
#[test]
fn exact_aliases_have_no_remedy() {
    let base = Effect::BaseCompliance { tilt: 0.0, translation: 2e-7 };
    let spindle = Effect::ToolCompliance { rotation: 0.0, translation: 2e-7 };
    let campaign = measured(&[base], drawn(14), Measures::Displacements(forces()));
    let found = between(&campaign, &[base, spindle], OPTIONS);
    let [pair] = &found.pairs[..] else { panic!("{:?}", found.pairs) };
    assert!(pair.outlook == Outlook::Alias && pair.angle < 1e-3, "{pair:?}");
    assert_eq!(pair.remedies, []);
}

/// Of absolute positions without payloads the numbers of the table are to be known better.
#[test]
fn positions_sharpen_the_table() {
    let payloads = UnderPayloads { payloads: vec![0.0], repeatability: 0.0 };
    let campaign = measured(&[], drawn(16), Measures::Positions(payloads));
    let found = plan(&campaign, &silent(&campaign), &OPTIONS).expect("planned");
    let kinds = |kind: &str| found.numbers.iter().filter(|number| number.name.starts_with(kind)).count();
    assert!(kinds("joint_zero_offset@") >= 1 && kinds("dh_error@") >= 5, "{:?}", found.numbers);
    assert!(found.numbers.iter().all(|number| number.after < number.now), "{:?}", found.numbers);
    assert!(found.proposals.iter().all(|planned| planned.visit.loads == [[0.0; 6]]));
}

/// A campaign of few poses tells nothing of what is missing; the description's own numbers can be known
/// better all the same.
#[test]
fn few_poses_are_followed_by_more() {
    let campaign = measured(&[], drawn(5), Measures::Displacements(forces()));
    let trace = traced(&campaign);
    assert_eq!(trace.verdict, trace::Verdict::Insufficient);
    let found = plan(&campaign, &trace, &OPTIONS).expect("planned");
    assert_eq!(found.numbers.len(), 5);
    assert!(found.numbers.iter().all(|number| number.after < number.now && number.name.starts_with("joint ")));
    let other = measured(&[], drawn(20), Measures::Displacements(forces()));
    let refused = plan(&campaign, &traced(&other), &OPTIONS).expect_err("another campaign's");
    assert!(refused.to_string().contains("of another campaign"), "{refused}");
}
