//! From a campaign to a regression: noise, weights, and what the data can see.

use std::format;
use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use nalgebra::DVector;
use robstiff_robots::Description;

use super::baseline::{Declared, Visibility, declared, visibility, with_values};
use super::column::Column;
use super::covariance::contrasts::Level;
use super::covariance::{Basis, Covariance};
use super::normal::{Fit, Sign};
use super::not_shown::nothing_shows;
use super::problem::{Equations, Problem, Weights, raw};
use super::samples::Samples;
use super::second_order::{beyond_linear, straightened};
use super::wild::leave_out;
use super::{Error, NoiseSource, is_at_bound};
use crate::campaign::holdout::training_of;
use crate::campaign::{Campaign, Data, Displacements};
use crate::words::micrometres;

/// A campaign made ready for regressions.
pub struct Prepared<'c> {
    /// The rows of the table.
    pub data: &'c Displacements,
    /// The rows on the robot.
    pub samples: Rc<Samples>,
    /// Whether each pose is fitted to.
    pub training: Vec<bool>,
    /// Whether each row is left out of the fit, for it [does not
    /// belong](Covariance::beyond_doubt).
    pub left_out: Vec<bool>,
    /// The description's own numbers.
    pub own: Vec<Declared>,
    /// What the data can see of them.
    pub visibility: Vec<Visibility>,
    /// The columns of those that are lost in noise which nothing but the fit itself tells of.
    /// What is missing in it, and rows that are outlying, pass for noise: another model may see them.
    pub doubted: Vec<usize>,
    /// What they are: identified where seen, declared elsewhere.
    pub values: Vec<f64>,
    /// The rows less what is not linear in the load: the second order and declared laws.
    pub straight: Rc<Samples>,
    /// The declared noise of one displacement reading (m), with [what rounding
    /// adds](Campaign::noise_of_reading), unless the readings themselves say that it is [far
    /// less](Covariance::is_far_below).
    pub declared_noise: Option<f64>,
    /// Where that is known from.
    declared_by: NoiseSource,
    /// How noisy the readings are, and how they hang together.
    pub covariance: Covariance,
    /// The second order of the joints' displacement (m).
    pub correction: DVector<f64>,
}

/// Rotation weights converge to three digits within this many passes.
const WEIGHT_PASSES: usize = 4;

/// A joint whose declared compliance is not even one standard deviation, and
/// whose identified one not two, moves the readings less than the noise does:
/// its estimate would be a number made of noise.
pub const DECLARED_STANDS_OUT: f64 = 1.0;
pub const IDENTIFIED_STANDS_OUT: f64 = 2.0;

/// What a maker's compliance is taken to be off by, where a fit holds it: the seed paper's
/// identified ones stayed within it.
const DECLARED_IS_OFF_BY: f64 = 0.25;

/// The declared noise of a reading, with what rounding adds, unless the readings themselves say
/// that it is far less.
pub fn believed_noise(campaign: &Campaign, covariance: &Covariance) -> Option<f64> {
    let declared = campaign.noise.displacement.filter(|&declared| !covariance.is_far_below(declared));
    declared.and(campaign.noise_of_reading())
}

/// That the noise which a campaign of displacements declares is not used, in a sentence, where the
/// noise that is reported (m) is known from elsewhere: the readings show far less.
pub fn noise_not_used(campaign: &Campaign, (noise, source): (f64, NoiseSource)) -> Option<String> {
    let declared = campaign.noise.displacement?;
    let is_used = source.is_declared() || !matches!(campaign.data, Data::Displacement(_));
    (!is_used).then(|| {
        format!(
            "The declared noise of {} is not used: the readings show {}.",
            micrometres(declared),
            micrometres(noise)
        )
    })
}

impl<'c> Prepared<'c> {
    /// The same without the rows that the rest of the campaign contradicts, their load above
    /// all. A trace has no part in this: it weighs rows and deletes none.
    ///
    /// # Errors
    /// Likewise.
    pub fn without_wild(campaign: &'c Campaign) -> Result<Self, Error> {
        Self::of(campaign, true)
    }

    fn of(campaign: &'c Campaign, without_wild: bool) -> Result<Self, Error> {
        let Data::Displacement(data) = &campaign.data else {
            return Err(Error::OtherCampaign(String::from("this needs a campaign of kind `displacement`")));
        };
        let prepared = Self::by(&campaign.robot, campaign, data, without_wild)?;
        if !prepared.own.iter().any(|number| number.column.is_law()) {
            return Ok(prepared);
        }
        // Laws that are no longer as declared would pass for noise.
        Self::by(&with_values(&campaign.robot, &prepared.values), campaign, data, without_wild)
    }

