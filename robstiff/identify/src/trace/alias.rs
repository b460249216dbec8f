//! What the data cannot tell a named effect from.

use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use super::Options;
use super::bench::Bench;
use super::bootstrap::Remaining;
use super::catalogue::{Candidate, EITHER, HYSTERESIS, LOST_MOTION, STIFFNESS_NONLINEARITY, Variant, tells_hysteresis};
use super::found::Place;
use super::isolated::Event;
use super::model::{Fitted, Named, Setting, all_but};
use super::selection::{CURVATURE, Tests, WITHIN_REACH, best_with};
use crate::identify::normal::{Fit, Sign};
use crate::probability::schwarz;
use robstiff::Effect;
use robstiff_robots::effect::Place as Part;

/// Columns that differ by less than this fraction of their energy, once the
/// rest of the model is fitted again, are the same but for rounding in the
/// poses: exact aliases.
const EXACT: f64 = 1e-6;

/// A rival whose misfit per pose differs from the named effect's by less than
/// this many standard errors is not told from it by the poses (Vuong,
/// Econometrica 57, 1989, one-sided at 1 %). With structure left, rows of a
/// pose agree on the better name for reasons that have nothing to do with it,
/// and the criterion is too sure; poses are independent witnesses.
const WITNESSES: f64 = 2.33;

/// Where the model leaves noise alone, its rows are witnesses too: a rival behind it by
/// more (odds of `exp(100 / 2)`) is none, whether few poses say so or many.
const BEYOND_DOUBT: f64 = 100.0;

/// The names of what the data cannot tell effect `k` of a model from, with `structure`
/// left or none: exact aliases at the model's own solution, and rivals that predict poses
/// left out better than no effect does and fit about as well as this one, or nearly so
/// where they are significant too; and what is as good in its own form by all rows, one of `swaps`. The
/// best fitting first.
pub fn same_as(
    bench: &Bench<'_>,
    model: &Fitted,
    k: usize,
    swaps: &[Swap],
    structure: bool,
    options: &Options,
) -> Vec<String> {
    let (one, rest) = (model.named[k], all_but(&model.named, k));
    let Some(alone) = Alone::of(bench, model, &rest) else { return Vec::new() };
    let without = Without::of(bench, &rest, options);
    let own = &alone.own.setting;
    let contest = Contest { bench, model, of_model: own.deviances(&model.fit), structure, alpha: options.alpha };
    let mut found: Vec<(f64, String)> = Vec::new();
    for candidate in (0..own.candidates.len()).filter(|&candidate| candidate != one.candidate) {
        let rival = without.as_ref().and_then(|without| Some((without, without.with(&rest, candidate)?)));
        let bic = rival.as_ref().map(|(_, rival)| rival.bic);
        let Some(bic) = bic.or_else(|| Some(best_with(own, &rest, candidate)?.bic)) else { continue };
        let is_alike = alone.is_exact(one, &rest, candidate)
            || one_formula(bench, own, model, one, candidate)
            || swaps.iter().any(|swap| swap.k == k && swap.candidate == candidate)
            || rival.is_some_and(|(without, rival)| contest.is_open(without, &rival, candidate));
        if is_alike {
            found.push((bic, own.candidates[candidate].name()));
        }
    }
    best_first(found).chain(dead_zone(bench, own, model, one)).collect()
}

/// A model against rivals that have another effect in the place of one of its own.
struct Contest<'b, 'c> {
    bench: &'b Bench<'c>,
    model: &'b Fitted,
    /// What the model leaves of each pose.
    of_model: Vec<f64>,
    /// Whether it leaves structure.
    structure: bool,
    /// The level of the tests.
    alpha: f64,
}

impl Contest<'_, '_> {
    /// Whether a rival with a candidate, fitted where the effect is missing, predicts poses left out
    /// better than no effect, and fits about as well as the model.
    fn is_open(&self, without: &Without<'_>, rival: &Fitted, candidate: usize) -> bool {
        let is_significant = without.tests.p_value(candidate) <= self.alpha;
        // In its own form it may fit better than its tangent does.
        let in_its_own_form = || {
            let at = self.bench.at(&rival.named).ok()?;
            let rival = at.fit(&rival.named).ok()?;
            Some(self.fits_as_well(&rival, &at, is_significant))
        };
        let may_fit = is_significant && self.bench.is_nonlinear(&rival.named) && rival.bic < self.model.bic + CURVATURE;
        (self.fits_as_well(rival, &without.setting, is_significant) || (may_fit && in_its_own_form().unwrap_or(false)))
            && without.setting.left_out(&rival.fit).deviance < without.unseen
    }

