//! How the covariance of a campaign's readings is estimated.
//!
//! The restricted likelihood of a model of the robot takes whatever the model lacks
//! for noise, and what is common to a visit, such as lost motion, for the unloaded
//! reading. So it is not asked of a model of the robot, but of the largest one there
//! is: at each pose a free response, linear in the load
//! ([`contrasts`](mod@super::contrasts)). What that leaves knows nothing of compliances,
//! frames and lever arms. A gear that is not linear would remain; so a part with
//! the square of the load, and then a displacement for each distinct load, is
//! freed where the contrasts ask for it (F tests, [`NESTED`]). Then
//!
//! - `lambda` is held to `0..1`, since an unloaded reading is a reading: more in
//!   common is structure, and is left for others to find ([`beyond_one`](super::Share::beyond_one));
//!   where the data tell 0 from 1 no better than chance it is 1;
//! - the axes have one variance unless they differ (Bartlett's test,
//!   [`EQUAL_AXES`]);
//! - outlying readings ([`outliers`](super::outliers)), sought before anything more is freed, are
//!   listed and set aside: they would pass for noise.
//!
//! Where poses have too few rows for that (one load a pose), the axes are taken
//! to be equal and `lambda` to be 1.

use super::contrasts::{Level, contrasts};
use super::estimated::{Estimated, bartlett};
use super::reml::count;
use super::samples::Samples;
use super::{Basis, Covariance, EQUAL_AXES, NESTED, Tails};
use crate::campaign::{Frame, Noise};

/// Outlying readings are looked for at most so many times over.
const PASSES: usize = 8;

impl Covariance {
    /// The covariance of a campaign's readings from the poses for which
    /// `of_pose` holds; the second order of large deflections is best taken from
    /// them ([`straightened`](super::straight::straightened)); `frame` is the
    /// one displacements were measured in. Of `declared` only the ratio of displacement to
    /// rotation is used, where there is no other: how noisy the readings are, they say
    /// themselves.
    pub(crate) fn estimate(samples: &Samples, frame: Frame, declared: Noise, of_pose: impl Fn(usize) -> bool) -> Self {
        Self::estimated(samples, frame, declared, of_pose).0
    }

    /// The same with the tails of what is left, where the readings say something of them: the
    /// noise of thousands of campaigns is drawn for that, and no fit asks.
    pub(crate) fn estimate_with_tails(
        samples: &Samples,
        frame: Frame,
        declared: Noise,
        of_pose: impl Fn(usize) -> bool,
    ) -> (Self, Option<Tails>) {
        let (covariance, estimated) = Self::estimated(samples, frame, declared, of_pose);
        (covariance, estimated.and_then(|estimated| estimated.tails()))
    }

    fn estimated(
        samples: &Samples,
        frame: Frame,
        declared: Noise,
        of_pose: impl Fn(usize) -> bool,
    ) -> (Self, Option<Estimated>) {
        let mut covariance = Self::assumed(samples, frame, declared);
        let readings = covariance.measured(samples);
        let mut left_out = std::vec![false; samples.rows.len()];
        let at = |level, left_out: &[bool]| {
            let chunks = contrasts(samples, &readings, level, &of_pose, |row| left_out[row]);
            Estimated::at(level, chunks, samples.axes)
        };
        // Outlying readings first, where little is free: they make curvature, and where
        // every load has its own displacement no one can say which of two is off.
        for _ in 0..PASSES {
            let Some(linear) = at(Level::Linear, &left_out) else { break };
            let wild = linear.wild();
            if wild.is_empty() {
                break;
            }
            wild.iter().flat_map(|outlier| &outlier.rows).for_each(|row| left_out[*row] = true);
            covariance.outliers.extend(wild);
        }
        let Some(mut estimated) = at(Level::Linear, &left_out) else { return (covariance, None) };
        for level in [Level::Curved, Level::Repeated] {
            if let Some(freer) = at(level, &left_out)
                && estimated.hides_structure(&freer).is_some_and(|p| p <= NESTED)
            {
                // What rows of a visit have in common shows against the linear.
                let share = estimated.share;
                estimated = freer;
                estimated.share = share;
            }
        }
        covariance.take(&estimated);
        covariance.outliers.sort_by_key(|outlier| outlier.rows[0]);
        (covariance, Some(estimated))
    }

    /// Variances of single axes, or of all alike where they do not differ.
    fn set_variances(&mut self, variances: &[f64], freedom: f64) {
        self.equal_axes = bartlett(&variances[..3], freedom);
        self.unequal = self.equal_axes.is_some_and(|p| p <= EQUAL_AXES);
        let mut variances = variances.to_vec();
        for kind in variances.chunks_mut(3) {
            let mean = kind.iter().sum::<f64>() / kind.len() as f64;
            let alike = bartlett(kind, freedom).is_none_or(|p| p > EQUAL_AXES);
            // Without noise, as on simulated readings, all weigh the same.
            kind.iter_mut().for_each(|variance| *variance = if alike { mean } else { variance.max(1e-6 * mean) });
        }
        if variances[0] > 0.0 && variances.last().is_some_and(|last| *last > 0.0) {
            self.own = variances.into_iter().map(f64::sqrt).collect();
        }
    }

    fn take(&mut self, estimated: &Estimated) {
        self.basis = Basis::Contrasts(estimated.level);
        self.freedom = count(&estimated.chunks);
        self.shared = estimated.shared;
        self.share = estimated.share;
        self.set_variances(&estimated.variances, self.freedom as f64);
    }
}
