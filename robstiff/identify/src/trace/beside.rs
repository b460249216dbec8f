//! What is named beside the classes: what is in every set, and stands out all the same.

use super::NamedEffect;
use super::found::Found as Effect;
use crate::effects::{Number, Place, kind_of};
use crate::fit::case::Case;
use crate::judge::thresholds::{OUTLYING_ROWS, STANDS_OUT};
use crate::model::{Size, Term};
use crate::probability::chi_square_tail;
use crate::select::always::REFLECTOR;
use crate::select::engine::Engine;
use crate::select::layout::Columns;
use crate::select::passes::Found;
use crate::select::unseen::Unseen;

/// The reflector of absolute positions, where it is elsewhere than the file says. It is always fitted, so
/// no set does without it: what counts is how far from zero it comes out.
pub fn reflector(found: &Found, unseen: &Unseen<'_>) -> Option<NamedEffect> {
    let fit = &found.own.fit;
    let noise = fit.variance.sqrt();
    let of = |(k, name): (usize, &'static str)| {
        let column = found.layout.always().find(|&column| found.layout.parameters[column].name == REFLECTOR[k])?;
        let at = fit.place(column)?;
        Some(Number { name, value: fit.mean[at], std: Some(fit.std[at]), unit: "m" })
    };
    let numbers: Vec<Number> = ["x", "y", "z"].into_iter().enumerate().filter_map(of).collect();
    let sigmas = |number: &Number| number.value.abs() / number.std.unwrap_or(f64::INFINITY);
    let most = numbers.iter().filter(|number| number.value.abs() > noise).map(sigmas).fold(0.0, f64::max);
    if most < STANDS_OUT {
        return None;
    }
    let effect = Effect::new(kind_of("reflector_offset")?, Place::Rig, numbers, Vec::new());
    Some(NamedEffect {
        class: [effect.to_string()].into_iter().chain(twins(found)).map(|name| (name, 1.0)).collect(),
        effect,
        lines: Vec::new(),
        probability: 1.0 - chi_square_tail(most * most, 1.0).unwrap_or(0.0),
        recurs: 1.0,
        holdout_rms: unseen.rms(&found.best, found.kappa).unwrap_or_default(),
        partial: false,
    })
}

/// Full names of what moves the readings as the reflector does: numbers of the last row of the table.
fn twins(found: &Found) -> Vec<String> {
    let layout = &found.layout;
    let is_flat = |k: &usize| matches!(layout.parameters[*k].size, Size::Flat(_));
    let stand: Vec<usize> = layout.always().filter(is_flat).collect();
    let reflector = layout.always().filter(|k| REFLECTOR.contains(&layout.parameters[*k].name));
    let both: Vec<usize> = stand.iter().copied().chain(reflector).collect();
    let left = |column: usize, others: &[usize]| found.grams[0].left_of(column, others).unwrap_or(f64::INFINITY);
    let is_twin = |form: &&Columns| match form.columns[..] {
        [column] if matches!(layout.parameters[column].term, Term::Table(..)) => {
            left(column, &both) < TWIN * left(column, &stand)
        }
        _ => false,
    };
    layout.forms.iter().filter(is_twin).map(|form| layout.candidates[form.candidate].name()).collect()
}

/// What leaves less than this part of its squares is no other.
const TWIN: f64 = 1e-3;

/// Rows that do not belong to the others, where they are few and far off: not the tail of the others.
pub fn outliers(engine: &Engine<'_>, (found, unseen): (&Found, &Unseen<'_>), case: &Case<'_>) -> Option<NamedEffect> {
    let readings = case.observation.readings();
    let rows = engine.noise.apart.rows();
    let fitted = case.rows(true).len();
    if rows.is_empty() || (rows.len() as f64) < OUTLYING_ROWS * fitted as f64 {
        return None;
    }
    let name = "outliers@rig".to_owned();
    Some(NamedEffect {
        effect: Effect::outliers(rows.len()),
        lines: rows.iter().map(|&row| readings.lines[row]).collect(),
        probability: engine.noise.apart.probability(),
        class: vec![(name, 1.0)],
        recurs: 1.0,
        holdout_rms: unseen.rms(&found.best, found.kappa).unwrap_or_default(),
        partial: false,
    })
}
