//! The direction in which a force of some size moves the TCP farthest.
//!
//! Where all of an arm is linear that is the first principal direction of its compliance. A
//! gear with backlash or one that hardens is softest without a load, so there the compliance
//! times the force is too much by a factor, and the direction may be another: it is sought
//! among forces of that size, from thirteen directions spread evenly over half a sphere (the
//! other half does the same, with the signs turned) and from the best four of them on, each by
//! smaller and smaller steps: there may be maxima of nearly the same height.

use nalgebra::{Matrix3, SVector, Vector3, Vector6};

use super::{Evaluate, Poses};

/// Displacements that differ by less than this fraction from the compliance times the force
/// are those of a linear arm.
const LINEAR: f64 = 1e-9;

/// The first step (rad), about half of what the directions to begin with are apart, and the
/// last: at a maximum what is left of it is its square.
const STEP: f64 = 0.4;
const LAST_STEP: f64 = 1e-5;

/// From so many directions the way goes on to a maximum.
const WAYS: usize = 4;

/// More steps than any pose needs: some twenty halvings, and a few between.
const MOST_STEPS: usize = 200;

/// How far the TCP moves (m), and the direction of the force that moves it.
pub type Farthest = (f64, Vector3<f64>);

/// The principal directions as columns, and the compliances in them (m/N).
pub type Principal = (Matrix3<f64>, Vector3<f64>);

/// The compliance in the softest direction (m/N), and that.
pub fn softest((directions, compliances): &Principal) -> (f64, Vector3<f64>) {
    (compliances[0], directions.column(0).into_owned())
}

/// How far a force of a size (N) moves the TCP (m) at each pose, in the direction in which it
/// moves it most, and that direction, in the base frame. `principal` are the principal
/// directions of the translational compliance there as columns, the softest first, and the
/// compliances (m/N).
pub fn largest<const N: usize>(
    robot: &impl Evaluate<N>,
    poses: Poses<'_, N>,
    force: f64,
    principal: &[Principal],
) -> Vec<Farthest> {
    let linear = |(compliance, direction)| (force * compliance, direction);
    let mut found: Vec<Farthest> = principal.iter().map(softest).map(linear).collect();
    let bent = not_linear(robot, poses, force, principal);
    if bent.is_empty() {
        return found;
    }
    let q: Vec<SVector<f64, N>> = bent.iter().map(|&pose| poses.pose(pose)).collect();
    let begin: Vec<Matrix3<f64>> = bent.iter().map(|&pose| principal[pose].0).collect();
    for (pose, best) in bent.into_iter().zip(search(robot, &q, force, &begin)) {
        found[pose] = best;
    }
    found
}

/// The poses at which a displacement is not the compliance times the force: a joint that no
/// force along an axis loads is loaded by none.
fn not_linear<const N: usize>(
    robot: &impl Evaluate<N>,
    poses: Poses<'_, N>,
    force: f64,
    principal: &[Principal],
) -> Vec<usize> {
    let mut differs = vec![false; poses.len()];
    let mut deflections = vec![Vector6::zeros(); poses.len()];
    for axis in 0..3 {
        let mut wrench = Vector6::zeros();
        wrench[axis] = force;
        robot.deflections(poses, &wrench, &mut deflections);
        for ((differs, deflection), (directions, compliances)) in differs.iter_mut().zip(&deflections).zip(principal) {
            let linear = directions * directions.row(axis).transpose().component_mul(compliances) * force;
            *differs |= (deflection.xyz() - linear).norm() > LINEAR * force * compliances[0];
        }
    }
    (0..differs.len()).filter(|&pose| differs[pose]).collect()
}

