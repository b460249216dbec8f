//! The description's own numbers, fitted alone.
//!
//! A search weighs a number by what is likely of it. Here nothing is: a number that the readings show has
//! the value that fits them best, and one that they do not show is held as declared. Numbers are held one
//! at a time, for of two that look alike either may show without the other.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use robstiff_robots::Description;

use super::case::Case;
use super::estimate::{NOTEWORTHY_DEVIATION, Visibility, with_value};
use super::readable::{is_readable, shares};
use crate::effects::What;
use crate::model::described::fixed;
use crate::model::{Sign, Size};
use crate::probability::{WITHIN, median, student};
use crate::regression::Fit;
use crate::regression::noise::Lacking;
use crate::regression::tails::most_apart;
use crate::select::Layout;
use crate::select::always::{Declared, Own};
use crate::select::engine::{Engine, FINEST, Point};
use crate::select::problem::moves;
use crate::select::solve::Solved;
use robstiff::Effect;

/// The description's own numbers alone.
pub struct Alone<'e> {
    /// The campaign where it was fitted, with the noise that is left.
    pub engine: Engine<'e>,
    /// The numbers.
    pub own: Vec<Declared>,
    /// What is fitted.
    pub layout: Layout,
    /// The fit.
    pub solved: Solved,
    /// How sure numbers are where those that are held at zero may be off it by what was declared.
    loose: Option<Fit>,
    /// What the readings say of each number.
    pub shown: Vec<Visibility>,
    /// The least variance of one reading: that of its rounding.
    least: f64,
}

/// What is likely of a number has no part in its fit: the prior is so many times as wide.
const WIDE: f64 = 1e6;

/// A number shows if its declared value is at least so many standard deviations, or its fitted one so many.
const DECLARED_STANDS_OUT: f64 = 1.0;
/// See [`DECLARED_STANDS_OUT`].
const FITTED_STANDS_OUT: f64 = 2.0;

/// One that is further off what was declared than this factor, further than any maker is, must be so by more
/// standard deviations: these are of what poses disagree in, and what the description lacks they agree in.
const FAR: f64 = 30.0;
/// See [`FAR`].
const FAR_STANDS_OUT: f64 = 10.0;

/// What a number that is held as declared is taken to be off by, as a part of it: others are no surer than that
/// lets them be. What the makers of arms declare stayed within it.
const HELD_OFF: f64 = NOTEWORTHY_DEVIATION;

/// With this much more of chi-square, the square of two standard deviations, the readings tell zero from what
/// was declared.
const TOLD_APART: f64 = 4.0;

impl<'e> Alone<'e> {
    /// Fits them to readings whose variance is not less than that of their rounding. None where there is no fit.
    pub fn fitted(case: &'e Case<'_>, robot: &'e Description, least: f64) -> Option<Self> {
        let mut engine = case.engine(robot);
        let own = engine.declared();
        engine.noise.lacking = Some(Lacking::default());
        engine.noise.weights = evened(&engine);
        engine.fit_alone()?;
        let layout = engine.layout_alone();
        let likely = likely(&engine, &layout, own.len());
        let shown = vec![Visibility::Seen; own.len()];
        let solved = engine.settle(&layout)?;
        let mut alone = Self { engine, own, layout, solved, loose: None, shown, least };
        alone.vary()?;
        // What others hide is held before nothing but the readings says what a number is.
        for wide in [1.0, WIDE] {
            for k in alone.seen() {
                alone.layout.parameters[alone.layout.fixed + k].size = Size::Flat(wide * likely[k]);
            }
            alone.settle()?;
            while let Some((k, shown)) = alone.least_told() {
                alone.shown[k] = shown;
                let declared = alone.own[k].parameter.mean.abs();
                alone.layout.parameters[alone.layout.fixed + k].size = Size::Of(HELD_OFF * declared);
                alone.settle()?;
            }
        }
        alone.bound()?;
        Some(alone)
    }

    /// Fits them once more.
    fn settle(&mut self) -> Option<()> {
        self.solved = self.engine.settle(&self.layout)?;
        self.vary()?;
        self.loose = self.loosened();
        Some(())
    }

