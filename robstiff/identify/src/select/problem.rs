//! The readings and columns at a linearisation point, and the evidence of sets of forms.

use core::cell::Cell;

use statrs::function::gamma::ln_gamma;

use super::Layout;
use super::always::BLOCK;
use crate::model::{Sign, Size};
use crate::observe::Readings;
use crate::regression::evidence::{Start, fit, reduced};
use crate::regression::{Fit, Gram, NoisePrior, Prior, Scales};

/// Forms that are there together, by their numbers in the layout, in ascending order.
pub type Set = Vec<usize>;

/// A linearised problem.
pub struct Problem<'l> {
    /// Its parameters and forms.
    pub layout: &'l Layout,
    /// The columns that are always in.
    pub always: Vec<usize>,
    /// What each number is likely to be, a column each.
    pub priors: Vec<Prior>,
    /// The forms that move the readings at all.
    pub offered: Vec<usize>,
    /// How many candidates these are of.
    pub candidates: usize,
    /// Under each discrepancy.
    pub grams: Vec<Gram>,
    /// What is known of the noise before.
    pub noise: NoisePrior,
    /// Where fits begin.
    pub start: (f64, Scales),
    /// How many effects are likely.
    pub likely: f64,
    /// The same under each discrepancy with what is always in taken out, and its part of the
    /// evidence.
    rest: Vec<(Gram, f64)>,
    /// The discrepancy that was the likeliest when last asked: that of the next set is near.
    likeliest: Cell<usize>,
}

/// How good a set is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// The log-evidence with the prior of the set.
    pub score: f64,
    /// The likeliest discrepancy, by its index.
    pub kappa: usize,
}

/// What a unit moves the readings by at least (m, rad), for its size to follow from that.
const LEAST_MOVED: f64 = 1e-3;

/// A discrepancy that is so much less likely than another has no part, and no one beyond it.
const NO_MATTER: f64 = 12.0;

/// Rounds for the noise and the scales.
const ROUNDS: usize = 8;

/// A form that moves the readings by less than this part of the noise is not offered.
const UNSEEN: f64 = 2e-3;

impl<'l> Problem<'l> {
    /// A problem whose Gram matrices have a column for each parameter of the layout and the readings
    /// behind; `moves` is the root mean square of each column.
    pub fn new(
        layout: &'l Layout,
        grams: Vec<Gram>,
        moves: &[f64],
        (noise, start): (NoisePrior, (f64, Scales)),
        (likely, sizes): (f64, f64),
    ) -> Self {
        let of_noise = start.0.sqrt();
        let priors: Vec<Prior> =
            (0..layout.parameters.len()).map(|k| prior(layout, k, (moves[k], of_noise), sizes)).collect();
        let least = UNSEEN * start.0.sqrt();
        let is_seen =
            |form: &usize| layout.forms[*form].columns.iter().any(|&column| moves[column] * priors[column].sd > least);
        let offered: Vec<usize> = (0..layout.forms.len()).filter(is_seen).collect();
        let mut candidates: Vec<usize> = offered.iter().map(|&form| layout.forms[form].candidate).collect();
        candidates.dedup();
        let always = layout.always().filter(|&column| moves[column] > 0.0).collect();
        let candidates = candidates.len();
        let mut problem = Self {
            layout,
            always,
            priors,
            offered,
            candidates,
            grams,
            noise,
            start,
            likely,
            rest: Vec::new(),
            likeliest: Cell::new(0),
        };
        problem.reduce();
        problem
    }

    /// Takes out what is always in, where fits begin now.
    fn reduce(&mut self) {
        let at = Start { variance: self.start.0, scales: &self.start.1 };
        let rest = |gram| {
            let behind = self.layout.always().end;
            let rest = reduced(gram, &self.always, behind, &self.priors, at);
            rest.unwrap_or_else(|| (Gram::clone(gram), f64::NEG_INFINITY))
        };
        self.rest = self.grams.iter().map(rest).collect();
    }

    /// Learns the noise and the scales with a set, in at most so many rounds; how good it is then.
    pub fn learn(&mut self, set: &[usize], rounds: usize) -> Option<f64> {
        let of = self.fit_from(set, 0, &self.start.1, rounds)?;
        self.begin_at(&of);
        Some(of.evidence + self.log_prior(set))
    }

