//! Is there structure left in the readings of clamped axes?

use core::f64::consts::PI;
use std::format;
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::axes::{Axes, axes_column};
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

/// What is left of an axis may follow this.
struct Curve {
    /// What it would depend on.
    depends_on: String,
    /// Over the rows of the axis, each with the number of its parameters.
    forms: Vec<(Vec<f64>, usize)>,
}

/// The curves that are looked for on an axis.
fn curves(axes: &Axes, axis: usize) -> Vec<Curve> {
    let (torques, largest) = (axes.torques(axis), axes.largest(axis));
    let over_rows = |of: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..torques.len()).map(of).collect() };
    let of_torque = |law: &dyn Fn(f64) -> f64| {
        let forms = vec![(over_rows(&|k| law(torques[k] / largest)), 1)];
        Curve { depends_on: format!("torque of axis {axis}"), forms }
    };
    let bent = [|t: f64| t * t.abs(), |t: f64| t * t * t, f64::abs, |t: f64| t / t.hypot(0.1)];
    let mut curves: Vec<Curve> = bent.iter().map(|law| of_torque(law)).collect();
    for waves in (1..=WAVES).map(|waves| f64::from(waves) * PI) {
        curves.push(of_torque(&|t| (waves * t).sin()));
        curves.push(of_torque(&|t| (waves * t).cos()));
    }
    curves.push(Curve {
        depends_on: format!("unloaded reading of axis {axis}"),
        forms: vec![(vec![1.0; torques.len()], 1)],
    });
    // A drift, or a slip before some row, which is a number as well. One row alone is a wild one.
    let rows = || 2..torques.len().saturating_sub(1);
    let since = |from: usize| move |k: usize| f64::from(u8::from(k >= from));
    let slips = rows().map(|from| (over_rows(&since(from)), 2));
    let drift = (over_rows(&|k| k as f64), 1);
    curves.push(Curve { depends_on: format!("row order of axis {axis}"), forms: slips.chain([drift]).collect() });
    // Or the compliance is another from some row on, or in the course of the rows.
    let load = |k: usize| torques[k] / largest;
    let another = rows().map(|from| (over_rows(&|k| load(k) * since(from)(k)), 2));
    let in_course = (over_rows(&|k| load(k) * k as f64), 1);
    curves.push(Curve {
        depends_on: format!("compliance of axis {axis} by row order"),
        forms: another.chain([in_course]).collect(),
    });
    curves
}

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
        let rows = axes.rows_of(axis);
        for Curve { depends_on, forms } in curves(axes, axis) {
            let variant = |(values, parameters): (Vec<f64>, usize)| {
                raw.push(axes_column(axes.rows.len(), &rows, values));
                signs.push(Sign::Free);
                Variant { parameters, ..Variant::new(vec![raw.len() - 1], Vec::new()) }
            };
            let variants = forms.into_iter().map(variant).collect();
            candidates.push(Candidate { kind: KINDS[0], place: Place::Rig, variants, check: None });
            names.push((depends_on, axes.rounding[axis - 1]));
        }
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
