//! Putting the result together.

use nalgebra::DVector;

use super::basis::Basis;
use super::beside;
use super::corrected::corrected;
use super::errors::{misfit, poses, rows};
use super::features::depends_on;
use super::forms::{between_forms, between_sets};
use super::found::Found as Effect;
use super::written::described;
use super::{NamedEffect, Nested, Rival, Suspected, Trace, Verdict};
use crate::campaign::{Campaign, Data};
use crate::effects::{Form, Number, Offers, Scene, Side, What};
use crate::fit::case::Case;
use crate::fit::estimate::estimates;
use crate::fit::noise::{self, NoiseSource};
use crate::identify::Error;
use crate::judge::gates::{Judgement, Weighed};
use crate::judge::thresholds::{FAR_OFF, MATTERS, SUSPECTED};
use crate::judge::verdict::{Evidence, OverNoise, verdict};
use crate::model::Term;
use crate::regression::Fit;
use crate::regression::noise::OUTLYING;
use crate::select::always::Own;
use crate::select::classes::ODDS;
use crate::select::engine::Engine;
use crate::select::folds;
use crate::select::passes::Found;
use crate::select::unseen::Unseen;
use crate::select::{Layout, Problem, Set};

/// A tracing in full.
///
/// # Errors
/// Numbers that no description takes beside its own effects.
pub fn report(
    campaign: &Campaign,
    (case, engine): (&Case<'_>, &Engine<'_>),
    (found, alone): (&Found, &DVector<f64>),
    nested: &folds::Nested,
    judgement: &Judgement,
) -> Result<Trace, Error> {
    let readings = case.observation.readings();
    let own = engine.declared();
    let problem = engine.problem_of(found);
    let effect = |of: &Weighed| effect(engine, &problem, found, of);
    let (named, rest): (Vec<&Weighed>, Vec<&Weighed>) = judgement.classes.iter().partition(|of| of.why_not.is_none());
    let side = |of: &&Weighed| found.layout.candidates[of.class.members[0].0].kind.side;
    let (unnamed, rest): (Vec<&Weighed>, Vec<&Weighed>) = rest.into_iter().partition(|of| side(of) == Side::Unnamed);
    let suspected: Vec<Suspected> = rest
        .iter()
        .chain(&unnamed)
        .filter(|of| of.class.probability > SUSPECTED)
        .map(|of| suspected(found, effect(of), of))
        .collect();
    let looks_like: Vec<String> = unnamed.iter().filter(|of| of.least > 0.5).map(|of| effect(of).words()).collect();
    let unseen = Unseen::new(engine, &found.layout, &found.columns);
    let model = corrected(case, engine, (found, &unseen), nested)
        .ok_or_else(|| Error::NotShown("no description fits these data".into()))?;
    let before = engine.alone(&found.layout);
    let estimates_before = estimates(&campaign.robot, &own, before.as_ref().map(|solved| (&found.layout, solved)));
    let mut estimates = estimates(&campaign.robot, &own, Some((&found.layout, &model.solved)));
    if !problem.learns() {
        // Where scales are learned, how sets differ is small against what the priors leave.
        for (estimate, between) in estimates.iter_mut().zip(between_sets(&problem, found)) {
            estimate.std = estimate.std.map(|std| (std * std + between).sqrt());
        }
    }
    let by_order = order_of(engine, (found, &unseen), &named, nested);
    let mut effects: Vec<NamedEffect> = by_order
        .iter()
        .map(|(of, rms)| NamedEffect {
            effect: effect(of),
            lines: Vec::new(),
            probability: of.class.probability,
            class: class(found, of),
            recurs: of.recurs,
            holdout_rms: *rms,
            partial: false,
        })
        .collect();
    let known = noise::known(campaign, case, &found.own.left);
    let size = found.own.fit.variance.sqrt();
    let plain = engine.noise_at(found);
    let over_noise = known.map(|known| OverNoise { ratio: plain / known.size, by_chance: known.by_chance() });
    // What does not matter is within the noise that is left.
    let names = rest.iter().filter(|of| of.class.probability > SUSPECTED && of.matters >= MATTERS);
    let names: Vec<String> = names.map(|of| effect(of).to_string()).collect();
    let outliers = beside::outliers(engine, (found, &unseen), case);
    let reflector = beside::reflector(found, &unseen);
    let many = effects.len() + usize::from(reflector.is_some());
    let outlying = outliers.as_ref().map_or(0.0, |of| of.lines.len() as f64 / case.rows(true).len() as f64);
    let (verdict, why) = verdict(&Evidence {
        named: many,
        outlying,
        suspected: &names,
        looks_like: &looks_like,
        far_off: &far_off(engine, case, (&found.own.left, plain)),
        discrepancy: judgement.discrepancy,
        over_noise,
    });
    effects.extend(reflector.into_iter().chain(outliers));
    effects.iter_mut().for_each(|named| named.partial = verdict == Verdict::Partial);
    let robots = |form: &&usize| found.layout.candidates[found.layout.forms[**form].candidate].kind.side == Side::Robot;
    let written: Vec<Effect> =
        model.set.iter().filter(robots).map(|&form| of_form(engine, &found.layout, &model.solved.fit, form)).collect();
    let table = table(case, &found.layout, &model.solved.point.values);
    let description = described(campaign, (&own, &estimates), &table, &written)?;
    let left_declared = declared(campaign, case);
    let misfits = |left: &DVector<f64>, unseen: &DVector<f64>| misfit(case, left, unseen);
    let (noise, noise_source) = known.map_or((size, NoiseSource::Residuals), |known| (known.size, known.source));
    let fitted = case.rows(true);
    let held_out = case.training.contains(&false);
    let left_rms = readings.rms(&found.own.left, fitted.iter().copied());
    Ok(Trace {
        robot: campaign.robot.name.clone(),
        rows: readings.rows(),
        poses: case.groups.len(),
        held_out: case.held_out(),
        noise,
        noise_source,
        encoders: case
            .encoders
            .iter()
            .enumerate()
            .map(|(k, &joint)| (joint, size / engine.noise.scales[2 + k]))
            .collect(),
        motors: matches!(&campaign.data, Data::Displacement(data) if data.rows.iter().all(|row| row.motors.is_some())),
        declared: misfits(&left_declared, &left_declared),
        identified: misfits(alone, &nested.alone),
        after: misfits(&found.own.left, &nested.left),
        written: model.error,
        unexplained: match known {
            Some(known) if plain > known.size => 1.0 - (known.size / plain).powi(2),
            _ if judgement.discrepancy > 0.5 && plain > size => 1.0 - (size / plain).powi(2),
            _ => 0.0,
        },
        depends_on: if matches!(verdict, Verdict::Partial | Verdict::Unexplained) {
            depends_on(case, &found.own.left)
        } else {
            Vec::new()
        },
        effects,
        suspected,
        verdict,
        why,
        looks_like,
        rivals: rivals(found),
        sets: sets(found),
        invisible: invisible(engine, found),
        next: Vec::new(),
        nested: Nested {
            folds: if held_out { 0 } else { nested.folds },
            rms: readings.rms(&nested.left, fitted.iter().copied()),
            identified_rms: readings.rms(&nested.alone, fitted.iter().copied()),
            names: nested.names(),
        },
        description,
        estimates_before,
        estimates,
        residuals: rows(case, alone, &found.own.left),
        components: readings.reported,
        differences: readings.differences,
        pose_errors: poses(case, alone, &found.own.left),
        basis: Some(Basis::of(engine, found)),
    })
    .map(|trace| checked(trace, left_rms))
}

