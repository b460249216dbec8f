//! What encoders read under load: those of the motors what the controller lets
//! through, those on the output side of the gears by how much each joint turns.
//!
//! *Motors* (`m1` .. `mn`). What they turn by is no deflection: `J (m - q)` is
//! taken from the displacements, and `m - q` from what the encoders behind the
//! gears read. Where a visit has rows without a load, the motors' angles there
//! are where the controller holds them, not `q`.
//!
//! *Output side* (`j1` .. `jn`). What is left, `j - m` or `j - q`, is what gears
//! give way by, and further readings of the same campaign: they follow those of
//! displacement in every stacked vector, a number a row and joint. A joint's
//! compliance shows there as its torque, a coupling as that of the other joint,
//! and so does each curve of a gear; a bearing that tilts, a link, the base and
//! the tool show nothing. A model has to agree with both, which is what tells a
//! gear from the rest.

use crate::campaign::{Displacements, Observation};

/// A row whose wrench is below this share of the largest of its visit carries no
/// load.
const UNLOADED: f64 = 0.01;

/// An encoder that differs from the motor by less than this at every row copies
/// it (rad or m).
const COPIED: f64 = 1e-12;

/// What the encoders of a campaign read.
#[derive(Clone, Debug, Default)]
pub struct Encoders {
    /// The joints (from 1) whose output angle is read.
    pub joints: Vec<usize>,
    /// By row of the campaign and one of these, by how much the joint has turned
    /// beyond its motor (rad or m).
    pub turned: Vec<Vec<f64>>,
    /// By row and joint, by how much the motor has turned (rad or m); empty where
    /// it is not read.
    pub given: Vec<Vec<f64>>,
}

impl Encoders {
    /// Encoders of all of so many joints that have not turned, at so many rows.
    pub fn of_all(joints: usize, rows: usize) -> Self {
        Self { joints: (1..=joints).collect(), turned: vec![vec![0.0; joints]; rows], given: Vec::new() }
    }

    /// The encoders of some rows.
    pub fn of(data: &Displacements) -> Self {
        let given = given(data).unwrap_or_default();
        let output: Option<Vec<&[f64]>> = data.rows.iter().map(|row| row.encoders.as_deref()).collect();
        let Some(output) = output.filter(|_| !data.rows.is_empty()) else {
            return Self { given, ..Self::default() };
        };
        let beyond = |row: usize, joint: usize| {
            let motor = given.get(row).map_or(0.0, |given: &Vec<f64>| given[joint]);
            output[row][joint] - data.rows[row].q[joint] - motor
        };
        let reads = |joint: &usize| (0..output.len()).any(|row| beyond(row, *joint).abs() > COPIED);
        let joints: Vec<usize> = (0..data.rows[0].q.len()).filter(reads).collect();
        let turned = (0..output.len()).map(|row| joints.iter().map(|&joint| beyond(row, joint)).collect()).collect();
        Self { joints: joints.into_iter().map(|joint| joint + 1).collect(), turned, given }
    }
}

/// By how much each motor has turned, where that is read.
fn given(data: &Displacements) -> Option<Vec<Vec<f64>>> {
    let motors: Vec<&[f64]> = data.rows.iter().map(|row| row.motors.as_deref()).collect::<Option<_>>()?;
    let size = |row: &Observation| row.wrench.iter().map(|w| w * w).sum::<f64>().sqrt();
    let mut largest = vec![0.0_f64; data.visits.len()];
    data.rows.iter().for_each(|row| largest[row.visit] = largest[row.visit].max(size(row)));
    // By visit, the sums over rows without a load and their number.
    let mut still = vec![(Vec::new(), 0.0); data.visits.len()];
    for (row, motors) in data.rows.iter().zip(&motors) {
        if size(row) <= UNLOADED * largest[row.visit] {
            let (sums, count): &mut (Vec<f64>, f64) = &mut still[row.visit];
            sums.resize(motors.len(), 0.0);
            sums.iter_mut().zip(*motors).zip(&row.q).for_each(|((sum, m), q)| *sum += m - q);
            *count += 1.0;
        }
    }
    let of_row = |(row, motors): (&Observation, &&[f64])| -> Vec<f64> {
        let (sums, count) = &still[row.visit];
        let held = |joint: usize| sums.get(joint).map_or(0.0, |sum| sum / count);
        motors.iter().zip(&row.q).enumerate().map(|(joint, (m, q))| m - q - held(joint)).collect()
    };
    Some(data.rows.iter().zip(&motors).map(of_row).collect())
}