    /// Whether a rival, at the setting it was fitted at, is as good by the criterion, or nearly so
    /// where it is significant and too few poses witness against it.
    fn fits_as_well(&self, rival: &Fitted, at: &Setting<'_>, is_significant: bool) -> bool {
        let behind = rival.bic - self.model.bic;
        behind < WITHIN_REACH
            || (is_significant
                && (self.structure || behind < BEYOND_DOUBT)
                && witnesses(&self.of_model, &at.deviances(&rival.fit)) < WITNESSES)
    }
}

/// What the others of a model leave of all columns, at a solution.
struct Beside<'c> {
    setting: Rc<Setting<'c>>,
    left: Remaining,
}

impl<'c> Beside<'c> {
    fn at(setting: Rc<Setting<'c>>, others: &[Named]) -> Option<Self> {
        let tested = setting.own.len()..setting.signs.len();
        let left = Remaining::new(&setting.problem.total, &setting.columns(others), tested)?;
        Some(Self { setting, left })
    }
}

/// Where exact aliases of an effect are asked for: at the solution of the whole model. The others
/// fitted without the effect may come to numbers that are physically impossible, so that is no
/// place to ask at. But at the whole solution the effect's own numbers have moved the loads and
/// lengths that rivals of its kind would move, and a rival would look like a copy of it: numbers
/// that enter the forward model in this way are asked for where the others are without it.
struct Alone<'c> {
    own: Beside<'c>,
    others: Option<Beside<'c>>,
}

impl<'c> Alone<'c> {
    fn of(bench: &Bench<'c>, model: &Fitted, others: &[Named]) -> Option<Self> {
        let own = Beside::at(bench.at(&model.named).ok()?, others)?;
        let others = bench.at(others).ok().and_then(|setting| Beside::at(setting, others));
        Some(Self { own, others })
    }

    fn beside(&self, candidate: usize) -> Option<&Beside<'c>> {
        let setting = &self.own.setting;
        let columns = || setting.candidates[candidate].variants.iter().flat_map(|variant| &variant.columns);
        let is_linear = columns().all(|column| setting.numbers[column - setting.own.len()].enters.is_none());
        if is_linear { Some(&self.own) } else { self.others.as_ref() }
    }

    /// Whether a candidate is, beside the others, the same as an effect but for rounding.
    fn is_exact(&self, one: Named, others: &[Named], candidate: usize) -> bool {
        let distance = || {
            let Beside { setting, left } = self.beside(candidate)?;
            let rival = best_with(setting, others, candidate)?;
            let [from, to] = [one, variant_of(&rival, candidate)].map(|named| setting.variant(named));
            Some(left.distance(from, to))
        };
        distance().is_some_and(|distance| distance < EXACT)
    }
}

/// The model without an effect, as it fits best.
struct Without<'c> {
    setting: Rc<Setting<'c>>,
    tests: Rc<Tests>,
    /// What poses left out leave of it, whitened and squared.
    unseen: f64,
}

impl<'c> Without<'c> {
    /// None where physics does not allow it.
    fn of(bench: &Bench<'c>, rest: &[Named], options: &Options) -> Option<Self> {
        let setting = bench.at(rest).ok()?;
        let tests = bench.tests(rest, options)?;
        let unseen = setting.left_out(&setting.fit(rest).ok()?.fit).deviance;
        Some(Self { setting, tests, unseen })
    }

    /// The best model with a candidate in the place of the effect.
    fn with(&self, rest: &[Named], candidate: usize) -> Option<Fitted> {
        best_with(&self.setting, rest, candidate)
    }
}

/// Of an effect with more numbers than this, none has an alias of its own.
const PARTS: usize = 4;

