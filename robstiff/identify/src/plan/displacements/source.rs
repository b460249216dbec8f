//! Which numbers of the regression planning looks at, and which effects rival:
//! what the adapter of displacements takes from a trace.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use crate::campaign::Campaign;
use crate::identify::column::Column;
use crate::identify::prepare::Prepared;
use crate::identify::{Error, element_name, unit_of};
use crate::plan::rivals::{Group, Number, Rival, Rivals, computed, pairs};
use crate::trace::bench::Bench;
use crate::trace::catalogue::{Candidate, Catalogue};
use crate::trace::found::full_name;
use crate::trace::model::{Fitted, Named};
use crate::trace::selection::best_with;
use crate::trace::{Place, Trace};

/// A number that planning looks at.
#[derive(Clone, Debug, PartialEq)]
pub enum Kept {
    /// One of the description.
    Own(Column),
    /// One of a candidate, by its kind and place, and which of its numbers.
    Of(&'static str, Place, usize),
}

/// The first number of a candidate, of numbers whose columns follow `own` ones.
pub fn start(everything: &Catalogue, kind: &str, place: Place, own: usize) -> Option<usize> {
    let is_it = |candidate: &&Candidate| candidate.kind.name == kind && candidate.place == place;
    let candidate = everything.candidates.iter().find(is_it)?;
    candidate.variants.iter().flat_map(|variant| &variant.columns).min().map(|first| first - own)
}

/// The regression of a campaign, where rivals come from.
pub struct Source<'s> {
    /// Where models are fitted.
    pub bench: &'s Bench<'s>,
    /// The campaign, made ready.
    pub prepared: &'s Prepared<'s>,
    /// Everything that may be missing.
    pub everything: &'s Catalogue,
}

impl Source<'_> {
    /// What a column of the regression is.
    pub fn kept(&self, column: usize) -> Kept {
        let own = self.prepared.own.len();
        if column < own {
            return Kept::Own(self.prepared.own[column].column);
        }
        let has = |candidate: &&Candidate| candidate.variants.iter().any(|variant| variant.columns.contains(&column));
        let candidate = self.everything.candidates.iter().find(has).expect("every column is somebody's");
        let first = start(self.everything, candidate.kind.name, candidate.place, own).expect("it has columns");
        Kept::Of(candidate.kind.name, candidate.place, column - own - first)
    }

    /// The best fitting form of a candidate beside others, and its model.
    fn best(&self, name: &str, beside: &[Named]) -> Option<(Named, Fitted)> {
        let candidate = self.bench.candidates().iter().position(|candidate| candidate.name() == name)?;
        let setting = self.bench.at(beside).ok()?;
        let fitted = best_with(&setting, beside, candidate)?;
        let named = *fitted.named.iter().find(|named| named.candidate == candidate)?;
        Some((named, fitted))
    }

    /// The columns of a named candidate, and their values in a fit.
    fn numbers_of(&self, named: Named, fitted: &Fitted) -> (Vec<usize>, Vec<f64>) {
        let columns = self.bench.candidates()[named.candidate].variants[named.variant].columns.clone();
        let value = |column: &usize| {
            let at = fitted.fit.columns.iter().position(|other| other == column);
            at.map_or(0.0, |k| fitted.fit.coefficients[k])
        };
        let values = columns.iter().map(value).collect();
        (columns, values)
    }

    /// The rivals of a trace, the effects named, and the regression's columns that planning
    /// looks at; rivals refer to them by index.
    pub fn rivals(
        &self,
        campaign: &Campaign,
        trace: &Trace,
        groups: &[Group],
    ) -> Result<(Rivals, Vec<Named>, Vec<usize>), Error> {
        let mut named: Vec<(String, Named)> = Vec::new();
        for effect in &trace.effects {
            let mut beside: Vec<Named> = named.iter().map(|(_, named)| *named).collect();
            beside.sort_unstable();
            let name = effect.effect.to_string();
            if let Some((found, _)) = self.best(&name, &beside) {
                named.push((name, found));
            }
        }
        let sorted = |without: Option<&str>| -> Vec<Named> {
            let kept = named.iter().filter(|(name, _)| Some(name.as_str()) != without);
            let mut kept: Vec<Named> = kept.map(|(_, named)| *named).collect();
            kept.sort_unstable();
            kept
        };
        let columns_of = |named: &[Named]| -> Vec<usize> {
            let of = |one: &Named| self.bench.candidates()[one.candidate].variants[one.variant].columns.clone();
            named.iter().flat_map(of).collect()
        };
        let model = sorted(None);
        let fitted = self.bench.fit(&model).map_err(Error::NotShown)?;
        // With an effect, loads may turn a joint that they do not turn as the file has them.
        let own = self.prepared.own.len();
        let base: Vec<usize> = fitted.fit.columns.iter().copied().filter(|&column| column < own).collect();
        let mut columns = Vec::new();
        let mut place = |column: usize| {
            columns.iter().position(|&other| other == column).unwrap_or_else(|| {
                columns.push(column);
                columns.len() - 1
            })
        };
        let numbers = fitted.fit.columns.iter().zip(fitted.fit.coefficients.iter());
        let numbers = numbers.map(|(&column, &value)| self.number(campaign, column, place(column), value)).collect();
        let mut places = |of: &[usize]| -> Vec<usize> { of.iter().map(|&column| place(column)).collect() };
        let mut contests = Vec::new();
        for Group { named: own, names } in groups {
            let own = own.map(|k| trace.effects[k].effect.to_string());
            let beside = sorted(own.as_deref());
            let core: Vec<usize> = base.iter().copied().chain(columns_of(&beside)).collect();
            let core = places(&core);
            let found = computed(names).filter_map(|name| {
                let (one, fitted) = self.best(name, &beside)?;
                let (columns, values) = self.numbers_of(one, &fitted);
                let parameters = self.bench.candidates()[one.candidate].variants[one.variant].parameters;
                Some((name.clone(), Rival { columns: places(&columns), values, parameters }))
            });
            contests.extend(pairs(&found.collect::<Vec<_>>(), &core));
        }
        let effects = places(&columns_of(&model));
        let rivals = Rivals { nuisance: Vec::new(), model: numbers, effects, pairs: contests };
        Ok((rivals, model, columns))
    }

    /// What a number of a model is: that of a column of the regression, which planning has
    /// at this place.
    fn number(&self, campaign: &Campaign, column: usize, place: usize, value: f64) -> Number {
        let (name, unit) = match (self.kept(column), column.checked_sub(self.prepared.own.len())) {
            (Kept::Of(kind, at, _), Some(k)) => {
                let number = &self.everything.numbers[k];
                (full_name(&format!("{kind}@{at}"), number.name), number.unit)
            }
            _ => {
                let number = &self.prepared.own[column];
                (element_name(&campaign.robot, number), unit_of(&campaign.robot, number.column))
            }
        };
        Number { column: place, name, unit, value }
    }
}
