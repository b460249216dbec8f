//! Programs of paths, and programs that are corrected.

use nalgebra::{Isometry3, Matrix3, SVector, Translation3, UnitQuaternion, Vector3, Vector6};

use super::{abb, degrees, fanuc, kuka, ur};
use crate::compensation::{Keep, compensate};
use crate::controller::{Followed, Frames, Nominal, Order, Postures, Sent, Targets, compose, files, placement};
use crate::deviation::{Contact, Load, Revolutions, turned};
use crate::program::{
    Document, Frame, Instruction, Language, Motion, Position, Speed, Target, TextFile, Zone, read, write,
};
use robstiff::{Effect, Generic, Robot};
use robstiff_robots::{Description, samples};

/// A controller's language, an arm with it, and angles of its pendant (deg).
type Arm = (Language, fn() -> Description, [f64; 6]);

const ROBOTS: [Arm; 4] = [
    (Language::Krl, kuka, [5.0, -70.0, 95.0, 10.0, 60.0, -15.0]),
    (Language::Rapid, abb, [5.0, 20.0, 10.0, 10.0, 60.0, -15.0]),
    (Language::Ls, fanuc, [5.0, 20.0, -10.0, 10.0, -60.0, -15.0]),
    (Language::Ur, ur, [5.0, -35.0, 45.0, -110.0, -80.0, -15.0]),
];

fn tool() -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::new(0.05, 0.0, 0.28), UnitQuaternion::from_euler_angles(0.0, 0.3, 0.0))
}

fn order(language: Language, work: Isometry3<f64>) -> Order {
    let has_words = matches!(language, Language::Rapid | Language::Ur);
    let name = |number: &str, word: &str| if has_words { word.to_owned() } else { number.to_owned() };
    let zone = if language == Language::Ls { Zone::Share(0.5) } else { Zone::Within(1e-4) };
    Order {
        language,
        name: "JOB".to_owned(),
        tool: Frame { name: name("1", "tMill"), pose: Some(tool()) },
        work: Frame { name: name("2", "wPart"), pose: Some(work) },
        targets: None,
        rapid: match language {
            Language::Rapid => Speed::Tool(0.2),
            Language::Ur => Speed::Joints(0.5),
            Language::Krl | Language::Ls => Speed::Share(0.1),
        },
        feed: Some(0.02),
        zone,
        spindle: [Some("M3 {rpm}".to_owned()), None],
    }
}

/// Four points on a square of 200 mm, at a posture of the pendant.
fn square(nominal: &Nominal<6>, postures: &Postures<'_, 6>, pendant: [f64; 6]) -> Vec<Sent<6>> {
    let first = nominal.joints(degrees(pendant).as_slice()).unwrap();
    let pose = nominal.pose(&first, &tool());
    let mut near = first;
    let corners = [[0.0, 0.0], [0.2, 0.0], [0.2, 0.2], [0.0, 0.2], [0.0, 0.0]];
    let points = corners.iter().enumerate().map(|(i, [x, y])| {
        near = postures.solve(&(Translation3::new(*x, *y, 0.0) * pose), &tool(), None, &near).unwrap();
        Sent { line: i + 1, q: near, rapid: i == 4, feed: None, spindle: Some(600.0), tool: None }
    });
    points.collect()
}

fn program(robot: &Description, language: Language, pendant: [f64; 6], targets: Option<Targets>) -> Vec<TextFile> {
    let nominal = Nominal::<6>::new(robot, None).unwrap();
    let postures = Postures::new(&nominal);
    let work = nominal.in_world(&Isometry3::translation(1.0, 0.2, 0.3));
    let order = Order { targets, ..order(language, work) };
    let composed = compose(&postures, &square(&nominal, &postures, pendant), &order).unwrap();
    files(language, &composed.program).unwrap_or_else(|wrong| panic!("{wrong:?}"))
}

/// The frames that only the controller knows, where the language does not say them.
fn frames(nominal: &Nominal<6>) -> Frames {
    let work = nominal.in_world(&Isometry3::translation(1.0, 0.2, 0.3));
    Frames { tools: vec![("1".to_owned(), tool())], works: vec![("2".to_owned(), work)], rapid_from: None }
}

