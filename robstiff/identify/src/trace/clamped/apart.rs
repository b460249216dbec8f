//! What all axes share against what each has of its own.
//!
//! Gears that all lag are many effects, and the first step of a search takes one number that
//! says a little of each, creep or a bias, before any of them. No effect put in the place of
//! another leads from the one to the many: they are held against each other as wholes, each
//! grown by what axes have of their own for as long as the criterion falls.

use std::string::String;
use std::vec::Vec;

use super::bench::Bench;
use super::slips::shifts_all;
use super::standing::Standing;
use crate::trace::catalogue::LOAD_CELL_BIAS;
use crate::trace::model::{Fitted, all_but};
use crate::trace::selection::{BETTER, WITHIN_REACH};

/// How much better than unloaded readings that are off, each by its own, a bias of the torque
/// has to be. Only the softest axes show a small one, and two or three shifts are in proportion
/// to two or three compliances by chance; a bias that all axes show is far beyond this.
const OF_BIAS: f64 = 2.0 * WITHIN_REACH;

/// A model in which axes have of their own what another says by what they share.
pub struct Apart {
    /// The effect that all axes share, by its place in the other model.
    pub shared: usize,
    /// The names of what is in its place.
    pub names: Vec<String>,
    /// The model, with its numbers out of grids where they fit best.
    pub found: (Bench, Fitted),
    /// By how much its criterion is above that of the other, each grown.
    worse: f64,
    /// Below what that takes the place of the other, and below what these data do not tell.
    limits: [f64; 2],
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
            let rest = all_but(&model.named, shared);
            // A bias loads gears as well, and what they do with it goes with it.
            let own = bench.with_numbers(&bench.fit(&rest)?);
            let Standing { bench: own, model: other, .. } = grown(&own, own.fit(&rest)?);
            let new = other.named.iter().filter(|new| model.named.iter().all(|old| old.candidate != new.candidate));
            let names: Vec<String> = new.map(|new| bench.candidates[new.candidate].name()).collect();
            let worse = other.bic - with;
            let limits = limits(bench, model, shared);
            // One for one is a replacement, and done as such; but of what is more likely.
            let several = names.len() > 1 || limits[0] > 0.0;
            several.then_some(Self { shared, names, found: (own, other), worse, limits })
        };
        let beyond = |one: &Self| one.worse - one.limits[0];
        all.iter().filter_map(without).min_by(|a, b| beyond(a).total_cmp(&beyond(b)))
    }

    /// Whether it takes the place of the other.
    pub fn is_better(&self) -> bool {
        self.worse < self.limits[0]
    }

    /// Whether these data do not tell it from the other.
    pub fn is_as_good(&self) -> bool {
        !self.names.is_empty() && self.worse < self.limits[1]
    }

    /// Whether it is of the same kind as what it is held against, of each axis by itself.
    pub fn is_of_one_kind(&self, model: &Fitted) -> bool {
        let (bench, shared) = (&self.found.0, model.named[self.shared].candidate);
        let new = self.found.1.named.iter().filter(|new| model.named.iter().all(|old| old.candidate != new.candidate));
        new.into_iter().all(|new| bench.candidates[new.candidate].kind == bench.candidates[shared].kind)
    }
}

/// The limits for one of the effects of a model that all axes share: what cannot be told stays
/// the fewer. But a bias of the torque is seen in what unloaded readings are off by and hardly
/// elsewhere, and where that of another axis is known to be off, no bias is needed for more.
fn limits(bench: &Bench, model: &Fitted, shared: usize) -> [f64; 2] {
    if bench.candidates[model.named[shared].candidate].kind != &LOAD_CELL_BIAS {
        return [-WITHIN_REACH, WITHIN_REACH];
    }
    let off = model.named.iter().any(|&one| shifts_all(bench, one));
    [if off { WITHIN_REACH } else { BETTER }, OF_BIAS]
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

    use super::super::creep_tests::creep;
    use super::super::tests::{both_ways, measured, names, play, traced};
    use super::*;
    use crate::campaign::Campaign;
    use crate::trace::Verdict;
    use robstiff_robots::samples::five_axis;

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
                0.5 * five_axis().joints[axis - 1].compliance() * all[axis - 1]
            };
            let (verdict, names) = told(&measured(&five_axis(), &both_ways(), 760 + seed, lags));
            // Of axes that are hardly loaded a lag may be too small to name, but then something is said to be
            // missing.
            let lag = names.iter().all(|name| name.starts_with("hysteresis@")) && names.len() >= 3;
            assert!(lag && (names.len() == 5 || verdict == Verdict::Partial), "{seed}: {verdict:?} {names:?}");
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
            let told = told(&measured(&five_axis(), &both_ways(), 780 + seed, creep([0.03; 5])));
            assert_eq!(told, (Verdict::Explained, ["creep@rig".into()].into()), "{seed}");
        }
    }
}
