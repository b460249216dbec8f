//! A set at its own optimum, by Gauss-Newton steps.

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::engine::{Engine, Fitted, Point};
use super::layout::Layout;
use super::problem::{Problem, moves};
use crate::model::{Sign, Size, Term};
use crate::regression::evidence::{Start, fit};
use crate::regression::gram::with_target;
use crate::regression::{Fit, Gram, Prior, Scales};

/// A set at its own optimum.
#[derive(Clone, Debug)]
pub struct Solved {
    /// What its parameters are.
    pub point: Point,
    /// The fit there; its columns are those of the layout.
    pub fit: Fit,
    /// What it leaves of every row, those that were not fitted to among them.
    pub left: DVector<f64>,
    /// The log-evidence, over all discrepancies, with the set's prior.
    pub score: f64,
    /// The likeliest discrepancy, by its index.
    pub kappa: usize,
    /// The columns whose numbers are held at zero, for they cannot be negative.
    pub held: Vec<usize>,
}

/// Rounds of Gauss-Newton steps to a set's optimum.
pub const STEPS: usize = 4;

/// A step that moves predictions by less than this part of the noise is the last.
const SETTLED: f64 = 0.01;

impl Engine<'_> {
    /// A set at its own optimum, by Gauss-Newton steps from a point, under a discrepancy.
    pub fn solve(&self, layout: &Layout, set: &[usize], from: (&Point, usize), steps: usize) -> Option<Solved> {
        self.solve_without(layout, set, from, steps, &[])
    }

    /// The same with numbers that cannot be negative held at zero where they would be.
    pub fn solve_bounded(&self, layout: &Layout, set: &[usize], from: (&Point, usize), steps: usize) -> Option<Solved> {
        let mut held = Vec::new();
        loop {
            let solved = self.solve_without(layout, set, from, steps, &held)?;
            let columns = solved.fit.columns.iter().zip(solved.fit.mean.iter());
            let negative = columns.filter(|(k, mean)| layout.parameters[**k].sign == Sign::Nonnegative && **mean < 0.0);
            let negative: Vec<usize> = negative.map(|(k, _)| *k).collect();
            if negative.is_empty() {
                return Some(Solved { held, ..solved });
            }
            held.extend(negative);
        }
    }

    fn solve_without(
        &self,
        layout: &Layout,
        set: &[usize],
        (from, kappa): (&Point, usize),
        steps: usize,
        held: &[usize],
    ) -> Option<Solved> {
        let chosen: Vec<usize> = layout
            .always()
            .filter(|k| !self.is_out(layout, *k))
            .chain(set.iter().flat_map(|&form| layout.forms[form].columns.iter().copied()))
            .filter(|k| !held.contains(k))
            .collect();
        let readings = self.observation.readings();
        let mut point = self.only(layout, &chosen, from);
        let (mut variance, mut scales) = self.start.clone();
        let mut solved: Option<(Fit, Vec<Gram>, Vec<Prior>)> = None;
        let predict = |at: &Point| self.observation.predict(&at.world, &layout.parameters, &layout.values(&at.values));
        let mut predicted = predict(&point);
        for step in 0..steps.max(1) {
            let values = layout.values(&point.values);
            let columns = self.observation.columns(&point.world, &layout.parameters, &values, &chosen);
            let mut target = &readings.values - &predicted;
            for (k, &column) in chosen.iter().enumerate() {
                target.axpy(values[column], &columns.column(k), 1.0);
            }
            let moves = moves(readings, &columns, &self.training);
            let part = Layout {
                parameters: chosen.iter().map(|&k| layout.parameters[k].clone()).collect(),
                keys: chosen.iter().map(|&k| layout.keys[k].clone()).collect(),
                fixed: 0,
                always: chosen.iter().filter(|k| layout.always().contains(k)).count(),
                candidates: Vec::new(),
                forms: Vec::new(),
            };
            let all = with_target(columns, &target);
            let grams = self.grams(&all, &self.one_group()).total;
            let shown =
                Problem::new(&part, Vec::new(), &moves, (self.prior, (variance, scales.clone())), (0.0, self.sizes));
            let priors = shown.priors;
            let own: Vec<usize> = (0..chosen.len()).filter(|&k| moves[k] > 0.0).collect();
            let start = Start { variance, scales: &scales };
            let found = fit(&grams[kappa.min(grams.len() - 1)], &own, &priors, self.prior, start, 8)?;
            (variance, scales) = (found.variance, found.scales.clone());
            let mut values = BTreeMap::new();
            for (at, &k) in own.iter().enumerate() {
                values.insert(part.keys[k].clone(), found.mean[at]);
            }
            let next = self.absorbed(layout, Point { world: point.world.clone(), values });
            let there = predict(&next);
            let trained = (0..readings.rows()).filter(|&row| self.training[readings.block[row]]);
            let moved = readings.rms(&(&there - &predicted), trained);
            (point, predicted) = (next, there);
            let done = moved < SETTLED * variance.sqrt() && step > 0;
            solved = Some((found, grams, priors));
            if done {
                break;
            }
        }
        let (mut found, grams, priors) = solved?;
        let left = &readings.values - predicted;
        let own = found.columns.clone();
        let (score, kappa) = self.weigh(&grams, &own, &priors, (variance, &scales))?;
        if let Some(again) = fit(&grams[kappa], &own, &priors, self.prior, Start { variance, scales: &scales }, 8) {
            found = again;
        }
        found.columns = own.iter().map(|&k| chosen[k]).collect();
        Some(Solved { point, fit: found, left, score, kappa, held: Vec::new() })
    }

    /// The evidence over all discrepancies, and the likeliest.
    fn weigh(&self, grams: &[Gram], columns: &[usize], priors: &[Prior], at: (f64, &Scales)) -> Option<(f64, usize)> {
        let start = Start { variance: at.0, scales: at.1 };
        let count = grams.len();
        let share = |kappa: usize| if kappa == 0 { 0.5 } else { 0.5 / (count - 1) as f64 };
        let of = |kappa: usize| {
            let evidence = fit(&grams[kappa], columns, priors, self.prior, start, 8)?.evidence;
            Some(evidence + if count > 1 { share(kappa).ln() } else { 0.0 })
        };
        let each: Vec<f64> = (0..count).map(of).collect::<Option<_>>()?;
        let best = (0..count).max_by(|a, b| each[*a].total_cmp(&each[*b]))?;
        let sum: f64 = each.iter().map(|one| (one - each[best]).exp()).sum();
        Some((each[best] + sum.ln(), best))
    }

    /// A point with the values of some columns only.
    fn only(&self, layout: &Layout, columns: &[usize], from: &Point) -> Point {
        let own = |k: &usize| Some((layout.keys[*k].clone(), *from.values.get(&layout.keys[*k])?));
        Point { world: from.world.clone(), values: columns.iter().filter_map(own).collect() }
    }

    /// A point with where the robot stands taken into the world.
    fn absorbed(&self, layout: &Layout, mut point: Point) -> Point {
        for k in layout.always() {
            let parameter = &layout.parameters[k];
            if let (Size::Flat(_), Term::World(change)) = (parameter.size, &parameter.term)
                && let Some(value) = point.values.remove(&layout.keys[k])
            {
                change(&mut point.world, value);
            }
        }
        point.world.rig.absorb();
        point
    }

    /// Where a set begins: its fit at the linearisation point.
    pub fn start_of(&self, problem: &Problem<'_>, set: &[usize], kappa: usize) -> Point {
        let Some(fit) = problem.fit(set, kappa) else { return self.point.clone() };
        let values = fit.columns.iter().zip(fit.mean.iter());
        let values = values.map(|(&k, &value)| (problem.layout.keys[k].clone(), value)).collect();
        self.absorbed(problem.layout, Point { world: self.point.world.clone(), values })
    }

    /// The description's own numbers alone, at their optimum, none of the compliances negative.
    pub fn alone(&self, layout: &Layout) -> Option<Solved> {
        self.fitting(Fitted::Written).solve_bounded(layout, &[], (&self.point, self.first_kappa()), 2 * STEPS)
    }

    /// The same where compliances may be negative.
    pub fn free(&self, layout: &Layout) -> Option<Solved> {
        self.fitting(Fitted::Written).solve(layout, &[], (&self.point, self.first_kappa()), 2 * STEPS)
    }
}