/// The names of what some numbers of effect `k` of a model may as well be, the others kept: a
/// translation of the base, told with its tilt, is one of the tool as well. Exact aliases alone,
/// of those that are not named.
pub fn in_part(bench: &Bench<'_>, model: &Fitted, k: usize) -> Vec<String> {
    let (one, rest) = (model.named[k], all_but(&model.named, k));
    let Some(alone) = Alone::of(bench, model, &rest) else { return Vec::new() };
    let own = alone.own.setting.variant(one);
    let columns = &own.columns;
    if !own.shape.is_empty() || columns.len() > PARTS {
        return Vec::new();
    }
    let has_alias = |(index, candidate): (usize, &Candidate)| {
        let Some(Beside { setting, left }) = alone.beside(index) else { return false };
        let others = setting.columns(&rest);
        (1..(1_u32 << columns.len()) - 1).any(|set| {
            let of = |inside: bool| -> Vec<usize> {
                (0..columns.len()).filter(|k| (set >> k & 1 == 1) == inside).map(|k| columns[k]).collect()
            };
            let (part, kept) = (of(true), of(false));
            let alike = |other: &Variant| {
                let with_the_others: Vec<usize> = other.columns.iter().chain(&kept).copied().collect();
                let whole = [&others[..], &with_the_others].concat();
                let [part, other] = [part.clone(), with_the_others].map(|columns| Variant::new(columns, Vec::new()));
                left.distance(&part, &other) < EXACT && is_possible(setting, &whole)
            };
            candidate.variants.iter().filter(|other| other.columns.len() == part.len()).any(alike)
        })
    };
    let named = |candidate: usize| model.named.iter().any(|one| one.candidate == candidate);
    let unnamed = alone.own.setting.candidates.iter().enumerate().filter(|&(candidate, _)| !named(candidate));
    unnamed.filter(|&candidate| has_alias(candidate)).map(|(_, candidate)| candidate.name()).collect()
}

/// Whether columns fit with numbers that are possible. A scale of the loads is in the span of
/// all compliances, and each of these in that of the scale and the others; but the scale would
/// have to be 1 and the others nothing.
fn is_possible(setting: &Setting<'_>, columns: &[usize]) -> bool {
    let signs: Vec<Sign> = columns.iter().map(|&column| setting.signs[column]).collect();
    let Some(fit) = setting.problem.total.solve_signed(columns, &signs) else { return false };
    let is_within = |(&column, &value): (&usize, &f64)| {
        column.checked_sub(setting.own.len()).is_none_or(|k| {
            let [least, most] = setting.numbers[k].range;
            least < value && value < most
        })
    };
    fit.columns.iter().zip(fit.coefficients.iter()).all(is_within)
}

/// Rows that are left out as wild, held against the same model with them in the fit.
struct Wild<'c> {
    /// With them.
    whole: Bench<'c>,
    setting: Rc<Setting<'c>>,
    /// The criterion of that model with a shift for each event.
    as_wild: f64,
}

impl<'c> Wild<'c> {
    /// None without such rows among those that are fitted to, or where a model cannot be fitted.
    fn of(bench: &Bench<'c>, named: &[Named], events: &[Event]) -> Option<Self> {
        let is_fitted_to = |event: &&Event| event.rows.iter().all(|&row| bench.is_fitted_to(row));
        let events: Vec<&Event> = events.iter().filter(is_fitted_to).collect();
        if events.is_empty() {
            return None;
        }
        let out: Vec<usize> = events.iter().flat_map(|event| &event.rows).copied().collect();
        let (whole, rest) = (bench.leaving_out(&[]), bench.leaving_out(&out));
        let (setting, others) = (whole.at(named).ok()?, rest.at(named).ok()?);
        let Fitted { fit, .. } = others.fit(named).ok()?;
        // An event of several rows has one shift, and noise in the rest of their readings.
        let shifts = 3 * events.len();
        let noise = (setting.problem.total.rows - others.problem.total.rows).saturating_sub(shifts);
        let rss = fit.rss * (1.0 + noise as f64 / others.problem.freedom(&fit));
        // Which visit it is, and its shift.
        let as_wild = setting.bic(named, &Fit { rss, ..fit }, 4 * events.len());
        Some(Self { whole, setting, as_wild })
    }
}

/// The same with the rows in the fit that are left out as wild, where it fits about as well
/// without a shift for them: what stands out from the noise need not stand out from structure.
pub fn with_wild_rows<'c>(bench: &Bench<'c>, model: &Fitted) -> Option<(Bench<'c>, Fitted)> {
    // What poses held out have is in no fit that could say so.
    if !bench.events.iter().flat_map(|event| &event.rows).all(|&row| bench.is_fitted_to(row)) {
        return None;
    }
    let Wild { mut whole, setting, as_wild } = Wild::of(bench, &model.named, &bench.events)?;
    let with = setting.fit(&model.named).ok()?;
    whole.events = Rc::new([]);
    (with.bic - as_wild < WITHIN_REACH).then_some((whole, with))
}

