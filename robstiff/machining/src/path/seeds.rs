//! Which postures at the first point of a path are followed.

use nalgebra::SVector;

/// The most of them.
const MOST: usize = 16;

/// Postures that differ by less in each joint are on one branch (rad or m): the inverse
/// kinematics looks at turns about the tool's axis that are 3 degrees apart.
const ONE_BRANCH: f64 = 0.25;

/// Of postures, the nearest to the middle of the joints' ranges first, those that stand for all:
/// of each branch the first, and where the turn about the tool's axis is free and branches are
/// long, others that are far from these. In the order given.
pub fn spread<const N: usize>(postures: &[SVector<f64, N>]) -> Vec<SVector<f64, N>> {
    let far = |one: usize, other: usize| (postures[one] - postures[other]).amax();
    let mut chosen = Vec::new();
    if postures.len() <= MOST {
        chosen.extend(0..postures.len());
    } else {
        spread_over(&mut chosen, &first_of_branches(postures.len(), &far), &far);
        spread_over(&mut chosen, &(0..postures.len()).collect::<Vec<_>>(), &far);
    }
    chosen.sort_unstable();
    chosen.into_iter().map(|k| postures[k]).collect()
}

/// Chooses up to the most, each the farthest from those chosen.
fn spread_over(chosen: &mut Vec<usize>, among: &[usize], far: &impl Fn(usize, usize) -> f64) {
    let apart = |k: usize, chosen: &[usize]| chosen.iter().map(|&one| far(k, one)).fold(f64::INFINITY, f64::min);
    while chosen.len() < MOST {
        // Of equally far ones the first.
        let farthest = among.iter().map(|&k| (k, apart(k, chosen)));
        let farthest = farthest.reduce(|best, next| if next.1 > best.1 { next } else { best });
        match farthest.filter(|(_, apart)| *apart > 0.0) {
            Some((k, _)) => chosen.push(k),
            None => break,
        }
    }
}

/// The first of each branch: of the postures that steps of less than [`ONE_BRANCH`] lead to.
fn first_of_branches(count: usize, far: &impl Fn(usize, usize) -> f64) -> Vec<usize> {
    let mut left: Vec<usize> = (0..count).collect();
    let mut firsts = Vec::new();
    while let Some(&first) = left.first() {
        firsts.push(first);
        let mut reached = Vec::from([first]);
        while let Some(one) = reached.pop() {
            let (near, others) = left.into_iter().partition(|&other| far(one, other) < ONE_BRANCH);
            left = others;
            reached.extend::<Vec<usize>>(near);
        }
    }
    firsts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_branch_is_followed_and_long_ones_from_several_places() {
        // A long branch beside two short ones, which come last.
        let long = (0..100).map(|k| SVector::from([0.05 * f64::from(k), 0.0]));
        let short = [[0.0, 1.0], [0.01, 1.0], [0.0, -1.0]].map(SVector::from);
        let all: Vec<SVector<f64, 2>> = long.chain(short).collect();
        let kept = spread(&all);
        assert_eq!(kept.len(), MOST);
        assert_eq!(kept[0], all[0]);
        assert!(kept.contains(&all[100]) && kept.contains(&all[102]), "{kept:?}");
        let widest = all[..100].iter().map(|one| kept.iter().map(|other| (one - other).amax()).fold(9.0, f64::min));
        assert!(widest.fold(0.0, f64::max) < 0.5);
        assert_eq!(spread(&all[98..]), all[98..]);
    }
}
