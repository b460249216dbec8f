//! The verdict, and when names are taken back.

use core::fmt;
use std::format;
use std::string::String;
use std::vec::Vec;

use super::along::{Along, along};
use super::bench::Bench;
use super::catalogue::{CREEP, Candidate, HYSTERESIS, LOST_MOTION, STIFFNESS_NONLINEARITY};
use super::features::LOAD_ORDER;
use super::found::Place;
use super::lack_of_fit::{LackOfFit, StructureTest};
use super::model::{Fitted, Named, all_but};
use super::selection::Selection;
use crate::words::count;

/// What a tracing came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing is missing: no effect is named.
    Adequate,
    /// Effects are named, and the rest is noise.
    Explained,
    /// Effects are named, and structure is left, or nothing but what they leave says how large the
    /// noise is.
    Partial,
    /// Structure, and nothing in the catalogue accounts for it.
    Unexplained,
    /// The data cannot tell.
    Insufficient,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Adequate => "adequate",
            Self::Explained => "explained",
            Self::Partial => "partial",
            Self::Unexplained => "unexplained",
            Self::Insufficient => "insufficient",
        })
    }
}

/// With fewer poses there are too few sign patterns (`2^(P - 1)`) to reject
/// anything at the usual levels with a margin.
pub const FEWEST_POSES: usize = 10;

/// Why so many poses are too few, if they are.
pub fn too_few(poses: usize) -> Option<String> {
    let are = if poses == 1 { "is" } else { "are" };
    let given = count(poses, "pose");
    (poses < FEWEST_POSES).then(|| format!("{given} {are} too few to judge by, at least {FEWEST_POSES} are needed"))
}

/// What a name has to be worth, where structure is left with it: the share of what is
/// missing without it that it accounts for, over the square of how much of what is left
/// lies [along](mod@super::along) it. A search in a catalogue finds something a little
/// like whatever is missing, and does not stop by itself on an effect that it does not
/// have; such a name accounts for part of it, and leaves the rest along itself.
///
/// The numbers are from simulated campaigns with something outside the catalogue in them
/// (a cable, a joint that lags, a foundation that hardens, ..), alone or beside an effect,
/// 336 with one seed, before anything [nameless](super::beyond) was held against names: of
/// true ones 25 of 125 fall, of false ones 373 of 424. The share alone tells a false name
/// from a true one in 76 of 100 pairs, what lies along it in 84, both in 92. It is no
/// guarantee.
const WORTH: f64 = 0.9;

/// Of a name along which lies so much more than noise the number is another at every
/// reading: it says where something is missing, and not what.
const AS_MUCH: f64 = 0.95;

/// A name that accounts for so much of what is missing stays, whatever the little that is left
/// looks like: without it the description would be many times worse.
const NEARLY_ALL: f64 = 0.95;

/// The effects of a model that are to be taken back because structure is left
/// all the same: one at a time, that which is worth least; but of gears that harden or soften
/// all, where what is left depends on the order of loads.
pub fn to_take_back(bench: &Bench<'_>, model: &Fitted, left: &LackOfFit) -> Vec<usize> {
    if !left.structure || model.named.is_empty() {
        return Vec::new();
    }
    // A gear with hysteresis is softer at small torques, on the way back: what
    // changes with the load order is no function of the torque.
    let of_order = left.depends_on.iter().any(|column| column == LOAD_ORDER);
    let nonlinear = |named: &Named| bench.candidates()[named.candidate].kind == &STIFFNESS_NONLINEARITY;
    if of_order && model.named.iter().any(nonlinear) {
        return (0..model.named.len()).filter(|&k| nonlinear(&model.named[k])).collect();
    }
    let Ok(setting) = bench.at(&model.named) else { return Vec::new() };
    let share = |k: usize| {
        let without = bench.fit(&all_but(&model.named, k)).ok()?.fit.rss;
        // Both over the same degrees of freedom but for a few.
        let noise = model.fit.rss * (1.0 - left.fraction);
        Some((without - model.fit.rss) / (without - noise))
    };
    let falls = |(k, along): (usize, Along)| Some((worth_of_fallen(share(k), along)?, k));
    let falling = along(&setting, model).into_iter().enumerate().filter_map(falls);
    falling.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k).into_iter().collect()
}

/// What a name is worth that falls, by the share of what is missing without it that it accounts
/// for, none where it cannot be left out; `None` where it stays.
fn worth_of_fallen(share: Option<f64>, Along { ratio, is_significant }: Along) -> Option<f64> {
    // What no model can do without is no name for want of better.
    let share = share.filter(|share| *share < NEARLY_ALL)?;
    let worth = share / ratio.powi(2);
    (worth < WORTH || (is_significant && ratio >= AS_MUCH)).then_some(worth)
}

/// Whether a model takes a lag to pieces: a joint that comes to rest with a time
/// constant of a minute or two depends on the order of loads like hysteresis,
/// and is softer where loads rest longer, like a gear with a curve or creep. A
/// gear can have both; no test of residuals tells, for next to nothing is left.
pub fn may_lag(bench: &Bench<'_>, model: &Fitted) -> bool {
    let candidates = || model.named.iter().map(|one| &bench.candidates()[one.candidate]);
    let sticks = |one: &&Candidate| one.kind == &HYSTERESIS;
    candidates().filter(sticks).any(|one| candidates().any(|other| makes_up_a_lag(other, one.place)))
}

