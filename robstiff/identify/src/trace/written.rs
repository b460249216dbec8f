//! What is written down of a model: a description that can be read back and does what
//! the model does.

use std::format;
use std::rc::Rc;
use std::string::{String, ToString};
use std::vec::Vec;

use robstiff_robots::Description;

use super::NamedEffect;
use super::bench::Bench;
use super::found::{EffectParameter, Found, add};
use super::model::{Fitted, Named, Setting};
use super::report::named::in_order;
use crate::campaign::Campaign;
use crate::identify::Error;
use crate::identify::baseline::with_values;
use crate::identify::normal::Sign;
use crate::identify::prepare::Prepared;
use crate::identify::readable::{is_readable, readable};

/// Numbers that noise takes beyond what a description says cost no more than this many
/// times the residual variance when they are held there: three standard deviations.
const BY_NOISE: f64 = 9.0;

/// A model whose numbers a description takes, the others fitted again; as it is where
/// that would be another model.
pub fn within_description(
    campaign: &Campaign,
    prepared: &Prepared<'_>,
    setting: &Setting<'_>,
    model: &Fitted,
) -> Fitted {
    let signs: Vec<Sign> = model.fit.columns.iter().map(|&column| setting.signs[column]).collect();
    let described = |fit: &crate::identify::normal::Fit| {
        let model = Fitted { fit: fit.clone(), ..model.clone() };
        let mut description = with_values(&campaign.robot, &values(prepared, setting, &model));
        let place = |column: &usize| fit.columns.iter().position(|of| of == column);
        let own = |effect: usize| -> Vec<usize> {
            let columns = (0..prepared.own.len()).filter(|&column| prepared.own[column].effect == Some(effect));
            columns.filter_map(|column| place(&column)).collect()
        };
        let mut places: Vec<Vec<usize>> = (0..description.effects.len()).map(own).collect();
        for &one in &model.named {
            let found = plain(setting, &model, one);
            if let Some(effect) = found.effect_on(&description).filter(|_| !found.is_of_rig()) {
                let columns = setting.variant(one).columns.iter().filter_map(place);
                let at = add(&mut description, effect);
                places.resize(description.effects.len(), Vec::new());
                places[at].extend(columns);
            }
        }
        (description, places)
    };
    let variance = setting.problem.variance(&model.fit);
    let held = readable(&setting.problem.total, &model.fit, &signs, described);
    match held.filter(|held| held.rss - model.fit.rss <= BY_NOISE * variance) {
        Some(fit) => Fitted { fit, ..model.clone() },
        None => model.clone(),
    }
}

/// The model without effects that a description has a word for but takes at no such
/// numbers, fitted again, with its setting; `None` where there are none of these. What made
/// up for such an effect can be driven beyond physics without it, and goes with it.
pub fn without_untold<'c>(
    campaign: &Campaign,
    prepared: &Prepared<'_>,
    bench: &Bench<'c>,
    setting: &Setting<'_>,
    model: &Fitted,
) -> Option<(Rc<Setting<'c>>, Fitted)> {
    let fit = |rest: &[Named]| {
        let setting = bench.at(rest).ok()?;
        let fitted = setting.fit(rest).ok().or_else(|| setting.fit_loosely(rest))?;
        Some((Rc::clone(&setting), within_description(campaign, prepared, &setting, &fitted)))
    };
    let stays = |(setting, fitted): &(Rc<Setting<'c>>, Fitted)| {
        let mut stays = taken(campaign, prepared, setting, fitted);
        stays.retain(|&one| setting.check_effect(&fitted.fit, one).is_ok());
        stays
    };
    fitted_again(model.named.len(), taken(campaign, prepared, setting, model), fit, stays)
}

/// A model of fewer effects than there were, fitted until all stay that it has; `None` where
/// it has as many, or not even one without effects can be fitted.
pub fn fitted_again<M>(
    before: usize,
    mut rest: Vec<Named>,
    fit: impl Fn(&[Named]) -> Option<M>,
    stays: impl Fn(&M) -> Vec<Named>,
) -> Option<M> {
    if rest.len() == before {
        return None;
    }
    loop {
        match fit(&rest) {
            Some(model) => {
                let stays = stays(&model);
                if stays.len() == rest.len() {
                    return Some(model);
                }
                rest = stays;
            }
            None => drop(rest.pop()?),
        }
    }
}