    /// The fit where numbers that are held at zero may be off it.
    fn loosened(&self) -> Option<Fit> {
        let held = &self.solved.held;
        let mut parameters = self.layout.parameters.clone();
        for &column in held {
            let parameter = &mut parameters[column];
            (parameter.size, parameter.mean) = (Size::Of(self.own[column - self.layout.fixed].parameter.mean), 0.0);
        }
        let layout = Layout { parameters, ..self.engine.layout_alone() };
        if held.is_empty() { None } else { Some(self.engine.free(&layout)?.fit) }
    }

    /// Fits them again until what a compliance varies by with its coordinate, a share of it, goes with it.
    fn vary(&mut self) -> Option<()> {
        let varies = |effect: &Effect| matches!(effect, Effect::PoseDependentCompliance { .. });
        if !self.engine.robot.effects.iter().any(varies) {
            return Some(());
        }
        for _ in 0..PASSES {
            let fixed = fixed(&self.description());
            self.layout.parameters.splice(..fixed.len(), fixed);
            self.solved = self.engine.settle(&self.layout)?;
        }
        Some(())
    }

    /// Holds numbers of effects next to the largest that a description takes beside the others, where the fit goes
    /// beyond them.
    fn bound(&mut self) -> Option<()> {
        for _ in 0..PASSES {
            let found = self.description();
            if is_readable(&found) {
                break;
            }
            let Some(shares) = shares(&found) else { break };
            for k in self.seen() {
                if let Own::Effect(index, _) = self.own[k].what
                    && shares[index] < 1.0
                {
                    let at = shares[index] * self.value(k);
                    let parameter = &mut self.layout.parameters[self.layout.fixed + k];
                    (parameter.mean, parameter.size) = (at, Size::Of(0.0));
                }
            }
            self.settle()?;
        }
        Some(())
    }

    /// The description with the numbers that the readings show.
    pub fn description(&self) -> Description {
        let value = |changed, k: usize| with_value(changed, &self.own[k], self.value(k));
        self.seen().into_iter().fold(self.engine.robot.clone(), value)
    }

    /// The indices of the numbers that the readings show.
    pub fn seen(&self) -> Vec<usize> {
        (0..self.own.len()).filter(|&k| self.shown[k] == Visibility::Seen).collect()
    }

    /// Whether a number is held at zero, for it cannot be negative.
    pub fn is_at_bound(&self, k: usize) -> bool {
        self.solved.held.contains(&(self.layout.fixed + k))
    }

    /// Whether every joint that shows would be less than rigid.
    pub fn is_against_the_loads(&self) -> bool {
        let is_joint = |k: &usize| matches!(self.own[*k].what, Own::Joint(_));
        let mut joints = self.seen().into_iter().filter(is_joint).peekable();
        joints.peek().is_some() && joints.all(|k| self.is_at_bound(k))
    }

    /// The value of a number, as fitted or as declared.
    pub fn value(&self, k: usize) -> f64 {
        match self.shown[k] {
            Visibility::Seen => self.solved.fit.value(self.layout.fixed + k),
            _ => self.own[k].parameter.mean,
        }
    }

    /// One standard deviation of a number that was fitted: of the normal distribution that has the same 95 %
    /// interval, however few readings there are.
    pub fn std(&self, k: usize) -> Option<f64> {
        let column = self.layout.fixed + k;
        let at = self.solved.fit.place(column).filter(|_| self.shown[k] == Visibility::Seen)?;
        let loose = self.loose.as_ref().and_then(|fit| Some(fit.std[fit.place(column)?]));
        let std = self.solved.fit.std[at].max(loose.unwrap_or(0.0));
        Some(std * self.widened()).filter(|std| *std > 0.0)
    }

