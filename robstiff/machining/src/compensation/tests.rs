use nalgebra::{SVector, Unit, Vector3, Vector6};
use proptest::prelude::*;
use robstiff_robots::Description;

use super::*;
use crate::deviation::tests::{cut, described, solved};
use crate::deviation::{ForceTable, Revolutions, Surface, load_of_cut, width};
use crate::milling::{Cut, CutFrame, Direction, Engagement, ForceFrame, Forces};
use crate::path::ToolPath;
use robstiff::{Generic, Robot};
use robstiff_robots::samples;

/// Where a tool comes to rest that is commanded to `q`, with the force of the cut as
/// wide and deep as it is there: the model itself, not its slope.
fn settled<const N: usize>(
    robot: &impl Robot<N>,
    q: &SVector<f64, N>,
    point: &PathPoint<N>,
    cut: &Cut,
) -> Vector3<f64> {
    let frame = CutFrame::new(&-Vector3::z(), &point.tangent.unwrap()).unwrap();
    let aside = (robot.transform(q) - point.pose).fixed_view::<3, 1>(0, 3).into_owned();
    let mut off = aside;
    for _ in 0..100 {
        let moved = frame.components(&off);
        let engagement = Engagement::of_width(Direction::Down, width(cut) - moved.y, cut.mill.diameter).unwrap();
        let met = Cut { engagement, depth: cut.depth + moved.z, ..cut.clone() };
        off = aside + robot.deflection(q, &frame.wrench(&met.mean_force())).fixed_rows::<3>(0);
    }
    off
}

/// What is left of the uncompensated deviation, at the worst.
fn left_of_a_pocket<const N: usize>(name: &str, axis: Unit<Vector3<f64>>) -> f64 {
    let (robot, _, path) = solved::<N>(name, axis);
    let cut = cut("3 mm", "9000 rpm", "0.15 mm/tooth");
    let load = load_of_cut(&Forces::Model(cut.clone()), &path, axis, Surface::Side);
    let found = compensate(&robot, &path, &load, Keep::of(N, axis)).unwrap();
    assert!((1..=5).contains(&found.rounds()), "{}", found.rounds());
    let mut worst = [0.0_f64; 2];
    for (point, corrected) in path.points.iter().zip(&found.points) {
        assert!(corrected.remaining.distance < TOLERANCE && corrected.remaining.angle < TOLERANCE);
        let [before, after] = [&point.q, &corrected.q].map(|q| settled(&robot, q, point, &cut).norm());
        worst = [worst[0].max(before), worst[1].max(after)];
        // The axis of the tool keeps its direction as it yields.
        let tool = turned(&corrected.pose, &robot.deflection(&corrected.q, &corrected.wrench));
        let direction = tool.fixed_view::<3, 3>(0, 0) * axis.into_inner();
        assert!((direction + Vector3::z()).norm() < 1e-8, "{direction}");
    }
    assert!(worst[0] > 2e-5, "{worst:?}");
    worst[1] / worst[0]
}

#[test]
fn a_true_model_leaves_next_to_nothing() {
    let left = [
        left_of_a_pocket::<5>("rv130hsc", Vector3::x_axis()),
        left_of_a_pocket::<6>("kuka-kr270-r2700", Vector3::z_axis()),
    ];
    assert!(left.iter().all(|left| *left < 0.001), "{left:?}");
}

#[test]
fn a_model_wrong_by_a_tenth_leaves_about_a_tenth() {
    let axis = Vector3::z_axis();
    let (robot, _, path) = solved::<6>("kuka-kr270-r2700", axis);
    let forces = Forces::Model(cut("3 mm", "9000 rpm", "0.15 mm/tooth"));
    let load = load_of_cut(&forces, &path, axis, Surface::Side);
    let found = compensate(&robot, &path, &load, Keep::Pose).unwrap();
    let of = sensitivity(&robot, &path, &load, &found, 0.1).unwrap();
    let [softer, stiffer] = of.all;
    // 0.1 / 1.1 and 0.1 / 0.9, but for the force that follows the deviation.
    assert!((softer.rms - 0.1 / 1.1).abs() < 0.01 && (stiffer.rms - 0.1 / 0.9).abs() < 0.01, "{of:?}");
    assert_eq!(of.each.len(), 6);
    for [one, other] in &of.each {
        assert!(one.rms < softer.rms && other.rms < stiffer.rms, "{of:?}");
    }
    assert!(of.each.iter().any(|both| both[0].rms > 0.02), "{of:?}");
    let right = left(&robot, &[1.0; 6], &path, &load, &found).unwrap();
    assert!(right.worst < 1e-4, "{right:?}");
    // The same arm, described softer, is what the factors make of it.
    let mut softened = described("kuka-kr270-r2700");
    softened.joints.iter_mut().for_each(|joint| joint.compliance[0].value *= 1.1);
    let softened = Generic::<6>::new(&softened).unwrap();
    let whole = left(&softened, &[1.0; 6], &path, &load, &found).unwrap();
    assert!((whole.rms - softer.rms).abs() < 1e-9, "{whole:?} {softer:?}");
}

