//! Linearise, search, fit, learn the noise, and again.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;

use super::always::{BLOCK, Declared, LIKELY_SCALES, REFLECTOR, always, fixed};
use super::layout::Layout;
use super::problem::{Judged, Problem, Set, moves};
use super::search::{Visited, Width, search};
use crate::effects::{Offers, Scene, Shapes, What};
use crate::model::arm::BETA;
use crate::model::{Sign, Size, Term, World};
use crate::observe::{Observation, Readings};
use crate::regression::evidence::{Start, fit};
use crate::regression::gram::with_target;
use crate::regression::noise::{Noise, discrepancies, rows_of_blocks};
use crate::regression::{Fit, Gram, Grams, NoisePrior, Prior, Scales};

/// Where a model is linearised: what its parameters are, by their keys, and the world that they
/// change.
#[derive(Clone, Debug)]
pub struct Point {
    /// The world, with where the robot stands taken into it.
    pub world: World,
    /// The values.
    pub values: BTreeMap<String, f64>,
}

/// A campaign that is searched.
#[derive(Clone)]
pub struct Engine<'c> {
    /// What is read.
    pub observation: &'c dyn Observation,
    /// The description as declared.
    pub robot: &'c Description,
    /// What the campaign can show.
    pub scene: Scene<'c>,
    /// Which blocks are fitted to.
    pub training: Vec<bool>,
    /// The noise.
    pub noise: Noise,
    /// What is known of it before.
    pub prior: NoisePrior,
    /// The linearisation point.
    pub point: Point,
    /// The variance of one reading, and the scales of learned priors.
    pub start: (f64, Scales),
    /// What is likely of candidates, times this.
    pub sizes: f64,
    /// How many effects are likely.
    pub likely: f64,
    /// Which of what is always in is fitted.
    fitted: Fitted,
    /// The noise of one reading, where it is known before (m, rad).
    known: Option<f64>,
}

/// Which of what is always in is fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fitted {
    /// All of it.
    All,
    /// Only what a description takes, and the rig: not the unnamed block, and no angle between
    /// parallel axes.
    Written,
    /// The same with the reflector where the file says.
    AsFiled,
}

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
    /// The best set at its own optimum.
    pub own: Solved,
}

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

/// Before any discrepancy is known the first steps assume this one, by its index.
const FIRST_KAPPA: usize = 2;

/// How often columns are formed for a search.
const PASSES: usize = 5;

/// Rounds of Gauss-Newton steps to a set's optimum.
const STEPS: usize = 4;

/// Steps by which shapes are refined, pass by pass.
const FINER: [f64; 6] = [1.35, 1.16, 1.06, 1.025, 1.01, 1.005];

/// A step that moves predictions by less than this part of the noise is the last.
const SETTLED: f64 = 0.01;

/// What is assumed of the noise of which nothing is known (m): that of a good tracker.
const LIKELY_NOISE: f64 = 2e-5;
/// As many readings say so.
const SAY_SO: f64 = 6.0;
/// No instrument reads more finely (m, rad). Of displacements whose noise is not known, one reading says
/// so: it keeps readings without any noise from having none, and has no part in others.
const FINEST: f64 = 1e-8;

/// Rotations and encoders are at first as noisy as if read at this lever (m).
const LEVER: f64 = 0.2;

/// How many effects are likely: few that a loaded arm shows, and more of an arm that is read all over
/// its reach.
const LIKELY_LOADED: f64 = 0.7;
const LIKELY_ABSOLUTE: f64 = 3.0;

impl<'c> Engine<'c> {
    /// A campaign as declared; `noise` is one sigma of one axis of a reading, where known.
    pub fn new(
        observation: &'c dyn Observation,
        robot: &'c Description,
        scene: Scene<'c>,
        training: Vec<bool>,
        noise: Option<f64>,
    ) -> Self {
        let readings = observation.readings();
        let positions = scene.what == What::Positions;
        let prior = match noise {
            Some(size) => NoisePrior { size, weight: SAY_SO },
            // Of positions a discrepancy of each pose is noise, whose size is not that of the instrument.
            None if positions => NoisePrior { size: LIKELY_NOISE, weight: SAY_SO },
            None => NoisePrior { size: FINEST, weight: 1.0 },
        };
        let size = noise.unwrap_or(LIKELY_NOISE);
        let scales = if positions { Scales::new(LIKELY_SCALES.to_vec()) } else { Scales::default() };
        let likely = if positions { LIKELY_ABSOLUTE } else { LIKELY_LOADED };
        Self {
            observation,
            robot,
            noise: Noise::plain(readings, LEVER),
            prior,
            point: Point { world: observation.world().clone(), values: BTreeMap::new() },
            start: (size * size, scales),
            sizes: 1.0,
            likely,
            fitted: Fitted::All,
            known: noise,
            scene,
            training,
        }
    }

