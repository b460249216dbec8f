//! A campaign with the catalogue behind it.

use super::candidate::catalogue;
use super::model::Setting;
use crate::campaign::Campaign;
use crate::identify::prepare::Prepared;

/// The regression of a prepared campaign with a column for everything that may
/// be missing.
pub fn setting(campaign: &Campaign, prepared: &Prepared<'_>) -> Setting {
    let own = prepared.own.len();
    let (candidates, columns) = catalogue(&campaign.robot, &prepared.samples, own);
    Setting {
        samples: prepared.samples.clone(),
        problem: prepared.problem(&columns),
        candidates,
        signs: prepared.signs(&columns),
        base: prepared.seen(),
        own,
        joint_values: prepared.values[..prepared.samples.joints()].to_vec(),
    }
}