/// Whether a model has a hysteresis beside one that the description declares, of which weights
/// are fitted again and radii are not: what a wrong radius leaves has no other name.
pub fn lags_beside_declared(bench: &Bench<'_>, model: &Fitted) -> bool {
    let mut named = model.named.iter().map(|one| bench.candidates()[one.candidate].kind);
    bench.robot().effects.iter().any(|effect| HYSTERESIS.is_of(effect)) && named.any(|kind| kind == &HYSTERESIS)
}

/// Whether an effect makes up a lag of the joint at a place, beside its hysteresis.
pub fn makes_up_a_lag(other: &Candidate, place: Place) -> bool {
    let curve = [&STIFFNESS_NONLINEARITY, &LOST_MOTION].contains(&other.kind);
    other.kind == &CREEP || (curve && other.place == place)
}

/// A test with such a probability found nothing: structure is known otherwise.
const SAYS_NOTHING: f64 = 0.1;

/// What is known of a model besides what it leaves.
#[derive(Clone, Copy, Debug, Default)]
pub struct Besides<'a> {
    /// So many names besides, for what is wrong in single visits.
    pub isolated: usize,
    /// Full names that were taken back.
    pub taken_back: &'a [String],
    /// What accounts for what is left and has no name, each as a noun for a sentence.
    pub looks_like: &'a [String],
    /// Whether the model [may be](may_lag) a lag taken to pieces.
    pub may_lag: bool,
    /// Whether a hysteresis is named [beside](lags_beside_declared) one that is declared.
    pub beside_declared: bool,
}

/// The verdict on a model that stands, and why.
pub fn judge(selection: &Selection, left: &LackOfFit, besides: &Besides<'_>) -> (Verdict, String) {
    let &Besides { isolated, taken_back, looks_like, may_lag, beside_declared } = besides;
    let named = selection.model.named.len() + isolated;
    let structure = left.structure || selection.unnamed;
    let strongest = left.tests.iter().min_by(|a, b| a.p_value.total_cmp(&b.p_value));
    let because = match strongest.filter(|test| test.p_value < SAYS_NOTHING) {
        Some(test) => format!("{} (p {})", test.name, Shown(test.p_value)),
        None if selection.unnamed => {
            String::from("something is missing significantly, but no effect of the catalogue passes every test")
        }
        None if !taken_back.is_empty() => String::from("what the names that were taken back had accounted for"),
        None => String::from("with it the readings are accounted for better"),
    };
    let taken_back = taken_back.join(", ");
    let verdict = match (named, structure) {
        (0, false) => Verdict::Adequate,
        (_, false) => Verdict::Explained,
        (0, true) => Verdict::Unexplained,
        (_, true) => Verdict::Partial,
    };
    let why = match verdict {
        Verdict::Adequate => String::from("nothing is missing significantly, and what is left looks like noise"),
        Verdict::Explained => String::from("what the named effects leave looks like noise"),
        _ if !looks_like.is_empty() => {
            let instead =
                if taken_back.is_empty() { taken_back } else { format!("; in its place had fitted {taken_back}") };
            format!(
                "what is left looks like {}, for which the catalogue has no name{instead}: {because}",
                looks_like.join(" and ")
            )
        }
        Verdict::Unexplained if !taken_back.is_empty() => {
            format!("what fitted was taken back for what it leaves ({taken_back}): {because}")
        }
        Verdict::Unexplained => format!("structure is left that no effect of the catalogue accounts for: {because}"),
        _ if beside_declared => String::from(
            "the radii of the hysteresis that the description declares are taken as they are, and where they are off, \
             another joint looks as if it had one",
        ),
        _ if may_lag => String::from("hysteresis with a curve or creep besides is also how a joint looks that lags"),
        _ => format!("structure is left beyond the named effects: {because}"),
    };
    (verdict, why)
}

/// The verdict, and why, where it would be that nothing is left, but a test finds that
/// poses held out are not predicted.
pub fn missed(verdict: Verdict, test: &StructureTest) -> Option<(Verdict, String)> {
    let p = Shown(test.p_value);
    match verdict {
        Verdict::Adequate => Some((
            Verdict::Unexplained,
            format!("the poses held out are not predicted as well as the others are fitted (p {p})"),
        )),
        Verdict::Explained => Some((
            Verdict::Partial,
            format!(
                "with the named effects the poses held out are not predicted as well as the others are fitted (p {p})"
            ),
        )),
        _ => None,
    }
}

/// A probability as a sentence shows it.
struct Shown(f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 < 1e-3 { f.write_str("< 0.001") } else { write!(f, "= {:.3}", self.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever lies along it: there is nothing to compare it with.
    #[test]
    fn what_cannot_be_left_out_is_not_taken_back() {
        let along = Along { ratio: 1.2, is_significant: true };
        assert_eq!(worth_of_fallen(None, along), None);
        assert_eq!(worth_of_fallen(Some(0.99), along), None);
        assert!(worth_of_fallen(Some(0.5), along).is_some());
        // A worth that nothing leaves is none to fall by.
        assert_eq!(worth_of_fallen(Some(f64::NAN), along), None);
    }
}
