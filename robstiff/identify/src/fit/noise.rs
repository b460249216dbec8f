//! Where the noise of a reading is known from.

use nalgebra::DVector;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::case::Case;
use crate::campaign::Campaign;
use crate::effects::What;

/// Where the noise of a reading is known from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseSource {
    /// The campaign declares it.
    Declared,
    /// The campaign declares less than the step that readings are in: with what their rounding adds.
    Rounded,
    /// From what repeated readings differ by.
    Repetitions,
    /// From what the model leaves: an upper bound, since it counts what the model lacks as noise.
    Residuals,
}

impl NoiseSource {
    /// Whether the campaign says it.
    pub fn is_declared(self) -> bool {
        matches!(self, Self::Declared | Self::Rounded)
    }
}

/// With fewer degrees of freedom a variance is uncertain by half and more (`sqrt(2 / 10)` is 45 %).
const FEWEST_REPETITIONS: usize = 10;

/// Two loads are the same if they differ by less than this part of the usual load.
const SAME: f64 = 1e-3;

/// The noise of one axis of a reading that is known independently of the model (m, rad), and from
/// what; `left` is the residual of each row.
pub fn known(campaign: &Campaign, case: &Case<'_>, left: &DVector<f64>) -> Option<Known> {
    if let Some(size) = case.noise {
        let source = if campaign.step_beyond_noise().is_some() { NoiseSource::Rounded } else { NoiseSource::Declared };
        return Some(Known { size, source, freedom: None });
    }
    let (size, count) = repeated(case, left)?;
    Some(Known { size, source: NoiseSource::Repetitions, freedom: Some(count as f64) })
}

/// A noise that is known independently of the model.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// Of one axis of one reading (m, rad).
    pub size: f64,
    /// From what.
    pub source: NoiseSource,
    /// From how many degrees of freedom; none where it is declared.
    freedom: Option<f64>,
}

/// The part of the cases in which chance alone makes noise seem smaller than that.
const BY_CHANCE: f64 = 0.01;

impl Known {
    /// By which factor the noise may be larger than known, in all but one in a hundred cases: what few
    /// repetitions scatter by is uncertain.
    pub fn by_chance(&self) -> f64 {
        let least = |freedom: f64| Some(ChiSquared::new(freedom).ok()?.inverse_cdf(BY_CHANCE) / freedom);
        self.freedom.and_then(least).map_or(1.0, |least| 1.0 / least.sqrt())
    }
}

/// From readings of one visit under the same load, of absolute positions of one pose: whatever a model predicts
/// of two of them is the same but for what depends on their order, which the best model has taken out. With the
/// degrees of freedom.
fn repeated(case: &Case<'_>, left: &DVector<f64>) -> Option<(f64, usize)> {
    let readings = case.observation.readings();
    let (mut sum, mut count) = (0.0, 0);
    // No two positions share an unloaded reading, and each time that a pose is reached has a noise of its own.
    let of = if case.scene.what == What::Positions { &readings.block } else { &readings.visit };
    let mut rows: Vec<Vec<usize>> = vec![Vec::new(); of.iter().max().map_or(0, |last| last + 1)];
    of.iter().enumerate().for_each(|(row, &group)| rows[group].push(row));
    for rows in rows {
        let mut used = vec![false; rows.len()];
        for i in 0..rows.len() {
            let same = |j: &usize| !used[*j] && case.is_same_load(rows[i], rows[*j], SAME);
            let alike: Vec<usize> = (i..rows.len()).filter(same).collect();
            if used[i] || alike.len() < 2 {
                continue;
            }
            alike.iter().for_each(|&j| used[j] = true);
            for k in 0..readings.reported {
                let of: Vec<f64> = alike.iter().map(|&j| left[rows[j] * readings.width + k]).collect();
                let mean = of.iter().sum::<f64>() / of.len() as f64;
                sum += of.iter().map(|one| (one - mean).powi(2)).sum::<f64>();
                count += of.len() - 1;
            }
        }
    }
    (count >= FEWEST_REPETITIONS).then(|| ((sum / count as f64).sqrt(), count))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lower hundredth of chi-square with ten degrees of freedom is 2.558.
    #[test]
    fn few_repetitions_leave_a_noise_uncertain() {
        let known = |freedom| Known { size: 1e-6, source: NoiseSource::Repetitions, freedom };
        assert!((known(Some(10.0)).by_chance() - (10.0_f64 / 2.558).sqrt()).abs() < 1e-3);
        assert!(known(Some(2000.0)).by_chance() < 1.04);
        assert_eq!(known(None).by_chance(), 1.0);
    }
}
