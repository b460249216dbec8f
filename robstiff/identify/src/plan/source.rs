//! What planning goes on from: the regression of a campaign where its trace ended.
//!
//! The model has the numbers that are always fitted, and the effects that were named. The block of
//! waves without a name has hundreds of numbers and moves little, and what depends on when something
//! is read has nothing to do with poses and loads. Both are fitted to the campaign with the others, and
//! held where they are afterwards.

use nalgebra::DMatrix;

use super::rivals::{Group, Number, Rival, Rivals, computed, is_of_time, pairs};
use crate::effects::Candidate;
use crate::identify::Error;
use crate::model::{Parameter, Size, Term};
use crate::select::always::{BLOCK, TABLE};
use crate::select::{Engine, Layout, Problem};
use crate::trace::Trace;

/// The numbers that planning looks at, and what is known of them.
pub struct Source {
    /// The parameters that are not zero, and those that planning looks at.
    pub parameters: Vec<Parameter>,
    /// Their values.
    pub values: Vec<f64>,
    /// The numbers that planning looks at, by their parameter.
    pub kept: Vec<usize>,
    /// Their information from the campaign and from what is likely, over that of one reading.
    pub known: DMatrix<f64>,
    /// That from what is likely alone.
    pub likely: DMatrix<f64>,
    /// The variance of one reading (m^2).
    pub variance: f64,
    /// Who rivals whom; columns are places in [`kept`](Self::kept).
    pub rivals: Rivals,
}

/// A number of the table is one of the model if the campaign brings its uncertainty below this part of
/// what it was before; others are not what a calibration asks for.
const SEEN: f64 = 0.5;

impl Source {
    /// Of a campaign at the end of its trace, under a discrepancy, with groups of rivals. `best` are the
    /// forms that the trace found.
    ///
    /// # Errors
    /// A campaign that does not show the model's numbers.
    pub fn new(
        engine: &Engine<'_>,
        (kappa, best): (usize, &[(String, String)]),
        trace: &Trace,
        groups: &[Group],
    ) -> Result<Self, Error> {
        let layout = wanted(engine, trace, groups);
        let (_, problem) = engine.problem_here(&layout);
        let gram = problem.grams[kappa].matrix.clone();
        let forms = Forms { layout: &layout, problem: &problem, kappa, best };
        let found = found(&forms, trace);
        let set = sorted(found.iter().map(|of| of.form));
        let hidden = || Error::NotShown("these data do not show the numbers that a plan is made for".into());
        let fit = problem.fit(&set, kappa).ok_or_else(hidden)?;
        let (mut away, always): (Vec<usize>, Vec<usize>) = layout.always().partition(|&k| is_of_block(&layout, k));
        let (of_time, found): (Vec<InModel>, Vec<InModel>) = found.into_iter().partition(|of| is_of_time(&of.name));
        away.extend(of_time.iter().flat_map(|of| &layout.forms[of.form].columns));
        let of_time: Vec<usize> = of_time.iter().map(|of| of.form).collect();
        let mut places = Places { columns: always.clone() };
        let mut model = Vec::new();
        for &k in &always {
            let parameter = &layout.parameters[k];
            let at = fit.place(k);
            let name = match parameter.term {
                Term::Table(joint, number) => {
                    let prior = sd(&problem, k);
                    let is_seen = at.is_some_and(|at| fit.std[at] < SEEN * prior);
                    is_seen.then(|| of_table(joint, number))
                }
                // The description's own numbers come first.
                _ => trace.estimates.get(k - layout.fixed).map(|estimate| estimate.name.clone()),
            };
            if let Some(name) = name {
                let value = at.map_or(parameter.mean, |at| fit.mean[at]);
                model.push(Number { column: places.of(k), name, unit: parameter.unit, value });
            }
        }
        let mut effects = Vec::new();
        for of in found.iter().filter(|of| of.is_named) {
            let own = &layout.forms[of.form].columns;
            for &k in own {
                let parameter = &layout.parameters[k];
                let name = if own.len() == 1 { of.name.clone() } else { format!("{} {}", of.name, parameter.name) };
                let column = places.of(k);
                effects.push(column);
                model.push(Number { column, name, unit: parameter.unit, value: fit.value(k) });
            }
        }
        let mut contests = Vec::new();
        for Group { names, .. } in groups {
            let beside: Vec<usize> = found.iter().filter(|of| !names.contains(&of.name)).map(|of| of.form).collect();
            let core: Vec<usize> = always.iter().copied().chain(problem.columns(&beside)).collect();
            let core = places.all(&core);
            let beside = sorted(beside.into_iter().chain(of_time.iter().copied()));
            let rival = |name: &String| {
                let form = forms.of(name, &beside)?;
                let fit = problem.fit(&sorted(beside.iter().copied().chain([form])), kappa)?;
                let own = &layout.forms[form];
                let shape = layout.candidates[own.candidate].forms[own.form].shape.len();
                let values = own.columns.iter().map(|&k| fit.value(k)).collect();
                let columns = places.all(&own.columns);
                Some((name.clone(), Rival { columns, values, parameters: own.columns.len() + shape }))
            };
            let rivals: Vec<(String, Rival)> = computed(names).filter_map(rival).collect();
            contests.extend(pairs(&rivals, &core));
        }
        let kept = places.columns;
        let is_asked = |column: &usize| model.iter().any(|number| number.column == *column);
        let nuisance = (0..always.len()).filter(|column| !is_asked(column)).collect();
        let variance = if trace.basis.is_some() { engine.start.0 } else { fit.variance };
        // The numbers of rivals have no prior: data alone are to tell them apart.
        let has_prior = |k: &usize| layout.always().contains(k) || away.contains(k);
        let precision = |k: usize| if has_prior(&k) { variance / sd(&problem, k).powi(2) } else { 0.0 };
        let whole = DMatrix::from_fn(gram.nrows() - 1, gram.ncols() - 1, |i, j| {
            gram[(i, j)] + if i == j { precision(i) } else { 0.0 }
        });
        let known = eliminated(&whole, &kept, &away);
        let likely = DMatrix::from_diagonal(&kept.iter().map(|&k| precision(k)).collect::<Vec<_>>().into());
        let values = layout.values(&engine.point.values);
        let used: Vec<usize> = (0..values.len()).filter(|k| values[*k] != 0.0 || kept.contains(k)).collect();
        let place = |k: &usize| used.iter().position(|other| other == k);
        Ok(Self {
            parameters: used.iter().map(|&k| layout.parameters[k].clone()).collect(),
            values: used.iter().map(|&k| values[k]).collect(),
            kept: kept.iter().filter_map(place).collect(),
            known,
            likely,
            variance,
            rivals: Rivals { nuisance, model, effects, pairs: contests },
        })
    }
}

