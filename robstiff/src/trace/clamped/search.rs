//! The search for effects on clamped axes.

use std::format;
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::axes::{Axes, OnAxes, OnAxesForm};
use crate::identify::normal::{Fit, Normal, Sign};
use crate::identify::problem::{Block, Problem};
use crate::identify::whitening::whiten;
use crate::trace::bootstrap::ScoreTest;
use crate::trace::catalogue::{Candidate, KINDS, Kind, Variant};
use crate::trace::found::Place;
use crate::trace::lack_of_fit::{LackOfFit, StructureTest};
use crate::trace::model::{Fitted, Named};
use crate::trace::selection::{Selection, Step, Tested, WITHIN_REACH};
use crate::trace::verdict::FEWEST_POSES;
use crate::trace::{Options, Progress};

/// Names beyond this are borrowed ones, where there are so few axes.
const MOST_EFFECTS: usize = 4;

/// How many of the best proposals are put to the tests in one step, and how
/// many are extended where none of them passes alone.
const PROPOSALS: usize = 3;
const EXTENDED: usize = 8;

/// A model that is better by this is worth another look: odds of e to one.
const BETTER: f64 = 2.0;

/// The level at which a row is wild, over all rows; and how far off it must be
/// while effects may be missing, in variances.
const WILD: f64 = 1e-3;
const STANDS_OUT: f64 = 150.0;

/// More than this share of the rows is no matter of single rows.
const FEW: f64 = 0.1;

/// The median of chi-square with one degree of freedom.
const MEDIAN: f64 = 0.4549;

/// Times that numbers out of grids are looked at in turn, how far from the grid's
/// value, and how finely, in logarithms.
const SWEEPS: usize = 2;
const REACH: f64 = 0.9;
const FINE: f64 = 0.02;

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

