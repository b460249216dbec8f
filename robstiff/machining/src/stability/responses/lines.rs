//! The responses in a band, in units of which all numbers are about one.

use core::f64::consts::TAU;

use nalgebra::Complex;

use super::model::{Model, NO_DIRECTIONS};
use super::rest;
use super::{Fit, FittedModes, Responses};
use crate::stability::{MeasuredMode, Spring};

/// The lines of the responses that are fitted.
pub struct Lines {
    /// Over the highest.
    pub frequencies: Vec<f64>,
    /// What makes a displacement the measured motion, at each.
    pub factors: Vec<Complex<f64>>,
    /// Directions and values of each response, over the root mean square of all values.
    pub responses: Vec<([usize; 2], Vec<Complex<f64>>)>,
    /// The pairs of directions that were measured, those of force and response exchanged being one.
    pub pairs: Vec<[usize; 2]>,
    /// The highest frequency (rad/s).
    highest: f64,
    /// The first and the last frequency (Hz).
    band: [f64; 2],
    /// The root mean square of the values.
    size: f64,
    /// How often the displacement is differentiated.
    order: i32,
}

impl Lines {
    /// Those of responses.
    pub fn new(responses: &Responses) -> Self {
        let highest = responses.frequencies.last().copied().unwrap_or(1.0);
        let frequencies: Vec<f64> = responses.frequencies.iter().map(|frequency| frequency / highest).collect();
        let mut all: Vec<_> =
            responses.all.iter().map(|response| (response.directions, response.values.clone())).collect();
        let sum: f64 = all.iter().flat_map(|(_, values)| values).map(|value| value.norm_sqr()).sum();
        let mean = (sum / (all.len() * frequencies.len()) as f64).sqrt();
        let size = if mean > 0.0 && mean.is_finite() { mean } else { 1.0 };
        all.iter_mut().flat_map(|(_, values)| values).for_each(|value| *value /= size);
        let mut pairs: Vec<[usize; 2]> = all.iter().map(|(directions, _)| ordered(*directions)).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let order = responses.motion.order();
        let band = [responses.frequencies.first().copied().unwrap_or(highest), highest];
        let factors = frequencies.iter().map(|&frequency| Complex::new(0.0, frequency).powi(order)).collect();
        Self { frequencies, factors, responses: all, pairs, highest: TAU * highest, band, size, order }
    }

    /// How many real numbers were measured.
    pub fn numbers(&self) -> usize {
        2 * self.responses.len() * self.frequencies.len()
    }

    /// The place among the pairs.
    pub fn pair(&self, directions: [usize; 2]) -> usize {
        let directions = ordered(directions);
        self.pairs.iter().position(|pair| *pair == directions).unwrap_or(NO_DIRECTIONS)
    }

    /// The sum of the squares of all values.
    pub fn power(&self) -> f64 {
        self.responses.iter().flat_map(|(_, values)| values).map(|value| value.norm_sqr()).sum()
    }

    /// A model in SI units, with what it leaves.
    pub fn unscaled(&self, model: &Model) -> FittedModes {
        // The values are those of `(i w)^order G`.
        let flexibility = self.size / self.highest.powi(self.order);
        let mut modes: Vec<MeasuredMode> = model
            .modes
            .iter()
            .map(|mode| MeasuredMode {
                frequency: self.highest * mode.frequency,
                damping: mode.damping,
                stiffness: mode.frequency.powi(2) / (mode.shape.norm_squared() * flexibility),
                direction: mode.shape.normalize(),
            })
            .collect();
        modes.sort_by(|one, other| one.frequency.total_cmp(&other.frequency));
        let (kept, massless) = rest::massless(self, model);
        let stiffer = |spring: Spring| Spring { stiffness: spring.stiffness / flexibility, ..spring };
        let massless = massless.into_iter().map(stiffer).collect();
        let share = |sum: f64| (sum / self.power()).sqrt();
        let fit = Fit {
            band: self.band,
            lines: self.frequencies.len(),
            responses: self.responses.len(),
            left: share(kept.left(self)),
            below: share(model.below_alone(self)),
        };
        FittedModes { modes, massless, fit }
    }
}

fn ordered([i, j]: [usize; 2]) -> [usize; 2] {
    [i.min(j), i.max(j)]
}
