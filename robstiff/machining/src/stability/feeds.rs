//! The cut as a spring of its own, and the best direction to feed in.

use core::f64::consts::TAU;

use nalgebra::{Matrix3, Unit, Vector3};

use super::{Limits, Lobes, Modes};
use crate::milling::{Coefficients, Cut, CutFrame, Engagement};

/// The change of the force on the tool with its displacement per depth of cut,
/// 3 x 3 (N/m^2), in the frame that `frame` is given in: the average over the
/// teeth of `g n^T`, where `n` points out along the tooth and makes its chip
/// thicker and `g` is the force on the tooth per chip area.
///
/// It is the zero-order term of the directional coefficients of Altintas and
/// Budak (CIRP Annals 44/1 (1995) 357-362), with an axial row, for an even
/// surface. The edge forces do not change with the chip and take no part; neither
/// does a displacement along the axis, which changes the depth itself.
pub fn process(cut: &Cut, frame: &CutFrame) -> Matrix3<f64> {
    let Coefficients { ktc, krc, kac, .. } = cut.inclined();
    let Engagement { entry, exit } = cut.engagement;
    let (sine2, cosine2) = ((2.0 * exit).sin() - (2.0 * entry).sin(), (2.0 * exit).cos() - (2.0 * entry).cos());
    let (s, c) = (entry.cos() - exit.cos(), exit.sin() - entry.sin());
    let (ss, cc) = (0.5 * (exit - entry) - 0.25 * sine2, 0.5 * (exit - entry) + 0.25 * sine2);
    let sc = -0.25 * cosine2;
    let local = Matrix3::new(
        -ktc * sc - krc * ss,
        -ktc * cc - krc * sc,
        0.0,
        ktc * ss - krc * sc,
        ktc * sc - krc * cc,
        0.0,
        kac * s,
        kac * c,
        0.0,
    );
    let axes = frame.matrix();
    axes * local * axes.transpose() * (cut.mill.teeth as f64 / TAU)
}

/// `-kp f n^T`: a force of the size `kp n . x`, against the direction `f`, the
/// model of Pan et al. 2006; `kp` in N/m gives N/m, per depth it gives that per
/// depth.
pub fn rank_one(kp: f64, force: &Unit<Vector3<f64>>, normal: &Unit<Vector3<f64>>) -> Matrix3<f64> {
    force.as_ref() * normal.transpose() * -kp
}

/// The depths that are not stable with a feed.
#[derive(Clone, Debug, PartialEq)]
pub struct FeedLimit {
    /// The feed's angle in the plane (rad), from the first direction on.
    pub angle: f64,
    /// The feed, a unit vector.
    pub feed: Vector3<f64>,
    /// The arm that bears the cut.
    pub modes: Modes,
    /// The depths, where each tooth meets the surface that the tooth before it has cut.
    pub limits: Limits,
    /// The same on a surface that stays even, as if the delay between two teeth did not count:
    /// the model of mode coupling alone, which the literature compares with.
    pub without_delay: Limits,
    /// What gives the depths at any other spindle speed.
    pub lobes: Lobes,
}

/// So many directions across a tool axis, with their angles (rad), evenly
/// around it, clockwise looked at along the axis (from the spindle): the first is
/// the part of x across the axis, or that of y where the axis is along x. `None`
/// for an axis of zero length.
pub fn feeds_in_plane(axis: &Vector3<f64>, count: usize) -> Option<Vec<(f64, Vector3<f64>)>> {
    let axis = axis.try_normalize(0.0)?;
    let along = if axis.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let first = (along - axis * axis.dot(&along)).try_normalize(0.0)?;
    let second = axis.cross(&first);
    let angle = |k: usize| TAU * k as f64 / count as f64;
    Some((0..count).map(|k| (angle(k), first * angle(k).cos() + second * angle(k).sin())).collect())
}

/// The depths that are not stable for each of so many feeds across a tool axis
/// (from the spindle to the tip), the cut turning with the feed, with a time between two teeth
/// (`period`, s: [`Cut::tooth_period`]), up to a greatest depth (m). `modes` are those
/// of the arm under the mean force of such a cut, 3 (N) in the frame of the axis:
/// an arm with backlash or hardening has others under each. They are those at the
/// depth of the cut, also where other depths are looked at. `None` for an axis of
/// zero length, where there are no modes, and where the cut or the greatest depth gives no [`Lobes`].
pub fn over_feeds(
    modes: impl Fn(&Vector3<f64>) -> Option<Modes>,
    cut: &Cut,
    axis: &Vector3<f64>,
    count: usize,
    period: f64,
    greatest: f64,
) -> Option<Vec<FeedLimit>> {
    let force = cut.mean_force();
    let limit = |(angle, feed): (f64, Vector3<f64>)| {
        let frame = CutFrame::new(axis, &feed)?;
        let modes = modes(&frame.force(&force))?;
        let process = process(cut, &frame);
        let lobes = Lobes::new(&modes, &process, greatest)?;
        let without_delay = modes.limits(&process, greatest);
        Some(FeedLimit { angle, feed, limits: lobes.limits(period), without_delay, lobes, modes })
    };
    feeds_in_plane(axis, count)?.into_iter().map(limit).collect()
}

/// The feed whose limiting depth with regeneration is the greatest; of equal ones the first.
/// `None` of none.
pub fn best(feeds: &[FeedLimit]) -> Option<&FeedLimit> {
    let depth = |feed: &FeedLimit| feed.limits.limiting().unwrap_or(f64::INFINITY);
    feeds.iter().reduce(|best, feed| if depth(feed) > depth(best) { feed } else { best })
}
