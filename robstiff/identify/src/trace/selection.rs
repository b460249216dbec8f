//! Which effects to name: a search by an information criterion, admitted by
//! tests.
//!
//! The search proposes (the best models of each size, by BIC, from a beam of
//! extensions and then by replacing each effect with each other candidate);
//! the tests dispose: a model is accepted when *every* effect in it is missed
//! by the model without it, family-wise over the whole catalogue, and when
//! poses left out of the fit, each in turn, are predicted better than by the
//! smaller model. An effect that was named early and is no longer needed falls
//! out this way, so steps go forward, sideways and back; what stands is tested
//! again with the rows and the noise that it stands on, and where something is
//! missing without what that drops, the search goes on from there, once. Poses
//! held out take no part: they judge what was found.

use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use super::bench::Bench;
use super::bootstrap::{Alternatives, Reference, ScoreTest};
use super::model::{Fitted, Named, Setting, all_but};
use super::settle::{Settled, settled, told};
use super::step::{Step, Tested};
use super::{Options, Progress};

/// How many models of one size are kept: a single missing effect is found by
/// the best alone, for two or three the right set can start from any of the
/// first few.
const BEAM: usize = 12;

/// Rivals within this of the best in BIC are not told from it: odds below
/// twenty to one (`exp(6 / 2)`), "positive" evidence at most (Kass and Raftery,
/// JASA 90, 1995).
pub const WITHIN_REACH: f64 = 6.0;

/// A catalogue of a few dozen explains anything with enough names; what takes
/// more than this many at once is not in it.
const MOST_EFFECTS: usize = 6;

/// What the search found.
pub struct Selection {
    /// The model.
    pub model: Fitted,
    /// The family-wise p-value of each of its effects.
    pub p_values: Vec<f64>,
    /// What was tested on the way.
    pub steps: Vec<Step>,
    /// Whether something is missing for which no effect passed every test.
    pub unnamed: bool,
}

impl Selection {
    /// The same, with the steps that came before.
    #[must_use]
    pub fn after(mut self, before: Self) -> Self {
        self.steps.splice(..0, before.steps);
        self
    }
}

/// A test of the whole catalogue against one model.
pub struct Tests {
    /// The statistic of each candidate and the variant that has it.
    pub statistics: Vec<Option<(f64, usize)>>,
    /// The distribution of the largest.
    pub reference: Reference,
}

impl Tests {
    /// The tests against the model of some effects; `None` where it cannot be
    /// fitted.
    pub fn against(setting: &Setting<'_>, named: &[Named], options: &Options) -> Option<Self> {
        let columns = setting.with_besides(setting.columns(named));
        let alternatives = Alternatives {
            total: &setting.problem.total,
            white: &|column| setting.white(column),
            candidates: &setting.candidates,
            signs: &setting.signs,
            first: setting.own.len(),
        };
        let scores = ScoreTest::new(&setting.on(&columns), &columns, &alternatives)?;
        let (statistics, reference) = (scores.statistics(), scores.reference(options.draws, options.seed));
        Some(Self { statistics, reference })
    }

    /// The family-wise p-value of a candidate.
    pub fn p_value(&self, candidate: usize) -> f64 {
        self.statistics[candidate].map_or(1.0, |(statistic, _)| self.reference.p_value(statistic))
    }

    /// The family-wise p-value of the largest statistic.
    pub fn smallest_p(&self) -> f64 {
        (0..self.statistics.len()).map(|candidate| self.p_value(candidate)).fold(1.0, f64::min)
    }
}