/// The rows with everything that may explain them.
pub struct Bench {
    /// The rows.
    pub axes: Axes,
    /// What may be missing.
    pub offers: Vec<(&'static Kind, OnAxes)>,
    /// The same as the tests have it.
    pub candidates: Vec<Candidate>,
    /// The sign of each column.
    pub signs: Vec<Sign>,
    /// The columns as measured; those of the loaded axes come first.
    pub raw: DMatrix<f64>,
    /// The regression, every row a block.
    pub problem: Problem,
    /// How many axes are loaded.
    pub base: usize,
}

impl Bench {
    /// The rows with what the catalogue does to them; forms keep the numbers out
    /// of grids that they had.
    fn new(axes: Axes, before: Option<&[(&'static Kind, OnAxes)]>) -> Self {
        let of = |kind: &&'static Kind| {
            let offers = kind.on_axes.map_or_else(Vec::new, |offer| offer(&axes));
            offers.into_iter().map(|one| (*kind, one)).collect::<Vec<_>>()
        };
        let mut offers: Vec<(&'static Kind, OnAxes)> = KINDS.iter().flat_map(of).collect();
        offers.retain(|(kind, one)| !axes.declares(kind.name, one.place));
        for ((_, one), (_, old)) in offers.iter_mut().zip(before.into_iter().flatten()) {
            one.forms.iter_mut().zip(&old.forms).for_each(|(form, old)| form.shape.clone_from(&old.shape));
        }
        let loaded: Vec<usize> = axes.loaded().collect();
        let torque = |&axis: &usize| super::axes_column(axes.rows.len(), &axes.rows_of(axis), axes.torques(axis));
        let mut columns: Vec<DVector<f64>> = loaded.iter().map(torque).collect();
        let mut signs = vec![Sign::Nonnegative; columns.len()];
        let mut candidates = Vec::new();
        for (kind, one) in &offers {
            let variant = |form: &OnAxesForm| {
                let first = columns.len();
                columns.extend((form.columns)(&form.values()));
                signs.extend(form.numbers.iter().map(|number| match number.range[0] >= 0.0 {
                    true => Sign::Nonnegative,
                    false => Sign::Free,
                }));
                Variant {
                    columns: (first..columns.len()).collect(),
                    parameters: form.numbers.len() + form.shape.len(),
                    shape: form.shape.clone(),
                    names: &[],
                    refine: None,
                    within: form.within,
                    likely: form.likely,
                }
            };
            let variants = one.forms.iter().map(variant).collect();
            candidates.push(Candidate { kind, place: one.place, variants, check: None });
        }
        let raw = DMatrix::from_columns(&columns);
        let problem = problem(&axes, raw.clone());
        Self { base: loaded.len(), axes, offers, candidates, signs, raw, problem }
    }

    /// The columns of a model.
    pub fn columns(&self, named: &[Named]) -> Vec<usize> {
        let effects = named.iter().flat_map(|one| &self.candidates[one.candidate].variants[one.variant].columns);
        (0..self.base).chain(effects.copied()).collect()
    }

    /// The form of a named effect.
    pub fn form(&self, one: Named) -> &OnAxesForm {
        &self.offers[one.candidate].1.forms[one.variant]
    }

    /// Fits a model; `None` where physics does not allow it.
    pub fn fit(&self, named: &[Named]) -> Option<Fitted> {
        let columns = self.columns(named);
        let signs: Vec<Sign> = columns.iter().map(|&column| self.signs[column]).collect();
        let fit = self.problem.total.solve_signed(&columns, &signs)?;
        let numbers = named.iter().flat_map(|&one| &self.form(one).numbers);
        let values = fit.coefficients.iter().skip(self.base);
        let physical = numbers.zip(values).all(|(number, &value)| number.range[0] < value && value < number.range[1]);
        let parameters = self.base + named.iter().map(|&one| self.variant(one).parameters).sum::<usize>();
        let rows = self.axes.rows.len() as f64;
        let bic = rows * (fit.rss / rows).max(f64::MIN_POSITIVE).ln() + parameters as f64 * rows.ln();
        physical.then(|| Fitted { named: named.to_vec(), fit, bic, physical })
    }

    fn variant(&self, one: Named) -> &Variant {
        &self.candidates[one.candidate].variants[one.variant]
    }

    fn test(&self, named: &[Named]) -> Option<ScoreTest> {
        ScoreTest::new(&self.problem, &self.candidates, &self.signs, self.base, &self.columns(named))
    }

    /// The root mean square of each row's residual by the fit without it (rad).
    pub fn left_out_rms(&self, fit: &Fit) -> f64 {
        let signs: Vec<Sign> = fit.columns.iter().map(|&column| self.signs[column]).collect();
        let squares = self.problem.blocks.iter().map(|block| {
            let without = self.problem.solve_without(block, &fit.columns, Some(&signs));
            let row = block.rows[0];
            let with = without.as_ref().unwrap_or(&fit.coefficients).iter();
            let fitted: f64 = fit.columns.iter().zip(with).map(|(&column, b)| self.raw[(row, column)] * b).sum();
            (self.problem.readings[row] - fitted).powi(2)
        });
        (squares.sum::<f64>() / self.problem.blocks.len() as f64).sqrt()
    }

    /// What a fit leaves of the rows (rad).
    pub fn residuals(&self, fit: &Fit) -> DVector<f64> {
        let mut left = self.problem.readings.clone();
        for (&column, &value) in fit.columns.iter().zip(fit.coefficients.iter()) {
            left.axpy(-value, &self.raw.column(column), 1.0);
        }
        left
    }

    /// The best model with one effect more, by candidate, the best first.
    fn extended(&self, named: &[Named]) -> Vec<Fitted> {
        let free = |candidate: &usize| named.iter().all(|one| one.candidate != *candidate);
        let best = |candidate: usize| {
            let with = |variant: usize| {
                let mut named = named.to_vec();
                named.push(Named { candidate, variant });
                named.sort_unstable();
                self.fit(&named)
            };
            let fits = (0..self.candidates[candidate].variants.len()).filter_map(with);
            fits.min_by(|a, b| a.bic.total_cmp(&b.bic))
        };
        let mut found: Vec<Fitted> = (0..self.candidates.len()).filter(free).filter_map(best).collect();
        found.sort_by(|a, b| a.bic.total_cmp(&b.bic));
        found
    }

    /// What a model could be taken for: every model with one effect replaced, with
    /// the index of that.
    pub fn replaced(&self, named: &[Named]) -> Vec<(usize, Fitted)> {
        let without = |k: usize| {
            let mut rest = named.to_vec();
            let one = rest.remove(k);
            let others = self.extended(&rest).into_iter();
            others.filter(move |other| !other.named.iter().any(|n| n.candidate == one.candidate)).map(move |m| (k, m))
        };
        (0..named.len()).flat_map(without).collect()
    }

    /// The family-wise p-value of each effect, that of the model without it;
    /// `None` where one of them is above the level.
    fn p_values(&self, named: &[Named], options: &Options) -> Option<Vec<f64>> {
        let one = |k: usize| {
            let mut rest = named.to_vec();
            let one = rest.remove(k);
            let test = self.test(&rest)?;
            let (statistic, _) = test.statistics()[one.candidate]?;
            Some(test.reference(options.draws, options.seed).p_value(statistic)).filter(|&p| p <= options.alpha)
        };
        (0..named.len()).map(one).collect()
    }

    /// The first of some models that passes every test.
    fn accepted(&self, proposals: &[Fitted], smaller: &Fitted, options: &Options) -> Option<(Fitted, Vec<f64>)> {
        let best = proposals.first()?.bic;
        let near = proposals.iter().take_while(|one| one.bic < best + WITHIN_REACH).take(PROPOSALS);
        let before = self.left_out_rms(&smaller.fit);
        let mut near = near.filter(|one| self.left_out_rms(&one.fit) < before);
        near.find_map(|one| Some((one.clone(), self.p_values(&one.named, options)?)))
    }

    /// The same with numbers out of grids where they fit best.
    fn polished(self, named: &[Named]) -> Self {
        let mut offers = self.offers.clone();
        let left = |offers: &[(&'static Kind, OnAxes)]| {
            let forms = named.iter().map(|one| &offers[one.candidate].1.forms[one.variant]);
            let columns = forms.flat_map(|form| (form.columns)(&form.values()));
            let base = (0..self.base).map(|k| self.raw.column(k).into_owned());
            let raw: Vec<DVector<f64>> = base.chain(columns).collect();
            let signs: Vec<Sign> = self.columns(named).iter().map(|&column| self.signs[column]).collect();
            let all: Vec<usize> = (0..raw.len()).collect();
            let total = problem(&self.axes, DMatrix::from_columns(&raw)).total;
            total.solve_signed(&all, &signs).map_or(f64::INFINITY, |fit| fit.rss)
        };
        let variance = left(&offers) / self.axes.rows.len() as f64;
        for _ in 0..SWEEPS {
            for one in named {
                for k in 0..self.form(*one).shape.len() {
                    let form = &offers[one.candidate].1.forms[one.variant];
                    let ([least, most], likely, at) = (form.within, form.likely, form.shape[k].value.ln());
                    let mut of = |log: f64| {
                        offers[one.candidate].1.forms[one.variant].shape[k].value = log.exp();
                        let unlikely = likely.map_or(0.0, |[middle, spread]| ((log - middle.ln()) / spread).powi(2));
                        left(&offers) + variance * unlikely
                    };
                    let (low, high) = ((at - REACH).max(least.ln()), (at + REACH).min(most.ln()));
                    let steps = ((high - low) / FINE).ceil().max(1.0) as usize;
                    let tried = (0..=steps).map(|k| low + (high - low) * k as f64 / steps as f64);
                    let best = tried.map(|log| (of(log), log)).min_by(|a, b| a.0.total_cmp(&b.0));
                    let better = best.filter(|(found, _)| *found < of(at)).map_or(at, |(_, log)| log);
                    of(better);
                }
            }
        }
        Self::new(self.axes, Some(&offers))
    }

    /// The same with the compliances of a fit in what effects do, which some
    /// depend on.
    fn with_compliances(self, fit: &Fit) -> Self {
        let mut axes = self.axes;
        let loaded: Vec<usize> = axes.loaded().collect();
        for (axis, &value) in loaded.into_iter().zip(fit.coefficients.iter()) {
            axes.compliance[axis - 1] = value;
        }
        Self::new(axes, Some(&self.offers))
    }
}

/// The regression of the rows on some columns.
pub fn problem(axes: &Axes, raw: DMatrix<f64>) -> Problem {
    let count = raw.ncols();
    let readings = DVector::from_iterator(axes.rows.len(), axes.rows.iter().map(|row| row.deflection));
    let mut white = raw.insert_column(count, 0.0);
    white.set_column(count, &readings);
    let visits: Vec<usize> = axes.rows.iter().map(|row| row.axis - 1).collect();
    whiten(&mut white, &visits, 1, 1.0);
    let white_readings = white.column(count).into_owned();
    let white = white.remove_column(count);
    let blocks = (0..axes.rows.len()).map(|row| Block { pose: row, rows: vec![row], stacked: vec![row] }).collect();
    let total = Normal::new(&white, &white_readings);
    Problem { readings, white, white_readings, axes: 1, shared: 1.0, blocks, held_out: Vec::new(), total }
}

/// Searches for effects.
///
/// # Errors
/// Why not even the axes' compliances can be fitted.
pub fn search(axes: Axes, options: &Options, progress: &Progress<'_>) -> Result<Found, String> {
    let every = axes.rows.clone();
    let all = every.len();
    let mut bench = Bench::new(axes, None);
    let none = || String::from("these rows show no axis's compliance");
    let base = bench.fit(&[]).ok_or_else(none)?;
    if let Some(why) = too_little(&bench) {
        let selection = Selection { model: base, p_values: Vec::new(), steps: Vec::new(), unnamed: false };
        let left = LackOfFit { tests: Vec::new(), structure: false, fraction: 0.0, depends_on: Vec::new() };
        return Ok(Found { bench, selection, left, wild: (Vec::new(), 1.0), too_little: Some(why) });
    }
    let mut wild: (Vec<usize>, f64) = (Vec::new(), 0.0);
    let (mut model, mut p_values, mut steps, mut unnamed) = (base, Vec::new(), Vec::new(), false);
    let mut strict = false;
    loop {
        // Wild rows must not vote for an effect; those that were wild while one was
        // missing are looked at again once it is named.
        if !wild.0.is_empty() {
            wild = (Vec::new(), 0.0);
            bench = Bench::new(bench.axes.with_rows(every.clone()), Some(&bench.offers));
            model = bench.fit(&model.named).ok_or_else(none)?;
        }
        while let Some((row, p)) = worst(&bench, &model.fit, strict) {
            if (wild.0.len() + 1) as f64 > FEW * all as f64 {
                break;
            }
            wild = (wild.0, p.max(wild.1));
            let mut axes = bench.axes.clone();
            wild.0.push(axes.rows.remove(row).line);
            bench = Bench::new(axes, Some(&bench.offers));
            model = bench.fit(&model.named).or_else(|| bench.fit(&[])).ok_or_else(none)?;
        }
        if model.named.len() >= MOST_EFFECTS {
            break;
        }
        progress(&format!("searching for effect {}", model.named.len() + 1));
        let Some(test) = bench.test(&model.named) else { break };
        let reference = test.reference(options.draws, options.seed);
        let statistics = test.statistics();
        let smallest = statistics.iter().flatten().map(|(s, _)| reference.p_value(*s)).fold(1.0, f64::min);
        let mut step = table(&bench, &model, |candidate| {
            statistics[candidate].map(|(statistic, _)| (statistic, reference.p_value(statistic)))
        });
        if smallest > options.alpha {
            step.outcome = "nothing is missing significantly".to_string();
            steps.push(step);
            if strict {
                break;
            }
            // With structure accounted for, rows need stand out from noise alone.
            strict = true;
            if worst(&bench, &model.fit, strict).is_none() {
                break;
            }
            continue;
        }
        let single = bench.extended(&model.named);
        let accepted = bench.accepted(&single, &model, options).or_else(|| {
            let mut pairs: Vec<Fitted> =
                single.iter().take(EXTENDED).flat_map(|one| bench.extended(&one.named)).collect();
            pairs.sort_by(|a, b| a.bic.total_cmp(&b.bic));
            bench.accepted(&pairs, &model, options)
        });
        let Some((mut better, mut p)) = accepted else {
            unnamed = true;
            step.outcome = "something is missing, but no effect passes every test".to_string();
            steps.push(step);
            break;
        };
        let replaced = bench.replaced(&better.named).into_iter().map(|(_, model)| model);
        if let Some(other) = replaced.min_by(|a, b| a.bic.total_cmp(&b.bic)).filter(|o| o.bic < better.bic - BETTER)
            && let Some(of_other) = bench.p_values(&other.named, options)
        {
            (better, p) = (other, of_other);
        }
        bench = bench.polished(&better.named);
        let fine = bench.fit(&better.named).unwrap_or(better);
        bench = bench.with_compliances(&fine.fit);
        model = bench.fit(&fine.named).unwrap_or(fine);
        p_values = p;
        let names: Vec<String> = model.named.iter().map(|one| bench.candidates[one.candidate].name()).collect();
        step.outcome = format!("named {}", names.join(", "));
        for tested in step.candidates.iter_mut().filter(|tested| names.contains(&tested.name)) {
            tested.reason.clear();
        }
        steps.push(step);
    }
    p_values.resize(model.named.len(), 1.0);
    progress("looking for structure in what is left");
    let left = structure(&bench, &model, options);
    let selection = Selection { model, p_values, steps, unnamed };
    Ok(Found { bench, selection, left, wild, too_little: None })
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

/// The row that stands out most, if one does, with the probability of that.
fn worst(bench: &Bench, fit: &Fit, strict: bool) -> Option<(usize, f64)> {
    let residuals = bench.problem.white_residuals(&fit.columns, &fit.coefficients);
    let inverse = bench.problem.total.inverse(&fit.columns)?;
    let left = |row: usize| {
        let x = DVector::from_fn(fit.columns.len(), |k, _| bench.problem.white[(row, fit.columns[k])]);
        residuals[row].powi(2) / (1.0 - x.dot(&(&inverse * &x))).max(f64::EPSILON)
    };
    let all: Vec<f64> = (0..residuals.len()).map(left).collect();
    let mut sorted = all.clone();
    sorted.sort_by(f64::total_cmp);
    let variance = sorted[sorted.len() / 2] / MEDIAN;
    let (row, most) = all.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    let table = ChiSquared::new(1.0).ok()?;
    let p = all.len() as f64 * table.sf(most / variance);
    let stands_out = if strict { p <= WILD } else { *most > STANDS_OUT * variance };
    (variance > 0.0 && stands_out).then_some((row, p.min(1.0)))
}

fn table(bench: &Bench, model: &Fitted, tested: impl Fn(usize) -> Option<(f64, f64)>) -> Step {
    let fits = bench.extended(&model.named);
    let candidates = (0..bench.candidates.len()).map(|candidate| {
        let with = fits.iter().find(|fit| fit.named.iter().any(|one| one.candidate == candidate));
        let already = model.named.iter().any(|one| one.candidate == candidate);
        let statistic = tested(candidate);
        let reason = match (already, statistic.is_some() && with.is_some()) {
            (true, _) => "already named",
            (false, false) => "it explains nothing with numbers that are physically possible",
            (false, true) => "another explains more, or it is not significant",
        };
        Tested {
            name: bench.candidates[candidate].name(),
            statistic: statistic.map(|(statistic, _)| statistic),
            p_value: statistic.map_or(1.0, |(_, p)| p),
            bic: with.filter(|_| !already).map(|fit| fit.bic),
            left_out_rms: with.filter(|_| !already).map(|fit| bench.left_out_rms(&fit.fit)),
            reason: reason.to_string(),
        }
    });
    let name = |one: &Named| bench.candidates[one.candidate].name();
    Step { named: model.named.iter().map(name).collect(), candidates: candidates.collect(), outcome: String::new() }
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
            let variant = Variant {
                columns: vec![raw.len()],
                parameters: 1,
                shape: Vec::new(),
                names: &[],
                refine: None,
                within: [0.0, f64::INFINITY],
                likely: None,
            };
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
    let problem = problem(axes, DMatrix::from_columns(&raw));
    let null: Vec<usize> = (0..first).collect();
    let Some(test) = ScoreTest::new(&problem, &candidates, &signs, first, &null) else { return none };
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
    let mut depends_on: Vec<String> =
        found.iter().filter(|(_, p, _)| *p <= options.alpha).map(|(.., name)| name.clone()).collect();
    depends_on.dedup();
    let freedom = problem.freedom(&model.fit);
    LackOfFit {
        tests: vec![StructureTest { name: "what is left depends on torque or order".to_string(), statistic, p_value }],
        structure,
        fraction: if structure { (statistic / freedom).clamp(0.0, 1.0) } else { 0.0 },
        depends_on,
    }
}
