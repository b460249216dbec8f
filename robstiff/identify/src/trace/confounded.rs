//! Which numbers would be others if an effect were there that the data cannot tell from what a
//! model has.
//!
//! Compliances about one point add up. Where the axes of a shoulder meet in a point, joint 2 with
//! its tilt lets the arm turn about every axis alike, and so does joint 3 with its own: the tilt of
//! joint 3 is that of joint 2 with joint 2 softer and joint 3 stiffer, at every pose and under
//! every load. All mixtures of both that leave no compliance below zero fit as well. That the name
//! may be another says [`same_as`](super::alias::same_as); that the numbers of the joints may be
//! others, however well they fit, is said here.
//!
//! It takes an effect that is there. That a link twists about the axis of its joint is part of what
//! the compliance of a joint means, until something says that this link yields.

use std::collections::BTreeSet;
use std::string::String;
use std::vec::Vec;

use nalgebra::DVector;

use super::catalogue::{
    BASE_COMPLIANCE, Candidate, Kind, LINK_COMPLIANCE, TOOL_COMPLIANCE, TRANSVERSE_COMPLIANCE, Variant,
};
use super::model::{Fitted, Setting};
use crate::identify::normal::{Fit, Normal, Projected, Scaled, Sign};
use crate::identify::prepare::Prepared;
use crate::identify::{Estimate, Visibility, element_name};

/// Kinds whose numbers are compliances of one place each, which add up with those of others.
static ADD_UP: [&Kind; 4] = [&TOOL_COMPLIANCE, &BASE_COMPLIANCE, &TRANSVERSE_COMPLIANCE, &LINK_COMPLIANCE];

/// A column is like others when they leave less than this fraction of its energy. A length that
/// is off by a millimetre leaves 1e-5 of what is exactly the same without; tilts of joints that
/// are apart leave some 1e-2.
const ALIKE: f64 = 1e-3;

/// What is like others is not told from them when, as much as there can be of it, it leaves less
/// than this many standard deviations of the noise.
const HIDDEN: f64 = 2.0;

/// A fraction of a column's energy below this, left by others or that of one of them, is rounding.
const ROUNDING: f64 = 1e-6;

/// An effect that the data cannot tell from what a model has.
pub struct Alias {
    /// Its full name, or that of its number where the description has it.
    pub name: String,
    /// What each coefficient of the fit changes by, were there as much of it as there can be.
    shifts: DVector<f64>,
}

impl Alias {
    /// Whether it changes a coefficient of the fit by more than its standard deviation.
    pub fn changes(&self, at: usize, std: f64) -> bool {
        self.shifts[at].abs() > std
    }
}

/// A fit, and what is asked about it.
pub struct Asked<'a> {
    /// The normal equations of all columns.
    pub total: &'a Normal,
    /// The fit of some.
    pub fit: &'a Fit,
    /// The signs of these.
    pub signs: Vec<Sign>,
    /// Whether each of these is of an effect, and no joint's own.
    pub of_effect: Vec<bool>,
    /// The variance of a whitened reading (m^2).
    pub variance: f64,
}

