//! The steps that a gauge reads in.

use super::Displacements;

/// A reading nearer than this part of the largest to another, or to a multiple of a step, is
/// there; and a step that is less than so much of it is nothing to be unsure by.
const SAME: f64 = 1e-8;
const FINE: f64 = 1e-6;

/// The step that all readings are multiples of, if they show one: the largest that there is,
/// by Euclid's algorithm.
pub(crate) fn step(readings: impl Iterator<Item = f64> + Clone) -> Option<f64> {
    let largest = readings.clone().map(f64::abs).fold(0.0, f64::max);
    let common = |mut step: f64, reading: f64| {
        let mut rest = reading.abs();
        while rest > SAME * largest {
            (step, rest) = (rest, (step - rest * (step / rest).round()).abs());
        }
        step
    };
    Some(readings.fold(0.0, common)).filter(|step| *step > FINE * largest)
}

impl Displacements {
    /// Whether displacements are read in steps so wide that noise of this variance (m^2), of
    /// one reading, does not take them from one to the next: more than twice its sigma. Rows
    /// that are alike are then rounded alike, and small readings less than large ones, which
    /// is no sign of the arm's.
    pub(crate) fn is_coarse(&self, variance: f64) -> bool {
        let readings = self.rows.iter().flat_map(|row| row.displacement);
        step(readings).is_some_and(|step| step * step > 4.0 * variance)
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_step_is_the_largest_that_all_readings_are_multiples_of() {
        let of = |units: &[f64], step: f64| super::step(units.iter().map(move |unit| unit * step));
        let near = |found: Option<f64>, step: f64| found.is_some_and(|found| (found / step - 1.0).abs() < 1e-6);
        assert!(near(of(&[3.0, -7.0, 0.0, 118.0], 1e-5), 1e-5) && near(of(&[30.0, -70.0, 20.0], 1e-6), 1e-5));
        assert_eq!(of(&[1.0, 0.577_215_664_901, -0.365_309_886_183], 1e-4), None);
        assert_eq!(of(&[0.0, 0.0], 1.0), None);
    }
}
