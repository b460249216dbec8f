//! The moment of a slip that whole visits keep, and where it may have begun.

use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector, Matrix3, Matrix3x6, Matrix6, Vector3};

use super::catalogue::{BASE_SLIP, Kind, REFLECTOR_SLIP};
use super::model::{Fitted, Setting};
use crate::identify::covariance::alone;
use crate::identify::normal::Scaled;
use crate::identify::problem::Block;
use crate::identify::samples::{Sample, turn_of};
use crate::identify::whitening::{mean_share, whiten};

/// With less than this share left, the rest of the model says the same.
const OF_ITS_OWN: f64 = 0.1;

/// A step that explains less, over the residual variance, is nowhere near
/// significant.
const WORTH_A_LOOK: f64 = 15.0;

/// What a slip that turns as well must explain beyond one that does not, over the
/// residual variance: as much as three more numbers do of noise (chi-square with
/// three degrees of freedom at 0.1 %).
const TURNS: f64 = 16.3;

/// The number by which a slip says when it was: the first line that has it.
pub const SLIPPED_AT: &str = "line";

/// What slips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slipping {
    /// The robot, or the tracker: by a shift in the base frame, and maybe a turn.
    Base,
    /// The reflector on the tool: by a shift in the tool frame.
    Reflector,
}

impl Slipping {
    /// All there are.
    pub const ALL: [Self; 2] = [Self::Base, Self::Reflector];

    /// The kind of such slips.
    pub fn kind(self) -> &'static Kind {
        match self {
            Self::Base => &BASE_SLIP,
            Self::Reflector => &REFLECTOR_SLIP,
        }
    }

    /// What slips by effects of a kind, if anything does.
    pub fn of(kind: &Kind) -> Option<Self> {
        Self::ALL.into_iter().find(|slipping| slipping.kind() == kind)
    }

    /// How many of the numbers of [`moves`](Self::moves) a slip may have, the first ones.
    fn numbers(self) -> &'static [usize] {
        match self {
            Self::Base => &[3, 6],
            Self::Reflector => &[3],
        }
    }

    /// What a unit of shift (m), and of turn about the origin of the base frame (rad),
    /// moves at a row, in the base frame.
    pub fn moves(self, sample: &Sample) -> Matrix3x6<f64> {
        let (shift, turn) = match self {
            Self::Base => {
                let at = sample.tcp.fixed_view::<3, 1>(0, 3) + sample.marker;
                (Matrix3::identity(), -at.cross_matrix())
            }
            Self::Reflector => (turn_of(&sample.tcp), Matrix3::zeros()),
        };
        let mut moves = Matrix3x6::zeros();
        moves.fixed_view_mut::<3, 3>(0, 0).copy_from(&shift);
        moves.fixed_view_mut::<3, 3>(0, 3).copy_from(&turn);
        moves
    }
}

/// A slip that whole visits keep: the rows from one on have the shift, or where
/// the unloaded readings were taken in a round before, and the slip was within
/// the round, the rows before one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment {
    /// The row.
    pub row: usize,
    /// Whether the rows before it have the shift.
    pub before: bool,
}

impl Moment {
    /// Whether a row has the shift.
    pub fn has(&self, row: usize) -> bool {
        (row < self.row) == self.before
    }
}

/// When something may have slipped so that whole visits keep it, the likeliest first.
#[derive(Clone, Debug, Default)]
pub struct Moments([Vec<Moment>; Slipping::ALL.len()]);

impl Moments {
    /// The same for everything that slips.
    pub fn alike(moments: &[Moment]) -> Self {
        Self(Slipping::ALL.map(|_| moments.to_vec()))
    }

    /// When this may have slipped.
    pub fn of(&self, slipping: Slipping) -> &[Moment] {
        &self.0[slipping as usize]
    }

    /// Puts moments in the place of the first.
    pub fn replace_first(&mut self, slipping: Slipping, by: &[Moment]) {
        self.0[slipping as usize][..by.len()].copy_from_slice(by);
    }
}

