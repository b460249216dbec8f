//! Axes of which some lag and some creep, told as all doing the one.
//!
//! Gears of a robot are of one make: what one has, all have. Of one axis under few loads creep and
//! a play differ little, and of gears that all creep noise makes some look as if they lagged.

use std::string::String;
use std::vec::Vec;

use robstiff_robots::effect::Place as Part;

use super::bench::Bench;
use crate::trace::catalogue::{CREEP, HYSTERESIS, Kind};
use crate::trace::model::{Fitted, Named};
use crate::trace::selection::WITHIN_REACH;

/// A model in whose gears all lag or all creep that did otherwise in another.
pub struct Alike {
    /// The model, with its numbers out of grids where they fit best.
    pub found: (Bench, Fitted),
    /// Below what difference of the criterion it takes the place of the other.
    limit: f64,
    worse: f64,
}

impl Alike {
    /// The best of those in which all gears creep that lag, or all lag that creep.
    pub fn of(bench: &Bench, model: &Fitted) -> Option<Self> {
        let kinds = [(&HYSTERESIS, &CREEP, false), (&HYSTERESIS, &CREEP, true), (&CREEP, &HYSTERESIS, true)];
        let other = |(from, to, each)| {
            let (named, new) = instead(bench, &model.named, from, to, each)?;
            match new[..] {
                // A grid may not tell how many radii it takes.
                [one] => bench.anew_in_any_form(&named, one),
                _ => bench.anew(bench.axes.clone(), &named),
            }
        };
        let found = kinds.into_iter().filter_map(other).min_by(|a, b| a.1.bic.total_cmp(&b.1.bic))?;
        let limit = if is_mixed(bench, model) { WITHIN_REACH } else { 0.0 };
        // Against what all share by one number, each by its own has the advantage of that.
        let own = other((&CREEP, &CREEP, true)).map_or(f64::INFINITY, |(_, own)| own.bic);
        Some(Self { worse: found.1.bic - model.bic.min(own), limit, found })
    }

    /// Whether it takes the place of the other.
    pub fn is_better(&self) -> bool {
        self.worse < self.limit
    }

    /// Whether these data do not tell it from the other.
    pub fn is_as_good(&self) -> bool {
        self.worse < WITHIN_REACH
    }

    /// The names of what is in the place of an effect of the other model.
    pub fn instead_of(&self, model: &Fitted, k: usize) -> Vec<String> {
        let (bench, found) = &self.found;
        let has = |of: &Fitted, one: &Named| of.named.iter().any(|other| other.candidate == one.candidate);
        if has(found, &model.named[k]) {
            return Vec::new();
        }
        let axis = bench.axis_of(model.named[k].candidate);
        let is_new = |new: &&Named| !has(model, new) && (axis.is_none() || bench.axis_of(new.candidate) == axis);
        found.named.iter().filter(is_new).map(|new| bench.candidates[new.candidate].name()).collect()
    }
}

/// Whether some gears of a model lag and some creep.
pub fn is_mixed(bench: &Bench, model: &Fitted) -> bool {
    let has = |kind: &Kind| model.named.iter().any(|one| bench.candidates[one.candidate].kind == kind);
    has(&HYSTERESIS) && has(&CREEP)
}

/// The effects with another kind of the same axes in the place of one, and which are new; what
/// all axes share as one of each, if `each`. None where there is none, or an axis does not show it.
fn instead(bench: &Bench, named: &[Named], from: &Kind, to: &Kind, each: bool) -> Option<(Vec<Named>, Vec<usize>)> {
    let is_of = |one: &Named, kind: &Kind| bench.candidates[one.candidate].kind == kind;
    let is_shared = |one: &Named| bench.axis_of(one.candidate).is_none();
    let goes = |one: &Named| is_of(one, from) || (each && is_of(one, to) && is_shared(one));
    let (gone, mut others): (Vec<Named>, Vec<Named>) = named.iter().partition(|one| goes(one));
    gone.iter().find(|one| is_of(one, from))?;
    let all: Vec<usize> = match gone.iter().any(is_shared) {
        true => bench.axes.loaded().collect(),
        false => gone.iter().filter_map(|one| bench.axis_of(one.candidate)).collect(),
    };
    let mut new = Vec::new();
    for axis in all {
        let of_axis =
            |&k: &usize| bench.candidates[k].kind == to && bench.candidates[k].place == Part::Joint(axis).into();
        let candidate = (0..bench.candidates.len()).find(of_axis)?;
        if others.iter().all(|one| one.candidate != candidate) {
            others.push(Named { candidate, variant: 0 });
            new.push(candidate);
        }
    }
    others.sort_unstable();
    (!new.is_empty()).then_some((others, new))
}
