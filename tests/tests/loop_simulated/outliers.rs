//! What looks like outliers, or like a slip, and is not for sure.

use nalgebra::{SVector, Vector6};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff::{Effect, Generic, Robot};
use robstiff_identify::trace::{Trace, Verdict};
use robstiff_tests::simulator::{Hidden, Row, Scenario, Simulated, six_axis};

use crate::bench::{arm, assert_most, plan, stands_for, trace_files};

/// The torque on joint 2 of the six-axis arm (Nm).
fn torque(generic: &Generic<6>, row: &Row) -> f64 {
    let q = SVector::from_column_slice(&row.q);
    let jacobian = generic.jacobian(&q);
    jacobian.column(1).dot(&Vector6::from_column_slice(&row.acting))
}

/// Of so many poses with five rows each, the 36 that load joint 2 least and the four
/// that load it most.
fn few_load_it(scenario: &Scenario) -> Simulated {
    let generic = Generic::<6>::new(&scenario.truth).expect("six joints");
    let mut simulated = scenario.run();
    let mut largest = vec![(0.0_f64, 0); scenario.poses];
    for row in &simulated.rows {
        let known = &mut largest[row.pose];
        *known = (known.0.max(torque(&generic, row).abs()), row.pose);
    }
    largest.sort_by(|a, b| a.0.total_cmp(&b.0));
    let kept: Vec<usize> = largest[..36].iter().chain(&largest[largest.len() - 4..]).map(|&(_, pose)| pose).collect();
    simulated.rows.retain(|row| kept.contains(&row.pose));
    simulated
}

/// Four poses stand out from the others, but they are no outlying readings: a gear has a curve.
#[test]
fn a_curve_that_few_poses_load() {
    let arm = six_axis();
    let curve = |added, knee| Effect::StiffnessNonlinearity { joint: 2, added, knee };
    let trace = |seed, curve| {
        let scenario = Scenario { poses: 400, visits: 1, ..plan(&arm, &[curve], seed) };
        (seed, trace_files(&few_load_it(&scenario), &arm, ""))
    };
    let (hardens, softens) = (curve(3e-7, 1000.0), curve(-1.2e-7, 1600.0));
    let traces: Vec<(u64, Trace)> =
        (700..703).flat_map(|seed| [hardens, softens].map(|curve| trace(seed, curve))).collect();
    assert_most("a curve that few poses load", 5, &traces, |_, trace| {
        trace.effects.iter().all(|named| stands_for(named, &hardens))
    });
}

/// The readings of each pose with noise of one to four times the usual.
fn noisier(mut simulated: Simulated) -> Simulated {
    let mut random = ChaCha8Rng::seed_from_u64(simulated.scenario.seed);
    let times: Vec<f64> = (0..simulated.scenario.poses).map(|_| 4_f64.powf(random.random_range(0.0..1.0))).collect();
    for row in &mut simulated.rows {
        for (read, exact) in row.displacement.iter_mut().zip(row.exact_displacement) {
            *read = exact + times[row.pose] * (*read - exact);
        }
    }
    simulated
}

/// Six campaigns, carried out as `run` does.
fn traces(first: u64, run: impl Fn(Scenario) -> Simulated) -> Vec<(u64, Trace)> {
    let trace = |seed| (seed, trace_files(&run(plan(&arm(seed), &[], seed)), &arm(seed), ""));
    (first..first + 6).map(trace).collect()
}

/// An arm that trembles where it hangs far out: in noise of the same size everywhere,
/// nine of ten such campaigns would have outliers or a slip.
#[test]
fn noise_that_differs_from_pose_to_pose() {
    let traces = traces(710, |scenario| noisier(scenario.run()));
    assert_most("noise by pose", 5, &traces, |_, trace| trace.effects.is_empty());
}

/// What goes beyond it is found all the same: four rows of the visit in which the base slips. Where the noise of
/// the pose is as large, they are part of it.
#[test]
fn a_slip_in_noise_that_differs() {
    let slip = Hidden::BaseSlip { shift: [3e-4, -2e-4, 2e-4], turn: [0.0; 3], when: 0.503 };
    let traces = traces(710, |scenario| noisier(scenario.hiding(slip.clone()).run()));
    let of = |trace: &Trace| -> Vec<String> { trace.effects.iter().map(|named| named.effect.to_string()).collect() };
    assert_most("a slip in noise by pose", 4, &traces, |_, trace| of(trace) == ["outliers@rig"]);
    assert_most("nothing else", 6, &traces, |_, trace| of(trace).iter().all(|name| name == "outliers@rig"));
}

/// A force that is held to a tenth of what it should be: the largest residuals are
/// where the arm gives way furthest, and no outlying rows.
#[test]
fn noise_in_proportion_to_the_displacement() {
    let traces = traces(720, |scenario| {
        let mut simulated = scenario.run();
        let mut random = ChaCha8Rng::seed_from_u64(simulated.scenario.seed);
        for row in &mut simulated.rows {
            let times = random.random_range(0.9..1.1);
            row.displacement.iter_mut().for_each(|length| *length *= times);
        }
        simulated
    });
    assert_most("noise in proportion", 5, &traces, |_, trace| {
        trace.effects.is_empty() && matches!(trace.verdict, Verdict::Adequate | Verdict::Unexplained)
    });
}

/// The largest of a thousand such readings are ten standard deviations off and belong
/// to the others.
#[test]
fn noise_with_heavy_tails() {
    let traces = traces(730, |scenario| Scenario { tails: Some(3), ..scenario }.run());
    assert_most("heavy tails", 5, &traces, |_, trace| trace.effects.is_empty());
}

/// A reading that is off by far more is found in it, at most with the largest of the others.
#[test]
fn an_outlier_among_heavy_tails() {
    let traces = traces(730, |scenario| {
        let mut simulated = Scenario { tails: Some(3), ..scenario }.run();
        simulated.rows[77].displacement[1] += 3e-3;
        simulated
    });
    assert_most("an outlier among heavy tails", 5, &traces, |_, trace| {
        let [outlier] = &trace.effects[..] else { return false };
        outlier.lines.contains(&79) && outlier.lines.len() <= 2
    });
}
