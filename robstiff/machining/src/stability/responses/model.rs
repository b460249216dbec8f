//! The model of responses, and what it leaves of them.

use nalgebra::{Complex, Vector3};

use super::lines::Lines;

/// A mode, in the units of the [lines](Lines).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// The natural frequency.
    pub frequency: f64,
    /// The damping ratio.
    pub damping: f64,
    /// The mass-normalised shape.
    pub shape: Vector3<f64>,
}

/// Modes, and what stands for those outside the band, by pairs of directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// The modes.
    pub modes: Vec<Mode>,
    /// `L` of the modes below.
    pub below: Option<Vec<f64>>,
    /// `U` of the modes above.
    pub above: Option<Vec<f64>>,
}

/// `1 / (w_k^2 - w^2 + 2 i z_k w_k w)`.
pub fn resonance(natural: f64, damping: f64, frequency: f64) -> Complex<f64> {
    Complex::new((natural - frequency) * (natural + frequency), 2.0 * damping * natural * frequency).inv()
}

impl Model {
    /// How many numbers it consists of.
    pub fn parameters(&self) -> usize {
        let rest = [&self.below, &self.above].map(|rest| rest.as_ref().map_or(0, Vec::len));
        5 * self.modes.len() + rest[0] + rest[1]
    }

    /// The displacement at a line, by a pair of directions and its place.
    pub fn at(&self, frequency: f64, [i, j]: [usize; 2], pair: usize) -> Complex<f64> {
        let of_modes: Complex<f64> = self
            .modes
            .iter()
            .map(|mode| resonance(mode.frequency, mode.damping, frequency) * (mode.shape[i] * mode.shape[j]))
            .sum();
        let below = self.below.as_ref().map_or(0.0, |below| below[pair]);
        let above = self.above.as_ref().map_or(0.0, |above| above[pair]);
        of_modes + above - below / (frequency * frequency)
    }

    /// The sum of the squares of what it leaves.
    pub fn left(&self, lines: &Lines) -> f64 {
        self.sum(lines, |measured, told| (measured - told).norm_sqr())
    }

    /// The sum of the squares of the part of the modes below the band.
    pub fn below_alone(&self, lines: &Lines) -> f64 {
        let alone = Self { modes: Vec::new(), below: self.below.clone(), above: None };
        alone.sum(lines, |_, told| told.norm_sqr())
    }

    fn sum(&self, lines: &Lines, of: impl Fn(Complex<f64>, Complex<f64>) -> f64) -> f64 {
        let mut sum = 0.0;
        for (directions, values) in &lines.responses {
            let pair = lines.pair(*directions);
            for (k, value) in values.iter().enumerate() {
                sum += of(*value, lines.factors[k] * self.at(lines.frequencies[k], *directions, pair));
            }
        }
        sum
    }
}
