//! What is predicted is what the runtime says, to second order in joints.

use nalgebra::{Matrix4, SVector, Vector3, Vector6};
use robstiff::elements::deformed;
use robstiff::{DhEntry, Effect, Generic, Robot, State};
use robstiff_robots::effect::gravity_sag::GRAVITY;
use robstiff_robots::samples::{five_axis, odd, poses};
use robstiff_robots::{Description, Link};

use super::predict;
use crate::campaign::made::{Plan, campaign, displacements};
use crate::campaign::made_positions;
use crate::campaign::{Campaign, Data, Displacements, Frame, PositionRow, Positions};

/// An arm with an effect of every kind.
fn with_all_effects() -> Description {
    let mut robot = odd();
    let link = |k: f64| Link { mass: 100.0 - 10.0 * k, center_of_mass: [0.1 * k, -0.2, 0.05] };
    robot.links = (0..6).map(|k| link(f64::from(k))).collect();
    robot.effects = vec![
        Effect::TransverseCompliance { joint: 3, value: 6e-7 },
        Effect::LinkCompliance { link: 2, bending: 3e-7, torsion: 2e-7 },
        Effect::BaseCompliance { tilt: 1e-7, translation: 1e-8 },
        Effect::ToolCompliance { rotation: 4e-7, translation: 2e-8 },
        Effect::JointCoupling { joints: [4, 5], value: 1e-7 },
        Effect::StiffnessNonlinearity { joint: 2, added: 2e-7, knee: 0.5 },
        Effect::LostMotion { joint: 3, gap: 1e-7, knee: 0.4 },
        Effect::Hysteresis {
            joint: 4,
            radius1: 0.1,
            weight1: 3e-7,
            radius2: 0.3,
            weight2: 1e-7,
            radius3: 0.0,
            weight3: 0.0,
        },
        Effect::PoseDependentCompliance { joint: 2, cos1: 0.3, sin1: -0.2, cos2: 0.1, sin2: 0.05 },
        Effect::JointZeroOffset { joint: 3, value: 0.02 },
        Effect::DhError { entry: DhEntry::A(2), value: 5e-3 },
        Effect::TransmissionError { joint: 2, order: 2.0, sin: 1e-3, cos: -5e-4 },
        Effect::GravitySag { share: 0.5 },
    ];
    robot
}

/// Visits of five loads each (N, Nm), in the frame and at the points of a tool that is not the flange.
fn loads(robot: &Description, newtons: f64) -> Displacements {
    let plan = Plan { robot: robot.clone(), poses: 8, ramp: vec![0.4, 1.0, -0.7, 0.2], ..Plan::new(3) };
    let mut data = displacements(&plan.run()).clone();
    for row in &mut data.rows {
        let largest = row.wrench.iter().map(|w| w * w).sum::<f64>().sqrt();
        row.wrench = row.wrench.map(|w| w * newtons / largest * (1.0 + (row.line % 4) as f64));
    }
    (data.wrench_frame, data.wrench_at) = (Frame::Tool, [0.1, -0.05, 0.2]);
    (data.measured_frame, data.measured_at) = (Frame::Tool, [-0.1, 0.02, 0.15]);
    data
}

/// The largest difference between what is predicted in the base frame and what something else has there,
/// over the largest displacement.
fn off(robot: &Description, data: &Displacements, of: impl Fn(usize) -> Vector3<f64>) -> f64 {
    let found = predict(robot, &campaign(robot.clone(), Data::Displacement(data.clone()))).expect("displacements");
    let differences =
        found.rows.iter().enumerate().map(|(row, found)| (Vector3::from(found.predicted) - of(row)).norm());
    let largest = found.rows.iter().map(|found| Vector3::from(found.predicted).norm()).fold(0.0, f64::max);
    differences.fold(0.0, f64::max) / largest
}

