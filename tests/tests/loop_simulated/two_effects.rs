//! Two effects at once: a search that adds one at a time is not sure to end
//! with both, but mostly does.

use robstiff::Effect;
use robstiff_identify::trace::{Trace, Verdict};

use crate::bench::{FLOOR, arm, assert_most, names_all, traced};

const TILT_2: Effect = Effect::TransverseCompliance { joint: 2, value: 2e-7 };
const TILT_3: Effect = Effect::TransverseCompliance { joint: 3, value: 3e-7 };
const TOOL: Effect = Effect::ToolCompliance { rotation: 6e-6, translation: 1e-7 };
const COUPLING: Effect = Effect::JointCoupling { joints: [2, 3], value: 1.4e-7 };

#[test]
fn tilt_and_tool() {
    are_found([TILT_2, TOOL]);
}

#[test]
fn tilt_and_coupling() {
    are_found([TILT_3, COUPLING]);
}

fn are_found(hidden: [Effect; 2]) {
    let traces: Vec<(u64, Trace)> = (400..404).map(|seed| (seed, traced(&arm(seed), &hidden, seed))).collect();
    let [one, other] = hidden;
    assert_most(&format!("{one} and {other}"), 3, &traces, |_, trace| {
        names_all(trace, &hidden)
            && trace.verdict == Verdict::Explained
            && (0.9..1.1).contains(&(trace.after.rms / FLOOR))
    });
}
