//! How sure numbers are beside others that the readings do not tell.

use std::string::ToString;
use std::vec::Vec;

use robstiff_robots::{Description, catalogue};

use super::{Identification, identify};
use crate::campaign::made::campaign;
use crate::campaign::{Campaign, Noise};
use crate::simulate::{Scenario, simulate};

/// One pose and two pulls: of its six joints it tells three or four.
const ONE_POSE: &str = "\
name: one pose
seed: SEED
poses: {count: 1, floor: 100 mm, column: 600 mm}
visits: 2
ramp: [0.02, 0.35, 0.7, 1, 0.7, 0.35]
force: {bounds: [500 N, 1.3 kN]}
noise: {displacement: 8 um}
scatter: 0.3
";

/// What is identified, and the robot as it is.
fn identified(seed: usize) -> Option<(Identification, Description)> {
    let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
    let robot = Description::parse("robot.yaml", text).expect("of the catalogue");
    let scenario = ONE_POSE.replace("SEED", &seed.to_string());
    let scenario = Scenario::parse("try.yaml", &scenario, &robot).expect("a scenario");
    let simulated = simulate(&robot, &scenario).expect("it can be measured");
    let noise = Noise { displacement: Some(8e-6), rotation: None };
    let campaign = Campaign { noise, ..campaign(robot, simulated.data) };
    Some((identify(&campaign).ok()?, simulated.truth))
}

/// A joint that is held as declared, or clipped at zero, is off by some part of itself, and
/// what it does is in the readings that others are identified from.
#[test]
fn a_single_pose_is_no_surer_than_what_it_does_not_tell() {
    let mut off: Vec<f64> = Vec::new();
    for (found, truth) in (1..=60).filter_map(identified) {
        let joints = found.estimates.iter().zip(&truth.joints);
        off.extend(joints.filter_map(|(joint, truth)| Some((joint.value - truth.compliance()).abs() / joint.std?)));
    }
    let beyond = off.iter().filter(|&&off| off > 1.96).count();
    assert!(off.len() > 200 && beyond * 20 <= off.len() + 20, "{beyond} of {}", off.len());
    let worst = off.iter().copied().fold(0.0, f64::max);
    assert!(worst < 5.0, "off by {worst} standard deviations");
}
