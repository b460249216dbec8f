use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{SVector, Vector3, Vector6};
use robstiff_robots::{Description, DhEntry, Effect, catalogue};

use super::{Part, Scenario, Simulated, simulate};
use crate::campaign::made::campaign;
use crate::campaign::{Data, Displacements};
use crate::predict::{PredictedRow, Prediction, predict};
use robstiff::{Generic, Robot, State};

const SCENARIO: &str = "\
name: a try
seed: 4
poses: {count: 30, floor: 100 mm, column: 600 mm}
visits: 2
ramp: [0.5, 1, -0.25]
force: {bounds: [500 N, 1.3 kN]}
noise: {displacement: 8 um}
hidden:
  effects:
    - {kind: transverse_compliance, at: joint 3, value: 6e-7 rad/Nm}
scatter: 0.3
";

fn robot() -> Description {
    let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
    Description::parse("robot.yaml", text).expect("of the catalogue")
}

fn read(text: &str) -> Scenario {
    Scenario::parse("try.yaml", text, &robot()).unwrap_or_else(|problems| panic!("{problems}"))
}

fn simulated(text: &str) -> (Simulated, Displacements) {
    let found = simulate(&robot(), &read(text)).expect("it can be measured");
    let Data::Displacement(data) = found.data.clone() else { unreachable!("displacements") };
    (found, data)
}

fn problem(text: &str) -> String {
    Scenario::parse("try.yaml", text, &robot()).expect_err("it has a mistake").to_string()
}

#[test]
fn the_seed_says_it_all_and_noise_keeps_the_rest() {
    let rows = |text: &str| simulated(text).1.rows;
    assert_eq!(rows(SCENARIO), rows(SCENARIO));
    assert_ne!(rows(SCENARIO), rows(&SCENARIO.replace("seed: 4", "seed: 5")));
    let louder = rows(&SCENARIO.replace("8 um", "80 um"));
    for (one, other) in rows(SCENARIO).iter().zip(&louder) {
        assert_eq!((&one.q, one.wrench), (&other.q, other.wrench));
        assert_ne!(one.displacement, other.displacement);
    }
}

#[test]
fn poses_and_loads_are_within_their_bounds() {
    let (found, data) = simulated(SCENARIO);
    assert_eq!(data.rows.len(), 180);
    for (i, row) in data.rows.iter().enumerate() {
        assert_eq!((row.pose, row.visit, row.line), (i / 6, i / 3, i + 2));
        assert!(row.q.iter().zip(&found.declared.joints).all(|(&q, joint)| joint.reaches(q)));
        let force = Vector6::from(row.wrench).norm();
        let share = [0.5, 1.0, 0.25][i % 3];
        assert!((500.0 * share - 1e-9..=1300.0 * share + 1e-9).contains(&force));
    }
    for (joint, declared) in found.truth.joints.iter().zip(&found.declared.joints) {
        assert!((0.7..=1.3).contains(&(joint.compliance() / declared.compliance())));
    }
}

/// An arm on a pedestal is drawn as the same arm on the ground.
#[test]
fn the_floor_is_that_of_the_base() {
    let poses = |robot: &Description| {
        let scenario = Scenario::parse("try.yaml", SCENARIO, robot).expect("it is a scenario");
        let Data::Displacement(data) = simulate(robot, &scenario).expect("it can be measured").data else {
            unreachable!("displacements")
        };
        data.rows.into_iter().map(|row| row.q).collect::<Vec<_>>()
    };
    let mut raised = robot();
    raised.base.xyz[2] += 3.0;
    assert_eq!(poses(&raised), poses(&robot()));
}

/// Against the trait's own deflection, at a load so small that its second order
/// is nothing; read beside the tool centre point, in the tool's frame.
#[test]
fn small_loads_deflect_as_the_robot_says() {
    let text = SCENARIO.replace("[500 N, 1.3 kN]", "[0.5 N, 1 N]").replace("8 um", "0 um")
        + "measured: {frame: tool, at: [0, 0, 0.1]}\n";
    let (found, data) = simulated(&text);
    let robot = Generic::<6>::new(&found.truth).expect("six joints");
    for row in &data.rows {
        let q = SVector::<f64, 6>::from_column_slice(&row.q);
        let twist = robot.deflection(&q, &Vector6::from(row.wrench));
        let tool = robot.transform(&q).fixed_view::<3, 3>(0, 0).into_owned();
        let lever = tool * Vector3::new(0.0, 0.0, 0.1);
        let moved = tool.transpose() * (twist.fixed_rows::<3>(0) + twist.fixed_rows::<3>(3).cross(&lever));
        let read = Vector3::from(row.displacement);
        assert!((read - moved).norm() < 1e-5 * moved.norm(), "{read} {moved}");
    }
}

