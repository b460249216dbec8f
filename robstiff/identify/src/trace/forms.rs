//! How uncertain numbers are since the set of effects is, and the form of each: a gap that comes out larger with another
//! knee is known no better than the knee.

use crate::select::passes::Found;
use crate::select::search::with;
use crate::select::{Problem, Set};

/// A form that is so much less likely than that of the best set has no part.
const UNLIKELY: f64 = 1e-3;

/// The variance of each number that is always fitted between the sets that were judged, about the values in the best
/// (Hoeting, Madigan, Raftery and Volinsky, Statistical Science 14, 1999).
pub fn between_sets(problem: &Problem<'_>, found: &Found) -> Vec<f64> {
    let always = found.layout.always();
    let Some(best) = problem.fit(&found.best, found.kappa) else { return vec![0.0; always.len()] };
    let likely = found.visited.posterior().into_iter().take_while(|(_, p)| *p > UNLIKELY);
    let fits: Vec<_> =
        likely.filter_map(|(set, p)| Some((p, problem.fit(set, found.visited.sets[set].kappa)?))).collect();
    always.map(|k| fits.iter().map(|(p, fit)| p * (fit.value(k) - best.value(k)).powi(2)).sum()).collect()
}

/// The variance of each number of a form of the best set between the forms of its candidate that have
/// the same numbers, about the values in the best set.
pub fn between_forms(problem: &Problem<'_>, found: &Found, form: usize) -> Vec<f64> {
    let layout = &found.layout;
    let own = &layout.forms[form].columns;
    let none = vec![0.0; own.len()];
    let rest: Set = found.best.iter().copied().filter(|other| *other != form).collect();
    let (Some(best), Some(fit)) = (found.visited.sets.get(&found.best), problem.fit(&found.best, found.kappa)) else {
        return none;
    };
    let has_same_numbers = |other: &usize| {
        let columns = &layout.forms[*other].columns;
        let name = |column: &usize| (layout.parameters[*column].name, layout.parameters[*column].unit);
        columns.iter().map(name).eq(own.iter().map(name))
    };
    let (mut sum, mut squares) = (1.0, none);
    for other in problem.other_forms(form).filter(has_same_numbers) {
        let set = with(&rest, other);
        let Some(judged) = found.visited.sets.get(&set) else { continue };
        let likely = (judged.score - best.score).exp();
        if likely < UNLIKELY {
            continue;
        }
        let Some(of_set) = problem.fit(&set, judged.kappa) else { continue };
        sum += likely;
        for (k, (column, other)) in own.iter().zip(&layout.forms[other].columns).enumerate() {
            squares[k] += likely * (of_set.value(*other) - fit.value(*column)).powi(2);
        }
    }
    squares.iter().map(|square| square / sum).collect()
}
