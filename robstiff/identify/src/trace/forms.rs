//! How uncertain an effect's numbers are since its form is: a gap that comes out larger with another knee
//! is known no better than the knee.

use crate::select::passes::Found;
use crate::select::search::with;
use crate::select::{Problem, Set};

/// A form that is so much less likely than that of the best set has no part.
const UNLIKELY: f64 = 1e-3;

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
        let name = |column: &usize| layout.parameters[*column].name;
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