/// The slip that whole visits keep which is most likely, if one is near
/// significant: a shift, or of the base a shift with a turn. Rows that are left
/// out next to its moment have no part in finding it; they are laid to the side
/// that they look like, but for those of poses held out, which choose nothing.
pub fn likeliest_slip(setting: &Setting<'_>, model: &Fitted, slipping: Slipping) -> Option<Moment> {
    let (problem, fit) = setting.alone(&model.fit);
    let (axes, rows) = (problem.axes, setting.point.samples.rows.len());
    let fitted_to = Block::among(&problem.blocks, rows);
    let columns = &fit.columns;
    let mut white = problem.white.clone().insert_column(columns.len(), 0.0);
    white.set_column(columns.len(), &problem.white_residuals(columns, &problem.total.solve(columns)?.coefficients));
    for row in (0..rows).filter(|&row| !fitted_to[row]) {
        white.rows_mut(row * axes, axes).fill(0.0);
    }
    // A step is whitened like the readings; its products with what is whitened
    // are sums over rows of that whitened once more. Where axes differ in noise
    // their scale cancels for a shift of the base; for others, or in a measuring frame
    // that turns with the tool, this is a first look only, like the moment it gives:
    // the tests have the whole.
    let not_fitted: Vec<bool> = fitted_to.iter().map(|fitted| !fitted).collect();
    let visits = alone(&setting.point.samples.visits(), &not_fitted);
    let shared = problem.shared;
    whiten(&mut white, &visits, axes, shared);
    let scan = Scan {
        setting,
        slipping,
        fitted_to,
        white,
        inverse: problem.total.inverse(columns)?,
        variance: problem.variance(&model.fit),
        visits,
    };
    let after = scan.best(&mut (1..rows).rev(), false);
    let before = scan.best(&mut (0..rows - 1), true);
    let best = after.into_iter().chain(before).max_by(|a, b| a.gain.total_cmp(&b.gain))?;
    (best.gain > WORTH_A_LOOK * scan.variance).then(|| scan.settled(&best, model))
}

/// What is needed to look at all moments.
struct Scan<'s, 'c> {
    setting: &'s Setting<'c>,
    slipping: Slipping,
    fitted_to: Vec<bool>,
    /// The model's columns and what it leaves, whitened twice.
    white: DMatrix<f64>,
    inverse: DMatrix<f64>,
    variance: f64,
    visits: Vec<usize>,
}

/// A slip at one moment.
struct Slip {
    gain: f64,
    moment: Moment,
    /// Shift (m) and turn (rad).
    by: DVector<f64>,
}

impl Scan<'_, '_> {
    /// The best of the moments that come as rows are added in an order.
    fn best(&self, order: &mut dyn Iterator<Item = usize>, before: bool) -> Option<Slip> {
        let (axes, shared) = (self.setting.problem.axes, self.setting.problem.shared);
        let count = self.white.ncols();
        let mut sizes = vec![0_usize; self.visits.iter().max()? + 1];
        self.visits.iter().for_each(|&visit| sizes[visit] += 1);
        let mut inside = vec![0_usize; sizes.len()];
        let mut energy = Matrix6::<f64>::zeros();
        let mut sums = DMatrix::<f64>::zeros(6, count);
        let mut best: Option<Slip> = None;
        for row in order {
            if self.fitted_to[row] {
                let moves = self.moves(row);
                for column in 0..count {
                    let own = Vector3::from_fn(|axis, _| self.white[(row * axes + axis, column)]);
                    let along = moves.tr_mul(&own);
                    (0..6).for_each(|k| sums[(k, column)] += along[k]);
                }
                let visit = self.visits[row];
                let before = step_energy(sizes[visit], inside[visit], shared);
                inside[visit] += 1;
                energy += moves.tr_mul(&moves) * (step_energy(sizes[visit], inside[visit], shared) - before);
            }
            let moment = Moment { row: row + usize::from(before), before };
            let numbers = self.slipping.numbers().iter();
            for slip in numbers.filter_map(|&numbers| self.slip(&energy, &sums, numbers, moment)) {
                if best.as_ref().is_none_or(|best| slip.gain > best.gain) {
                    best = Some(slip);
                }
            }
        }
        best
    }

