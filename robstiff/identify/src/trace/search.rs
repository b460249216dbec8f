//! The search for what displacements show, from the joints alone to what is told of it.
//!
//! Effects are [selected](super::selection); where structure is left with them, the same is
//! tried [beyond the catalogue](super::beyond); where that accounts for nothing either, names
//! are taken back that [the verdict](super::verdict) does not hold to be worth it.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use super::alias::{Rival, bic_of_all, with_wild_rows};
use super::bench::Bench;
use super::beyond::{self, Beyond};
use super::isolated::Event;
use super::lack_of_fit::{self, AGREE, LackOfFit, StructureTest};
use super::model::{Fitted, Named};
use super::selection::{Selection, select};
use super::settle::{settled, told};
use super::step::Step;
use super::verdict::{self, Verdict};
use super::wander::displacements::instead_of_slips;
use super::yardstick::{self, Yardstick};
use super::{Options, Progress, held_out};
use crate::identify::prepare::Prepared;
use crate::words::micrometres;

/// What was found, before it is told.
pub struct Outcome {
    /// The model, and the way to it.
    pub selection: Selection,
    /// What it leaves; `None` where nothing was looked for.
    pub left: Option<LackOfFit>,
    /// What is wrong in single visits.
    pub events: Vec<Event>,
    /// What is left looks like these, each as a noun for a sentence.
    pub looks_like: Vec<String>,
    /// Whether these are what the files may have been written with.
    pub misread: bool,
    /// Another model that is about as good, come to by another way.
    pub rival: Option<Rival>,
    /// The conclusion.
    pub verdict: Verdict,
    /// Why.
    pub why: String,
}

impl Outcome {
    /// A model that nothing was looked for beyond.
    pub fn nothing(model: Fitted, verdict: Verdict, why: String) -> Self {
        let selection = Selection { model, p_values: Vec::new(), steps: Vec::new(), unnamed: false };
        let (events, looks_like) = (Vec::new(), Vec::new());
        Self { selection, left: None, events, looks_like, misread: false, rival: None, verdict, why }
    }

    /// The same, with the steps that came before.
    pub fn after(mut self, before: Self) -> Self {
        self.selection = self.selection.after(before.selection);
        self
    }

    /// Asks the poses held out, which had no part in the search, whether the model
    /// predicts them.
    ///
    /// # Errors
    /// Why the model cannot be fitted.
    pub fn judge_by_held_out(&mut self, bench: &Bench<'_>, options: &Options) -> Result<(), String> {
        let Some(left) = &mut self.left else { return Ok(()) };
        let setting = bench.at(&self.selection.model.named)?;
        let test = held_out::of_displacements(&setting, &self.selection.model, options);
        if let Some(judged) = test.and_then(|test| held_out::judged(test, self.verdict, left, options)) {
            (self.verdict, self.why) = judged;
        }
        Ok(())
    }

    /// The full names of the model's effects.
    pub fn names(&self, bench: &Bench<'_>) -> Vec<String> {
        bench.names(&self.selection.model.named)
    }

    /// The criterion of Schwarz, of all rows.
    pub fn bic_of_all(&self, bench: &Bench<'_>) -> Option<f64> {
        bic_of_all(bench, &self.selection.model, &self.events)
    }

    /// Whether structure is left.
    pub fn structure(&self) -> bool {
        self.left.as_ref().is_some_and(|left| left.structure) || self.selection.unnamed
    }
}