impl Asked<'_> {
    /// The aliases among effects that [add up](adds_up); each by its name, with whether it is there,
    /// and its columns, of which the fit has some.
    pub fn aliases(&self, effects: impl Iterator<Item = (String, bool, BTreeSet<usize>)>) -> Vec<Alias> {
        let Some(factor) = Scaled::of(&self.total.gram_of(&self.fit.columns)) else { return Vec::new() };
        let of_effect = |(name, is_there, columns): (String, bool, BTreeSet<usize>)| {
            let missing = columns.into_iter().filter(|column| !self.fit.columns.contains(column));
            let shifts = missing.filter_map(|column| self.shifts(&factor, column, is_there));
            shifts.map(|shifts| Alias { name: name.clone(), shifts }).collect::<Vec<_>>()
        };
        effects.flat_map(of_effect).collect()
    }

    /// What the coefficients change by, were there as much of a column as there can be: until one
    /// is at zero. `None` where the data tell it from the model's, or no effect says that it
    /// may be there.
    fn shifts(&self, factor: &Scaled, column: usize, is_there: bool) -> Option<DVector<f64>> {
        let (fit, whole) = (self.fit, self.total.gram[(column, column)]);
        let Projected { gram, shares } = self.total.projected(&[column], factor, &fit.columns);
        let part = |k: usize| shares[k] * shares[k] * self.total.gram[(fit.columns[k], fit.columns[k])] / whole;
        let left = gram[(0, 0)];
        // Of a column at zero nothing is asked either.
        let is_alike = left < ALIKE * whole;
        let takes_from_effect = (0..fit.columns.len()).any(|k| self.of_effect[k] && part(k) > ALIKE);
        if !is_alike || !(is_there || takes_from_effect) {
            return None;
        }
        let takes = |&k: &usize| self.signs[k] == Sign::Nonnegative && shares[k] > 0.0 && part(k) > ROUNDING;
        let most = (0..fit.columns.len()).filter(takes).map(|k| fit.coefficients[k] / shares[k]);
        let most = most.reduce(f64::min)?;
        let is_hidden = left < ROUNDING * whole || most * most * left < HIDDEN * HIDDEN * self.variance;
        let shift = |k: usize| if part(k) > ROUNDING { -most * shares[k] } else { 0.0 };
        is_hidden.then(|| DVector::from_fn(fit.columns.len(), |k, _| shift(k)))
    }
}

/// The aliases of a model of displacements at its setting: of the catalogue, and those numbers of
/// the description's effects that it has at zero because the data do not tell them.
pub fn aliases(prepared: &Prepared<'_>, setting: &Setting<'_>, model: &Fitted) -> Vec<Alias> {
    let fit = &model.fit;
    let asked = Asked {
        total: &setting.problem.total,
        fit,
        signs: fit.columns.iter().map(|&column| setting.signs[column]).collect(),
        of_effect: fit.columns.iter().map(|&column| column >= setting.joint_values.len()).collect(),
        variance: setting.problem.variance(fit),
    };
    let is_named = |index: usize| model.named.iter().any(|one| one.candidate == index);
    let candidates = setting.candidates.iter().enumerate().filter(|(_, candidate)| adds_up(candidate));
    let of_catalogue = candidates.map(|(index, candidate)| (candidate.name(), is_named(index), columns_of(candidate)));
    let own = prepared.own.iter().enumerate().filter(|&(column, number)| {
        number.effect.is_some() && is_left_at_zero(number.value, &prepared.visibility[column])
    });
    let of_description =
        own.map(|(column, number)| (element_name(prepared.description, number), true, BTreeSet::from([column])));
    asked.aliases(of_catalogue.chain(of_description))
}

/// Whether a number of a description's effect says nothing: the effect is there, but the data do not
/// tell the number, and none is declared.
pub fn is_left_at_zero(declared: f64, visibility: &Visibility) -> bool {
    declared == 0.0 && matches!(visibility, Visibility::Confounded(_))
}

/// Whether the numbers of a candidate are compliances of one place each.
pub fn adds_up(candidate: &Candidate) -> bool {
    ADD_UP.contains(&candidate.kind)
}

/// The columns of all forms of a candidate.
pub fn columns_of(candidate: &Candidate) -> BTreeSet<usize> {
    let columns = |variant: &'_ Variant| variant.columns.clone();
    candidate.variants.iter().flat_map(columns).collect()
}

/// Says of estimates, `at` being the place of each in the fit, with which aliases they are
/// confounded. Every share of one is as likely, from none to as much as there can be, and counts
/// as spread.
pub fn tell(estimates: &mut [Estimate], aliases: &[Alias], at: impl Fn(usize) -> Option<usize>) {
    for (index, estimate) in estimates.iter_mut().enumerate() {
        let Some(at) = at(index) else { continue };
        let noise = estimate.std.unwrap_or(0.0);
        let confounded: Vec<&Alias> = aliases.iter().filter(|alias| alias.changes(at, noise)).collect();
        let spread: f64 = confounded.iter().map(|alias| alias.shifts[at].powi(2) / 3.0).sum();
        estimate.std = estimate.std.map(|std| (std * std + spread).sqrt());
        for Alias { name, .. } in confounded {
            if !estimate.confounded_with.contains(name) {
                estimate.confounded_with.push(name.clone());
            }
        }
    }
}
