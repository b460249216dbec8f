//! What tells rivals apart where poses do not: further sensors and other loads,
//! each tried on the proposed visits.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::TOLD_APART;
use super::criterion::Judge;
use super::regressors::{ENCODER_NOISE, LEVELS, PAYLOADS, REACH, ROTATION_NOISE, Regressors, Sensor, Visit};
use super::rivals::Contest;

/// Something that would tell two rivals apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Remedy {
    /// What to do.
    pub words: String,
    /// The separation (sigmas) expected of the proposed visits with it; none
    /// where it is not computed.
    pub separation: Option<f64>,
}

/// A sensor that does not bring this factor is not worth its trouble.
const WORTH_IT: f64 = 1.5;

/// What would tell a pair, by its index, apart, the best first. `without` is the
/// separation (sigmas) with the visits alone.
pub fn remedies(
    regressors: &impl Regressors,
    judge: &Judge,
    visits: &[Visit],
    (contest, pair): (&Contest, usize),
    without: f64,
) -> Vec<Remedy> {
    let separation = |sensor: Sensor| {
        let gives = regressors.information(visits, Some(sensor)).into_iter();
        judge.separations(&gives.fold(regressors.known(), |sum, one| sum + one))[pair]
    };
    let sensors = regressors.sensors().into_iter();
    let mut tried: Vec<(f64, Sensor)> = sensors.map(|sensor| (separation(sensor), sensor)).collect();
    tried.retain(|(sigmas, _)| *sigmas >= TOLD_APART && *sigmas >= WORTH_IT * without);
    tried.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut found: Vec<Remedy> =
        tried.into_iter().map(|(sigmas, sensor)| Remedy { words: words(sensor), separation: Some(sigmas) }).collect();
    found.extend(of_kinds(contest).into_iter().map(|words| Remedy { words: String::from(words), separation: None }));
    found
}

fn words(sensor: Sensor) -> String {
    let millimetres = REACH * 1e3;
    match sensor {
        Sensor::Rotations => {
            format!(
                "readings of the tool's rotation (to {:.0} urad, where the campaign states nothing else)",
                ROTATION_NOISE * 1e6
            )
        }
        Sensor::Encoders => format!("encoders on the output side of the gears (to {:.0} urad)", ENCODER_NOISE * 1e6),
        Sensor::Lever => {
            format!("the same forces at a second lever length, {millimetres:.0} mm further out along the tool")
        }
        Sensor::Levels => format!(
            "five load levels, one of them {:.1} % of the greatest, and one with the torque reversed",
            LEVELS[0] * 100.0
        ),
        Sensor::Reflector => format!("a second reflector on the tool, {millimetres:.0} mm aside along its x axis"),
        Sensor::Payloads => {
            format!("five payloads at every pose, one of them {:.0} % of the greatest", PAYLOADS[1] * 100.0)
        }
    }
}

/// What is known of kinds of effects and cannot be computed from a pose and a
/// load alone.
fn of_kinds(contest: &Contest) -> Option<&'static str> {
    let is_hysteresis = contest.names.iter().any(|name| name.starts_with("hysteresis@"));
    is_hysteresis.then_some("loading and unloading in steps at every pose")
}
