//! Which poses are fitted to and which are kept for judging.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::{Campaign, Holdout};

/// Whether each of `poses` poses is fitted to; whole poses are held out, since
/// rows of one pose share what is wrong with it.
pub fn training(poses: usize, holdout: Option<Holdout>) -> Vec<bool> {
    let mut training = vec![true; poses];
    if let Some(holdout) = holdout {
        let mut order: Vec<usize> = (0..poses).collect();
        order.shuffle(&mut ChaCha8Rng::seed_from_u64(holdout.seed));
        for &pose in &order[..holdout.count(poses)] {
            training[pose] = false;
        }
    }
    training
}

/// The same of a campaign, without the poses that it holds out as well.
pub fn training_of(poses: usize, campaign: &Campaign) -> Vec<bool> {
    let mut training = training(poses, campaign.holdout);
    campaign.held_out.iter().for_each(|&pose| training[pose] = false);
    training
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fraction_of_poses_is_held_out_and_the_seed_decides_which() {
        let held = |seed| training(40, Some(Holdout { fraction: 0.25, seed }));
        assert_eq!(held(1).iter().filter(|training| !**training).count(), 10);
        assert_eq!(held(1), held(1));
        assert_ne!(held(1), held(2));
        assert_eq!(training(3, None), [true; 3]);
        assert_eq!(training(2, Some(Holdout { fraction: 0.99, seed: 0 })).iter().filter(|t| **t).count(), 1);
    }
}
