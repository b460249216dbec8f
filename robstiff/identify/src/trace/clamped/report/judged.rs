//! The verdict, with what only clamped axes have against one.

use std::format;
use std::string::{String, ToString};

use super::errors::rms;
use super::named::slip;
use crate::trace::clamped::alike::is_mixed;
use crate::trace::clamped::bench::Bench;
use crate::trace::clamped::search::Found as Searched;
use crate::trace::clamped::slips::shifts_all;
use crate::trace::model::Fitted;
use crate::trace::verdict::{self, Besides};
use crate::trace::{NamedEffect, Verdict};

/// The verdict and why. `apart`: whether what all axes share and what each has of its own account
/// for the readings alike; `alike`: whether gears that all lag and gears that all creep do; `exceeded`:
/// that more is left than noise, if so.
pub fn judged(found: &Searched, apart: bool, alike: bool, exceeded: Option<String>) -> (Verdict, String) {
    if let Some(why) = &found.too_little {
        return (Verdict::Insufficient, why.clone());
    }
    let (bench, model) = (&found.bench, &found.selection.model);
    let besides = Besides { isolated: usize::from(!found.wild.0.is_empty()), ..Besides::default() };
    let judged = verdict::judge(&found.selection, &found.left, &besides);
    let against = apart
        .then(told_apart)
        .or_else(|| mixed(bench, model, alike))
        .or_else(|| off(bench, model))
        .or_else(|| many(bench))
        .or(exceeded);
    match (judged.0, against) {
        (Verdict::Adequate, Some(why)) => (Verdict::Unexplained, why),
        (Verdict::Explained, Some(why)) => (Verdict::Partial, why),
        _ => judged,
    }
}

fn told_apart() -> String {
    String::from("what all axes share and what each has of its own account for the readings alike")
}

/// Why gears that lag and gears that creep are not told from each other.
fn mixed(bench: &Bench, model: &Fitted, alike: bool) -> Option<String> {
    if is_mixed(bench, model) {
        return Some(String::from("gears that all lag, or all creep, look as if some did the one and some the other"));
    }
    alike.then(|| String::from("a gear that lags and one that creeps account for the readings alike"))
}

/// What is left in readings as they are, over the noise that rows have to themselves, is more than
/// an unloaded reading as noisy as others lets it be.
const SEVERAL: f64 = 4.0;

/// What is off where more is left than noise: all rows of an axis are, which share one
/// unloaded reading.
fn off(bench: &Bench, model: &Fitted) -> Option<String> {
    let left = bench.residuals(&model.fit);
    let noise = bench.problem.variance(&model.fit).sqrt();
    let of_axis = |axis: &usize| rms(&left.select_rows(&bench.axes.rows_of(*axis)));
    let axis = bench.axes.loaded().max_by(|a, b| of_axis(a).total_cmp(&of_axis(b)))?;
    let is_noise = bench.leaves_nothing(&model.fit) || of_axis(&axis) <= SEVERAL * noise;
    (!is_noise).then(|| format!("what is left of axis {axis} is several times the noise: its unloaded reading is off"))
}

/// Of an axis more than this share of the rows, and more than two, are wild for a reason.
const MANY: f64 = 0.15;
const TWO: usize = 2;

/// Which axis has too many wild rows for single accidents.
fn many(bench: &Bench) -> Option<String> {
    let whole = bench.axes.whole();
    bench.axes.loaded().find_map(|axis| {
        let wild = bench.axes.left_out().filter(|row| row.axis == axis).count();
        let rows = whole.rows_of(axis).len();
        let many = wild > TWO && wild as f64 > MANY * rows as f64;
        many.then(|| format!("{wild} of {rows} rows of axis {axis} are wild: they have something in common"))
    })
}

/// How many unloaded readings are off before one more is the likeliest of what looks like it.
const SEVERAL_OFF: usize = 2;

/// Which effect one more unloaded reading that is off may look like, where several are.
pub fn one_more_is_off(bench: &Bench, model: &Fitted, effects: &[NamedEffect]) -> Option<String> {
    let off = model.named.iter().filter(|&&one| shifts_all(bench, one)).count();
    let slip = slip();
    let other = effects.iter().find(|named| named.effect.to_string() != slip && named.same_as.contains(&slip))?;
    (off >= SEVERAL_OFF).then(|| {
        format!("the unloaded readings of several axes are off, and {} may be one more of them", other.effect.words())
    })
}
