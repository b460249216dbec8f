use nalgebra::{Matrix4, SVector, Vector3};
use robstiff_robots::{Description, catalogue};

use super::{Goal, SolvedPath, ToolPath, Unreached};
use robstiff::{Generic, Robot};

fn catalogued(name: &str) -> Description {
    Description::parse(name, catalogue::find(name).unwrap()).unwrap()
}

fn abb() -> (Description, Generic<6>) {
    let description = catalogued("abb-irb6640-185-280");
    let robot = Generic::new(&description).unwrap();
    (description, robot)
}

fn parse(text: &str, robot: &Description) -> Result<ToolPath, String> {
    ToolPath::parse("path.csv", text, robot, Vector3::z_axis()).map_err(|problems| problems.to_string())
}

fn solve(text: &str) -> SolvedPath<6> {
    let (description, robot) = abb();
    parse(text, &description).unwrap().solve(&robot, None).unwrap()
}

/// A square of 200 mm with the tool down.
const SQUARE: &str = "x [mm],y [mm],z [mm],qw,qx,qy,qz,feed [mm/min]\n\
    1500,-100,900,0,1,0,0,1200\n1700,-100,900,0,1,0,0,1200\n1700,100,900,0,1,0,0,1200\n1500,100,900,0,1,0,0,1200\n";

#[test]
fn points_have_postures_lengths_and_directions() {
    let path = solve(SQUARE);
    let (_, robot) = abb();
    assert_eq!(path.points.len(), 4);
    assert!(path.jumps.is_empty());
    for (i, point) in path.points.iter().enumerate() {
        assert_eq!((point.line, point.feed), (i + 2, Some(0.02)));
        assert!((point.s - 0.2 * i as f64).abs() < 1e-9, "{}", point.s);
        assert!((robot.transform(&point.q) - point.pose).norm() == 0.0);
        assert!((point.pose.fixed_view::<3, 1>(0, 2) + Vector3::z()).norm() < 1e-9, "the tool points down");
    }
    assert!((path.points[0].position() - Vector3::new(1.5, -0.1, 0.9)).norm() < 1e-9);
    let tangents: [Vector3<f64>; 4] = core::array::from_fn(|i| path.points[i].tangent.unwrap().into_inner());
    let half = core::f64::consts::FRAC_1_SQRT_2;
    for (found, expected) in tangents.iter().zip([[1.0, 0.0], [half, half], [-half, half], [-1.0, 0.0]]) {
        assert!((found - Vector3::new(expected[0], expected[1], 0.0)).norm() < 1e-9, "{found}");
    }
}

#[test]
fn a_path_that_turns_back_does_not_go_across() {
    // The way back is a micrometre beside the way there.
    let text = "x [mm],y [mm],z [mm],qw,qx,qy,qz\n\
        1500,0,900,0,1,0,0\n1550,0,900,0,1,0,0\n1600,0,900,0,1,0,0\n1550,0.001,900,0,1,0,0\n1500,0,900,0,1,0,0\n";
    let path = solve(text);
    for (point, x) in path.points.iter().zip([1.0, 1.0, -1.0, -1.0, -1.0]) {
        let feed = point.tangent.unwrap();
        assert!((feed.into_inner() - Vector3::x() * x).norm() < 1e-3, "{feed:?}");
    }
}

#[test]
fn orientations_are_read_in_every_form() {
    let (description, _) = abb();
    let turned = |columns: &str, values: &str| {
        let text = format!("x,y,z,{columns}\n1.5,0,1,{values}\n");
        let path = parse(&text, &description).unwrap();
        let Goal::Tool(target) = &path.points[0].goal else { panic!("a pose") };
        match target.orientation {
            super::Orientation::Full(rotation) => rotation.matrix() * Vector3::new(1.0, 2.0, 3.0),
            super::Orientation::Axis { direction, .. } => direction.into_inner(),
            super::Orientation::Free => panic!("a file says how the tool is turned"),
        }
    };
    // A quarter turn about z.
    let expected = Vector3::new(-2.0, 1.0, 3.0);
    for (columns, values) in [
        ("qw,qx,qy,qz", "0.70710678,0,0,0.70710678"),
        ("rx [deg],ry [deg],rz [deg]", "0,0,90"),
        ("a [deg],b [deg],c [deg]", "90,0,0"),
    ] {
        assert!((turned(columns, values) - expected).norm() < 1e-7, "{columns}");
    }
    // b about the new y, c about the new x.
    let angles = turned("a [deg],b [deg],c [deg]", "90,90,0");
    assert!((angles - Vector3::new(-2.0, 3.0, -1.0)).norm() < 1e-12, "{angles}");
    assert!((turned("ux,uy,uz", "0,0,-5") + Vector3::z()).norm() < 1e-12);
}

