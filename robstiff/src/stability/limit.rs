//! How deep a cut may be.

use std::vec::Vec;

use nalgebra::{DMatrix, Matrix3};

use super::Modes;

/// Depths are looked at in so many steps where there is no closed form.
const STEPS: usize = 400;
/// Halvings of a step; 1e-9 of the greatest depth.
const HALVINGS: usize = 24;

/// The depths of cut that are not stable, up to a greatest one.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// The greatest depth looked at (m).
    pub greatest: f64,
    /// From where to where it is not stable (m), in order; beyond the first
    /// there may be stable depths again.
    pub unstable: Vec<[f64; 2]>,
}

impl Limits {
    /// The depth from which on it is not stable (m); `None` where all depths up
    /// to the greatest are stable.
    pub fn limiting(&self) -> Option<f64> {
        self.unstable.first().map(|[from, _]| *from)
    }

    /// Whether a depth (m) is stable; nobody looked beyond the greatest.
    pub fn is_stable(&self, depth: f64) -> bool {
        depth <= self.greatest && self.unstable.iter().all(|[from, to]| depth < *from || depth > *to)
    }

    /// Whether every depth up to this (m) is stable, as a cut that reaches it needs: it
    /// passes through those below, and stays at less where the stock is uneven.
    pub fn is_stable_up_to(&self, depth: f64) -> bool {
        depth <= self.greatest && self.limiting().is_none_or(|limit| depth < limit)
    }
}

impl Modes {
    /// The depths that are not stable, of a force that changes with the tool's
    /// displacement by `depth * process * x`, `process` 3 x 3 per depth
    /// (N/m^2).
    ///
    /// For two modes without damping the limits are the roots of two quadratics,
    /// `(a - d)^2 + 4 b c` and the determinant; otherwise the eigenvalues are
    /// looked at in 400 steps, between two of which they are found by bisection:
    /// a range narrower than a step may be missed.
    pub fn limits(&self, process: &Matrix3<f64>, greatest: f64) -> Limits {
        let seen = self.seen(process);
        let stable = |depth: f64| self.is_stable_seen(&(&seen * depth));
        let bounds = match (self.frequencies().len(), self.damping() == 0.0) {
            (0..=2, true) => self.roots(&seen),
            _ => Self::searched(&stable, greatest),
        };
        let mut bounds: Vec<f64> = bounds.into_iter().filter(|depth| *depth > 0.0 && *depth < greatest).collect();
        bounds.sort_by(f64::total_cmp);
        bounds.push(greatest);
        let (mut from, mut unstable) = (0.0, Vec::<[f64; 2]>::new());
        for to in bounds {
            if to > from && !stable(0.5 * (from + to)) {
                match unstable.last_mut().filter(|last| last[1] == from) {
                    Some(last) => last[1] = to,
                    None => unstable.push([from, to]),
                }
            }
            from = to;
        }
        Limits { greatest, unstable }
    }

    /// Where the discriminant or the determinant of one or two modes is zero.
    fn roots(&self, seen: &DMatrix<f64>) -> Vec<f64> {
        let squares: Vec<f64> = self.frequencies().iter().map(|frequency| frequency * frequency).collect();
        match squares[..] {
            [square] => std::vec![square / seen[(0, 0)]],
            [one, other] => {
                let (a, b, c, d) = (seen[(0, 0)], seen[(0, 1)], seen[(1, 0)], seen[(1, 1)]);
                let (apart, change) = (one - other, d - a);
                let mut roots = quadratic(change * change + 4.0 * b * c, 2.0 * apart * change, apart * apart);
                roots.extend(quadratic(a * d - b * c, -(one * d + other * a), one * other));
                roots
            }
            _ => Vec::new(),
        }
    }

    fn searched(stable: &impl Fn(f64) -> bool, greatest: f64) -> Vec<f64> {
        let mut bounds = Vec::new();
        let (mut before, mut was) = (0.0, stable(0.0));
        for step in 1..=STEPS {
            let depth = greatest * step as f64 / STEPS as f64;
            let is = stable(depth);
            if is != was {
                let (mut low, mut high) = (before, depth);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if stable(middle) == was { low = middle } else { high = middle }
                }
                bounds.push(high);
            }
            (before, was) = (depth, is);
        }
        bounds
    }
}

/// The real roots of `a x^2 + b x + c`.
fn quadratic(a: f64, b: f64, c: f64) -> Vec<f64> {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return Vec::new();
    }
    // The sum that does not cancel; each root from the quotient that is safe.
    let sum = -0.5 * (b + discriminant.sqrt().copysign(b));
    [sum / a, c / sum].into_iter().filter(|root| root.is_finite()).collect()
}
