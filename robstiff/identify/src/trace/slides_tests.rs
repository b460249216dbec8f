//! Arms with joints that slide: what shows there, and what does not.

use std::string::ToString;
use std::vec;
use std::vec::Vec;

use robstiff_robots::Description;

use super::Trace;
use super::tests::{names, traced};
use crate::campaign::Data;
use crate::campaign::made::Plan;
use crate::identify::column::Column;
use robstiff::elements::Spring;

/// Two axes, a slide and the hand, all along z.
const SCARA: &str = "name: Scara
convention: standard
joints:
  - {d: 500 mm, a: 450 mm, compliance: 4e-6}
  - {a: 350 mm, alpha: 180 deg, compliance: 6e-6}
  - {type: prismatic, compliance: 3e-8 m/N}
  - {compliance: 8e-6}
tool: {xyz: [60 mm, 0, 100 mm]}
";

/// Three slides across each other, and a head of two axes.
const GANTRY: &str = "name: Gantry
convention: standard
joints:
  - {type: prismatic, alpha: -90 deg, compliance: 2e-8 m/N}
  - {type: prismatic, theta: -90 deg, alpha: -90 deg, compliance: 3e-8 m/N}
  - {type: prismatic, compliance: 4e-8 m/N}
  - {alpha: 90 deg, compliance: 3e-6}
  - {d: 250 mm, compliance: 5e-6}
tool: {xyz: [80 mm, 0, 0]}
";

fn plan(robot: &str, seed: u64) -> Plan {
    Plan { robot: Description::parse("arm.yaml", robot).expect("an arm"), ..Plan::new(seed) }
}

/// A campaign whose loads act by so much (m) beside where its file says.
fn beside(plan: &Plan, lever: [f64; 3]) -> Trace {
    let mut campaign = Plan { at: [lever, [0.0; 3]], ..plan.clone() }.run();
    let Data::Displacement(data) = &mut campaign.data else { unreachable!("made of displacements") };
    data.wrench_at = [0.0; 3];
    traced(&campaign)
}

#[test]
fn of_a_lever_is_named_what_shows() {
    let lever = [0.09, -0.06, 0.15];
    let trace = beside(&plan(SCARA, 1), lever);
    assert_eq!(names(&trace), ["lever_arm@rig"], "{}", trace.why);
    let numbers = &trace.effects[0].effect.parameters;
    assert_eq!(numbers.iter().map(|number| number.name).collect::<Vec<_>>(), ["x", "y"]);
    for (number, truth) in numbers.iter().zip(lever) {
        let std = number.std.expect("a fitted number");
        assert!((number.value - truth).abs() < 4.0 * std && std < 0.005, "{number:?}");
    }
    assert!(trace.effects[0].effect.words().ends_with("as far as these loads show"));
    // A direction that is none of the axes does not show.
    let trace = beside(&plan(GANTRY, 2), lever);
    assert_eq!(names(&trace), ["lever_arm@rig"], "{}", trace.why);
    assert_eq!(trace.effects[0].effect.parameters.len(), 2);
}

/// A belt goes along a slide.
#[test]
fn joints_with_a_slide_between_are_coupled() {
    let hidden = vec![(Column::Spring(Spring::Coupling([2, 4])), 6e-6)];
    let trace = traced(&Plan { hidden, ..plan(SCARA, 3) }.run());
    assert_eq!(names(&trace), ["joint_coupling@joints 2,4".to_string()], "{}", trace.why);
}
