//! Sets weighed over how large effects are likely to be.

use std::collections::BTreeSet;

use nalgebra::DMatrix;

use super::engine::Engine;
use super::problem::{Judged, Problem, Set};
use super::search::{Visited, search};
use crate::model::Term;

/// How many times larger effects may be than usual, beside usual.
const OTHER_SIZES: [f64; 2] = [1.0 / 3.0, 3.0];

/// A set that is so much less likely than the best (in the logarithm) is not weighed over sizes.
const NO_MATTER: f64 = 10.0;

impl Engine<'_> {
    /// Weighs sets over how large springs and laws of joints are likely to be: of three sizes each is as
    /// likely, so that one which is larger than usual is not passed over for two that are usual. Lengths
    /// and angles have sizes that one knows.
    pub(super) fn over_sizes(&self, problem: &Problem<'_>, columns: &DMatrix<f64>, visited: &mut Visited) {
        let best = visited.best();
        let mut others: Vec<(Problem<'_>, Visited)> = Vec::new();
        for by in OTHER_SIZES {
            let mut other = self.clone();
            other.sizes *= by;
            let mut problem = other.problem(problem.layout, columns, problem.grams.clone());
            problem.priors.iter_mut().zip(&problem.layout.parameters).skip(problem.layout.always().end).for_each(
                |(prior, parameter)| {
                    if !matches!(parameter.term, Term::Spring(_) | Term::Hardening(..) | Term::Law(..)) {
                        prior.sd /= by;
                    }
                },
            );
            let own = search(&mut problem, &best, self.fold_width());
            others.push((problem, own));
        }
        let mut likely: BTreeSet<Set> = BTreeSet::new();
        for visited in others.iter().map(|(_, visited)| visited).chain([&*visited]) {
            let ranked = visited.ranked();
            let Some(least) = ranked.first().map(|(_, judged)| judged.score - NO_MATTER) else { continue };
            likely.extend(ranked.iter().take_while(|(_, judged)| judged.score > least).map(|(set, _)| (*set).clone()));
        }
        let count = (1 + others.len()) as f64;
        visited.sets.values_mut().for_each(|judged| judged.score -= count.ln());
        for set in likely {
            let at_other =
                others.iter().map(|(problem, own)| own.sets.get(&set).copied().or_else(|| problem.judge(&set)));
            let usual = visited.sets.get(&set).copied();
            let usual = usual.or_else(|| {
                let judged = problem.judge(&set)?;
                Some(Judged { score: judged.score - count.ln(), ..judged })
            });
            let at_other = at_other.flatten().map(|judged| Judged { score: judged.score - count.ln(), ..judged });
            let each: Vec<Judged> = usual.into_iter().chain(at_other).collect();
            if let Some(most) = each.iter().copied().max_by(|a, b| a.score.total_cmp(&b.score)) {
                let sum: f64 = each.iter().map(|one| (one.score - most.score).exp()).sum();
                visited.sets.insert(set, Judged { score: most.score + sum.ln(), ..most });
            }
        }
    }
}
