//! What is wrong in single visits: wild rows, a wild unloaded reading, a slip
//! within a visit. The tests of the catalogue keep whole poses together and
//! cannot see what one pose alone says; and a wild row must not vote for an
//! effect there.
//!
//! A visit's residuals are held against each of these: one row off, all rows
//! from one on off by the same, all rows off by the same (the unloaded reading),
//! by generalised least squares. What is a straight line in the load is taken
//! out before, for that is how a missing compliance looks, and the scale is the
//! median over all rows, by axis: structure common to many visits raises it, the more
//! where the arm gives way further. So rows stand out from structure and noise together, and what was cut while an
//! effect was missing is looked at again once it is named. A median of few rows is
//! itself uncertain; what is held against it has the tails of Student's
//! distribution (`OF_MEDIAN`). Where the noise is another at each pose (`by_pose`),
//! what stands out must stand out from that of its own pose as well, and where its tails
//! are heavy, from tails like them. Of few rows with one load at each pose a wild one moves the
//! fit until it stands out no more; these are held against the fit without them first
//! ([`alone`]).
//!
//! Without any model the other readings of its own pose can contradict one
//! ([`Covariance::beyond_doubt`](crate::identify::covariance::Covariance::beyond_doubt)).
//! Such rows have no part in the first fit, which one that is far enough off would move until
//! all others look wild; in poses held out, where no model may find fault, they are what is
//! wild; and where structure is left, it is asked whether they are all of it.

pub mod alone;
mod by_pose;
mod search;

use std::vec;
use std::vec::Vec;

use nalgebra::{Matrix3, Vector3};

use self::by_pose::ByPose;
use self::search::search;
use super::model::{Fitted, Setting};
use crate::campaign::Frame;
use crate::identify::covariance::Outlier;
use crate::identify::covariance::heavy::{freedom_of_tails, scale_of_tails};
use crate::identify::covariance::outliers::{STANDS_OUT, by_median};
use crate::identify::samples::{Samples, turn_of};
use crate::probability::as_normal;

/// Something wrong in one visit.
#[derive(Clone, Debug)]
pub struct Event {
    /// The rows it is seen in, of the campaign.
    pub rows: Vec<usize>,
    /// The probability of so much under noise alone, over all that was looked
    /// at.
    pub p_value: f64,
    /// By how much they are off (m), where these are several rows to the visit's end, but not
    /// all.
    pub slip: Option<Vector3<f64>>,
}

impl Event {
    /// What the other readings of its own pose contradict; of displacements measured in `frame`.
    pub fn contradicted(
        Outlier { rows, visit, whole_visit, shift, p_value, .. }: Outlier,
        on: (&Samples, Frame),
    ) -> Self {
        let (samples, frame) = on;
        let first = rows.iter().copied().min().unwrap_or_default();
        let turn = if frame == Frame::Tool { turn_of(&samples.rows[first].tcp) } else { Matrix3::identity() };
        // Where rows before it were set aside first, it is but the rest that is off alike.
        let is_rest = whole_visit && samples.rows[..first].iter().any(|row| row.visit == visit);
        let slip = is_rest.then(|| turn * Vector3::new(shift[0], shift[1], shift[2]));
        Self { rows, p_value, slip }
    }
}

/// What must be explained where there are too few rows to take the straight line out:
/// beyond fourteen standard deviations ([`STANDS_OUT`]: beyond twelve).
const STANDS_OUT_AS_IT_IS: f64 = 200.0;

/// The degrees of freedom of a variance from that median, over those of the
/// readings: its own variance is `1 / (4 n f^2)` with the density `f` of chi-square
/// there, that of the sum of squares `2 / n`.
const OF_MEDIAN: f64 = 0.368;

/// With less than this share left, a straight line in the load says the same.
const OF_ITS_OWN: f64 = 0.1;

/// What two names may differ by before the simpler is left for the other.
const TIE: f64 = 6.0;

