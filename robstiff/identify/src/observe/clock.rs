//! When and where rows were read.

use nalgebra::Vector3;

/// When and where the rows were read.
pub(super) struct Clock {
    /// When, from 0 to 1 over the campaign.
    pub time: Vec<f64>,
    /// By how much it is warmer than on average (K).
    pub warmer: Vec<f64>,
    /// The force over the root mean square of all forces.
    pub load: Vec<f64>,
    /// The tool centre point from the middle of all rows, in the base frame (m).
    pub place: Vec<Vector3<f64>>,
}

impl Clock {
    /// From the times (s) and temperatures of all rows, where given.
    pub fn new(times: &[Option<f64>], temperatures: &[Option<f64>]) -> Self {
        let rows = times.len();
        let last = times.iter().flatten().copied().fold(0.0, f64::max);
        let reported = last > 0.0 && times.iter().all(Option::is_some);
        let time = |(row, time): (usize, &Option<f64>)| match time {
            Some(time) if reported => time / last,
            _ => row as f64 / rows.saturating_sub(1).max(1) as f64,
        };
        let known: Vec<f64> = temperatures.iter().flatten().copied().collect();
        let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
        Self {
            time: times.iter().enumerate().map(time).collect(),
            warmer: temperatures.iter().map(|t| t.map_or(0.0, |t| t - mean)).collect(),
            load: vec![0.0; rows],
            place: vec![Vector3::zeros(); rows],
        }
    }
}

/// For how long each row's visit has lasted (s); a minute a row where no time is given.
pub(super) fn in_visit(visit: &[usize], times: &[Option<f64>]) -> Vec<f64> {
    let visits = visit.iter().max().map_or(0, |last| last + 1);
    let (mut began, mut count) = (vec![None; visits], vec![0.0; visits]);
    let row = |(&visit, time): (&usize, &Option<f64>)| {
        let elapsed = match time {
            Some(time) => time - *began[visit].get_or_insert(*time),
            None => 60.0 * count[visit],
        };
        count[visit] += 1.0;
        elapsed.max(0.0)
    };
    visit.iter().zip(times).map(row).collect()
}
