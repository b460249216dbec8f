//! The poles that all responses have in common, by the least-squares complex frequency method.

use core::f64::consts::{FRAC_1_SQRT_2, PI};

use nalgebra::{Cholesky, Complex, DMatrix, DVector};

use super::lines::Lines;
use crate::stability::spectrum::Spectrum;

/// The highest order of the denominator: of a higher one rounding takes the normal equations.
pub const MOST_ORDER: usize = 40;
/// What a matrix of sums of squares has left of its largest singular value that is rounding.
const ROUNDING: f64 = 1e-13;
/// How far frequency and damping of a pole move with the order at the most where it is called stable, as
/// usual in diagrams of stabilisation.
const STABLE: [f64; 2] = [0.01, 0.05];
/// The damping ratio from which on a response has no top.
pub const MOST_DAMPING: f64 = FRAC_1_SQRT_2;

/// A pole with its conjugate.
#[derive(Clone, Copy, Debug)]
pub struct Pole {
    /// The natural frequency, over the highest.
    pub frequency: f64,
    /// The damping ratio.
    pub damping: f64,
}

impl Pole {
    /// Whether it may be of a mode within a band.
    pub fn is_physical(&self, [from, to]: [f64; 2]) -> bool {
        self.damping > 0.0 && self.damping < MOST_DAMPING && (from..=to).contains(&self.frequency)
    }

    fn is_stable_from(&self, before: &Self) -> bool {
        (self.frequency - before.frequency).abs() <= STABLE[0] * before.frequency
            && (self.damping - before.damping).abs() <= STABLE[1] * before.damping
    }
}

/// The lines that so many modes need: a denominator with a pair of poles for each mode and one for what is
/// on either side of the band, and a numerator of as high an order, both real.
pub fn least_lines(modes: usize) -> usize {
    order_of(modes) + 1
}

fn order_of(modes: usize) -> usize {
    2 * modes + 4
}

/// The poles in the band that stay where they are when the order goes up, those first that stay longest.
pub fn stable(lines: &Lines) -> Vec<Pole> {
    let sums = Sums::new(lines);
    let band = [lines.frequencies[0], 1.0];
    let mut tracks: Vec<(Pole, usize, usize)> = Vec::new();
    for order in (2..=sums.most).step_by(2) {
        let Some(poles) = sums.poles(order) else { break };
        for pole in poles.into_iter().filter(|pole| pole.is_physical(band)) {
            // Of those that it may continue the nearest, of which it takes the place.
            let before = tracks.iter_mut().filter(|(before, at, _)| *at < order && pole.is_stable_from(before));
            let apart = |before: &Pole| (before.frequency - pole.frequency).abs();
            match before.min_by(|(one, ..), (other, ..)| apart(one).total_cmp(&apart(other))) {
                Some(track) => *track = (pole, order, track.2 + 1),
                None => tracks.push((pole, order, 0)),
            }
        }
    }
    tracks.retain(|(_, _, stayed)| *stayed > 0);
    tracks.sort_by(|(.., one), (.., other)| other.cmp(one));
    tracks.into_iter().map(|(pole, ..)| pole).collect()
}

/// The sums over all lines of which the normal equations consist. The responses are those at the sampling
/// rate that just has the band between two multiples of half of it: with `x = exp(-i w T)` the band takes half
/// of the circle or more, and powers of `x` are far from alike.
struct Sums {
    /// The highest order.
    most: usize,
    /// The time between two samples.
    period: f64,
    /// The multiples of half the sampling rate that are below the band.
    zone: usize,
    /// `sum cos(k w T)` by the lag `k`.
    basis: Vec<f64>,
    /// `sum Re(exp(i k w T) H)` of each response, from the lag `-most` on.
    mixed: Vec<Vec<f64>>,
    /// `sum |H|^2 cos(k w T)` by the lag `k`.
    squares: Vec<f64>,
}

impl Sums {
    fn new(lines: &Lines) -> Self {
        let (first, count) = (lines.frequencies[0], lines.frequencies.len());
        let most = MOST_ORDER.min(count - 1);
        let zone = (first / (1.0 - first)).floor().max(0.0);
        let zone = if zone.is_finite() { zone } else { 0.0 };
        let period = PI * (zone + 1.0);
        let angle = |lag: f64, k: usize| lag * lines.frequencies[k] * period;
        let over = |lag: usize, weight: &dyn Fn(usize) -> f64| -> f64 {
            (0..count).map(|k| weight(k) * angle(lag as f64, k).cos()).sum()
        };
        let square = |k: usize| lines.responses.iter().map(|(_, values)| values[k].norm_sqr()).sum::<f64>();
        let mixed = |values: &[Complex<f64>]| -> Vec<f64> {
            let lags = (0..=2 * most).map(|lag| lag as f64 - most as f64);
            let sum = |lag: f64| -> f64 {
                values.iter().enumerate().map(|(k, value)| (Complex::cis(angle(lag, k)) * value).re).sum()
            };
            lags.map(sum).collect()
        };
        Self {
            most,
            period,
            zone: zone as usize,
            basis: (0..=most).map(|lag| over(lag, &|_| 1.0)).collect(),
            mixed: lines.responses.iter().map(|(_, values)| mixed(values)).collect(),
            squares: (0..=most).map(|lag| over(lag, &square)).collect(),
        }
    }

    /// All poles of a denominator of this order, of which the coefficient of the oldest sample is one: the
    /// poles that noise brings then lie where damping is negative (Cauberghe, Guillaume, Verboven, Vanlanduit,
    /// Parloo, Mechanical Systems and Signal Processing 19 (2005)). `None` where the equations have no solution.
    fn poles(&self, order: usize) -> Option<Vec<Pole>> {
        let size = order + 1;
        let of = |sums: &[f64]| DMatrix::from_fn(size, size, |a, b| sums[a.abs_diff(b)]);
        let basis = Cholesky::new(of(&self.basis))?;
        let mut reduced = of(&self.squares);
        for mixed in &self.mixed {
            let mixed = DMatrix::from_fn(size, size, |a, b| mixed[self.most + a - b]);
            reduced -= mixed.transpose() * basis.solve(&mixed);
        }
        let right: DVector<f64> = reduced.view((0, order), (order, 1)).column(0).into_owned();
        let left = reduced.view((0, 0), (order, order)).into_owned().svd(true, true);
        let least = ROUNDING * left.singular_values.max();
        let coefficients = -left.solve(&right, least).ok()?;
        let mut companion = DMatrix::zeros(order, order);
        companion.view_mut((1, 0), (order - 1, order - 1)).fill_with_identity();
        companion.column_mut(order - 1).copy_from(&-coefficients);
        let roots = Spectrum::of(&companion)?.values;
        Some(roots.into_iter().filter(|root| root.im < 0.0).map(|root| self.pole(root)).collect())
    }

    /// The pole of a root `exp(-s T)`, at its place in the band.
    fn pole(&self, root: Complex<f64>) -> Pole {
        let (decay, alias) = (root.norm().ln() / self.period, -root.arg() / self.period);
        let half = PI / self.period;
        let frequency = if self.zone.is_multiple_of(2) {
            self.zone as f64 * half + alias
        } else {
            (self.zone + 1) as f64 * half - alias
        };
        let natural = frequency.hypot(decay);
        Pole { frequency: natural, damping: decay / natural }
    }
}
