//! A campaign that is searched: what is read, its noise, and where the model is linearised.

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use robstiff_robots::Description;

use super::always::{BLOCK, Declared, LIKELY_SCALES, REFLECTOR, always};
use super::layout::Layout;
use super::problem::{Problem, moves};
use super::search::Width;
use crate::effects::{Candidate, Offers, Scene, Shapes, What};
use crate::model::arm::BETA;
use crate::model::described::fixed;
use crate::model::{Size, Term, World};
use crate::observe::Observation;
use crate::regression::gram::with_target;
use crate::regression::noise::{Noise, discrepancies};
use crate::regression::{Gram, Grams, NoisePrior, Scales};

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
    pub(super) fitted: Fitted,
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

/// Before any discrepancy is known the first steps assume this one, by its index.
const FIRST_KAPPA: usize = 2;

/// What is assumed of the noise of which nothing is known (m): that of a good tracker.
const LIKELY_NOISE: f64 = 2e-5;
/// As many readings say so.
const SAY_SO: f64 = 6.0;
/// No instrument reads more finely (m, rad). Of displacements whose noise is not known, one reading says
/// so: it keeps readings without any noise from having none, and has no part in others.
pub const FINEST: f64 = 1e-8;

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

    /// The same campaign as declared, of which nothing was learned.
    #[must_use]
    pub fn fresh(&self) -> Self {
        let mut scene = self.scene.clone();
        scene.shapes = Shapes::default();
        let fresh = Self::new(self.observation, self.robot, scene, self.training.clone(), self.known);
        Self { sizes: self.sizes, ..fresh }
    }

    /// The same where only some of what is always in is fitted.
    #[must_use]
    pub fn fitting(&self, fitted: Fitted) -> Self {
        Self { fitted, ..self.clone() }
    }

    /// As how many readings what is known of the noise before counts; not what only keeps it from being none.
    pub fn readings_before(&self) -> f64 {
        if self.prior.size > FINEST { self.prior.weight } else { 0.0 }
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
        self.layout_with(Offers::of(&self.scene))
    }

    /// The parameters that are there without any candidate.
    pub fn layout_alone(&self) -> Layout {
        self.layout_with(Vec::new())
    }

    fn layout_with(&self, candidates: Vec<Candidate>) -> Layout {
        let (_, own) = always(self.robot, &self.scene, self.blocks());
        Layout::new(fixed(self.robot), own, candidates)
    }

    /// The widths of searches: the last, those before, and those of folds.
    pub(super) fn widths(&self) -> [Width; 3] {
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

    /// The columns of a layout at the linearisation point, and the problem of all blocks that are fitted to.
    pub fn problem_here<'l>(&self, layout: &'l Layout) -> (DMatrix<f64>, Problem<'l>) {
        let columns = self.linearise(layout, &self.point);
        let grams = self.grams(&columns, &self.one_group()).total;
        let problem = self.problem(layout, &columns, grams);
        (columns, problem)
    }

    /// All blocks that are fitted to in one group.
    pub fn one_group(&self) -> Vec<Option<usize>> {
        self.training.iter().map(|fitted| fitted.then_some(0)).collect()
    }

    /// The Gram matrices of columns over some groups of blocks.
    pub fn grams(&self, columns: &DMatrix<f64>, groups: &[Option<usize>]) -> Grams {
        Grams::new(self.observation.readings(), &self.noise, columns, groups)
    }

    /// The discrepancy that is assumed before any is known, by its index.
    pub(super) fn first_kappa(&self) -> usize {
        FIRST_KAPPA.min(discrepancies(self.observation.readings()).len() - 1)
    }

    /// Whether a column that is always in is not fitted.
    pub(super) fn is_out(&self, layout: &Layout, column: usize) -> bool {
        let parameter = &layout.parameters[column];
        let is_unwritten =
            matches!(parameter.size, Size::Learned(BLOCK, _)) || matches!(parameter.term, Term::Table(_, BETA));
        match self.fitted {
            Fitted::All => false,
            Fitted::Written => is_unwritten,
            Fitted::AsFiled => is_unwritten || REFLECTOR.contains(&parameter.name),
        }
    }
}
