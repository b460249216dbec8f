//! Whether gears carry the arm's own weight when the load comes.
//!
//! A description with masses says what weighs on each joint, and not whether its gear carries
//! that or a compensator does. Backlash and hardening are about all that a gear carries: about
//! the load alone they are other curves, which wild readings or a slip of the base account for
//! no worse. So where something is missing in the description of an arm whose masses are known,
//! the search is gone through once more with gears that carry the weight, and it is that one
//! which is told if a curve of a gear is found that leaves less: no structure where the other
//! leaves some, else what is better by the criterion of Schwarz, with odds of 20 to 1.

use std::vec;
use std::vec::Vec;

use robstiff_robots::Place as Part;

use super::bench::Bench;
use super::catalogue::{GRAVITY_PRELOAD, HYSTERESIS, LOST_MOTION, STIFFNESS_NONLINEARITY};
use super::found::{EffectParameter, Found};
use super::report::report;
use super::search::Outcome;
use super::selection::WITHIN_REACH;
use super::{NamedEffect, Options, Trace, Verdict, displacements};
use crate::campaign::Campaign;
use crate::identify::prepare::Prepared;
use robstiff::Effect;

/// How much of the weight gears carry that carry it.
const WHOLE: f64 = 1.0;

/// Whether a kind is a curve of a gear.
fn is_curve(kind: &str) -> bool {
    [STIFFNESS_NONLINEARITY.name, LOST_MOTION.name, HYSTERESIS.name].contains(&kind)
}

/// The same campaign on an arm whose gears carry its weight, where that is worth a try:
/// something is missing, and the masses are known. A description that has curves has them
/// about the torques that it says.
pub fn worth_a_try(campaign: &Campaign, outcome: &Outcome) -> Option<Campaign> {
    let robot = &campaign.robot;
    let says = |effect: &Effect| is_curve(effect.kind()) || matches!(effect, Effect::GravityPreload { .. });
    let is_missing = outcome.structure() || !outcome.selection.model.named.is_empty() || !outcome.events.is_empty();
    let is_known = robot.links.iter().any(|link| link.mass > 0.0) && !robot.effects.iter().any(says);
    if outcome.verdict == Verdict::Insufficient || outcome.misread || !is_missing || !is_known {
        return None;
    }
    let mut preloaded = campaign.clone();
    preloaded.robot.effects.push(Effect::GravityPreload { share: WHOLE });
    Some(preloaded)
}

/// The trace of the same campaign on such an arm, where that accounts better for the data; none
/// where no search can be made of it.
pub fn better(preloaded: &Campaign, plain: (&Bench<'_>, &Outcome), options: &Options) -> Option<Trace> {
    let prepared = Prepared::new(preloaded).ok()?;
    // Its stages are those that were told before.
    let (bench, outcome) = displacements::of_campaign(preloaded, &prepared, options, &|_| ()).ok()?;
    if !is_better((&bench, &outcome), plain) {
        return None;
    }
    let mut trace = report(preloaded, &prepared, &bench, outcome, options).ok()?;
    let has_curve = trace.effects.iter().any(|named| is_curve(named.effect.kind()));
    tell(&mut trace);
    has_curve.then_some(trace)
}

/// Whether what was found with gears that carry the weight accounts better for the data.
fn is_better(preloaded: (&Bench<'_>, &Outcome), plain: (&Bench<'_>, &Outcome)) -> bool {
    let has_curve = preloaded.1.names(preloaded.0).iter().any(|name| name.split('@').next().is_some_and(is_curve));
    match (preloaded.1.structure(), plain.1.structure()) {
        _ if !has_curve => false,
        (false, true) => true,
        (true, false) => false,
        _ => matches!(
            (preloaded.1.bic_of_all(preloaded.0), plain.1.bic_of_all(plain.0)),
            (Some(with), Some(without)) if with < without - WITHIN_REACH
        ),
    }
}

/// Tells that gears carry the weight, behind the first curve that says so. Alone it does
/// nothing, and is as sure as the curves.
fn tell(trace: &mut Trace) {
    let curves = trace.effects.iter().filter(|named| is_curve(named.effect.kind()));
    let p_value = curves.map(|named| named.p_value).fold(0.0, f64::max);
    let Some(first) = trace.effects.iter().position(|named| is_curve(named.effect.kind())) else { return };
    let share = EffectParameter { name: "share", value: WHOLE, std: None, unit: "1" };
    let told = NamedEffect {
        effect: Found::new(&GRAVITY_PRELOAD, Part::Robot.into(), vec![share]),
        lines: Vec::new(),
        p_value,
        holdout_rms: trace.effects[first].holdout_rms,
        same_as: Vec::new(),
        in_part: Vec::new(),
        partial: trace.effects[first].partial,
    };
    trace.effects.insert(first + 1, told);
}
