//! The frequency response of the tool as a chip sees it, with its eigenvalues over frequency.

use nalgebra::{Complex, Matrix2, Matrix2x3, Matrix3, Matrix3x2, Vector3};

use super::Modes;

/// The third singular value of a process over its first that is rounding.
const ROUNDING: f64 = 1e-9;
/// How far an eigenvalue may be from the mean of its neighbours, over its size.
const BEND: f64 = 0.02;
/// How far the phase of an eigenvalue may turn between two samples (rad).
const TURN: f64 = 0.2;
/// How far the half difference of the eigenvalues may turn between two samples (rad): at a
/// quarter of a turn it would not be known which is which.
const EXCHANGE: f64 = 0.7;
/// A half difference over the mean that is as good as zero.
const EQUAL: f64 = 1e-7;
/// The shortest step between two samples, over the frequency.
const SHORTEST: f64 = 1e-12;
/// The longest step beyond the modes, as a ratio.
const STEP: f64 = 1.5;

/// `N^T G(i w) F` for a process `P = F N^T`, 2 x 2 (1/m): the displacement across the chip, along
/// two directions, by a force that changes with two such displacements, per depth. Its
/// eigenvalues are those of `G(i w) P` that are not zero.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Response {
    resonances: Vec<Resonance>,
    /// The part of what has no mass.
    massless: Matrix2<f64>,
}

/// A mode as the chip sees it.
#[derive(Clone, Debug, PartialEq)]
struct Resonance {
    /// The natural frequency (rad/s).
    natural: f64,
    /// The damping ratio.
    damping: f64,
    part: Matrix2<f64>,
}

/// The two eigenvalues at one frequency, `mean + half` and `mean - half`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sample {
    /// The frequency (rad/s).
    pub frequency: f64,
    mean: Complex<f64>,
    half: Complex<f64>,
    /// The phase of each (rad), without jumps over the samples.
    pub phases: [f64; 2],
}

impl Sample {
    /// The first or the second eigenvalue.
    pub fn value(&self, branch: usize) -> Complex<f64> {
        if branch == 0 { self.mean + self.half } else { self.mean - self.half }
    }

    fn is_finite(&self) -> bool {
        [self.mean, self.half].iter().all(|part| part.re.is_finite() && part.im.is_finite())
    }
}

impl Response {
    /// The response of modes with at least a damping ratio to a process, 3 x 3 per depth
    /// (N/m^2). `None` where the process is not finite, or depends on displacements along more
    /// than two directions.
    pub fn new(modes: &Modes, process: &Matrix3<f64>, least_damping: f64) -> Option<Self> {
        if process.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        let parts = process.svd(true, true);
        let (u, v_t, sizes) = (parts.u?, parts.v_t?, parts.singular_values);
        if sizes[2] > ROUNDING * sizes[0] {
            return None;
        }
        let forces = Matrix3x2::from_columns(&[u.column(0) * sizes[0], u.column(1) * sizes[1]]);
        let across: Matrix2x3<f64> = v_t.fixed_rows::<2>(0).into_owned();
        let part = |shape: Vector3<f64>| (across * shape) * (forces.transpose() * shape).transpose();
        let parts = modes.shapes().column_iter().map(|shape| part(Vector3::new(shape[0], shape[1], shape[2])));
        let each = modes.frequencies().iter().zip(modes.damping()).zip(parts);
        let resonance = |((natural, damping), part): ((&f64, &f64), Matrix2<f64>)| Resonance {
            natural: *natural,
            damping: damping.max(least_damping),
            part,
        };
        Some(Self { resonances: each.map(resonance).collect(), massless: across * modes.massless * forces })
    }

    /// The part of what has no mass, which is left at the highest frequencies.
    pub fn massless(&self) -> &Matrix2<f64> {
        &self.massless
    }

    /// More than the size of the modes' part at a frequency above all of them, and at any higher.
    fn bound(&self, frequency: f64) -> f64 {
        let size =
            |Resonance { natural, part, .. }: &Resonance| part.norm() / (frequency * frequency - natural * natural);
        self.resonances.iter().map(size).sum()
    }