    /// What the first `numbers` of shift and turn gain.
    fn slip(&self, energy: &Matrix6<f64>, sums: &DMatrix<f64>, numbers: usize, moment: Moment) -> Option<Slip> {
        let last = sums.ncols() - 1;
        let along = sums.view((0, 0), (numbers, last));
        let left = energy.view((0, 0), (numbers, numbers)) - along * &self.inverse * along.transpose();
        if (0..numbers).any(|k| left[(k, k)] <= OF_ITS_OWN * energy[(k, k)]) {
            return None;
        }
        let score = sums.view((0, last), (numbers, 1)).into_owned();
        let by = Scaled::of(&left)?.solve(&score.column(0).into_owned());
        let price = if numbers > 3 { TURNS * self.variance } else { 0.0 };
        Some(Slip { gain: by.dot(&score.column(0)) - price, moment, by })
    }

    /// What a unit of shift and turn moves at a row.
    fn moves(&self, row: usize) -> Matrix3x6<f64> {
        self.slipping.moves(&self.setting.point.samples.rows[row])
    }

    /// The moment among rows that are left out around it. Poses held out have no part in it.
    fn settled(&self, slip: &Slip, model: &Fitted) -> Moment {
        let axes = self.setting.problem.axes;
        let residuals = self.setting.residuals(&model.fit) - &self.setting.correction;
        let is_out = |row: usize| !self.fitted_to[row];
        let held_out = Block::among(&self.setting.problem.held_out, self.fitted_to.len());
        let row = slip.moment.row;
        let first = (0..row).rev().take_while(|&row| is_out(row)).last().unwrap_or(row);
        let last = (row..self.fitted_to.len()).take_while(|&row| is_out(row)).last().map_or(row, |row| row + 1);
        let by = slip.by.clone().resize_vertically(6, 0.0);
        // How much better a row is explained with the shift than without.
        let better = |row: usize| {
            let left = residuals.fixed_rows::<3>(row * axes).into_owned();
            let moved = self.moves(row) * &by;
            left.norm_squared() - (left - moved).norm_squared()
        };
        let with =
            |moment: Moment| (first..last).filter(|&row| !held_out[row] && moment.has(row)).map(better).sum::<f64>();
        let moments = (first..=last).map(|row| Moment { row, before: slip.moment.before });
        moments.fold(slip.moment, |best, moment| if with(moment) > with(best) { moment } else { best })
    }
}

/// The rows held out that no row fitted to is between them and the moment of a slip, the
/// first row after it: on which side of it they are the fit does not say.
pub fn undecided(moments: impl IntoIterator<Item = usize>, fitted_to: &[bool], held_out: &[bool]) -> Vec<usize> {
    let beside = |slip: usize| {
        let before = (0..slip).rev().take_while(|&row| !fitted_to[row]);
        before.chain((slip..fitted_to.len()).take_while(|&row| !fitted_to[row]))
    };
    let mut undecided: Vec<usize> = moments.into_iter().flat_map(beside).filter(|&row| held_out[row]).collect();
    undecided.sort_unstable();
    undecided.dedup();
    undecided
}

/// The squared length of a step over the last `inside` of a visit's `rows`
/// rows, whitened.
fn step_energy(rows: usize, inside: usize, shared: f64) -> f64 {
    let (n, m) = (rows as f64, inside as f64);
    let taken = mean_share(rows, shared) * m / n;
    m * (1.0 - taken).powi(2) + (n - m) * taken * taken
}
