//! Nested cross-validation: the whole search without some of the poses, and what it says of them.
//!
//! Poses that took part in the search had a say in what was named, so the error of a fit without
//! them, with the same names, is too small for poses that no one has measured yet (Varma and Simon,
//! BMC Bioinformatics 7, 2006). Here the search has never seen them. How often a name comes back
//! says how much it depends on single poses.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::{Options, Progress, trace};
use crate::campaign::Campaign;
use crate::identify::Error;
use crate::words::count;

/// What searches without some poses, each pose once, say of these.
#[derive(Clone, Debug, PartialEq)]
pub struct Nested {
    /// How many searches there were.
    pub folds: usize,
    /// The root mean square error on the poses that a search was without (m), over all rows, those
    /// that do not belong to the others included.
    pub rms: f64,
    /// The same of the description's own numbers, identified without these poses, and nothing else.
    pub identified_rms: f64,
    /// What the searches named, what came back most often first.
    pub names: Vec<Recurring>,
}

/// A name that searches came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Recurring {
    /// The full name, `kind@at`.
    pub name: String,
    /// The share of the searches that named it.
    pub share: f64,
}

/// Repeats the search `folds` times, each time without as many of the poses; where that is left
/// out, as many times as there are poses, without each of them in turn. Which poses go together
/// depends on the seed. Poses that the campaign holds out have a part in it like all others.
///
/// # Errors
/// A campaign of clamped axes, which have no poses; less than two folds, or more than poses; what
/// [`trace`] says of the campaign without some poses.
pub fn nested(
    campaign: &Campaign,
    options: &Options,
    folds: Option<usize>,
    progress: &Progress<'_>,
) -> Result<Nested, Error> {
    let poses = campaign.data.poses().len();
    let folds = folds.unwrap_or(poses);
    if poses == 0 {
        return Err(Error::OtherCampaign(String::from(
            "a search is repeated without some poses: clamped axes have none",
        )));
    }
    if !(2..=poses).contains(&folds) {
        return Err(Error::Invalid(format!(
            "{} in {folds} folds: from 2 to {poses} are possible",
            count(poses, "pose")
        )));
    }
    let mut order: Vec<usize> = (0..poses).collect();
    order.shuffle(&mut ChaCha8Rng::seed_from_u64(options.seed));
    let (mut after, mut before) = (Mean::default(), Mean::default());
    let mut names: Vec<(String, usize)> = Vec::new();
    for fold in 0..folds {
        progress(&format!("search {} of {folds} without some poses", fold + 1));
        let without: Vec<usize> = order.iter().copied().skip(fold).step_by(folds).collect();
        let rest = Campaign { holdout: None, held_out: without.clone(), ..campaign.clone() };
        let found = trace(&rest, options, &|_| {})?;
        let unseen = found.residuals.iter().filter(|row| without.contains(&row.pose));
        for row in unseen.filter(|row| !found.undecided.contains(&row.line)) {
            after.add(row.after);
            before.add(row.before);
        }
        let mut here: Vec<String> = found.effects.iter().map(|named| named.effect.to_string()).collect();
        here.sort();
        here.dedup();
        for name in here {
            match names.iter_mut().find(|(known, _)| *known == name) {
                Some((_, times)) => *times += 1,
                None => names.push((name, 1)),
            }
        }
    }
    names.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    let recurring = |(name, times): (String, usize)| Recurring { name, share: times as f64 / folds as f64 };
    let names = names.into_iter().map(recurring).collect();
    Ok(Nested { folds, rms: after.rms(), identified_rms: before.rms(), names })
}

/// A mean of squares.
#[derive(Clone, Copy, Default)]
struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    fn add(&mut self, vector: [f64; 3]) {
        self.sum += vector.iter().map(|one| one * one).sum::<f64>();
        self.count += vector.len();
    }

    fn rms(&self) -> f64 {
        (self.sum / self.count.max(1) as f64).sqrt()
    }
}
