//! Which posture it is, and the way back.

use nalgebra::Isometry3;
use proptest::prelude::*;

use super::{abb, degrees, fanuc, kuka};
use crate::controller::{NoNominal, Nominal, Postures, Unmatched, said};
use crate::program::{Configuration, Language};
use robstiff_robots::{Description, samples};

fn words(robot: &Description, pendant: [f64; 6], language: Language) -> String {
    let nominal = Nominal::<6>::new(robot, None).unwrap();
    let q = nominal.joints(degrees(pendant).as_slice()).unwrap();
    said(&Postures::new(&nominal).configuration(&q, language).unwrap())
}

/// KUKA: positions that were taught on robots have S 2 with T 2, 10, 35 and S 6 with T 18, 26, 27, 50: bit 2
/// of S goes with the bit of A5 in T.
#[test]
fn kuka_has_status_and_turn() {
    let is = |axes, expected: &str| assert_eq!(words(&kuka(), axes, Language::Krl), expected, "{axes:?}");
    is([0.0, -90.0, 90.0, 0.0, 45.0, 0.0], "S 2, T 2");
    is([-5.0, -70.0, 100.0, 3.0, 40.0, -20.0], "S 2, T 35");
    is([10.0, -70.0, 100.0, -3.0, -40.0, 20.0], "S 6, T 26");
    // Leaning back, the wrist is behind axis 1; bent beyond straight, the forearm is up.
    is([0.0, -150.0, 30.0, 0.0, 45.0, 0.0], "S 3, T 2");
    is([0.0, -60.0, -60.0, 0.0, 45.0, 0.0], "S 0, T 6");
}

/// ABB, RAPID reference manual, confdata: quarters 0, -1 and 1, and the table of cfx.
#[test]
fn abb_has_confdata() {
    let is = |axes, expected: &str| assert_eq!(words(&abb(), axes, Language::Rapid), expected, "{axes:?}");
    is([0.0, 0.0, 0.0, 0.0, 30.0, 0.0], "[0,0,0,0]");
    is([-10.0, 0.0, 0.0, 100.0, -30.0, -181.0], "[-1,1,-3,1]");
    is([10.0, 40.0, -150.0, 0.0, 30.0, 0.0], "[0,0,0,2]");
    is([10.0, -65.0, -60.0, 0.0, 30.0, 0.0], "[0,0,0,4]");
}

/// FANUC: with the tool down at J5 = -90 degrees it is N U T.
#[test]
fn fanuc_has_letters_and_turns() {
    let is = |axes, expected: &str| assert_eq!(words(&fanuc(), axes, Language::Ls), expected, "{axes:?}");
    is([0.0, 0.0, 0.0, 0.0, -90.0, 0.0], "'N U T, 0, 0, 0'");
    is([0.0, 20.0, -10.0, -190.0, 90.0, 181.0], "'F U T, 0, -1, 1'");
    let nominal = Nominal::<6>::new(&fanuc(), None).unwrap();
    let q = nominal.joints(degrees([0.0, 0.0, 0.0, 0.0, -90.0, 0.0]).as_slice()).unwrap();
    let flange = nominal.pose(&q, &Isometry3::identity());
    assert!((flange.rotation * nalgebra::Vector3::z() + nalgebra::Vector3::z()).norm() < 1e-12);
}

/// Far from where it begins: the words alone lead to the posture.
fn back(robot: &Description, language: Language, pendant: [f64; 6], near: [f64; 6]) -> Result<(), TestCaseError> {
    let nominal = Nominal::<6>::new(robot, None).unwrap();
    let postures = Postures::new(&nominal);
    let q = nominal.joints(degrees(pendant).as_slice()).unwrap();
    let tool = Isometry3::translation(0.1, -0.02, 0.3);
    let configuration = postures.configuration(&q, language).unwrap();
    let pose = nominal.pose(&q, &tool);
    let found = postures.solve(&pose, &tool, Some(&configuration), &degrees(near));
    let found = found.map_err(|why| TestCaseError::fail(format!("{} {why}", said(&configuration))))?;
    prop_assert!((nominal.pose(&found, &tool).translation.vector - pose.translation.vector).norm() < 1e-9);
    // Signs of axes 2, 3 and 5 leave some in turns of axes 4 and 6.
    prop_assert!(postures.is(&found, &configuration));
    let apart = (found - q).amax();
    let whole_turns =
        (found - q).iter().all(|by| (by.to_degrees() / 360.0 - (by.to_degrees() / 360.0).round()).abs() < 1e-7);
    prop_assert!(whole_turns, "{apart} {}", said(&configuration));
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn words_lead_back_to_the_posture(
        one in -160.0..160.0, two in -85.0..-20.0, three in 30.0..130.0, four in -170.0..170.0, five in 6.0..110.0_f64,
        flipped: bool, six in -300.0..300.0, near in prop::array::uniform6(-60.0..60.0),
    ) {
        let five = if flipped { -five } else { five };
        back(&kuka(), Language::Krl, [one, two, three, four, five, six], near)?;
        back(&abb(), Language::Rapid, [one, two + 40.0, three - 80.0, four, five, six], near)?;
        back(&fanuc(), Language::Ls, [one, two + 40.0, three - 80.0, four, five, six], near)?;
    }
}

#[test]
fn a_posture_that_does_not_get_there_is_refused() {
    let robot = kuka();
    let nominal = Nominal::<6>::new(&robot, None).unwrap();
    let postures = Postures::new(&nominal);
    let q = degrees([0.0, -90.0, 90.0, 0.0, 45.0, 0.0]);
    let pose = nominal.pose(&q, &Isometry3::identity());
    // A1 at 180 degrees is beyond its limits.
    let asked = Configuration::Kuka { status: Some(3), turn: None };
    let refused = postures.solve(&pose, &Isometry3::identity(), Some(&asked), &q).unwrap_err();
    let Unmatched::Otherwise(found) = &refused else { panic!("{refused}") };
    assert!(found.contains(&"S 2, T 2".to_owned()), "{refused}");
    let far = Isometry3::translation(5.0, 0.0, 0.0) * pose;
    let refused = postures.solve(&far, &Isometry3::identity(), None, &q).unwrap_err();
    assert!(matches!(refused, Unmatched::Unreached(_)), "{refused}");
}

#[test]
fn the_nominal_model_has_no_effects_and_another_table_where_one_is_given() {
    let mut robot = kuka();
    let q = degrees([10.0, -80.0, 100.0, 5.0, 45.0, 0.0]);
    let identity = Isometry3::identity();
    let plain = Nominal::<6>::new(&robot, None).unwrap().pose(&q, &identity);
    robot.effects.push(robstiff::Effect::JointZeroOffset { joint: 2, value: 1e-3 });
    assert_eq!(Nominal::<6>::new(&robot, None).unwrap().pose(&q, &identity), plain);
    let mut maker = robot.clone();
    maker.joints[1].a += 1e-3;
    let other = Nominal::<6>::new(&robot, Some(&maker)).unwrap().pose(&q, &identity);
    assert!(((other.translation.vector - plain.translation.vector).norm() - 1e-3).abs() < 1e-12);

    robot.controller = None;
    assert_eq!(Nominal::<6>::new(&robot, None).unwrap_err(), NoNominal::NoController);
    let mut five = samples::five_axis();
    five.controller = kuka().controller;
    assert!(matches!(Nominal::<5>::new(&five, Some(&maker)), Err(NoNominal::OtherJoints { .. })));
    let nominal = Nominal::<5>::new(&five, None).unwrap();
    assert!(Postures::new(&nominal).unfit().is_some());
}
