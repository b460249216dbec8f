//! Is what is missing something that has no name, and not what was named?
//!
//! Where structure is left, the search is made once more among more: the catalogue, and
//! what arms are known to have [beside it](super::catalogue::NAMELESS). If that finds a
//! model with something nameless in it, admitted by the same tests, and no structure is left
//! then, the names in that model are the true ones: what had been named and is not among
//! them was named for want of better. Where no structure is left, one thing without a name is
//! tried in place of one to three that have one, for effects together can be much like another.

use std::string::String;
use std::vec;
use std::vec::Vec;

use super::Options;
use super::bench::Bench;
use super::catalogue::{CREEP, HYSTERESIS, LAG, LOST_MOTION, STIFFNESS_NONLINEARITY};
use super::found::Found;
use super::lack_of_fit::LackOfFit;
use super::model::{Fitted, Named};
use super::selection::{CURVATURE, Selection, WITHIN_REACH, best_with, p_values, select};
use super::step::Step;
use super::verdict::makes_up_a_lag;

/// A model with something nameless in it.
pub struct Beyond<'c> {
    /// The bench without what has no name.
    pub bench: Bench<'c>,
    /// The effects that have a name, fitted without the rest; as they were tested with it.
    pub selection: Selection,
    /// What there is besides, each as a noun for a sentence.
    pub nameless: Vec<String>,
}

/// Searches among what has no name, too, where `test` finds structure in what names leave.
///
/// # Errors
/// Why not even the description's own model can be fitted.
pub fn search<'c>(
    bench: &Bench<'c>,
    options: &Options,
    test: impl Fn(&Bench<'c>, &Fitted) -> Result<LackOfFit, String>,
) -> Result<Option<Beyond<'c>>, String> {
    bench.spare_memory();
    let mut wide = bench.widened()?;
    let base = wide.fit(&[])?;
    // Its stages are those that were told before.
    let found = select(&mut wide, base, options, &|_| ())?;
    let is_nameless = |one: &Named| wide.candidates()[one.candidate].is_nameless();
    if found.unnamed || !found.model.named.iter().any(is_nameless) || test(&wide, &found.model)?.structure {
        return Ok(None);
    }
    without_nameless(wide, &found).map(Some)
}

/// Tries something nameless in place of some effects of a model that leaves no
/// structure, which `test` asks of the other model, too.
///
/// # Errors
/// Why not even the description's own model can be fitted.
pub fn instead<'c>(
    bench: &Bench<'c>,
    model: &Fitted,
    options: &Options,
    test: impl Fn(&Bench<'c>, &Fitted) -> Result<LackOfFit, String>,
) -> Result<Option<Beyond<'c>>, String> {
    bench.spare_memory();
    let wide = bench.widened_as_it_is()?;
    let setting = wide.at(&model.named)?;
    let laws = laws_of_gears(bench, model);
    let is_tried = |set: &u32| set.count_ones() <= MOST_REPLACED || *set == laws;
    let sets = (1..1_u32 << model.named.len()).filter(is_tried);
    let without = |set: u32| -> Vec<Named> {
        let rest = model.named.iter().enumerate().filter(|(k, _)| set >> k & 1 == 0);
        rest.map(|(_, one)| *one).collect()
    };
    let nameless = || (0..wide.candidates().len()).filter(|&candidate| wide.candidates()[candidate].is_nameless());
    let with = |rest: Vec<Named>| nameless().filter_map(|candidate| best_with(&setting, &rest, candidate)).collect();
    let mut others: Vec<Fitted> = sets.map(without).flat_map::<Vec<Fitted>, _>(with).collect();
    others.retain(|other| other.bic < model.bic - WITHIN_REACH + CURVATURE);
    others.sort_by(|a, b| a.bic.total_cmp(&b.bic));
    // At their own solution, with what is out of a grid where it fits best.
    let refitted = others.iter().take(TRIED).filter_map(|other| {
        let polished = wide.polished(&other.named);
        let model = polished.fit(&other.named).ok()?;
        Some((polished, model))
    });
    // Better by the criterion, and not for being simpler alone: what is told by many numbers can
    // be like it without being it.
    let saved = |other: &Fitted| wide.parameters(&model.named).saturating_sub(wide.parameters(&other.named)) as f64;
    let price = AKAIKE * setting.problem.variance(&model.fit);
    let is_better = |(_, other): &(Bench<'c>, Fitted)| {
        other.bic < model.bic - WITHIN_REACH && other.fit.rss < model.fit.rss + price * saved(other)
    };
    let best = refitted.filter(is_better).min_by(|a, b| a.1.bic.total_cmp(&b.1.bic));
    let Some((wide, other)) = best else { return Ok(None) };
    let p_values = p_values(&wide, &other.named, options);
    if p_values.iter().any(|&p| p > options.alpha) || test(&wide, &other)?.structure {
        return Ok(None);
    }
    let found = Selection { model: other, p_values, steps: Vec::new(), unnamed: false };
    without_nameless(wide, &found).map(Some)
}

