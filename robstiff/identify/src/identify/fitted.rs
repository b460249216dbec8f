//! The result of a fit of the description's own numbers.

use nalgebra::DVector;
use robstiff_robots::Description;

use super::readable::is_readable;
use super::{Error, Estimate, Identification, NoiseSource, Visibility};
use crate::campaign::Campaign;
use crate::fit::case::Case;
use crate::fit::estimate::{name, with_value};
use crate::fit::noise::known;
use crate::fit::own::{Alone, Shown};

/// Puts together what a fit found; `poses` are those of the campaign.
///
/// # Errors
/// Numbers that no description takes beside its own effects.
pub fn identification(
    campaign: &Campaign,
    (case, alone): (&Case<'_>, &Alone<'_>),
    poses: usize,
) -> Result<Identification, Error> {
    let readings = case.observation.readings();
    let seen = alone.seen();
    let description =
        seen.iter().fold(campaign.robot.clone(), |changed, &k| with_value(changed, &alone.own[k], alone.value(k)));
    if !is_readable(&description) {
        return Err(Error::NoDescription);
    }
    let (noise, source) = match known(campaign, case, &alone.solved.left) {
        Some(known) => (known.size, known.source.into()),
        None => (alone.solved.fit.variance.sqrt(), NoiseSource::Residuals),
    };
    let outliers = alone.outliers();
    let rms = |left: &DVector<f64>| readings.rms(left, (0..readings.rows()).filter(|row| !outliers.contains(row)));
    Ok(Identification {
        description,
        estimates: (0..alone.own.len()).map(|k| estimate(&campaign.robot, alone, k)).collect(),
        correlation: alone.correlation(),
        rows: readings.rows(),
        poses,
        noise: Some((noise, source)),
        covariance: None,
        left_out: outliers.iter().map(|&row| readings.lines[row]).collect(),
        rms_declared: alone.left(|k| alone.own[k].parameter.mean).map(|left| rms(&left)),
        rms: alone.left(|k| alone.value(k)).map(|left| rms(&left)),
    })
}

/// What came of a number.
pub fn estimate(robot: &Description, alone: &Alone<'_>, k: usize) -> Estimate {
    let own = &alone.own[k];
    let declared = own.parameter.mean;
    Estimate {
        name: name(robot, own),
        declared,
        value: alone.value(k),
        std: alone.std(k),
        unit: own.parameter.unit,
        visibility: match &alone.shown[k] {
            Shown::Seen => Visibility::Seen,
            Shown::Unseen => Visibility::Unseen,
            Shown::Confounded(others) => Visibility::Confounded(others.clone()),
        },
        at_bound: declared > 0.0 && alone.is_at_bound(k),
        confounded_with: Vec::new(),
    }
}