fn parse(language: Language, files: Vec<TextFile>) -> Document {
    read(language, files).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Poses to a micrometre and less, angles to 1e-5 rad: the digits that programs have. A TP program has angles to
/// 0.001 degrees, which are hundredths of a millimetre at the tip.
#[test]
fn what_is_written_takes_the_arm_to_the_same_coordinates() {
    for (language, robot, pendant) in ROBOTS {
        for targets in [Targets::Poses, Targets::Joints] {
            let robot = robot();
            let document = parse(language, program(&robot, language, pendant, Some(targets)));
            let nominal = Nominal::<6>::new(&robot, None).unwrap();
            let postures = Postures::new(&nominal);
            let sent = square(&nominal, &postures, pendant);
            // From a posture that is far away.
            let followed = Followed::new(&document, &postures, &frames(&nominal), Some(&SVector::zeros())).unwrap();
            assert_eq!(followed.stops.len(), sent.len());
            for (stop, sent) in followed.stops.iter().zip(&sent) {
                assert!((stop.q - sent.q).amax() < 3e-5, "{language:?} {targets:?} {}", stop.q - sent.q);
                let [one, other] = [&stop.q, &sent.q].map(|q| nominal.pose(q, &tool()).translation.vector);
                let digits = if language == Language::Ls && targets == Targets::Joints { 1e-4 } else { 2e-6 };
                assert!((one - other).norm() < digits, "{language:?} {targets:?} {}", one - other);
            }
            let motions: Vec<Motion> = document.moves().map(|to| to.motion).collect();
            let by_joints = targets == Targets::Joints && matches!(language, Language::Krl | Language::Rapid);
            assert_eq!(motions[..2], [Motion::Joint, if by_joints { Motion::Joint } else { Motion::Linear }]);
            let text: String = document.files().iter().map(|file| file.text.as_str()).collect();
            assert!(text.contains("M3 5729.578") && text.to_lowercase().contains("spindle off"), "{text}");
        }
    }
}

/// A rail below the arm is E1; the pose is that of the tool where the rail has taken the arm.
#[test]
fn a_rail_is_a_further_axis() {
    let mut robot = kuka();
    let rail = "name: Rail\nconvention: standard\nbase: {rpy: [-90 deg, 0, 0]}\njoints:\n  - {type: prismatic, alpha: -90 deg, limits: [-2 m, 2 m]}\n";
    let rail = Description::parse("rail.yaml", rail).unwrap();
    robot.joints.insert(0, rail.joints[0].clone());
    robot.base = rail.base;
    let controller = robot.controller.as_mut().unwrap();
    controller.joints.insert(0, controller.joints[0].clone());
    let nominal = Nominal::<7>::new(&robot, None).unwrap();
    let postures = Postures::new(&nominal);
    assert_eq!((postures.unfit(), postures.carriers()), (None, 1));
    let arm = degrees([5.0, -70.0, 95.0, 10.0, 60.0, -15.0]);
    let at = |e: f64| SVector::<f64, 7>::from_fn(|i, _| if i == 0 { e } else { arm[i - 1] });
    let sent =
        [0.0, 0.5, 1.25].map(|e| Sent { line: 1, q: at(e), rapid: e == 0.0, feed: None, spindle: None, tool: None });
    for language in [Language::Krl, Language::Rapid] {
        let composed = compose(&postures, &sent, &order(language, Isometry3::identity())).unwrap();
        let document = parse(language, files(language, &composed.program).unwrap());
        let moves: Vec<_> = document.moves().collect();
        let external: Vec<_> = moves.iter().map(|to| to.position.external[0]).collect();
        assert_eq!(external, [Some(0.0), Some(500.0), Some(1250.0)]);
        let places = moves.iter().map(|to| match &to.position.target {
            Target::Pose(pose, which) => (pose.translation.vector, *which),
            Target::Joints(_) => panic!("{language:?}"),
        });
        let places: Vec<_> = places.collect();
        // The rail is along y, and the posture stays.
        assert!((places[2].0 - places[0].0 - Vector3::new(0.0, 1.25, 0.0)).norm() < 1e-6, "{places:?}");
        assert_eq!(places[2].1, places[0].1);
        assert_eq!(
            places[0].1,
            Postures::new(&Nominal::<6>::new(&kuka(), None).unwrap()).configuration(&arm, language)
        );
    }
    let refused = compose(&postures, &sent, &order(Language::Ur, Isometry3::identity())).unwrap();
    assert!(files(Language::Ur, &refused.program).unwrap_err()[0].why.contains("no further axes"));
}

#[test]
fn what_fits_is_chosen_and_explained() {
    let robot = kuka();
    let nominal = Nominal::<6>::new(&robot, None).unwrap();
    let postures = Postures::new(&nominal);
    let work = Isometry3::identity();
    let sent = square(&nominal, &postures, ROBOTS[0].2);
    let chosen = |language| compose(&postures, &sent, &order(language, work)).unwrap();
    for language in Language::ALL {
        assert_eq!((chosen(language).targets, chosen(language).why), (Targets::Poses, None));
    }
    let no_feed = Order { feed: None, ..order(Language::Krl, work) };
    assert_eq!(compose(&postures, &sent, &no_feed).unwrap_err().to_string(), "the point has no feed");

    let mut five = samples::five_axis();
    five.controller = robot.controller.clone();
    five.controller.as_mut().unwrap().joints.pop();
    let nominal = Nominal::<5>::new(&five, None).unwrap();
    let point = Sent { line: 1, q: SVector::zeros(), rapid: false, feed: Some(0.01), spindle: None, tool: Some(3) };
    let composed = compose(&Postures::new(&nominal), &[point; 2], &order(Language::Krl, work)).unwrap();
    assert!(composed.targets == Targets::Joints && composed.without_feed, "{composed:?}");
    assert!(composed.why.unwrap().contains("it has not six axes"));
    let poses = Order { targets: Some(Targets::Poses), ..order(Language::Ls, work) };
    assert!(compose(&Postures::new(&nominal), &[point; 2], &poses).is_err());
}

#[test]
fn a_long_tp_program_calls_its_parts() {
    let position = || Position::from(Target::Joints(vec![0.1; 6]));
    let to = || crate::program::Move {
        speed: Some(Speed::Share(0.1)),
        ..crate::program::Move::to(Motion::Joint, position())
    };
    let frame = |name: &str| Frame { name: name.to_owned(), pose: None };
    let mut instructions = vec![Instruction::Tool(frame("3")), Instruction::Work(frame("4"))];
    instructions.extend((0..9001).map(|_| Instruction::Move(to())));
    let long = crate::program::Program { name: "LONG".to_owned(), instructions };
    let files = files(Language::Ls, &long).unwrap();
    let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names, ["LONG.ls", "LONG_1.ls", "LONG_2.ls"]);
    assert!(files[0].text.contains("CALL LONG_2") && files[2].text.contains("UTOOL_NUM=3"));
    assert_eq!(parse(Language::Ls, files).moves().count(), 9001);
    assert_eq!(write(Language::Ls, &long).unwrap().len(), 1);
}