    /// The same where only some of what is always in is fitted.
    #[must_use]
    pub fn fitting(&self, fitted: Fitted) -> Self {
        Self { fitted, ..self.clone() }
    }

    /// How many blocks are fitted to.
    pub fn blocks(&self) -> usize {
        self.training.iter().filter(|fitted| **fitted).count()
    }

    /// The numbers of the description that are fitted, in the order of the layout's.
    pub fn declared(&self) -> Vec<Declared> {
        always(self.robot, &self.scene, self.blocks()).0
    }

    /// All parameters and the forms of all candidates.
    pub fn layout(&self) -> Layout {
        let (_, own) = always(self.robot, &self.scene, self.blocks());
        Layout::new(fixed(self.robot, &self.scene), own, Offers::of(&self.scene))
    }

    /// The widths of searches: the last, those before, and those of folds.
    fn widths(&self) -> [Width; 3] {
        match self.scene.what {
            What::Positions => [Width::LEARNED; 3],
            _ => [Width::WIDE, Width::FIRST, Width::FOLD],
        }
    }

    /// The width of a search that is repeated without some poses.
    pub fn fold_width(&self) -> Width {
        self.widths()[2]
    }

    /// The columns at the linearisation point, with the readings behind: such that they are the
    /// product of columns and values, and the residual.
    pub fn linearise(&self, layout: &Layout, point: &Point) -> DMatrix<f64> {
        let values = layout.values(&point.values);
        let all: Vec<usize> = (layout.fixed..layout.parameters.len()).collect();
        let parts = self.observation.columns(&point.world, &layout.parameters, &values, &all);
        let mut columns = parts.insert_columns(0, layout.fixed, 0.0);
        layout.always().filter(|k| self.is_out(layout, *k)).for_each(|k| columns.column_mut(k).fill(0.0));
        let mut target = self.observation.readings().values.clone();
        target -= self.observation.predict(&point.world, &layout.parameters, &values);
        for (k, value) in values.iter().enumerate().skip(layout.fixed).filter(|(_, value)| **value != 0.0) {
            target.axpy(*value, &columns.column(k), 1.0);
        }
        with_target(columns, &target)
    }

