//! Variances by restricted maximum likelihood (Patterson and Thompson,
//! Biometrika 58, 1971): the likelihood of contrasts, which know nothing of the
//! coefficients.

use super::contrasts::Chunk;

/// What contrasts say of the variance of each axis, given the share of the
/// unloaded reading.
#[derive(Clone, Debug)]
pub struct Profile {
    /// The logarithm of the restricted likelihood, but for a constant.
    pub likelihood: f64,
    /// The variance of what a row has to itself, an axis each (m^2, rad^2).
    pub variances: Vec<f64>,
}

/// The number of contrasts, of one axis.
pub fn count(chunks: &[Chunk]) -> usize {
    chunks.iter().map(|chunk| chunk.shares.len()).sum()
}

/// The sum of squares of each axis, each contrast over its variance in units of
/// that of a row.
pub fn sums(chunks: &[Chunk], axes: usize, shared: f64) -> Vec<f64> {
    let of_chunk = |chunk: &Chunk, axis: usize| -> f64 {
        let values = chunk.values.column(axis);
        (0..chunk.shares.len()).map(|j| values[j] * values[j] / (1.0 + shared * chunk.shares[j])).sum()
    };
    let sum = |axis: usize| -> f64 { chunks.iter().map(|chunk| of_chunk(chunk, axis)).sum() };
    (0..axes).map(sum).collect()
}

/// The restricted likelihood with the best variances for a given share.
pub fn profile(chunks: &[Chunk], axes: usize, shared: f64) -> Profile {
    let contrasts = count(chunks) as f64;
    let variances: Vec<f64> = sums(chunks, axes, shared).into_iter().map(|sum| sum / contrasts).collect();
    let spread: f64 = chunks.iter().flat_map(|chunk| &chunk.shares).map(|share| (shared * share).ln_1p()).sum();
    let scale: f64 = variances.iter().map(|variance| contrasts * variance.max(f64::MIN_POSITIVE).ln()).sum();
    Profile { likelihood: -0.5 * (scale + axes as f64 * spread), variances }
}

/// The share of the unloaded reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// The most likely value, from zero up to [`BEYOND`].
    pub value: f64,
    /// What the contrasts do not contradict, at 95 %: from, to.
    pub interval: [f64; 2],
    /// Twice the logarithm of the likelihood of the value over that of one: how
    /// much more a visit's rows have in common than an unloaded reading gives
    /// them.
    pub beyond_one: f64,
}

/// No share is looked for beyond this.
pub const BEYOND: f64 = 16.0;

/// Chi-square with one degree of freedom at 95 %.
const CHI_SQUARE_95: f64 = 3.841;

/// Contrasts that hold less than this of an unloaded reading say nothing of it.
const HOLDS: f64 = 0.05;

/// Fewer contrasts than this on either side say too little.
const FEWEST: usize = 5;

/// The most likely share; `None` where the contrasts do not hold different
/// amounts of the unloaded readings, so that nothing tells them from the rest.
pub fn share(chunks: &[Chunk], axes: usize) -> Option<Share> {
    let mut shares: Vec<f64> = chunks.iter().flat_map(|chunk| chunk.shares.iter().copied()).collect();
    shares.sort_by(f64::total_cmp);
    let (low, high) = (*shares.get(FEWEST - 1)?, *shares.get(shares.len().checked_sub(FEWEST)?)?);
    if high - low < HOLDS {
        return None;
    }
    // From zero to one in steps of a fiftieth, then wider ones.
    let grid: Vec<f64> = (0..=50)
        .map(|k| f64::from(k) / 50.0)
        .chain((1..=60).map(|k| (f64::from(k) / 60.0 * BEYOND.ln()).exp()))
        .collect();
    let likelihoods: Vec<f64> = grid.iter().map(|&shared| profile(chunks, axes, shared).likelihood).collect();
    let best = (0..grid.len()).max_by(|&i, &j| likelihoods[i].total_cmp(&likelihoods[j]))?;
    let inside = |k: &usize| 2.0 * (likelihoods[best] - likelihoods[*k]) <= CHI_SQUARE_95;
    let first = (0..grid.len()).find(inside)?;
    let last = (0..grid.len()).rev().find(inside)?;
    let at_one = likelihoods[50];
    Some(Share {
        value: grid[best],
        interval: [grid[first], grid[last]],
        beyond_one: if grid[best] > 1.0 { 2.0 * (likelihoods[best] - at_one) } else { 0.0 },
    })
}