    /// Begins fits at the noise and the scales of one.
    pub fn begin_at(&mut self, of: &Fit) {
        self.start = (of.variance, of.scales.clone());
        self.reduce();
    }

    /// The scales with that of the unnamed block far smaller, where there is one.
    pub fn small_block(&self) -> Option<Scales> {
        smaller(&self.start.1)
    }

    /// How good a set is when noise and scales are learned from some on, and the fit.
    pub fn learned(&self, set: &[usize], from: &Scales, rounds: usize) -> Option<(f64, Fit)> {
        let fit = self.fit_from(set, 0, from, rounds)?;
        Some((fit.evidence + self.log_prior(set), fit))
    }

    /// The most promising additions at other scales, the best first.
    pub fn small_additions(&mut self, set: &[usize], scales: &Scales) -> Option<Vec<usize>> {
        let fit = self.fit_from(set, 0, scales, 1)?;
        Some(self.additions_to(&fit, &self.grams[0], set).into_iter().map(|(_, form)| form).collect())
    }

    /// Whether scales are learned.
    pub fn learns(&self) -> bool {
        !self.start.1.now.is_empty()
    }

    /// The columns of a set, those behind what is always in.
    pub fn columns(&self, set: &[usize]) -> Vec<usize> {
        set.iter().flat_map(|&form| self.layout.forms[form].columns.iter().copied()).collect()
    }

    /// The logarithm of a set's prior: geometric in its size, alike for all sets of a size, and for
    /// all forms of a candidate (Scott and Berger, Annals of Statistics 38, 2010, on why sets of a size
    /// share one prior).
    pub fn log_prior(&self, set: &[usize]) -> f64 {
        let (size, all) = (set.len() as f64, self.candidates as f64);
        let more = self.likely / (1.0 + self.likely);
        let sets = ln_gamma(all + 1.0) - ln_gamma(size + 1.0) - ln_gamma((all - size).max(0.0) + 1.0);
        let forms: f64 = set.iter().map(|&form| self.layout.forms[form].log_share).sum();
        (1.0 - more).ln() + size * more.ln() - sets + forms
    }

    /// The logarithm of the prior of a discrepancy.
    fn log_kappa(&self, kappa: usize) -> f64 {
        match (self.grams.len(), kappa) {
            (1, _) => 0.0,
            (_, 0) => 0.5_f64.ln(),
            (count, _) => (0.5 / (count - 1) as f64).ln(),
        }
    }

    /// A fit of a set under a discrepancy, with what is always in.
    pub fn fit(&self, set: &[usize], kappa: usize) -> Option<Fit> {
        self.fit_from(set, kappa, &self.start.1, ROUNDS)
    }

    fn fit_from(&self, set: &[usize], kappa: usize, scales: &Scales, rounds: usize) -> Option<Fit> {
        let columns: Vec<usize> = self.always.iter().copied().chain(self.columns(set)).collect();
        let start = Start { variance: self.start.0, scales };
        fit(&self.grams[kappa], &columns, &self.priors, self.noise, start, rounds)
    }

    /// How good a set is, over all discrepancies, with the scales as they are.
    pub fn judge(&self, set: &[usize]) -> Option<Judged> {
        let (score, kappa) =
            self.weigh(self.likeliest.get(), |kappa| Some(self.fit_rest(set, kappa)?.evidence + self.rest[kappa].1))?;
        self.likeliest.set(kappa);
        Some(Judged { score: score + self.log_prior(set), kappa })
    }

    /// The log-evidence of the discrepancies together, and the likeliest. From one on in both
    /// directions, as far as they matter.
    fn weigh(&self, from: usize, of: impl Fn(usize) -> Option<f64>) -> Option<(f64, usize)> {
        let mut known: Vec<(f64, usize)> = vec![(of(from)? + self.log_kappa(from), from)];
        let down = (0..from).rev();
        let up = from + 1..self.grams.len();
        for way in [down.collect::<Vec<usize>>(), up.collect()] {
            for kappa in way {
                let one = of(kappa)? + self.log_kappa(kappa);
                known.push((one, kappa));
                let best = known.iter().map(|(of, _)| *of).fold(f64::NEG_INFINITY, f64::max);
                if one < best - NO_MATTER {
                    break;
                }
            }
        }
        let (best, kappa) = known.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let sum: f64 = known.iter().map(|(one, _)| (one - best).exp()).sum();
        Some((best + sum.ln(), kappa))
    }

