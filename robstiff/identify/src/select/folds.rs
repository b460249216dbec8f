//! The whole search repeated without some poses.
//!
//! The error on unseen poses that is reported anywhere is this one: nothing of a fold's poses, the choice
//! of effects included, has a part in what predicts them (Varma and Simon, BMC Bioinformatics 7, 2006).
//! With few poses everything is done again from the declared description, the noise and the
//! linearisation too; with many the columns and the noise are those of all poses, of which a few have
//! next to no part in them, and a fold is a subtraction of Gram matrices.

use nalgebra::{DMatrix, DVector};

use super::engine::Engine;
use super::passes::Found;
use super::problem::Set;
use super::search::{Visited, candidates_of, search};
use super::unseen::{groups, unseen_rows, without_each_fold};

/// The whole search, repeated.
#[derive(Clone, Debug)]
pub struct Nested {
    /// How many folds there are.
    pub folds: usize,
    /// What the model of each fold leaves of the rows that it has not seen, stacked.
    pub left: DVector<f64>,
    /// The same of the description's own numbers alone.
    pub alone: DVector<f64>,
    /// What each fold found: sets of candidates by their names, with their probability.
    pub found: Vec<Vec<(Vec<String>, f64)>>,
}

/// From so many poses on a fold is a subtraction.
const MANY: usize = 60;

/// How likely something must be in a fold to be back there.
const BACK: f64 = 0.5;

impl Nested {
    /// The share of the folds in which one of some candidates is back, by their names.
    pub fn recurs(&self, class: &[String]) -> f64 {
        let has = |names: &[String]| names.iter().any(|name| class.contains(name));
        let back = |fold: &&Vec<(Vec<String>, f64)>| {
            fold.iter().filter(|(names, _)| has(names)).map(|(_, p)| p).sum::<f64>() > BACK
        };
        self.found.iter().filter(back).count() as f64 / self.found.len().max(1) as f64
    }

    /// The share of the folds whose best set has each candidate, by its name; the most frequent
    /// first.
    pub fn names(&self) -> Vec<(String, f64)> {
        let mut names: Vec<(String, f64)> = Vec::new();
        for name in self.found.iter().filter_map(|fold| fold.first()).flat_map(|(names, _)| names) {
            match names.iter_mut().find(|(known, _)| known == name) {
                Some((_, share)) => *share += 1.0,
                None => names.push((name.clone(), 1.0)),
            }
        }
        names.iter_mut().for_each(|(_, share)| *share /= self.found.len().max(1) as f64);
        names.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        names
    }
}

/// Repeats a search in so many folds, drawn at random; in each pose by itself where there are no more
/// of them.
pub fn nested(engine: &Engine<'_>, found: &Found, folds: usize, seed: u64, progress: &dyn Fn(&str)) -> Nested {
    let group = groups(engine.observation.readings(), &engine.training, folds, seed);
    let folds = group.iter().flatten().max().map_or(0, |last| last + 1);
    let size = engine.observation.readings().values.len();
    let mut nested = Nested { folds, left: DVector::zeros(size), alone: DVector::zeros(size), found: Vec::new() };
    if engine.blocks() >= MANY {
        by_subtraction(engine, found, &group, &mut nested, progress);
    } else {
        anew(engine, &group, &mut nested, progress);
    }
    nested
}

/// Puts the residuals of some rows in their place.
fn put(whole: &mut DVector<f64>, left: &DVector<f64>, rows: &[usize], width: usize) {
    for row in rows {
        whole.rows_mut(row * width, width).copy_from(&left.rows(row * width, width));
    }
}

/// Everything again without each fold.
fn anew(engine: &Engine<'_>, group: &[Option<usize>], nested: &mut Nested, progress: &dyn Fn(&str)) {
    let readings = engine.observation.readings();
    for fold in 0..nested.folds {
        progress(&format!("searching without some poses ({} of {})", fold + 1, nested.folds));
        let mut without = engine.fresh();
        without.training = group.iter().map(|of| of.is_some_and(|of| of != fold)).collect();
        let rows = unseen_rows(readings, group, fold);
        let Some((found, alone)) = without.run_from_alone(&|_| ()) else { continue };
        put(&mut nested.left, &found.own.left, &rows, readings.width);
        put(&mut nested.alone, &alone, &rows, readings.width);
        nested.found.push(posterior(&found.visited, |set| names(&found, set)));
    }
}

/// The search again with Gram matrices less a fold's.
fn by_subtraction(
    engine: &Engine<'_>,
    found: &Found,
    group: &[Option<usize>],
    nested: &mut Nested,
    progress: &dyn Fn(&str),
) {
    let readings = engine.observation.readings();
    let folds = without_each_fold(engine, &found.layout, &found.columns, group);
    for (fold, (mut problem, rows)) in folds.enumerate() {
        progress(&format!("searching without some poses ({} of {})", fold + 1, nested.folds));
        let start = if problem.learns() { Set::new() } else { found.best.clone() };
        let visited = search(&mut problem, &start, engine.fold_width());
        let best = visited.best();
        let kappa = visited.sets.get(&best).map_or(0, |judged| judged.kappa);
        if let Some(fit) = problem.fit(&best, kappa) {
            put(&mut nested.left, &left_by(&found.columns, &fit.columns, &fit.mean), &rows, readings.width);
        }
        // Their optimum is elsewhere, and no compliance is negative there.
        let mut without = engine.clone();
        without.training = group.iter().map(|of| of.is_some_and(|of| of != fold)).collect();
        if let Some(alone) = without.alone(&found.layout) {
            put(&mut nested.alone, &alone.left, &rows, readings.width);
        }
        nested.found.push(posterior(&visited, |set| {
            candidates_of(&problem, set).into_iter().map(|of| found.layout.candidates[of].name()).collect()
        }));
    }
}

/// What numbers of some columns leave of the readings behind the columns.
fn left_by(columns: &DMatrix<f64>, of: &[usize], numbers: &DVector<f64>) -> DVector<f64> {
    let mut left = columns.column(columns.ncols() - 1).into_owned();
    for (&column, number) in of.iter().zip(numbers.iter()) {
        left.axpy(-number, &columns.column(column), 1.0);
    }
    left
}

/// The names of a set's candidates.
fn names(found: &Found, set: &[usize]) -> Vec<String> {
    set.iter().map(|&form| found.layout.names(form).0).collect()
}

/// The posterior of sets of candidates by their names, the best first; what is next to impossible left
/// out.
fn posterior(visited: &Visited, names: impl Fn(&[usize]) -> Vec<String>) -> Vec<(Vec<String>, f64)> {
    const NEXT_TO_IMPOSSIBLE: f64 = 1e-6;
    let likely = visited.posterior().into_iter().take_while(|(_, p)| *p > NEXT_TO_IMPOSSIBLE);
    likely.map(|(set, p)| (names(set), p)).collect()
}
