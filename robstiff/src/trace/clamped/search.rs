//! The search for effects on clamped axes.

use std::format;
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::axes::Axes;
use super::bench::Bench;
use super::one_off::one_off;
use crate::identify::clamped::regression::problem;
use crate::identify::clamped::wild;
use crate::identify::covariance::outliers::FEW;
use crate::identify::normal::Sign;
use crate::trace::bootstrap::ScoreTest;
use crate::trace::catalogue::{Candidate, KINDS, Variant};
use crate::trace::found::Place;
use crate::trace::lack_of_fit::{LackOfFit, StructureTest};
use crate::trace::model::Fitted;
use crate::trace::selection::{Selection, insignificant};
use crate::trace::step::{Against, Step};
use crate::trace::verdict::FEWEST_POSES;
use crate::trace::{Options, Progress};

/// Names beyond this are borrowed ones, where there are so few axes.
const MOST_EFFECTS: usize = 4;

/// How many of the best are extended where none of them passes alone.
const EXTENDED: usize = 8;

/// A model that is better by this is worth another look: odds of e to one.
const BETTER: f64 = 2.0;

/// What was found.
pub struct Found {
    /// The regression of the final model.
    pub bench: Bench,
    /// The model and how it was come to.
    pub selection: Selection,
    /// What it leaves.
    pub left: LackOfFit,
    /// The lines of rows that are wild, with the probability of the likeliest.
    pub wild: (Vec<usize>, f64),
    /// Why the data cannot tell, if so.
    pub too_little: Option<String>,
}

/// Searches for effects.
///
/// # Errors
/// Why not even the axes' compliances can be fitted.
pub fn search(axes: Axes, options: &Options, progress: &Progress<'_>) -> Result<Found, String> {
    let all = axes.rows.len();
    let mut bench = Bench::new(axes, None);
    let none = || String::from("these rows show no axis's compliance");
    let base = bench.fit(&[]).ok_or_else(none)?;
    if let Some(why) = too_little(&bench) {
        let selection = Selection { model: base, p_values: Vec::new(), steps: Vec::new(), unnamed: false };
        let left = LackOfFit { tests: Vec::new(), structure: false, fraction: 0.0, depends_on: Vec::new() };
        return Ok(Found { bench, selection, left, wild: (Vec::new(), 1.0), too_little: Some(why) });
    }
    let mut wild: (Vec<usize>, f64) = (Vec::new(), 0.0);
    let (mut model, mut steps, mut unnamed) = (base, Vec::new(), false);
    let (mut strict, mut kept) = (false, false);
    loop {
        // Wild rows must not vote for an effect; those that were wild while one was
        // missing are looked at again once it is named. They stay out where physics
        // does not allow the model with them, or what they do has another name.
        if !wild.0.is_empty()
            && !kept
            && let Some(whole) = refitted(bench.axes.whole(), &bench, &model)
        {
            wild = (Vec::new(), 0.0);
            (bench, model) = whole;
        }
        let most = (FEW * all as f64).floor() as usize;
        while let Some((rows, p)) = wild_rows(&bench, &model, strict, most - wild.0.len()) {
            wild.1 = p.max(wild.1);
            wild.0.extend(rows.iter().map(|&row| bench.axes.rows[row].line));
            bench = Bench::new(bench.axes.without(&rows), Some(&bench.offers));
            let stands = bench.fit(&model.named);
            // A name that stood on the row would come back with it, time and again.
            kept |= stands.is_none();
            model = stands.or_else(|| bench.fit(&[])).ok_or_else(none)?;
        }
        if model.named.len() >= MOST_EFFECTS {
            break;
        }
        progress(&format!("searching for effect {}", model.named.len() + 1));
        let Some(test) = bench.test(&model.named) else { break };
        let reference = test.reference(options.draws, options.seed);
        let statistics = test.statistics();
        let smallest = statistics.iter().flatten().map(|(s, _)| reference.p_value(*s)).fold(1.0, f64::min);
        let single = bench.extended(&model.named);
        let mut step = Step::against(&bench.candidates, &model.named, |candidate| {
            let with = single.iter().find(|fit| fit.named.iter().any(|one| one.candidate == candidate));
            Against {
                gains: statistics[candidate].map(|(statistic, _)| (statistic, reference.p_value(statistic))),
                bic: with.map(|with| with.bic),
                left_out_rms: with.map(|with| bench.left_out_rms(&with.fit)),
            }
        });
        if smallest > options.alpha {
            step.outcome = "nothing is missing significantly".to_string();
            steps.push(step);
            if strict {
                break;
            }
            // With structure accounted for, rows need stand out from noise alone.
            strict = true;
            if wild_rows(&bench, &model, strict, most - wild.0.len()).is_none() {
                break;
            }
            continue;
        }
        let accepted = bench.accepted(&single, &model, options).or_else(|| {
            let mut pairs: Vec<Fitted> =
                single.iter().take(EXTENDED).flat_map(|one| bench.extended(&one.named)).collect();
            pairs.sort_by(|a, b| a.bic.total_cmp(&b.bic));
            bench.accepted(&pairs, &model, options)
        });
        // What a single row says better needs no effect.
        let off = one_off(&bench, &model).filter(|off| off.p <= options.alpha && wild.0.len() < most);
        if let Some(off) = off.filter(|off| off.bic < accepted.as_ref().map_or(model.bic, |better| better.bic)) {
            let axes = bench.axes.without(&[off.row]);
            if let Some((without, fitted)) = refitted(axes, &bench, &model) {
                wild.0.push(bench.axes.rows[off.row].line);
                wild.1 = off.p.max(wild.1);
                step.outcome = format!("line {} alone says as much", bench.axes.rows[off.row].line);
                steps.push(step);
                (bench, model, kept) = (without, fitted, true);
                continue;
            }
        }
        let Some(mut better) = accepted else {
            unnamed = true;
            step.outcome = "something is missing, but no effect passes every test".to_string();
            steps.push(step);
            break;
        };
        let replaced = bench.replaced(&better.named).into_iter().map(|(_, model)| model);
        if let Some(other) = replaced.min_by(|a, b| a.bic.total_cmp(&b.bic)).filter(|o| o.bic < better.bic - BETTER)
            && bench.is_significant(&other.named, options)
        {
            better = other;
        }
        bench = bench.polished(&better.named);
        let fine = bench.fit(&better.named).unwrap_or(better);
        bench = bench.with_compliances(&fine.fit);
        model = bench.fit(&fine.named).unwrap_or(fine);
        let names: Vec<String> = model.named.iter().map(|one| bench.candidates[one.candidate].name()).collect();
        step.came_to(&names);
        steps.push(step);
    }
    let (model, p_values) = significant(&bench, model, options);
    progress("looking for structure in what is left");
    let left = structure(&bench, &model, options);
    let selection = Selection { model, p_values, steps, unnamed };
    Ok(Found { bench, selection, left, wild, too_little: None })
}

