//! What has no name, held against what has one.

use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use robstiff_robots::effect::DhEntry;

use super::tests::{names, six_axis, traced};
use crate::campaign::made_positions::Plan;
use crate::campaign::{Campaign, Data};
use crate::trace::{Trace, Verdict};
use robstiff::Effect;

/// A campaign whose joint goes by a share of how far one has gone from an angle farther than
/// it reads.
fn following(plan: &Plan, [joint, of]: [usize; 2], share: f64, from: f64) -> Campaign {
    let mut campaign = plan.run();
    let Data::Position(data) = &mut campaign.data else { unreachable!("positions") };
    for row in &mut data.rows {
        row.q[joint - 1] -= share * (row.q[of - 1] - from);
    }
    campaign
}

/// An encoder with a scale of its own is no periodic error, nor is a joint that another
/// takes along; they look like themselves, wherever they count from and however noisy the
/// readings are said to be.
#[test]
fn a_joint_that_goes_farther_than_it_reads_has_no_name() {
    let scale = |joint| (std::format!("an encoder of joint {joint} that has a scale of its own"), [joint, joint]);
    let along = |joint, of| (std::format!("joint {joint} going along with joint {of}"), [joint, of]);
    let cases = [(scale(4), 0.0), (along(5, 4), 0.0), (scale(3), 0.9), (along(3, 2), -0.6)];
    for (seed, ((words, joints), from)) in (0..).zip(cases) {
        for declared in [None, Some(3e-5)] {
            let mut campaign = following(&Plan::new(six_axis(), seed), joints, 4e-4, from);
            campaign.noise.displacement = declared;
            let trace = traced(&campaign);
            assert_eq!((trace.verdict, names(&trace)), (Verdict::Unexplained, vec![]), "{words}: {}", trace.why);
            assert_eq!(trace.looks_like, [words.as_str()]);
            assert!(trace.why.contains(&words) && trace.description.effects.is_empty(), "{}", trace.why);
        }
    }
}

/// Under payload the torque of one joint turns another, through no drive that they share.
#[test]
fn a_coupling_without_a_drive_has_no_name() {
    for (seed, joints) in (0..).zip([[1, 5], [2, 4]]) {
        let hidden = vec![Effect::JointCoupling { joints, value: 3e-7 }];
        let plan = Plan { hidden, payloads: vec![0.0, 120.0], noise: 1e-5, ..Plan::new(six_axis(), seed) };
        let trace = traced(&plan.run());
        assert_eq!((trace.verdict, names(&trace)), (Verdict::Unexplained, vec![]), "{joints:?}: {}", trace.why);
        let [i, j] = joints;
        assert_eq!(trace.looks_like, [std::format!("a coupling of joints {i} and {j}, which share no drive")]);
    }
}

/// What else is there keeps its name beside it.
#[test]
fn a_true_name_stays_beside_what_has_none() {
    let hidden = vec![Effect::DhError { entry: DhEntry::A(3), value: 1e-3 }];
    let campaign = following(&Plan { hidden, ..Plan::new(six_axis(), 5) }, [4, 4], 5e-4, 0.0);
    let trace = traced(&campaign);
    assert_eq!((trace.verdict, names(&trace)), (Verdict::Partial, vec!["dh_error@a3".to_string()]), "{}", trace.why);
    assert_eq!(trace.looks_like, ["an encoder of joint 4 that has a scale of its own"]);
    assert!(trace.effects[0].partial);
}

/// Effects of the catalogue are not told as something else, however much they look like it.
#[test]
fn what_has_a_name_keeps_it() {
    let wave = |joint, order| Effect::TransmissionError { joint, order, sin: 2e-4, cos: -1.5e-4 };
    let all = [wave(4, 1.0), wave(3, 1.0), wave(2, 2.0), Effect::JointZeroOffset { joint: 4, value: 5e-4 }];
    for (seed, effect) in (20..).zip(all) {
        let trace: Trace = traced(&Plan { hidden: vec![effect], ..Plan::new(six_axis(), seed) }.run());
        assert_eq!((trace.verdict, names(&trace)), (Verdict::Explained, vec![effect.to_string()]), "{}", trace.why);
        assert_eq!(trace.looks_like, Vec::<String>::new());
    }
}