/// The farthest displacement at each pose, and the direction of its force.
fn search<const N: usize>(
    robot: &impl Evaluate<N>,
    q: &[SVector<f64, N>],
    force: f64,
    begin: &[Matrix3<f64>],
) -> Vec<Farthest> {
    let mut deflections = vec![Vector6::zeros(); q.len()];
    let mut moved = |directions: &[Vector3<f64>]| -> Vec<f64> {
        let wrench = |u: &Vector3<f64>| Vector6::new(u.x, u.y, u.z, 0.0, 0.0, 0.0) * force;
        let wrenches: Vec<Vector6<f64>> = directions.iter().map(wrench).collect();
        robot.deflections_under(Poses::List(q), &wrenches, &mut deflections);
        deflections.iter().map(|deflection| deflection.xyz().norm()).collect()
    };
    let mut take = |directions: &[Vector3<f64>], best: &mut [Farthest]| -> Vec<bool> {
        let better = |((best, moved), direction): ((&mut Farthest, f64), &Vector3<f64>)| {
            let is_better = moved > best.0;
            if is_better {
                *best = (moved, *direction);
            }
            is_better
        };
        best.iter_mut().zip(moved(directions)).zip(directions).map(better).collect()
    };
    let mut looked: Vec<Vec<Farthest>> = vec![Vec::new(); q.len()];
    for direction in half_sphere() {
        let directions: Vec<Vector3<f64>> = begin.iter().map(|begin| begin * direction).collect();
        let mut here = vec![(f64::NEG_INFINITY, Vector3::zeros()); q.len()];
        take(&directions, &mut here);
        looked.iter_mut().zip(here).for_each(|(looked, here)| looked.push(here));
    }
    for looked in &mut looked {
        looked.sort_by(|(one, _), (other, _)| other.total_cmp(one));
    }
    let mut farthest = vec![(f64::NEG_INFINITY, Vector3::zeros()); q.len()];
    for way in 0..WAYS {
        let mut best: Vec<Farthest> = looked.iter().map(|looked| looked[way]).collect();
        climb(&mut best, &mut take);
        for (farthest, best) in farthest.iter_mut().zip(best) {
            if best.0 > farthest.0 {
                *farthest = best;
            }
        }
    }
    farthest
}

/// From a direction at each pose to one that moves the TCP farthest among those beside it.
/// `take` looks at one direction at each pose, takes those that are better, and says which are.
fn climb(best: &mut [Farthest], take: &mut impl FnMut(&[Vector3<f64>], &mut [Farthest]) -> Vec<bool>) {
    let mut steps = vec![STEP; best.len()];
    for _ in 0..MOST_STEPS {
        if steps.iter().all(|&step| step < LAST_STEP) {
            break;
        }
        let from: Vec<Vector3<f64>> = best.iter().map(|(_, direction)| *direction).collect();
        let mut is_better = vec![false; best.len()];
        for k in 0..4 {
            let aside = |(from, step): (&Vector3<f64>, &f64)| {
                let [a, b] = across(from);
                from * step.cos() + [a, b, -a, -b][k] * step.sin()
            };
            let directions: Vec<Vector3<f64>> = from.iter().zip(&steps).map(aside).collect();
            let better = take(&directions, best);
            is_better.iter_mut().zip(better).for_each(|(all, one)| *all |= one);
        }
        steps.iter_mut().zip(is_better).filter(|(_, is_better)| !is_better).for_each(|(step, _)| *step *= 0.5);
    }
}

/// The axes, diagonals of faces and diagonals of a cube, one of two that are opposite.
fn half_sphere() -> impl Iterator<Item = Vector3<f64>> {
    let signs = [-1.0, 0.0, 1.0];
    let all = signs
        .into_iter()
        .flat_map(move |x| signs.into_iter().flat_map(move |y| signs.into_iter().map(move |z| Vector3::new(x, y, z))));
    // The first thirteen of 27 are the opposites of the last.
    all.skip(14).map(|direction| direction.normalize())
}

/// Two directions at right angles to one and to each other.
fn across(direction: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let mut aside = Vector3::zeros();
    aside[direction.iamin()] = 1.0;
    let first = direction.cross(&aside).normalize();
    [first, direction.cross(&first)]
}
