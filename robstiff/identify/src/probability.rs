//! Probabilities as they are reported, tails of distributions, and normal variates.
//!
//! A tail is the probability of a statistic as large as this or larger. It is `None`
//! where a degree of freedom is missing, or where the statistic is no number: readings
//! beyond all measure come to that.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor, StudentsT};

/// Nothing is rarer than what is so large; the square of it is still a number.
const LARGEST: f64 = 1e100;

/// Tails of distributions underflow to zero, and correction for several tests goes
/// beyond one: the nearest that a probability can be.
pub fn told(p: f64) -> f64 {
    p.clamp(f64::MIN_POSITIVE, 1.0)
}

/// The tail of Fisher's F with the degrees of freedom of its two variances.
pub fn fisher_tail(ratio: f64, [above, below]: [f64; 2]) -> Option<f64> {
    Some(FisherSnedecor::new(above, below).ok()?.sf(number(ratio)?))
}

/// The tail of a chi-square.
pub fn chi_square_tail(square: f64, freedom: f64) -> Option<f64> {
    Some(ChiSquared::new(freedom).ok()?.sf(number(square)?))
}

/// The tail of Student's t, of one side.
pub fn student_tail(t: f64, freedom: f64) -> Option<f64> {
    Some(StudentsT::new(0.0, 1.0, freedom).ok()?.sf(number(t)?))
}

/// The quantile of the standard normal distribution that has 95 % within.
pub const WITHIN: f64 = 1.959_963_984_540_054;

/// With more degrees of freedom the quantile is that of its expansion about the normal
/// one. That of statrs 0.19 is off by 7e-6 at 1e5 of them, by 0.13 at 1e7, and is looked
/// for without end from 1e8 on.
const MANY: f64 = 1e4;

/// The quantile of Student's distribution that has 95 % within, to 1e-7.
pub fn student(freedom: f64) -> f64 {
    if freedom > MANY {
        // Abramowitz and Stegun, 26.7.5, to the first order.
        return WITHIN + (WITHIN.powi(3) + WITHIN) / (4.0 * freedom);
    }
    StudentsT::new(0.0, 1.0, freedom).map_or(WITHIN, |table| table.inverse_cdf(0.975))
}

fn number(statistic: f64) -> Option<f64> {
    (!statistic.is_nan()).then(|| statistic.clamp(-LARGEST, LARGEST))
}

/// A standard normal variate (Box and Muller, Annals of Mathematical Statistics 29, 1958,
/// 610-611), of two uniform ones.
pub fn normal(random: &mut ChaCha8Rng) -> f64 {
    // The logarithm needs a number above zero.
    let radius = (-2.0 * (1.0 - random.random::<f64>()).ln()).sqrt();
    radius * (core::f64::consts::TAU * random.random::<f64>()).cos()
}

/// The middle one of some numbers; zero of none.
pub fn median(mut numbers: Vec<f64>) -> f64 {
    if numbers.is_empty() {
        return 0.0;
    }
    let middle = numbers.len() / 2;
    *numbers.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The quantiles of tables.
    #[test]
    fn tails_are_those_of_the_tables() {
        for (tail, p) in [
            (fisher_tail(3.708_265, [3.0, 10.0]), 0.05),
            (chi_square_tail(11.344_867, 3.0), 0.01),
            (student_tail(1.812_461, 10.0), 0.05),
        ] {
            assert!((tail.expect("a tail") / p - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn nothing_measured_is_impossible() {
        let underflown = chi_square_tail(1e6, 1.0).expect("a degree of freedom");
        assert_eq!([underflown, 0.3, 4.0].map(told), [f64::MIN_POSITIVE, 0.3, 1.0]);
    }

    #[test]
    fn beyond_all_measure_is_rare_and_no_number_is_nothing() {
        for beyond in [1e300, f64::INFINITY] {
            let tails = [fisher_tail(beyond, [3.0, 10.0]), chi_square_tail(beyond, 3.0), student_tail(beyond, 10.0)];
            assert!(tails.into_iter().all(|tail| tail.expect("a tail") < 1e-100));
        }
        assert_eq!(
            [fisher_tail(f64::NAN, [3.0, 10.0]), chi_square_tail(f64::NAN, 3.0), student_tail(f64::NAN, 10.0)],
            [None; 3]
        );
        assert_eq!([fisher_tail(2.0, [0.0, 10.0]), chi_square_tail(2.0, 0.0), student_tail(2.0, 0.0)], [None; 3]);
    }
}