/// What a trace found.
struct InModel {
    name: String,
    form: usize,
    /// Whether it is named, and not suspected only.
    is_named: bool,
}

/// The effects of a trace with their forms; those that pose and load have nothing to do with have none.
fn found(forms: &Forms<'_>, trace: &Trace) -> Vec<InModel> {
    let named = trace.effects.iter().map(|of| (of.effect.to_string(), true));
    let suspected = trace.suspected.iter().map(|of| (of.effect.to_string(), false));
    let mut found: Vec<InModel> = Vec::new();
    for (name, is_named) in named.chain(suspected) {
        let beside = sorted(found.iter().map(|of| of.form));
        if let Some(form) = forms.of(&name, &beside) {
            found.push(InModel { name, form, is_named });
        }
    }
    found
}

/// Where a name gets its form.
struct Forms<'f> {
    layout: &'f Layout,
    problem: &'f Problem<'f>,
    kappa: usize,
    best: &'f [(String, String)],
}

impl Forms<'_> {
    /// The form of a full name: that of the best set, or the one that does best beside others.
    fn of(&self, name: &str, beside: &[usize]) -> Option<usize> {
        let own = self.best.iter().find(|(of, _)| of == name);
        own.and_then(|(name, label)| self.layout.find(name, label)).or_else(|| {
            let additions = self.problem.additions(beside, self.kappa);
            additions.into_iter().map(|(_, form)| form).find(|&form| self.layout.stands_for(form, name))
        })
    }
}

/// Columns of the layout in the order in which planning has them.
struct Places {
    columns: Vec<usize>,
}

impl Places {
    fn of(&mut self, column: usize) -> usize {
        self.columns.iter().position(|&other| other == column).unwrap_or_else(|| {
            self.columns.push(column);
            self.columns.len() - 1
        })
    }

    fn all(&mut self, columns: &[usize]) -> Vec<usize> {
        columns.iter().map(|&column| self.of(column)).collect()
    }
}

/// The layout with the candidates that are asked about, or have a value, alone.
fn wanted(engine: &Engine<'_>, trace: &Trace, groups: &[Group]) -> Layout {
    let Layout { parameters, candidates, fixed, always, .. } = engine.layout();
    let named = trace.effects.iter().map(|of| of.effect.to_string());
    let suspected = trace.suspected.iter().map(|of| of.effect.to_string());
    let asked = groups.iter().flat_map(|group| group.names.iter().cloned());
    let names: Vec<String> = named.chain(suspected).chain(asked).collect();
    let has_value = |name: &str| {
        engine.point.values.keys().any(|key| key.strip_prefix(name).is_some_and(|rest| rest.starts_with('/')))
    };
    let does_same = |of: &Candidate| {
        of.forms.iter().flat_map(|form| &form.same).any(|name| names.iter().any(|asked| asked == name))
    };
    let candidates =
        candidates.into_iter().filter(|of| names.contains(&of.name()) || has_value(&of.name()) || does_same(of));
    Layout::new(parameters[..fixed].to_vec(), parameters[fixed..fixed + always].to_vec(), candidates.collect())
}

fn sorted(forms: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut forms: Vec<usize> = forms.collect();
    forms.sort_unstable();
    forms
}

fn is_of_block(layout: &Layout, column: usize) -> bool {
    matches!(layout.parameters[column].size, Size::Learned(BLOCK, _))
}

/// What a number is likely to be: the standard deviation of its prior, in its unit.
fn sd(problem: &Problem<'_>, column: usize) -> f64 {
    let prior = &problem.priors[column];
    prior.sd * prior.group.map_or(1.0, |group| problem.start.1.now[group])
}

/// The full name of a number of the table.
fn of_table(joint: usize, number: usize) -> String {
    let name = TABLE.iter().find(|(of, ..)| *of == number).map_or("theta", |(_, name, _)| name);
    if name == "theta" { format!("joint_zero_offset@joint {joint}") } else { format!("dh_error@{name}{joint}") }
}

/// The information of some numbers with others fitted again: the Schur complement.
fn eliminated(whole: &DMatrix<f64>, kept: &[usize], away: &[usize]) -> DMatrix<f64> {
    let part = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| whole[(rows[i], columns[j])])
    };
    let own = part(kept, kept);
    if away.is_empty() {
        return own;
    }
    let Some(factor) = part(away, away).cholesky() else { return own };
    let beside = part(away, kept);
    own - beside.tr_mul(&factor.solve(&beside))
}
