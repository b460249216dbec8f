//! Probabilities as they are told, and tails of one distribution as another's.

/// Tails of distributions underflow to zero, and correction for several tests goes
/// beyond one: the nearest that a probability can be.
pub fn told(p: f64) -> f64 {
    p.clamp(f64::MIN_POSITIVE, 1.0)
}

/// The square of a standard normal variate that is as rare as the square of one of
/// Student's with so many degrees of freedom (Wallace, Annals of Mathematical
/// Statistics 30, 1959, 1121-1130): what is held against a variance that few
/// readings told becomes as if it had been known.
pub fn as_normal(square: f64, freedom: f64) -> f64 {
    ((8.0 * freedom + 1.0) / (8.0 * freedom + 3.0)).powi(2) * freedom * (square / freedom).ln_1p()
}

#[cfg(test)]
mod tests {
    use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

    use super::*;

    #[test]
    fn tails_of_student_are_those_of_a_normal_variate() {
        let normal = ChiSquared::new(1.0).expect("a degree of freedom");
        for freedom in [5.0, 8.0, 30.0, 1e6] {
            let student = StudentsT::new(0.0, 1.0, freedom).expect("degrees of freedom");
            for t in [1.0_f64, 3.0, 5.0] {
                let ratio = normal.sf(as_normal(t * t, freedom)) / (2.0 * student.sf(t));
                assert!((ratio - 1.0).abs() < 0.1, "{ratio} at {t} with {freedom}");
            }
        }
    }

    #[test]
    fn nothing_measured_is_impossible() {
        let underflown = ChiSquared::new(1.0).expect("a degree of freedom").sf(1e6);
        assert_eq!([underflown, 0.3, 4.0].map(told), [f64::MIN_POSITIVE, 0.3, 1.0]);
    }
}
