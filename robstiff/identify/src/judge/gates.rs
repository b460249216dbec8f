//! What a class of effects must pass to be named.

use super::thresholds::{ACCOUNTS, DISCREPANCY, DISTINCT, MATTERS, PROBABLE, RECURS, SIZES, WORSE};
use crate::effects::Side;
use crate::observe::Readings;
use crate::regression::noise::{discrepancies, rows_of_blocks};
use crate::select::classes::{ByCandidate, Class, classes};
use crate::select::engine::{Engine, Found, groups};
use crate::select::folds::Nested;
use crate::select::search::{search, with, without};
use crate::select::{Problem, Set};

/// A class, and how it fares.
#[derive(Clone, Debug)]
pub struct Weighed {
    /// The class.
    pub class: Class,
    /// The least probability with priors that are narrower or wider.
    pub least: f64,
    /// The share of folds in which it is back.
    pub recurs: f64,
    /// By how many standard errors unseen poses are predicted worse without it.
    pub worse: f64,
    /// By how much the error on unseen poses grows without it (1).
    pub loss: f64,
    /// By how much the error grows without its effect, over the noise.
    pub matters: f64,
    /// Whether its numbers are distinct from zero.
    pub distinct: bool,
    /// What keeps it from being named, in words; none where it is named.
    pub why_not: Option<String>,
}

/// The classes of the best set, weighed, and what is left.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The classes, in the order of the best set.
    pub classes: Vec<Weighed>,
    /// The probability that nothing is there.
    pub nothing: f64,
    /// The probability that a discrepancy is left.
    pub discrepancy: f64,
    /// The share of what is beyond the noise that the best set accounts for; of a campaign in which a
    /// discrepancy is left.
    pub accounts: f64,
}

/// Weighs the classes of what was found.
pub fn weigh(engine: &Engine<'_>, found: &Found, nested: &Nested, seed: u64) -> Judgement {
    let grams = engine.grams(&found.columns, &engine.one_group()).total;
    let mut problem = engine.problem(&found.layout, &found.columns, grams.clone());
    if problem.learns() {
        problem.learn(&found.best, 8);
    }
    let classes = classes(&problem, &found.visited, &found.best);
    let least = at_other_sizes(engine, found, &classes, seed);
    let unseen = without_each(engine, found, &classes, seed);
    let readings = engine.observation.readings();
    let noise = found.own.fit.variance.sqrt();
    let by = ByCandidate::of(&problem, &found.visited);
    let likely = problem.discrepancies(&found.best);
    let discrepancy =
        likely.iter().zip(discrepancies(readings)).filter(|(_, kappa)| **kappa >= DISCREPANCY).map(|(p, _)| p).sum();
    let accounts = accounted(&problem, &found.best, found.kappa);
    let weighed = classes.into_iter().enumerate().map(|(k, class)| {
        let names: Vec<String> = class.members.iter().map(|(of, _)| found.layout.candidates[*of].name()).collect();
        let (worse, loss) = unseen[k];
        let matters = growth_without(&problem, found, k, noise);
        let mut weighed = Weighed {
            least: least[k].min(class.probability),
            recurs: nested.recurs(&names),
            worse,
            loss,
            matters,
            distinct: is_distinct(found, class.form),
            why_not: None,
            class,
        };
        weighed.why_not = why_not(&weighed, found, discrepancy, accounts);
        weighed
    });
    Judgement { classes: weighed.collect(), nothing: by.of_none(), discrepancy, accounts }
}

