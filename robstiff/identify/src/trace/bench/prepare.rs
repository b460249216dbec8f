//! The catalogue of a bench: what the data can show, which rows are wild, and where
//! slips may have begun.

use std::collections::BTreeSet;
use std::rc::Rc;
use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};

use super::Bench;
use crate::identify::covariance::Outlier;
use crate::identify::normal::Normal;
use crate::trace::bootstrap::tells_apart;
use crate::trace::catalogue::{Candidate, Catalogue, LIKELY, Number, Variant, catalogue};
use crate::trace::isolated::{self, Event};
use crate::trace::model::{Fitted, Named, Setting, all_but};
use crate::trace::point::Point;
use crate::trace::slip::{Moment, Slipping, likeliest_slip};

/// A column this small against the largest of a joint is zero but for rounding.
const ZERO: f64 = 1e-7;

/// Leaving rows out changes what the others look like; it settles at once or
/// was no matter of single rows.
const ROUNDS: usize = 4;

/// Of forms of which some are only there where those with more numbers are not shown, those with
/// the most numbers that are; all others are there anyway.
fn most_numbers(variants: Vec<Variant>, is_shown: impl Fn(&Variant) -> bool) -> Vec<Variant> {
    let (fewer, whole): (Vec<Variant>, Vec<Variant>) =
        variants.into_iter().partition(|variant| variant.in_place_of_more);
    let whole: Vec<Variant> = whole.into_iter().filter(&is_shown).collect();
    if !whole.is_empty() {
        return whole;
    }
    let mut shown: Vec<Variant> = fewer.into_iter().filter(is_shown).collect();
    let most = shown.iter().map(|variant| variant.columns.len()).max();
    shown.retain(|variant| Some(variant.columns.len()) == most);
    shown
}

impl<'c> Bench<'c> {
    /// Forms the catalogue, without what the data cannot show.
    pub(super) fn set_up(&mut self) -> Result<(), String> {
        self.form();
        let (kept, lost) = self.seen(self.candidates.iter())?;
        self.candidates = kept.into();
        self.invisible.extend(lost);
        Ok(())
    }

    /// Forms the whole catalogue.
    fn form(&mut self) {
        self.forget();
        let Catalogue { candidates, numbers, invisible } = catalogue(&self.scene(), self.own.len(), self.wide);
        let signs = self.prepared.signs().into_iter().chain(numbers.iter().map(Number::sign));
        self.signs = signs.collect();
        self.numbers = numbers.into();
        self.candidates = candidates.into();
        self.invisible = invisible;
    }

    /// Candidates with the forms that the data can show, held against the description's own
    /// model, and the full names of those that have none.
    fn seen<'a>(
        &self,
        candidates: impl Iterator<Item = &'a Candidate> + Clone,
    ) -> Result<(Vec<Candidate>, Vec<String>), String> {
        let base = self.state(&[])?;
        let point = self.point_at(&[], &base);
        let size = self.size_at(&point);
        let freedom = self.fitted_to().count().saturating_sub(base.fit.columns.len()).max(1);
        let noise = (base.fit.rss / freedom as f64).sqrt();
        let largest = base.base.iter().copied().map(&size).fold(0.0, f64::max);
        let is_visible = |&column: &usize| {
            let number = &self.numbers[column - self.own.len()];
            match number.range[1].is_finite() {
                // Even the most of it moves all readings together by less than
                // the noise of one.
                true => size(column) * number.range[1] > noise,
                false => size(column) > ZERO * largest,
            }
        };
        let variants = candidates.clone().flat_map(|candidate| &candidate.variants);
        let columns: BTreeSet<usize> = variants.flat_map(|variant| &variant.columns).copied().collect();
        let visible: BTreeSet<usize> = columns.into_iter().filter(is_visible).collect();
        let is_seen = |variant: &&Variant| variant.columns.iter().all(|column| visible.contains(column));
        let (mut kept, mut lost) = (Vec::new(), Vec::new());
        for candidate in candidates {
            let mut variants: Vec<Variant> = candidate.variants.iter().filter(is_seen).cloned().collect();
            if candidate.variants.iter().any(|variant| variant.in_place_of_more) {
                variants = most_numbers(variants, |variant| self.tells_apart(&point, &base.base, &variant.columns));
            }
            match variants.is_empty() {
                true if candidate.is_nameless() => {}
                true => lost.push(candidate.name()),
                false => kept.push(Candidate { variants, ..candidate.clone() }),
            }
        }
        Ok((kept, lost))
    }

    /// Whether the data tell some columns apart from each other and from those of the
    /// description's numbers.
    fn tells_apart(&self, point: &Point<'c>, own: &[usize], columns: &[usize]) -> bool {
        let whitener = self.noise.covariance.whitener(&self.left_out);
        let places: Vec<usize> = self.fitted_to().collect();
        let white = |&column: &usize| whitener.whitened(self.linear(point, column)).select_rows(&places);
        let all: Vec<DVector<f64>> = own.iter().chain(columns).map(white).collect();
        let total = Normal::new(&DMatrix::from_columns(&all), &DVector::zeros(places.len()));
        let own: Vec<usize> = (0..own.len()).collect();
        tells_apart(&total, &own, own.len()..all.len())
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
            self.set_up_again(
                |candidate| candidate.slipping().is_some(),
                |kept, slips| {
                    let moved = |candidate: &Candidate| {
                        let same = slips.iter().find(|slip| slip.name() == candidate.name());
                        same.unwrap_or(candidate).clone()
                    };
                    kept.iter().map(moved).collect()
                },
            )?;
        }
        Ok(changed)
    }

    /// Forms the columns anew. Which forms of which candidates are seen stays as it was, and so
    /// do numbers out of grids: the candidates are made by `of`, of those kept and, of the new
    /// ones, those that are wanted.
    pub(super) fn set_up_again(
        &mut self,
        is_wanted: impl Fn(&Candidate) -> bool,
        of: impl FnOnce(&[Candidate], &[Candidate]) -> Vec<Candidate>,
    ) -> Result<(), String> {
        let (kept, invisible) = (Rc::clone(&self.candidates), self.invisible.clone());
        self.form();
        self.invisible = invisible;
        let (wanted, _) = self.seen(self.candidates.iter().filter(|candidate| is_wanted(candidate)))?;
        self.candidates = of(&kept, &wanted).into();
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
                let samples = &*self.prepared.samples;
                let rows: Vec<usize> = wild.iter().flat_map(|event| event.rows.iter().copied()).collect();
                // What is off from the rows after a slip are those before it.
                let slipped = wild.iter().filter(|event| event.slip.is_some());
                let slipped: Vec<usize> = slipped.map(|event| samples.rows[event.rows[0]].visit).collect();
                let contradicted = self.contradicted(&fitted.named, of_pose)?.into_iter();
                let is_known =
                    |one: &Outlier| slipped.contains(&one.visit) || one.rows.iter().any(|row| rows.contains(row));
                let on = (samples, self.prepared.data.measured_frame);
                wild.extend(contradicted.filter(|one| !is_known(one)).map(|one| Event::contradicted(one, on)));
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
