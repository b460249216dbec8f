//! Which joints and effects a displacement comes from.

use super::parts::parts;
use super::{Deviation, Load};
use crate::path::SolvedPath;
use robstiff::elements::Element;
use robstiff::{Robot, State};

/// Which share of the surface error comes from each joint and effect, the largest
/// first; over the points of a deviation that `counts` picks by their index. Each
/// point counts with the size of its error, and what works against the error
/// counts negative. The sum is 1; empty where there is no error.
pub fn blame<'r, const N: usize>(
    robot: &'r impl Robot<N>,
    path: &SolvedPath<N>,
    load: &Load,
    deviation: &Deviation,
    counts: impl Fn(usize) -> bool,
) -> Vec<(Element<'r>, f64)> {
    let mut state = State::new();
    let mut shares: Vec<(Element<'r>, f64)> = Vec::new();
    for (i, (point, found)) in path.points.iter().zip(&deviation.points).enumerate() {
        let parts = parts(robot, &point.q, &found.wrench, &mut state);
        let (Some(into), Some(error), true) = (load.contacts[i].into, found.error, counts(i)) else { continue };
        for (k, (element, part)) in parts.enumerate() {
            let share = error.signum() * into.dot(&part.fixed_rows::<3>(0));
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