/// The arm as it is: off in its table and its zeros, soft, with a bearing that tilts.
fn real(robot: &Description, nominal: &Nominal<6>) -> Generic<6> {
    let mut real = robot.clone();
    for (joint, value) in real.joints.iter_mut().zip([2.6e-7, 1.5e-7, 2.6e-7, 1.8e-6, 1.5e-6, 2.1e-6]) {
        joint.compliance = vec![robstiff_robots::Part { name: String::new(), value }];
    }
    real.effects = vec![
        Effect::JointZeroOffset { joint: 2, value: 6e-4 },
        Effect::JointZeroOffset { joint: 4, value: -1e-3 },
        Effect::TransverseCompliance { joint: 3, value: 3e-7 },
    ];
    real.tool = placement(&nominal.tool_of_arm(&tool()));
    Generic::new(&real).unwrap()
}

fn load(points: usize, rapids: impl Fn(usize) -> bool) -> Load {
    let contact = |i: usize| Contact {
        wrench: if rapids(i) { Vector6::zeros() } else { Vector6::new(300.0, -150.0, 200.0, 5.0, 0.0, -3.0) },
        response: Matrix3::zeros(),
        frame: None,
        into: None,
        turn: Matrix3::identity(),
    };
    Load { contacts: (0..points).map(contact).collect(), revolution: Revolutions::None, undirected: Vec::new() }
}

/// Where the tip of the real arm is when its controller runs a program under the load, off where the program
/// that was not corrected wants it (m), at the worst.
fn off(
    document: &Document,
    wanted: &Followed<'_, 6>,
    postures: &Postures<'_, 6>,
    real: &Generic<6>,
    load: &Load,
) -> f64 {
    let run = Followed::new(document, postures, &frames(postures.nominal), None).unwrap();
    let off = run.stops.iter().zip(&wanted.stops).zip(&load.contacts).filter_map(|((stop, wanted), contact)| {
        let deflection = real.deflection(&stop.q, &contact.wrench);
        let tip: Vector3<f64> = turned(&real.transform(&stop.q), &deflection).fixed_view::<3, 1>(0, 3).into_owned();
        Some((tip - wanted.wanted?.translation.vector).norm())
    });
    off.fold(0.0, f64::max)
}

