//! Probabilities as they are told.

/// Tails of distributions underflow to zero, and correction for several tests goes
/// beyond one: the nearest that a probability can be.
pub fn told(p: f64) -> f64 {
    p.clamp(f64::MIN_POSITIVE, 1.0)
}

#[cfg(test)]
mod tests {
    use statrs::distribution::{ChiSquared, ContinuousCDF};

    use super::*;

    #[test]
    fn nothing_measured_is_impossible() {
        let underflown = ChiSquared::new(1.0).expect("a degree of freedom").sf(1e6);
        assert_eq!([underflown, 0.3, 4.0].map(told), [f64::MIN_POSITIVE, 0.3, 1.0]);
    }
}
