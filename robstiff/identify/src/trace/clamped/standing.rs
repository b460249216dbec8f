//! A model of clamped axes with the rows that it stands on.

use std::string::String;
use std::vec::Vec;

use super::axes::Axes;
use super::bench::Bench;
use super::slips::{instead_of_slip, shifts_all};
use crate::identify::clamped::wild::{self, Room};
use crate::probability::schwarz;
use crate::trace::model::{Fitted, Named};
use crate::trace::selection::WITHIN_REACH;

/// A model with its rows.
pub struct Standing {
    /// The rows that are used.
    pub bench: Bench,
    /// The model.
    pub model: Fitted,
    /// The lines of rows that are left out, with the largest of their p-values.
    pub wild: (Vec<usize>, f64),
    /// Whether rows that are left out stay so.
    pub kept: bool,
}

pub fn no_axis() -> String {
    String::from("these rows show no axis's compliance")
}

/// Times that rows are judged and what is named is polished on them, in turn.
const LOOKS: usize = 4;

impl Standing {
    /// A model on all its rows.
    pub fn new(bench: Bench, model: Fitted) -> Self {
        Self { bench, model, wild: (Vec::new(), 0.0), kept: false }
    }

    /// The rows judged anew. Wild rows must not vote for an effect; those that were wild
    /// while one was missing are looked at again once it is named. They stay out where
    /// physics does not allow the model with them, or what they do has another name.
    ///
    /// An effect that was polished on some rows is wrong on others, and makes those wild that
    /// it was polished without: it begins from its grid as well, and what leaves least with
    /// the fewest rows left out stands.
    ///
    /// # Errors
    /// Why not even the axes' compliances can be fitted.
    pub fn look_again(&mut self, strict: bool, room: &Room) -> Result<(), String> {
        if self.wild.0.is_empty() || self.kept {
            return self.judge(strict, room);
        }
        let as_it_is = refitted(self.bench.axes.whole(), &self.bench, &self.model);
        let anew = self.bench.anew(self.bench.axes.whole(), &self.model.named);
        let mut found = Vec::new();
        for (bench, model) in as_it_is.into_iter().chain(anew) {
            let mut whole = Self::new(bench, model);
            whole.judge(strict, room)?;
            found.push(whole);
        }
        match found.into_iter().min_by(|a, b| a.weight().total_cmp(&b.weight())) {
            Some(best) => *self = best,
            None => self.judge(strict, room)?,
        }
        Ok(())
    }

    /// Takes a slip back that the gear of its axis says better.
    pub fn without_slips(&mut self) {
        let best = |slip: usize| {
            let found = instead_of_slip(&self.bench, &self.model.named, slip).into_iter().next()?.found;
            // Not so of a gear that is named as well, beside which the shift is more.
            let in_its_place = found.1.named.len() == self.model.named.len();
            let first = in_its_place && shifts_all(&self.bench, self.model.named[slip]);
            let as_good = if first { WITHIN_REACH } else { 0.0 };
            (found.1.bic < self.model.bic + as_good).then_some(found)
        };
        let found = (0..self.model.named.len()).filter_map(best);
        if let Some(better) = found.min_by(|a, b| a.1.bic.total_cmp(&b.1.bic)) {
            (self.bench, self.model) = better;
        }
    }

    /// Leaves out what is wild, for as long as something is.
    fn judge(&mut self, strict: bool, room: &Room) -> Result<(), String> {
        for _ in 0..LOOKS {
            if !self.leave_out(strict, room)? {
                break;
            }
            let better = self.bench.anew(self.bench.axes.clone(), &self.model.named);
            if let Some(better) = better.filter(|(_, model)| model.bic < self.model.bic) {
                (self.bench, self.model) = better;
            }
        }
        Ok(())
    }

    /// The same with the shapes that there are; whether there was something.
    fn leave_out(&mut self, strict: bool, room: &Room) -> Result<bool, String> {
        let before = self.wild.0.len();
        while let Some((rows, p)) = self.wild_rows(strict, room) {
            self.wild.1 = p.max(self.wild.1);
            self.wild.0.extend(rows.iter().map(|&row| self.bench.axes.rows[row].line));
            self.bench = Bench::new(self.bench.axes.without(&rows), Some(&self.bench.offers));
            let stands = self.bench.fit(&self.model.named);
            // A name that stood on the row would come back with it, time and again.
            self.kept |= stands.is_none();
            self.model = stands.or_else(|| self.bench.fit(&[])).ok_or_else(no_axis)?;
        }
        Ok(self.wild.0.len() > before)
    }