/// A trace whose numbers are finite.
fn checked(trace: Trace, left: f64) -> Trace {
    debug_assert!(left.is_finite());
    trace
}

/// That a campaign cannot tell.
///
/// # Errors
/// None of its own.
pub fn insufficient(campaign: &Campaign, case: &Case<'_>, engine: &Engine<'_>, why: String) -> Result<Trace, Error> {
    let readings = case.observation.readings();
    let left = declared(campaign, case);
    let declared = misfit(case, &left, &left);
    let estimates = estimates(&campaign.robot, &engine.declared(), None);
    let noise = case.noise.unwrap_or(declared.rms);
    Ok(Trace {
        robot: campaign.robot.name.clone(),
        rows: readings.rows(),
        poses: case.groups.len(),
        held_out: Vec::new(),
        noise,
        noise_source: if case.noise.is_some() { NoiseSource::Declared } else { NoiseSource::Residuals },
        encoders: Vec::new(),
        motors: false,
        declared,
        identified: declared,
        after: declared,
        written: declared,
        effects: Vec::new(),
        suspected: Vec::new(),
        verdict: Verdict::Insufficient,
        why,
        unexplained: 0.0,
        depends_on: Vec::new(),
        looks_like: Vec::new(),
        rivals: Vec::new(),
        sets: Vec::new(),
        invisible: Vec::new(),
        next: Vec::new(),
        nested: Nested::default(),
        description: campaign.robot.clone(),
        estimates_before: estimates.clone(),
        estimates,
        residuals: rows(case, &left, &left),
        components: readings.reported,
        differences: readings.differences,
        pose_errors: poses(case, &left, &left),
        basis: None,
    })
}