/// Where a load returns to what it was, only what hysteresis remembers differs, and
/// the next visit begins without it; at loads so small that the second order is nothing.
#[test]
fn hysteresis_remembers_the_loads_of_a_visit() {
    let hidden = "{kind: hysteresis, at: joint 2, radius1: 0.1 Nm, weight1: 3e-7 rad/Nm}";
    let text = SCENARIO
        .replace("[0.5, 1, -0.25]", "[0.5, 1, 0.5]")
        .replace("[500 N, 1.3 kN]", "[0.5 N, 1.3 N]")
        .replace("8 um", "0 um")
        .replace("{kind: transverse_compliance, at: joint 3, value: 6e-7 rad/Nm}", hidden);
    let (found, data) = simulated(&text);
    let robot = Generic::<6>::new(&found.truth).expect("six joints");
    let mut largest: f64 = 0.0;
    for visit in data.rows.chunks(3) {
        let q = SVector::<f64, 6>::from_column_slice(&visit[0].q);
        let mut state = State::new();
        let moved = [0, 1, 2].map(|row| robot.deflection_with(&q, &Vector6::from(visit[row].wrench), &mut state));
        let left = (moved[2] - moved[0]).fixed_rows::<3>(0).into_owned();
        let read = Vector3::from(visit[2].displacement) - Vector3::from(visit[0].displacement);
        assert!((read - left).norm() < 1e-5 * moved[1].norm(), "{read} {left}");
        largest = largest.max(left.norm());
    }
    assert!(largest > 20e-9, "{largest}");
}

/// What joints turn by moves the tool as the same robot without its bearing does,
/// at loads so small that the second order is nothing.
#[test]
fn encoders_read_what_joints_turn_by() {
    let hidden = "{kind: transverse_compliance, at: joint 3, value: 6e-7 rad/Nm}";
    let of_joints = "    - {kind: joint_coupling, at: \"joints 4,5\", value: 1e-6 rad/Nm}
    - {kind: stiffness_nonlinearity, at: joint 2, added: 1e-7 rad/Nm, knee: 1 Nm}
    - {kind: hysteresis, at: joint 3, radius1: 0.2 Nm, weight1: 1e-7 rad/Nm}
";
    let text = SCENARIO
        .replace("[500 N, 1.3 kN]", "[0.5 N, 1 N]")
        .replace("8 um", "0 um, encoders: 0 urad")
        .replace(hidden, &(String::from(hidden) + "\n" + of_joints.trim_end()));
    let (found, data) = simulated(&text);
    let mut without_bearing = found.truth.clone();
    without_bearing.effects.remove(0);
    let robot = Generic::<6>::new(&without_bearing).expect("six joints");
    for visit in data.rows.chunks(3) {
        let mut state = State::new();
        for row in visit {
            let q = SVector::<f64, 6>::from_column_slice(&row.q);
            let moved = robot.deflection_with(&q, &Vector6::from(row.wrench), &mut state);
            let read = SVector::<f64, 6>::from_column_slice(row.encoders.as_ref().expect("they are read"));
            let by_joints = robot.jacobian(&q) * (read - q);
            assert!((by_joints - moved).norm() < 1e-5 * moved.norm(), "{by_joints} {moved}");
        }
    }
}

#[test]
fn encoders_have_a_noise_of_their_own() {
    let rows = |noise: &str| {
        let text = SCENARIO.replace("8 um", &std::format!("8 um, encoders: {noise}"));
        simulated(&text).1.rows
    };
    let (mut squares, mut count) = ([0.0; 6], 0.0);
    for (exact, noisy) in rows("0 urad").iter().zip(&rows("[10 urad, 20 urad, 30 urad, 0, 5 urad, 1 mrad]")) {
        assert_eq!(exact.displacement, noisy.displacement);
        let [exact, noisy] = [exact, noisy].map(|row| row.encoders.as_ref().expect("they are read"));
        squares.iter_mut().zip(exact.iter().zip(noisy)).for_each(|(sum, (one, other))| *sum += (other - one).powi(2));
        count += 1.0;
    }
    for (squares, sigma) in squares.iter().zip([10e-6, 20e-6, 30e-6, 0.0, 5e-6, 1e-3]) {
        // 180 readings: 5.3 % of scatter, four times that is allowed.
        let found = (squares / count).sqrt();
        assert!((found - sigma).abs() <= 0.21 * sigma, "{found} {sigma}");
    }
}

