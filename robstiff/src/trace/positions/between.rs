//! What the catalogue has in steps, between them: the moment of a slip and the knee of a
//! gear's law, where they leave least.

use core::f64::consts::SQRT_2;
use std::string::ToString;
use std::vec;
use std::vec::Vec;

use nalgebra::DVector;

use super::bench::{Bench, Model, TIE};
use super::offers::Knee;
use super::rig::{SLIP, SLIPPED_AT, line};
use crate::identify::positions::regression::STANDS;
use crate::trace::catalogue::{EITHER, Variant};
use crate::trace::found::Found;
use crate::trace::model::Named;

/// The number by which the law of a gear says where it bends.
const KNEE: &str = "knee";

/// The first and the last factor between knees that are tried; the first is that
/// between those of the grid, or less.
const COARSE: f64 = SQRT_2;
const FINE: f64 = 1.002;

impl Bench<'_> {
    /// The effect that was found, in its form; a slip is moved to its moment, a law to its
    /// knee.
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
        if found.kind() == SLIP {
            let line = of(SLIPPED_AT)?;
            let moment = self.prepared.data.rows.iter().position(|row| row.line as f64 == line)?;
            self.move_slip(named, moment);
        }
        if self.knee(named).is_some() {
            self.move_knee(named, of(KNEE)?);
        }
        Some(named)
    }

    /// The model with a slip that it names at the moment between those tried which
    /// leaves least, by halving ever smaller steps.
    pub fn at_its_moment(&mut self, model: Model) -> Model {
        let is_slip = |one: &&Named| self.candidates[one.candidate].kind.name == SLIP;
        let Some(&slip) = model.named.iter().find(is_slip) else { return model };
        let (rows, tried) = (&self.prepared.data.rows, self.variant(slip).shape[0].value);
        let count = rows.len();
        let Some(mut at) = rows.iter().position(|row| row.line as f64 == tried) else { return model };
        let (mut best, mut step) = (model, self.rig.apart() / 2);
        while step > 0 {
            for next in [at.saturating_sub(step), at + step] {
                if !(1..count).contains(&next) {
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
    fn move_slip(&mut self, slip: Named, moment: usize) {
        let (own, first) = (self.prepared.own.len(), self.variant(slip).columns[0]);
        for (number, enters) in (first - STANDS..).zip(self.rig.at_row(moment)) {
            self.numbers[number - own].enters = enters.clone();
            self.regression.numbers[number] = enters;
        }
        let forms = self.candidates[slip.candidate].variants.iter_mut();
        for form in forms.filter(|form| form.columns[0] == first) {
            form.shape = vec![line(self.prepared.data, moment)];
        }
    }

    /// The knees that a law may have.
    fn knee(&self, one: Named) -> Option<Knee> {
        self.knees.iter().find(|(of, _)| *of == one).map(|(_, knee)| knee.clone())
    }

    /// Moves the law of a gear to another knee.
    fn move_knee(&mut self, law: Named, to: f64) {
        let Some(knee) = self.knee(law) else { return };
        let number = self.variant(law).columns[0] - STANDS;
        let enters = (knee.enters)(to);
        self.numbers[number - self.prepared.own.len()].enters = enters.clone();
        self.regression.numbers[number] = enters;
        self.candidates[law.candidate].variants[law.variant].shape[0].value = to;
    }

    /// The model with the laws that it names at the knees which leave least, and under
    /// the other name of a law where that leaves less.
    pub fn at_its_knees(&mut self, mut model: Model) -> Model {
        let laws: Vec<Named> = model.named.iter().copied().filter(|one| self.knee(*one).is_some()).collect();
        for law in laws {
            model = self.at_its_knee(model, law);
            let Some(twin) = self.twin(law).filter(|twin| model.named.iter().all(|one| one.candidate != *twin)) else {
                continue;
            };
            let forms = 0..self.candidates[twin].variants.len();
            let with = |variant| {
                let mut named: Vec<Named> = model.named.iter().copied().filter(|one| *one != law).collect();
                named.push(Named { candidate: twin, variant });
                named.sort_unstable();
                self.solve(&named, &model.solved.state)
            };
            let Some(other) = forms.filter_map(with).min_by(|a, b| a.bic.total_cmp(&b.bic)) else { continue };
            let one = other.named.iter().find(|one| one.candidate == twin).copied();
            let other = one.map(|one| self.at_its_knee(other, one));
            model = other.filter(|other| other.bic < model.bic - TIE).unwrap_or(model);
        }
        model
    }

    /// The other law of the same gear.
    pub fn twin(&self, law: Named) -> Option<usize> {
        let own = &self.candidates[law.candidate];
        let is_twin = |(other, _): &&(Named, Knee)| {
            other.candidate != law.candidate && self.candidates[other.candidate].place == own.place
        };
        self.knees.iter().find(is_twin).map(|(other, _)| other.candidate)
    }

    /// The model with a law at the knee that leaves least, by halving ever smaller
    /// steps.
    fn at_its_knee(&mut self, model: Model, law: Named) -> Model {
        let Some(Knee { range: [least, most], .. }) = self.knee(law) else { return model };
        let (mut best, mut at, mut factor) = (model, self.variant(law).shape[0].value, COARSE);
        while factor > FINE {
            let before = at;
            for next in [at / factor, at * factor].into_iter().filter(|next| (least..=most).contains(next)) {
                self.move_knee(law, next);
                if let Some(other) = self.solve(&best.named, &best.solved.state).filter(|other| other.bic < best.bic) {
                    (best, at) = (other, next);
                }
            }
            if at == before {
                factor = factor.sqrt();
            }
        }
        self.move_knee(law, at);
        best
    }

    /// What more of a knee does to what is read, in its own unit, of each law that a
    /// model names.
    pub fn knee_columns(&self, model: &Model) -> Vec<(Named, DVector<f64>)> {
        let column = |&one: &Named| {
            let (knee, at) = (self.knee(one)?, self.variant(one).shape[0].value);
            let placed = |factor: f64| {
                let mut regression = self.regression.clone();
                regression.numbers[self.variant(one).columns[0] - STANDS] = (knee.enters)(factor * at);
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
        self.knee(law).is_some_and(|knee| {
            value > 0.0 && (EITHER[0]..=EITHER[1]).contains(&(self.variant(law).shape[0].value / knee.largest))
        })
    }
}