/// One visit's residuals.
#[derive(Clone)]
struct Visit {
    pose: usize,
    /// `lambda`, the variance of its unloaded reading over that of a row's own.
    shared: f64,
    rows: Vec<usize>,
    used: Vec<bool>,
    residuals: Vec<Vector3<f64>>,
    /// Along the load, the largest being 1.
    loads: Vec<f64>,
    /// The third of all rows that each is in, by how far the arm gives way there.
    thirds: Vec<usize>,
}

/// What one hypothesis explains: by axis, and along which shift.
struct Explained {
    by_axis: Vector3<f64>,
    shift: Vector3<f64>,
    projected: bool,
}

impl Visit {
    /// `a^T V^-1 b` over the rows used, with `V = I + lambda 1 1^T`.
    fn product(&self, a: &[f64], b: &[f64]) -> f64 {
        let used = || (0..self.rows.len()).filter(|&i| self.used[i]);
        let count = used().count() as f64;
        let (mut dot, mut sum_a, mut sum_b) = (0.0, 0.0, 0.0);
        for i in used() {
            dot += a[i] * b[i];
            sum_a += a[i];
            sum_b += b[i];
        }
        dot - self.shared * sum_a * sum_b / (1.0 + self.shared * count)
    }

    fn explained(&self, pattern: &[f64], strict: bool) -> Option<Explained> {
        let own = self.product(pattern, pattern);
        let loads = self.product(&self.loads, &self.loads);
        let along = if loads > 0.0 { self.product(pattern, &self.loads) / loads } else { 0.0 };
        let left: Vec<f64> = pattern.iter().zip(&self.loads).map(|(p, load)| p - along * load).collect();
        let remaining = self.product(&left, &left);
        let enough = self.used.iter().filter(|used| **used).count() > 3 && remaining > OF_ITS_OWN * own;
        let projected = !strict && enough;
        let (pattern, size) = if projected { (&left[..], remaining) } else { (pattern, own) };
        if size <= 0.0 {
            return None;
        }
        let of_axis = |axis: usize| {
            let residuals: Vec<f64> = self.residuals.iter().map(|residual| residual[axis]).collect();
            self.product(pattern, &residuals)
        };
        let products = Vector3::from_fn(|axis, _| of_axis(axis));
        Some(Explained { by_axis: products.component_mul(&products) / size, shift: products / size, projected })
    }

    fn single(&self, row: usize) -> Vec<f64> {
        (0..self.rows.len()).map(|i| f64::from(u8::from(i == row))).collect()
    }

    fn from(&self, row: usize) -> Vec<f64> {
        (0..self.rows.len()).map(|i| f64::from(u8::from(i >= row))).collect()
    }
}

/// What is wrong in single visits of poses fitted to, the worst first; nothing
/// where that would be more than a few. With `strict`, the rest is taken to be noise.
pub fn events(setting: &Setting<'_>, model: &Fitted, strict: bool) -> Vec<Event> {
    let mut visits = visits(setting, model);
    let tells = setting.problem.freedom(&model.fit) / setting.problem.total.rows as f64;
    let mut rest = visits.clone();
    let found = search(&mut rest, strict, tells, &Known::default());
    if !strict || found.is_empty() {
        return found;
    }
    // That is also how noise looks that is larger at some poses, or has heavy tails.
    let scale = scale(&rest, strict, tells, None);
    let by_pose = ByPose::of(&rest, &scale, tells);
    let tails = tails(&rest, &scale, tells, by_pose.as_ref());
    if by_pose.is_none() && tails.is_none() {
        return found;
    }
    search(&mut visits, strict, tells, &Known { by_pose, tails })
}

/// What noise is known to be like besides its variance.
#[derive(Default)]
struct Known {
    /// It is another at each pose.
    by_pose: Option<ByPose>,
    /// The degrees of freedom of Student's distribution that its tails have.
    tails: Option<f64>,
}

