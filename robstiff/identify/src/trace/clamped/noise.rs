//! How noisy readings of clamped axes are, known from elsewhere than what a model leaves of them: from
//! what the campaign declares, or what the rows of one torque differ by.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::bench::Bench;
use crate::campaign::Campaign;
use crate::identify::NoiseSource;
use crate::probability::{chi_square_tail, fisher_tail};
use crate::trace::Options;
use crate::trace::model::Fitted;
use robstiff::JointKind;

/// Torques within this share of the largest of the axis are the same; what a model says of them is
/// taken from the readings.
const SAME_TORQUE: f64 = 0.01;

/// With fewer degrees of freedom a variance says too little to judge a model by.
const FEWEST_REPEATED: usize = 10;

/// Rounding of more than this share of what repeated rows differ by may be all that they do: a step
/// is then more than twice the noise.
const COARSE: f64 = 1.0 / 3.0;

/// What the rows of one torque differ by: a sum of squares (rad^2) and its degrees of freedom.
struct Repeated {
    sum: f64,
    freedom: usize,
}

/// One sigma of a reading (rad, or m), and where it is known from.
pub fn noise(campaign: &Campaign, bench: &Bench, model: &Fitted) -> (f64, NoiseSource) {
    if let Some(declared) = declared(campaign, bench) {
        let rounding = bench.axes.rounding.iter().copied().fold(0.0, f64::max).sqrt();
        return match rounding > declared {
            true => (declared.hypot(rounding), NoiseSource::Rounded),
            false => (declared, NoiseSource::Declared),
        };
    }
    match repeated(bench, model) {
        Some(Repeated { sum, freedom }) => ((sum / freedom as f64).sqrt(), NoiseSource::Repetitions),
        None => (bench.problem.variance(&model.fit).sqrt(), NoiseSource::Residuals),
    }
}

/// What the campaign declares of a reading of its axes, which turn or slide.
fn declared(campaign: &Campaign, bench: &Bench) -> Option<f64> {
    let slide = bench.axes.loaded().all(|axis| campaign.robot.joints[axis - 1].kind == JointKind::Prismatic);
    if slide { campaign.noise.displacement } else { campaign.noise.rotation }
}

/// That a model leaves more than the noise, if so, and the noise is known.
pub fn is_exceeded(campaign: &Campaign, bench: &Bench, model: &Fitted, options: &Options) -> Option<String> {
    let freedom = bench.problem.freedom(&model.fit);
    let (p, known) = match noise(campaign, bench, model) {
        (_, NoiseSource::Residuals) => return None,
        (_, NoiseSource::Repetitions) => {
            let Repeated { sum, freedom: own } = repeated(bench, model)?;
            let (left, own) = (freedom - own as f64, own as f64);
            if left < 1.0 {
                return None;
            }
            (
                fisher_tail((model.fit.rss - sum).max(0.0) / left / (sum / own), [left, own])?,
                "what repeated torques differ by",
            )
        }
        (noise, _) => (chi_square_tail(model.fit.rss / (noise * noise), freedom)?, "the declared noise"),
    };
    (p <= options.alpha).then(|| format!("what is left is larger than {known} (p = {p:.3})"))
}

/// What the rows of one torque differ by, if enough are repeated, and not rounded alike.
fn repeated(bench: &Bench, model: &Fitted) -> Option<Repeated> {
    let left = bench.residuals(&model.fit);
    let mut all = Repeated { sum: 0.0, freedom: 0 };
    for axis in bench.axes.loaded() {
        let mut rows = bench.axes.rows_of(axis);
        let torque = |row: usize| bench.axes.rows[row].torque;
        rows.sort_by(|&a, &b| torque(a).total_cmp(&torque(b)));
        let apart = SAME_TORQUE * bench.axes.largest(axis);
        for alike in rows.chunk_by(|&a, &b| torque(b) - torque(a) <= apart) {
            let left: Vec<f64> = alike.iter().map(|&row| left[row]).collect();
            let mean = left.iter().sum::<f64>() / left.len() as f64;
            all.sum += left.iter().map(|one| (one - mean).powi(2)).sum::<f64>();
            all.freedom += left.len() - 1;
        }
    }
    let rounding = bench.axes.rounding.iter().copied().fold(0.0, f64::max);
    let variance = all.sum / all.freedom.max(1) as f64;
    (all.freedom >= FEWEST_REPEATED && variance > 0.0 && rounding < COARSE * variance).then_some(all)
}
