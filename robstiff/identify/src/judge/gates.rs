//! What a class of effects must pass to be named.

use super::thresholds::{
    ACCOUNTS, DISCREPANCY, DISTINCT, FALLS, LOSS, MATTERS, PROBABLE, RECURS, SIZES, STANDS_OUT, WORSE,
};
use crate::effects::{Side, What};
use crate::model::Term;
use crate::observe::Readings;
use crate::regression::noise::{OUTLYING, discrepancies};
use crate::select::classes::{ByCandidate, Class, classes, extend, weigh_again};
use crate::select::engine::Engine;
use crate::select::folds::Nested;
use crate::select::passes::Found;
use crate::select::problem::moves;
use crate::select::search::{search, with, without};
use crate::select::unseen::{groups, without_each_fold};
use crate::select::{Problem, Set};

/// A class, and how it fares.
#[derive(Clone, Debug)]
pub struct Weighed {
    /// The class.
    pub class: Class,
    /// The least probability with priors as they are, narrower and wider.
    pub least: f64,
    /// How many times as wide the priors are with which it is the least.
    pub least_at: f64,
    /// The share of folds in which it is back.
    pub recurs: f64,
    /// Of absolute positions, what it costs on unseen poses to put the best of all others in its place.
    pub replaced: Option<Replaced>,
    /// By how much the error grows without its effect, over the noise.
    pub matters: f64,
    /// Whether its numbers are distinct from zero.
    pub distinct: bool,
    /// Of a number of the table that absolute positions show, whether it stands out from the others.
    pub stands_out: Option<bool>,
    /// What keeps it from being named, in words; none where it is named.
    pub why_not: Option<String>,
}

/// How unseen poses are predicted with the best of all others in the place of a class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Replaced {
    /// By how many standard errors of the difference between poses they are predicted worse.
    pub worse: f64,
    /// By how much the error grows (1).
    pub loss: f64,
}

/// The classes of the best set, weighed, and what is left.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The classes, in the order of the best set.
    pub classes: Vec<Weighed>,
    /// The probability that a discrepancy is left.
    pub discrepancy: f64,
}

/// Weighs the classes of what was found.
pub fn weigh(engine: &Engine<'_>, found: &Found, nested: &Nested, seed: u64) -> Judgement {
    let mut problem = engine.problem_of(found);
    if problem.learns() {
        problem.learn(&found.best, 8);
    }
    let mut classes = classes(&problem, &found.visited, &found.best);
    let by = ByCandidate::of(&problem, &found.visited);
    let least = at_other_sizes(engine, found, &mut classes, &by);
    let unseen = match engine.scene.what {
        What::Positions => without_each(engine, found, &classes, seed).into_iter().map(Some).collect(),
        What::Displacements | What::Clamped => vec![None; classes.len()],
    };
    let falls = fall(engine, nested);
    let readings = engine.observation.readings();
    let noise = found.own.fit.variance.sqrt();
    let likely = problem.discrepancies(&found.best);
    let discrepancy =
        likely.iter().zip(discrepancies(readings)).filter(|(_, kappa)| **kappa >= DISCREPANCY).map(|(p, _)| p).sum();
    let accounts = accounted(&problem, &found.best, found.kappa);
    let weighed = classes.into_iter().enumerate().map(|(k, class)| {
        let names: Vec<String> = class.members.iter().map(|(of, _)| found.layout.candidates[*of].name()).collect();
        let (at, least) = least[k];
        let matters = growth_without(&problem, found, k, noise);
        let mut weighed = Weighed {
            least,
            least_at: at,
            recurs: nested.recurs(&names),
            replaced: unseen[k],
            matters,
            distinct: is_distinct(found, class.form),
            stands_out: stands_out(engine, found, class.form),
            why_not: None,
            class,
        };
        weighed.why_not = why_not(&weighed, (found, engine.scene.what), falls, (discrepancy, accounts));
        weighed
    });
    Judgement { classes: weighed.collect(), discrepancy }
}

/// What keeps a class from being named.
fn why_not(
    of: &Weighed,
    (found, what): (&Found, What),
    falls: f64,
    (discrepancy, accounts): (f64, f64),
) -> Option<String> {
    let side = found.layout.candidates[of.class.members[0].0].kind.side;
    let percent = |p: f64| format!("{:.0} %", 100.0 * p);
    if side == Side::Unnamed {
        return Some("a description has no word for it".into());
    }
    if of.least < PROBABLE {
        return Some(improbable(of, percent));
    }
    if of.recurs < RECURS {
        return Some(format!("it is back in {} of the searches without some poses only", percent(of.recurs)));
    }
    if !of.distinct {
        return Some("its numbers are not distinct from zero".into());
    }
    if of.stands_out == Some(false) {
        return Some("it does not stand out from the other numbers of the table".into());
    }
    if what == What::Displacements && of.matters < MATTERS {
        return Some("without it the error grows by next to nothing".into());
    }
    if of.stands_out.is_none() && of.replaced.is_some_and(|of| of.loss < LOSS || of.worse < WORSE) {
        return Some("unseen poses are predicted about as well with something else in its place".into());
    }
    if what != What::Clamped && of.stands_out.is_none() && falls < FALLS {
        return Some("all effects together predict unseen poses no better than the description's own numbers".into());
    }
    if discrepancy > 0.5 && accounts < ACCOUNTS {
        return Some(format!(
            "something else is missing: all effects together account for {} of what is beyond the noise",
            percent(accounts)
        ));
    }
    None
}

