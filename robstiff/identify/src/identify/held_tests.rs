//! How sure numbers are beside others that the readings do not tell, and where there are
//! hardly more readings than numbers.

use std::format;
use std::string::ToString;
use std::vec::Vec;

use robstiff_robots::{Description, catalogue};

use super::{Identification, identify};
use crate::campaign::made::campaign;
use crate::campaign::{Campaign, Noise};
use crate::simulate::{Scenario, simulate};

/// Pulls on some poses, each with the loads of a ramp.
#[derive(Clone, Copy)]
struct Pulls {
    poses: usize,
    visits: usize,
    ramp: &'static str,
}

/// One pose and two pulls: of its six joints it tells three or four.
const ONE_POSE: Pulls = Pulls { poses: 1, visits: 2, ramp: "[0.02, 0.35, 0.7, 1, 0.7, 0.35]" };

/// What is read under them, with noise of 8 um that is declared or not, and the robot as it is.
fn measured(Pulls { poses, visits, ramp }: Pulls, seed: usize, is_declared: bool) -> (Campaign, Description) {
    let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
    let robot = Description::parse("robot.yaml", text).expect("of the catalogue");
    let scenario = format!(
        "name: pulls\nseed: {seed}\nposes: {{count: {poses}, floor: 100 mm, column: 600 mm}}\nvisits: {visits}\n\
         ramp: {ramp}\nforce: {{bounds: [500 N, 1.3 kN]}}\nnoise: {{displacement: 8 um}}\nscatter: 0.3\n"
    );
    let scenario = Scenario::parse("try.yaml", &scenario, &robot).expect("a scenario");
    let simulated = simulate(&robot, &scenario).expect("it can be measured");
    let noise = Noise { displacement: is_declared.then_some(8e-6), rotation: None };
    (Campaign { noise, ..campaign(robot, simulated.data) }, simulated.truth)
}

/// How many standard deviations the numbers of some campaigns are off by.
fn off(pulls: Pulls, campaigns: usize, is_declared: bool) -> Vec<f64> {
    let of_one = |seed: usize| -> Option<Vec<f64>> {
        let (campaign, truth) = measured(pulls, seed, is_declared);
        let found: Identification = identify(&campaign).ok()?;
        let joints = found.estimates.iter().zip(&truth.joints);
        Some(joints.filter_map(|(joint, truth)| Some((joint.value - truth.compliance()).abs() / joint.std?)).collect())
    };
    (1..=campaigns).filter_map(of_one).flatten().collect()
}

/// They are intervals of 95 %, and none is far beyond.
fn hold(off: &[f64]) {
    let beyond = off.iter().filter(|&&off| off > 1.96).count();
    assert!(off.len() > 200 && beyond * 20 <= off.len() + 20, "{beyond} of {}", off.len());
    let worst = off.iter().copied().fold(0.0, f64::max);
    assert!(worst < 5.0, "off by {worst} standard deviations");
}

/// A joint that is held as declared, or clipped at zero, is off by some part of itself, and
/// what it does is in the readings that others are identified from.
#[test]
fn a_single_pose_is_no_surer_than_what_it_does_not_tell() {
    hold(&off(ONE_POSE, 60, true));
}

/// A fit of as many numbers as there are readings leaves nothing, whatever the noise.
#[test]
fn few_rows_are_no_surer_than_the_noise_that_is_declared() {
    for poses in 1..=3 {
        hold(&off(Pulls { poses, visits: 1, ramp: "[1]" }, 150, true));
    }
}

/// Without a noise that is declared, rows must tell how noisy they are beside the numbers.
#[test]
fn too_few_rows_to_tell_the_noise_are_refused() {
    for (seed, poses) in (1..=8).flat_map(|seed| [1, 2, 3].map(|poses| (seed, poses))) {
        let (campaign, _) = measured(Pulls { poses, visits: 1, ramp: "[1]" }, seed, false);
        let why = identify(&campaign).err().map(|error| error.to_string()).unwrap_or_default();
        assert!(why.contains("cannot tell the 6 compliances of the robot from each other"), "{seed} {poses}: {why}");
    }
    for poses in [4, 6] {
        let off = off(Pulls { poses, visits: 1, ramp: "[1]" }, 100, false);
        let beyond = off.iter().filter(|&&off| off > 1.96).count();
        assert!(off.len() > 200 && beyond * 10 <= off.len(), "{beyond} of {} at {poses} poses", off.len());
    }
}