    /// The problem of some Gram matrices.
    pub fn problem<'l>(&self, layout: &'l Layout, columns: &DMatrix<f64>, grams: Vec<Gram>) -> Problem<'l> {
        let readings = self.observation.readings();
        let moves = moves(readings, columns, &self.training);
        Problem::new(layout, grams, &moves, (self.prior, self.start.clone()), (self.likely, self.sizes))
    }

    /// All blocks that are fitted to in one group.
    pub fn one_group(&self) -> Vec<Option<usize>> {
        self.training.iter().map(|fitted| fitted.then_some(0)).collect()
    }

    /// The Gram matrices of columns over some groups of blocks.
    pub fn grams(&self, columns: &DMatrix<f64>, groups: &[Option<usize>]) -> Grams {
        Grams::new(self.observation.readings(), &self.noise, columns, groups)
    }

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
        for step in 0..=steps {
            let values = layout.values(&point.values);
            let predicted = self.observation.predict(&point.world, &layout.parameters, &values);
            if step == steps && solved.is_some() {
                break;
            }
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
            let moved = {
                let values = layout.values(&next.values);
                self.observation.predict(&next.world, &layout.parameters, &values) - &predicted
            };
            let moved = readings.rms(&moved, (0..readings.rows()).filter(|&row| self.training[readings.block[row]]));
            point = next;
            let done = moved < SETTLED * variance.sqrt() && step > 0;
            solved = Some((found, grams, priors));
            if done {
                break;
            }
        }
        let (mut found, grams, priors) = solved?;
        let values = layout.values(&point.values);
        let left = &readings.values - self.observation.predict(&point.world, &layout.parameters, &values);
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

    /// The same campaign as declared, of which nothing was learned.
    #[must_use]
    pub fn fresh(&self) -> Self {
        let mut scene = self.scene.clone();
        scene.shapes = Shapes::default();
        let fresh = Self::new(self.observation, self.robot, scene, self.training.clone(), self.known);
        Self { sizes: self.sizes, ..fresh }
    }

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
            let columns = self.linearise(&layout, &self.point.clone());
            let grams = self.grams(&columns, &self.one_group()).total;
            let mut problem = self.problem(&layout, &columns, grams);
            let mut start: Set = names.iter().filter_map(|(name, form)| layout.find(name, form)).collect();
            start.sort_unstable();
            let visited = search(&mut problem, &start, first);
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
        let layout = Layout { candidates: Vec::new(), ..self.layout() };
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

    /// The description's own numbers alone, at their optimum, none of the compliances negative.
    pub fn alone(&self, layout: &Layout) -> Option<Solved> {
        self.fitting(Fitted::Written).solve_bounded(layout, &[], (&self.point, self.first_kappa()), 2 * STEPS)
    }

    /// The same where compliances may be negative.
    pub fn free(&self, layout: &Layout) -> Option<Solved> {
        self.fitting(Fitted::Written).solve(layout, &[], (&self.point, self.first_kappa()), 2 * STEPS)
    }

    /// The discrepancy that is assumed before any is known, by its index.
    fn first_kappa(&self) -> usize {
        FIRST_KAPPA.min(discrepancies(self.observation.readings()).len() - 1)
    }

    /// Whether a column that is always in is not fitted.
    fn is_out(&self, layout: &Layout, column: usize) -> bool {
        let parameter = &layout.parameters[column];
        let is_unwritten =
            matches!(parameter.size, Size::Learned(BLOCK, _)) || matches!(parameter.term, Term::Table(_, BETA));
        match self.fitted {
            Fitted::All => false,
            Fitted::Written => is_unwritten,
            Fitted::AsFiled => is_unwritten || REFLECTOR.contains(&parameter.name),
        }
    }

    /// The noise of one axis of a reading where no discrepancy accounts for any of the residual.
    pub fn noise_at(&self, found: &Found) -> f64 {
        let grams = self.grams(&found.columns, &self.one_group()).total;
        let problem = self.problem(&found.layout, &found.columns, grams);
        problem.fit(&found.best, 0).map_or(0.0, |fit| fit.variance.sqrt())
    }

    /// The error of a set under a discrepancy on poses that are left out in turn, with the columns of
    /// a layout as they were linearised.
    pub fn unseen_rms(&self, layout: &Layout, columns: &DMatrix<f64>, set: &[usize], kappa: usize) -> Option<f64> {
        let readings = self.observation.readings();
        let group = groups(readings, &self.training, UNSEEN_FOLDS, 1);
        let grams = self.grams(columns, &group);
        let (mut sum, mut count) = (0.0, 0);
        for fold in 0..group.iter().flatten().max().map_or(0, |last| last + 1) {
            let problem = self.problem(layout, columns, grams.without(fold).total);
            let fit = problem.fit(set, kappa)?;
            let unseen: Vec<bool> = group.iter().map(|of| *of == Some(fold)).collect();
            for row in rows_of_blocks(readings, &unseen).concat() {
                for k in 0..readings.reported {
                    let at = row * readings.width + k;
                    let taken: f64 = fit.columns.iter().zip(fit.mean.iter()).map(|(&c, b)| columns[(at, c)] * b).sum();
                    sum += (columns[(at, columns.ncols() - 1)] - taken).powi(2);
                    count += 1;
                }
            }
        }
        (count > 0).then(|| (sum / f64::from(count)).sqrt())
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
        self.noise.learn(readings, &solved.left, kappa, &self.training);
    }

    /// Offers shapes near those of a set.
    fn refine(&mut self, layout: &Layout, set: &[usize], pass: usize) {
        let step = FINER[pass.min(FINER.len() - 1)];
        let mut shapes = Shapes::default();
        for &form in set {
            let of = &layout.forms[form];
            let candidate = &layout.candidates[of.candidate];
            let own = &candidate.forms[of.form];
            let joint = match candidate.place {
                crate::effects::Place::Part(robstiff_robots::Place::Joint(joint)) => joint,
                _ => 0,
            };
            for number in &own.shape {
                match number.name {
                    "knee" | "radius1" if own.shape.len() == 1 && joint > 0 => {
                        let now = number.value / self.scene.torque[joint - 1];
                        for by in [1.0, step, 1.0 / step, step * step, 1.0 / (step * step)] {
                            shapes.of_laws.push((candidate.kind.name, joint, now * by));
                        }
                    }
                    "from_line" => {
                        let at = self.scene.lines.iter().position(|line| *line as f64 == number.value);
                        let near = at.unwrap_or(0).saturating_sub(NEAR)..=at.unwrap_or(0) + NEAR;
                        shapes.moments.extend(near.filter(|row| (1..self.scene.lines.len()).contains(row)));
                    }
                    _ => {}
                }
            }
        }
        self.scene.shapes = shapes;
    }

    /// The last search, wide and where the best set stands; sets near the best are compared each at
    /// its own optimum.
    fn last(&mut self, names: &[(String, String)], width: Width) -> Option<Found> {
        let layout = self.layout();
        let columns = self.linearise(&layout, &self.point.clone());
        let grams = self.grams(&columns, &self.one_group()).total;
        let mut problem = self.problem(&layout, &columns, grams);
        let mut start: Set = names.iter().filter_map(|(name, form)| layout.find(name, form)).collect();
        start.sort_unstable();
        let mut visited = search(&mut problem, &start, width);
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
        drop(problem);
        Some(Found { layout, visited, best, kappa, columns, own })
    }

    /// Weighs sets over how large springs and laws of joints are likely to be: of three sizes each is as
    /// likely, so that one which is larger than usual is not passed over for two that are usual. Lengths
    /// and angles have sizes that one knows.
    fn over_sizes(&self, problem: &Problem<'_>, columns: &DMatrix<f64>, visited: &mut Visited) {
        let best = visited.best();
        let mut others: Vec<(Problem<'_>, Visited)> = Vec::new();
        for by in OTHER_SIZES {
            let other = Self { sizes: by * self.sizes, ..self.clone() };
            let mut problem = other.problem(problem.layout, columns, problem.grams.clone());
            problem.priors.iter_mut().zip(&problem.layout.parameters).skip(problem.layout.always().end).for_each(
                |(prior, parameter)| {
                    if !matches!(parameter.term, Term::Spring(_) | Term::Law(..)) {
                        prior.sd /= by;
                    }
                },
            );
            let own = search(&mut problem, &best, self.fold_width());
            others.push((problem, own));
        }
        let mut likely: BTreeSet<Set> = BTreeSet::new();
        for visited in others.iter().map(|(_, visited)| visited).chain([&*visited]) {
            let ranked = visited.ranked();
            let Some(least) = ranked.first().map(|(_, judged)| judged.score - NO_MATTER) else { continue };
            likely.extend(ranked.iter().take_while(|(_, judged)| judged.score > least).map(|(set, _)| (*set).clone()));
        }
        let count = (1 + others.len()) as f64;
        visited.sets.values_mut().for_each(|judged| judged.score -= count.ln());
        for set in likely {
            let at_other =
                others.iter().map(|(problem, own)| own.sets.get(&set).copied().or_else(|| problem.judge(&set)));
            let usual = visited.sets.get(&set).copied();
            let usual = usual.or_else(|| {
                let judged = problem.judge(&set)?;
                Some(Judged { score: judged.score - count.ln(), ..judged })
            });
            let at_other = at_other.flatten().map(|judged| Judged { score: judged.score - count.ln(), ..judged });
            let each: Vec<Judged> = usual.into_iter().chain(at_other).collect();
            if let Some(most) = each.iter().copied().max_by(|a, b| a.score.total_cmp(&b.score)) {
                let sum: f64 = each.iter().map(|one| (one.score - most.score).exp()).sum();
                visited.sets.insert(set, Judged { score: most.score + sum.ln(), ..most });
            }
        }
    }

    /// Where a set begins: its fit at the linearisation point.
    pub fn start_of(&self, problem: &Problem<'_>, set: &[usize], kappa: usize) -> Point {
        let Some(fit) = problem.fit(set, kappa) else { return self.point.clone() };
        let values = fit.columns.iter().zip(fit.mean.iter());
        let values = values.map(|(&k, &value)| (problem.layout.keys[k].clone(), value)).collect();
        self.absorbed(problem.layout, Point { world: self.point.world.clone(), values })
    }
}

/// Folds for the error that named effects leave one after the other.
const UNSEEN_FOLDS: usize = 5;

/// The fold of each block, drawn at random, alike from each stratum; none of one that is not fitted
/// to.
pub fn groups(readings: &Readings, training: &[bool], folds: usize, seed: u64) -> Vec<Option<usize>> {
    let mut blocks: Vec<usize> = (0..training.len()).filter(|&block| training[block]).collect();
    blocks.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
    blocks.sort_by_key(|&block| readings.stratum[block]);
    let folds = folds.min(blocks.len());
    let mut group = vec![None; training.len()];
    blocks.into_iter().enumerate().for_each(|(k, block)| group[block] = Some(k % folds.max(1)));
    group
}

/// How many times larger effects may be than usual, beside usual.
const OTHER_SIZES: [f64; 2] = [1.0 / 3.0, 3.0];

/// A set that is so much less likely than the best (in the logarithm) is not weighed over sizes.
const NO_MATTER: f64 = 10.0;

/// So many sets are compared at their own optimum, those that are at least so likely.
const OWN: usize = 10;
const UNLIKELY: f64 = 2e-3;

/// Rows about a moment that was found which are tried as well.
const NEAR: usize = 12;