/// That a class is not probable enough, and where it is least so.
fn improbable(of: &Weighed, percent: impl Fn(f64) -> String) -> String {
    if of.class.probability < PROBABLE {
        return format!("its probability is {}, less than {}", percent(of.class.probability), percent(PROBABLE));
    }
    let size = if of.least_at > 1.0 { "larger" } else { "smaller" };
    format!("its probability falls to {} where effects are taken to be three times {size}", percent(of.least))
}

/// By how much the error on unseen poses falls with the whole search.
fn fall(engine: &Engine<'_>, nested: &Nested) -> f64 {
    let readings = engine.observation.readings();
    let is_asked = |row: &usize| engine.training[readings.block[*row]] && engine.noise.weights[*row] >= OUTLYING;
    let rms = |left| readings.rms(left, (0..readings.rows()).filter(is_asked));
    let alone = rms(&nested.alone);
    if alone > 0.0 { 1.0 - rms(&nested.left) / alone } else { 0.0 }
}

/// Extends classes by what may stand in the place of their effects with priors that are narrower or
/// wider, and finds the least probability of each with any, after how many times as wide they are then.
fn at_other_sizes(engine: &Engine<'_>, found: &Found, classes: &mut [Class], by: &ByCandidate) -> Vec<(f64, f64)> {
    let mut others: Vec<(f64, ByCandidate)> = Vec::new();
    for sizes in SIZES {
        let mut other = engine.clone();
        other.sizes = sizes;
        let mut problem = other.problem_of(found);
        let visited = search(&mut problem, &found.best, engine.fold_width());
        extend(classes, &problem, &visited, &found.best);
        others.push((sizes, ByCandidate::of(&problem, &visited)));
    }
    weigh_again(classes, by);
    let least = |class: &Class| {
        let members: Vec<usize> = class.members.iter().map(|(of, _)| *of).collect();
        let each = others.iter().map(|(sizes, by)| (*sizes, by.of_any(&members)));
        each.fold((1.0, class.probability), |least, one| if one.1 < least.1 { one } else { least })
    };
    classes.iter().map(least).collect()
}

/// Of each class, by how many standard errors unseen poses are predicted worse without it, the best of
/// all others in its place, and by how much.
fn without_each(engine: &Engine<'_>, found: &Found, classes: &[Class], seed: u64) -> Vec<Replaced> {
    let readings = engine.observation.readings();
    let group = groups(readings, &engine.training, super::thresholds::FOLDS, seed);
    // The sum of squares of each block, of the best set and without each class.
    let mut with_all = vec![0.0; readings.blocks];
    let mut less: Vec<Vec<f64>> = vec![vec![0.0; readings.blocks]; classes.len()];
    for (mut problem, rows) in without_each_fold(engine, &found.layout, &found.columns, &group) {
        if problem.learns() {
            problem.learn(&found.best, 4);
        }
        add_squares(&mut with_all, readings, found, &problem, &found.best, found.kappa, &rows);
        for (class, sums) in classes.iter().zip(&mut less) {
            let other = replaced(&problem, &found.best, class, found.kappa);
            add_squares(sums, readings, found, &problem, &other, found.kappa, &rows);
        }
    }
    let blocks: Vec<usize> = (0..readings.blocks).filter(|&block| engine.training[block]).collect();
    let whole: f64 = blocks.iter().map(|&block| with_all[block]).sum();
    let of_class = |sums: &Vec<f64>| {
        // Squares over the noise: large where a pose is unseen badly either way.
        let differences: Vec<f64> = blocks.iter().map(|&block| sums[block] - with_all[block]).collect();
        let count = differences.len().max(2) as f64;
        let mean = differences.iter().sum::<f64>() / count;
        let spread = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let error = (spread / count).sqrt().max(f64::MIN_POSITIVE);
        let loss = ((whole + mean * count).max(0.0) / whole.max(f64::MIN_POSITIVE)).sqrt() - 1.0;
        Replaced { worse: mean / error, loss }
    };
    less.iter().map(of_class).collect()
}

