//! Models that may be better than one, in the order in which they are worth a try, and what
//! of a model is superfluous.

use std::vec::Vec;

use super::bench::{Bench, Model, Proposed, TIE};
use crate::trace::Options;
use crate::trace::bootstrap::{Reference, price};
use crate::trace::lack_of_fit::LackOfFit;
use crate::trace::model::all_but;
use crate::trace::selection::{BETTER, CURVATURE, REFITTED, WITHIN_REACH};
use crate::trace::step::{Against, Step};

/// How many of the best are extended where none of them passes alone.
const EXTENDED: usize = 8;

/// How many of the best with one effect replaced, or in another form, are tried without
/// what is superfluous then.
const REPLACED: usize = 24;

/// The tests of all candidates against a model, the models with one of them more, the best
/// first, the distribution of the largest statistic, and whether something is missing.
pub fn tested(bench: &Bench<'_>, model: &Model, options: &Options) -> Option<(Step, Vec<Proposed>, Reference, bool)> {
    let test = bench.test(&model.named)?;
    let reference = test.reference(options.draws, options.seed);
    let singles = bench.extended(&model.named);
    let statistics = test.statistics();
    let step = Step::against(&bench.candidates, &model.named, |candidate| {
        let with = singles.iter().find(|fit| fit.named.iter().any(|one| one.candidate == candidate));
        Against {
            gains: statistics[candidate].map(|(statistic, _)| (statistic, reference.p_value(statistic))),
            bic: with.map(|with| with.bic),
            left_out_rms: None,
        }
    });
    let missing = step.candidates.iter().any(|tested| tested.p_value <= options.alpha);
    Some((step, singles, reference, missing))
}

/// The first of the best models with one effect more that passes; where none does,
/// with two, of which each can keep the other from passing alone.
pub fn extended(bench: &Bench<'_>, model: &Model, singles: &[Proposed], options: &Options) -> Option<Model> {
    let passing = |proposals: &[Proposed]| {
        refitted(bench, proposals, model).into_iter().find(|better| passes(bench, model, better, options))
    };
    passing(singles).or_else(|| {
        let mut pairs: Vec<Proposed> =
            singles.iter().take(EXTENDED).flat_map(|one| bench.extended(&one.named)).collect();
        pairs.sort_by(|a, b| a.bic.total_cmp(&b.bic));
        passing(&pairs)
    })
}

/// The best of some proposals, given the best first, in their own form; among equals
/// the one that comes first in the catalogue.
pub fn refitted(bench: &Bench<'_>, proposals: &[Proposed], from: &Model) -> Vec<Model> {
    let Some(best) = proposals.first().map(|one| one.bic) else { return Vec::new() };
    let near = proposals.iter().take_while(|one| one.bic < best + CURVATURE).take(REFITTED);
    let mut models: Vec<Model> = near.filter_map(|one| bench.solve(&one.named, &from.solved.state)).collect();
    models.sort_by(|a, b| a.bic.total_cmp(&b.bic));
    let Some(best) = models.first().map(|one| one.bic) else { return Vec::new() };
    models.retain(|one| one.bic < best + WITHIN_REACH);
    let equal = models.iter().take_while(|one| one.bic < best + TIE).count();
    models[..equal].sort_by(|a, b| a.named.cmp(&b.named));
    models
}

/// Whether a model's new effects are significant, and it predicts poses left out
/// better than the smaller one.
fn passes(bench: &Bench<'_>, smaller: &Model, better: &Model, options: &Options) -> bool {
    let new = (0..better.named.len()).filter(|&k| !smaller.named.contains(&better.named[k]));
    bench.left_out_rms(&better.solved) < bench.left_out_rms(&smaller.solved)
        && new.map(|k| bench.p_value(&better.named, k, options)).all(|p| p <= options.alpha)
}

/// The model that is better with one effect replaced, or in another form, and without
/// what that makes superfluous, where there is one whose effects are all significant.
pub fn sideways(bench: &Bench<'_>, model: Model, reference: &Reference, options: &Options) -> Model {
    // An effect the less is worth no more than what its number costs.
    let worth = (model.solved.problem.total.rows as f64).ln() * model.named.len() as f64;
    let mut proposals = bench.reformed(&model.named);
    proposals.extend(bench.replaced(&model.named).into_iter().map(|(_, other)| other));
    proposals.retain(|other| other.bic < model.bic + worth);
    proposals.sort_by(|a, b| a.bic.total_cmp(&b.bic));
    let mut proposals: Vec<Proposed> = proposals.into_iter().take(REPLACED).map(|other| bench.pruned(other)).collect();
    proposals.retain(|other| other.bic < model.bic);
    proposals.sort_by(|a, b| a.bic.total_cmp(&b.bic));
    proposals.dedup_by(|a, b| a.named == b.named);
    let others = refitted(bench, &proposals, &model);
    let better = others.into_iter().find(|other| {
        other.bic < model.bic - BETTER && weakest(bench, other, reference).is_none_or(|(_, p)| p <= options.alpha)
    });
    better.unwrap_or(model)
}

/// The effect of a model that gains least, with the p-value of that much by the
/// distribution of the largest statistic at another step.
fn weakest(bench: &Bench<'_>, model: &Model, reference: &Reference) -> Option<(usize, f64)> {
    let variance = model.solved.problem.variance(&model.solved.fit);
    let p = |k: usize| {
        let rest = all_but(&model.named, k);
        let without = bench.solve(&rest, &model.solved.state).map_or(f64::INFINITY, |rest| rest.solved.fit.rss);
        let price = price(bench.variant(model.named[k]));
        reference.p_value((without - model.solved.fit.rss) / variance - price)
    };
    (0..model.named.len()).map(|k| (k, p(k))).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The model without effects that later ones made superfluous.
pub fn without_superfluous(bench: &mut Bench<'_>, mut model: Model, reference: &Reference, options: &Options) -> Model {
    while let Some((k, _)) = weakest(bench, &model, reference).filter(|(_, p)| *p > options.alpha) {
        let rest = all_but(&model.named, k);
        let Some(smaller) = bench.solve(&rest, &model.solved.state) else { break };
        bench.turn_to(&smaller);
        model = smaller;
    }
    model
}

/// The model without the effect that accounts for least, where that is less than what
/// is left beyond noise: it may be borrowed from what has no name. `None` where all
/// account for more.
pub fn without_borrowed(bench: &Bench<'_>, model: &Model, left: &LackOfFit) -> Option<Model> {
    let own = model.solved.fit.rss;
    let smaller = (0..model.named.len()).filter_map(|k| {
        let rest = all_but(&model.named, k);
        bench.solve(&rest, &model.solved.state)
    });
    let least = smaller.min_by(|a, b| a.solved.fit.rss.total_cmp(&b.solved.fit.rss))?;
    (least.solved.fit.rss - own < left.fraction * own).then_some(least)
}
