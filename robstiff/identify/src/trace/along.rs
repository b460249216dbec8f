//! How much of what a model leaves points where an effect that it names points?
//!
//! A name for something that is not in the catalogue is the effect most like it: it
//! moves the tool in much the same directions, by amounts that are right at some
//! readings and wrong at others. What it leaves then lies along the directions in
//! which it moves the tool itself, more than along those of most other effects. What
//! is missing beside a true effect knows nothing of that effect's directions.
//!
//! Of each reading the squared residual is taken along the directions in which an
//! effect can move it there, whichever numbers it has, and averaged over these and
//! over readings, in multiples of the average over all directions: about 1 where what
//! is left has nothing to do with the effect.

use std::vec;
use std::vec::Vec;

use nalgebra::{DVector, Vector6};

use super::catalogue::Variant;
use super::model::{Fitted, Setting};
use super::resemblance::rows_looked_at;

/// The place in the catalogue, in order of what lies along each effect, that is compared
/// with: what is left of anything lies along some directions more than along others, and
/// many effects have neighbours that move the tool almost as they do.
const AMONG: f64 = 0.9;

/// Standard deviations that noise alone does not reach (one-sided at 1 %).
const BEYOND_NOISE: f64 = 2.33;

/// A direction of which less than this part is new is one of those before it.
const NEW: f64 = 1e-6;

/// How much of what is left lies along an effect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Along {
    /// In multiples of what lies along all but a tenth of the catalogue.
    pub ratio: f64,
    /// Whether it is more than noise alone would be along it.
    pub is_significant: bool,
}

/// By effect of a model that has some, how much of what the model leaves lies along it.
pub fn along(setting: &Setting<'_>, model: &Fitted) -> Vec<Along> {
    let Some(left) = Left::of(setting, model) else { return vec![Along::default(); model.named.len()] };
    let of_variant = |variant: &Variant| left.along(setting, &variant.columns);
    let most_of = |variants: &[Variant]| variants.iter().map(|one| of_variant(one).mean).fold(0.0, f64::max);
    let mut catalogue: Vec<f64> = setting.candidates.iter().map(|candidate| most_of(&candidate.variants)).collect();
    catalogue.sort_by(f64::total_cmp);
    let compared = catalogue[(AMONG * (catalogue.len() - 1) as f64).round() as usize];
    let of_named = |&one| {
        let Squares { mean, directions } = of_variant(setting.variant(one));
        // The standard deviation of the mean of so many squares of normal numbers.
        let noise = (2.0 / directions.max(1) as f64).sqrt();
        Along { ratio: mean / compared, is_significant: mean > 1.0 + BEYOND_NOISE * noise }
    };
    model.named.iter().map(of_named).collect()
}

/// What a model leaves of the tool's readings, whitened.
struct Left {
    /// Where each row's readings begin.
    rows: Vec<usize>,
    /// Readings of a row.
    axes: usize,
    /// By row; zero where there are fewer readings.
    residuals: Vec<Vector6<f64>>,
    /// The mean square of a reading.
    variance: f64,
}

/// Squared residuals along some directions.
struct Squares {
    /// Their mean over that of all readings.
    mean: f64,
    /// How many directions there are, of all rows together.
    directions: usize,
}

impl Left {
    /// `None` where nothing is left.
    fn of(setting: &Setting<'_>, model: &Fitted) -> Option<Self> {
        let (problem, fit) = setting.alone(&model.fit);
        let stacked = problem.white_residuals(&fit.columns, &fit.coefficients);
        let axes = problem.axes;
        let rows: Vec<usize> = rows_looked_at(&problem).into_iter().map(|row| row * axes).collect();
        let residuals: Vec<Vector6<f64>> = rows.iter().map(|&row| reading(&stacked, row, axes)).collect();
        let variance = residuals.iter().map(Vector6::norm_squared).sum::<f64>() / (rows.len() * axes) as f64;
        (variance > 0.0).then_some(Self { rows, axes, residuals, variance })
    }

    /// Along the directions of some columns.
    fn along(&self, setting: &Setting<'_>, columns: &[usize]) -> Squares {
        let columns: Vec<DVector<f64>> = columns.iter().map(|&column| setting.white(column)).collect();
        let (mut sum, mut directions) = (0.0, 0);
        for (&row, residual) in self.rows.iter().zip(&self.residuals) {
            // Gram and Schmidt: two numbers of an effect can move one reading alike.
            let mut basis: Vec<Vector6<f64>> = Vec::with_capacity(columns.len());
            for column in &columns {
                let own = reading(column, row, self.axes);
                let new = basis.iter().fold(own, |new, direction| new - direction * direction.dot(&new));
                if new.norm() > NEW * own.norm() {
                    basis.push(new.normalize());
                }
            }
            sum += basis.iter().map(|direction| direction.dot(residual).powi(2)).sum::<f64>();
            directions += basis.len();
        }
        Squares { mean: sum / (directions.max(1) as f64 * self.variance), directions }
    }
}

/// The readings of a row that begin at a place, zero where it has fewer.
fn reading(stacked: &DVector<f64>, row: usize, axes: usize) -> Vector6<f64> {
    Vector6::from_fn(|axis, _| if axis < axes { stacked[row + axis] } else { 0.0 })
}