/// The best set without a class, with the best of all others in its place, if any is worth it.
fn replaced(problem: &Problem<'_>, best: &Set, class: &Class, kappa: usize) -> Set {
    let Some(at) = best.iter().position(|form| *form == class.form) else { return best.clone() };
    let rest = without(best, at);
    let own = &problem.layout.candidates[class.members[0].0];
    let is_member = |form: usize| {
        let of = problem.layout.forms[form].candidate;
        let candidate = &problem.layout.candidates[of];
        // What has no name and is at the same place has the effect within it.
        let is_wider = candidate.kind.side == Side::Unnamed && candidate.place == own.place;
        is_wider || class.members.iter().any(|(member, _)| *member == of)
    };
    let others = problem.additions(&rest, kappa).into_iter().filter(|(_, form)| !is_member(*form));
    let mut judged: Vec<(f64, Set)> = others
        .take(TRIED)
        .map(|(_, form)| with(&rest, form))
        .chain([rest.clone()])
        .filter_map(|set| Some((problem.judge(&set)?.score, set)))
        .collect();
    judged.sort_by(|a, b| b.0.total_cmp(&a.0));
    judged.into_iter().next().map_or(rest, |(_, set)| set)
}

/// So many others are tried in the place of a class.
const TRIED: usize = 6;

/// Adds what a set leaves of unseen rows, squared and weighed, block by block.
fn add_squares(
    sums: &mut [f64],
    readings: &Readings,
    found: &Found,
    problem: &Problem<'_>,
    set: &Set,
    kappa: usize,
    rows: &[usize],
) {
    let Some(fit) = problem.fit(set, kappa) else { return };
    let last = found.columns.ncols() - 1;
    for &row in rows {
        for k in 0..readings.reported {
            let at = row * readings.width + k;
            let taken: f64 = fit.columns.iter().zip(fit.mean.iter()).map(|(&c, b)| found.columns[(at, c)] * b).sum();
            sums[readings.block[row]] += (found.columns[(at, last)] - taken).powi(2);
        }
    }
}

/// By how much the error grows without an effect of the best set, all others fitted again, over the
/// noise.
fn growth_without(problem: &Problem<'_>, found: &Found, place: usize, noise: f64) -> f64 {
    let error = |set: &Set| problem.fit(set, 0).map(|fit| fit.variance.sqrt());
    match (error(&found.best), error(&without(&found.best, place))) {
        (Some(with), Some(without)) => (without - with) / noise,
        _ => f64::INFINITY,
    }
}

/// Whether any number of an effect is distinct from zero.
fn is_distinct(found: &Found, form: usize) -> bool {
    let fit = &found.own.fit;
    found.layout.forms[form].columns.iter().filter_map(|&column| fit.place(column)).any(|at| {
        let (value, std) = (fit.mean[at], fit.std[at]);
        value.abs() > DISTINCT * std
    })
}

/// Whether a number of the table that absolute positions show stands out; none of another effect.
fn stands_out(engine: &Engine<'_>, found: &Found, form: usize) -> Option<bool> {
    let columns = &found.layout.forms[form].columns;
    let is_of_table = columns.iter().all(|&k| matches!(found.layout.parameters[k].term, Term::Table(..)));
    if engine.scene.what != What::Positions || !is_of_table {
        return None;
    }
    let moves = moves(engine.observation.readings(), &found.columns, &engine.training);
    let fit = &found.own.fit;
    let noise = fit.variance.sqrt();
    Some(columns.iter().any(|&k| {
        let std = fit.place(k).map_or(f64::INFINITY, |at| fit.std[at]);
        let value = fit.value(k).abs();
        value > STANDS_OUT * std && value * moves[k] > noise
    }))
}

/// The share of what the joints alone leave beyond the noise that a set accounts for, both without any
/// discrepancy that the model might hide behind.
fn accounted(problem: &Problem<'_>, best: &Set, kappa: usize) -> f64 {
    let variance = |set: &Set, kappa| problem.fit(set, kappa).map(|fit| fit.variance);
    match (variance(&Set::new(), 0), variance(best, 0), variance(best, kappa)) {
        (Some(alone), Some(with), Some(noise)) if alone > noise => ((alone - with) / (alone - noise)).clamp(0.0, 1.0),
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reason_is_what_decided() {
        let of = |probability, least, least_at| Weighed {
            class: Class { form: 0, members: vec![(0, probability)], probability },
            least,
            least_at,
            recurs: 1.0,
            replaced: None,
            matters: 1.0,
            distinct: true,
            stands_out: None,
            why_not: None,
        };
        let percent = |p: f64| format!("{:.0} %", 100.0 * p);
        assert_eq!(improbable(&of(0.7, 0.04, 3.0), percent), "its probability is 70 %, less than 95 %");
        let wider = "its probability falls to 4 % where effects are taken to be three times larger";
        assert_eq!(improbable(&of(0.99, 0.04, 3.0), percent), wider);
        assert_eq!(improbable(&of(0.99, 0.04, 1.0 / 3.0), percent), wider.replace("larger", "smaller"));
    }
}
