//! Weight that a description does not know, held against names.

use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use robstiff_robots::{Description, Link};

use super::tests::{names, six_axis, traced};
use super::weight::SAG;
use crate::campaign::made_positions::Plan;
use crate::trace::{NamedEffect, Trace, Verdict};
use robstiff::Effect;

/// The arm with masses.
fn heavy(factors: [f64; 6]) -> Description {
    let masses = [300.0, 250.0, 200.0, 80.0, 40.0, 20.0];
    let centers =
        [[0.0, 0.1, 0.0], [-0.6, 0.0, 0.1], [0.0, 0.05, 0.1], [0.0, -0.4, 0.0], [0.0, 0.0, 0.05], [0.0, 0.0, -0.05]];
    let mut robot = six_axis();
    robot.links = (0..6).map(|k| Link { mass: masses[k] * factors[k], center_of_mass: centers[k] }).collect();
    robot
}

/// What these positions tell, of an arm that has these masses and is described otherwise.
fn described_as(described: Description, factors: [f64; 6], seed: u64) -> Trace {
    let hidden = vec![Effect::GravitySag { share: 1.0 }];
    let mut campaign = Plan { hidden, noise: 2e-5, ..Plan::new(heavy(factors), seed) }.run();
    campaign.robot = described;
    traced(&campaign)
}

/// An arm sags whose description has no masses, or wrong ones: no angle has an error that
/// comes back once a turn.
#[test]
fn a_sag_that_the_description_has_not_is_no_periodic_error() {
    let wrong = [1.0, 1.3, 0.8, 1.4, 0.7, 2.0];
    for seed in 0..3 {
        for described in [six_axis(), heavy([1.0; 6])] {
            let sags = if described.links.is_empty() { vec![] } else { vec![SAG] };
            let trace = described_as(described, wrong, seed);
            assert_eq!(names(&trace), sags, "{}", trace.why);
            assert_ne!(trace.verdict, Verdict::Explained, "{}", trace.why);
            assert!(trace.looks_like.iter().any(|words| words.starts_with("unknown weight on joint")), "{}", trace.why);
        }
    }
}

/// A wave once a turn of the shoulder is what weight does as well, or a compensator; not one
/// of the upright axis, of the elbow, more times a turn, or larger than an arm gives way.
#[test]
fn of_a_wave_of_the_shoulder_a_sag_is_listed() {
    let wave = |joint, order, sin| Effect::TransmissionError { joint, order, sin, cos: -1.5e-4 };
    let cases = [
        (wave(2, 1.0, 2e-4), true),
        (wave(1, 1.0, 2e-4), false),
        (wave(3, 1.0, 2e-4), false),
        (wave(2, 2.0, 2e-4), false),
        (wave(2, 1.0, 4e-3), false),
    ];
    for (seed, (effect, is_like)) in (30..).zip(cases) {
        for robot in [six_axis(), heavy([1.0; 6])] {
            let trace = traced(&Plan { hidden: vec![effect], ..Plan::new(robot, seed) }.run());
            assert_eq!((trace.verdict, names(&trace)), (Verdict::Explained, vec![effect.to_string()]), "{}", trace.why);
            let listed: Vec<&str> = trace.effects[0].same_as.iter().map(String::as_str).collect();
            assert_eq!(listed, if is_like { vec![SAG] } else { vec![] }, "{effect:?}");
        }
    }
}

/// A compensator beside a sag by masses that are known: the sag keeps its name, and how to
/// tell the rest is said.
#[test]
fn a_compensator_beside_a_sag_is_one_or_a_wave() {
    let wave = Effect::TransmissionError { joint: 2, order: 1.0, sin: 3e-4, cos: 1e-4 };
    for seed in 10..13 {
        let hidden = vec![Effect::GravitySag { share: 1.0 }, wave];
        let trace = traced(&Plan { hidden, ..Plan::new(heavy([1.0; 6]), seed) }.run());
        assert_eq!((trace.verdict, names(&trace)), (Verdict::Explained, vec![SAG.into(), wave.to_string()]));
        let listed = |named: &NamedEffect| named.same_as.iter().any(|name| name == SAG);
        assert!(trace.effects.iter().all(|named| listed(named) == (named.effect.to_string() != SAG)));
        assert!(trace.why.contains("the torques of the motors at rest"), "{}", trace.why);
    }
}
