//! How deep a cut may be.

use nalgebra::{DMatrix, Matrix3};

use super::Modes;
use super::modes::{Margin, largest_real};
use super::spectrum::squared_difference;
use crate::golden::inner;

/// Each depth that is looked at over the one before, where there is no closed form.
const RATIO: f64 = 1.01;
/// The least of them (m), where nothing tells a larger one: no cut is as thin.
const LEAST: f64 = 1e-9;
/// Halvings of a step.
const HALVINGS: usize = 40;
/// Cuts by the golden section, to 1e-8 of two steps.
const CUTS: usize = 40;

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
    /// The depths that are not stable without delay, of a force that changes with the tool's
    /// displacement by `depth * process * x`, `process` 3 x 3 per depth
    /// (N/m^2), wherever the tooth before was. With it: [`Lobes`](super::Lobes).
    ///
    /// For two modes without damping the limits are the roots of two quadratics,
    /// `(a - d)^2 + 4 b c` and the determinant. Otherwise depths are looked at that grow by 1 %
    /// each, from one on below which nothing can happen; where the movements come nearest to
    /// growing, or to dying down, between depths where they do not, they are looked at there
    /// (golden section), and limits are found by bisection. So the greatest depth has no part
    /// in what is found below it.
    pub fn limits(&self, process: &Matrix3<f64>, greatest: f64) -> Limits {
        let is_stable = |depth: f64| self.is_stable(&(process * depth));
        let bounds = match (self.frequencies().len(), self.is_undamped() && self.massless == Matrix3::zeros()) {
            (0..=2, true) => self.seen(process).map_or_else(Vec::new, |seen| self.roots(&seen)),
            _ => self.searched(process, greatest),
        };
        let mut bounds: Vec<f64> = bounds.into_iter().filter(|depth| *depth > 0.0 && *depth < greatest).collect();
        bounds.sort_by(f64::total_cmp);
        bounds.push(greatest);
        let (mut from, mut unstable) = (0.0, Vec::<[f64; 2]>::new());
        for to in bounds {
            if to > from && !is_stable(0.5 * (from + to)) {
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
            [square] => vec![square / seen[(0, 0)]],
            [one, other] => {
                let (a, b, c, d) = (seen[(0, 0)], seen[(0, 1)], seen[(1, 0)], seen[(1, 1)]);
                let (apart, change) = (one - other, d - a);
                let mut roots = quadratic(squared_difference(a, b, c, d), 2.0 * apart * change, apart * apart);
                roots.extend(quadratic(a * d - b * c, -(one * d + other * a), one * other));
                roots
            }
            _ => Vec::new(),
        }
    }

    fn searched(&self, process: &Matrix3<f64>, greatest: f64) -> Vec<f64> {
        // What has no mass runs away from here on.
        let away = largest_real(&(process * self.massless)).recip();
        let end = if away > 0.0 && away < greatest { away } else { greatest };
        let look = |depth: f64| (depth, self.seen(&(process * depth)).map_or(Margin::LOST, |seen| self.margin(&seen)));
        let mut looked = Vec::from([look(self.nothing_below(process, end))]);
        while let Some(&(depth, _)) = looked.last().filter(|(depth, _)| *depth < end) {
            looked.push(look((depth * RATIO).min(end)));
        }
        let mut seen = looked.clone();
        for three in looked.windows(3) {
            seen.extend((0..2).filter_map(|distance| between(three, distance, &look)));
        }
        seen.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let limit = |pair: &[(f64, Margin)]| {
            let [(mut low, before), (mut high, after)] = [pair[0], pair[1]];
            if before.is_stable == after.is_stable {
                return None;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if look(middle).1.is_stable == before.is_stable { low = middle } else { high = middle }
            }
            Some(high)
        };
        let mut limits: Vec<f64> = seen.windows(2).filter_map(limit).collect();
        limits.push(end);
        limits
    }

    /// A depth (m) below which no movement grows. Eigenvalues move by no more than the change
    /// of a symmetric matrix (Bauer and Fike): two that are real do not meet before that is half
    /// of what keeps them apart, none gets to zero before it is the least. With damping a force
    /// must bear what the damper of a mode does, at least `2 zeta sqrt(1 - zeta^2)` of its square.
    fn nothing_below(&self, process: &Matrix3<f64>, greatest: f64) -> f64 {
        let squares: Vec<f64> = self.frequencies().iter().map(|frequency| frequency * frequency).collect();
        let least = squares.first().copied().unwrap_or(0.0);
        let damps = |(square, zeta): (&f64, &f64)| {
            square * if *zeta < 0.5 { 2.0 * zeta * (1.0 - zeta * zeta).sqrt() } else { 0.75 }
        };
        let apart = match self.is_undamped() {
            true => squares.windows(2).map(|pair| 0.5 * (pair[1] - pair[0])).fold(least, f64::min),
            false => squares.iter().zip(self.damping()).map(damps).fold(f64::INFINITY, f64::min),
        };
        let shapes = self.shapes().norm_squared();
        let force = process.norm() * shapes;
        // A force on what has no mass is up to twice as large where half of that is not reached.
        let yielding = process.norm() * self.massless.norm();
        let depth = (0.5 * apart / force).min(0.5 / yielding);
        if depth.is_finite() { depth.max(LEAST).min(greatest) } else { greatest }
    }
}

/// Of three depths of which all are stable or none is, the middle one nearest to a limit by one
/// of the distances: a depth between them where it is the other way, if there is one.
fn between(three: &[(f64, Margin)], distance: usize, look: &impl Fn(f64) -> (f64, Margin)) -> Option<(f64, Margin)> {
    let [(low, one), (_, middle), (high, other)] = three[..] else { return None };
    let sign = if middle.is_stable { 1.0 } else { -1.0 };
    let nearness = |margin: &Margin| sign * margin.distances[distance];
    let all = one.is_stable == middle.is_stable && other.is_stable == middle.is_stable;
    if !all || nearness(&middle) >= nearness(&one) || nearness(&middle) >= nearness(&other) {
        return None;
    }
    let (mut from, mut to) = (low, high);
    let mut cuts = inner(from, to).map(look);
    for _ in 0..CUTS {
        if let Some(found) = cuts.iter().find(|(_, margin)| margin.is_stable != middle.is_stable) {
            return Some(*found);
        }
        if nearness(&cuts[0].1) < nearness(&cuts[1].1) {
            to = cuts[1].0;
            cuts = [look(inner(from, to)[0]), cuts[0]];
        } else {
            from = cuts[0].0;
            cuts = [cuts[1], look(inner(from, to)[1])];
        }
    }
    None
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