    /// The eigenvalues at a frequency (rad/s), as the mean and half the difference.
    fn pair(&self, frequency: f64) -> (Complex<f64>, Complex<f64>) {
        let mut sum = self.massless.map(Complex::from);
        for Resonance { natural, damping, part } in &self.resonances {
            // Without the difference of squares, of which little is left near a resonance.
            let real = (natural - frequency) * (natural + frequency);
            let factor = Complex::new(real, 2.0 * damping * natural * frequency).inv();
            sum += part.map(|entry| factor * entry);
        }
        let apart = (sum[(0, 0)] - sum[(1, 1)]) * 0.5;
        ((sum[(0, 0)] + sum[(1, 1)]) * 0.5, (apart * apart + sum[(0, 1)] * sum[(1, 0)]).sqrt())
    }

    /// The eigenvalues at a frequency, in the order of those at a neighbour.
    pub fn next(&self, from: &Sample, frequency: f64) -> Sample {
        let (mean, half) = self.pair(frequency);
        let half = if (half * from.half.conj()).re < 0.0 { -half } else { half };
        let mut next = Sample { frequency, mean, half, phases: from.phases };
        for branch in 0..2 {
            next.phases[branch] += (next.value(branch) * from.value(branch).conj()).arg();
        }
        next
    }

    /// The eigenvalues over frequency, from 0 to where both stay smaller than `floor`, or as good
    /// as those of what has no mass; so close together that each can be followed where it is
    /// larger than `floor`. `None` where one is not finite.
    pub fn samples(&self, floor: f64) -> Option<Vec<Sample>> {
        let (mean, half) = self.pair(0.0);
        let mut samples =
            Vec::from([Sample { frequency: 0.0, mean, half, phases: [mean + half, mean - half].map(Complex::arg) }]);
        for to in self.frequencies(floor) {
            let mut targets = Vec::from([to]);
            while let (Some(&to), Some(from)) = (targets.last(), samples.last()) {
                let middle = self.next(from, 0.5 * (from.frequency + to));
                let next = self.next(&middle, to);
                if !(next.is_finite() && middle.is_finite()) {
                    return None;
                }
                if to - from.frequency <= SHORTEST * to || is_smooth([from, &middle, &next], floor) {
                    samples.push(next);
                    targets.pop();
                } else {
                    targets.push(middle.frequency);
                }
            }
        }
        Some(samples)
    }

    /// Frequencies at which nothing of a resonance is passed over: its top, and further and
    /// further away on both sides.
    fn frequencies(&self, floor: f64) -> Vec<f64> {
        let highest = self.resonances.iter().map(|resonance| resonance.natural).fold(0.0, f64::max);
        let enough = floor * if self.massless == Matrix2::zeros() { 0.5 } else { 1e-4 };
        let mut all = Vec::new();
        for Resonance { natural, damping, .. } in &self.resonances {
            all.push(*natural);
            let mut away = 0.5 * damping.min(0.5) * natural;
            while away < *natural {
                all.extend([natural - away, natural + away]);
                away *= 2.0;
            }
        }
        let mut top = STEP * highest;
        while top > 0.0 && self.bound(top) > enough {
            top *= STEP;
            all.push(top);
        }
        all.sort_by(f64::total_cmp);
        all.retain(|frequency| *frequency > 0.0);
        all.dedup();
        all
    }
}

/// Whether nothing happens between three samples but what the outer two tell.
fn is_smooth([from, middle, to]: [&Sample; 3], floor: f64) -> bool {
    let size = |sample: &Sample| sample.value(0).norm().max(sample.value(1).norm());
    if [from, middle, to].into_iter().all(|sample| size(sample) < 0.5 * floor) {
        return true;
    }
    let follows = |branch: usize| {
        let [one, half_way, other] = [from, middle, to].map(|sample| sample.value(branch));
        let sizes = [one, half_way, other].map(Complex::norm);
        if sizes.iter().all(|size| *size < 0.5 * floor) {
            return true;
        }
        let bend = (half_way - (one + other) * 0.5).norm();
        bend <= BEND * sizes[1].max(floor) && (to.phases[branch] - from.phases[branch]).abs() <= TURN
    };
    let is_one = |sample: &Sample| sample.half.norm() <= EQUAL * sample.mean.norm();
    let keeps_order = is_one(middle) || (to.half * from.half.conj()).arg().abs() <= EXCHANGE;
    follows(0) && follows(1) && keeps_order
}