/// How many effects one thing without a name may be told as, but for laws of gears.
const MOST_REPLACED: u32 = 3;

/// Which effects of a model are curves and lags of gears, a bit each: a load that is not what is
/// read of it is told as one of every gear.
fn laws_of_gears(bench: &Bench<'_>, model: &Fitted) -> u32 {
    let is_law = |one: &Named| {
        let kind = bench.candidates()[one.candidate].kind;
        [&STIFFNESS_NONLINEARITY, &LOST_MOTION, &HYSTERESIS, &CREEP].contains(&kind)
    };
    let of = |(k, one): (usize, &Named)| u32::from(is_law(one)) << k;
    model.named.iter().enumerate().map(of).sum()
}

/// What a number may save at most, in residual variances, for a model with fewer to fit as well
/// as noise allows (Akaike, IEEE Trans. Autom. Control 19, 1974).
pub const AKAIKE: f64 = 2.0;

/// How many of the best by the linear criterion are fitted at their own solution.
const TRIED: usize = 4;

/// A model told without what has no name in it.
fn without_nameless<'c>(wide: Bench<'c>, found: &Selection) -> Result<Beyond<'c>, String> {
    let model = &found.model.named;
    let is_nameless = |&k: &usize| wide.candidates()[model[k].candidate].is_nameless();
    let (nameless, named): (Vec<usize>, Vec<usize>) = (0..model.len()).partition(is_nameless);
    let words = |&k: &usize| {
        let (candidate, variant) = (&wide.candidates()[model[k].candidate], model[k].variant);
        Found::new(candidate.kind, candidate.place, candidate.variants[variant].shape.clone()).words()
    };
    let nameless: Vec<String> = nameless.iter().map(words).collect();
    let p_values = named.iter().map(|&k| found.p_values[k]).collect();
    let named: Vec<Named> = named.iter().map(|&k| model[k]).collect();
    let bench = wide.narrowed();
    let model = bench.fit_or_loosely(&named)?;
    let step = Step::beside_nameless(bench.names(&named), &nameless);
    let selection = Selection { model, p_values, steps: vec![step], unnamed: false };
    Ok(Beyond { bench, selection, nameless })
}

/// Whether a joint that lags fits about as well as a model that names its hysteresis: in place
/// of that, of a curve of the same joint, and of creep. Where it cannot be told, it does.
pub fn lag_is_near(bench: &Bench<'_>, model: &Fitted) -> bool {
    let Ok(wide) = bench.widened_as_it_is() else { return true };
    let candidates = wide.candidates();
    let sticks = |one: &&Named| candidates[one.candidate].kind == &HYSTERESIS;
    model.named.iter().filter(sticks).any(|hysteresis| {
        let place = candidates[hysteresis.candidate].place;
        let is_of_lag = |one: &Named| one == hysteresis || makes_up_a_lag(&candidates[one.candidate], place);
        let rest: Vec<Named> = model.named.iter().copied().filter(|one| !is_of_lag(one)).collect();
        let lag = candidates.iter().position(|other| other.kind == &LAG && other.place == place);
        let with = lag.and_then(|lag| best_with(&*wide.at(&rest).ok()?, &rest, lag));
        with.is_none_or(|with| {
            let polished = wide.polished(&with.named).fit(&with.named);
            polished.is_ok_and(|lagging| lagging.bic < model.bic + WITHIN_REACH)
        })
    })
}
