use nalgebra::{Matrix4, SVector, Unit, Vector3};
use robstiff_robots::{Description, catalogue};

use super::{Inverse, Target, Unreached};
use robstiff::{Generic, Robot, with_robot};
use robstiff_robots::samples;

fn catalogued(name: &str) -> Description {
    Description::parse(name, catalogue::find(name).unwrap()).unwrap()
}

/// Postures within the limits, the same every time.
fn postures<const N: usize>(robot: &impl Robot<N>, count: usize) -> Vec<SVector<f64, N>> {
    let limits = robot.limits().map(|limits| limits.unwrap_or([-3.0, 3.0]));
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count).map(|_| SVector::from_fn(|i, _| limits[i][0] + (limits[i][1] - limits[i][0]) * draw())).collect()
}

fn middle<const N: usize>(robot: &impl Robot<N>) -> SVector<f64, N> {
    SVector::from_iterator(robot.limits().map(|limits| limits.map_or(0.0, |[low, high]| 0.5 * (low + high))))
}

/// Every reachable target is reached, within the limits, by all solutions; and
/// where that is promised one of them is the posture that it was made from.
fn check_all<const N: usize>(robot: &impl Robot<N>, count: usize, target: impl Fn(&Matrix4<f64>) -> Target, own: bool) {
    let inverse = Inverse::new(robot);
    for q in postures(robot, count) {
        let target = target(&robot.transform(&q));
        let solutions = inverse.all(&target, &middle(robot)).unwrap_or_else(|why| panic!("{q}: {why}"));
        for solution in &solutions {
            let left = target.remaining(&robot.transform(solution));
            assert!(left.distance < 1e-10 && left.angle < 1e-10, "{q} {left:?}");
            for (value, limits) in solution.iter().zip(robot.limits()) {
                assert!(limits.is_none_or(|[low, high]| (low - 1e-6..=high + 1e-6).contains(value)));
            }
        }
        let turned = |other: &SVector<f64, N>| (other - q).iter().all(|apart| (apart * 0.5).sin().abs() < 1e-6);
        assert!(!own || solutions.iter().any(turned), "{q} {solutions:?}");
    }
}

#[test]
fn six_axes_have_a_closed_form_that_misses_nothing() {
    for name in ["kuka-kr270-r2700", "abb-irb6640-185-280", "fanuc-m900ib-700", "fanuc-r2000ic", "staubli-rx160"] {
        let robot = Generic::<6>::new(&catalogued(name)).unwrap();
        assert!(Inverse::new(&robot).has_closed_form(), "{name}");
        check_all(&robot, 300, Target::pose, true);
    }
}

/// A first axis that slides or turns, in any posture: with it where it was, the others are what they were.
#[test]
fn a_carried_arm_has_the_closed_form_of_the_arm() {
    let text = catalogue::find("kuka-kr270-r2700").unwrap();
    let carriers = [
        ("[-90 deg, 0, 0]", "{type: prismatic, alpha: -90 deg, limits: [-2 m, 2 m]}"),
        ("[180 deg, 0, 0]", "{a: 300 mm, limits: [-170 deg, 170 deg]}"),
        ("[30 deg, 20 deg, 0]", "{theta: 10 deg, d: 100 mm, a: 300 mm, alpha: 25 deg, limits: [-170 deg, 170 deg]}"),
    ];
    for (base, row) in carriers {
        let text = text.replace("base: {rpy: [180 deg, 0, 0]}", &format!("base: {{rpy: {base}}}"));
        let text = text.replace("joints:\n", &format!("joints:\n  - {row}\n"));
        let robot = Generic::<7>::new(&Description::parse("carried.yaml", &text).unwrap()).unwrap();
        let inverse = Inverse::new(&robot);
        assert!(inverse.has_closed_form(), "{row}");
        for q in postures(&robot, 100) {
            let target = Target::pose(&robot.transform(&q));
            let mut found = Vec::new();
            let mut seed = middle(&robot);
            seed[0] = q[0];
            inverse.postures(&target, &seed, |q| found.push(q));
            assert!(found.iter().any(|other| (other - q).amax() < 1e-7), "{row} {q} {found:?}");
            assert!(found.iter().all(|other| target.remaining(&robot.transform(other)).distance < 1e-9));
        }
        check_all(&robot, 20, Target::pose, false);
    }
}

#[test]
fn five_axes_reach_full_poses_and_directions_of_the_tool() {
    let robot = Generic::<5>::new(&catalogued("rv130hsc")).unwrap();
    assert!(Inverse::new(&robot).has_closed_form());
    check_all(&robot, 200, Target::pose, true);
    // Through the wrist, and past it.
    check_all(&robot, 100, |pose| pointing(pose, Vector3::x_axis()), true);
    for tool in [Vector3::z_axis(), Unit::new_normalize(Vector3::new(0.3, -0.5, 0.7))] {
        check_all(&robot, 300, |pose| pointing(pose, tool), true);
    }
}

fn pointing(pose: &Matrix4<f64>, tool: Unit<Vector3<f64>>) -> Target {
    let direction = pose.fixed_view::<3, 3>(0, 0) * tool.as_ref();
    Target::axis(pose.fixed_view::<3, 1>(0, 3).into_owned(), tool, Unit::new_normalize(direction))
}

