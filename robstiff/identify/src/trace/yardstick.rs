//! What residuals are held against: how noisy a reading is, and where that is known from.

use super::bench::Bench;
use crate::identify::noise::PureError;
use crate::identify::prepare::Prepared;

/// What the noise of one displacement reading is held to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Yardstick {
    /// Declared: its variance (m^2).
    Declared(f64),
    /// From repeated readings.
    Repeated(PureError),
    /// Not known but for the residuals.
    Unknown,
}

impl Yardstick {
    /// What there is: a declared noise before one from repetitions.
    pub(super) fn of(prepared: &Prepared<'_>, bench: &Bench<'_>) -> Self {
        if let Some(noise) = prepared.declared_noise {
            return Self::Declared(noise * noise);
        }
        let repeated = bench.repeated();
        if repeated.variance().is_some() { Self::Repeated(repeated) } else { Self::Unknown }
    }
}

/// Level at which repeated loads are noisier than declared.
const NOISIER: f64 = 0.01;

/// What repeated loads differ by (m), where it is beyond the declared noise.
pub(super) fn noisier_than_declared(prepared: &Prepared<'_>, bench: &Bench<'_>) -> Option<f64> {
    let (declared, repeated) = (prepared.declared_noise?, bench.repeated());
    let variance = repeated.variance()?;
    (repeated.tail_beside(declared)? <= NOISIER).then(|| variance.sqrt())
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use crate::campaign::made::Plan;
    use crate::campaign::{Campaign, Data, Noise};
    use crate::identify::NoiseSource;
    use crate::trace::Verdict;
    use crate::trace::tests::{SIGMA, TILT_3, campaign, names, traced};
    use robstiff_robots::samples::five_axis;

    fn declared(displacement: f64) -> Campaign {
        let noise = Noise { displacement: Some(displacement), rotation: None };
        Campaign { noise, ..campaign(&five_axis(), 24, &[TILT_3], 3) }
    }

    /// Noise declared in another unit hides no joint, nor what is missing.
    #[test]
    fn noise_that_the_readings_contradict_is_not_theirs() {
        let found = traced(&declared(1e3 * SIGMA));
        let without = traced(&Campaign { noise: Noise::default(), ..declared(SIGMA) });
        assert_eq!((names(&found), found.verdict), (names(&without), Verdict::Explained));
        assert_eq!((found.noise, found.noise_source), (without.noise, without.noise_source));
        assert_eq!(found.estimates, without.estimates);
    }

    /// More is left than was declared, but no model of the load could leave less.
    #[test]
    fn noise_declared_too_small_is_told_as_what_it_may_be() {
        let found = traced(&declared(0.5 * SIGMA));
        assert_eq!(
            (names(&found), found.verdict),
            (std::vec!["transverse_compliance@joint 3".into()], Verdict::Partial)
        );
        assert!(found.why.ends_with("so the noise may be larger than declared"), "{}", found.why);
        assert!(!traced(&declared(SIGMA)).why.contains("larger than declared"));
    }

    /// A dial gauge in steps of ten micrometres rounds loads that are repeated alike, and
    /// small readings less than large ones: neither is missing in the robot.
    #[test]
    fn what_a_coarse_gauge_rounds_is_no_structure() {
        for seed in 0..6 {
            let noise = [0.05 * SIGMA; 3];
            let mut campaign = Plan { robot: five_axis(), poses: 24, noise, ..Plan::new(30 + seed) }.run();
            let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
            for row in &mut data.rows {
                row.displacement = row.displacement.map(|reading| (reading / SIGMA).round() * SIGMA);
            }
            data.rows = data.rows.iter().flat_map(|row| [row.clone(), row.clone()]).collect();
            data.rows.iter_mut().enumerate().for_each(|(k, row)| row.line = k + 2);
            let found = traced(&campaign);
            assert_eq!((names(&found), found.verdict), (Vec::new(), Verdict::Adequate), "seed {seed}: {}", found.why);
        }
    }

    /// Readings in steps of ten micrometres of a gauge whose noise is declared below that: what
    /// the rounding adds is no structure, and takes back no effect.
    #[test]
    fn what_steps_add_to_the_declared_noise_is_no_structure() {
        for (seed, noise) in (0..4).flat_map(|seed| [2e-6, 4.6e-6].map(|noise| (seed, noise))) {
            for hidden in [&[][..], &[TILT_3]] {
                let plan = Plan { robot: five_axis(), poses: 24, noise: [noise; 3], ..Plan::new(40 + seed) };
                let mut campaign = Plan { hidden: hidden.to_vec(), ..plan }.run();
                let Data::Displacement(data) = &mut campaign.data else { unreachable!("displacements") };
                for row in &mut data.rows {
                    row.displacement = row.displacement.map(|reading| (reading / SIGMA).round() * SIGMA);
                }
                campaign.noise.displacement = Some(noise);
                let found = traced(&campaign);
                let (named, verdict) = match hidden {
                    [] => (Vec::new(), Verdict::Adequate),
                    _ => (std::vec!["transverse_compliance@joint 3".into()], Verdict::Explained),
                };
                assert_eq!((names(&found), found.verdict), (named, verdict), "{noise}, seed {seed}: {}", found.why);
                assert_eq!(found.noise_source, NoiseSource::Rounded);
                assert!((found.noise - noise.hypot(SIGMA / 12_f64.sqrt())).abs() < 1e-9, "{}", found.noise);
            }
        }
    }
}