#[test]
fn rows_of_a_visit_share_their_unloaded_reading_or_not() {
    // Half the difference of two rows of one load has the variance of a reading
    // where the unloaded one is shared, and twice that where it is not.
    let plan = |unloaded: &str| {
        let text = SCENARIO.replace("count: 30", "count: 1000").replace("[0.5, 1, -0.25]", "[1, 1]")
            + &std::format!("unloaded: {unloaded}\n");
        let rows = simulated(&text).1.rows;
        let halves: Vec<f64> =
            rows.chunks(2).map(|two| (two[0].displacement[1] - two[1].displacement[1]).powi(2) / 2.0).collect();
        halves.iter().sum::<f64>() / halves.len() as f64 / 8e-6_f64.powi(2)
    };
    // 2000 degrees of freedom: 3.2 % of scatter, four times that is allowed.
    assert!((plan("shared") - 1.0).abs() < 0.13);
    assert!((plan("separate") / 2.0 - 1.0).abs() < 0.13);
}

#[test]
fn mistakes_are_shown_where_they_are() {
    for (from, to, place, part) in [
        ("seed: 4", "seed: -4", "2:7", "a seed is not negative"),
        ("floor: 100 mm", "floor: 100 N", "3:27", "is a force, a length is expected"),
        ("count: 30", "count: 0", "3:16", "a number from 1 to 100000"),
        ("ramp: [0.5", "ramp: [1.5", "5:8", "between -1 and 1"),
        ("[500 N, 1.3 kN]", "[500 N, 13 N]", "6:17", "the lower one first"),
        ("joint 3", "joint 9", "10:41", "there is no joint 9"),
        ("noise:", "nioses:", "7:1", "unknown field"),
        ("8 um", "8 um, encoders: 8 um", "7:39", "is a length, an angle is expected"),
        ("8 um", "8 um, encoders: [8 urad]", "7:39", "for 6 joints"),
        ("scatter: 0.3", "scatter: 30", "11:10", "below 1"),
        ("visits: 2", "visits: 20000", "4:9", "1800000 rows, more than the 1000000"),
        ("[500 N, 1.3 kN]", "[0 N, 1e20 N]", "6:17", "beyond anything that is measured"),
        ("8 um", "1e20 um", "7:23", "beyond anything that is measured"),
        ("8 um", "[1 um, 1e20 um, 1 um]", "7:30", "beyond anything that is measured"),
        ("8 um", "8 um, encoders: 1e20 rad", "7:39", "at most 1e6 rad"),
        ("8 um", "8", "7:23", "8 m is more noise than any instrument has"),
        ("8 um", "[8 um, 8, 8 um]", "7:30", "in um? write `8 um`, or the unit if it is `8 m`"),
        ("8 um", "8 um, encoders: 5", "7:39", "in urad? write `5 urad`"),
        ("floor: 100 mm", "floor: 100", "3:27", "in mm? write `100 mm`"),
        (
            "{count: 30,",
            "{count: 30, within: [[-90, 1], [0, 1], [0, 1], [0, 1], [0, 1], [0, 1]],",
            "3:30",
            "write `-90 deg`, or the unit",
        ),
        ("{count: 30, floor: 100 mm, column: 600 mm}", "{list: [[0, 0, 0]]}", "3:16", "for 6 joints"),
        (
            "{count: 30,",
            "{count: 30, within: [[0, 9], [0, 1], [0, 1], [0, 1], [0, 1], [0, 1]],",
            "3:33",
            "outside its limits",
        ),
    ] {
        let text = problem(&SCENARIO.replace(from, to));
        assert!(text.contains(&std::format!("try.yaml:{place}")) && text.contains(part), "{text}");
    }
    // With its unit noise may be any.
    assert_eq!(read(&SCENARIO.replace("8 um", "8 m")).noise, [8.0; 3]);
    let mut limitless = robot();
    limitless.joints[1].limits = None;
    let text = Scenario::parse("try.yaml", SCENARIO, &limitless).expect_err("no limits").to_string();
    assert!(text.contains("gives joint 2 no limits") && text.contains("within:"), "{text}");
    let within = "count: 30, within: [[0, 1], [-1e20, 1e20], [0, 1], [0, 1], [0, 1], [0, 1]]";
    let text = SCENARIO.replace("count: 30", within);
    let text = Scenario::parse("try.yaml", &text, &limitless).expect_err("too wide").to_string();
    assert!(text.contains("try.yaml:3:38") && text.contains("at most 1e6 rad"), "{text}");
    let mut declares = robot();
    declares.effects = read(SCENARIO).hidden;
    let text = Scenario::parse("try.yaml", SCENARIO, &declares).expect_err("declared").to_string();
    assert!(text.contains("declares `transverse_compliance@joint 3` already"), "{text}");
    declares.effects = std::vec![Effect::DhError { entry: DhEntry::Theta(3), value: 1e-3 }];
    let offset = "{kind: joint_zero_offset, at: joint 3, value: 1 mrad}";
    let text = SCENARIO.replace("{kind: transverse_compliance, at: joint 3, value: 6e-7 rad/Nm}", offset);
    let text = Scenario::parse("try.yaml", &text, &declares).expect_err("one number").to_string();
    let said = "declares `dh_error@theta3` already, which is the same as `joint_zero_offset@joint 3`";
    assert!(text.contains(said), "{text}");
}

