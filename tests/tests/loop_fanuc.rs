//! The loop on a measured robot: 43 loads on a FANUC R-2000iC lack something
//! that looks like the tilt of joint 3, and more that looks like frames; the description that tracing writes
//! predicts what was promised, in every way it can be used, compiled too.
//!
//! The figures are checked against a least squares fit of its own whose columns
//! come from the simulator: what the arm with one spring alone does.

mod user;

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use nalgebra::{DMatrix, DVector, SVector, Vector6};
use robstiff::{Effect, Generic, Robot};
use robstiff_codegen::{Function, symbolic};
use robstiff_identify::campaign::{Campaign, Data, Observation};
use robstiff_identify::predict::predict;
use robstiff_identify::trace::{Options, Trace, Verdict, trace};
use robstiff_robots::Description;
use robstiff_tests::simulator::Arm;
use user::User;

static CAMPAIGN: LazyLock<Campaign> = LazyLock::new(|| {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/measured/fanuc-r2000ic/campaign.yaml");
    Campaign::read(path).unwrap_or_else(|problem| panic!("{problem}"))
});

static TRACE: LazyLock<Trace> =
    LazyLock::new(|| trace(&CAMPAIGN, &Options::default(), &|_| {}).unwrap_or_else(|problem| panic!("{problem}")));

fn rows() -> &'static [Observation] {
    data_of(&CAMPAIGN)
}

fn data_of(campaign: &Campaign) -> &[Observation] {
    let Data::Displacement(data) = &campaign.data else { panic!("a campaign of displacements") };
    &data.rows
}

/// Root mean square of the whole vector, of that of one axis (mm).
fn whole(rms: f64) -> f64 {
    1e3 * rms * 3_f64.sqrt()
}

/// Asserts a number within a fraction of itself.
#[track_caller]
fn assert_near(what: &str, found: f64, expected: f64, fraction: f64) {
    assert!((found / expected - 1.0).abs() <= fraction, "{what}: {found:e}, expected {expected:e}");
}

#[test]
fn more_than_the_joints_gives_way() {
    let found = &*TRACE;
    assert_eq!((found.rows, found.poses, found.held_out.len()), (43, 43, 0));
    assert_near("joints only (mm)", whole(found.identified.rms), 0.372, 2e-3);
    assert_near("joints only, in five folds (mm)", whole(found.identified.holdout_rms), 0.387, 5e-3);
    assert!(found.declared.rms > found.identified.rms);

    assert!(whole(found.after.rms) < 0.2 && whole(found.after.holdout_rms) < 0.22, "{:?}", found.after);
    // Whether joint 3 tilts or the link behind it bends, these data do not decide.
    let near_joint_3 = |name: &String| name == "transverse_compliance@joint 3" || name == "link_compliance@link 3";
    assert!(found.effects.iter().all(|named| named.partial));
    let of_class = found.effects.iter().map(|named| &named.class).chain(found.suspected.iter().map(|of| &of.class));
    let names: Vec<&String> = of_class.flatten().map(|(name, _)| name).collect();
    assert!(names.into_iter().any(near_joint_3), "{:?} {:?}", found.effects, found.suspected);
    // Nothing but what the model leaves says how large the noise is.
    assert_eq!(found.verdict, Verdict::Partial);
    assert!((0.0..1.0).contains(&found.unexplained) && !found.why.is_empty());
}

/// Readings per unit of each joint's compliance, and of the tilt of joint 3: the
/// simulated arm with that spring alone, so stiff that it hardly moves, and with
/// half the difference to the opposite load, which leaves what is linear.
fn columns() -> DMatrix<f64> {
    const STIFF: f64 = 1e-9;
    let mut columns = DMatrix::zeros(3 * rows().len(), 7);
    for k in 0..7 {
        let mut rigid = CAMPAIGN.robot.clone();
        for (i, joint) in rigid.joints.iter_mut().enumerate() {
            joint.compliance[0].value = if i == k { STIFF } else { 0.0 };
        }
        let tilt = [Effect::TransverseCompliance { joint: 3, value: STIFF }];
        let arm = Arm::new(&rigid, if k == 6 { &tilt } else { &[] });
        for (i, row) in rows().iter().enumerate() {
            let posed = arm.at(&row.q);
            let [there, back] = [1.0, -1.0].map(|sign| posed.settle(&row.wrench.map(|w| sign * w)).displacement);
            for axis in 0..3 {
                columns[(3 * i + axis, k)] = (there[axis] - back[axis]) / 2.0 / STIFF;
            }
        }
    }
    columns
}

fn readings() -> DVector<f64> {
    DVector::from_iterator(3 * rows().len(), rows().iter().flat_map(|row| row.displacement))
}

/// Ordinary least squares; the coefficients, their fit's rms and that of each
/// row predicted by the fit to the others (both m, of one axis).
fn least_squares(columns: &DMatrix<f64>, readings: &DVector<f64>) -> (DVector<f64>, f64, f64) {
    let solve = |columns: &DMatrix<f64>, readings: &DVector<f64>| {
        // Compliances differ by powers of ten, their columns do not matter less.
        columns.clone().svd(true, true).solve(readings, 1e-12).expect("both bases were asked for")
    };
    let all = solve(columns, readings);
    let size = readings.len() as f64;
    let unseen: f64 = (0..readings.len() / 3)
        .map(|row| {
            let others: Vec<usize> = (0..readings.len()).filter(|i| i / 3 != row).collect();
            let fitted = solve(&columns.select_rows(&others), &readings.select_rows(&others));
            (readings.rows(3 * row, 3) - columns.rows(3 * row, 3) * fitted).norm_squared()
        })
        .sum();
    let rms = ((readings - columns * &all).norm_squared() / size).sqrt();
    (all, rms, (unseen / size).sqrt())
}