/// Searches for effects, and takes names back that leave too much or are there for want of
/// better.
///
/// # Errors
/// Why a model cannot be fitted that was before.
pub fn search<'c>(
    bench: &mut Bench<'c>,
    prepared: &Prepared<'c>,
    start: Fitted,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<Outcome, String> {
    let mut selection = select(bench, start, options, progress)?;
    progress("looking for structure in what is left");
    let test = |bench: &Bench<'c>, model: &Fitted| left_by(bench, prepared, model, options);
    let mut left = test(bench, &selection.model)?;
    let found = if left.structure || selection.unnamed {
        progress("looking for what has no name in the catalogue");
        beyond::search(bench, options, test)?
    } else if selection.model.named.is_empty() {
        None
    } else {
        beyond::instead(bench, &selection.model, options, test)?
    };
    let (mut taken_back, mut looks_like) = (Vec::new(), Vec::new());
    if let Some(beyond) = found {
        taken_back = names_lost(bench, &selection.model, &beyond);
        looks_like = beyond.nameless;
        selection = beyond.selection.after(selection);
        *bench = beyond.bench;
        left = test(bench, &selection.model)?;
        left.structure = true;
    }
    if let Some((without, words)) = instead_of_slips(bench, &selection.model) {
        looks_like.push(words.to_string());
        taken_back.extend(leave_to_what_has_no_name(bench, &mut selection, &without, words));
        left = test(bench, &selection.model)?;
        left.structure = true;
    }
    if looks_like.is_empty() {
        take_back(bench, &mut selection, &mut left, &mut taken_back, options, test)?;
    }
    let may_lag =
        !left.structure && verdict::may_lag(bench, &selection.model) && beyond::lag_is_near(bench, &selection.model);
    let beside_declared = !left.structure && verdict::lags_beside_declared(bench, &selection.model);
    left.structure |= may_lag || beside_declared;
    if left.structure
        && let Some((whole, model)) = with_wild_rows(bench, &selection.model)
    {
        (*bench, selection.model) = (whole, model);
    }
    let events = bench.events.to_vec();
    let besides = verdict::Besides {
        isolated: events.len(),
        taken_back: &taken_back,
        looks_like: &looks_like,
        may_lag,
        beside_declared,
    };
    let (verdict, mut why) = verdict::judge(&selection, &left, &besides);
    if left.structure
        && let Some(repeated) = yardstick::noisier_than_declared(prepared, bench)
    {
        why.push_str(&format!(
            "; repeated loads themselves differ by {} a reading, so the noise may be larger than declared",
            micrometres(repeated)
        ));
    }
    if may_share_unloaded(prepared, &left, options) {
        why.push_str("; rows that share an unloaded reading agree, too: a column `visit` says which do");
    }
    Ok(Outcome { selection, left: Some(left), events, looks_like, misread: false, rival: None, verdict, why })
}

/// Whether what readings of a pose agree on may be their unloaded reading: of each row the
/// file says that it has its own.
fn may_share_unloaded(prepared: &Prepared<'_>, left: &LackOfFit, options: &Options) -> bool {
    let data = prepared.data;
    let agree = |test: &StructureTest| test.name == AGREE && test.p_value <= options.alpha;
    left.structure && data.visits.len() == data.rows.len() && left.tests.iter().any(agree)
}

/// What a model leaves.
///
/// # Errors
/// Why the model cannot be fitted.
pub fn left_by(
    bench: &Bench<'_>,
    prepared: &Prepared<'_>,
    model: &Fitted,
    options: &Options,
) -> Result<LackOfFit, String> {
    let yardstick = Yardstick::of(prepared, bench);
    bench.spare_memory();
    let setting = bench.at(&model.named)?;
    Ok(lack_of_fit::test(&setting, model, prepared.data, yardstick, &bench.noise.covariance, options))
}

/// Leaves a model as it is without what something nameless is said better by; the names that are
/// lost.
fn leave_to_what_has_no_name(
    bench: &Bench<'_>,
    selection: &mut Selection,
    without: &Fitted,
    nameless: &str,
) -> Vec<String> {
    let stays = |one: &Named| without.named.contains(one);
    let with_p = selection.model.named.iter().zip(&selection.p_values);
    let p_values = with_p.filter(|(one, _)| stays(one)).map(|(_, p)| *p).collect();
    let lost: Vec<Named> = selection.model.named.iter().copied().filter(|one| !stays(one)).collect();
    selection.steps.push(Step::beside_nameless(bench.names(&without.named), &[nameless]));
    (selection.model, selection.p_values) = (without.clone(), p_values);
    bench.names(&lost)
}

/// Full names of a model that are not among those beside something nameless.
fn names_lost(bench: &Bench<'_>, model: &Fitted, beyond: &Beyond<'_>) -> Vec<String> {
    let kept = beyond.bench.names(&beyond.selection.model.named);
    let mut lost = bench.names(&model.named);
    lost.retain(|name| !kept.contains(name));
    lost
}

/// Takes names back for what they leave, until what is left speaks against none.
fn take_back<'c>(
    bench: &mut Bench<'c>,
    selection: &mut Selection,
    left: &mut LackOfFit,
    taken_back: &mut Vec<String>,
    options: &Options,
    test: impl Fn(&Bench<'c>, &Fitted) -> Result<LackOfFit, String>,
) -> Result<(), String> {
    loop {
        let weak = verdict::to_take_back(bench, &selection.model, left);
        if weak.is_empty() {
            return Ok(());
        }
        let mut named = selection.model.named.clone();
        for k in weak.into_iter().rev() {
            taken_back.extend(bench.names(&[named.remove(k)]));
        }
        let rest = bench.fit_or_loosely(&named)?;
        let settled = settled(bench, rest, options);
        (selection.model, selection.p_values) = (settled.model, settled.p_values);
        if let Some((step, _)) = told(bench, &selection.model, &settled.dropped, options) {
            selection.steps.push(step);
        }
        *left = test(bench, &selection.model)?;
        // What a name had accounted for is there, found by a test or not.
        left.structure = true;
    }
}