#[test]
fn a_corrected_program_leaves_next_to_nothing() {
    for (language, robot, pendant) in ROBOTS {
        for targets in [Targets::Poses, Targets::Joints] {
            let robot = robot();
            let nominal = Nominal::<6>::new(&robot, None).unwrap();
            let postures = Postures::new(&nominal);
            let document = parse(language, program(&robot, language, pendant, Some(targets)));
            let followed = Followed::new(&document, &postures, &frames(&nominal), None).unwrap();
            if followed.stops.iter().all(|stop| stop.wanted.is_none()) {
                // Joint motions to angles stay as they are.
                continue;
            }
            let arm = real(&robot, &nominal);
            let axis = Vector3::z_axis();
            let (_, path) = followed.path(&arm, axis, false).unwrap();
            let load = load(path.points.len(), |i| path.points[i].rapid);
            let corrected = compensate(&arm, &path, &load, Keep::of(6, axis)).unwrap();
            let commanded: Vec<SVector<f64, 6>> = corrected.points.iter().map(|point| point.q).collect();
            let (positions, otherwise) = followed.positions(&postures, &commanded);
            assert!(otherwise.is_empty(), "{otherwise:?}");
            let files = followed.files(&positions).unwrap();
            assert_ne!(files, document.files());
            let again = parse(language, files);
            let [before, after] = [&document, &again].map(|document| off(document, &followed, &postures, &arm, &load));
            // The digits of angles in a TP program alone are more than a true model leaves.
            let share = if targets == Targets::Joints { 0.1 } else { 0.02 };
            // An arm of half the size.
            let worth = if language == Language::Ur { 5e-4 } else { 1e-3 };
            assert!(before > worth && after < share * before, "{language:?} {targets:?}: {before} m, {after} m");

            // Taught on the arm, the program stays where only the force is off; without one, as it is.
            let (_, path) = followed.path(&arm, axis, true).unwrap();
            let same: Vec<SVector<f64, 6>> = path.points.iter().map(|point| point.q).collect();
            assert_eq!(followed.files(&followed.positions(&postures, &same).0).unwrap(), document.files());
        }
    }
}

const KRL: &str = "DEF Part( )\n$BASE={X 1000,Y 0,Z 500,A 0,B 0,C 0}\n$TOOL=MYTOOL\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}\n\
    $VEL.CP=0.02\nLIN {X 600,Y 0,Z 300,A 0,B 90,C 0}\nCIRC {X 610,Y 10,Z 300},{X 620,Y 0,Z 300}\n  LIN {X 9000,Y 0,Z 300}\nEND\n";

#[test]
fn what_cannot_be_followed_is_shown_at_its_line() {
    let robot = kuka();
    let nominal = Nominal::<6>::new(&robot, None).unwrap();
    let postures = Postures::new(&nominal);
    let name = "part.src".to_owned();
    let follow = |text: &str, frames: &Frames| {
        let document = parse(Language::Krl, vec![TextFile { name: name.clone(), text: text.to_owned() }]);
        Followed::new(&document, &postures, frames, None).map(|_| ()).unwrap_err().to_string()
    };
    let reported = follow(KRL, &Frames::default());
    assert!(reported.contains("part.src:6:1") && reported.contains("--tool-data \"MYTOOL = x"), "{reported}");
    assert_eq!(reported.matches("MYTOOL` stands").count(), 1, "{reported}");
    let known = Frames { tools: vec![("mytool".to_owned(), tool())], ..Frames::default() };
    let far = KRL.replace("LIN {X 9000,Y 0,Z 300}", "LIN {X 9000,Y 0,Z 300,A 0,B 90,C 0}");
    let reported = follow(&far, &known);
    assert!(reported.contains("part.src:8:3") && reported.contains("out of reach"), "{reported}");
    let rail = KRL.replace("A6 0}", "A6 0,E1 0}").replace("B 90,C 0}", "B 90,C 0,E1 5}");
    let reported = follow(&rail, &known);
    assert!(reported.contains("part.src:6:1") && reported.contains("further axes move"), "{reported}");
}
