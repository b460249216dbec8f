//! The search for the best set of visits.
//!
//! Fedorov's exchange (Theory of Optimal Experiments, 1972): from a start, each
//! visit in turn gives way to the candidate that is best in its place, until no
//! exchange helps; from several starts. Then coordinate exchange (Meyer and
//! Nachtsheim, Technometrics 37, 1995) moves one joint at a time between the
//! candidates. Nothing is accepted that is not better, so the result is never
//! worse than its start.

use std::vec;
use std::vec::Vec;

use nalgebra::DMatrix;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::criterion::{Criterion, Judge};
use super::regressors::{Regressors, Visit};
use super::space::Space;

/// Passes over all visits; exchange converges after three or four.
const PASSES: usize = 10;

/// A gain below this is rounding.
const GAIN: f64 = 1e-9;

/// Values tried for one joint in a coordinate exchange.
const VALUES: usize = 9;

/// Passes of coordinate exchange.
const REFINEMENTS: usize = 2;

/// A search among candidates.
#[derive(Clone, Copy)]
pub struct Search<'s> {
    /// What values sets.
    pub judge: &'s Judge,
    /// What is known already.
    pub known: &'s DMatrix<f64>,
    /// What each candidate gives.
    pub information: &'s [DMatrix<f64>],
    /// The candidates; those of one pose follow each other.
    pub visits: &'s [Visit],
}

impl Search<'_> {
    /// The best set of `count` candidates at different poses that is found, by
    /// index.
    pub fn best(&self, criterion: Criterion, count: usize, starts: usize, seed: u64) -> Vec<usize> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let start = |k: usize| if k == 0 { self.greedy(criterion, count) } else { self.drawn(count, &mut random) };
        let found = (0..starts.max(1)).map(start).collect::<Vec<_>>().into_iter();
        let found = found.map(|start| self.exchange(criterion, start));
        // The first of equals: one seed gives one result.
        let best =
            found.reduce(
                |best, next| {
                    if self.value(criterion, &next) > self.value(criterion, &best) + GAIN { next } else { best }
                },
            );
        best.unwrap_or_default()
    }

    /// The value of a set.
    pub fn value(&self, criterion: Criterion, chosen: &[usize]) -> f64 {
        self.judge.value(criterion, &self.sum(chosen))
    }

    fn sum(&self, chosen: &[usize]) -> DMatrix<f64> {
        chosen.iter().fold(self.known.clone(), |sum, &k| sum + &self.information[k])
    }

    fn same_pose(&self, one: usize, other: usize) -> bool {
        self.visits[one].q == self.visits[other].q
    }

    /// The best candidate to add to what is known, at a pose not taken.
    fn best_beside(&self, criterion: Criterion, sum: &DMatrix<f64>, taken: &[usize]) -> Option<(f64, usize)> {
        let free = (0..self.information.len()).filter(|&k| !taken.iter().any(|&other| self.same_pose(k, other)));
        let valued = free.map(|k| (self.judge.value(criterion, &(sum + &self.information[k])), k));
        valued.reduce(|best, next| if next.0 > best.0 { next } else { best })
    }

    /// One after the other, the best each time.
    pub fn greedy(&self, criterion: Criterion, count: usize) -> Vec<usize> {
        let (mut chosen, mut sum) = (Vec::new(), self.known.clone());
        while chosen.len() < count {
            let Some((_, k)) = self.best_beside(criterion, &sum, &chosen) else { break };
            sum += &self.information[k];
            chosen.push(k);
        }
        chosen
    }

    /// At random, each at a pose of its own.
    pub fn drawn(&self, count: usize, random: &mut ChaCha8Rng) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.information.len()).collect();
        order.shuffle(random);
        let mut chosen: Vec<usize> = Vec::new();
        for k in order {
            if chosen.len() == count {
                break;
            }
            if !chosen.iter().any(|&other| self.same_pose(k, other)) {
                chosen.push(k);
            }
        }
        chosen
    }

    /// Exchanges from a start until nothing helps.
    pub fn exchange(&self, criterion: Criterion, mut chosen: Vec<usize>) -> Vec<usize> {
        let mut value = self.value(criterion, &chosen);
        for _ in 0..PASSES {
            let before = value;
            for place in 0..chosen.len() {
                let mut rest = chosen.clone();
                rest.remove(place);
                let Some((best, k)) = self.best_beside(criterion, &self.sum(&rest), &rest) else { continue };
                if best > value + GAIN {
                    (value, chosen[place]) = (best, k);
                }
            }
            if value <= before + GAIN {
                break;
            }
        }
        chosen
    }
}

/// Moves the joints of each visit, one at a time, where that helps.
pub fn refine(
    judge: &Judge,
    regressors: &impl Regressors,
    space: &Space,
    criterion: Criterion,
    mut chosen: Vec<Visit>,
) -> Vec<Visit> {
    let mut information = regressors.information(&chosen, None);
    let mut sum = information.iter().fold(regressors.known(), |sum, one| sum + one);
    let mut value = judge.value(criterion, &sum);
    let count = chosen.len();
    for place in (0..REFINEMENTS).flat_map(|_| 0..count) {
        for joint in 0..space.ranges.len() {
            let moved = |value: usize| {
                let [low, high] = space.ranges[joint];
                let mut visit = chosen[place].clone();
                visit.q[joint] = low + (high - low) * value as f64 / (VALUES - 1) as f64;
                visit
            };
            let tried: Vec<Visit> = (0..VALUES).map(moved).filter(|visit| space.reaches(&visit.q)).collect();
            let rest = &sum - &information[place];
            for (visit, gives) in tried.iter().zip(regressors.information(&tried, None)) {
                let with = &rest + &gives;
                let tried = judge.value(criterion, &with);
                let apart = chosen.iter().enumerate().all(|(k, other)| k == place || other.q != visit.q);
                if tried > value + GAIN && apart {
                    (value, sum) = (tried, with);
                    (chosen[place], information[place]) = (visit.clone(), gives);
                }
            }
        }
    }
    chosen
}

/// The visits in the order in which each gives most, so that whoever stops
/// early has the best of it.
pub fn in_order(judge: &Judge, regressors: &impl Regressors, criterion: Criterion, chosen: Vec<Visit>) -> Vec<Visit> {
    let information = regressors.information(&chosen, None);
    let (mut sum, mut taken) = (regressors.known(), vec![false; chosen.len()]);
    let mut ordered = Vec::with_capacity(chosen.len());
    while ordered.len() < chosen.len() {
        let free = (0..chosen.len()).filter(|&k| !taken[k]);
        let valued = free.map(|k| (judge.value(criterion, &(&sum + &information[k])), k));
        let best = valued.reduce(|best, next| if next.0 > best.0 { next } else { best });
        let (_, k) = best.expect("one is free while not all are taken");
        taken[k] = true;
        sum += &information[k];
        ordered.push(chosen[k].clone());
    }
    ordered
}
