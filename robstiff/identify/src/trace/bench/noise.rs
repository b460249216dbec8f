//! How noisy the readings are, once it is known what they are not.
//!
//! The noise is learnt from a free response, linear in the load, at each pose
//! ([`covariance`](crate::identify::covariance)). What is no function of the
//! load, as hysteresis and creep, no response at a pose takes up: the ways up
//! and down differ, and pass for noise that rows of a visit do *not* have in
//! common. A named effect is taken from the readings, and the noise is learnt
//! again; otherwise the unloaded readings of whole visits would look wild.

use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use super::Bench;
use crate::identify::covariance::{Basis, Covariance, Outlier};
use crate::identify::noise::{PureError, repetitions};
use crate::identify::prepare::Prepared;
use crate::identify::samples::Samples;
use crate::trace::model::Named;

/// What is known of the noise.
#[derive(Clone, Debug)]
pub struct Known {
    /// The covariance of the readings.
    pub covariance: Covariance,
    /// The rows that say so: without what is known to be no noise.
    straight: Rc<Samples>,
}

/// The noise has changed where the standard deviation of an axis, or of a
/// visit's unloaded reading, changes by more than this share.
const CHANGED: f64 = 0.02;

impl Known {
    /// What is known before anything is named.
    pub fn of(prepared: &Prepared<'_>) -> Self {
        Self { covariance: prepared.covariance.clone(), straight: Rc::clone(&prepared.straight) }
    }

    fn differs(&self, other: &Self) -> bool {
        let of = |known: &Self| {
            let unloaded = known.covariance.shared.sqrt();
            let of_tool = known.covariance.own.iter().map(|own| (*own, own * unloaded));
            let encoders = known.covariance.encoders.iter().flat_map(|noise| noise.own.iter().map(|own| (*own, *own)));
            of_tool.chain(encoders).collect::<Vec<_>>()
        };
        let moved = |a: f64, b: f64, size: f64| (a - b).abs() > CHANGED * size;
        of(self).into_iter().zip(of(other)).any(|(a, b)| moved(a.0, b.0, a.0) || moved(a.1, b.1, a.0))
    }
}

impl Bench<'_> {
    /// Learns the noise from readings without what a model's effects do;
    /// whether it is another than before.
    ///
    /// # Errors
    /// Why the model cannot be fitted.
    pub fn learn_noise(&mut self, named: &[Named]) -> Result<bool, String> {
        let prepared = self.prepared;
        let known = if named.is_empty() { Known::of(prepared) } else { self.noise_without(named)? };
        // A covariance that was assumed has been weighed by what a fit leaves.
        if !matches!(known.covariance.basis, Basis::Contrasts(_)) || !known.differs(&self.noise) {
            return Ok(false);
        }
        self.noise = Rc::new(known);
        self.forget();
        Ok(true)
    }

    /// What repeated readings differ by, of the rows that are fitted to; nothing is known of
    /// it where a coarse gauge rounds them alike.
    pub fn repeated(&self) -> PureError {
        let Known { covariance, straight } = &*self.noise;
        let pure = repetitions(straight, covariance, |pose| self.prepared.training[pose], |row| self.left_out[row]);
        match pure.variance() {
            Some(variance) if self.prepared.data.is_coarse(variance) => PureError::of([].into_iter()),
            _ => pure,
        }
    }

    /// The readings of poses for which `of_pose` holds that the others of their own pose
    /// contradict, whatever the compliance there: without what a model's effects do, for that
    /// may not be linear in the load.
    ///
    /// # Errors
    /// Why the model cannot be fitted.
    pub(super) fn contradicted(
        &self,
        named: &[Named],
        of_pose: impl Fn(usize) -> bool,
    ) -> Result<Vec<Outlier>, String> {
        let samples = if named.is_empty() { Rc::clone(&self.prepared.straight) } else { Rc::new(self.left_by(named)?) };
        let frame = self.prepared.data.measured_frame;
        Ok(Covariance::estimate(&samples, frame, self.campaign.noise, of_pose).beyond_doubt())
    }

    fn noise_without(&self, named: &[Named]) -> Result<Known, String> {
        let prepared = self.prepared;
        let samples = self.left_by(named)?;
        let training = |pose: usize| prepared.training[pose];
        let frame = prepared.data.measured_frame;
        let mut covariance = Covariance::estimate(&samples, frame, self.campaign.noise, training);
        covariance.encoders = covariance.encoders.or_else(|| self.noise.covariance.encoders.clone());
        Ok(Known { covariance, straight: Rc::new(samples) })
    }

    /// The rows with what a model leaves in place of what was read.
    fn left_by(&self, named: &[Named]) -> Result<Samples, String> {
        let setting = self.at(named)?;
        let fit = setting.fit(named)?.fit;
        // What the model leaves, not the readings less each effect's column: what
        // creeps has its creep in every column. That the joints are taken out as
        // well is no matter, for a response in proportion to the load is free.
        let left = setting.residuals(&fit) - &setting.correction;
        let mut samples = Samples::clone(&self.prepared.samples);
        let axes = samples.axes;
        for i in 0..samples.rows.len() {
            let of_encoders = samples.encoders_of(i);
            let row = &mut samples.rows[i];
            row.turned.iter_mut().zip(of_encoders).for_each(|(turned, at)| *turned = left[at]);
            row.displacement = left.fixed_rows::<3>(i * axes).into_owned();
            if axes > 3 {
                row.rotation = left.fixed_rows::<3>(i * axes + 3).into_owned();
            }
        }
        Ok(samples)
    }
}
