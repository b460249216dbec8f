//! What the data cannot tell a named effect from.

use std::string::String;
use std::vec::Vec;

use super::Options;
use super::model::{Fitted, Named, Setting};
use super::selection::{Tests, WITHIN_REACH, best_with, score_test};

/// Columns that differ by less than this fraction of their energy, once the
/// rest of the model is fitted again, are the same but for rounding in the
/// poses: exact aliases.
const EXACT: f64 = 1e-6;

/// A rival whose misfit per pose differs from the named effect's by less than
/// this many standard errors is not told from it by the poses (Vuong,
/// Econometrica 57, 1989, one-sided at 1 %). With structure left, rows of a
/// pose agree on the better name for reasons that have nothing to do with it,
/// and the criterion is too sure; poses are independent witnesses.
const WITNESSES: f64 = 2.33;

/// The names of what the data cannot tell effect `k` of a model from: exact
/// aliases, and rivals that would have been accepted in its place and fit
/// about as well. The best fitting first.
pub fn same_as(setting: &Setting, model: &Fitted, k: usize, options: &Options) -> Vec<String> {
    let mut rest = model.named.clone();
    let one = rest.remove(k);
    let (Some(test), Some(tests)) = (score_test(setting, &rest), Tests::against(setting, &rest, options)) else {
        return Vec::new();
    };
    let Ok(without) = setting.fit(&rest) else { return Vec::new() };
    let unseen = setting.left_out_rms(&without.fit);
    let mut found: Vec<(f64, String)> = Vec::new();
    for candidate in (0..setting.candidates.len()).filter(|&candidate| candidate != one.candidate) {
        let Some(rival) = best_with(setting, &rest, candidate) else { continue };
        let variant = variant_of(&rival, candidate);
        let exact = test.distance(setting.variant(one), setting.variant(variant)) < EXACT;
        let admitted = tests.p_value(candidate) <= options.alpha && setting.left_out_rms(&rival.fit) < unseen;
        let near = rival.bic - model.bic < WITHIN_REACH || witnesses(setting, model, &rival) < WITNESSES;
        if exact || (admitted && near) {
            found.push((rival.bic, setting.candidates[candidate].name()));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, name)| name).collect()
}

fn variant_of(model: &Fitted, candidate: usize) -> Named {
    let named = model.named.iter().find(|one| one.candidate == candidate);
    *named.expect("the rival is in its own model")
}

/// By how many standard errors the rival's misfit per pose exceeds the
/// model's.
fn witnesses(setting: &Setting, model: &Fitted, rival: &Fitted) -> f64 {
    let (of_model, of_rival) = (setting.deviances(&model.fit), setting.deviances(&rival.fit));
    let differences: Vec<f64> = of_rival.iter().zip(&of_model).map(|(rival, model)| rival - model).collect();
    let count = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / count;
    let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    mean / (variance / count).sqrt().max(f64::MIN_POSITIVE)
}
