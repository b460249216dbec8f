//! Did something slip, or did what is read go there and back?
//!
//! A step says most of what a tracker does that drifts and comes back, or wanders, and little
//! enough is left to look like noise. So slips are held against two courses of what is read,
//! smooth in the order of rows, that have no name: a wave, three shifts with a period and a
//! phase; and a walk, waves of which none has numbers of its own, but all together a size, the
//! less the shorter they are. Schwarz's criterion decides, for a walk of its likelihood over
//! all that the waves may be. A step has much in short waves: of a true slip more is left by
//! either than by the slip.

use core::f64::consts::PI;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, SymmetricEigen, Vector3};

use super::bench::{Bench, Model};
use super::course::Course;
use crate::identify::normal::{Scaled, Sign, transposed_times};
use crate::identify::positions::model::Enters;
use crate::trace::model::{Named, all_but};
use crate::trace::slip::Slipping;
use crate::trace::step::Step;

/// What it looks like, as a noun for a sentence.
const WORDS: &str = "a drift of what is read that goes there and back";

/// The kind of what drifts and has a name.
const OF_READING: &str = "thermal_drift";

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

/// A course without the slips that what is read says better by going there and back, and what
/// it looks like; `None` where there are none of these.
pub fn instead_of_slips(bench: &mut Bench<'_>, course: &Course) -> Option<(Course, String)> {
    let name = |one: &Named| bench.candidates[one.candidate].kind.name;
    let is_slip = |one: &Named| Slipping::has(name(one));
    let (mut model, mut best) = (course.model.clone(), course.model.bic);
    if model.leaves_nothing() {
        return None;
    }
    loop {
        // Beside such a course a drift may be part of it.
        let first = model.named.len() == course.model.named.len();
        let may_go = |one: &Named| is_slip(one) || (!first && name(one) == OF_READING);
        let without = |k: usize| {
            let smaller = bench.solve(&all_but(&model.named, k), &model.solved.state)?;
            Some((beside_a_course(bench, &smaller)?, smaller))
        };
        let found = (0..model.named.len()).filter(|&k| may_go(&model.named[k])).filter_map(without);
        let Some((bic, smaller)) = found.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(bic, _)| *bic < best) else {
            break;
        };
        if first && slipped_again(bench, &model).is_some_and(|again| again < bic) {
            break;
        }
        (model, best) = (smaller, bic);
    }
    if model.named.len() == course.model.named.len() {
        return None;
    }
    let names: Vec<String> = model.named.iter().map(|one| bench.candidates[one.candidate].name()).collect();
    let stays = |one: &Named| model.named.contains(one);
    let gone = course.model.named.iter().filter(|one| !stays(one));
    let taken_back = gone.map(|one| bench.candidates[one.candidate].name());
    let taken_back = course.taken_back.iter().cloned().chain(taken_back).collect();
    let with_p = course.model.named.iter().zip(&course.p_values).filter(|(one, _)| stays(one));
    let p_values = with_p.map(|(_, p)| *p).collect();
    let mut step = Step::bare(names);
    step.outcome = std::format!("beside what has no name in the catalogue: {WORDS}");
    let steps = course.steps.iter().cloned().chain([step]).collect();
    bench.turn_to(&model);
    let (wild, left, unnamed) = (course.wild.clone(), course.left.clone(), course.unnamed);
    Some((Course { model, wild, p_values, steps, unnamed, left, taken_back }, WORDS.to_string()))
}

/// What is left of some columns beside those of a model, in normal equations.
struct Beside {
    gram: DMatrix<f64>,
    moment: DVector<f64>,
    /// What the model leaves (m^2), of so many readings.
    rss: f64,
    readings: f64,
    /// What its numbers cost by Schwarz's criterion.
    price: f64,
}

