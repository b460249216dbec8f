//! Two effects at once: a search that adds one at a time is not sure to end
//! with both, but mostly does.

use robstiff::Effect;
use robstiff_identify::trace::{Trace, Verdict};
use robstiff_robots::Description;
use robstiff_tests::simulator::{five_axis, six_axis};

use crate::bench::{FLOOR, assert_most, names_all, traced};

const TILT_2: Effect = Effect::TransverseCompliance { joint: 2, value: 2e-7 };
const TILT_3: Effect = Effect::TransverseCompliance { joint: 3, value: 3e-7 };
const TOOL: Effect = Effect::ToolCompliance { rotation: 6e-6, translation: 1e-7 };
const COUPLING: Effect = Effect::JointCoupling { joints: [2, 3], value: 1.4e-7 };

#[test]
fn tilt_and_tool_of_five() {
    are_found(&five_axis(), [TILT_2, TOOL]);
}

#[test]
fn tilt_and_tool_of_six() {
    are_found(&six_axis(), [TILT_2, TOOL]);
}

#[test]
fn tilt_and_coupling_of_five() {
    are_found(&five_axis(), [TILT_3, COUPLING]);
}

#[test]
fn tilt_and_coupling_of_six() {
    are_found(&six_axis(), [TILT_3, COUPLING]);
}

fn are_found(arm: &Description, hidden: [Effect; 2]) {
    let traces: Vec<(u64, Trace)> = (400..404).map(|seed| (seed, traced(arm, &hidden, seed))).collect();
    let [one, other] = hidden;
    assert_most(&format!("{one} and {other} of {}", arm.name), 3, &traces, |_, trace| {
        names_all(trace, &hidden)
            && trace.verdict == Verdict::Explained
            && (0.9..1.1).contains(&(trace.after.rms / FLOOR))
    });
}
