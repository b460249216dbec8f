//! Random streams and the noise of readings.

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// What is random, each with a stream of its own.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stream {
    Poses,
    Loads,
    Noise,
    Wild,
    Tails,
    Order,
    Encoders,
}

impl Stream {
    pub fn of(self, seed: u64) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(self as u64);
        random
    }
}

/// A standard normal variate (Box and Muller).
pub(super) fn normal(random: &mut ChaCha8Rng) -> f64 {
    // The logarithm needs a number above zero.
    let radius = (-2.0 * (1.0 - random.random::<f64>()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.random::<f64>()).cos()
}

/// A direction, all equally likely.
pub(super) fn direction(random: &mut ChaCha8Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| normal(random)).normalize()
}

/// By what normal noise is to be multiplied for the noise of Student's
/// distribution with `freedom` degrees (a whole number above 2), of the same
/// standard deviation.
pub(super) fn tail(freedom: usize, random: &mut ChaCha8Rng) -> f64 {
    let square: f64 = (0..freedom).map(|_| normal(random).powi(2)).sum();
    ((freedom - 2) as f64 / square).sqrt()
}

/// What outliers would add to a row: whether it is one if they are as likely as
/// this number or more, and the direction and length (0.5 to 1.5) of the error.
pub(super) fn wild(random: &mut ChaCha8Rng) -> (f64, Vector3<f64>) {
    let rarity = random.random();
    (rarity, direction(random) * random.random_range(0.5..1.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_favour_none() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mean = (0..20_000).map(|_| direction(&mut random)).sum::<Vector3<f64>>() / 20_000.0;
        assert!(mean.amax() < 0.02);
    }

    #[test]
    fn tails_are_heavy_and_of_unit_variance() {
        let (mut noise, mut tails) = (Stream::Noise.of(2), Stream::Tails.of(2));
        let values: Vec<f64> = (0..200_000).map(|_| normal(&mut noise) * tail(5, &mut tails)).collect();
        let moment = |power: i32| values.iter().map(|value| value.powi(power)).sum::<f64>() / values.len() as f64;
        // Of five degrees: variance 1, and 0.357 % beyond four sigma (of the
        // normal distribution 0.006 %).
        assert!((moment(2) - 1.0).abs() < 0.03, "{}", moment(2));
        let far = values.iter().filter(|value| value.abs() > 4.0).count() as f64 / values.len() as f64;
        assert!((3.0e-3..4.2e-3).contains(&far), "{far}");
    }
}