    /// The same, with how noisy the readings are found out when what is not linear in
    /// the load is taken from them by the description `known`.
    fn by(
        known: &Description,
        campaign: &'c Campaign,
        data: &'c Displacements,
        without_wild: bool,
    ) -> Result<Self, Error> {
        let description = &campaign.robot;
        let samples = Samples::of_description(description, data);
        let training = training_of(samples.poses, campaign);
        let own = declared(description);
        let noise = campaign.noise;
        let straight = straightened(&samples, known, |pose| training[pose]);
        let covariance = Covariance::estimate(&straight, data.measured_frame, noise, |pose| training[pose]);
        // Readings that no one knows the noise of have no weight.
        let samples = if covariance.encoders.is_none() { samples.without_encoders() } else { samples };
        let weighed = covariance.reading().is_some() || (noise.displacement.is_some() && noise.rotation.is_some());
        let mut prepared = Self {
            data,
            correction: DVector::zeros(samples.length()),
            values: own.iter().map(|number| number.value).collect(),
            visibility: std::vec![Visibility::Seen; own.len()],
            doubted: Vec::new(),
            own,
            straight: Rc::new(straight),
            declared_noise: believed_noise(campaign, &covariance),
            declared_by: NoiseSource::of_declared(campaign),
            covariance,
            left_out: std::vec![false; samples.rows.len()],
            samples: Rc::new(samples),
            training,
        };
        let settle = |prepared: &mut Self| {
            prepared.visibility = prepared.shown();
            if !weighed && prepared.samples.axes > 3 { prepared.settle_weight() } else { Ok(()) }
        };
        if without_wild {
            let before = prepared.covariance.clone();
            settle(&mut prepared)?;
            if !leave_out(&mut prepared, campaign) {
                prepared.covariance = before;
            }
        }
        prepared.leave_out_beyond_doubt();
        settle(&mut prepared)?;
        prepared.look()?;
        Ok(prepared)
    }

    /// Leaves out the readings that the others of their pose contradict.
    fn leave_out_beyond_doubt(&mut self) {
        let wild = self.covariance.beyond_doubt();
        wild.iter().flat_map(|outlier| &outlier.rows).for_each(|&row| self.left_out[row] = true);
    }

    /// What the data see of the numbers by the geometry of poses and loads.
    fn shown(&self) -> Vec<Visibility> {
        visibility(&self.problem().total, self.own.len())
    }

    /// The columns that are fitted: those of the numbers that are seen.
    pub fn seen(&self) -> Vec<usize> {
        (0..self.own.len()).filter(|&i| self.visibility[i] == Visibility::Seen).collect()
    }

    /// The numbers that a fit holds, by column, each with the standard deviation of what it may
    /// be off by: those lost in the noise, or not told from others, at their declared value
    /// ([`DECLARED_IS_OFF_BY`]), and those clipped at zero, from it. Others are no surer
    /// than that lets them be.
    pub fn held(&self, fit: &Fit) -> Vec<(usize, f64)> {
        let spread = |column: usize| {
            let number = &self.own[column];
            match fit.columns.iter().position(|&fitted| fitted == column) {
                Some(k) => is_at_bound(number.sign, number.value, fit.coefficients[k]).then_some(number.value),
                None => Some(DECLARED_IS_OFF_BY * number.value.abs()),
            }
        };
        let held = |column| spread(column).filter(|&spread| spread > 0.0).map(|spread| (column, spread));
        (0..self.own.len()).filter_map(held).collect()
    }

    /// Holds one of the description's numbers as declared from now on.
    pub fn hold(&mut self, column: usize) {
        self.visibility[column] = Visibility::Unseen;
        self.values[column] = self.own[column].value;
        self.correction = beyond_linear(&self.samples, &self.values[..self.samples.joints()]);
    }

    /// Whether by a fit every joint that is fitted would be less than rigid.
    pub fn is_against_the_loads(&self, fit: &Fit) -> bool {
        let numbers = fit.columns.iter().zip(fit.coefficients.iter());
        let mut joints = numbers.filter(|(column, _)| **column < self.samples.joints()).peekable();
        let is_clipped =
            |(&column, &value): (&usize, &f64)| is_at_bound(self.own[column].sign, self.own[column].value, value);
        joints.peek().is_some() && joints.all(is_clipped)
    }

    /// The description's numbers with those of a fit.
    pub fn with(&self, fit: &Fit) -> Vec<f64> {
        let mut values = self.values.clone();
        for (&column, &value) in fit.columns.iter().zip(fit.coefficients.iter()) {
            values[column] = value;
        }
        values
    }

    /// The regression with the description's columns. What numbers that are
    /// held at their declared value do is taken from the readings.
    pub fn problem(&self) -> Problem {
        let columns: Vec<Column> = self.own.iter().map(|number| number.column).collect();
        let readings = self.readings(&self.samples);
        let weights = Weights { covariance: &self.covariance, training: &self.training, left_out: &self.left_out };
        Problem::new(&self.samples, raw(&self.samples, &columns), readings, &self.correction, weights)
    }

    /// The readings less what numbers do that are held at their declared value,
    /// stacked.
    pub fn readings(&self, samples: &Samples) -> DVector<f64> {
        self.readings_beside(samples, &self.seen())
    }