    /// The probability of each discrepancy with a set.
    pub fn discrepancies(&self, set: &[usize]) -> Vec<f64> {
        let each: Vec<f64> = (0..self.grams.len())
            .map(|kappa| self.fit(set, kappa).map_or(f64::NEG_INFINITY, |fit| fit.evidence + self.log_kappa(kappa)))
            .collect();
        let most = each.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = each.iter().map(|one| (one - most).exp()).sum();
        each.iter().map(|one| (one - most).exp() / sum).collect()
    }

    fn fit_rest(&self, set: &[usize], kappa: usize) -> Option<Fit> {
        let none = Scales::default();
        let start = Start { variance: self.start.0, scales: &none };
        let columns = self.columns(set);
        fit(&self.rest[kappa].0, &columns, &self.priors, self.noise, start, if self.learns() { 3 } else { ROUNDS })
    }

    /// About how good a set is with each of the forms that are offered and not of its candidates, under
    /// a discrepancy and with the scales as they are: only differences count. The best first.
    pub fn additions(&self, set: &[usize], kappa: usize) -> Vec<(f64, usize)> {
        let Some(fit) = self.fit_rest(set, kappa) else { return Vec::new() };
        self.additions_to(&fit, &self.rest[kappa].0, set)
    }

    fn additions_to(&self, fit: &Fit, gram: &Gram, set: &[usize]) -> Vec<(f64, usize)> {
        let taken = |form: usize| {
            let candidate = self.layout.forms[form].candidate;
            set.iter().any(|&own| self.layout.forms[own].candidate == candidate)
        };
        let forms: Vec<usize> = self.offered.iter().copied().filter(|&form| !taken(form)).collect();
        let lists: Vec<&[usize]> = forms.iter().map(|&form| self.layout.forms[form].columns.as_slice()).collect();
        let gains = fit.gains(gram, &self.priors, &lists);
        let mut found: Vec<(f64, usize)> = gains
            .into_iter()
            .zip(forms)
            .map(|(gain, form)| (gain + self.layout.forms[form].log_share, form))
            .filter(|(gain, _)| gain.is_finite())
            .collect();
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found
    }

    /// The other forms of a form's candidate that are offered.
    pub fn other_forms(&self, form: usize) -> impl Iterator<Item = usize> + '_ {
        let candidate = self.layout.forms[form].candidate;
        self.offered
            .iter()
            .copied()
            .filter(move |&other| other != form && self.layout.forms[other].candidate == candidate)
    }
}

/// The same scales with that of the unnamed block far smaller, where there is one.
fn smaller(scales: &Scales) -> Option<Scales> {
    let mut small = scales.clone();
    let now = small.now.get_mut(BLOCK)?;
    *now = (*now / 8.0).max(0.1 * scales.typical[BLOCK]);
    Some(small)
}

/// What a number is likely to be, given by how much a unit of it moves the readings and by the noise of
/// one; what is likely of candidates times `sizes`.
fn prior(layout: &Layout, column: usize, (moves, noise): (f64, f64), sizes: f64) -> Prior {
    let parameter = &layout.parameters[column];
    let is_always = layout.always().contains(&column);
    let (sd, group) = match parameter.size {
        Size::Of(sd) | Size::Flat(sd) => (sd, None),
        Size::Moves(by) => (by / moves.max(LEAST_MOVED), None),
        Size::Noise => (noise, None),
        Size::Learned(group, _) => (1.0, Some(group)),
    };
    let sd = if is_always { sd } else { sd * sizes };
    // A compliance that is always in is kept from being negative where it is estimated.
    let nonnegative = parameter.sign == Sign::Nonnegative && !is_always;
    Prior { mean: parameter.mean, sd, group, nonnegative }
}

/// Gram matrices of all rows together, and how much each column moves what is reported of a row.
pub fn moves(readings: &Readings, columns: &nalgebra::DMatrix<f64>, training: &[bool]) -> Vec<f64> {
    let rows: Vec<usize> = (0..readings.rows()).filter(|&row| training[readings.block[row]]).collect();
    let of = |column: usize| {
        let sum: f64 = rows
            .iter()
            .map(|row| columns.view((row * readings.width, column), (readings.width, 1)).norm_squared())
            .sum();
        (sum / (rows.len().max(1) * readings.width) as f64).sqrt()
    };
    (0..columns.ncols()).map(of).collect()
}