#[test]
fn six_axes_point_a_tool_with_the_turn_about_it_free() {
    let robot = Generic::<6>::new(&catalogued("abb-irb6640-185-280")).unwrap();
    let inverse = Inverse::new(&robot);
    for q in postures(&robot, 50) {
        let target = pointing(&robot.transform(&q), Vector3::z_axis());
        let near = inverse.nearest(&target, &middle(&robot)).unwrap();
        assert!(target.remaining(&robot.transform(&near)).distance < 1e-10);
    }
}

#[test]
fn an_arm_without_a_closed_form_is_solved_from_many_starts() {
    let robot = Generic::<6>::new(&samples::odd()).unwrap();
    assert!(!Inverse::new(&robot).has_closed_form());
    let inverse = Inverse::new(&robot);
    for q in postures(&robot, 40) {
        let target = Target::pose(&robot.transform(&q));
        let found = inverse.nearest(&target, &SVector::zeros()).unwrap_or_else(|why| panic!("{q}: {why}"));
        assert!(target.remaining(&robot.transform(&found)).distance < 1e-10);
    }
}

#[test]
fn a_measured_table_moves_the_axes_apart_and_is_still_solved() {
    let mut description = catalogued("kuka-kr210-l150");
    description.joints[4].a = 0.8e-3;
    description.joints[3].alpha += 4e-4;
    description.joints[1].alpha -= 3e-4;
    description.joints[2].d = 1.5e-3;
    let robot = Generic::<6>::new(&description).unwrap();
    assert!(Inverse::new(&robot).has_closed_form());
    check_all(&robot, 200, Target::pose, false);
}

#[test]
fn singular_postures_are_solved_as_the_seed_has_them() {
    let robot = Generic::<6>::new(&catalogued("abb-irb6640-185-280")).unwrap();
    let inverse = Inverse::new(&robot);
    // The wrist straight; the wrist above the first axis; the elbow stretched.
    let elbow = -f64::atan2(1.392, 0.2);
    let above = {
        let center = |q2: f64| 0.32 + 1.075 * q2.sin() + 1.392 * q2.cos() + 0.2 * q2.sin();
        let (mut low, mut high) = (-1.13_f64, 0.0_f64);
        for _ in 0..100 {
            let q2 = 0.5 * (low + high);
            if center(q2) > 0.0 { high = q2 } else { low = q2 }
        }
        low
    };
    let singular =
        [[0.4, 0.3, -0.5, 0.7, 0.0, -0.9], [0.4, 0.3, elbow, 0.7, 0.5, -0.9], [0.4, above, 0.0, 0.7, 0.5, -0.9]];
    for q in singular.map(SVector::from) {
        let target = Target::pose(&robot.transform(&q));
        let found = inverse.nearest(&target, &q).unwrap();
        let left = target.remaining(&robot.transform(&found));
        assert!(left.distance < 1e-10 && left.angle < 1e-10, "{left:?}");
        assert!((found - q).amax() < 1e-5, "{found} {q}");
    }
}

#[test]
fn the_nearest_turn_within_the_limits_is_taken() {
    let robot = Generic::<6>::new(&catalogued("abb-irb6640-185-280")).unwrap();
    let inverse = Inverse::new(&robot);
    let q = SVector::from([0.4, 0.3, -0.5, 0.7, 0.6, -0.9]);
    let target = Target::pose(&robot.transform(&q));
    // Joint 6 has four turns of room, joint 4 some more than three.
    let mut seed = q;
    seed[5] -= core::f64::consts::TAU;
    let found = inverse.nearest(&target, &seed).unwrap();
    assert!((found[5] - (q[5] - core::f64::consts::TAU)).abs() > 1.0, "it would be beyond -360 deg: {found}");
    seed = q;
    seed[5] += 5.0;
    let found = inverse.nearest(&target, &seed).unwrap();
    assert!((found[5] - (q[5] + core::f64::consts::TAU)).abs() < 1e-9, "{found}");
}

#[test]
fn what_cannot_be_reached_says_why() {
    let description = catalogued("abb-irb6640-185-280");
    let robot = Generic::<6>::new(&description).unwrap();
    let inverse = Inverse::new(&robot);
    let seed = SVector::zeros();
    let mut pose = robot.transform(&seed);
    pose[(0, 3)] += 3.0;
    let why = inverse.nearest(&Target::pose(&pose), &seed).unwrap_err();
    assert!(matches!(why, Unreached::OutOfReach { remaining } if remaining.distance > 1.0), "{why}");

    let beyond = SVector::from([0.0, 0.0, 0.0, 0.0, 2.5, 0.0]);
    let why = inverse.nearest(&Target::pose(&robot.transform(&beyond)), &seed).unwrap_err();
    assert!(matches!(why, Unreached::OutsideLimits { .. }), "{why}");

    pose[(0, 3)] = f64::NAN;
    assert_eq!(inverse.nearest(&Target::pose(&pose), &seed), Err(Unreached::NotFinite));
}

#[test]
fn small_arms_are_solved_too() {
    for joints in 1..=4 {
        let mut description = samples::five_axis();
        description.joints.truncate(joints);
        with_robot!(&description, |robot| check_all(&robot, 40, Target::pose, false));
    }
}
