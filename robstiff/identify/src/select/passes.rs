//! Linearise, search, fit, learn the noise, and again.

use nalgebra::{DMatrix, DVector};

use super::engine::{Engine, Fitted};
use super::layout::Layout;
use super::problem::{Problem, Set};
use super::search::{Visited, Width, search};
use super::solve::{STEPS, Solved};
use crate::effects::{Shapes, What};
use crate::model::Term;
use crate::regression::Gram;
use crate::regression::noise::discrepancies;

/// What a search came to.
pub struct Found {
    /// All parameters and forms.
    pub layout: Layout,
    /// The sets that were judged where the columns were linearised last.
    pub visited: Visited,
    /// The best.
    pub best: Set,
    /// Its discrepancy, by the index.
    pub kappa: usize,
    /// The columns there with the readings behind.
    pub columns: DMatrix<f64>,
    /// Their Gram matrices, under each discrepancy.
    pub grams: Vec<Gram>,
    /// The best set at its own optimum.
    pub own: Solved,
}

/// How often columns are formed for a search.
const PASSES: usize = 5;

/// Steps by which shapes are refined, pass by pass.
const FINER: [f64; 6] = [1.35, 1.16, 1.06, 1.025, 1.01, 1.005];

/// Rows about a moment that was found which are tried as well.
const NEAR: usize = 12;

/// How often noise and fit follow from each other at most, and the part of a row's weight that is no change of it.
const SETTLING: usize = 12;
const SETTLED: f64 = 0.05;

/// By which factor a discrepancy is larger that is the largest of all: as one of them is than the next.
const LACKS_MORE: f64 = 10.0;

/// So many sets are compared at their own optimum, those that are at least so likely.
const OWN: usize = 10;
const UNLIKELY: f64 = 2e-3;