    /// By how much standard deviations are larger than in a fit: the variance of a reading is itself known from
    /// so many degrees of freedom only. An unloaded reading is as noisy as the others, and one of them.
    fn widened(&self) -> f64 {
        let (fit, before) = (&self.solved.fit, self.engine.readings_before());
        let is_reading = |column: usize| matches!(self.layout.parameters[column].size, Size::Noise);
        let (mut freedom, mut squares) = (fit.count + before, fit.rss + before * self.engine.prior.size.powi(2));
        for (&column, (share, mean)) in fit.columns.iter().zip(fit.shares().into_iter().zip(&fit.mean)) {
            match is_reading(column) {
                true => squares += mean * mean,
                false => freedom -= share,
            }
        }
        if freedom <= 0.0 {
            return f64::INFINITY;
        }
        let scatter = squares / freedom * (student(freedom) / WITHIN).powi(2);
        let least = self.least.max(FINEST * FINEST) / self.engine.noise.of_middle_row();
        (scatter.max(least) / fit.variance).sqrt()
    }

    /// The correlations of the numbers; those that were not fitted have none.
    pub fn correlation(&self) -> DMatrix<f64> {
        let covariance = self.solved.fit.covariance();
        let place = |k: usize| {
            self.std(k).filter(|std| *std > 0.0)?;
            self.solved.fit.place(self.layout.fixed + k)
        };
        let places: Vec<Option<usize>> = (0..self.own.len()).map(place).collect();
        DMatrix::from_fn(self.own.len(), self.own.len(), |i, j| match (places[i], places[j]) {
            _ if i == j => 1.0,
            (Some(a), Some(b)) => covariance[(a, b)] / (covariance[(a, a)] * covariance[(b, b)]).sqrt(),
            _ => 0.0,
        })
    }

    /// The number that the readings tell the least of, if they do not tell it from what was declared: its
    /// standard deviation hides it, or zero fits, where it is held, and the declared value as well.
    fn least_told(&self) -> Option<(usize, Visibility)> {
        // Readings against the loads are refused as such, not held as if they told nothing.
        if self.is_against_the_loads() {
            return None;
        }
        let hidden = self.seen().into_iter().filter(|&k| !self.is_at_bound(k)).filter_map(|k| {
            // Of one that moves no reading there is no number at all.
            let std = self.std(k).unwrap_or(f64::INFINITY);
            (!self.stands_out(k, self.value(k), std)).then(|| (self.own[k].parameter.mean.abs() / std, k))
        });
        if let Some((_, k)) = hidden.min_by(|a, b| a.0.total_cmp(&b.0)) {
            return Some((k, self.hidden_by(k)));
        }
        let clipped: Vec<usize> = self.seen().into_iter().filter(|&k| self.is_at_bound(k)).collect();
        if clipped.is_empty() {
            return None;
        }
        let free = self.engine.free(&self.layout)?;
        let alike = clipped.into_iter().filter_map(|k| {
            let at = free.fit.place(self.layout.fixed + k)?;
            let (value, std) = (free.fit.mean[at], free.fit.std[at] * self.widened());
            let declared = self.own[k].parameter.mean;
            let more = ((declared - value).powi(2) - value * value) / (std * std);
            (declared > 0.0 && more < TOLD_APART).then_some((more, k))
        });
        alike.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| (k, Visibility::Unseen))
    }

    /// Whether a number stands out from its standard deviation.
    fn stands_out(&self, k: usize, value: f64, std: f64) -> bool {
        let declared = self.own[k].parameter.mean.abs();
        let is_far = declared > 0.0 && value.abs() > FAR * declared;
        let enough = if is_far { FAR_STANDS_OUT } else { FITTED_STANDS_OUT };
        declared >= DECLARED_STANDS_OUT * std || value.abs() >= enough * std
    }

    /// What hides a number: others where it would show with one of them known, or nothing does.
    fn hidden_by(&self, k: usize) -> Visibility {
        let fit = &self.solved.fit;
        let Some(at) = fit.place(self.layout.fixed + k) else { return Visibility::Unseen };
        let (covariance, widened) = (fit.covariance(), self.widened());
        let others = self.seen().into_iter().filter(|&other| {
            let Some(place) = fit.place(self.layout.fixed + other).filter(|_| other != k) else { return false };
            let shared = covariance[(at, place)].powi(2) / covariance[(place, place)];
            let std = (covariance[(at, at)] - shared).max(0.0).sqrt() * widened;
            self.stands_out(k, self.own[k].parameter.mean, std)
        });
        let others: Vec<usize> = others.collect();
        if others.is_empty() { Visibility::Unseen } else { Visibility::Confounded(others) }
    }

    /// How many of the numbers move a reading.
    pub fn moving(&self) -> usize {
        (0..self.own.len())
            .filter(|&k| self.is_at_bound(k) || self.solved.fit.place(self.layout.fixed + k).is_some())
            .count()
    }

    /// Whether any of the numbers moves a reading.
    pub fn moves_any(&self) -> bool {
        self.moving() > 0
    }

    /// The rows that do not belong to the others; none where these are many.
    pub fn outliers(&self) -> &[usize] {
        let rows = self.engine.noise.apart.rows();
        if rows.len() > most_apart(self.engine.observation.readings().rows()) { &[] } else { rows }
    }

    /// What the numbers leave of every row with some values, wherever the robot stands; the table and the reflector
    /// are as declared.
    pub fn left(&self, values: impl Fn(usize) -> f64) -> Option<DVector<f64>> {
        let mut layout = self.engine.layout_alone();
        let value = |changed, k: usize| with_value(changed, &self.own[k], values(k));
        let fixed = fixed(&(0..self.own.len()).fold(self.engine.robot.clone(), value));
        layout.parameters.splice(..fixed.len(), fixed);
        for k in layout.always() {
            let number = k - layout.fixed;
            let parameter = &mut layout.parameters[k];
            if number < self.own.len() {
                (parameter.mean, parameter.sign) = (values(number), Sign::Free);
            }
            if !matches!(parameter.size, Size::Flat(_)) {
                parameter.size = Size::Of(0.0);
            }
        }
        let point = Point { world: self.engine.point.world.clone(), values: BTreeMap::new() };
        Some(self.engine.solve(&layout, &[], (&point, 0), STEPS)?.left)
    }
}