#[test]
fn corrected_poses_out_of_the_limits_are_named() {
    let description = described("kuka-kr270-r2700");
    let robot = Generic::<6>::new(&description).unwrap();
    // Joint 5 stands at its limit on line 3.
    let text = "q1 [deg],q2 [deg],q3 [deg],q4 [deg],q5 [deg],q6 [deg]\n0,-60,90,10,60,0\n0,-60,90,10,120,0\n";
    let tool_path = ToolPath::parse("path.csv", text, &description, Vector3::z_axis()).unwrap();
    let path = tool_path.solve(&robot, None).unwrap();
    let failed: Vec<_> = [500.0, -500.0]
        .into_iter()
        .filter_map(|force| {
            let table = format!("Fx,Fy,Fz\n{force},0,{force}\n{force},0,{force}\n");
            let table = ForceTable::parse("forces.csv", &table).unwrap();
            let load = table.load(&path, ForceFrame::Base, Vector3::z_axis(), Surface::Side).unwrap();
            compensate(&robot, &path, &load, Keep::Pose).err()
        })
        .collect();
    assert_eq!(failed.len(), 1, "pushed one way, the correction is within the limits: {failed:?}");
    let [(line, why)] = failed[0].points[..] else { panic!("{failed:?}") };
    assert!(line == 3 && matches!(why, Uncorrectable::Unreached(Unreached::OutsideLimits { joint: 5, .. })), "{why:?}");
    let problems = failed[0].diagnostics(&tool_path).unwrap().to_string();
    assert!(
        problems.contains("path.csv:3:1")
            && problems.contains("the corrected pose cannot be taken: outside the limits"),
        "{problems}"
    );
    assert!(failed[0].to_string().ends_with("1 of 2 points cannot be corrected: line 3"));
}

/// Joint 5 stands at its limit. Where the file leaves the turn about the tool free, another turn lets it off.
#[test]
fn a_free_turn_is_free_for_the_correction() {
    let text = robstiff_robots::catalogue::find("kuka-kr270-r2700").unwrap();
    let text = format!("{text}\ntool: {{xyz: [250 mm, 0, 180 mm], rpy: [0, 90 deg, 0]}}\n");
    let description = Description::parse("spindle.yaml", &text).unwrap();
    let robot = Generic::<6>::new(&description).unwrap();
    let q = SVector::from([0.0, -60.0, 90.0, 10.0, 120.0, 0.0].map(f64::to_radians));
    let pose = robot.transform(&q);
    let [at, axis] = [3, 2].map(|column| pose.fixed_view::<3, 1>(0, column).into_owned());
    let text = format!("x,y,z,ux,uy,uz\n{},{},{},{},{},{}\n", at.x, at.y, at.z, axis.x, axis.y, axis.z);
    let tool_path = ToolPath::parse("path.csv", &text, &description, Vector3::z_axis()).unwrap();
    let path = tool_path.solve(&robot, Some(&q)).unwrap();
    assert!((path.points[0].q - q).amax() < 1e-8);
    assert_eq!(Keep::along(&tool_path, 6, Vector3::z_axis()), Keep::PoseOrAxis(Vector3::z_axis()));
    let mut refused = 0;
    for force in [500.0, -500.0] {
        let table = ForceTable::parse("forces.csv", &format!("Fx,Fy,Fz\n{force},0,{force}\n")).unwrap();
        let load = table.load(&path, ForceFrame::Base, Vector3::z_axis(), Surface::Side).unwrap();
        refused += usize::from(compensate(&robot, &path, &load, Keep::Pose).is_err());
        let found = compensate(&robot, &path, &load, Keep::along(&tool_path, 6, Vector3::z_axis())).unwrap().points[0];
        let actual = turned(&robot.transform(&found.q), &robot.deflection(&found.q, &found.wrench));
        let off = Keep::Axis(Vector3::z_axis()).target(&path.points[0].pose).remaining(&actual);
        assert!(off.distance < 2e-9 && off.angle < 2e-9, "{off:?}");
    }
    assert_eq!(refused, 1);
}

