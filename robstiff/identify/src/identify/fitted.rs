//! The result of a fit of the description's own numbers.

use nalgebra::DVector;
use robstiff_robots::Description;

use super::{Error, Estimate, Identification, NoiseSource};
use crate::campaign::Campaign;
use crate::effects::What;
use crate::fit::case::Case;
use crate::fit::estimate::name;
use crate::fit::noise::known;
use crate::fit::own::Alone;
use crate::fit::readable::is_readable;

/// How readings scatter about a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// One sigma of what a row has to itself on each axis (m).
    pub own: f64,
    /// The same of rotations (rad), where they are read.
    pub rotation: Option<f64>,
    /// The variance of the unloaded reading that the rows of a visit share, over that of what a row has to itself.
    pub shared: f64,
    /// The part of its displacement by which a row scatters more.
    pub growth: f64,
}

impl Scatter {
    fn of(alone: &Alone<'_>) -> Self {
        let noise = &alone.engine.noise;
        let own = alone.solved.fit.variance.sqrt();
        let turns = alone.engine.observation.readings().channels.contains(&1);
        Self { own, rotation: turns.then(|| own / noise.scales[1]), shared: noise.shared, growth: own * noise.growth }
    }
}

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
    let description = alone.description();
    if !is_readable(&description) {
        return Err(Error::NoDescription);
    }
    let (noise, source) = match known(campaign, case, &alone.solved.left) {
        Some(known) => (known.size, known.source),
        None => (alone.solved.fit.variance.sqrt(), NoiseSource::Residuals),
    };
    // Of a row that shares its unloaded reading with no other, both are in its noise.
    let is_alone = case.scene.what == What::Displacements && case.scene.visits >= readings.rows();
    let noise = if is_alone { noise * core::f64::consts::FRAC_1_SQRT_2 } else { noise };
    let outliers = alone.outliers();
    let rms = |left: &DVector<f64>| readings.rms(left, (0..readings.rows()).filter(|row| !outliers.contains(row)));
    Ok(Identification {
        description,
        estimates: (0..alone.own.len()).map(|k| estimate(&campaign.robot, alone, k)).collect(),
        correlation: alone.correlation(),
        rows: readings.rows(),
        poses,
        noise: Some((noise, source)),
        scatter: readings.differences.then(|| Scatter::of(alone)).filter(|_| poses > 0),
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
        visibility: alone.shown[k].clone(),
        at_bound: declared > 0.0 && alone.is_at_bound(k),
    }
}
