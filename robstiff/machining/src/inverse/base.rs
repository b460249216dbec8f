//! The first three joints of an ortho-parallel base: an axis, and two parallel
//! ones across it, in a frame with z along the first and y along the second.
//!
//! Turns about z are those of the complex number `x + i y`, turns about y those
//! of `z + i x`.

use nalgebra::{Complex, SVector, Vector3};

use super::screws::{Axis, Turn};

/// The base at zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Base {
    /// How far the wrist is from the plane of the first axis (m).
    beside: f64,
    /// From the first axis to the second, to the third, and to the wrist (m).
    shoulder: Complex<f64>,
    upper: Complex<f64>,
    lower: Complex<f64>,
    /// Whether the third axis points against the second.
    opposed: bool,
}

/// The first three joints where they put the wrist in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    first: Turn,
    second: Turn,
    third: Turn,
    /// The turn of the second and third together about the second's axis.
    both: Turn,
}

impl Base {
    /// The base with its second and third axis, and the place of the wrist, at
    /// zero.
    pub fn new(second: &Axis, third: &Axis, center: &Vector3<f64>) -> Self {
        let [shoulder, elbow, wrist] =
            [&second.point, &third.point, center].map(|point| Complex::new(point.z, point.x));
        let opposed = second.direction.dot(&third.direction) < 0.0;
        Self { beside: center.y, shoulder, upper: elbow - shoulder, lower: wrist - elbow, opposed }
    }

    /// The two turns of the first joint for a place of the wrist, and by how
    /// much that is too near to the axis (m), below zero where it is not.
    pub fn shoulders(&self, center: &Vector3<f64>, seed: f64) -> ([Turn; 2], f64) {
        let flat = Complex::new(center.x, center.y);
        let ahead = (flat.norm_sqr() - self.beside * self.beside).max(0.0).sqrt();
        let turns = [ahead, -ahead].map(|ahead| between(Complex::new(ahead, self.beside), flat, seed));
        (turns, self.beside.abs() - flat.norm_sqr().sqrt())
    }

    /// The two ways after a turn of the first joint, and how far the wrist is
    /// beyond what they reach (m^2), below zero where it is not.
    pub fn elbows<const N: usize>(
        &self,
        center: &Vector3<f64>,
        first: Turn,
        seed: &SVector<f64, N>,
    ) -> ([Way; 2], f64) {
        let ahead = center.x * first.re + center.y * first.im;
        let wrist = Complex::new(center.z, ahead) - self.shoulder;
        let at_zero = self.upper.conj() * self.lower;
        let length = at_zero.norm_sqr().sqrt();
        let along = 0.5 * (wrist.norm_sqr() - self.upper.norm_sqr() - self.lower.norm_sqr());
        let aside = ((length - along) * (length + along)).max(0.0).sqrt();
        let turned = |third: Turn| if self.opposed { third.inverse() } else { third };
        let ways = [aside, -aside].map(|aside| {
            let bent = if length > 1e-12 * wrist.norm_sqr() {
                between(at_zero, Complex::new(along.clamp(-length, length), aside), 0.0)
            } else {
                turned(Turn::new(seed[2]))
            };
            let second = between(self.upper + self.lower * bent.into_inner(), wrist, seed[1]);
            Way { first, second, third: turned(bent), both: second * bent }
        });
        (ways, along.abs() - length)
    }

    /// How far the wrist is ahead of the first axis (m), along second axis cross first, and the sine of the
    /// turn about the second axis from the upper arm to the line from the elbow to the wrist.
    pub fn sides(&self, second: f64, third: f64) -> (f64, f64) {
        let bent = Turn::new(if self.opposed { -third } else { third }).into_inner();
        let lower = self.lower * bent;
        let wrist = self.shoulder + Turn::new(second).into_inner() * (self.upper + lower);
        let size = (self.upper.norm_sqr() * lower.norm_sqr()).sqrt().max(f64::MIN_POSITIVE);
        (wrist.im, (self.upper.conj() * lower).im / size)
    }

    /// How far the wrist is from the first axis at most (m), or less.
    pub fn longest(&self) -> f64 {
        [self.shoulder, self.upper, self.lower]
            .map(|link| link.norm_sqr().sqrt())
            .iter()
            .sum::<f64>()
            .max(f64::MIN_POSITIVE)
    }

    /// All ways for a place of the wrist, up to four.
    pub fn ways<const N: usize>(&self, center: &Vector3<f64>, seed: &SVector<f64, N>, mut found: impl FnMut(Way)) {
        for first in once_if_same(self.shoulders(center, seed[0]).0) {
            once_if_same(self.elbows(center, first, seed).0).for_each(&mut found);
        }
    }
}

impl Way {
    /// A vector as the three joints carry it back.
    pub fn carried_back(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        let flat = Complex::new(vector.x, vector.y) * self.first.conj();
        let upright = Complex::new(vector.z, flat.re) * self.both.conj();
        Vector3::new(upright.im, flat.im, upright.re)
    }

    /// All joints (rad), with those of the wrist.
    pub fn with<const N: usize>(&self, wrist: &[Turn]) -> SVector<f64, N> {
        let all = [self.first, self.second, self.third];
        SVector::from_iterator(all.iter().chain(wrist).map(|turn| turn.angle()))
    }
}

/// The turn that brings one complex number's direction to another's; that of an
/// angle where one has none.
fn between(from: Complex<f64>, to: Complex<f64>, otherwise: f64) -> Turn {
    let turn = to * from.conj();
    let length = turn.norm_sqr().sqrt();
    let tells = from.norm_sqr() > 1e-24 && length > 1e-24;
    if tells { Turn::from_cos_sin_unchecked(turn.re / length, turn.im / length) } else { Turn::new(otherwise) }
}

fn once_if_same<T: PartialEq>([one, other]: [T; 2]) -> impl Iterator<Item = T> {
    let other = (one != other).then_some(other);
    core::iter::once(one).chain(other)
}