#[test]
fn joint_coordinates_go_in_and_come_out() {
    let (description, robot) = abb();
    let text = "q1 [deg],q2 [deg],q3 [deg],q4 [deg],q5 [deg],q6 [deg]\n0,10,20,0,30,0\n1,10,20,0,30,0\n";
    let path = parse(text, &description).unwrap().solve(&robot, None).unwrap();
    assert_eq!(path.points[1].q[0], 1_f64.to_radians());
    assert!(path.points[1].s > 0.02);
    let outside = text.replace("1,10,20", "1,90,20");
    let unsolved = parse(&outside, &description).unwrap().solve(&robot, None).unwrap_err();
    assert!(matches!(unsolved.points[..], [(3, Unreached::OutsideLimits { joint: 2, .. })]), "{unsolved}");
}

#[test]
fn unreachable_points_are_named_and_none_is_skipped() {
    let (description, robot) = abb();
    let text = SQUARE.replace("1700,-100", "9700,-100").replace("1500,100,", "1500,100,9");
    let unsolved = parse(&text, &description).unwrap().solve(&robot, None).unwrap_err();
    assert_eq!(unsolved.points.iter().map(|(line, _)| *line).collect::<std::vec::Vec<_>>(), [3, 5]);
    let said = unsolved.to_string();
    assert!(said.contains("--> path.csv:3:1") && said.contains("out of reach"), "{said}");
    assert!(said.ends_with("2 of 4 points cannot be reached: lines 3, 5"), "{said}");
}

