//! From the units of the lines to those of the SI.

use super::lines::Lines;
use super::model::Model;
use super::rest::massless;
use super::{Fit, FittedModes};
use crate::stability::{MeasuredMode, Spring};

/// A model in SI units, with what it leaves.
pub fn unscaled(lines: &Lines, model: &Model) -> FittedModes {
    // The values are those of `(i w)^order G`.
    let flexibility = lines.size / lines.highest.powi(lines.order);
    let mut modes: Vec<MeasuredMode> = model
        .modes
        .iter()
        .map(|mode| MeasuredMode {
            frequency: lines.highest * mode.frequency,
            damping: mode.damping,
            stiffness: mode.frequency.powi(2) / (mode.shape.norm_squared() * flexibility),
            direction: mode.shape.normalize(),
        })
        .collect();
    modes.sort_by(|one, other| one.frequency.total_cmp(&other.frequency));
    let (kept, massless) = massless(lines, model);
    let stiffer = |spring: Spring| Spring { stiffness: spring.stiffness / flexibility, ..spring };
    let massless = massless.into_iter().map(stiffer).collect();
    let share = |sum: f64| (sum / lines.power()).sqrt();
    let fit = Fit {
        band: lines.band,
        lines: lines.frequencies.len(),
        responses: lines.responses.len(),
        left: share(kept.left(lines)),
        below: share(model.below_alone(lines)),
    };
    FittedModes { modes, massless, fit }
}
