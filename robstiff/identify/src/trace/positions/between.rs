//! What the catalogue has in steps, between them: the moment of a slip, and a number out
//! of a grid, the knee of a gear's law or the time constant of what settles, where they
//! leave least.

use core::f64::consts::SQRT_2;
use std::string::ToString;
use std::vec;
use std::vec::Vec;

use nalgebra::DVector;

use super::bench::{Bench, Model, TIE};
use super::offers::Between;
use super::slips::{first_moment, line};
use crate::identify::positions::regression::STANDS;
use crate::trace::catalogue::{EITHER, Variant};
use crate::trace::found::Found;
use crate::trace::model::Named;
use crate::trace::slip::{SLIPPED_AT, Slipping};

/// The first and the last factor between numbers that are tried; the first is that
/// between those of the grid, or less.
const COARSE: f64 = SQRT_2;
const FINE: f64 = 1.002;

impl Bench<'_> {
    /// The effect that was found, in its form; a slip is moved to its moment, a number out
    /// of a grid to its value.
    pub fn named(&mut self, found: &Found) -> Option<Named> {
        let candidate = self.candidates.iter().position(|candidate| candidate.name() == found.to_string())?;
        let of = |name: &str| found.parameters.iter().find(|number| number.name == name).map(|number| number.value);
        let own = STANDS + self.prepared.own.len();
        let has = |form: &Variant| {
            let numbers = form.columns.iter().map(|column| &self.numbers[column - own]);
            let numbers = numbers.map(|number| (number.name, number.unit));
            let all: Vec<_> = numbers.chain(form.shape.iter().map(|number| (number.name, number.unit))).collect();
            all.len() == found.parameters.len()
                && found.parameters.iter().all(|number| all.contains(&(number.name, number.unit)))
        };
        let off = |form: &Variant| -> f64 {
            form.shape.iter().map(|number| (number.value - of(number.name).unwrap_or(f64::INFINITY)).abs()).sum()
        };
        let forms = self.candidates[candidate].variants.iter().enumerate().filter(|(_, form)| has(form));
        let (variant, _) = forms.min_by(|(_, a), (_, b)| off(a).total_cmp(&off(b)))?;
        let named = Named { candidate, variant };
        if let Some(slipping) = found.slipping() {
            let line = of(SLIPPED_AT)?;
            let moment = self.prepared.data.rows.iter().position(|row| row.line as f64 == line)?;
            self.move_slip((named, slipping), moment);
        }
        if self.between(named).is_some() {
            let value = of(self.variant(named).shape[0].name)?;
            self.reshape(named, value);
        }
        Some(named)
    }

    /// The model with slips that it names at the moments between those tried which leave
    /// least.
    pub fn at_its_moments(&mut self, model: Model) -> Model {
        let slip = |&one: &Named| Some((one, self.candidates[one.candidate].slipping()?));
        let slips: Vec<(Named, Slipping)> = model.named.iter().filter_map(slip).collect();
        slips.into_iter().fold(model, |model, slip| self.at_its_moment(model, slip))
    }

    /// The same of one slip, by halving ever smaller steps.
    fn at_its_moment(&mut self, model: Model, slip: (Named, Slipping)) -> Model {
        let (rows, tried) = (&self.prepared.data.rows, self.variant(slip.0).shape[0].value);
        let count = rows.len();
        let Some(mut at) = rows.iter().position(|row| row.line as f64 == tried) else { return model };
        let first = first_moment(slip.1);
        let (mut best, mut step) = (model, self.rig.apart() / 2);
        while step > 0 {
            for next in [at.saturating_sub(step), at + step] {
                if !(first..count).contains(&next) {
                    continue;
                }
                self.move_slip(slip, next);
                if let Some(other) = self.solve(&best.named, &best.solved.state).filter(|other| other.bic < best.bic) {
                    (best, at) = (other, next);
                }
            }
            step = if step == 1 { 0 } else { step.div_ceil(2) };
        }
        self.move_slip(slip, at);
        best
    }

    /// Moves a slip to another moment, in all its forms.
    fn move_slip(&mut self, (slip, slipping): (Named, Slipping), moment: usize) {
        let (own, first) = (self.prepared.own.len(), self.variant(slip).columns[0]);
        let slipped = self.rig.slipped(slipping, moment);
        for (number, enters) in (first - STANDS..).zip(slipped) {
            self.numbers[number - own].enters = enters.clone();
            self.regression.numbers[number] = enters;
        }
        let forms = self.candidates[slip.candidate].variants.iter_mut();
        for form in forms.filter(|form| form.columns[0] == first) {
            form.shape = vec![line(self.prepared.data, moment)];
        }
    }

    /// What the number out of a grid may be.
    fn between(&self, one: Named) -> Option<Between> {
        self.betweens.iter().find(|(of, _)| *of == one).map(|(_, between)| between.clone())
    }

    /// Moves the number out of a grid to another value.
    fn reshape(&mut self, one: Named, to: f64) {
        let Some(between) = self.between(one) else { return };
        let (own, columns) = (self.prepared.own.len(), self.variant(one).columns.clone());
        for (column, enters) in columns.into_iter().zip((between.enters)(to)) {
            self.numbers[column - STANDS - own].enters = enters.clone();
            self.regression.numbers[column - STANDS] = enters;
        }
        self.candidates[one.candidate].variants[one.variant].shape[0].value = to;
    }

    /// The model with the numbers out of grids that leave least, and a law under its other
    /// name where that leaves less.
    pub fn reshaped(&mut self, mut model: Model) -> Model {
        let shaped: Vec<Named> = model.named.iter().copied().filter(|one| self.between(*one).is_some()).collect();
        for one in shaped {
            model = self.at_its_best(model, one);
            let Some(twin) = self.twin(one).filter(|twin| model.named.iter().all(|one| one.candidate != *twin)) else {
                continue;
            };
            let forms = 0..self.candidates[twin].variants.len();
            let with = |variant| {
                let mut named: Vec<Named> = model.named.iter().copied().filter(|other| *other != one).collect();
                named.push(Named { candidate: twin, variant });
                named.sort_unstable();
                self.solve(&named, &model.solved.state)
            };
            let Some(other) = forms.filter_map(with).min_by(|a, b| a.bic.total_cmp(&b.bic)) else { continue };
            let Some(one) = other.named.iter().find(|one| one.candidate == twin).copied() else { continue };
            let before = self.variant(one).shape[0].value;
            let other = self.at_its_best(other, one);
            if other.bic < model.bic - TIE {
                model = other;
            } else {
                self.reshape(one, before);
            }
        }
        model
    }

    /// The other law of the same gear.
    pub fn twin(&self, law: Named) -> Option<usize> {
        let own = &self.candidates[law.candidate];
        let is_twin = |(other, _): &&(Named, Between)| {
            other.candidate != law.candidate && self.candidates[other.candidate].place == own.place
        };
        self.betweens.iter().find(is_twin).map(|(other, _)| other.candidate)
    }

    /// The model with a number out of a grid where it leaves least, by halving ever smaller
    /// steps.
    fn at_its_best(&mut self, model: Model, one: Named) -> Model {
        let Some(Between { range: [least, most], .. }) = self.between(one) else { return model };
        let (mut best, mut at, mut factor) = (model, self.variant(one).shape[0].value, COARSE);
        while factor > FINE {
            let before = at;
            for next in [at / factor, at * factor].into_iter().filter(|next| (least..=most).contains(next)) {
                self.reshape(one, next);
                if let Some(other) = self.solve(&best.named, &best.solved.state).filter(|other| other.bic < best.bic) {
                    (best, at) = (other, next);
                }
            }
            if at == before {
                factor = factor.sqrt();
            }
        }
        self.reshape(one, at);
        best
    }

    /// What more of a number out of a grid does to what is read, in its own unit, of each
    /// effect of a model that has one.
    pub fn shape_columns(&self, model: &Model) -> Vec<(Named, DVector<f64>)> {
        let column = |&one: &Named| {
            let (between, at) = (self.between(one)?, self.variant(one).shape[0].value);
            let placed = |factor: f64| {
                let mut regression = self.regression.clone();
                for (column, enters) in self.variant(one).columns.iter().zip((between.enters)(factor * at)) {
                    regression.numbers[column - STANDS] = enters;
                }
                regression.placed(&model.solved.state)
            };
            let (more, less) = (placed(FINE), placed(FINE.recip()));
            let width = at * (FINE - FINE.recip());
            let slopes = more.iter().zip(&less).flat_map(|(more, less)| <[f64; 3]>::from((more - less) / width));
            Some((one, DVector::from_vec(slopes.collect())))
        };
        model.named.iter().filter_map(column).collect()
    }

    /// Whether a law that was found may as well have its other name: both have one
    /// formula, and its knee may be either's.
    pub fn may_be_its_twin(&self, law: Named, value: f64) -> bool {
        self.between(law).is_some_and(|knee| {
            value > 0.0 && (EITHER[0]..=EITHER[1]).contains(&(self.variant(law).shape[0].value / knee.whole))
        })
    }
}
