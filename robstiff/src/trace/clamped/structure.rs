//! Is there structure left in the readings of clamped axes?

use core::f64::consts::PI;
use std::format;
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::axes::axes_column;
use super::bench::Bench;
use crate::identify::clamped::regression::problem;
use crate::identify::normal::Sign;
use crate::trace::Options;
use crate::trace::bootstrap::ScoreTest;
use crate::trace::catalogue::{Candidate, KINDS, Variant};
use crate::trace::found::Place;
use crate::trace::lack_of_fit::{LackOfFit, StructureTest};
use crate::trace::model::Fitted;

/// So many waves between the largest torques of both signs, at most, a curve may have that is
/// looked for.
const WAVES: u8 = 4;

/// Whether what is left depends on the torque, by any smooth curve, or on the
/// order of rows, by a straight line or a step, of any axis, or is the same in all its rows.
pub fn structure(bench: &Bench, model: &Fitted, options: &Options) -> LackOfFit {
    let none = LackOfFit::default();
    if bench.leaves_nothing(&model.fit) {
        return none;
    }
    let columns = bench.columns(&model.named);
    let mut raw: Vec<DVector<f64>> = columns.iter().map(|&column| bench.raw.column(column).into_owned()).collect();
    let mut signs: Vec<Sign> = columns.iter().map(|&column| bench.signs[column]).collect();
    let (first, axes) = (raw.len(), &bench.axes);
    let (mut candidates, mut names) = (Vec::new(), Vec::new());
    for axis in axes.loaded() {
        let (rows, torques, largest) = (axes.rows_of(axis), axes.torques(axis), axes.largest(axis));
        // Each with the number of its parameters.
        let mut add = |name: String, forms: Vec<(Vec<f64>, usize)>| {
            let variant = |(values, parameters): (Vec<f64>, usize)| {
                raw.push(axes_column(axes.rows.len(), &rows, values));
                signs.push(Sign::Free);
                Variant { parameters, ..Variant::new(vec![raw.len() - 1], Vec::new()) }
            };
            let variants = forms.into_iter().map(variant).collect();
            candidates.push(Candidate { kind: KINDS[0], place: Place::Rig, variants, check: None });
            names.push((name, axes.rounding[axis - 1]));
        };
        let mut depends = |law: &dyn Fn(f64) -> f64| {
            let values = torques.iter().map(|torque| law(torque / largest)).collect();
            add(format!("torque of axis {axis}"), vec![(values, 1)]);
        };
        for law in [|t: f64| t * t.abs(), |t: f64| t * t * t, f64::abs, |t: f64| t / t.hypot(0.1)] {
            depends(&law);
        }
        for waves in (1..=WAVES).map(|waves| f64::from(waves) * PI) {
            depends(&|t| (waves * t).sin());
            depends(&|t| (waves * t).cos());
        }
        add(format!("unloaded reading of axis {axis}"), vec![(vec![1.0; rows.len()], 1)]);
        let order = |of: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..rows.len()).map(of).collect() };
        // A drift, or a slip before some row, which is a number as well. One row alone is a wild one.
        let drift = (order(&|k| k as f64), 1);
        let slip = |from: usize| (order(&|k| f64::from(u8::from(k >= from))), 2);
        let slips = (2..rows.len().saturating_sub(1)).map(slip);
        add(format!("row order of axis {axis}"), slips.chain([drift]).collect());
        // Or the compliance is another from some row on, or in the course of the rows.
        let loaded = |of: &dyn Fn(usize) -> f64| order(&|k| torques[k] / largest * of(k));
        let another = |from: usize| (loaded(&|k| f64::from(u8::from(k >= from))), 2);
        let others = (2..rows.len().saturating_sub(1)).map(another);
        add(format!("compliance of axis {axis} by row order"), others.chain([(loaded(&|k| k as f64), 1)]).collect());
    }
    let problem = problem(&axes.rows, DMatrix::from_columns(&raw));
    let null: Vec<usize> = (0..first).collect();
    let Some(test) = ScoreTest::among(&problem, &candidates, &signs, first, &null) else { return none };
    let reference = test.reference(options.draws, options.seed);
    let mut found: Vec<(f64, f64, String)> = test
        .statistics()
        .into_iter()
        .zip(candidates.iter().zip(names))
        .filter_map(|(found, (candidate, (name, rounding)))| {
            let (statistic, variant) = found?;
            // Rows of one torque are rounded alike, which is a curve of it.
            let statistic = test.against(statistic, &candidate.variants[variant], rounding);
            Some((statistic, reference.p_value(statistic), name))
        })
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let Some(&(statistic, p_value, _)) = found.first() else { return none };
    let structure = p_value <= options.alpha;
    // Several laws of an axis have one name.
    let mut depends_on: Vec<String> = Vec::new();
    for (_, p, name) in &found {
        if *p <= options.alpha && !depends_on.contains(name) {
            depends_on.push(name.clone());
        }
    }
    let freedom = problem.freedom(&model.fit);
    LackOfFit {
        tests: vec![StructureTest { name: "what is left depends on torque or order".to_string(), statistic, p_value }],
        structure,
        fraction: if structure { (statistic / freedom).clamp(0.0, 1.0) } else { 0.0 },
        depends_on,
    }
}