/// What keeps a class from being named.
fn why_not(of: &Weighed, found: &Found, discrepancy: f64, accounts: f64) -> Option<String> {
    let side = found.layout.candidates[of.class.members[0].0].kind.side;
    let percent = |p: f64| format!("{:.0} %", 100.0 * p);
    if side == Side::Unnamed {
        return Some("a description has no word for it".into());
    }
    if of.least < PROBABLE {
        return Some(format!("its probability is {}, less than {}", percent(of.least), percent(PROBABLE)));
    }
    if of.recurs < RECURS {
        return Some(format!("it is back in {} of the searches without some poses only", percent(of.recurs)));
    }
    if !of.distinct {
        return Some("its numbers are not distinct from zero".into());
    }
    if of.matters < MATTERS {
        return Some("without it the error grows by next to nothing".into());
    }
    if of.worse < WORSE {
        return Some("unseen poses are predicted about as well without it".into());
    }
    if discrepancy > 0.5 && accounts < ACCOUNTS {
        return Some(format!(
            "something else is missing: all effects together account for {} of what is beyond the noise",
            percent(accounts)
        ));
    }
    None
}

/// The probability of each class with priors that are narrower and wider, the least.
fn at_other_sizes(engine: &Engine<'_>, found: &Found, classes: &[Class], _seed: u64) -> Vec<f64> {
    let mut least = vec![1.0_f64; classes.len()];
    for sizes in SIZES {
        let mut other = engine.clone();
        other.sizes = sizes;
        let grams = other.grams(&found.columns, &other.one_group()).total;
        let mut problem = other.problem(&found.layout, &found.columns, grams);
        let visited = search(&mut problem, &found.best, engine.fold_width());
        let by = ByCandidate::of(&problem, &visited);
        for (least, class) in least.iter_mut().zip(classes) {
            let members: Vec<usize> = class.members.iter().map(|(of, _)| *of).collect();
            *least = least.min(by.of_any(&members));
        }
    }
    least
}

/// Of each class, by how many standard errors unseen poses are predicted worse without it, the best of
/// all others in its place, and by how much.
fn without_each(engine: &Engine<'_>, found: &Found, classes: &[Class], seed: u64) -> Vec<(f64, f64)> {
    let readings = engine.observation.readings();
    let group = groups(&engine.training, super::thresholds::FOLDS, seed);
    let folds = group.iter().flatten().max().map_or(0, |last| last + 1);
    let grams = engine.grams(&found.columns, &group);
    // The sum of squares of each block, of the best set and without each class.
    let mut with_all = vec![0.0; readings.blocks];
    let mut less: Vec<Vec<f64>> = vec![vec![0.0; readings.blocks]; classes.len()];
    for fold in 0..folds {
        let mut problem = engine.problem(&found.layout, &found.columns, grams.without(fold).total);
        if problem.learns() {
            problem.learn(&found.best, 4);
        }
        let unseen: Vec<bool> = group.iter().map(|of| *of == Some(fold)).collect();
        let rows = rows_of_blocks(readings, &unseen).concat();
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
        (mean / error, ((whole + mean * count).max(0.0) / whole.max(f64::MIN_POSITIVE)).sqrt() - 1.0)
    };
    less.iter().map(of_class).collect()
}

/// The best set without a class, with the best of all others in its place, if any is worth it.
fn replaced(problem: &Problem<'_>, best: &Set, class: &Class, kappa: usize) -> Set {
    let Some(at) = best.iter().position(|form| *form == class.form) else { return best.clone() };
    let rest = without(best, at);
    let is_member = |form: usize| {
        let of = problem.layout.forms[form].candidate;
        class.members.iter().any(|(member, _)| *member == of)
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

/// The share of what the joints alone leave beyond the noise that a set accounts for, both without any
/// discrepancy that the model might hide behind.
fn accounted(problem: &Problem<'_>, best: &Set, kappa: usize) -> f64 {
    let variance = |set: &Set, kappa| problem.fit(set, kappa).map(|fit| fit.variance);
    match (variance(&Set::new(), 0), variance(best, 0), variance(best, kappa)) {
        (Some(alone), Some(with), Some(noise)) if alone > noise => ((alone - with) / (alone - noise)).clamp(0.0, 1.0),
        _ => 1.0,
    }
}
