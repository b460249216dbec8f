//! The residual flexibility as springs.

use nalgebra::Matrix3;

use super::lines::Lines;
use super::model::Model;
use crate::stability::Spring;

/// The springs that stand for the modes above the band, in the units of the lines, and the model with these and
/// without the modes below the band.
///
/// Where not all pairs of directions were measured, the rest is the least that it can be: of a column of forces
/// `u` with `u_j` along the force it is `u u^T / u_j`. A spring gives way along the force on it: what would be
/// against it is noise, and left out.
pub fn massless(lines: &Lines, model: &Model) -> (Model, Vec<Spring>) {
    let Some(above) = &model.above else {
        return (Model { below: None, ..model.clone() }, Vec::new());
    };
    let known = |i: usize, j: usize| above.get(lines.pair([i, j])).copied();
    let whole = completed(known);
    let parts = whole.symmetric_eigen();
    let springs: Vec<Spring> = (0..3)
        .filter(|&k| parts.eigenvalues[k] > 0.0 && parts.eigenvalues[k].recip().is_finite())
        .map(|k| Spring {
            stiffness: parts.eigenvalues[k].recip(),
            direction: parts.eigenvectors.column(k).into_owned(),
        })
        .collect();
    let kept: Matrix3<f64> = springs.iter().map(Spring::compliance).sum();
    let above = lines.pairs.iter().map(|&[i, j]| kept[(i, j)]).collect();
    (Model { modes: model.modes.clone(), below: None, above: Some(above) }, springs)
}

/// A symmetric matrix of which some entries are known, those of a column among them.
fn completed(known: impl Fn(usize, usize) -> Option<f64>) -> Matrix3<f64> {
    let full = |j: usize| (0..3).all(|i| known(i, j).is_some());
    let along = |j: usize| known(j, j).unwrap_or_default();
    let column = (0..3).filter(|&j| full(j)).max_by(|&i, &j| along(i).total_cmp(&along(j))).unwrap_or(0);
    let least = |i: usize, j: usize| match along(column) {
        own if own > 0.0 => known(i, column).unwrap_or_default() * known(j, column).unwrap_or_default() / own,
        _ => 0.0,
    };
    Matrix3::from_fn(|i, j| known(i, j).unwrap_or_else(|| least(i, j)))
}