#[test]
fn directions_have_any_length() {
    let forces = |directions: &str| {
        let text = SCENARIO.replace("1.3 kN]}", &std::format!("1.3 kN], directions: {directions}}}"));
        simulated(&text).1.rows
    };
    let plain = forces("[[1, 0, 0], [1, -1, 0]]");
    for (row, plain) in forces("[[1e-29, 0, 0], [1e30, -1e30, 0]]").iter().zip(&plain) {
        assert!((Vector6::from(row.wrench) - Vector6::from(plain.wrench)).norm() < 1e-9, "{row:?} {plain:?}");
    }
}

/// Noise below any rounding is written as what it is: zero is no noise to a campaign.
#[test]
fn the_noise_that_is_stated_is_above_zero() {
    let stated = |noise: &str| {
        let found = simulate(&robot(), &read(&SCENARIO.replace("8 um", noise))).expect("it can be measured");
        let campaign = found.files().campaign;
        campaign.lines().find(|line| line.starts_with("noise:")).map(ToString::to_string).expect("it is stated")
    };
    assert_eq!(stated("8 um"), "noise: {displacement: 8 um}");
    assert_eq!(stated("1e-10 um"), "noise: {displacement: 0.0000000001 um}");
    assert!(stated("[3 um, 4 um, 0 um]").starts_with("noise: {displacement: 2.8867513459481"), "sqrt(25 / 3)");
    assert_eq!(stated("7 um, rotation: 1e-12 urad"), "noise: {displacement: 7 um, rotation: 0.000000000001 urad}");
}

const POSITIONS: &str = "\
kind: position
seed: 5
poses: {count: 50}
visits: 2
payloads: [0 kg, 120 kg]
wrench: {at: [0, 0, 200 mm]}
measured: {at: [40 mm, -20 mm, 110 mm]}
noise: {displacement: 20 um, repeatability: 30 um}
hidden:
  effects:
    - {kind: joint_zero_offset, at: joint 3, value: 0.1 deg}
scatter: 0.3
";

/// The robot goes through all poses, then through all again; what it misses one by is
/// common to a visit, and the truth predicts the rest to the noise.
#[test]
fn positions_are_read_under_payloads() {
    let found = simulate(&robot(), &read(POSITIONS)).expect("it can be measured");
    let Data::Position(data) = &found.data else { unreachable!("positions") };
    assert_eq!((data.rows.len(), data.poses.len(), data.visits.len()), (200, 50, 100));
    for (i, row) in data.rows.iter().enumerate() {
        assert_eq!((row.line, row.visit, row.pose), (i + 2, i / 2, i / 2 % 50));
        assert_eq!(row.payload, [0.0, 120.0][i % 2]);
    }
    let left = |description: &Description| {
        let campaign = campaign(description.clone(), found.data.clone());
        let Prediction { rows, rms, .. } = predict(description, &campaign).expect("positions");
        let off = |row: &PredictedRow| Vector3::from(row.measured) - Vector3::from(row.predicted);
        (rms, rows.iter().map(off).collect::<Vec<_>>())
    };
    let (rms, left_by_row) = left(&found.truth);
    // 600 readings: 3 % of scatter, four times that is allowed.
    let whole = 20e-6_f64.hypot(30e-6);
    assert!((rms / whole - 1.0).abs() < 0.12, "{rms}");
    let apart: f64 = left_by_row.chunks(2).map(|two| (two[1] - two[0]).norm_squared()).sum();
    let of_one = (apart / (2.0 * 300.0)).sqrt();
    assert!((of_one / 20e-6 - 1.0).abs() < 0.16, "{of_one}");
    assert!(left(&found.declared).0 > 10.0 * rms);
}

