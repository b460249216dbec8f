//! Did something slip, or did what is read go there and back?
//!
//! A step says most of what a tracker or a base does that drifts and comes back, or wanders, and
//! little enough is left to look like noise. So slips are held against two courses of what is
//! read, smooth in the order of rows, that have no name: a wave, three shifts with a period and a
//! phase; and a walk, waves of which none has numbers of its own, but all together a size, the
//! less the shorter they are. Schwarz's criterion decides, for a walk of its likelihood over
//! all that the waves may be. A step has much in short waves: of a true slip more is left by
//! either than by the slip.
//!
//! Here is what both kinds of campaigns share: what is [beside](Beside) a model, and the
//! [courses](beside_a_course). [`displacements`] and
//! [positions](super::positions) ask with models of their own.

pub mod displacements;
#[cfg(test)]
mod tests;

use core::f64::consts::PI;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::identify::normal::{Fit, Normal, Projected, Scaled, Sign};
use crate::probability::schwarz;

/// What it looks like, as a noun for a sentence.
pub const WORDS: &str = "a drift of what is read that goes there and back";

/// How the words for a second slip begin; all that is said of one of displacements.
pub const AGAIN: &str = "another slip";

/// How often a wave comes in a campaign, and in how many steps half a turn of its phase is
/// looked for.
const PERIODS: [f64; 8] = [0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0];
const PHASES: u8 = 16;

/// The half waves of a walk, and the rows that there are for each at least.
const WAVES: usize = 12;
const ROWS_A_WAVE: usize = 4;

/// Sizes of a walk that are tried, doubling: of the longest wave the variance over that of
/// what noise makes of it.
const SIZES: i32 = 24;

/// What a model leaves of some more columns, in normal equations.
pub struct Beside {
    gram: DMatrix<f64>,
    moment: DVector<f64>,
    /// What the model leaves (m^2), of so many readings.
    rss: f64,
    readings: f64,
    /// What its numbers cost by Schwarz's criterion.
    price: f64,
}

impl Beside {
    /// Of normal equations whose first columns are those of a model, in the order of its fit; with
    /// their signs, and Schwarz's criterion of the model. `None` where these are collinear.
    pub fn of(total: &Normal, fit: &Fit, signs: &[Sign], bic: f64) -> Option<Self> {
        let model = fit.columns.len();
        let is_held = |k: &usize| signs[*k] == Sign::Nonnegative && fit.coefficients[*k] == 0.0;
        let own: Vec<usize> = (0..model).filter(|k| !is_held(k)).collect();
        let more: Vec<usize> = (model..total.moment.len()).collect();
        let Projected { gram, shares } = total.projected(&more, &Scaled::of(&total.gram_of(&own))?, &own);
        let readings = total.rows as f64;
        Some(Self {
            gram,
            moment: total.moment_of(&more) - shares.tr_mul(&total.moment_of(&own)),
            rss: fit.rss,
            readings,
            price: bic - schwarz(fit.rss, readings, 0.0),
        })
    }

    /// Schwarz's criterion where so much is left, with so many numbers more.
    fn bic(&self, rss: f64, more: usize) -> f64 {
        schwarz(rss, self.readings, more as f64) + self.price
    }

    /// The same with combinations of the columns, and so many numbers besides. `None` where the
    /// rows do not tell these from the model.
    pub fn with(&self, combined: &DMatrix<f64>, besides: usize) -> Option<f64> {
        let moment = combined.tr_mul(&self.moment);
        let factor = Scaled::of(&(combined.tr_mul(&self.gram) * combined))?;
        let gain = moment.dot(&factor.solve(&moment));
        Some(self.bic(self.rss - gain, combined.ncols() + besides))
    }

    /// The same of columns whose numbers are random, of variances in proportion to some, by the
    /// likelihood over all that they may be.
    fn at_random(&self, variances: &DVector<f64>) -> Option<f64> {
        let root = variances.map(f64::sqrt);
        let scaled = DMatrix::from_fn(root.len(), root.len(), |i, j| root[i] * self.gram[(i, j)] * root[j]);
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(scaled);
        let along = eigenvectors.tr_mul(&self.moment.component_mul(&root));
        let largest = eigenvalues.max();
        let of_size = |size: f64| {
            let (mut rss, mut cost) = (self.rss, 0.0);
            for (value, along) in eigenvalues.iter().zip(along.iter()) {
                let seen = 1.0 + size * value.max(0.0);
                rss -= size * along * along / seen;
                cost += seen.ln();
            }
            self.bic(rss, 1) + cost
        };
        let sizes = (0..=SIZES).map(|power| of_size(2_f64.powi(power) / largest));
        sizes.min_by(f64::total_cmp).filter(|bic| bic.is_finite())
    }
}

/// The columns of shifts along three axes that follow a course over the campaign, which is from
/// 0 to 1 in the order of its rows.
pub type Shifts<'a> = dyn Fn(&dyn Fn(f64) -> f64) -> [DVector<f64>; 3] + 'a;

/// Schwarz's criterion of a model with a course of what is read besides, a wave or a walk;
/// `beside` is what the model leaves of columns.
pub fn beside_a_course(
    rows: usize,
    shifts: &Shifts<'_>,
    beside: &dyn Fn(&[DVector<f64>]) -> Option<Beside>,
) -> Option<f64> {
    let wave = |periods: &f64| {
        let turns = 2.0 * PI * periods;
        let both = [shifts(&|at| (turns * at).sin()), shifts(&|at| (turns * at).cos())].concat();
        let beside = beside(&both)?;
        let phase = |step: u8| {
            let (sin, cos) = (PI * f64::from(step) / f64::from(PHASES)).sin_cos();
            let part = |i: usize, k: usize| if i % 3 == k { [cos, sin][i / 3] } else { 0.0 };
            // The period, and the phase.
            beside.with(&DMatrix::from_fn(6, 3, part), 2)
        };
        (0..PHASES).filter_map(phase).min_by(f64::total_cmp)
    };
    let walk = || {
        let waves = 1..=WAVES.min(rows / ROWS_A_WAVE);
        let columns: Vec<DVector<f64>> = waves.flat_map(|wave| shifts(&|at| (wave as f64 * PI * at).cos())).collect();
        let beside = beside((!columns.is_empty()).then_some(&columns)?)?;
        beside.at_random(&DVector::from_fn(columns.len(), |i, _| ((i / 3 + 1) as f64).powi(-2)))
    };
    PERIODS.iter().filter_map(wave).chain(walk()).min_by(f64::total_cmp)
}
