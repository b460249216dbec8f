//! Which joints and effects a displacement comes from.

use super::parts::parts;
use super::{Deviation, Load};
use crate::path::SolvedPath;
use robstiff::elements::Element;
use robstiff::{Robot, State};

/// Which share of the surface error comes from each joint and effect, the largest
/// first; over the points of a deviation that `counts` picks by their index. Each
/// point counts with the size of its error and the length of path that it stands for, and what works
/// against the error counts negative. The sum is 1; empty where there is no error.
pub fn blame<'r, const N: usize>(
    robot: &'r impl Robot<N>,
    path: &SolvedPath<N>,
    load: &Load,
    deviation: &Deviation,
    counts: impl Fn(usize) -> bool,
) -> Vec<(Element<'r>, f64)> {
    let mut state = State::new();
    let mut shares: Vec<(Element<'r>, f64)> = Vec::new();
    // A single point stands for no length, and is all there is.
    let has_length = (0..deviation.points.len()).any(|i| counts(i) && deviation.points[i].length > 0.0);
    for (i, (point, found)) in path.points.iter().zip(&deviation.points).enumerate() {
        let parts = parts(robot, &point.q, &found.wrench, &mut state);
        let (Some(into), Some(error), true) = (load.contacts[i].into, found.error, counts(i)) else { continue };
        let length = if has_length { found.length } else { 1.0 };
        for (k, (element, part)) in parts.enumerate() {
            let share = length * error.signum() * into.dot(&part.fixed_rows::<3>(0));
            match shares.get_mut(k) {
                Some((_, sum)) => *sum += share,
                None => shares.push((element, share)),
            }
        }
    }
    let whole: f64 = shares.iter().map(|(_, share)| share).sum();
    if whole <= 0.0 {
        return Vec::new();
    }
    shares.iter_mut().for_each(|(_, share)| *share /= whole);
    shares.sort_by(|(_, one), (_, other)| other.total_cmp(one));
    shares
}
