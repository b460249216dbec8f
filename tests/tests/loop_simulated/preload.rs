//! Gears that carry the weight of the arm when the load comes. The simulator hangs masses
//! on the links, and its gears act on all that they carry; the description knows the masses.

use robstiff::Effect;
use robstiff_identify::trace::{EffectParameter, Trace, Verdict};
use robstiff_robots::{Description, Link};
use robstiff_tests::simulator::{Hidden, Scenario, six_axis};

use crate::bench::{assert_most, names_all, plan, trace_files};

/// Standard deviations that an estimate may be from the truth.
const FEW: f64 = 4.0;

/// The part of itself that a knee may be from the truth.
const CHOSEN: f64 = 0.1;

const SEEDS: std::ops::Range<u64> = 800..804;

/// The six-axis arm with masses of its size, loaded and unloaded, as described by `effects`.
fn heavy(effects: &[Effect]) -> Description {
    let mut arm = six_axis();
    let kilograms = [300.0, 250.0, 180.0, 60.0, 40.0, 80.0];
    let links = arm.joints.iter().zip(kilograms);
    arm.links = links.map(|(joint, mass)| Link { mass, center_of_mass: [-0.5 * joint.a, 0.0, 0.0] }).collect();
    arm.effects = effects.to_vec();
    arm
}

const SAG: Effect = Effect::GravitySag { share: 1.0 };
const PRELOAD: Effect = Effect::GravityPreload { share: 1.0 };

/// Traces with these effects declared, of an arm with a hidden one and its weight.
fn traces(declared: &[Effect], hidden: &Hidden) -> Vec<(u64, Trace)> {
    let of_seed = |seed| {
        let declared = heavy(declared);
        let mut plain = declared.clone();
        plain.effects.clear();
        let scenario = plan(&plain, &[], seed);
        let hidden = vec![Hidden::GravitySag(declared.links.clone()), hidden.clone()];
        (seed, trace_files(&Scenario { hidden, ..scenario }.run(), &declared, ""))
    };
    SEEDS.map(of_seed).collect()
}

/// Half as soft again without load, which the weight alone takes away.
const HARDENS: Effect = Effect::StiffnessNonlinearity { joint: 2, added: 3e-7, knee: 1500.0 };

#[test]
fn a_gear_that_hardens_is_found_under_its_preload() {
    let traces = traces(&[SAG, PRELOAD], &HARDENS.into());
    assert_most("hardening under a declared preload", 3, &traces, |_, trace| {
        let near = |name: &str, truth: f64| {
            let parameters = trace.effects.iter().flat_map(|named| &named.effect.parameters);
            let mut own = parameters.filter(|parameter| parameter.name == name);
            // A knee is chosen from a grid that is made finer, and has no standard deviation.
            let within = |own: &EffectParameter| own.std.map_or(CHOSEN * truth, |std| FEW * std);
            own.all(|own| (own.value - truth).abs() < within(own))
        };
        trace.verdict == Verdict::Explained
            && names_all(trace, &[HARDENS])
            && near("added", 3e-7)
            && near("knee", 1500.0)
    });
}

#[test]
fn backlash_is_found_where_some_loads_take_the_preload_off() {
    let backlash = Effect::LostMotion { joint: 2, gap: 4e-4, knee: 120.0 };
    let traces = traces(&[SAG, PRELOAD], &Hidden::LostMotion { joint: 2, gap: 4e-4, knee: 120.0 });
    assert_most("backlash under a declared preload", 2, &traces, |_, trace| names_all(trace, &[backlash]));
}

/// A preload that the description does not declare is found with the law of its gear.
#[test]
fn hardening_shows_a_preload_that_is_not_declared() {
    let traces = traces(&[SAG], &HARDENS.into());
    assert_most("hardening under a preload that is not declared", 3, &traces, |_, trace| {
        trace.verdict == Verdict::Explained && names_all(trace, &[HARDENS]) && is_preloaded(trace)
    });
}

#[test]
fn backlash_shows_a_preload_that_is_not_declared() {
    let backlash = Effect::LostMotion { joint: 2, gap: 4e-4, knee: 120.0 };
    let traces = traces(&[SAG], &Hidden::LostMotion { joint: 2, gap: 4e-4, knee: 120.0 });
    assert_most("backlash under a preload that is not declared", 2, &traces, |_, trace| {
        names_all(trace, &[backlash]) && is_preloaded(trace)
    });
    // Nothing else of the arm is named for it.
    assert_most("backlash under a preload that is not declared", 4, &traces, |_, trace| {
        let mut of_arm = trace.effects.iter().filter(|named| !named.effect.is_of_rig());
        of_arm.all(|named| named.effect.kind() == "lost_motion")
    });
}

fn is_preloaded(trace: &Trace) -> bool {
    trace.description.effects.contains(&PRELOAD)
}

#[test]
fn weight_alone_is_nothing_missing() {
    for declared in [&[SAG, PRELOAD][..], &[SAG]] {
        let traces = traces(declared, &Hidden::TrackerScale(0.0));
        assert_most("weight alone", 4, &traces, |_, trace| trace.verdict == Verdict::Adequate);
    }
}

/// A compensator that carries all of the weight leaves the gears nothing: the masses alone
/// are no reason to tell a preload.
#[test]
fn a_gear_that_carries_nothing_has_its_curve_about_the_load() {
    let of_seed = |seed| {
        let declared = heavy(&[]);
        let scenario = plan(&declared, &[HARDENS], seed);
        (seed, trace_files(&scenario.run(), &declared, ""))
    };
    let traces: Vec<(u64, Trace)> = SEEDS.map(of_seed).collect();
    assert_most("hardening without a preload", 3, &traces, |_, trace| {
        names_all(trace, &[HARDENS]) && !is_preloaded(trace)
    });
}
