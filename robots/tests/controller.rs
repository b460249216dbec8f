//! What the pendant shows, and what the joints are at.

use proptest::prelude::*;
use robstiff_robots::{Description, Pendant};

fn arm(controller: &str) -> String {
    format!(
        "name: Arm\nconvention: standard\njoints: [{{}}, {{a: 1 m}}, {{a: 1 m}}, {{type: prismatic}}]\n{controller}"
    )
}

fn read(controller: &str) -> Description {
    Description::parse("arm.yaml", &arm(controller)).unwrap_or_else(|problems| panic!("{problems}"))
}

/// FANUC counts joint 3 from the ground: at J2 = 30 deg, J3 = 10 deg its forearm is 40 deg
/// from where it is at 0 relative to the upper arm.
#[test]
fn a_joint_may_be_counted_from_the_ground() {
    let arm =
        read("controller:\n  joints: [{sign: -1}, {sign: -1, offset: 90 deg}, {add: {t2: 1}}, {offset: 500 mm}]\n");
    let controller = arm.controller.as_ref().expect("a controller");
    let t = [0.1, 30_f64.to_radians(), 10_f64.to_radians(), 0.2];
    let q = controller.pendant_to_q(&t);
    let expected = [-0.1, 60_f64.to_radians(), 40_f64.to_radians(), 0.7];
    assert!(q.iter().zip(expected).all(|(q, expected)| (q - expected).abs() < 1e-15), "{q:?}");
    assert!(controller.q_to_pendant(&q).iter().zip(t).all(|(back, t)| (back - t).abs() < 1e-15));
}

#[test]
fn without_joints_the_pendant_shows_them() {
    let arm = read("controller: {world: {xyz: [0, 0, 500 mm]}, nominal: maker.yaml}\n");
    let controller = arm.controller.expect("a controller");
    assert_eq!(controller.joints, vec![Pendant::default(); 4]);
    assert_eq!((controller.world.xyz[2], controller.nominal.as_deref()), (0.5, Some("maker.yaml")));
    assert_eq!(controller.pendant_to_q(&[0.1, 0.2, 0.3, 0.4]), [0.1, 0.2, 0.3, 0.4]);
    assert_eq!(read("").controller, None);
}

#[test]
fn mistakes_are_shown_where_they_are() {
    let told = |joints: &str| {
        let text = arm(&format!("controller:\n  joints: {joints}\n"));
        Description::parse("arm.yaml", &text).unwrap_err().to_string()
    };
    let wrong = [
        ("[{}, {}, {}]", "the robot has 4 joints; the controller gives 3", ":5:11"),
        ("[{sign: 2}, {}, {}, {}]", "a sign is 1 or -1", ":5:19"),
        ("[{add: {t2: 1}}, {}, {}, {}]", "`t2` is no coordinate of a joint before joint 1", ":5:23"),
        ("[{}, {add: {q1: 1}}, {}, {}]", "`q1` is no coordinate", ":5:27"),
        ("[{}, {add: {t1: 0}}, {}, {}]", "a factor of 0 adds nothing", ":5:27"),
        ("[{}, {add: {}}, {}, {}]", "nothing is added", ":5:22"),
        ("[{}, {}, {}, {add: {t2: 1}}]", "a joint that turns adds nothing to one that slides", ":5:35"),
        ("[{}, {}, {}, {offset: 3 deg}]", "`deg`", ":5:33"),
        ("[{offset: 90}, {}, {}, {}]", "90", ":5:21"),
    ];
    for (joints, message, place) in wrong {
        let told = told(joints);
        assert!(told.contains(message) && told.contains(&format!("arm.yaml{place}")), "{told}");
    }
}

fn pendant(joint: usize) -> impl Strategy<Value = Pendant> {
    let offset = prop_oneof![-3.0..3.0, (-9i32..9).prop_map(|tens| f64::from(20 * tens).to_radians())];
    let before = if joint == 4 { 1 } else { joint };
    let add = prop::collection::btree_map(1..before.max(2), -2.0..2.0_f64, 0..2);
    (any::<bool>(), offset, add).prop_map(move |(reversed, offset, add)| {
        let add = if before < 2 { Vec::new() } else { add.into_iter().filter(|(_, factor)| *factor != 0.0).collect() };
        // What is read back is snapped to quarter turns.
        Pendant { reversed, offset: if joint == 4 { offset } else { robstiff_robots::angle::snapped(offset) }, add }
    })
}

proptest! {
    #[test]
    fn written_it_is_read_back(joints in (pendant(1), pendant(2), pendant(3), pendant(4)), t in prop::array::uniform4(-3.0..3.0)) {
        let mut robot = read("controller: {flange: {rpy: [0, 90 deg, 0]}, nominal: \"a b: #1.yaml\"}\n");
        let controller = robot.controller.as_mut().expect("a controller");
        controller.joints = vec![joints.0, joints.1, joints.2, joints.3];
        let back = controller.q_to_pendant(&controller.pendant_to_q(&t));
        prop_assert!(back.iter().zip(t).all(|(back, t)| (back - t).abs() < 1e-12));
        let yaml = robot.to_yaml();
        let read = Description::parse("arm.yaml", &yaml).map_err(|problems| TestCaseError::fail(problems.to_string()))?;
        prop_assert_eq!(read, robot, "{}", yaml);
    }
}