    /// The rows that are wild beside the model, with the largest of their p-values.
    pub fn wild_rows(&self, strict: bool, room: &Room) -> Option<(Vec<usize>, f64)> {
        let columns = self.bench.raw.select_columns(&self.model.fit.columns);
        wild::wild_rows(&self.bench.axes.rows, &columns, strict, &self.room_in(room))
    }

    /// The names of the model's effects.
    pub fn names(&self) -> Vec<String> {
        self.model.named.iter().map(|one| self.bench.candidates[one.candidate].name()).collect()
    }

    /// How many more rows may be left out.
    pub fn room_in(&self, room: &Room) -> Room {
        room.beside(self.bench.axes.left_out().map(|row| row.axis))
    }

    fn weight(&self) -> f64 {
        weight(&self.bench, &self.model)
    }
}

/// Schwarz's criterion over all rows: of one that is left out, which it is and how far off.
pub fn weight(bench: &Bench, model: &Fitted) -> f64 {
    let wild = bench.axes.left_out().count();
    let numbers = bench.parameters(&model.named) + 2 * wild;
    schwarz(model.fit.rss, (bench.axes.rows.len() + wild) as f64, numbers as f64)
}

/// The same model on other rows.
pub fn refitted(axes: Axes, bench: &Bench, model: &Fitted) -> Option<(Bench, Fitted)> {
    let other = Bench::new(axes, Some(&bench.offers));
    let fitted = other.fit(&model.named)?;
    Some((other, fitted))
}

impl Bench {
    /// The same effects on some rows, their numbers out of grids where they fit best from the
    /// whole grid on; none where none are.
    pub fn anew(&self, axes: Axes, named: &[Named]) -> Option<(Self, Fitted)> {
        if named.is_empty() {
            return None;
        }
        let grid = Self::new(axes, None);
        let mut named = named.to_vec();
        for k in (0..named.len()).chain(0..named.len()) {
            let best = grid.forms(&named, k).into_iter().min_by(|a, b| a.bic.total_cmp(&b.bic));
            named = best.map_or(named, |best| best.named);
        }
        grid.at_best(&named)
    }

    /// The same on the same rows, one of the effects with as many numbers as fit best, which a
    /// grid may not tell.
    pub fn anew_in_any_form(&self, named: &[Named], candidate: usize) -> Option<(Self, Fitted)> {
        let (grid, first) = (Self::new(self.axes.clone(), None), self.anew(self.axes.clone(), named)?);
        let k = first.1.named.iter().position(|one| one.candidate == candidate)?;
        let mut best: Vec<Fitted> = Vec::new();
        for model in grid.forms(&first.1.named, k) {
            let numbers = grid.parameters(&model.named);
            match best.iter_mut().find(|other| grid.parameters(&other.named) == numbers) {
                Some(other) if model.bic < other.bic => *other = model,
                Some(_) => {}
                None => best.push(model),
            }
        }
        let polished = best.iter().filter_map(|model| grid.at_best(&model.named));
        polished.chain([first]).min_by(|a, b| a.1.bic.total_cmp(&b.1.bic))
    }

    /// A model with each form of one of its effects that physics allows.
    fn forms(&self, named: &[Named], k: usize) -> Vec<Fitted> {
        let with = |variant: usize| {
            let mut other = named.to_vec();
            other[k].variant = variant;
            self.fit(&other)
        };
        (0..self.candidates[named[k].candidate].variants.len()).filter_map(with).collect()
    }

    /// The same with some effects' numbers out of grids where they fit best, and the model.
    pub fn at_best(&self, named: &[Named]) -> Option<(Self, Fitted)> {
        // What acts besides the torque shifts where the laws of gears begin, and they it.
        let once = |bench: &Self| -> Option<(Self, Fitted)> {
            let polished = bench.polished(named);
            let fine = polished.fit(named)?;
            let bench = polished.with_numbers(&fine);
            let model = bench.fit(named).unwrap_or(fine);
            Some((bench, model))
        };
        let first = once(self)?;
        if first.0.axes.bias == 0.0 {
            return Some(first);
        }
        once(&first.0)
    }
}
