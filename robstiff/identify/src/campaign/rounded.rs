//! The steps that a gauge reads in.

use super::{Campaign, Data};

/// A reading nearer than this part of the largest to another, or to a multiple of a step, is
/// there; and a step that is less than so much of it is nothing to be unsure by.
const SAME: f64 = 1e-8;
const FINE: f64 = 1e-6;

/// Rounding that adds less than this part to a variance is of no account.
const NOTHING: f64 = 1e-3;

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

impl Campaign {
    /// One sigma of one axis of one reading (m), where the file declares it, with what the
    /// rounding of readings to the steps that they show adds: each is off by up to half a step,
    /// whatever else it is off by, with a variance of a twelfth of its square. Where the
    /// difference of two is rounded and not the two, it is less; who has asked the gauge for
    /// its noise may have had the rounding in it. Then this is a little much.
    pub(crate) fn noise_of_reading(&self) -> Option<f64> {
        let declared = self.noise.displacement?;
        let rounding = self.squared_step() / 12.0;
        Some(if rounding < NOTHING * declared * declared { declared } else { declared.hypot(rounding.sqrt()) })
    }

    /// The step (m) that readings are in, where their declared noise is below it.
    pub(crate) fn step_beyond_noise(&self) -> Option<f64> {
        let step = self.squared_step().sqrt();
        self.noise.displacement.filter(|declared| *declared < step).map(|_| step)
    }

    /// The square of the step that readings show (m^2), its mean over the axes, each of which
    /// may have a gauge of its own; 0 where they show none.
    fn squared_step(&self) -> f64 {
        let of_axis = |axis: usize| match &self.data {
            Data::Displacement(data) => step(data.rows.iter().map(|row| row.displacement[axis])),
            Data::Position(data) => step(data.rows.iter().map(|row| row.position[axis])),
            Data::Clamped(_) => None,
        };
        [0, 1, 2].map(|axis| of_axis(axis).unwrap_or_default().powi(2)).iter().sum::<f64>() / 3.0
    }
}

#[cfg(test)]
mod tests {
    use crate::campaign::made::Plan;
    use crate::campaign::{Campaign, Data, Noise};

    #[test]
    fn the_step_is_the_largest_that_all_readings_are_multiples_of() {
        let of = |units: &[f64], step: f64| super::step(units.iter().map(move |unit| unit * step));
        let near = |found: Option<f64>, step: f64| found.is_some_and(|found| (found / step - 1.0).abs() < 1e-6);
        assert!(near(of(&[3.0, -7.0, 0.0, 118.0], 1e-5), 1e-5) && near(of(&[30.0, -70.0, 20.0], 1e-6), 1e-5));
        assert_eq!(of(&[1.0, 0.577_215_664_901, -0.365_309_886_183], 1e-4), None);
        assert_eq!(of(&[0.0, 0.0], 1.0), None);
    }

    /// By a twelfth of the square of the step; of a fine one by nothing.
    #[test]
    fn rounding_adds_to_the_noise_that_is_declared() {
        let read_in = |step: f64| {
            let mut campaign = Plan::new(1).run();
            let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
            for row in &mut data.rows {
                row.displacement = row.displacement.map(|reading| (reading / step).round() * step);
            }
            campaign.noise.displacement = Some(4e-6);
            campaign
        };
        let coarse = read_in(1e-5);
        assert!(coarse.step_beyond_noise().is_some_and(|step| (step - 1e-5).abs() < 1e-11));
        let noise = coarse.noise_of_reading().expect("it is declared");
        assert!((noise - (16.0_f64 + 100.0 / 12.0).sqrt() * 1e-6).abs() < 1e-11, "{noise}");
        let fine = read_in(1e-7);
        assert_eq!((fine.noise_of_reading(), fine.step_beyond_noise()), (Some(4e-6), None));
        let unknown = Campaign { noise: Noise::default(), ..coarse };
        assert_eq!((unknown.noise_of_reading(), unknown.step_beyond_noise()), (None, None));
    }
}