#[test]
fn another_least_squares_finds_the_same() {
    let (found, columns, readings) = (&*TRACE, columns(), readings());
    // The library takes the second order of the joints' deflections from the
    // readings, some 0.2 % of them, which is what the two may differ by.
    let (joints, rms, unseen) = least_squares(&columns.columns(0, 6).into_owned(), &readings);
    assert_near("joints only", rms, found.identified.rms, 3e-3);
    // Here each pose is left out by itself, there a fifth of them.
    assert_near("joints only, each left out", unseen, found.identified.holdout_rms, 0.05);
    for (estimate, own) in found.estimates_before.iter().zip(joints.iter()) {
        // A trace weighs poses by what each of them leaves.
        let (off, std) = ((own - estimate.value).abs(), estimate.std.unwrap_or(f64::INFINITY));
        assert!(off < 2.0 * std, "{}: {own:e}, expected {:e} +- {std:e}", estimate.name, estimate.value);
    }

    let (all, _, tilted) = least_squares(&columns, &readings);
    assert!(tilted < unseen, "{tilted} {unseen}");
    // As they are, no compliance had to be kept from being negative.
    assert!(all.iter().chain(joints.iter()).all(|&value| value > 0.0));
}

/// A displacement per row (m).
type Displacements = Vec<[f64; 3]>;

/// Asserts displacements that are the same to a fraction of the largest component of each.
#[track_caller]
fn assert_same(what: &str, found: &Displacements, expected: &Displacements, fraction: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (row, (found, expected)) in found.iter().zip(expected).enumerate() {
        let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).abs() <= fraction * largest, "{what}, row {row}: {found:?}, expected {expected:?}");
        }
    }
}

#[test]
fn the_description_predicts_what_was_promised_in_every_way() {
    let written = TRACE.description.to_yaml();
    let read = Description::parse("robot.yaml", &written).unwrap_or_else(|problem| panic!("{problem}"));
    assert_eq!(read, TRACE.description);
    let of_robot: Vec<Effect> = TRACE.effects.iter().filter_map(|named| named.effect.effect()).collect();
    // All that predicts is written, what is named among it.
    assert!(of_robot.iter().all(|effect| read.effects.contains(effect)), "{of_robot:?} {:?}", read.effects);

    let prediction = predict(&read, &CAMPAIGN).expect("the campaign's robot");
    // Of the readings as they are: faults of the rig are not in a description.
    assert!(TRACE.after.rms < prediction.rms && prediction.rms < TRACE.declared.rms, "{}", prediction.rms);
    let before = predict(&CAMPAIGN.robot, &CAMPAIGN).expect("the campaign's robot");
    assert_near("the error as declared", before.rms, TRACE.declared.rms, 1e-9);

    // A prediction has the arm carry its loads where these have moved it, which light ones do not.
    let mut light = CAMPAIGN.clone();
    let Data::Displacement(data) = &mut light.data else { panic!("a campaign of displacements") };
    data.rows.iter_mut().for_each(|row| row.wrench = row.wrench.map(|w| LIGHT * w));
    let predicted = predict(&read, &light).expect("the campaign's robot");
    let predicted: Displacements = predicted.rows.iter().map(|row| row.predicted).collect();
    assert_same(
        "read at run time",
        &data_of(&light).iter().map(|row| of_generic(&read, row)).collect(),
        &predicted,
        1e-6,
    );
    let whole: Displacements = prediction.rows.iter().map(|row| row.predicted).collect();
    let at_once: Displacements = rows().iter().map(|row| of_generic(&read, row)).collect();
    assert_same("under the loads", &at_once, &whole, 0.02);

    let function = Function::of(|graph| symbolic::deflection(graph, &read));
    let of_function = |row: &Observation| {
        let moved = function.evaluate(&row.q, &row.wrench);
        [moved[0], moved[1], moved[2]]
    };
    assert_same("generated", &rows().iter().map(of_function).collect(), &at_once, 1e-12);
}

/// Loads so many times as small have no second order that matters.
const LIGHT: f64 = 1e-4;

/// What a description makes of a load, read at run time.
fn of_generic(description: &Description, row: &Observation) -> [f64; 3] {
    let generic = Generic::<6>::new(description).expect("six joints");
    let moved = generic.deflection(&SVector::from_column_slice(&row.q), &Vector6::from_column_slice(&row.wrench));
    [moved[0], moved[1], moved[2]]
}

#[test]
fn the_description_compiles_and_the_program_agrees() {
    let user = User::new("traced");
    fs::write(user.folder.join("robot.yaml"), TRACE.description.to_yaml()).expect("the copy can be written");
    let chosen = [0, 7, 21, 42];
    let line = |row: &usize| {
        let row = &rows()[*row];
        let numbers: Vec<String> = row.q.iter().chain(&row.wrench).map(f64::to_string).collect();
        numbers.join(" ") + "\n"
    };
    fs::write(user.folder.join("loads.txt"), chosen.iter().map(line).collect::<String>())
        .expect("the copy can be written");

    let of_robot = &TRACE.description.effects;
    let printed = user.prints();
    let mut lines = printed.lines();
    assert_eq!(lines.next(), Some(format!("{of_robot:?}").as_str()));
    let moved = |line: &str| -> [f64; 3] {
        let numbers: Vec<f64> = line.split(' ').map(|number| number.parse().expect("a number")).collect();
        numbers.try_into().expect("three numbers")
    };
    let expected = chosen.map(|row| of_generic(&TRACE.description, &rows()[row])).to_vec();
    assert_same("compiled", &lines.map(moved).collect(), &expected, 1e-12);
}