/// What the description as declared leaves of each row.
fn declared(campaign: &Campaign, case: &Case<'_>) -> DVector<f64> {
    let engine = case.engine(&campaign.robot);
    let layout = engine.layout_alone();
    let own = engine.declared();
    let values = own.iter().enumerate().map(|(k, own)| (layout.keys[layout.fixed + k].clone(), own.parameter.mean));
    let values = layout.values(&values.collect());
    let predicted = case.observation.predict(case.observation.world(), &layout.parameters, &values);
    &case.observation.readings().values - predicted
}

/// The lines of rows that are far off, where the error of all of them is far above the noise of most. Those that do not
/// belong to the others are reported by themselves.
fn far_off(engine: &Engine<'_>, case: &Case<'_>, (left, noise): (&DVector<f64>, f64)) -> Vec<usize> {
    let readings = case.observation.readings();
    let apart = engine.noise.apart.rows();
    let rows: Vec<usize> = case.rows(true).into_iter().filter(|row| !apart.contains(row)).collect();
    if readings.rms(left, rows.iter().copied()) <= FAR_OFF * noise {
        return Vec::new();
    }
    rows.into_iter().filter(|&row| engine.noise.weights[row] < OUTLYING).map(|row| readings.lines[row]).collect()
}

/// An effect of the best set with its numbers.
fn effect(engine: &Engine<'_>, problem: &Problem<'_>, found: &Found, of: &Weighed) -> Effect {
    let (layout, fit) = (&found.layout, &found.own.fit);
    let mut effect = of_form(engine, layout, fit, of.class.form);
    let own = &layout.forms[of.class.form];
    let by = in_shares(engine, layout, fit, &layout.candidates[own.candidate].forms[own.form]);
    let between = between_forms(problem, found, of.class.form);
    for (number, between) in effect.parameters.iter_mut().zip(between) {
        number.std = number.std.map(|std| (std * std + by * by * between).sqrt());
    }
    effect
}

/// An effect in one of its forms with its numbers in a fit.
fn of_form(engine: &Engine<'_>, layout: &Layout, fit: &Fit, form: usize) -> Effect {
    let columns = &layout.forms[form];
    let candidate = &layout.candidates[columns.candidate];
    let form = &candidate.forms[columns.form];
    let by = in_shares(engine, layout, fit, form);
    let number = |&k: &usize| {
        let parameter = &layout.parameters[k];
        let std = fit.place(k).map(|at| by * fit.std[at]);
        Number { name: parameter.name, value: by * fit.value(k), std, unit: parameter.unit }
    };
    let values: Vec<f64> = columns.columns.iter().map(|&k| by * fit.value(k)).collect();
    let is_there = values.iter().any(|value| *value != 0.0);
    let written = form.written.as_ref().filter(|_| is_there).map_or_else(Vec::new, |written| written(&values));
    let numbers = columns.columns.iter().map(number).chain(form.shape.iter().cloned()).collect();
    Effect::new(candidate.kind, candidate.place, numbers, written)
}

/// What turns shares of what is likely of a joint into shares of what was fitted.
fn in_shares(engine: &Engine<'_>, layout: &Layout, fit: &Fit, form: &Form) -> f64 {
    let Some(joint) = form.share_of else { return 1.0 };
    let own = engine.declared().iter().position(|own| own.what == Own::Joint(joint));
    let now = own.map_or(0.0, |k| fit.value(layout.fixed + k));
    if now > 0.0 { engine.scene.compliance[joint - 1] / now } else { 1.0 }
}

fn class(found: &Found, of: &Weighed) -> Vec<(String, f64)> {
    let of_form = &found.layout.forms[of.class.form];
    let same = &found.layout.candidates[of_form.candidate].forms[of_form.form].same;
    let own = of.class.members[0].1;
    let members = of.class.members.iter().map(|(member, p)| (found.layout.candidates[*member].name(), *p));
    let mut all: Vec<(String, f64)> = members.collect();
    let twins = same.iter().filter(|name| all.iter().all(|(other, _)| other != *name));
    let twins: Vec<(String, f64)> = twins.map(|name| ((*name).to_owned(), own)).collect();
    all.splice(1..1, twins);
    all
}