impl Engine<'_> {
    /// The same, with what the description's own numbers alone leave of every row.
    pub fn run_from_alone(&mut self, progress: &dyn Fn(&str)) -> Option<(Found, DVector<f64>)> {
        progress("fitting the description's own numbers");
        let alone = self.fit_alone()?;
        Some((self.look(progress)?, alone))
    }

    fn look(&mut self, progress: &dyn Fn(&str)) -> Option<Found> {
        let [wide, first, _] = self.widths();
        let mut names: Vec<(String, String)> = Vec::new();
        let mut pass = 0;
        loop {
            progress("searching");
            let layout = self.layout();
            let (_, mut problem) = self.problem_here(&layout);
            let visited = search(&mut problem, &named(&layout, &names), first);
            let best = visited.best();
            let kappa = visited.sets.get(&best).map_or(0, |judged| judged.kappa);
            let found: Vec<(String, String)> = best.iter().map(|&form| layout.names(form)).collect();
            let shaped = best.iter().any(|&form| {
                !layout.candidates[layout.forms[form].candidate].forms[layout.forms[form].form].shape.is_empty()
            });
            let again = found == names && pass > 0 && (!shaped || pass + 1 >= PASSES);
            names = found;
            if let Some(begin) = problem.fit(&best, kappa) {
                self.start = (begin.variance, begin.scales.clone());
            }
            let solved = self.solve(&layout, &best, (&self.point, kappa), STEPS)?;
            self.adopt(&solved);
            pass += 1;
            if again || pass >= PASSES {
                break;
            }
            self.refine(&layout, &best, pass - 1);
        }
        self.last(&names, wide)
    }

    /// Fits the description's own numbers, in steps that come from far away; what they leave of every
    /// row, none of the compliances negative.
    pub fn fit_alone(&mut self) -> Option<DVector<f64>> {
        let kappa = self.first_kappa();
        let layout = self.layout_alone();
        self.fitted = Fitted::Written;
        let mut left = None;
        for steps in [1, 1, 2 * STEPS] {
            let begin = self.start.clone();
            let solved = match steps {
                1 => self.solve(&layout, &[], (&self.point, kappa), steps)?,
                _ => self.solve_bounded(&layout, &[], (&self.point, kappa), steps)?,
            };
            self.point = solved.point.clone();
            self.start = if steps > 1 { (solved.fit.variance, solved.fit.scales.clone()) } else { begin };
            left = Some(solved.left);
        }
        self.fitted = Fitted::All;
        self.learn_sizes(&layout);
        left
    }

    /// What is likely of bearings and laws where no compliance is declared: what was fitted. A clamped axis
    /// shows its compliance whatever else there is, and what a bias does to it goes with that.
    fn learn_sizes(&mut self, layout: &Layout) {
        for (k, own) in self.declared().iter().enumerate() {
            let key = &layout.keys[layout.fixed + k];
            if let super::always::Own::Joint(joint) = own.what
                && (self.robot.joints[joint - 1].compliance() == 0.0 || self.scene.what == What::Clamped)
            {
                self.scene.compliance[joint - 1] = self.point.values.get(key).copied().unwrap_or(0.0).max(0.0);
            }
        }
        self.scene.learn_middle();
    }

    /// Takes over a set at its optimum, and the noise that it leaves.
    fn adopt(&mut self, solved: &Solved) {
        self.point = solved.point.clone();
        self.start = (solved.fit.variance, solved.fit.scales.clone());
        self.learn_noise(solved, solved.kappa);
    }

    fn learn_noise(&mut self, solved: &Solved, kappa: usize) {
        let readings = self.observation.readings();
        let kappa = discrepancies(readings)[kappa];
        if let Some(lacking) = &mut self.noise.lacking {
            lacking.fitted = solved.fit.shares().iter().sum();
        }
        self.noise.learn(readings, &solved.left, kappa, &self.training);
    }

    /// What is always in by itself at its optimum under the noise that it leaves; none of the compliances negative.
    /// A row that is far off its pose may be its own matter, or what is missing at the pose: the likelier of both.
    pub fn settle(&mut self, layout: &Layout) -> Option<Solved> {
        let mut apart = self.clone();
        let solved = self.settled(layout, false)?;
        if solved.kappa == 0 {
            return Some(solved);
        }
        let rows = self.observation.readings().rows() as f64;
        let score = |engine: &Self, solved: &Solved| solved.score - engine.noise.apart.rows().len() as f64 * rows.ln();
        match apart.settled(layout, true) {
            Some(other) if score(&apart, &other) > score(self, &solved) => {
                *self = apart;
                Some(other)
            }
            _ => Some(solved),
        }
    }

    /// The same where rows are weighed at first as if nothing were missing, or by what seems to be. The noise follows
    /// from the fit, and the fit from the noise, until rows weigh as before.
    fn settled(&mut self, layout: &Layout, apart: bool) -> Option<Solved> {
        let readings = self.observation.readings();
        let last_kappa = discrepancies(readings).len() - 1;
        let mut kappa = if apart { 0 } else { self.first_kappa() };
        let mut pass = 0;
        loop {
            let solved = self.fitting(Fitted::Written).solve_bounded(layout, &[], (&self.point, kappa), 2 * STEPS)?;
            let (before, last) = (self.noise.weights.clone(), kappa);
            self.adopt(&solved);
            kappa = solved.kappa;
            if apart && pass == 0 {
                kappa = 0;
                self.learn_noise(&solved, kappa);
            }
            pass += 1;
            let moved = before.iter().zip(&self.noise.weights).map(|(a, b)| (a / b).ln().abs()).fold(0.0, f64::max);
            // What is missing may be more than any search would leave; a row a pose does not tell it from noise.
            let is_most = kappa > 0 && kappa == last_kappa && readings.blocks < readings.rows();
            if let Some(lacking) = self.noise.lacking.as_mut().filter(|_| is_most && pass < SETTLING) {
                lacking.times *= LACKS_MORE;
                continue;
            }
            if pass == SETTLING || (moved < SETTLED && kappa == last) {
                return Some(solved);
            }
        }
    }

    /// Offers shapes near those of a set.
    fn refine(&mut self, layout: &Layout, set: &[usize], pass: usize) {
        let step = FINER[pass.min(FINER.len() - 1)];
        let mut shapes = Shapes::default();
        for &form in set {
            let of = &layout.forms[form];
            let candidate = &layout.candidates[of.candidate];
            let own = &candidate.forms[of.form];
            let several = own.shape.iter().any(|number| number.name == "radius2");
            for number in &own.shape {
                match number.name {
                    "from_line" => {
                        let at = self.scene.lines.iter().position(|line| *line as f64 == number.value);
                        let near = at.unwrap_or(0).saturating_sub(NEAR)..=at.unwrap_or(0) + NEAR;
                        shapes.moments.extend(near.filter(|row| (1..self.scene.lines.len()).contains(row)));
                    }
                    _ if several => {}
                    name => {
                        for by in [1.0, step, 1.0 / step, step * step, 1.0 / (step * step)] {
                            shapes.numbers.push((name, candidate.place, number.value * by));
                        }
                    }
                }
            }
        }
        self.scene.shapes = shapes;
    }

    /// The last search, wide and where the best set stands; sets near the best are compared each at
    /// its own optimum.
    fn last(&mut self, names: &[(String, String)], width: Width) -> Option<Found> {
        let layout = self.layout();
        let (columns, mut problem) = self.problem_here(&layout);
        let mut visited = search(&mut problem, &named(&layout, names), width);
        if !problem.learns() {
            self.over_sizes(&problem, &columns, &mut visited);
        }
        let near: Vec<(Set, f64)> =
            visited.posterior().into_iter().take(OWN).map(|(set, p)| (set.clone(), p)).collect();
        let curved = |set: &Set| {
            let columns = set.iter().flat_map(|&form| &layout.forms[form].columns);
            columns.into_iter().any(|&k| matches!(layout.parameters[k].term, Term::World(_) | Term::Table(..)))
        };
        let any = near.iter().any(|(set, p)| *p > UNLIKELY && curved(set));
        for (set, p) in &near {
            if *p > UNLIKELY && any && !problem.learns() {
                let kappa = visited.sets[set].kappa;
                let begin = self.start_of(&problem, set, kappa);
                if let Some(solved) = self.solve(&layout, set, (&begin, kappa), STEPS) {
                    let linear =
                        problem.judge(set).map_or(solved.score, |judged| judged.score - problem.log_prior(set));
                    let judged = visited.sets.get_mut(set).expect("it was visited");
                    judged.score += solved.score - linear;
                    judged.kappa = solved.kappa;
                }
            }
        }
        let best = visited.best();
        let kappa = visited.sets.get(&best)?.kappa;
        let begin = self.start_of(&problem, &best, kappa);
        let own = self.solve_bounded(&layout, &best, (&begin, kappa), 2 * STEPS)?;
        let grams = problem.grams;
        Some(Found { layout, visited, best, kappa, columns, grams, own })
    }

    /// The problem that the last search came to.
    pub fn problem_of<'f>(&self, found: &'f Found) -> Problem<'f> {
        self.problem(&found.layout, &found.columns, found.grams.clone())
    }

    /// The noise of one axis of a reading where no discrepancy accounts for any of the residual.
    pub fn noise_at(&self, found: &Found) -> f64 {
        self.problem_of(found).fit(&found.best, 0).map_or(0.0, |fit| fit.variance.sqrt())
    }
}

/// The forms of some names that a layout has.
fn named(layout: &Layout, names: &[(String, String)]) -> Set {
    let mut set: Set = names.iter().filter_map(|(name, form)| layout.find(name, form)).collect();
    set.sort_unstable();
    set
}
