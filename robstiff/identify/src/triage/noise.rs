//! What the readings say of their own noise.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::evidence::Evidence;
use super::{Raw, Stray, Unjudged};
use crate::noise::contrasts::Level;
use crate::noise::{Outlier, WILD};
use crate::probability::chi_square_tail;
use crate::words::{count, micrometres};

const SEVERAL: &str = "several loads along one line within a visit, more than the directions of load at the pose";

/// The likelihood ratio of a shared reading noisier than a loaded one, against
/// one as noisy; at the edge, half a chi-square.
pub(super) fn offset(evidence: &Evidence<'_>) -> Unjudged {
    let Some(share) = evidence.covariance.share else { return Err(String::from(SEVERAL)) };
    let p_value = chi_square_tail(share.beyond_one, 1.0).map_or(1.0, |tail| 0.5 * tail);
    let p_value = if share.value > 1.0 { p_value } else { 1.0 };
    let [from, to] = share.interval;
    let shared = if share.value < 0.5 { "its own unloaded reading, or a mean of many" } else { "one unloaded reading" };
    Ok(Raw {
        statistic: share.value,
        unit: "times the variance of a reading",
        p_value: Some(p_value),
        matters_from: 1.0,
        witnesses: evidence.covariance.freedom,
        said: [
            format!(
                "Rows of a visit have in common {:.2} (95 %: {from:.2} to {to:.2}) times the variance of a reading, as \
                 with {shared}.",
                share.value
            ),
            format!(
                "Rows of a visit have more in common than an unloaded reading gives them, {:.1} times the variance of a \
                 reading. Something moves the tool when any load is on: lost motion, a biased load cell, a seat that \
                 settles, or unloaded readings that are worse than loaded ones.",
                share.value
            ),
        ],
    })
}

/// The variance of repeated loads against the declared noise (chi-square).
pub(super) fn replicates(evidence: &Evidence<'_>) -> Unjudged {
    let pure = evidence.covariance.pure_error(&evidence.samples, Level::Repeated, |_| true, |_| false);
    let Some(variance) = pure.variance() else {
        return Err(String::from("the same load at the same pose again, a dozen times in all"));
    };
    let declared = evidence.campaign.noise.displacement;
    let too_large = declared.is_some_and(|declared| evidence.covariance.is_far_below(declared));
    let tail = evidence.campaign.noise_of_reading().and_then(|noise| pure.tail_beside(noise));
    let p_value = tail.map(|tail| if too_large { 1.0 - tail } else { tail });
    let noise = micrometres(variance.sqrt());
    let step =
        evidence.campaign.step_beyond_noise().map(|step| format!(" and steps of {} add to it", micrometres(step)));
    let step = step.unwrap_or_default();
    let declared =
        declared.map(|declared| format!(", {} are declared{step}", micrometres(declared))).unwrap_or_default();
    let fails = if too_large {
        "the noise is far less than declared, which is in another unit or of another instrument; what the readings say \
         of it counts"
    } else {
        "the noise is larger than declared, or the displacement depends on more than the load (hysteresis, drift)"
    };
    Ok(Raw {
        statistic: 1e6 * variance.sqrt(),
        unit: "um a reading",
        p_value,
        matters_from: 0.0,
        witnesses: pure.freedom,
        said: [
            format!("Repeated loads differ by {noise} a reading{declared}."),
            format!("Repeated loads differ by {noise} a reading{declared}: {fails}."),
        ],
    })
}

/// Kurtosis against that of simulated normal noise.
pub(super) fn tails(evidence: &Evidence<'_>) -> Unjudged {
    let Some(tails) = evidence.tails else { return Err(String::from(SEVERAL)) };
    let student =
        tails.freedom.map(|freedom| format!(" as Student's with {freedom} degrees of freedom")).unwrap_or_default();
    Ok(Raw {
        statistic: tails.excess_kurtosis,
        unit: "excess kurtosis",
        p_value: Some(tails.p_value),
        matters_from: 0.5,
        witnesses: evidence.covariance.freedom,
        said: [
            String::from("The noise is normal as far as one can tell."),
            format!(
                "The noise has heavy tails{student}: a few readings are off more than the others. Fits that count \
                 squares lend them too much weight."
            ),
        ],
    })
}

/// Outlying readings, by externally studentised shifts (Bonferroni).
pub(super) fn outliers(evidence: &Evidence<'_>) -> Unjudged {
    if evidence.covariance.freedom == 0 {
        return Err(String::from(SEVERAL));
    }
    let wild = &evidence.covariance.outliers;
    let least = wild.iter().map(|outlier| outlier.p_value).fold(f64::INFINITY, f64::min);
    Ok(Raw {
        statistic: wild.len() as f64,
        unit: "readings",
        // Those that are not outlying are not kept; they are above the level.
        p_value: Some(if wild.is_empty() { 1.0 } else { least }),
        matters_from: 1.0,
        witnesses: evidence.samples.rows.len(),
        said: [
            if wild.is_empty() {
                format!("Every reading belongs to the others (at {WILD}).")
            } else {
                format!("{} stands out, not beyond doubt.", count(wild.len(), "reading"))
            },
            format!(
                "{} {} not belong to the others; see the list. They are left out of the estimate of the noise.",
                count(wild.len(), "reading"),
                if wild.len() == 1 { "does" } else { "do" }
            ),
        ],
    })
}

/// The outlying readings.
pub(super) fn strays(evidence: &Evidence<'_>) -> Vec<Stray> {
    let stray = |outlier: &Outlier| Stray {
        visit: outlier.visit,
        said: outlier.told(evidence.data),
        accounted_for_by: Vec::new(),
    };
    evidence.covariance.outliers.iter().map(stray).collect()
}
