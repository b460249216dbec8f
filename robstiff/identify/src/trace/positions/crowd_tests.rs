//! Rows under payload that stand out because the description does not know what loads do.

use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use super::tests::{names, six_axis, traced};
use crate::campaign::made_positions::Plan;
use crate::campaign::{Campaign, Data};
use crate::trace::Verdict;
use robstiff::Effect;

/// A campaign without and under payload of an arm on which the torque of one joint bends another
/// that no drive ties to it: no effect of the catalogue.
fn coupled(joints: [usize; 2], value: f64, seed: u64) -> Campaign {
    let hidden = vec![Effect::JointCoupling { joints, value }];
    Plan { hidden, payloads: vec![0.0, 120.0], noise: 5e-6, ..Plan::new(six_axis(), seed) }.run()
}

/// Without declared noise the worst tenth of the rows must not pass for what is wrong.
#[test]
fn what_loads_do_is_no_matter_of_single_rows() {
    for (seed, joints) in (0..).zip([[1, 5], [2, 4], [2, 5]]) {
        let trace = traced(&coupled(joints, 1.5e-7, seed));
        assert_ne!(trace.verdict, Verdict::Explained, "{joints:?}: {}", trace.why);
        assert_eq!(names(&trace), Vec::<String>::new(), "{joints:?}: {}", trace.why);
    }
}

/// Rows that went wrong by themselves are wild, whatever they carry.
#[test]
fn single_rows_under_payload_are_wild() {
    let plan = Plan { payloads: vec![0.0, 120.0], noise: 2e-5, ..Plan::new(six_axis(), 5) };
    let mut campaign = plan.run();
    let Data::Position(data) = &mut campaign.data else { unreachable!("positions") };
    let wild = [11, 37, 63, 89];
    wild.iter().for_each(|&row| data.rows[row].position[row % 3] += 4e-4);
    let lines: Vec<usize> = wild.iter().map(|&row| data.rows[row].line).collect();
    let trace = traced(&campaign);
    assert_eq!((trace.verdict, names(&trace)), (Verdict::Explained, vec!["outliers@rig".to_string()]), "{}", trace.why);
    assert_eq!(trace.effects[0].lines, lines);
}