/// The model with the p-value of each effect, without those that rows which are left out
/// by now, or effects named since, had made significant.
fn significant(bench: &Bench, mut model: Fitted, options: &Options) -> (Fitted, Vec<f64>) {
    loop {
        let p_values = bench.p_values(&model.named, options);
        let Some(worst) = insignificant(&p_values, options) else { return (model, p_values) };
        let mut rest = model.named.clone();
        rest.remove(worst);
        let Some(smaller) = bench.fit(&rest) else { return (model, p_values) };
        model = smaller;
    }
}

/// The rows that are wild beside a model, with the probability of the likeliest.
fn wild_rows(bench: &Bench, model: &Fitted, strict: bool, most: usize) -> Option<(Vec<usize>, f64)> {
    wild::wild_rows(&bench.axes.rows, &bench.raw.select_columns(&model.fit.columns), strict, most)
}

/// The same model on other rows.
fn refitted(axes: Axes, bench: &Bench, model: &Fitted) -> Option<(Bench, Fitted)> {
    let other = Bench::new(axes, Some(&bench.offers));
    let fitted = other.fit(&model.named)?;
    Some((other, fitted))
}

/// Why rows cannot tell what is missing, if so: every row is a witness.
fn too_little(bench: &Bench) -> Option<String> {
    let (rows, numbers) = (bench.axes.rows.len(), bench.base);
    (rows < FEWEST_POSES.max(3 * numbers)).then(|| {
        format!(
            "{rows} rows are too few to judge {numbers} axes by, at least {} are needed",
            FEWEST_POSES.max(3 * numbers)
        )
    })
}

/// Whether what is left depends on the torque, by any smooth curve, or on the
/// order of rows, of any axis.
fn structure(bench: &Bench, model: &Fitted, options: &Options) -> LackOfFit {
    let columns = bench.columns(&model.named);
    let mut raw: Vec<DVector<f64>> = columns.iter().map(|&column| bench.raw.column(column).into_owned()).collect();
    let mut signs: Vec<Sign> = columns.iter().map(|&column| bench.signs[column]).collect();
    let (first, axes) = (raw.len(), &bench.axes);
    let (mut candidates, mut names) = (Vec::new(), Vec::new());
    for axis in axes.loaded() {
        let (rows, torques, largest) = (axes.rows_of(axis), axes.torques(axis), axes.largest(axis));
        let mut add = |name: String, values: Vec<f64>| {
            let variant = Variant::new(vec![raw.len()], Vec::new());
            raw.push(super::axes_column(axes.rows.len(), &rows, values));
            signs.push(Sign::Free);
            candidates.push(Candidate { kind: KINDS[0], place: Place::Rig, variants: vec![variant], check: None });
            names.push(name);
        };
        let of = |law: fn(f64) -> f64| torques.iter().map(|torque| law(torque / largest)).collect::<Vec<f64>>();
        for law in [|t: f64| t * t.abs(), |t: f64| t * t * t, f64::abs, |t: f64| t / t.hypot(0.1)] {
            add(format!("torque of axis {axis}"), of(law));
        }
        add(format!("row order of axis {axis}"), (0..rows.len()).map(|k| k as f64).collect());
    }
    let none = LackOfFit { tests: Vec::new(), structure: false, fraction: 0.0, depends_on: Vec::new() };
    let problem = problem(&axes.rows, DMatrix::from_columns(&raw));
    let null: Vec<usize> = (0..first).collect();
    let Some(test) = ScoreTest::among(&problem, &candidates, &signs, first, &null) else { return none };
    let reference = test.reference(options.draws, options.seed);
    let mut found: Vec<(f64, f64, String)> = test
        .statistics()
        .into_iter()
        .zip(names)
        .filter_map(|(statistic, name)| Some((statistic?.0, reference.p_value(statistic?.0), name)))
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