/// What is likely of each of so many own numbers, in its unit: what a search takes for likely, or what would account for
/// all that was read, if that is more. Readings in another unit are so many times what they should be.
fn likely(engine: &Engine<'_>, layout: &Layout, own: usize) -> Vec<f64> {
    let readings = engine.observation.readings();
    let moves = moves(readings, &engine.linearise(layout, &engine.point), &engine.training);
    let read = if readings.differences { readings.rms(&readings.values, 0..readings.rows()) } else { 0.0 };
    let of = |k: usize| {
        let column = layout.fixed + k;
        let sd = match layout.parameters[column].size {
            Size::Of(sd) => sd,
            _ => 0.0,
        };
        if moves[column] > 0.0 { sd.max(read / moves[column]) } else { sd }
    };
    (0..own).map(of).collect()
}

/// Passes until numbers go with each other that no fit takes together.
const PASSES: usize = 8;

/// Weights by which no row says more of the numbers than the middle one does: a load that is far too large would
/// decide them alone, and leave nothing of itself. From there on rows weigh by what is left of them.
fn evened(engine: &Engine<'_>) -> Vec<f64> {
    let readings = engine.observation.readings();
    if engine.scene.what != What::Displacements {
        return engine.noise.weights.clone();
    }
    let layout = engine.layout_alone();
    let columns = engine.linearise(&layout, &engine.point);
    let of_row = |row: usize| -> f64 {
        let of = |k: usize| match layout.parameters[k].size {
            Size::Of(sd) => sd * sd * columns.view((row * readings.width, k), (readings.reported, 1)).norm_squared(),
            _ => 0.0,
        };
        layout.always().map(of).sum()
    };
    let says: Vec<f64> = (0..readings.rows()).map(of_row).collect();
    let middle = median(says.iter().copied().filter(|says| *says > 0.0).collect());
    says.into_iter().map(|says| if says > middle { middle / says } else { 1.0 }).collect()
}

/// Steps to where the robot stands.
const STEPS: usize = 8;
