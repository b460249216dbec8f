//! What all axes share against what each has of its own.
//!
//! Gears that all lag are many effects, and the first step of a search takes one number that
//! says a little of each, creep or a bias, before any of them. No effect put in the place of
//! another leads from the one to the many: they are held against each other as wholes, each
//! grown by what axes have of their own for as long as the criterion falls.

use std::string::String;
use std::vec::Vec;

use super::bench::Bench;
use super::standing::Standing;
use crate::trace::model::{Fitted, all_but};
use crate::trace::selection::BETTER;

/// A model in which axes have of their own what another says by what they share.
pub struct Apart {
    /// The effect that all axes share, by its place in the other model.
    pub shared: usize,
    /// The names of what is in its place.
    pub names: Vec<String>,
    /// The model, with its numbers out of grids where they fit best.
    pub found: (Bench, Fitted),
    /// By how much its criterion is above that of the other, each grown.
    pub worse: f64,
}

impl Apart {
    /// The best without one of the effects of a model that all axes share, which several of
    /// single axes make up for; none where there are none.
    pub fn of(bench: &Bench, model: &Fitted) -> Option<Self> {
        let all: Vec<usize> =
            (0..model.named.len()).filter(|&k| bench.axis_of(model.named[k].candidate).is_none()).collect();
        if all.is_empty() {
            return None;
        }
        let with = grown(bench, model.clone()).model.bic.min(model.bic);
        let without = |&shared: &usize| {
            let Standing { bench, model: other, .. } = grown(bench, bench.fit(&all_but(&model.named, shared))?);
            let new = other.named.iter().filter(|new| model.named.iter().all(|old| old.candidate != new.candidate));
            let names: Vec<String> = new.map(|new| bench.candidates[new.candidate].name()).collect();
            let worse = other.bic - with;
            (names.len() > 1).then_some(Self { shared, names, found: (bench, other), worse })
        };
        all.iter().filter_map(without).min_by(|a, b| a.worse.total_cmp(&b.worse))
    }
}

/// A model with effects of axes more, the best one by one, and without those that others have
/// made up for since, for as long as the criterion falls.
fn grown(bench: &Bench, model: Fitted) -> Standing {
    let mut at = Standing::new(Bench::new(bench.axes.clone(), Some(&bench.offers)), model);
    loop {
        let of_axis = |candidate: usize| at.bench.axis_of(candidate).is_some();
        let best = at.bench.extended_by(&at.model.named, of_axis).into_iter().next();
        let Some(best) = best.filter(|best| best.bic < at.model.bic - BETTER) else { break };
        let before = at.model.bic;
        (at.bench, at.model) = at.bench.at_best(&best.named).unwrap_or((at.bench, best));
        at.without_slips();
        if at.model.bic >= before {
            break;
        }
    }
    loop {
        let rest = (0..at.model.named.len()).filter_map(|k| at.bench.fit(&all_but(&at.model.named, k)));
        let best = rest.min_by(|a: &Fitted, b: &Fitted| a.bic.total_cmp(&b.bic));
        match best.filter(|best| best.bic < at.model.bic) {
            Some(best) => at.model = best,
            None => return at,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::format;

    use super::super::tests::{both_ways, measured, names, play, traced};
    use super::*;
    use crate::campaign::Campaign;
    use crate::samples::five_axis;
    use crate::trace::Verdict;

    fn told(campaign: &Campaign) -> (Verdict, Vec<String>) {
        let trace = traced(campaign);
        let mut names = names(&trace);
        names.sort();
        (trace.verdict, names)
    }

    fn of_all(kind: &str) -> (Verdict, Vec<String>) {
        (Verdict::Explained, (1..=5).map(|axis| format!("{kind}@joint {axis}")).collect())
    }

    /// Gears of a robot are of one make: what one has, all have.
    #[test]
    fn gears_that_all_lag_do_not_creep() {
        for seed in 0..3 {
            let states = core::cell::Cell::new([0.0; 5]);
            let lags = |axis: usize, torque: f64| {
                let mut all = states.get();
                all[axis - 1] = play(torque, 100.0, all[axis - 1]);
                states.set(all);
                0.2 * five_axis().joints[axis - 1].compliance() * all[axis - 1]
            };
            assert_eq!(told(&measured(&five_axis(), &both_ways(), 760 + seed, lags)), of_all("hysteresis"), "{seed}");
        }
    }

    #[test]
    fn gears_that_all_have_play_are_told_one_by_one() {
        // A drift can stand in for several axes: then it is `partial`.
        let lost = |_, torque: f64| 1e-4 * torque / torque.hypot(30.0);
        let told: Vec<_> = (0..6).map(|seed| told(&measured(&five_axis(), &both_ways(), 770 + seed, lost))).collect();
        assert!(told.iter().filter(|told| **told == of_all("lost_motion")).count() >= 4, "{told:?}");
    }

    /// One number for all axes stays where it says as much as one for each.
    #[test]
    fn what_all_axes_share_stays_one_number() {
        for seed in 0..3 {
            let loads = core::cell::RefCell::new((0, Vec::new()));
            let crept = |axis: usize, torque: f64| {
                let mut loads = loads.borrow_mut();
                if loads.0 != axis {
                    *loads = (axis, Vec::new());
                }
                loads.1.push(torque);
                let own = five_axis().joints[axis - 1].compliance();
                let step = |k: usize| loads.1[k] - k.checked_sub(1).map_or(0.0, |before| loads.1[before]);
                let since = |k: usize| (1.0 + (loads.1.len() - k) as f64 / 0.3).log10();
                own * (0..loads.1.len()).map(|k| 0.03 * since(k) * step(k)).sum::<f64>()
            };
            let told = told(&measured(&five_axis(), &both_ways(), 780 + seed, crept));
            assert_eq!(told, (Verdict::Explained, ["creep@rig".into()].into()), "{seed}");
        }
    }
}