/// The names of what may as well have made the rows that are left out as wild: effects
/// that with these rows in the fit leave as little as a shift of each event does. They
/// need not have passed the tests by which effects are named, for these ask for poses
/// that agree, and a part that few poses load has few.
pub fn same_as_wild(bench: &Bench<'_>, model: &Fitted, events: &[Event]) -> Vec<String> {
    let named = &model.named;
    let Some(Wild { whole, setting, as_wild }) = Wild::of(bench, named, events) else { return Vec::new() };
    let mut found: Vec<(f64, String)> = Vec::new();
    for candidate in 0..setting.candidates.len() {
        let Some(rival) = best_with(&setting, named, candidate) else { continue };
        if rival.bic - as_wild > CURVATURE {
            continue;
        }
        let Ok(rival) = whole.polished(&rival.named).fit(&rival.named) else { continue };
        if rival.bic - as_wild < WITHIN_REACH {
            found.push((rival.bic, setting.candidates[candidate].name()));
        }
    }
    best_first(found).collect()
}

/// Names in the order of their criterion.
fn best_first(mut found: Vec<(f64, String)>) -> impl Iterator<Item = String> {
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, name)| name)
}

/// The hysteresis that a softening may as well be where the joint's torque never goes back
/// ([`tells_hysteresis`]). Hysteresis is no candidate then.
fn dead_zone(bench: &Bench<'_>, setting: &Setting<'_>, model: &Fitted, one: Named) -> Option<String> {
    let (own, scene) = (&setting.candidates[one.candidate], bench.scene());
    let Place::Part(Part::Joint(joint)) = own.place else { return None };
    if own.kind != &STIFFNESS_NONLINEARITY || tells_hysteresis(&scene, joint) {
        return None;
    }
    let softens = |column: &usize| {
        let at = model.fit.columns.iter().position(|of| of == column);
        at.is_some_and(|at| model.fit.coefficients[at] < 0.0)
    };
    let known = |effect: &Effect| HYSTERESIS.is_of(effect) && own.place == Place::Part(effect.place());
    (setting.variant(one).columns.iter().any(softens) && !scene.description.effects.iter().any(known))
        .then(|| std::format!("{}@{}", HYSTERESIS.name, own.place))
}

/// Whether a candidate is the other name of what lost motion and hardening both
/// do, and the knee that a model found may be either's.
fn one_formula(bench: &Bench<'_>, setting: &Setting<'_>, model: &Fitted, one: Named, candidate: usize) -> bool {
    let (own, other) = (&setting.candidates[one.candidate], &setting.candidates[candidate]);
    let kinds = [own.kind, other.kind];
    let both = [&LOST_MOTION, &STIFFNESS_NONLINEARITY];
    let Place::Part(Part::Joint(joint)) = own.place else { return false };
    let variant = setting.variant(one);
    let (Some(knee), &[column]) = (variant.shape.first(), &variant.columns[..]) else { return false };
    if own.place != other.place || own.kind == other.kind || !kinds.iter().all(|kind| both.contains(kind)) {
        return false;
    }
    let hardens =
        model.fit.columns.iter().zip(&model.fit.coefficients).any(|(&of, &value)| of == column && value > 0.0);
    let largest = bench.scene().largest_carried(joint);
    hardens && largest.is_some_and(|largest| (EITHER[0]..=EITHER[1]).contains(&(knee.value / largest)))
}

fn variant_of(model: &Fitted, candidate: usize) -> Named {
    let named = model.named.iter().find(|one| one.candidate == candidate);
    *named.expect("the rival is in its own model")
}

/// By how many standard errors the rival's misfit per pose exceeds the
/// model's.
fn witnesses(of_model: &[f64], of_rival: &[f64]) -> f64 {
    let differences: Vec<f64> = of_rival.iter().zip(of_model).map(|(rival, model)| rival - model).collect();
    let count = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / count;
    let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    mean / (variance / count).sqrt().max(f64::MIN_POSITIVE)
}

/// A whole model that the data cannot tell from the one that was named.
#[derive(Clone, Debug, PartialEq)]
pub struct Rival {
    /// The full names of its effects.
    pub names: Vec<String>,
    /// By how much its information criterion is above that of the model named. The odds against
    /// it are `exp` of half of that (Kass and Raftery, JASA 90, 1995): 20 to 1 at 6.
    pub bic_difference: f64,
}

/// A model that has another candidate in the place of one effect of the model named, in its own
/// form.
pub struct Swap {
    /// Which effect is replaced, by its place.
    pub k: usize,
    /// The candidate in its place.
    pub candidate: usize,
    /// The model.
    pub model: Fitted,
    /// By how much its criterion of all rows is above that of the model named.
    pub behind: f64,
}

