//! All parameters of a model together, by damped least squares (Marquardt, SIAM J. Applied Mathematics 11
//! (1963) 431-441).

use nalgebra::{Cholesky, Complex, DMatrix, DVector};

use super::lines::Lines;
use super::model::{Mode, Model, resonance};
use super::poles::Pole;

/// Steps, at the most.
const STEPS: usize = 40;
/// A share of the squares that is no gain.
const NO_GAIN: f64 = 1e-9;
/// What the damping of the steps begins with, over the diagonal.
const BEGIN: f64 = 1e-3;
/// Beyond it no step helps.
const STUCK: f64 = 1e8;

impl Model {
    /// The model near this one that leaves least, with what it leaves (the sum of the squares). Modes stay in
    /// the band, and damped.
    pub fn refined(mut self, lines: &Lines) -> (Self, f64) {
        let mut left = self.left(lines);
        let mut damping = BEGIN;
        for _ in 0..STEPS {
            let (normal, slope) = self.equations(lines);
            let before = left;
            while damping < STUCK {
                let next = self.stepped(&normal, &slope, damping).filter(|next| next.is_physical(lines));
                let next = next.map(|next| (next.left(lines), next)).filter(|(now, _)| *now < left);
                let Some((now, next)) = next else {
                    damping *= 10.0;
                    continue;
                };
                (self, left) = (next, now);
                damping *= 0.1;
                break;
            }
            if before - left <= NO_GAIN * before {
                break;
            }
        }
        (self, left)
    }

    fn is_physical(&self, lines: &Lines) -> bool {
        let band = [lines.frequencies[0], 1.0];
        let pole = |mode: &Mode| Pole { frequency: mode.frequency, damping: mode.damping };
        self.modes.iter().all(|mode| pole(mode).is_physical(band) && mode.shape.iter().all(|part| part.is_finite()))
    }

    /// One step further.
    fn stepped(&self, normal: &DMatrix<f64>, slope: &DVector<f64>, damping: f64) -> Option<Self> {
        let mut damped = normal.clone();
        for i in 0..slope.len() {
            // A parameter that changes nothing stays.
            damped[(i, i)] += damping * normal[(i, i)] + f64::MIN_POSITIVE;
        }
        let step = Cholesky::new(damped)?.solve(slope);
        let mut next = self.clone();
        for (mode, step) in next.modes.iter_mut().zip(step.as_slice().chunks(5)) {
            mode.frequency *= step[0].exp();
            mode.damping *= step[1].exp();
            (0..3).for_each(|i| mode.shape[i] += step[2 + i]);
        }
        let rest = next.below.iter_mut().chain(&mut next.above).flatten();
        rest.zip(&step.as_slice()[5 * self.modes.len()..]).for_each(|(value, step)| *value += step);
        Some(next)
    }

    /// The normal equations of a step. The parameters are of each mode the logarithms of frequency and damping
    /// and the shape, then `L` and `U`.
    fn equations(&self, lines: &Lines) -> (DMatrix<f64>, DVector<f64>) {
        let (count, modes) = (self.parameters(), self.modes.len());
        let (mut normal, mut slope) = (DMatrix::zeros(count, count), DVector::zeros(count));
        let mut row: Vec<(usize, Complex<f64>)> = Vec::with_capacity(4 * modes + 2);
        for (directions, values) in &lines.responses {
            let ([i, j], pair) = (*directions, lines.pair(*directions));
            for (k, value) in values.iter().enumerate() {
                let (frequency, factor) = (lines.frequencies[k], lines.factors[k]);
                row.clear();
                let mut told = Complex::from(0.0);
                for (mode, Mode { frequency: natural, damping, shape }) in self.modes.iter().enumerate() {
                    let part = factor * resonance(*natural, *damping, frequency);
                    let product = part * (shape[i] * shape[j]);
                    let turned = Complex::new(0.0, 2.0 * damping * natural * frequency);
                    let inverse = resonance(*natural, *damping, frequency);
                    told += product;
                    row.push((5 * mode, -product * inverse * (turned + 2.0 * natural * natural)));
                    row.push((5 * mode + 1, -product * inverse * turned));
                    if i == j {
                        row.push((5 * mode + 2 + i, part * (2.0 * shape[i])));
                    } else {
                        row.push((5 * mode + 2 + i, part * shape[j]));
                        row.push((5 * mode + 2 + j, part * shape[i]));
                    }
                }
                let mut place = 5 * modes + pair;
                if let Some(below) = &self.below {
                    let part = -factor / (frequency * frequency);
                    told += part * below[pair];
                    row.push((place, part));
                    place += below.len();
                }
                if let Some(above) = &self.above {
                    told += factor * above[pair];
                    row.push((place, factor));
                }
                let left = value - told;
                for (n, (a, one)) in row.iter().enumerate() {
                    slope[*a] += (one.conj() * left).re;
                    for (b, other) in &row[n..] {
                        normal[(*a, *b)] += (one.conj() * other).re;
                    }
                }
            }
        }
        for a in 0..count {
            for b in 0..a {
                let both = normal[(a, b)] + normal[(b, a)];
                (normal[(a, b)], normal[(b, a)]) = (both, both);
            }
        }
        (normal, slope)
    }
}
