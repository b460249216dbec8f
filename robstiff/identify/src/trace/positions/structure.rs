//! Whether something is left in positions that no model of them says.
//!
//! What is left is held against [everything smooth](super::smooth) that an arm could do:
//! the largest statistic against its own distribution under random signs of whole poses,
//! as in the search. Its size is held against the noise, where that is declared, or
//! where the robot came to a pose again.

use std::collections::BTreeSet;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{DMatrix, Vector3};

use super::bench::{Bench, Model};
use super::crowd::{Crowd, single_rows};
use super::smooth::{PAYLOAD, everything};
use crate::campaign::Campaign;
use crate::identify::NoiseSource;
use crate::identify::normal::Sign;
use crate::probability::{chi_square_tail, fisher_tail, told};
use crate::trace::Options;
use crate::trace::bootstrap::ScoreTest;
use crate::trace::catalogue::{Candidate, KINDS, Variant};
use crate::trace::found::Place;
use crate::trace::lack_of_fit::{LackOfFit, StructureTest, draws};

/// With fewer degrees of freedom a variance says too little to judge a model by.
const FEWEST_REPEATED: f64 = 10.0;

/// What is left over what it should be: the share beyond noise, its probability under
/// noise alone, and the ratio of the variances.
struct Size {
    name: &'static str,
    /// The variance of a reading that it should be (m^2).
    noise: f64,
    beyond: f64,
    p_value: f64,
    ratio: f64,
}

/// Tests what a model leaves; `noise` is the one that is declared (m).
pub fn structure(bench: &Bench<'_>, model: &Model, noise: Option<f64>, options: &Options) -> LackOfFit {
    if model.leaves_nothing() {
        return LackOfFit::default();
    }
    let mut tests = Vec::new();
    let size = noise.and_then(|noise| against_declared(bench, model, noise)).or_else(|| against_repeated(bench, model));
    if let Some(Size { name, p_value, ratio, .. }) = size {
        tests.push(StructureTest { name: name.to_string(), statistic: ratio, p_value });
    }
    let found = resemblance(bench, model, options);
    if let Some(&(statistic, p_value, _)) = found.first() {
        let name = "what is left follows joints, payloads or the order".to_string();
        tests.push(StructureTest { name, statistic, p_value });
    }
    // Poses held out are asked at the same level.
    let held_out = usize::from(!model.solved.problem.held_out.is_empty());
    let level = options.alpha / (tests.len() + held_out).max(1) as f64;
    let mut structure = tests.iter().any(|test| test.p_value <= level);
    let crowd = single_rows(bench, model, true).err();
    structure |= crowd.is_some();
    let freedom = model.solved.problem.freedom(&model.solved.fit);
    let of_size = size.filter(|size| size.p_value <= level).map_or(0.0, |size| size.beyond);
    let of_largest = found.first().filter(|(_, p, _)| *p <= level).map_or(0.0, |(statistic, ..)| statistic / freedom);
    let mut depends_on: Vec<String> = Vec::new();
    for (_, p, of) in found {
        for column in of {
            if structure && p <= options.alpha && !depends_on.contains(&column) {
                depends_on.push(column);
            }
        }
    }
    if let Some(Crowd { test, of_payload }) = crowd {
        tests.push(test);
        if of_payload && !depends_on.iter().any(|column| column == PAYLOAD) {
            depends_on.push(PAYLOAD.to_string());
        }
    }
    LackOfFit { tests, structure, fraction: of_size.max(of_largest).clamp(0.0, 1.0), depends_on }
}

/// One sigma of a reading at a model (m), and where it is known from: as declared, or from visits of one
/// pose, where it has in it how well the robot comes back.
pub fn noise(campaign: &Campaign, bench: &Bench<'_>, model: &Model) -> (f64, NoiseSource) {
    if let Some(declared) = campaign.noise_of_reading() {
        return (declared, NoiseSource::of_declared(campaign));
    }
    match against_repeated(bench, model) {
        Some(size) => (size.noise.sqrt(), NoiseSource::Repetitions),
        None => (model.solved.problem.variance(&model.solved.fit).sqrt(), NoiseSource::Residuals),
    }
}