impl Beside {
    fn new(bench: &Bench<'_>, model: &Model, columns: &[DVector<f64>]) -> Option<Self> {
        let total = bench.with_columns(model, &DMatrix::from_columns(columns)).equations.total;
        let (fit, signs) = (&model.solved.fit, &model.solved.signs);
        let is_held = |k: &usize| signs[*k] == Sign::Nonnegative && fit.coefficients[*k] == 0.0;
        let own: Vec<usize> = (0..fit.columns.len()).filter(|k| !is_held(k)).collect();
        let more = |k: usize| fit.columns.len() + k;
        let inverse = total.inverse(&own)?;
        let crossed = DMatrix::from_fn(own.len(), columns.len(), |i, j| total.gram[(own[i], more(j))]);
        let taken = &inverse * &crossed;
        let gram = DMatrix::from_fn(columns.len(), columns.len(), |i, j| total.gram[(more(i), more(j))]);
        let moment = DVector::from_fn(columns.len(), |k, _| total.moment[more(k)]);
        let readings = total.rows as f64;
        Some(Self {
            gram: gram - transposed_times(&crossed, &taken),
            moment: moment - taken.tr_mul(&total.moment_of(&own)),
            rss: fit.rss,
            readings,
            price: model.bic - readings * (fit.rss / readings).max(f64::MIN_POSITIVE).ln(),
        })
    }

    /// Schwarz's criterion where so much is left, with so many numbers more.
    fn bic(&self, rss: f64, more: usize) -> f64 {
        let readings = self.readings;
        readings * (rss / readings).max(f64::MIN_POSITIVE).ln() + self.price + more as f64 * readings.ln()
    }

    /// The same with combinations of the columns, and so many numbers besides. `None` where the
    /// rows do not tell these from the model.
    fn with(&self, combined: &DMatrix<f64>, besides: usize) -> Option<f64> {
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

/// Schwarz's criterion of a model with a course of what is read besides, a wave or a walk.
fn beside_a_course(bench: &Bench<'_>, model: &Model) -> Option<f64> {
    let rows = bench.prepared.data.rows.len();
    // Along each axis of the frame that positions are read in.
    let shifts = |course: &dyn Fn(f64) -> f64| -> Vec<DVector<f64>> {
        let at = |i: usize| course((i / 3) as f64 / rows as f64 + 0.5 / rows as f64);
        (0..3).map(|k| DVector::from_fn(3 * rows, |i, _| if i % 3 == k { at(i) } else { 0.0 })).collect()
    };
    let wave = |periods: &f64| {
        let turns = 2.0 * PI * periods;
        let both = [shifts(&|at| (turns * at).sin()), shifts(&|at| (turns * at).cos())].concat();
        let beside = Beside::new(bench, model, &both)?;
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
        let beside = Beside::new(bench, model, (!columns.is_empty()).then_some(&columns)?)?;
        beside.at_random(&DVector::from_fn(columns.len(), |i, _| ((i / 3 + 1) as f64).powi(-2)))
    };
    PERIODS.iter().filter_map(wave).chain(walk()).min_by(f64::total_cmp)
}

/// Schwarz's criterion of a model with a second slip like one that it names: that has its own
/// words.
fn slipped_again(bench: &Bench<'_>, model: &Model) -> Option<f64> {
    let kinds = model.named.iter().map(|one| bench.candidates[one.candidate].kind.name);
    let moments = || (1..bench.prepared.data.rows.len()).step_by(bench.rig.apart());
    let turn = model.solved.state.registration.turn;
    let of_one = |(kind, moment): (&str, usize)| {
        let moved = bench.rig.slipped(kind, moment).into_iter().filter_map(|enters| match enters {
            Enters::Reading(moved) => Some(moved),
            Enters::Model(..) => None,
        });
        let column = |by: &Vec<Vector3<f64>>| {
            let stacked = by.iter().flat_map(|by| <[f64; 3]>::from(turn * by));
            DVector::from_vec(stacked.collect())
        };
        let columns: Vec<DVector<f64>> = moved.map(|moved| column(&moved.rows)).collect();
        let beside = Beside::new(bench, model, &columns)?;
        let first = |count: usize| beside.with(&DMatrix::identity(columns.len(), count), 1);
        [3, columns.len()].into_iter().filter_map(first).min_by(f64::total_cmp)
    };
    let all = kinds.filter(|kind| Slipping::has(kind)).flat_map(|kind| moments().map(move |moment| (kind, moment)));
    all.filter_map(of_one).min_by(f64::total_cmp)
}
