//! The model that is written.
//!
//! What predicts and what is named are told apart. A description carries every effect of the best set that
//! it has a word for, named or not; what the rig is off by is corrected for. What no description takes is
//! not in the fit, so that the numbers written are those that predict without it.

use super::errors::Misfit;
use crate::effects::{Side, What};
use crate::fit::case::Case;
use crate::judge::thresholds::LOSS;
use crate::model::Term;
use crate::select::engine::{Engine, Fitted};
use crate::select::folds::Nested;
use crate::select::passes::Found;
use crate::select::search::with;
use crate::select::solve::Solved;
use crate::select::unseen::Unseen;
use crate::select::{Layout, Set};

/// The model that is written.
pub struct Corrected {
    /// The forms in it, those that correct the rig among them.
    pub set: Set,
    /// Its fit.
    pub solved: Solved,
    /// Its error, the rig corrected for.
    pub error: Misfit,
}

/// The best set as a description takes it; the description's own numbers alone where unseen poses are
/// predicted better by them. None where there is no fit.
pub fn corrected(
    case: &Case<'_>,
    engine: &Engine<'_>,
    (found, unseen): (&Found, &Unseen<'_>),
    nested: &Nested,
) -> Option<Corrected> {
    let readings = case.observation.readings();
    let fitted = || case.rows(true);
    let alone = readings.rms(&nested.alone, fitted());
    let set = writable(engine, found);
    let part = |as_filed| of_set(case, &engine.fitting(as_filed), (found, unseen, nested), &set);
    let mut whole = part(Fitted::Written);
    if case.scene.what == What::Positions
        && let Some(as_filed) = part(Fitted::AsFiled)
        && whole.as_ref().is_none_or(|of| as_filed.error.holdout_rms < (1.0 + LOSS) * of.error.holdout_rms)
    {
        whole = Some(as_filed);
    }
    let chosen = whole.filter(|of| of.error.holdout_rms <= alone).or_else(|| {
        let solved = engine.alone(&found.layout)?;
        let error = Misfit { rms: readings.rms(&solved.left, fitted()), holdout_rms: alone };
        Some(Corrected { set: Set::new(), solved, error })
    })?;
    let held_out = case.rows(false);
    let holdout_rms = match held_out.is_empty() {
        true => chosen.error.holdout_rms,
        false => readings.rms(&chosen.solved.left, held_out),
    };
    Some(Corrected { error: Misfit { holdout_rms, ..chosen.error }, ..chosen })
}

/// A set at its optimum with the error that it leaves on unseen poses: that of the whole search, by as
/// much more as it leaves than the best set.
fn of_set(
    case: &Case<'_>,
    engine: &Engine<'_>,
    (found, unseen, nested): (&Found, &Unseen<'_>, &Nested),
    set: &Set,
) -> Option<Corrected> {
    let readings = case.observation.readings();
    let layout = &found.layout;
    let best = unseen.rms(&found.best, found.kappa)?;
    let is_best = *set == found.best && case.scene.what != What::Positions;
    let solved = match is_best {
        true => found.own.clone(),
        false => engine.solve_bounded(layout, set, (&found.own.point, found.kappa), STEPS)?,
    };
    let unseen = match case.scene.what {
        What::Positions => {
            let columns = engine.linearise(layout, &solved.point);
            Unseen::new(engine, layout, &columns).rms(set, solved.kappa)?
        }
        _ => unseen.rms(set, solved.kappa)?,
    };
    let rows = || case.rows(true);
    let last = readings.rms(&nested.left, rows());
    let holdout_rms = if best > 0.0 { last * unseen / best } else { last };
    let error = Misfit { rms: readings.rms(&solved.left, rows()), holdout_rms };
    Some(Corrected { set: set.clone(), solved, error })
}

/// Steps to the optimum of what is written.
const STEPS: usize = 8;

/// The best set without what no description takes. An effect whose form has no word is there in one that
/// has, where that makes it better.
fn writable(engine: &Engine<'_>, found: &Found) -> Set {
    let layout = &found.layout;
    let problem = engine.problem_of(found);
    let (kept, rest): (Set, Set) = found.best.iter().partition(|form| is_kept(layout, **form));
    rest.into_iter().filter(|&form| side(layout, form) == Side::Robot).fold(kept, |set, form| {
        let score = |set: &Set| problem.judge(set).map_or(f64::NEG_INFINITY, |judged| judged.score);
        let others = problem.other_forms(form).filter(|&other| is_kept(layout, other));
        let others = others.map(|other| with(&set, other)).map(|set| (score(&set), set));
        let best = others.max_by(|a, b| a.0.total_cmp(&b.0));
        best.filter(|(of, _)| *of > score(&set)).map_or(set, |(_, with)| with)
    })
}

fn side(layout: &Layout, form: usize) -> Side {
    layout.candidates[layout.forms[form].candidate].kind.side
}

/// Whether a form is in what is written: a description has a word for it, or it is corrected for.
fn is_kept(layout: &Layout, form: usize) -> bool {
    let of = &layout.forms[form];
    match side(layout, form) {
        Side::Rig => true,
        Side::Robot => layout.candidates[of.candidate].forms[of.form].written.is_some(),
        // What is read is off, not the arm.
        Side::Unnamed => {
            let is_of_reading = |&k: &usize| matches!(layout.parameters[k].term, Term::Reading(_) | Term::Gain(_));
            of.columns.iter().all(is_of_reading)
        }
    }
}