fn suspected(found: &Found, effect: Effect, of: &Weighed) -> Suspected {
    Suspected {
        effect,
        probability: of.class.probability,
        class: class(found, of),
        recurs: of.recurs,
        why_not: of.why_not.clone().unwrap_or_default(),
    }
}

/// Named effects, the one that matters most first, each with the error on unseen poses that it and
/// those before it leave.
fn order_of<'w>(
    engine: &Engine<'_>,
    (found, unseen): (&Found, &Unseen<'_>),
    named: &[&'w Weighed],
    nested: &folds::Nested,
) -> Vec<(&'w Weighed, f64)> {
    let mut ordered: Vec<&Weighed> = named.to_vec();
    ordered.sort_by(|a, b| b.matters.total_cmp(&a.matters));
    let mut so_far = Set::new();
    let unseen = |set: &Set| unseen.rms(set, found.kappa);
    let readings = engine.observation.readings();
    let rows = (0..readings.rows()).filter(|&row| engine.training[readings.block[row]]);
    let last = readings.rms(&nested.left, rows);
    let whole = unseen(&found.best).filter(|whole| *whole > 0.0);
    ordered
        .into_iter()
        .map(|of| {
            so_far = crate::select::search::with(&so_far, of.class.form);
            // Relative to the best set's, whose choice is in the nested error.
            let rms = match (unseen(&so_far), whole) {
                (Some(rms), Some(whole)) => last * rms / whole,
                _ => last,
            };
            (of, rms)
        })
        .collect()
}

/// What the table's numbers change by, a row each; none but of absolute positions.
fn table(case: &Case<'_>, layout: &Layout, values: &std::collections::BTreeMap<String, f64>) -> Vec<[f64; 5]> {
    let mut table = vec![[0.0; 5]; case.scene.kinds.len()];
    if case.scene.what == What::Positions {
        for k in layout.always() {
            if let Term::Table(joint, number) = layout.parameters[k].term {
                table[joint - 1][number] = values.get(&layout.keys[k]).copied().unwrap_or(0.0);
            }
        }
    }
    table
}

/// Other sets of candidates that are nearly as probable.
fn rivals(found: &Found) -> Vec<Rival> {
    let names = |set: &Set| -> Vec<String> { set.iter().map(|&form| found.layout.names(form).0).collect() };
    let best = names(&found.best);
    let mut rivals: Vec<Rival> = Vec::new();
    let Some(top) = found.visited.sets.get(&found.best).map(|judged| judged.score) else { return rivals };
    for (set, judged) in found.visited.ranked() {
        let behind = top - judged.score;
        if behind > ODDS.ln() {
            break;
        }
        let names = names(set);
        if names != best && rivals.iter().all(|rival| rival.names != names) {
            rivals.push(Rival { names, bic_difference: 2.0 * behind.max(0.0) });
        }
    }
    rivals
}

/// The most probable sets.
fn sets(found: &Found) -> Vec<(Vec<String>, f64)> {
    const TOLD: usize = 12;
    let name = |form: &usize| {
        let (name, label) = found.layout.names(*form);
        if label.is_empty() { name } else { format!("{name} ({label})") }
    };
    found.visited.posterior().into_iter().take(TOLD).map(|(set, p)| (set.iter().map(name).collect(), p)).collect()
}

/// Full names of candidates that these readings could not show.
fn invisible(engine: &Engine<'_>, found: &Found) -> Vec<String> {
    let problem = engine.problem_of(found);
    let shown: Vec<usize> = problem.offered.iter().map(|&form| found.layout.forms[form].candidate).collect();
    let all = found.layout.candidates.iter().enumerate();
    let hidden = all.filter(|(k, of)| !shown.contains(k) && of.kind.side != Side::Unnamed);
    let mut names: Vec<String> = hidden.map(|(_, of)| of.name()).collect();
    if engine.scene.what == What::Clamped {
        // What loads at the tool would show.
        let pulled = Scene { what: What::Displacements, force: 1.0, ..engine.scene.clone() };
        let offered: Vec<String> = found.layout.candidates.iter().map(|of| of.name()).collect();
        let others = Offers::of(&pulled).into_iter().filter(|of| of.kind.side != Side::Unnamed);
        names.extend(others.map(|of| of.name()).filter(|name| !offered.contains(name)));
    }
    names
}