/// The wrench of a row at the tool centre point that stands somewhere, in the base frame.
fn wrench(data: &Displacements, row: usize, force: &Vector3<f64>, tcp: &Matrix4<f64>) -> Vector6<f64> {
    let arm = tcp.fixed_view::<3, 3>(0, 0) * Vector3::from(data.wrench_at);
    let moment = arm.cross(force) + Vector3::from_column_slice(&data.rows[row].wrench[3..]);
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// At loads so small that the second order is nothing, with every effect that there is.
#[test]
fn light_loads_deflect_as_the_runtime_says() {
    let described = with_all_effects();
    let robot = Generic::<6>::new(&described).expect("six joints");
    let data = loads(&described, 0.5);
    let mut moved = Vec::new();
    let (mut state, mut visit) = (State::new(), None);
    for (i, row) in data.rows.iter().enumerate() {
        if visit != Some(row.visit) {
            (state, visit) = (State::new(), Some(row.visit));
        }
        let q = SVector::from_column_slice(&row.q);
        let tcp = robot.transform(&q);
        let tool = tcp.fixed_view::<3, 3>(0, 0).into_owned();
        let force = tool * Vector3::from_column_slice(&row.wrench[..3]);
        let twist = robot.deflection_with(&q, &wrench(&data, i, &force, &tcp), &mut state);
        let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
        moved.push(twist.fixed_rows::<3>(0) + turn.cross(&(tool * Vector3::from(data.measured_at))));
    }
    // The tool stands aside by some mrad of where the controller has it, and readings are in its frame.
    let off = off(&described, &data, |row| moved[row]);
    assert!(off < 1e-5, "{off}");
}

/// Joints carry heavy loads where these have taken them, as the runtime says.
#[test]
fn heavy_loads_act_on_the_moved_arm() {
    let described = odd();
    let robot = Generic::<6>::new(&described).expect("six joints");
    let data = loads(&described, 500.0);
    let of = |row: usize, is_moved: bool| {
        let q = SVector::from_column_slice(&data.rows[row].q);
        let tcp = robot.transform(&q);
        let tool = tcp.fixed_view::<3, 3>(0, 0).into_owned();
        let force = tool * Vector3::from_column_slice(&data.rows[row].wrench[..3]);
        let marker = tool * Vector3::from(data.measured_at);
        let twist = match is_moved {
            true => {
                let load = |tcp: &Matrix4<f64>| wrench(&data, row, &force, tcp);
                return deformed(&robot, &q, load, &mut State::new())
                    .displacement_at(&marker)
                    .fixed_rows::<3>(0)
                    .into();
            }
            false => robot.deflection(&q, &wrench(&data, row, &force, &tcp)),
        };
        let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
        twist.fixed_rows::<3>(0) + turn.cross(&marker)
    };
    let [second, rest] = [false, true].map(|is_moved| off(&described, &data, |row| of(row, is_moved)));
    assert!(second > 1e-3 && rest < 1e-2 * second, "{second} {rest}");
}

/// Payloads likewise, wherever the tracker stands.
#[test]
fn positions_are_those_of_the_moved_arm() {
    for (described, most) in [(odd(), 1e-7), (with_all_effects(), 2e-5)] {
        let robot = Generic::<6>::new(&described).expect("six joints");
        let mut data = Positions {
            payload_at: [0.0, 0.05, 0.2],
            measured_at: [0.02, -0.03, 0.15],
            poses: Vec::new(),
            visits: Vec::new(),
            rows: Vec::new(),
        };
        for (pose, q) in poses::<6>().enumerate() {
            data.poses.push(pose.to_string());
            data.visits.push(pose.to_string());
            for payload in [0.0, 200.0] {
                let load = |tcp: &Matrix4<f64>| {
                    let force = Vector3::new(0.0, 0.0, -GRAVITY * payload);
                    let moment = (tcp.fixed_view::<3, 3>(0, 0) * Vector3::from(data.payload_at)).cross(&force);
                    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
                };
                let tcp = deformed(&robot, &SVector::from(q), load, &mut State::new()).tcp;
                let position = tcp.transform_point(&nalgebra::Point3::from(data.measured_at)).coords;
                let line = data.rows.len() + 2;
                let row = PositionRow {
                    line,
                    pose,
                    visit: pose,
                    time: None,
                    temperature: None,
                    q: q.to_vec(),
                    position: position.into(),
                    payload,
                };
                data.rows.push(row);
            }
        }
        let of = |data: &Positions| {
            predict(&described, &campaign(described.clone(), Data::Position(data.clone()))).expect("positions").max
        };
        assert!(of(&data) < most, "{}", of(&data));
        // Seen from elsewhere.
        let mut moved = data.clone();
        moved
            .rows
            .iter_mut()
            .for_each(|row| row.position = [3.0 - row.position[1], row.position[0], row.position[2] - 1.0]);
        assert!((of(&moved) - of(&data)).abs() < 1e-12);
    }
}

/// What is predicted of positions that are exact is exact, and two do not tell where the robot stands.
#[test]
fn exact_positions_are_predicted() {
    let plan = made_positions::Plan {
        noise: 0.0,
        payloads: vec![80.0],
        hidden: vec![Effect::TransmissionError { joint: 2, order: 1.0, sin: 1e-3, cos: -2e-3 }],
        ..made_positions::Plan::new(five_axis(), 4)
    };
    let exact: Campaign = plan.run();
    assert!(predict(&exact.robot, &exact).expect("positions").rms > 1e-4);
    let mut told = exact.robot.clone();
    told.effects.clone_from(&plan.hidden);
    assert!(predict(&told, &exact).expect("positions").max < 1e-12);
    let two = made_positions::Plan { poses: 2, ..plan }.run();
    let why = predict(&two.robot, &two).expect_err("two positions").to_string();
    assert!(why.contains("do not tell where the robot stands"), "{why}");
}