/// What is left against the noise that is declared, by chi-square. In that noise is by
/// what the robot misses a pose, which the rows of a visit have in common, so a visit
/// counts once.
fn against_declared(bench: &Bench<'_>, model: &Model, noise: f64) -> Option<Size> {
    let problem = &model.solved.problem;
    let rows: Vec<usize> = problem.blocks.iter().flat_map(|block| block.rows.iter().copied()).collect();
    let visits: BTreeSet<usize> = rows.iter().map(|&row| bench.prepared.data.rows[row].visit).collect();
    let share = visits.len() as f64 / rows.len() as f64;
    let freedom = share * problem.freedom(&model.solved.fit);
    let statistic = share * model.solved.fit.rss / (noise * noise);
    Some(Size {
        name: "residuals are larger than the noise",
        noise: noise * noise,
        beyond: 1.0 - freedom / statistic,
        p_value: told(chi_square_tail(statistic, freedom)?),
        ratio: statistic / freedom,
    })
}

/// What is left against what visits of one pose under one payload differ by, by
/// Fisher's F. The rows of a visit have in common where the robot came to, so a visit
/// counts once.
fn against_repeated(bench: &Bench<'_>, model: &Model) -> Option<Size> {
    let (problem, data) = (&model.solved.problem, bench.prepared.data);
    let residuals = problem.white_residuals(&model.solved.fit.columns, &model.solved.fit.coefficients);
    let (mut sum, mut count, mut visits) = (0.0, 0.0, 0.0);
    for block in problem.blocks.iter() {
        let mut rows = block.rows.clone();
        rows.sort_by(|&a, &b| data.rows[a].payload.total_cmp(&data.rows[b].payload));
        let mut most: f64 = 0.0;
        for alike in rows.chunk_by(|&a, &b| data.rows[a].payload == data.rows[b].payload) {
            let first = alike.iter().map(|&row| data.rows[row].visit).collect::<BTreeSet<usize>>().len();
            if first < alike.len() {
                // Readings of one visit say nothing of where the robot comes to.
                return None;
            }
            let left = |row: &usize| residuals.fixed_rows::<3>(3 * row).into_owned();
            let middle = alike.iter().map(left).sum::<Vector3<f64>>() / alike.len() as f64;
            sum += alike.iter().map(|row| (left(row) - middle).norm_squared()).sum::<f64>();
            count += 3.0 * (alike.len() - 1) as f64;
            most = most.max(3.0 * (alike.len() - 1) as f64);
        }
        visits += most;
    }
    let freedom = problem.freedom(&model.solved.fit) - count;
    if visits < FEWEST_REPEATED || freedom < 1.0 || sum <= 0.0 {
        return None;
    }
    let (pure, left) = (sum / count, (model.solved.fit.rss - sum) / freedom);
    let share = visits / count;
    Some(Size {
        name: "residuals are larger than what visits differ by",
        noise: pure,
        beyond: 1.0 - pure * problem.freedom(&model.solved.fit) / model.solved.fit.rss,
        p_value: told(fisher_tail(left / pure, [(freedom * share).max(1.0), visits])?),
        ratio: left / pure,
    })
}

/// Everything smooth with its statistic and its family-wise p-value, the largest
/// first.
fn resemblance(bench: &Bench<'_>, model: &Model, options: &Options) -> Vec<(f64, f64, Vec<String>)> {
    let all = everything(bench, model);
    let first = model.solved.fit.columns.len();
    let (mut columns, mut candidates) = (Vec::new(), Vec::new());
    for smooth in &all {
        let at = first + columns.len();
        let variant = Variant::new((at..at + smooth.columns.len()).collect(), Vec::new());
        columns.extend(smooth.columns.iter().cloned());
        let variants = std::vec![variant];
        candidates.push(Candidate { kind: KINDS[0], place: Place::Rig, variants, check: None });
    }
    if columns.is_empty() {
        return Vec::new();
    }
    let mut signs = model.solved.signs.clone();
    signs.resize(first + columns.len(), Sign::Free);
    let problem = bench.with_columns(model, &DMatrix::from_columns(&columns));
    let null: Vec<usize> = (0..first).collect();
    let Some(test) = ScoreTest::among(&problem, &candidates, &signs, first, &null) else { return Vec::new() };
    let reference = test.reference(draws(options), options.seed);
    let named = test.statistics().into_iter().zip(all);
    let mut found: Vec<(f64, f64, Vec<String>)> = named
        .filter_map(|(statistic, smooth)| Some((statistic?.0, reference.p_value(statistic?.0), smooth.of)))
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found
}