#[test]
fn a_change_of_posture_is_reported() {
    let (description, robot) = abb();
    // The same place with the wrist turned over.
    let q = SVector::from([0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
    let over = SVector::from([0.1, 0.2, 0.3, 0.4 - core::f64::consts::PI, -0.5, 0.6 - core::f64::consts::PI]);
    assert!((robot.transform(&q) - robot.transform(&over)).norm() < 1e-12);
    let row = |q: &SVector<f64, 6>| q.iter().map(ToString::to_string).collect::<std::vec::Vec<_>>().join(",");
    let text = format!("q1,q2,q3,q4,q5,q6\n{}\n{}\n", row(&q), row(&over));
    let path = parse(&text, &description).unwrap().solve(&robot, None).unwrap();
    let [jump] = path.jumps[..] else { panic!("{:?}", path.jumps) };
    assert_eq!(jump.lines, [2, 3]);
    assert!(jump.change.abs() > 3.0 && matches!(jump.joint, 4 | 6), "{jump:?}");
}

#[test]
fn a_start_chooses_the_posture() {
    let (description, robot) = abb();
    let path = parse(SQUARE, &description).unwrap();
    let free = path.solve(&robot, None).unwrap();
    let mut start = free.points[0].q;
    start[3] += core::f64::consts::PI;
    start[4] = -start[4];
    start[5] -= core::f64::consts::PI;
    let other = path.solve(&robot, Some(&start)).unwrap();
    assert!((other.points[0].q - start).amax() < 1e-9);
    assert!(other.jumps.is_empty());
}

#[test]
fn five_axes_follow_a_tool_axis() {
    let description = catalogued("rv130hsc");
    let robot = Generic::<5>::new(&description).unwrap();
    let text = "x [mm],y [mm],z [mm],ux,uy,uz\n1300,-50,600,0,0,-1\n1300,0,600,0,0.1,-1\n1300,50,600,0,0.2,-1\n";
    let path = ToolPath::parse("p.csv", text, &description, Vector3::x_axis()).unwrap();
    let solved = path.solve(&robot, None).unwrap();
    for (point, slope) in solved.points.iter().zip([0.0, 0.1, 0.2]) {
        let axis = point.pose.fixed_view::<3, 1>(0, 0).into_owned();
        assert!((axis - Vector3::new(0.0, slope, -1.0).normalize()).norm() < 1e-9);
    }
}

/// A full orientation asks five axes for what only six have.
#[test]
fn five_axes_are_told_that_they_do_not_hold_a_turn_about_the_tool() {
    let description = catalogued("rv130hsc");
    let robot = Generic::<5>::new(&description).unwrap();
    let unsolved = |position: &str| {
        let text = format!("x [mm],y [mm],z [mm],a [deg],b [deg],c [deg]\n{position},0,90,17\n");
        let path = ToolPath::parse("p.csv", &text, &description, Vector3::x_axis()).unwrap();
        path.solve(&robot, None).unwrap_err()
    };
    let said = unsolved("1300,-50,600");
    assert_eq!(said.points, [(2, Unreached::TurnAboutTool)]);
    let said = said.to_string();
    assert!(said.contains("not the turn about it") && said.contains("`ux,uy,uz`"), "{said}");
    assert!(said.ends_with("1 of 1 point cannot be reached: line 2"), "{said}");
    let far = unsolved("9300,-50,600");
    assert!(!far.points.contains(&(2, Unreached::TurnAboutTool)), "{far}");
}

#[test]
fn a_path_can_be_placed() {
    let (description, _) = abb();
    let mut place = Matrix4::new_translation(&Vector3::new(0.5, 0.0, 0.0));
    place.fixed_view_mut::<3, 3>(0, 0).copy_from(nalgebra::Rotation3::from_euler_angles(0.0, 0.0, 1.0).matrix());
    let path = parse(SQUARE, &description).unwrap().placed(&place);
    let Goal::Tool(target) = &path.points[0].goal else { panic!("a pose") };
    let expected = place * nalgebra::Vector4::new(1.5, -0.1, 0.9, 1.0);
    assert!((target.position - expected.xyz()).norm() < 1e-15);
}

#[test]
fn mistakes_are_shown_where_they_are() {
    let (description, _) = abb();
    let refused = |text: &str| parse(text, &description).unwrap_err();
    for (text, part) in [
        ("x,y\n1,2\n", "the column `z` is missing"),
        ("x,y,z\n1,2,3\n", "the orientation of the tool is missing"),
        ("x,y,z,rx,ry,rz,ux,uy,uz\n1,0,1,0,0,0,0,0,1\n", "given twice, by `rx` and `ux`"),
        ("x,y,z,qw,qx,qy,qz\n1,0,1,1,1,0,0\n", "path.csv:2:7"),
        ("x,y,z,ux,uy,uz\n1,0,1,0,0,0\n", "has no direction"),
        ("x,y,z,ux,uy,uz,feed [mm/min]\n1,0,1,0,0,1,-3\n", "the feed is not positive"),
        ("x,y,z,ux,uy,uz,s [mm]\n1,0,1,0,0,1,3\n1,0,1,0,0,1,2\n", "path.csv:3:13"),
        ("x [deg],y,z,ux,uy,uz\n1,0,1,0,0,1\n", "`deg` is an angle, a length is expected here"),
        ("q1,q2\n1,2\n", "the column `q6` is missing"),
        ("x,y,z,ux,uy,uz\n1,0,one,0,0,1\n", "`one` is not a number"),
    ] {
        let said = refused(text);
        assert!(said.contains(part), "{text}: {said}");
    }
    // No path is shorter than the straight line.
    let path = |s: [u32; 3]| {
        let rows = s.iter().zip([1500, 1520, 1540]).map(|(s, x)| format!("{x},0,600,0,0,-1,{s}\n"));
        let text = format!("x [mm],y [mm],z [mm],ux,uy,uz,s [mm]\n{}", rows.collect::<std::string::String>());
        parse(&text, &description).unwrap().warnings
    };
    assert!(path([0, 20, 40]).is_empty() && path([0, 30, 60]).is_empty());
    let short = path([0, 2, 4]).concat();
    assert!(short.contains("grows by 2.000000 mm on line 3, and the points are 20.000000 mm apart"), "{short}");
    let warned = parse("x,y,z,ux,uy,uz,colour\n1500,0,1,0,0,1,3\n", &description).unwrap().warnings;
    assert_eq!(warned.len(), 2, "{warned:?}");
    assert!(warned[0].contains("write `x [mm]`") && warned[1].contains("`colour` is not used"), "{warned:?}");
}

/// With a free turn about the tool's axis one branch has more postures than are followed.
#[test]
fn a_free_turn_is_no_reason_to_change_the_posture() {
    let description = catalogued("kuka-kr270-r2700");
    let robot = Generic::<6>::new(&description).unwrap();
    let (from, to) = (Vector3::new(-0.37085, -1.05316, 0.79941), Vector3::new(1.03540, -1.00066, 0.44338));
    let mut text = String::from("x,y,z,ux,uy,uz\n");
    for k in 0..30 {
        let at = from.lerp(&to, f64::from(k) / 29.0);
        text += &format!("{},{},{},0.091319,-0.522372,-0.847814\n", at.x, at.y, at.z);
    }
    let path = parse(&text, &description).unwrap();
    let start = SVector::from([-1.9094, -1.0848, 2.1871, -2.2925, 0.6743, -1.2534]);
    assert_eq!(path.solve(&robot, Some(&start)).unwrap().jumps, []);
    assert_eq!(path.solve(&robot, None).unwrap().jumps, []);
}
