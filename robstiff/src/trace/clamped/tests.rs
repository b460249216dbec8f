//! What single rows of clamped axes are taken for. Rows are made from the laws
//! themselves: what is tested is the search.

use std::string::{String, ToString};
use std::vec::Vec;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;

use crate::campaign::made::{campaign, normal};
use crate::campaign::{Campaign, ClampedRow, Data};
use crate::samples::five_axis;
use crate::trace::{Options, Trace, Verdict, trace};

/// One sigma of a reading (rad).
const NOISE: f64 = 1e-6;

/// The same torques (Nm) on every axis; `more` is what an axis turns by besides its
/// compliance (rad).
fn measured(robot: &Description, torques: &[f64], seed: u64, more: impl Fn(usize, f64) -> f64) -> Campaign {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut rows = Vec::new();
    for (joint, axis) in robot.joints.iter().zip(1..) {
        let unloaded = NOISE * normal(&mut random);
        for &torque in torques {
            let exact = joint.compliance() * torque + more(axis, torque);
            let deflection = exact + NOISE * normal(&mut random) - unloaded;
            rows.push(ClampedRow { line: rows.len() + 2, axis, torque, deflection });
        }
    }
    campaign(robot.clone(), Data::Clamped(rows))
}

fn traced(campaign: &Campaign) -> Trace {
    let options = Options { draws: 499, ..Options::default() };
    trace(campaign, &options, &|_| {}).expect("every axis is loaded")
}

fn names(trace: &Trace) -> Vec<String> {
    trace.effects.iter().map(|named| named.effect.to_string()).collect()
}

fn ramp(count: usize) -> Vec<f64> {
    (1..=count).map(|k| 1000.0 * k as f64 / count as f64).collect()
}

#[test]
fn a_curve_of_one_gear_is_no_wild_reading() {
    for seed in 0..3 {
        let lost = |axis, torque: f64| if axis == 2 { 0.5e-4 * torque / torque.hypot(20.0) } else { 0.0 };
        let trace = traced(&measured(&five_axis(), &ramp(14), seed, lost));
        let told = (trace.verdict, names(&trace));
        assert_eq!(told, (Verdict::Explained, ["lost_motion@joint 2".into()].into()), "seed {seed}");
    }
}

/// Two of eight rows of an axis do not hide each other.
#[test]
fn wild_readings_of_one_axis_are_told() {
    let mut campaign = measured(&five_axis(), &ramp(8), 7, |_, _| 0.0);
    let Data::Clamped(rows) = &mut campaign.data else { unreachable!("made of clamped axes") };
    rows[18].deflection += 3e-4;
    rows[21].deflection -= 2e-4;
    let trace = traced(&campaign);
    assert_eq!((trace.verdict, names(&trace)), (Verdict::Explained, ["outliers@rig".into()].into()));
    assert_eq!(trace.effects[0].lines, [20, 23]);
}