/// The effects the data ask for, beginning with those of a model.
///
/// # Errors
/// Why not even the description's own model can be fitted.
pub fn select(
    bench: &mut Bench<'_>,
    mut model: Fitted,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<Selection, String> {
    let mut steps = Vec::new();
    let mut resumed = false;
    loop {
        let unnamed = grow(bench, &mut model, &mut steps, options, progress)?;
        let settled = settled(bench, model, options);
        let told = told(bench, &settled.model, &settled.dropped, options);
        let missing = told.is_some_and(|(step, missing)| {
            steps.push(step);
            missing
        });
        // Once, for the same may be named and dropped time and again.
        if resumed || !missing {
            let Settled { model, p_values, .. } = settled;
            return Ok(Selection { model, p_values, steps, unnamed: unnamed || missing });
        }
        (model, resumed) = (settled.model, true);
    }
}

/// Adds effects to a model for as long as one passes every test; whether something is missing
/// for which none does. The order counts: each effect is sought on the rows and with the weights
/// that go with those before it, and is in its own form before the next one is sought.
pub fn grow(
    bench: &mut Bench<'_>,
    model: &mut Fitted,
    steps: &mut Vec<Step>,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<bool, String> {
    let mut beam = std::vec![model.clone()];
    let mut unnamed = false;
    loop {
        progress(&std::format!("searching for effect {}", model.named.len() + 1));
        // Without rows that look wild physics may not allow what was accepted.
        if let Some(better) = bench.tried(&model.named, Bench::look_again) {
            *model = better;
        }
        let mut setting = bench.at(&model.named)?;
        if let Some(better) = sideways(bench, &setting, model, options) {
            *model = better;
            setting = bench.at(&model.named)?;
        }
        let Some(tests) = bench.tests(&model.named, options) else { break };
        let mut step = table(&setting, model, &tests, options);
        if tests.smallest_p() > options.alpha {
            step.nothing_is_missing();
            steps.push(step);
            break;
        }
        if model.named.len() >= MOST_EFFECTS {
            unnamed = true;
            step.too_many(MOST_EFFECTS);
            steps.push(step);
            break;
        }
        beam = improve(&setting, extend(&setting, &beam));
        let mut accepted = propose(bench, &setting, &beam, model, &tests, options);
        if accepted.is_none() {
            // What is missing besides can keep either of two from passing alone.
            beam = improve(&setting, extend(&setting, &beam));
            accepted = propose(bench, &setting, &beam, model, &tests, options);
        }
        let Some(proposed) = accepted else {
            unnamed = true;
            step.none_passes();
            steps.push(step);
            break;
        };
        step.came_to(&bench.names(&proposed.named));
        steps.push(step);
        *model = proposed;
        // What a grid's value leaves of an effect must not look like another, nor what weights
        // do that are of the noise without it.
        polish(bench, model);
        if let Some(better) = bench.tried(&model.named, Bench::learn_noise) {
            *model = better;
        }
    }
    if bench.may_be_simpler(&model.named) {
        // The noise is better known than when they were named.
        polish(bench, model);
    }
    Ok(unnamed)
}

/// Takes the numbers of a model out of their grids, and its forms in the simplest that will do;
/// where it cannot be fitted so, it stays as it is.
fn polish(bench: &mut Bench<'_>, model: &mut Fitted) {
    let (polished, named) = bench.polished(&model.named).simplified(&model.named);
    if let Ok(better) = polished.fit(&named) {
        (*bench, *model) = (polished, better);
    }
}

/// The first of the best models of a beam that passes.
fn propose(
    bench: &Bench<'_>,
    setting: &Setting<'_>,
    beam: &[Fitted],
    model: &Fitted,
    tests: &Tests,
    options: &Options,
) -> Option<Fitted> {
    let proposals = nonlinear(bench, setting, beam);
    proposals
        .iter()
        .take_while(|proposed| proposed.bic < proposals[0].bic + WITHIN_REACH)
        .take(PROPOSALS)
        .find(|proposed| passes(bench, model, proposed, tests, options))
        .cloned()
}

/// The model of as many effects that is better, one of them replaced or in
/// another form, where there is one that passes.
fn sideways(bench: &Bench<'_>, setting: &Setting<'_>, model: &Fitted, options: &Options) -> Option<Fitted> {
    if model.named.is_empty() {
        return None;
    }
    let beam = improve(setting, std::vec![model.clone()]);
    let proposals = nonlinear(bench, setting, &beam);
    let best = proposals.into_iter().find(|proposed| proposed.bic < model.bic - BETTER)?;
    p_values(bench, &best.named, options).iter().all(|&p| p <= options.alpha).then_some(best)
}

/// A criterion that is lower by this is worth another look: odds of e to one.
pub const BETTER: f64 = 2.0;

/// The best proposals of a linear search that physics allows, with nonlinear
/// numbers in their own form, the best first.
fn nonlinear(bench: &Bench<'_>, setting: &Setting<'_>, beam: &[Fitted]) -> Vec<Fitted> {
    let best = beam.iter().find(|model| model.physical);
    // Curvature can change a criterion by this much before it changes the order.
    let near = |model: &&Fitted| best.is_none_or(|best| model.bic < best.bic + CURVATURE);
    let physical = beam.iter().filter(|model| model.physical).filter(near).take(REFITTED);
    // A joint that takes up what is missing spoils the slope there of what is, and its
    // criterion: a lever's, of one that hardly turned without it. In its own form, with the
    // joint as it then is, physics may allow it.
    let otherwise = beam.iter().filter(|model| !model.physical && bench.is_nonlinear(&model.named)).take(PROPOSALS);
    best_of(physical.chain(otherwise).filter_map(|model| bench.refit(setting, model).ok()).collect())
}

/// How many proposals are refitted in their own form.
pub const REFITTED: usize = 6;

/// How far behind the best by the linear criterion a proposal may be to be
/// refitted.
pub const CURVATURE: f64 = 60.0;

/// How many of the best proposals are put to the tests in one step.
const PROPOSALS: usize = 3;

/// Whether poses left out are predicted better by a proposal than by the smaller model,
/// and each of its effects is significant.
fn passes(bench: &Bench<'_>, smaller: &Fitted, proposed: &Fitted, against_smaller: &Tests, options: &Options) -> bool {
    let left_out = |model: &Fitted| Some(bench.at(&model.named).ok()?.left_out(&model.fit).deviance);
    let predicts_better = matches!((left_out(proposed), left_out(smaller)), (Some(new), Some(old)) if new < old);
    let p_value = |k: usize| {
        let (one, rest) = (proposed.named[k], all_but(&proposed.named, k));
        if rest == smaller.named {
            return against_smaller.p_value(one.candidate);
        }
        bench.tests(&rest, options).map_or(1.0, |tests| tests.p_value(one.candidate))
    };
    predicts_better && (0..proposed.named.len()).all(|k| p_value(k) <= options.alpha)
}

/// The family-wise p-value of each effect, that of the model without it.
pub fn p_values(bench: &Bench<'_>, named: &[Named], options: &Options) -> Vec<f64> {
    let one = |k: usize| {
        let (one, rest) = (named[k], all_but(named, k));
        let tests = match bench.by_own_form {
            true => bench.at(named).ok().and_then(|setting| Tests::against(&setting, &rest, options)).map(Rc::new),
            false => bench.tests(&rest, options),
        };
        tests.map_or(1.0, |tests| tests.p_value(one.candidate))
    };
    (0..named.len()).map(one).collect()
}

/// Every model with one effect more than one of `beam`, the best first.
fn extend(setting: &Setting<'_>, beam: &[Fitted]) -> Vec<Fitted> {
    let mut found = Vec::new();
    for model in beam {
        for candidate in 0..setting.candidates.len() {
            found.extend(best_loosely(setting, &model.named, candidate));
        }
    }
    best_of(found)
}

/// The best physical model of some effects and one candidate more.
pub fn best_with(setting: &Setting<'_>, named: &[Named], candidate: usize) -> Option<Fitted> {
    best_loosely(setting, named, candidate).filter(|model| model.physical)
}

/// The best model of some effects and one candidate more; where physics allows
/// none, the best all the same.
fn best_loosely(setting: &Setting<'_>, named: &[Named], candidate: usize) -> Option<Fitted> {
    if named.iter().any(|one| one.candidate == candidate) {
        return None;
    }
    let variants = 0..setting.candidates[candidate].variants.len();
    let fits = variants.filter_map(|variant| {
        let mut named = named.to_vec();
        named.push(Named { candidate, variant });
        // One order for one set, so that it is the same model however reached.
        named.sort_unstable();
        setting.fit_loosely(&named)
    });
    fits.min_by(|a, b| b.physical.cmp(&a.physical).then(a.bic.total_cmp(&b.bic)))
}

/// Replaces each effect of the best model with each candidate as long as that
/// improves it.
fn improve(setting: &Setting<'_>, mut beam: Vec<Fitted>) -> Vec<Fitted> {
    loop {
        let best = bests(&beam);
        if best.is_empty() {
            return beam;
        }
        for model in &best {
            for k in 0..model.named.len() {
                let rest = all_but(&model.named, k);
                let swapped =
                    (0..setting.candidates.len()).filter_map(|candidate| best_loosely(setting, &rest, candidate));
                beam.extend(swapped);
            }
        }
        beam = best_of(beam);
        let better = |(new, old): (&Fitted, &Fitted)| new.bic < old.bic - TIE;
        if !bests(&beam).iter().zip(&best).any(better) {
            return beam;
        }
    }
}

/// The best model that physics allows, and the best of all where that is
/// another.
fn bests(beam: &[Fitted]) -> Vec<Fitted> {
    let physical = beam.iter().find(|model| model.physical);
    let any = beam.first().filter(|model| !model.physical);
    physical.into_iter().chain(any).cloned().collect()
}

/// Criteria closer than this are equal but for rounding.
const TIE: f64 = 1e-3;

/// The best of each set of candidates, the best set first; among equals the
/// one that comes first in the catalogue. Those that physics does not allow are
/// not counted against the others.
fn best_of(mut models: Vec<Fitted>) -> Vec<Fitted> {
    let set = |model: &Fitted| -> Vec<usize> { model.named.iter().map(|one| one.candidate).collect() };
    models.sort_by_cached_key(|model| ((model.bic / TIE).round() as i64, model.named.clone()));
    let mut kept: Vec<Fitted> = Vec::new();
    for model in models {
        let alike = kept.iter().filter(|other| other.physical == model.physical).count();
        if alike < BEAM && kept.iter().all(|other| set(other) != set(&model)) {
            kept.push(model);
        }
    }
    kept
}

/// All candidates against a model.
pub fn table(setting: &Setting<'_>, model: &Fitted, tests: &Tests, options: &Options) -> Step {
    let name = |one: &Named| setting.candidates[one.candidate].name();
    let before = setting.left_out(&model.fit).deviance;
    let candidates = (0..setting.candidates.len()).map(|candidate| {
        let statistic = tests.statistics[candidate].map(|(statistic, _)| statistic);
        let p_value = tests.p_value(candidate);
        let with = best_with(setting, &model.named, candidate);
        let left_out = with.as_ref().map(|with| setting.left_out(&with.fit));
        let reason = if model.named.iter().any(|one| one.candidate == candidate) {
            "already named"
        } else if statistic.is_none() || with.is_none() {
            "it explains nothing with numbers that are physically possible"
        } else if p_value > options.alpha {
            "not significant"
        } else if left_out.as_ref().is_some_and(|left| left.deviance >= before) {
            "poses left out are not predicted better"
        } else {
            "another explains more"
        };
        Tested {
            name: setting.candidates[candidate].name(),
            statistic,
            p_value,
            bic: with.map(|with| with.bic),
            left_out_rms: left_out.map(|left| left.rms),
            reason: String::from(reason),
        }
    });
    Step { named: model.named.iter().map(name).collect(), candidates: candidates.collect(), outcome: String::new() }
}
