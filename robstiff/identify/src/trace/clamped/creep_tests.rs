//! Gears that creep, all or one, and are told as that.

use core::cell::RefCell;
use std::string::{String, ToString};
use std::vec::Vec;

use super::tests::{NOISE, both_ways, measured, names, ramp, traced};
use crate::trace::Verdict;
use robstiff_robots::samples::five_axis;

/// What axes turn by that creep by a share each, a decade after 0.3 rows.
pub(super) fn creep(shares: [f64; 5]) -> impl Fn(usize, f64) -> f64 {
    let loads = RefCell::new((0, Vec::new()));
    move |axis, torque| {
        let (last, loads) = &mut *loads.borrow_mut();
        if *last != axis {
            (*last, *loads) = (axis, Vec::new());
        }
        loads.push(torque);
        let own = shares[axis - 1] * five_axis().joints[axis - 1].compliance();
        let step = |k: usize| loads[k] - k.checked_sub(1).map_or(0.0, |before| loads[before]);
        let since = |k: usize| (1.0 + (loads.len() - k) as f64 / 0.3).log10();
        own * (0..loads.len()).map(|k| since(k) * step(k)).sum::<f64>()
    }
}

/// The shares by which axes creep so many times the noise of a reading under the largest load.
fn shares(times: [f64; 5]) -> [f64; 5] {
    core::array::from_fn(|k| times[k] * NOISE / (1000.0 * five_axis().joints[k].compliance()))
}

/// What one gear has by noise that looks like a play, all have, and is creep.
#[test]
fn gears_that_all_creep_do_not_lag() {
    let there_and_back = || -> Vec<f64> {
        let line = ramp(9).into_iter().map(|torque| 2.0 * torque - 1000.0);
        line.clone().rev().chain(line.skip(1)).collect()
    };
    for (seed, torques) in (0..4).zip([both_ways(), there_and_back()].iter().cycle()) {
        let creep = creep(shares([12.0, 22.0, 16.0, 28.0, 18.0]));
        let trace = traced(&measured(&five_axis(), torques, 900 + seed, creep));
        let told = names(&trace);
        assert!(told.iter().all(|name| name.starts_with("creep@")), "{seed}: {told:?}");
        assert_eq!(trace.verdict, Verdict::Explained, "{seed}: {}", trace.why);
    }
}

#[test]
fn one_axis_that_creeps_is_told() {
    for seed in 0..3 {
        let shares = shares([0.0, 40.0, 0.0, 0.0, 0.0]);
        let trace = traced(&measured(&five_axis(), &both_ways(), 910 + seed, creep(shares)));
        assert_eq!(
            (trace.verdict, names(&trace)),
            (Verdict::Explained, ["creep@joint 2".to_string()].into()),
            "{seed}"
        );
        let effect = &trace.effects[0].effect;
        assert!((effect.value("share") / shares[1] - 1.0).abs() < 0.3, "{seed}: {}", effect.value("share"));
        assert!(effect.is_of_rig() && effect.words().contains("joint 2"), "{}", effect.words());
    }
}

/// Some of both is how gears look that all creep or all lag, and is not taken for what it is.
#[test]
fn an_axis_that_lags_beside_others_that_creep_is_partial() {
    let state = core::cell::Cell::new(0.0);
    let others = creep(shares([20.0, 0.0, 20.0, 20.0, 20.0]));
    let both = |axis: usize, torque: f64| {
        if axis != 2 {
            return others(axis, torque);
        }
        state.set(super::tests::play(torque, 250.0, state.get()));
        1e-7 * state.get()
    };
    let trace = traced(&measured(&five_axis(), &both_ways(), 920, both));
    let told = names(&trace);
    assert!(told.contains(&String::from("hysteresis@joint 2")), "{told:?}");
    assert!(told.iter().any(|name| name.starts_with("creep@")), "{told:?}");
    assert_eq!(trace.verdict, Verdict::Partial);
}