/// The models with one effect replaced that are within reach of a model by the criterion of all
/// rows, or better, the best first. `events` are what is wrong in single visits by the model.
pub fn swaps(bench: &Bench<'_>, model: &Fitted, events: &[Event]) -> Vec<Swap> {
    let mut found = Vec::new();
    let of_all_rows = OfAllRows::new(bench, events);
    let Some(own) = of_all_rows.bic(model) else { return found };
    let whole = bench.at(&model.named).ok();
    let is_named = |candidate: &usize| model.named.iter().any(|one| one.candidate == *candidate);
    for k in 0..model.named.len() {
        let rest = all_but(&model.named, k);
        let settings: Vec<Rc<Setting<'_>>> = bench.at(&rest).ok().into_iter().chain(whole.clone()).collect();
        for candidate in (0..bench.candidates().len()).filter(|candidate| !is_named(candidate)) {
            let linear = settings.iter().filter_map(|at| Some((at, best_with(at, &rest, candidate)?)));
            let Some((at, near)) = linear.min_by(|a, b| a.1.bic.total_cmp(&b.1.bic)) else { continue };
            if near.bic - model.bic > CURVATURE {
                continue;
            }
            // A proposal that is linear is in its own form where the others stand without it.
            let in_own_form = bench.refit(at, &near).ok().filter(|rival| rival.bic - model.bic < CURVATURE);
            let Some(rival) = in_own_form else { continue };
            let Some(behind) = of_all_rows.bic(&rival).map(|bic| bic - own) else { continue };
            if behind < WITHIN_REACH {
                found.push(Swap { k, candidate, model: rival, behind });
            }
        }
    }
    found.sort_by(|a, b| a.behind.total_cmp(&b.behind));
    found
}

/// The criterion of a model of all rows: what is wrong in single visits has a shift of its own, or is
/// in the fit, whichever is better; `None` where it cannot be fitted so.
pub fn bic_of_all(bench: &Bench<'_>, model: &Fitted, events: &[Event]) -> Option<f64> {
    OfAllRows::new(bench, events).bic(model)
}

/// What models are held against by the criterion of all rows.
struct OfAllRows<'b, 'c> {
    bench: &'b Bench<'c>,
    /// With the rows in the fit that are left out for what is wrong in single visits.
    whole: Bench<'c>,
    /// How many such visits there are among those fitted to.
    events: usize,
}

impl<'b, 'c> OfAllRows<'b, 'c> {
    fn new(bench: &'b Bench<'c>, events: &[Event]) -> Self {
        // Those of poses held out have no part in a fit.
        let is_fitted_to = |event: &&Event| event.rows.iter().all(|&row| bench.is_fitted_to(row));
        Self { bench, whole: bench.leaving_out(&[]), events: events.iter().filter(is_fitted_to).count() }
    }

    fn bic(&self, model: &Fitted) -> Option<f64> {
        if self.events == 0 {
            return Some(model.bic);
        }
        let of_effects = self.bench.parameters(&model.named);
        let [rows, all] = [self.bench.count_readings(), self.whole.count_readings()];
        let criterion = |fit: &Fit, rss: f64, more: usize| {
            let base = fit.columns.iter().filter(|&&column| self.bench.is_base(column)).count();
            schwarz(rss, all as f64, (base + of_effects + more) as f64)
        };
        // An event of several rows has one shift, and noise in the rest of their readings.
        let noise = (all - rows).saturating_sub(3 * self.events);
        let freedom = rows.saturating_sub(model.fit.columns.len()).max(1);
        let rss = model.fit.rss * (1.0 + noise as f64 / freedom as f64);
        let as_wild = criterion(&model.fit, rss, 4 * self.events);
        let in_the_fit = self.whole.fit_at_solution(&model.named).ok();
        Some(in_the_fit.map_or(as_wild, |fit| as_wild.min(criterion(&fit, fit.rss, 0))))
    }
}

/// The models that come close to the one named: of as many effects, and another that was come to.
pub fn rivals(bench: &Bench<'_>, swaps: &[Swap], other: Option<&Rival>) -> Vec<Rival> {
    let rival = |swap: &Swap| Rival { names: bench.names(&swap.model.named), bic_difference: swap.behind.max(0.0) };
    let mut rivals: Vec<Rival> = swaps.iter().map(rival).collect();
    rivals.extend(other.filter(|other| rivals.iter().all(|rival| rival.names != other.names)).cloned());
    rivals.sort_by(|a, b| a.bic_difference.total_cmp(&b.bic_difference));
    rivals
}