#[test]
fn an_arm_of_rubber_is_not_corrected_and_every_point_is_named() {
    let mut description = described("kuka-kr270-r2700");
    description.joints.iter_mut().for_each(|joint| joint.compliance[0].value *= 3000.0);
    let robot = Generic::<6>::new(&description).unwrap();
    let text = "x,y,z,ux,uy,uz\n1.5,0,0.6,0,0,-1\n1.6,0,0.6,0,0,-1\n";
    let path = ToolPath::parse("path.csv", text, &description, Vector3::z_axis()).unwrap();
    let path = path.solve(&robot, None).unwrap();
    let table = ForceTable::parse("forces.csv", "Fx,Fy,Fz\n800,300,-900\n800,300,-900\n").unwrap();
    let load = table.load(&path, ForceFrame::Base, Vector3::z_axis(), Surface::Side).unwrap();
    let failed = compensate(&robot, &path, &load, Keep::Pose).unwrap_err();
    assert_eq!(failed.points.iter().map(|(line, _)| *line).collect::<Vec<_>>(), [2, 3], "{failed}");
}

/// One joint goes round a circle, and its tool yields along the tangent: by 20 um the commanded
/// point is 0.2 nm off the circle, which nobody sees.
#[test]
fn one_joint_is_corrected_as_near_as_it_gets() {
    let text = "name: One\nconvention: standard\njoints:\n  - {a: 1 m, compliance: 1e-6 rad/Nm}\n";
    let robot = Generic::<1>::new(&Description::parse("one.yaml", text).unwrap()).unwrap();
    for q in [0.0, 0.25, 0.75] {
        let (q, force) = (SVector::from([q]), Vector6::new(10.0, 20.0, 30.0, 0.0, 0.0, 0.0));
        let (path, mut load) = one_point(&robot, q, force);
        load.contacts[0].response.fill(0.0);
        let found = compensate(&robot, &path, &load, Keep::of(1, Vector3::z_axis())).unwrap().points[0];
        assert!(found.remaining.distance < TOLERANCE, "{found:?}");
        let along = -force.x * q[0].sin() + force.y * q[0].cos();
        assert!((found.q[0] - q[0] + 1e-6 * along).abs() < 2e-9, "{found:?}");
    }
}

fn one_point<const N: usize>(robot: &impl Robot<N>, q: SVector<f64, N>, wrench: Vector6<f64>) -> (SolvedPath<N>, Load) {
    let pose = robot.transform(&q);
    let point = PathPoint {
        line: 2,
        q,
        pose,
        tangent: None,
        s: 0.0,
        feed: None,
        rapid: false,
        spindle: None,
        tool: None,
        width: None,
        depth: None,
    };
    let response = nalgebra::Matrix3::new(2e4, 1e4, 0.0, -1e4, 3e4, 0.0, 5e3, 0.0, -2e4);
    let contact = Contact { wrench, response, frame: None, into: None, turn: nalgebra::Matrix3::identity() };
    let load = Load { contacts: vec![contact], revolution: Revolutions::None, undirected: Vec::new() };
    (SolvedPath { points: vec![point], jumps: Vec::new() }, load)
}

