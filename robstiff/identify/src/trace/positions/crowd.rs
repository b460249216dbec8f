//! Rows that stand out, and are no single rows for all that.
//!
//! What loads do and no model says makes rows under payload worse than those without. They stand
//! out from these one by one, as if each had gone wrong by itself, and without them what is left
//! looks like noise. So where more than a few stand out, or those do that carry most, it is
//! structure, and none is left out. Whether they do is asked of how many of them are heavier than
//! the mean, by the hypergeometric distribution (Fisher's exact test, of one side).

use std::string::ToString;

use statrs::distribution::{DiscreteCDF, Hypergeometric};

use super::bench::{Bench, Model};
use crate::identify::positions::wild::{Many, Wild, wild_rows};
use crate::probability::told;
use crate::trace::lack_of_fit::StructureTest;

/// The level at which wild rows are those under payload: what is single goes wrong under any.
const LEVEL: f64 = 0.01;

/// Rows that stand out together.
pub struct Crowd {
    /// By what they are known.
    pub test: StructureTest,
    /// Whether that is the payload.
    pub of_payload: bool,
}

/// The rows that are wild at a model fitted to all of them, each by itself. Unless `strict`, they
/// must stand out from structure that may be left, too.
///
/// # Errors
/// What stands out are no single rows.
pub fn single_rows(bench: &Bench<'_>, model: &Model, strict: bool) -> Result<Wild, Crowd> {
    let mut all = bench.rows.clone();
    all.left_out.fill(false);
    let (problem, _) = bench.regression.at(&model.solved.state, &bench.chosen(&model.named), &all);
    let payload = |row: usize| bench.prepared.data.rows[row].payload;
    let fitted = || problem.blocks.iter().flat_map(|block| block.rows.iter().copied());
    let many = |Many { rows, p }: Many| {
        let name = "more rows stand out than single ones do".to_string();
        Crowd { test: StructureTest { name, statistic: rows.len() as f64, p_value: p }, of_payload: false }
    };
    let wild = wild_rows(&problem, strict).map_err(many)?;
    let rows = fitted().count();
    let mean = fitted().map(payload).sum::<f64>() / rows as f64;
    let heavy = |row: &usize| payload(*row) > mean;
    let (weighty, of_wild) = (fitted().filter(heavy).count(), wild.rows.iter().filter(|row| heavy(row)).count());
    match as_heavy([rows, weighty], [wild.rows.len(), of_wild]) {
        Some(p_value) if p_value <= LEVEL => {
            let name = "the rows that stand out are those under payload".to_string();
            Err(Crowd { test: StructureTest { name, statistic: of_wild as f64, p_value }, of_payload: true })
        }
        _ => Ok(wild),
    }
}

/// How probable it is that so many or more of some rows are heavy, if they are any of all: how
/// many there are, and how many are heavy.
fn as_heavy([all, heavy]: [usize; 2], [some, of_some]: [usize; 2]) -> Option<f64> {
    let fewer = of_some.checked_sub(1)? as u64;
    Some(told(Hypergeometric::new(all as u64, heavy as u64, some as u64).ok()?.sf(fewer)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_are_heavy_as_combinations_say() {
        // All three of three, of six of which three are heavy: one of twenty choices.
        assert!((as_heavy([6, 3], [3, 3]).expect("a tail") - 0.05).abs() < 1e-12);
        assert!((as_heavy([6, 3], [3, 2]).expect("a tail") - 0.5).abs() < 1e-12);
        assert_eq!(as_heavy([6, 3], [3, 0]), None);
        assert_eq!(as_heavy([6, 6], [2, 2]), Some(1.0));
    }
}
