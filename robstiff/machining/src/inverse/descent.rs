//! Damped least squares within joint limits.
//!
//! The step of Levenberg and Marquardt, `(J^T W J + m I) dq = J^T W e`, with the
//! damping `m` of Nielsen (Madsen, Nielsen, Tingleff: Methods for non-linear
//! least squares problems, 2004) times a bound by the error (Yamashita and
//! Fukushima 2001), which keeps the last steps those of Gauss and Newton also
//! where the Jacobian is singular. A joint that stands at a limit and is pushed
//! outwards is held for the step.

use nalgebra::{SMatrix, SVector, Vector3, Vector6};

use super::target::{Orientation, Remaining, Target};
use robstiff::Robot;
use robstiff::elements::commanded_rates;

/// Steps after which a descent gives up.
const MOST_STEPS: usize = 200;

/// A descent that has not halved its error in so many steps is stuck.
const PATIENCE: usize = 25;

/// Below this the last digits decide (m, and rad times the length scale).
const EXACT: f64 = 1e-14;

/// Where a descent ended.
#[derive(Clone, Copy, Debug)]
pub struct End<const N: usize> {
    /// Joint coordinates (rad or m).
    pub q: SVector<f64, N>,
    /// How far from the target.
    pub remaining: Remaining,
}

/// The bounds of the joint coordinates; infinite where there is no limit.
pub type Bounds<const N: usize> = [[f64; 2]; N];

/// Goes down from a start towards the target. `scale` (m) weighs angles against
/// lengths: that of the arm.
pub fn descend<const N: usize, R: Robot<N>>(
    robot: &R,
    target: &Target,
    start: &SVector<f64, N>,
    bounds: &Bounds<N>,
    scale: f64,
) -> End<N> {
    let mut q = SVector::from_fn(|i, _| start[i].clamp(bounds[i][0], bounds[i][1]));
    let (mut error, mut remaining) = weighted_error(robot, target, &q, scale);
    let (mut cost, mut damping, mut growth) = (error.norm_squared(), 1e-3, 2.0);
    let (mut mark, mut since) = (cost, 0);
    let mut step = 0;
    while step < MOST_STEPS && cost > EXACT * EXACT {
        let jacobian = weighted_jacobian(robot, target, &q, scale);
        let gradient = jacobian.transpose() * error;
        let normal = jacobian.transpose() * jacobian;
        let largest = (0..N).map(|i| normal[(i, i)]).fold(f64::MIN_POSITIVE, f64::max);
        let held: [bool; N] = core::array::from_fn(|i| {
            (q[i] <= bounds[i][0] && gradient[i] < 0.0) || (q[i] >= bounds[i][1] && gradient[i] > 0.0)
        });
        let mut went_down = false;
        while step < MOST_STEPS && !went_down {
            step += 1;
            // Relative to the arm's own size, and vanishing with the error.
            let added = damping * largest * (cost.sqrt() / scale).clamp(1e-15, 1.0);
            let Some(change) = step_within(&normal, &gradient, &held, added) else {
                damping *= 10.0;
                continue;
            };
            let next = SVector::from_fn(|i, _| (q[i] + change[i]).clamp(bounds[i][0], bounds[i][1]));
            let (next_error, next_remaining) = weighted_error(robot, target, &next, scale);
            let next_cost = next_error.norm_squared();
            if next_cost < cost {
                let expected = cost - (error - jacobian * (next - q)).norm_squared();
                let gain = (cost - next_cost) / expected.max(f64::MIN_POSITIVE);
                damping = (damping * (1.0 - (2.0 * gain - 1.0).powi(3)).max(1.0 / 3.0)).max(1e-12);
                growth = 2.0;
                (q, error, remaining, cost) = (next, next_error, next_remaining, next_cost);
                went_down = true;
            } else if cost < 1e-24 || damping > 1e12 {
                return End { q, remaining };
            } else {
                damping *= growth;
                growth *= 2.0;
            }
        }
        since += 1;
        if cost < 0.25 * mark {
            (mark, since) = (cost, 0);
        } else if since > PATIENCE {
            break;
        }
    }
    End { q, remaining }
}

/// The damped step with the held joints at rest.
fn step_within<const N: usize>(
    normal: &SMatrix<f64, N, N>,
    gradient: &SVector<f64, N>,
    held: &[bool; N],
    added: f64,
) -> Option<SVector<f64, N>> {
    let (mut matrix, mut right) = (*normal, *gradient);
    for i in 0..N {
        if held[i] {
            matrix.row_mut(i).fill(0.0);
            matrix.column_mut(i).fill(0.0);
            matrix[(i, i)] = 1.0;
            right[i] = 0.0;
        } else {
            matrix[(i, i)] += added;
        }
    }
    matrix.cholesky().map(|factor| factor.solve(&right))
}

fn weighted_error<const N: usize, R: Robot<N>>(
    robot: &R,
    target: &Target,
    q: &SVector<f64, N>,
    scale: f64,
) -> (Vector6<f64>, Remaining) {
    let (shift, turn) = target.apart(&robot.transform(q));
    let mut error = Vector6::zeros();
    error.fixed_rows_mut::<3>(0).copy_from(&shift);
    error.fixed_rows_mut::<3>(3).copy_from(&(turn * scale));
    (error, Remaining { distance: shift.norm(), angle: turn.norm() })
}

/// The change of the pose per joint coordinate, without the turns that are free.
fn weighted_jacobian<const N: usize, R: Robot<N>>(
    robot: &R,
    target: &Target,
    q: &SVector<f64, N>,
    scale: f64,
) -> SMatrix<f64, 6, N> {
    let mut jacobian = robot.jacobian(q);
    let rates = commanded_rates(robot, q);
    for (i, mut column) in jacobian.column_iter_mut().enumerate() {
        column *= rates[i];
        let mut turn: Vector3<f64> = column.fixed_rows::<3>(3).into_owned();
        match &target.orientation {
            Orientation::Full(_) => {}
            Orientation::Axis { direction, .. } => turn -= direction.as_ref() * direction.dot(&turn),
            Orientation::Free => turn.fill(0.0),
        }
        column.fixed_rows_mut::<3>(3).copy_from(&(turn * scale));
    }
    jacobian
}