/// The effects of a model but those that a description has a word for and does not take.
fn taken(campaign: &Campaign, prepared: &Prepared<'_>, setting: &Setting<'_>, model: &Fitted) -> Vec<Named> {
    let description = with_values(&campaign.robot, &values(prepared, setting, model));
    taken_by(description, &model.named, |one| plain(setting, model, one))
}

/// Of some effects, those that a description takes one after the other or has no word for.
pub fn taken_by(mut description: Description, named: &[Named], found: impl Fn(Named) -> Found) -> Vec<Named> {
    let mut is_taken = |&one: &Named| {
        let found = found(one);
        found.is_of_rig() || found.effect().is_none() || found.write_into(&mut description)
    };
    named.iter().copied().filter(&mut is_taken).collect()
}

/// The effects of a model with its own numbers, in the order in which they are told.
pub fn own_effects(setting: &Setting<'_>, model: &Fitted, told: &[NamedEffect]) -> Vec<Found> {
    in_told_order(model.named.iter().map(|&one| plain(setting, model, one)), told)
}

/// Effects in the order in which they are told.
pub fn in_told_order(effects: impl Iterator<Item = Found>, told: &[NamedEffect]) -> Vec<Found> {
    let place = |found: &Found| {
        let same = |named: &NamedEffect| named.effect.kind() == found.kind() && named.effect.place() == found.place();
        told.iter().position(same)
    };
    let mut effects: Vec<Found> = effects.collect();
    effects.sort_by_key(place);
    effects
}

/// The description's own numbers in a model.
pub fn values(prepared: &Prepared<'_>, setting: &Setting<'_>, model: &Fitted) -> Vec<f64> {
    // What is not fitted is held as declared.
    let mut values: Vec<f64> = prepared.own.iter().map(|number| number.value).collect();
    for (&column, &value) in model.fit.columns.iter().zip(model.fit.coefficients.iter()) {
        if column < setting.own.len() {
            values[column] = value;
        }
    }
    values
}

/// An effect of a model with its numbers alone.
pub fn plain(setting: &Setting<'_>, model: &Fitted, one: Named) -> Found {
    let variant = setting.variant(one);
    let number = |(k, column): (usize, &usize)| {
        let number = &setting.numbers[column - setting.own.len()];
        let at = model.fit.columns.iter().position(|of| of == column).expect("its own model has it");
        let whole = number.share_of.map_or(1.0, |joint| setting.joint_value(&model.fit, joint));
        let name = variant.names.get(k).copied().unwrap_or(number.name);
        EffectParameter { name, value: model.fit.coefficients[at] / whole, std: None, unit: number.unit }
    };
    let numbers = variant.columns.iter().enumerate().map(number).collect();
    let candidate = &setting.candidates[one.candidate];
    Found::new(candidate.kind, candidate.place, in_order(numbers, variant.shape.clone()))
}

/// The description with identified numbers and named effects, which says what from:
/// the campaign, or what it is where it has no name.
///
/// # Errors
/// As for [`with_effects`].
pub fn described(campaign: &Campaign, nameless: &str, values: &[f64], effects: &[Found]) -> Result<Description, Error> {
    let from = if campaign.name.is_empty() { nameless } else { &campaign.name };
    with_effects(with_values(&campaign.robot, values), effects, |names| {
        let with = if names.is_empty() { String::new() } else { format!(", with {names}") };
        format!("Compliances identified from {from}{with}.")
    })
}

/// A description with as many of the named effects as it takes; a sentence with the names
/// of these is added to its source.
///
/// # Errors
/// A description that could not be read back without the effects.
pub fn with_effects(
    mut description: Description,
    effects: &[Found],
    sentence: impl FnOnce(&str) -> String,
) -> Result<Description, Error> {
    if !is_readable(&description) {
        return Err(Error::NoDescription);
    }
    let written = effects.iter().filter(|effect| effect.write_into(&mut description));
    let names: Vec<String> = written.map(ToString::to_string).collect();
    let source = description.source.trim_end();
    let separator = if source.is_empty() { "" } else { "\n" };
    description.source = format!("{source}{separator}{}", sentence(&names.join(", ")));
    Ok(description)
}
