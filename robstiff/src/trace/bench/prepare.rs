//! The catalogue of a bench: what the data can show, which rows are wild, and where
//! slips may have begun.

use std::rc::Rc;
use std::string::String;
use std::vec;
use std::vec::Vec;

use super::Bench;
use crate::trace::catalogue::{Candidate, Catalogue, LIKELY, Number, Variant, catalogue};
use crate::trace::isolated::{self, Event};
use crate::trace::model::{Fitted, Named, Setting, all_but};
use crate::trace::slip::{Moment, Slipping, likeliest_slip};

/// A column this small against the largest of a joint is zero but for rounding.
const ZERO: f64 = 1e-7;

/// Leaving rows out changes what the others look like; it settles at once or
/// was no matter of single rows.
const ROUNDS: usize = 4;

impl Bench<'_> {
    /// Forms the catalogue, without what the data cannot show.
    pub(super) fn set_up(&mut self) -> Result<(), String> {
        self.forget();
        let Catalogue { candidates, numbers, invisible } = catalogue(&self.scene(), self.own.len(), self.wide);
        let signs = self.prepared.signs().into_iter().chain(numbers.iter().map(Number::sign));
        self.signs = signs.collect();
        self.numbers = numbers.into();
        self.candidates = candidates.into();
        self.invisible = invisible;

        let setting = self.at(&[])?;
        let base = setting.fit(&[])?;
        let noise = (base.fit.rss / setting.problem.freedom(&base.fit)).sqrt();
        let gram = &setting.problem.total.gram;
        let largest = setting.base.iter().map(|&j| gram[(j, j)].sqrt()).fold(0.0, f64::max);
        let visible = |&column: &usize| {
            let (number, size) = (&self.numbers[column - self.own.len()], gram[(column, column)].sqrt());
            match number.range[1].is_finite() {
                // Even the most of it moves all readings together by less than
                // the noise of one.
                true => size * number.range[1] > noise,
                false => size > ZERO * largest,
            }
        };
        let (mut kept, mut lost) = (Vec::new(), Vec::new());
        for candidate in self.candidates.iter() {
            let is_seen = |variant: &&Variant| variant.columns.iter().all(visible);
            let variants: Vec<Variant> = candidate.variants.iter().filter(is_seen).cloned().collect();
            match variants.is_empty() {
                true if candidate.is_nameless() => {}
                true => lost.push(candidate.name()),
                false => kept.push(Candidate { variants, ..candidate.clone() }),
            }
        }
        self.candidates = kept.into();
        self.invisible.extend(lost);
        self.settings.get_mut().clear();
        self.tests.get_mut().clear();
        Ok(())
    }

    /// Looks again, with a model, for rows that are wild and for the moment at
    /// which a slip may have begun; whether anything changed.
    ///
    /// # Errors
    /// Why the description's own model cannot be fitted without such rows.
    pub fn look_again(&mut self, named: &[Named]) -> Result<bool, String> {
        let mut changed = false;
        for _ in 0..ROUNDS {
            let setting = self.at(named)?;
            let fitted = setting.fit(named)?;
            let wild = self.wild(&setting, &fitted)?;
            let mut left_out = vec![false; self.left_out.len()];
            wild.iter().flat_map(|event| &event.rows).for_each(|&row| left_out[row] = true);
            self.events = wild.into();
            let likely = Slipping::ALL.map(|slipping| (slipping, self.likely_slips(named, slipping)));
            let moves = likely.iter().any(|(slipping, moments)| {
                moments.iter().any(|moment| !self.moments.of(*slipping)[..LIKELY].contains(moment))
            });
            if left_out == self.left_out && !moves {
                break;
            }
            drop(setting);
            changed = true;
            self.left_out = left_out;
            likely.iter().for_each(|(slipping, moments)| self.moments.replace_first(*slipping, moments));
            self.set_up_again(|kept, now| {
                let moved = |candidate: &Candidate| {
                    let same = now.iter().find(|other| other.name() == candidate.name());
                    same.filter(|_| Slipping::has(candidate.kind.name)).unwrap_or(candidate).clone()
                };
                kept.iter().map(moved).collect()
            })?;
        }
        Ok(changed)
    }

    /// Forms the columns anew. Which forms of which candidates are seen stays as it was, and so
    /// do numbers out of grids: the candidates are made by `of`, of those kept and the new ones.
    pub(super) fn set_up_again(
        &mut self,
        of: impl FnOnce(&[Candidate], &[Candidate]) -> Vec<Candidate>,
    ) -> Result<(), String> {
        let (kept, invisible) = (Rc::clone(&self.candidates), self.invisible.clone());
        self.set_up()?;
        self.invisible = invisible;
        self.candidates = of(&kept, &self.candidates).into();
        self.numbers = self.refined_numbers(0..self.candidates.len());
        self.forget();
        Ok(())
    }

    /// What is wrong in single visits, held against a model; of poses held out, which no model
    /// may find fault with, against the other readings there.
    fn wild(&self, setting: &Setting<'_>, fitted: &Fitted) -> Result<Vec<Event>, String> {
        let training = &self.prepared.training;
        let mut wild = isolated::alone::events(setting, fitted, training, self.strict);
        if wild.is_empty() {
            wild = isolated::events(setting, fitted, self.strict);
        }
        let judged = |pose: usize| self.by_own_pose || !training[pose];
        for fitted_to in [true, false] {
            let of_pose = |pose: usize| judged(pose) && training[pose] == fitted_to;
            if (0..training.len()).any(of_pose) {
                let rows: Vec<usize> = wild.iter().flat_map(|event| event.rows.iter().copied()).collect();
                let contradicted = self.contradicted(&fitted.named, of_pose)?.into_iter();
                let others = contradicted.filter(|one| !one.rows.iter().any(|row| rows.contains(row)));
                wild.extend(others.map(Event::from));
            }
        }
        Ok(wild)
    }

    /// Where a slip that all later rows keep may have begun: what a model says,
    /// and what it says without one of its effects, which may be in place of a
    /// slip or be one.
    fn likely_slips(&self, named: &[Named], slipping: Slipping) -> Vec<Moment> {
        let slips = |one: &Named| self.candidates[one.candidate].kind == slipping.kind();
        let mut models: Vec<Vec<Named>> = Vec::new();
        if !named.iter().any(slips) {
            models.push(named.to_vec());
        }
        for k in 0..named.len() {
            let rest = all_but(named, k);
            if !rest.iter().any(slips) {
                models.push(rest);
            }
        }
        let mut moments: Vec<Moment> = Vec::new();
        for named in models {
            let Ok(setting) = self.at(&named) else { continue };
            let Ok(fitted) = setting.fit(&named) else { continue };
            moments.extend(likeliest_slip(&setting, &fitted, slipping).filter(|moment| !moments.contains(moment)));
        }
        moments.truncate(LIKELY);
        moments
    }
}