/// What is written is what was simulated.
#[test]
fn positions_are_written_with_all_their_digits() {
    let found = simulate(&robot(), &read(POSITIONS)).expect("it can be measured");
    let Data::Position(data) = &found.data else { unreachable!("positions") };
    let files = found.files();
    assert_eq!(files.observations.0, "positions.csv");
    assert!(files.campaign.contains("kind: position") && files.campaign.contains("observations: positions.csv"));
    assert!(files.campaign.contains("noise: {displacement: 36.05551275463"), "{}", files.campaign);
    let mut lines = files.observations.1.lines();
    let header = lines.next().expect("a header");
    assert!(header.ends_with(",q6 [deg],payload [kg],px [mm],py [mm],pz [mm]"), "{header}");
    for (line, row) in lines.zip(&data.rows) {
        let numbers: Vec<f64> = line.split(',').map(|number| number.parse().expect("a number")).collect();
        assert_eq!(numbers.len(), 13);
        assert!((numbers[10] / 1e3 - row.position[0]).abs() < 1e-15 && (numbers[9] - row.payload).abs() < 1e-12);
        assert!((numbers[3].to_radians() - row.q[0]).abs() < 1e-15);
    }
}

#[test]
fn each_kind_has_its_own_fields() {
    for (from, to, place, part) in [
        ("visits: 2", "ramp: [0.5, 1]", "4:7", "positions are read under payloads"),
        ("visits: 2", "force: {bounds: [500 N, 1300 N]}", "4:8", "positions are read under payloads"),
        ("120 kg", "-120 kg", "5:18", "negative"),
        ("[0 kg, 120 kg]", "[]", "5:11", "at least one payload"),
        ("120 kg", "120 N", "5:18", "is a force, a mass is expected"),
        ("repeatability: 30 um", "rotation: 3 urad", "8:30", "unknown field"),
        ("kind: position", "kind: positions", "1:7", "did you mean"),
        ("visits: 2", "visits: 20000", "4:9", "20000 visits of 2 payloads are 2000000 rows"),
    ] {
        let text = problem(&POSITIONS.replace(from, to));
        assert!(text.contains(&std::format!("try.yaml:{place}")) && text.contains(part), "{text}");
    }
    let text = problem(&(String::from(SCENARIO) + "payloads: [100 kg]\n"));
    assert!(text.contains("displacements are read under forces"), "{text}");
}

#[test]
fn what_cannot_be_measured_is_said() {
    // Longer than a file may say.
    let mut lever = read(SCENARIO);
    lever.wrench_at = [0.0, 0.0, 1e307];
    let error = simulate(&robot(), &lever).expect_err("nothing can be read");
    assert_eq!(error.part, Part::Loads);
    assert!(error.to_string().contains("beyond what a campaign may have"), "{error}");
    let text = SCENARIO.replace("floor: 100 mm", "floor: 90 m");
    let error = simulate(&robot(), &read(&text)).expect_err("nobody reaches there");
    let said = error.located("try.yaml", &text).to_string();
    assert!(said.contains("working region") && said.contains("(poses.floor)") && said.contains("90 m"), "{said}");
    // Of a coupling that only unscattered joints can have.
    let coupled = "    - {kind: joint_coupling, at: \"joints 2,3\", value: VALUE}\n";
    let values = robot().joints.iter().map(|joint| joint.compliance()).collect::<Vec<f64>>();
    let value = std::format!("{:e} rad/Nm", 0.95 * (values[1] * values[2]).sqrt());
    let text = SCENARIO.replace("scatter: 0.3", &(coupled.replace("VALUE", &value) + "scatter: 0.9"));
    let refused = (0..40).find_map(|seed| simulate(&robot(), &Scenario { seed, ..read(&text) }).err());
    let refused = refused.expect("some of forty are scattered too far");
    assert_eq!(refused.part, Part::Hidden(1));
    let said = refused.located("try.yaml", &text).to_string();
    assert!(said.contains("(hidden.effects[1]") && said.contains("once its joints are scattered"), "{said}");
}