    /// The same where the numbers of these columns are fitted, and no others.
    pub fn readings_beside(&self, samples: &Samples, fitted: &[usize]) -> DVector<f64> {
        let mut readings = samples.readings();
        for (column, number) in self.own.iter().enumerate() {
            if !fitted.contains(&column) && number.value != 0.0 {
                readings.axpy(-number.value, &samples.column(number.column), 1.0);
            }
        }
        readings
    }

    /// The noise of one displacement reading (m), given the residual variance
    /// (m^2), and where it is from.
    pub fn noise(&self, residual_variance: f64) -> (f64, NoiseSource) {
        match (self.declared_noise, self.covariance.reading(), self.covariance.basis) {
            (Some(declared), ..) => (declared, self.declared_by),
            (None, Some(reading), Basis::Contrasts(Level::Repeated)) => (reading, NoiseSource::Repetitions),
            (None, Some(reading), Basis::Contrasts(_)) => (reading, NoiseSource::Poses),
            _ => (residual_variance.sqrt(), NoiseSource::Residuals),
        }
    }

    /// Displacements and rotations weighted by what the fit leaves of each.
    fn settle_weight(&mut self) -> Result<(), Error> {
        // A displacement of a millimetre goes with a rotation of one metre's
        // lever: a start that the first pass corrects.
        for _ in 0..WEIGHT_PASSES {
            let problem = self.problem();
            let fit = fit(self, &problem)?;
            let residuals = problem.white_residuals(&fit.columns, &fit.coefficients);
            // Of the rows that are fitted to; encoders, behind all rows, are neither.
            let rows = problem.axes * self.samples.rows.len();
            let fitted = || problem.blocks.iter().flat_map(|block| &block.stacked).filter(|&&i| i < rows);
            let sum = |rotations: bool| -> f64 {
                let of_kind = |i: &&usize| (**i % problem.axes >= 3) == rotations;
                fitted().filter(of_kind).map(|&i| residuals[i] * residuals[i]).sum()
            };
            let (displacement, rotation) = (sum(false), sum(true));
            if displacement > 0.0 && rotation > 0.0 {
                self.covariance.weigh_rotations((displacement / rotation).sqrt());
            }
        }
        Ok(())
    }

    /// Finds out which numbers are seen, first by the geometry, then against
    /// the noise; and their values.
    fn look(&mut self) -> Result<(), Error> {
        self.visibility = self.shown();
        let fitted = loop {
            let problem = self.problem();
            let fitted = fit(self, &problem)?;
            let lost = self.lost(&problem, &fitted, |_| true);
            if lost.is_empty() {
                break fitted;
            }
            lost.iter().for_each(|&column| self.visibility[column] = Visibility::Unseen);
            if self.noise(0.0).1 == NoiseSource::Residuals {
                self.doubted.extend(lost);
            }
        };
        for (&column, &value) in fitted.columns.iter().zip(fitted.coefficients.iter()) {
            self.values[column] = value;
        }
        self.correction = beyond_linear(&self.samples, &self.values[..self.samples.joints()]);
        Ok(())
    }

    /// Of the description's numbers for which `may` holds, the column of the one that is lost in
    /// the noise the most, if any is: one at a time, for of two that look alike either may be
    /// seen without the other. All columns where none stands out, for then the readings say
    /// nothing of any.
    pub fn lost(&self, problem: &Equations, fitted: &Fit, may: impl Fn(usize) -> bool) -> Vec<usize> {
        let Some(inverse) = problem.total.inverse(&fitted.columns) else { return Vec::new() };
        let (noise, _) = self.noise(problem.variance(fitted));
        let own = fitted.columns.iter().enumerate().filter(|&(_, &column)| column < self.own.len() && may(column));
        let lost = own.filter_map(|(k, &column)| {
            let std = inverse[(k, k)].sqrt() * noise;
            let declared = self.own[column].value.abs() / std;
            let stands_out =
                declared >= DECLARED_STANDS_OUT || fitted.coefficients[k].abs() >= IDENTIFIED_STANDS_OUT * std;
            (!stands_out).then_some((declared, column))
        });
        let mut lost: Vec<(f64, usize)> = lost.collect();
        lost.sort_by(|a, b| a.0.total_cmp(&b.0));
        let count = if lost.len() == fitted.columns.len() { lost.len() } else { 1 };
        lost.into_iter().take(count).map(|(_, column)| column).collect()
    }
}

/// The description's seen numbers, fitted.
///
/// # Errors
/// If none is seen.
pub fn fit(prepared: &Prepared<'_>, problem: &Problem) -> Result<Fit, Error> {
    let seen = prepared.seen();
    let signs: Vec<Sign> = seen.iter().map(|&i| prepared.own[i].sign).collect();
    let fitted = if seen.is_empty() { None } else { problem.total.solve_signed(&seen, &signs) };
    fitted.ok_or_else(|| nothing_shows(prepared, problem))
}