/// A cut that grows by a share of what the arm resists with: by less than all of it the tool stays on the path
/// once it is there, whatever the way there would do; by more it leaves.
#[test]
fn a_force_that_grows_with_the_displacement_is_corrected_as_long_as_the_tool_stays() {
    let robot = Generic::<6>::new(&described("kuka-kr270-r2700")).unwrap();
    let q = SVector::from([10.0, -60.0, 90.0, 10.0, 60.0, 20.0].map(f64::to_radians));
    let (path, mut load) = one_point(&robot, q, Vector6::new(300.0, -200.0, 400.0, 0.0, 0.0, 0.0));
    let yields = |axis: usize| robot.deflection(&q, &Vector6::ith(axis, 1.0)).fixed_rows::<3>(0).into_owned();
    let stiffness = nalgebra::Matrix3::from_columns(&[0, 1, 2].map(yields)).try_inverse().unwrap();
    for share in [-5.0, 0.3, 0.7, 0.95] {
        load.contacts[0].response = stiffness * share;
        let found =
            compensate(&robot, &path, &load, Keep::Pose).unwrap_or_else(|why| panic!("{share}: {why}")).points[0];
        let actual = turned(&found.pose, &robot.deflection(&found.q, &load.contacts[0].wrench));
        let off = Target::pose(&path.points[0].pose).remaining(&actual);
        assert!(off.distance < 2e-9 && off.angle < 2e-9 && found.rounds <= 5, "{share}: {off:?}");
    }
    load.contacts[0].response = stiffness * 1.2;
    let failed = compensate(&robot, &path, &load, Keep::Pose).unwrap_err();
    assert_eq!(failed.points, [(2, Uncorrectable::PulledIn)]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn commanded_pose_and_deflection_make_the_wanted_pose(
        shares in prop::array::uniform6(0.15..0.85_f64),
        force in prop::array::uniform3(-800.0..800.0_f64),
        moment in prop::array::uniform3(-100.0..100.0_f64),
    ) {
        let robot = Generic::<6>::new(&described("abb-irb6640-185-280")).unwrap();
        let limits = robot.limits().map(Option::unwrap);
        let mut q = SVector::<f64, 6>::from_fn(|i, _| limits[i][0] + shares[i] * (limits[i][1] - limits[i][0]));
        // A wrist that is straight cannot be corrected in every direction.
        q[4] = q[4].signum() * q[4].abs().max(0.3);
        let wrench = Vector6::new(force[0], force[1], force[2], moment[0], moment[1], moment[2]);
        let (path, load) = one_point(&robot, q, wrench);
        // Where the arm is stretched out it may not get there.
        let found = compensate(&robot, &path, &load, Keep::Pose);
        prop_assume!(found.is_ok());
        let found = found.unwrap().points[0];
        let deflection = robot.deflection(&found.q, &wrench);
        let actual = turned(&robot.transform(&found.q), &deflection);
        let off = Target::pose(&path.points[0].pose).remaining(&actual);
        prop_assert!(off.distance < 2e-9 && off.angle < 2e-9, "{off:?}");
        prop_assert!((found.wrench - wrench).norm() < 1e-3);
    }

    #[test]
    fn five_axes_keep_position_and_axis(
        angles in prop::array::uniform5(-1.2..1.2_f64),
        force in prop::array::uniform3(-800.0..800.0_f64),
    ) {
        let mut description = samples::five_axis();
        description.effects = samples::linear_effects();
        let robot = Generic::<5>::new(&description).unwrap();
        let mut q = SVector::<f64, 5>::from(angles);
        q[4] += 1.5;
        let wrench = Vector6::new(force[0], force[1], force[2], 0.0, 0.0, 0.0);
        let (path, load) = one_point(&robot, q, wrench);
        let axis = Vector3::x_axis();
        let found = compensate(&robot, &path, &load, Keep::Axis(axis));
        prop_assume!(found.is_ok());
        let found = found.unwrap().points[0];
        let actual = turned(&robot.transform(&found.q), &robot.deflection(&found.q, &wrench));
        let off = Keep::Axis(axis).target(&path.points[0].pose).remaining(&actual);
        prop_assert!(off.distance < 2e-9 && off.angle < 2e-9, "{off:?}");
    }
}

/// A SCARA cannot tilt its tool back, and is not asked to.
#[test]
fn few_axes_keep_the_position() {
    let text = "name: Scara\nconvention: standard\njoints:\n  \
                - {d: 400 mm, a: 400 mm, compliance: 1e-6 rad/Nm}\n  - {a: 300 mm, compliance: 1e-6 rad/Nm}\n  \
                - {type: prismatic, limits: [-0.2 m, 0.2 m], compliance: 1e-8 m/N}\n  - {compliance: 1e-6 rad/Nm}\n\
                effects:\n  - {kind: transverse_compliance, at: joint 2, value: 1e-6 rad/Nm}\n";
    let description = Description::parse("scara.yaml", text).unwrap();
    let robot = Generic::<4>::new(&description).unwrap();
    let text = "q1 [deg],q2 [deg],q3 [mm],q4 [deg]\n10,40,0,0\n20,50,10,0\n30,60,20,0\n";
    let path = ToolPath::parse("path.csv", text, &description, Vector3::z_axis()).unwrap();
    let path = path.solve(&robot, None).unwrap();
    let forces = ForceTable::parse("forces.csv", "Fx,Fy,Fz\n80,-60,-20\n80,-60,-20\n80,-60,-20\n").unwrap();
    let load = forces.load(&path, ForceFrame::Base, Vector3::z_axis(), Surface::Side).unwrap();
    let found = compensate(&robot, &path, &load, Keep::of(4, Vector3::z_axis())).unwrap();
    for (point, corrected) in path.points.iter().zip(&found.points) {
        let tool = turned(&corrected.pose, &robot.deflection(&corrected.q, &corrected.wrench));
        assert!((tool - point.pose).fixed_view::<3, 1>(0, 3).norm() < 1e-8 && corrected.correction.norm() > 1e-6);
    }
    // Kept in full the tool's tilt is out of reach, by less than a micrometre.
    let missed = compensate(&robot, &path, &load, Keep::Pose).unwrap_err().to_string();
    assert!(missed.contains("line 2: the corrected pose cannot be taken: no posture was found"), "{missed}");
    assert!(!missed.contains("0.000"), "{missed}");
}
