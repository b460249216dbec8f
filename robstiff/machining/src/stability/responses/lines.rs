//! The responses in a band, in units of which all numbers are about one.

use core::f64::consts::TAU;

use nalgebra::Complex;

use super::Responses;

/// A place among pairs of directions at which there is none.
pub const NO_DIRECTIONS: usize = usize::MAX;

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
    pub highest: f64,
    /// The first and the last frequency (Hz).
    pub band: [f64; 2],
    /// The root mean square of the values.
    pub size: f64,
    /// How often the displacement is differentiated.
    pub order: i32,
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
}

fn ordered([i, j]: [usize; 2]) -> [usize; 2] {
    [i.min(j), i.max(j)]
}