/// The degrees of freedom that the tails of single rows have, if they are heavy.
fn tails(visits: &[Visit], scale: &Scale, tells: f64, by_pose: Option<&ByPose>) -> Option<f64> {
    let mut squares = Vec::new();
    for (k, visit) in visits.iter().enumerate() {
        let variance = scale.variance * by_pose.map_or(1.0, |by_pose| by_pose.times(visits, k, scale));
        let used = (0..visit.rows.len()).filter(|&row| visit.used[row]);
        let found = used.filter_map(|row| visit.explained(&visit.single(row), true));
        squares.extend(found.flat_map(|found| found.by_axis.component_div(&variance).data.0[0]));
    }
    freedom_of_tails(&squares, tells)
}

/// What the model leaves of the visits of poses fitted to.
fn visits(setting: &Setting<'_>, model: &Fitted) -> Vec<Visit> {
    let samples = &setting.point.samples;
    let residuals = setting.residuals(&model.fit) - &setting.correction;
    let mut visits: Vec<Visit> = Vec::new();
    let mut at = vec![usize::MAX; samples.rows.iter().map(|row| row.visit + 1).max().unwrap_or(0)];
    // What is held out judges the model: none of it is wild because the model misses it.
    let held_out: Vec<usize> = setting.problem.held_out.iter().map(|block| block.pose).collect();
    let fitted_to = samples.rows.iter().enumerate().filter(|(_, row)| !held_out.contains(&row.pose));
    for (i, row) in fitted_to {
        if at[row.visit] == usize::MAX {
            at[row.visit] = visits.len();
            visits.push(Visit {
                pose: row.pose,
                shared: setting.problem.shared,
                rows: vec![],
                used: vec![],
                residuals: vec![],
                loads: vec![],
                thirds: vec![],
            });
        }
        let visit = &mut visits[at[row.visit]];
        visit.rows.push(i);
        visit.used.push(true);
        visit.residuals.push(residuals.fixed_rows::<3>(i * samples.axes).into_owned());
    }
    let moved = |visit: &Visit| -> Vec<f64> {
        let rows = visit.rows.iter().zip(&visit.residuals);
        rows.map(|(&row, left)| (samples.rows[row].displacement - left).norm()).collect()
    };
    let mut all: Vec<f64> = visits.iter().flat_map(moved).collect();
    all.sort_by(f64::total_cmp);
    let third = |moved: f64| 3 * all.partition_point(|other| *other < moved) / all.len();
    for visit in &mut visits {
        visit.thirds = moved(visit).into_iter().map(third).collect();
        let wrench = |&row: &usize| samples.rows[row].wrench;
        let norm = |row: &&usize| wrench(row).norm();
        let Some(largest) = visit.rows.iter().max_by(|a, b| norm(a).total_cmp(&norm(b))) else { continue };
        let largest = wrench(largest);
        let size = largest.norm_squared().max(f64::MIN_POSITIVE);
        visit.loads = visit.rows.iter().map(|row| wrench(row).dot(&largest) / size).collect();
    }
    visits
}

/// The variance of a reading, by axis.
struct Scale {
    variance: Vector3<f64>,
    /// The degrees of freedom of what is held against it: of how well it is known, or of
    /// the tails. A mean of several readings has tails as heavy.
    freedom: f64,
    /// How many times that the variance is in each third of the rows, at least 1.
    thirds: [f64; 3],
}

/// The variance of a reading by axis, from the median over single rows, of whose
/// freedom a model has left the share `tells`. Noise does not know how far an arm gives
/// way, and structure does. With heavy `tails` it is the square of their scale.
fn scale(visits: &[Visit], strict: bool, tells: f64, tails: Option<f64>) -> Scale {
    let mut seen: Vec<(usize, Vector3<f64>)> = Vec::new();
    for visit in visits {
        for i in (0..visit.rows.len()).filter(|&i| visit.used[i]) {
            seen.extend(visit.explained(&visit.single(i), strict).map(|found| (visit.thirds[i], found.by_axis)));
        }
    }
    let of_tails = tails.map_or(1.0, scale_of_tails);
    let variance = Vector3::from_fn(|axis, _| of_tails * by_median(seen.iter().map(|(_, by_axis)| by_axis[axis])));
    let of_third = |third: usize| {
        let rows = seen.iter().filter(|(of, _)| *of == third);
        let over = rows.flat_map(|(_, by_axis)| by_axis.component_div(&variance).data.0[0]);
        by_median(over).max(1.0)
    };
    let thirds = if strict { [1.0; 3] } else { [0, 1, 2].map(of_third) };
    let freedom = (OF_MEDIAN * tells * seen.len() as f64).min(tails.unwrap_or(f64::INFINITY));
    Scale { variance, freedom, thirds }
}

