//! What nobody would wait for.

use robstiff_machining::online::{Controller, Effort, Servo};

use super::Variant;
use crate::failure::Failure;
use crate::text::significant;

/// Points in time of all the frequencies and controls together: some minutes.
const SINES: f64 = 1e7;

/// Of one frequency that nobody asked for: some seconds.
const QUICK: f64 = 5e5;

/// Points in time along a path or a record: some gigabytes.
const ALONG: f64 = 3e7;

/// Refuses frequencies (Hz) and controls that take too long, by the option to change.
pub fn sines(variants: &[Variant], frequencies: &[f64]) -> Result<(), Failure> {
    let instants = |controller: &Controller, frequency: f64| Effort::of_sine(controller, frequency).instants();
    let each = variants.iter().flat_map(|variant| frequencies.iter().map(move |&each| (&variant.controller, each)));
    let all: f64 = each.clone().map(|(controller, frequency)| instants(controller, frequency)).sum();
    if all <= SINES {
        return Ok(());
    }
    let most = |one: &(&Controller, f64), other: &(&Controller, f64)| {
        instants(one.0, one.1).total_cmp(&instants(other.0, other.1))
    };
    let (&controller, frequency) = each.max_by(most).expect("there is a control and a frequency");
    // The option without which there would be the least to do.
    let without = [
        (instants(&controller, frequency.max(1.0)), "higher --frequencies"),
        (
            instants(&Controller { servo: Servo::Ideal, ..controller }, frequency),
            "a higher --bandwidth, or a --loop-damping nearer to 1",
        ),
        (instants(&Controller { delay: 0.0, ..controller }, frequency), "a shorter --delay"),
        (instants(&Controller { step: controller.step.max(1e-3), ..controller }, frequency), "a longer --step"),
    ];
    let (_, change) = without.into_iter().min_by(|one, other| one.0.total_cmp(&other.0)).expect("there are four");
    Err(Failure::Usage(format!(
        "a force at {} Hz would be simulated for {} s in control steps of {} s: {} points in time in all, of which {} \
         are the most; give {change}",
        significant(frequency, 4),
        significant(Effort::of_sine(&controller, frequency).duration, 4),
        significant(controller.step, 4),
        significant(all, 3),
        significant(SINES, 3)
    )))
}

/// Whether a frequency (Hz) is simulated in no time.
pub fn is_quick(controller: &Controller, frequency: f64) -> bool {
    Effort::of_sine(controller, frequency).instants() <= QUICK
}

/// Refuses controls with which a path or record of that duration (s) takes too long.
pub fn along(name: &str, duration: f64, variants: &[Variant]) -> Result<(), Failure> {
    let efforts = variants.iter().map(|variant| Effort::along(&variant.controller, duration));
    let most = efforts.max_by(|one, other| one.instants().total_cmp(&other.instants()));
    match most.filter(|effort| effort.instants() > ALONG) {
        None => Ok(()),
        Some(effort) => Err(Failure::Usage(format!(
            "{name} takes {} s, {} points in time with a control step of {} s, of which {} are the most: give a longer \
             --step",
            significant(duration, 4),
            significant(effort.instants(), 3),
            significant(effort.step, 4),
            significant(ALONG, 3)
        ))),
    }
}
