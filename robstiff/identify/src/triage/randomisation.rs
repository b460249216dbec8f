//! P-values that hold whatever the noise is, as long as it is as likely up as
//! down and poses do not know of each other.
//!
//! A check brings one score or several for each witness, a pose (or, where there
//! are few poses, a load sequence, which has an unloaded reading of its own). A
//! score is a sum of a witness's readings that is zero but for the noise where
//! nothing is wrong, so that its sign is a coin's. The sums over all witnesses,
//! each over the root of its sum of squares, are compared with those under random
//! signs; of several scores the largest, against the largest (Westfall and Young,
//! 1993), so that asking for several costs what it must. Rows of a witness keep
//! together, and with them what they share.

use std::vec::Vec;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Random signs drawn where they are too many to be tried out one by one.
const DRAWS: usize = 9999;

/// So many witnesses have all their signs tried.
const ALL_SIGNS: usize = 13;

/// Fewer witnesses than this have too few signs to show anything.
pub const FEWEST: usize = 12;

/// The least p-value that they can have: that of all of one sign, which only the opposite
/// signs reach as well.
pub const LEAST_P: f64 = 1.0 / (1_u64 << (FEWEST - 1)) as f64;

/// The scores of a witness.
#[derive(Clone, Debug)]
pub struct Witness {
    /// The pose, by index.
    pub pose: usize,
    /// The visits it has readings of.
    pub visits: Vec<usize>,
    /// Its scores.
    pub scores: Vec<f64>,
}

/// What random signs say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flipped {
    /// The score that stands out most, by index.
    pub strongest: usize,
    /// The probability of one standing out as much.
    pub p_value: f64,
    /// The number of witnesses.
    pub witnesses: usize,
}

/// With fewer poses than this, load sequences are witnesses of their own.
const FEW_POSES: usize = 12;

/// Adds up the scores of witnesses that are one: those of one pose, or where
/// poses are few those that share a visit.
fn merged(witnesses: &[Witness]) -> Vec<Vec<f64>> {
    let mut poses: Vec<usize> = witnesses.iter().map(|witness| witness.pose).collect();
    poses.sort_unstable();
    poses.dedup();
    let by_pose = poses.len() >= FEW_POSES;
    let one = |a: &Witness, b: &Witness| {
        a.pose == b.pose && (by_pose || a.visits.iter().any(|visit| b.visits.contains(visit)))
    };
    let mut groups: Vec<Vec<&Witness>> = Vec::new();
    for witness in witnesses {
        // Witnesses come pose by pose; a new one may bring groups together.
        let (mut joined, rest): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|group| group.iter().any(|known| one(known, witness)));
        groups = rest;
        let mut group: Vec<&Witness> = joined.drain(..).flatten().collect();
        group.push(witness);
        groups.push(group);
    }
    let count = witnesses.first().map_or(0, |witness| witness.scores.len());
    let sum = |group: &Vec<&Witness>| (0..count).map(|k| group.iter().map(|w| w.scores[k]).sum()).collect();
    groups.iter().map(sum).collect()
}

/// Flips the signs of witnesses; `None` where they are too few.
pub fn flip(witnesses: &[Witness]) -> Option<Flipped> {
    let mut scores = merged(witnesses);
    scores.retain(|scores| scores.iter().any(|score| *score != 0.0));
    let (count, kinds) = (scores.len(), scores.first()?.len());
    if count < FEWEST {
        return None;
    }
    let scales: Vec<f64> = (0..kinds)
        .map(|k| scores.iter().map(|scores| scores[k] * scores[k]).sum::<f64>().sqrt().max(f64::MIN_POSITIVE))
        .collect();
    let size = |signs: &dyn Fn(usize) -> f64, k: usize| {
        (scores.iter().enumerate().map(|(p, scores)| signs(p) * scores[k]).sum::<f64>() / scales[k]).abs()
    };
    let largest = |signs: &dyn Fn(usize) -> f64| (0..kinds).map(|k| size(signs, k)).fold(0.0, f64::max);
    let observed = largest(&|_| 1.0);
    let strongest = (0..kinds).max_by(|&a, &b| size(&|_| 1.0, a).total_cmp(&size(&|_| 1.0, b)))?;
    // What rounding makes of equal sums counts as equal.
    let reached = |largest: f64| largest >= observed * (1.0 - 1e-12);
    let p_value = if count <= ALL_SIGNS {
        let all = 1_u32 << (count - 1);
        let beyond = (0..all).filter(|bits| reached(largest(&|p| if bits >> p & 1 == 0 { 1.0 } else { -1.0 }))).count();
        beyond as f64 / f64::from(all)
    } else {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut signs = std::vec![1.0; count];
        let beyond = (0..DRAWS)
            .filter(|_| {
                signs.iter_mut().for_each(|sign| *sign = if random.next_u32() & 1 == 0 { 1.0 } else { -1.0 });
                reached(largest(&|p| signs[p]))
            })
            .count();
        (1 + beyond) as f64 / (1 + DRAWS) as f64
    };
    Some(Flipped { strongest, p_value, witnesses: count })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probability::normal;

    fn witness(pose: usize, visit: usize, score: f64) -> Witness {
        Witness { pose, visits: std::vec![visit], scores: std::vec![score] }
    }

    #[test]
    fn few_witnesses_are_counted_out() {
        // All of one sign: only this and its opposite are as large.
        let witnesses: Vec<Witness> = (0..12).map(|pose| witness(pose, pose, 1.0 + pose as f64)).collect();
        let found = flip(&witnesses).expect("twelve");
        assert_eq!((found.p_value, found.witnesses), (LEAST_P, 12));
        assert_eq!(flip(&witnesses[..11]), None);
    }

    #[test]
    fn witnesses_of_one_pose_count_once_where_poses_are_many() {
        let many: Vec<Witness> = (0..40).map(|visit| witness(visit / 2, visit, 1.0)).collect();
        assert_eq!(flip(&many).expect("twenty poses").witnesses, 20);
        assert_eq!(flip(&many[..22]).expect("eleven poses").witnesses, 22);
        let shared: Vec<Witness> = (0..26).map(|line| witness(line / 2, line / 2, 1.0)).collect();
        assert_eq!(flip(&shared).expect("thirteen visits").witnesses, 13);
    }

    /// The share of p-values up to 5 % is 5 %: in 1000 between 35 and 66 with a
    /// probability of 97 %; noise of unlike size, in two scores that go together.
    #[test]
    fn p_values_are_what_they_say() {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let mut small = 0;
        for _ in 0..1000 {
            let scores = |pose: usize| {
                let (size, one, other) = (1.0 + (pose % 5) as f64, normal(&mut random), normal(&mut random));
                Witness { pose, visits: std::vec![pose], scores: std::vec![size * one, size * (one + other)] }
            };
            let witnesses: Vec<Witness> = (0..12).map(scores).collect();
            small += u32::from(flip(&witnesses).expect("twelve").p_value <= 0.05);
        }
        assert!((35..=66).contains(&small), "{small}");
    }
}