/// What stands out from all rows, and from the noise of its own pose where that is known; with
/// what it explains over the variance of a reading, as if that were known.
struct Judge<'a> {
    scale: &'a Scale,
    /// The noise of the pose, if what a pattern says is wrong there.
    own: &'a dyn Fn(&[f64]) -> Option<by_pose::Noise>,
    strict: bool,
    threshold: f64,
}

impl Judge<'_> {
    /// The worst of a visit.
    fn worst(&self, visit: &Visit) -> Option<(f64, Event)> {
        let used: Vec<usize> = (0..visit.rows.len()).filter(|&i| visit.used[i]).collect();
        let single = used.iter().filter_map(|&i| self.event(visit, &visit.single(i), false));
        let single = single.max_by(|a, b| a.0.total_cmp(&b.0));
        // The last row alone is a single one, all rows the unloaded reading.
        let from = used.iter().take(used.len().saturating_sub(1));
        let several = from.filter_map(|&i| self.event(visit, &visit.from(i), i > 0));
        let several = several.max_by(|a, b| a.0.total_cmp(&b.0));
        match (single, several) {
            (Some(single), Some(several)) if several.0 > single.0 + TIE => Some(several),
            (Some(single), _) => Some(single),
            (None, several) => several,
        }
    }

    /// One slip in place of all that was found in a visit, if nothing stands out from it. The
    /// rows before a slip are off as far from those after it as these from them, and may have
    /// been taken out first.
    fn one_slip(&self, visit: &Visit) -> Option<(f64, Event)> {
        let mut whole = visit.clone();
        whole.used.fill(true);
        let slips = (1..whole.rows.len().saturating_sub(1)).filter_map(|i| self.event(&whole, &whole.from(i), true));
        let best = slips.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let shift = best.1.slip?;
        for (row, left) in whole.rows.iter().zip(&mut whole.residuals) {
            *left -= if best.1.rows.contains(row) { shift } else { Vector3::zeros() };
        }
        self.worst(&whole).is_none().then_some(best)
    }

    /// What a pattern says is wrong with a visit.
    fn event(&self, visit: &Visit, pattern: &[f64], is_slip: bool) -> Option<(f64, Event)> {
        let &Self { scale, own, strict, threshold } = self;
        let explained = visit.explained(pattern, strict)?;
        let rows = || (0..visit.rows.len()).filter(|&i| visit.used[i] && pattern[i] != 0.0);
        let times = rows().map(|i| scale.thirds[visit.thirds[i]]).fold(1.0, f64::max);
        let over = explained.by_axis.component_div(&scale.variance) / times;
        let mut statistic = over.map(|square| as_normal(square, scale.freedom)).sum();
        if statistic > threshold
            && let Some(noise) = own(pattern)
        {
            let freedom = noise.freedom.min(scale.freedom);
            statistic = over.map(|square| as_normal(square / noise.times, freedom)).sum().min(statistic);
        }
        let enough = match (strict, explained.projected) {
            (true, _) => 0.0,
            (false, true) => STANDS_OUT,
            (false, false) => STANDS_OUT_AS_IT_IS,
        };
        let rows = rows().map(|i| visit.rows[i]).collect();
        let event = Event { rows, p_value: 1.0, slip: is_slip.then_some(explained.shift) };
        (over.sum() > enough && statistic > threshold).then_some((statistic, event))
    }
}
