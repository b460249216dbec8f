//! Whether the noise is normal: the kurtosis of studentised residuals, against
//! that of as many normal readings under the same poses and loads.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use statrs::function::gamma::ln_gamma;

use super::contrasts::Chunk;
use crate::probability::normal;

/// The tails of the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tails {
    /// The fourth moment of the studentised residuals over the square of the
    /// second, less the three of a normal distribution.
    pub excess_kurtosis: f64,
    /// The probability of so much under normal noise, by simulation.
    pub p_value: f64,
    /// The degrees of freedom of the Student distribution that fits the
    /// residuals best; none where that is the normal one.
    pub freedom: Option<f64>,
}

/// Simulated campaigns; a p-value is no smaller than one over their number. Triage counts
/// it among all its checks, at a level of a hundredth.
pub const DRAWS: usize = 1999;

/// Once so many campaigns have heavier tails, a p-value is known as well as it needs to be:
/// it is their share, after as many draws as that took (Besag and Clifford, Biometrika 78,
/// 1991). Of normal noise few are drawn.
const ENOUGH: usize = 20;

/// Chunks up to about this many rows are looked at.
const MOST_ROWS: usize = 2000;

/// Of the degrees of freedom of Student's distribution.
pub const GRID: [f64; 14] = [2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0, 60.0];

/// The tails of contrasts with given variances.
pub fn tails(chunks: &[Chunk], axes: usize, shared: f64, variances: &[f64]) -> Option<Tails> {
    let mut rows = 0;
    let seen = |chunk: &&Chunk| {
        rows += chunk.rows.len();
        rows <= MOST_ROWS.max(chunk.rows.len())
    };
    let seen: Vec<Studentising<'_>> =
        chunks.iter().take_while(seen).map(|chunk| Studentising::new(chunk, shared)).collect();
    let measured = |of: &Studentising<'_>, j: usize, axis: usize| {
        of.chunk.values[(j, axis)] / of.root[j] / variances[axis].max(f64::MIN_POSITIVE).sqrt()
    };
    let residuals = studentised(&seen, axes, measured);
    if residuals.len() < 20 {
        return None;
    }
    let kurtosis = excess(&residuals);
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let (mut drawn, mut beyond) = (0, 0);
    while drawn < DRAWS && beyond < ENOUGH {
        drawn += 1;
        beyond += usize::from(excess(&studentised(&seen, axes, |_, _, _| normal(&mut random))) >= kurtosis);
    }
    let p_value = match beyond {
        ENOUGH => beyond as f64 / drawn as f64,
        _ => (1 + beyond) as f64 / (1 + drawn) as f64,
    };
    let spread = (residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64).sqrt();
    let normal = residuals.iter().map(|r| -0.5 * (r / spread).powi(2)).sum::<f64>()
        - residuals.len() as f64 * 0.5 * core::f64::consts::TAU.ln();
    let likely = |freedom: f64| residuals.iter().map(|r| log_student(r / spread, freedom)).sum::<f64>();
    let best = GRID.iter().map(|&freedom| (likely(freedom), freedom)).max_by(|a, b| a.0.total_cmp(&b.0));
    Some(Tails {
        excess_kurtosis: kurtosis,
        p_value,
        freedom: best.filter(|(likelihood, _)| *likelihood > normal).map(|(_, freedom)| freedom),
    })
}

/// What makes residuals of the contrasts of a chunk, each over its standard deviation.
struct Studentising<'c> {
    chunk: &'c Chunk,
    /// The standard deviation of each contrast over that of a reading.
    root: Vec<f64>,
    /// By row, the weights of the contrasts; of rows that the contrasts see little of, none.
    weights: Vec<Vec<f64>>,
}

impl<'c> Studentising<'c> {
    fn new(chunk: &'c Chunk, shared: f64) -> Self {
        let root: Vec<f64> = chunk.shares.iter().map(|share| (1.0 + shared * share).sqrt()).collect();
        let of_row = |i: usize| {
            let along: Vec<f64> = root.iter().enumerate().map(|(j, root)| chunk.basis[(i, j)] / root).collect();
            let leverage: f64 = along.iter().map(|a| a * a).sum();
            (leverage > 0.05).then(|| along.iter().map(|a| a / leverage.sqrt()).collect())
        };
        let weights = (0..chunk.rows.len()).filter_map(of_row).collect();
        Self { chunk, root, weights }
    }
}

/// The residual of every row and axis over its standard deviation; `contrast`
/// gives a contrast over its own.
fn studentised(
    seen: &[Studentising<'_>],
    axes: usize,
    mut contrast: impl FnMut(&Studentising<'_>, usize, usize) -> f64,
) -> Vec<f64> {
    let mut residuals = Vec::with_capacity(axes * seen.iter().map(|of| of.weights.len()).sum::<usize>());
    let mut values = Vec::new();
    for of in seen {
        for axis in 0..axes {
            values.clear();
            values.extend((0..of.root.len()).map(|j| contrast(of, j, axis)));
            let residual =
                |weights: &Vec<f64>| weights.iter().zip(&values).map(|(weight, value)| weight * value).sum::<f64>();
            residuals.extend(of.weights.iter().map(residual));
        }
    }
    residuals
}

fn excess(residuals: &[f64]) -> f64 {
    let moment = |power: i32| residuals.iter().map(|r| r.powi(power)).sum::<f64>() / residuals.len() as f64;
    moment(4) / moment(2).powi(2).max(f64::MIN_POSITIVE) - 3.0
}

/// The logarithm of Student's density with unit variance.
fn log_student(x: f64, freedom: f64) -> f64 {
    let scale = ((freedom - 2.0) / freedom).sqrt();
    ln_gamma(0.5 * (freedom + 1.0))
        - ln_gamma(0.5 * freedom)
        - 0.5 * (freedom * core::f64::consts::PI).ln()
        - scale.ln()
        - 0.5 * (freedom + 1.0) * (x / scale).powi(2).mul_add(freedom.recip(), 1.0).ln()
}
