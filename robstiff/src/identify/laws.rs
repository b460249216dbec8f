//! What the laws of joints do that a description declares and no column fits:
//! hysteresis. A compliance that varies with the angle is in its joint's column.

use std::collections::BTreeMap;
use std::vec::Vec;

use nalgebra::{DVector, Vector6};
use robstiff_robots::Description;
use robstiff_robots::effect::physics::PLAYS;

use super::baseline::columns_of;
use super::samples::{Sample, Samples, is_share};
use crate::elements::{plays, turn};

/// The displacement of the marker (m), and rotation (rad), through them;
/// stacked like [`Samples::readings`]. The rows of a visit are one load
/// sequence, which begins on a robot that was never loaded.
pub fn turned_by_laws(description: &Description, samples: &Samples) -> DVector<f64> {
    let laws = description.effects.iter().filter(|effect| columns_of(effect).is_empty() && !is_share(effect));
    let laws: Vec<_> = laws.filter_map(|effect| Some((effect, effect.row()? - 1))).collect();
    if laws.is_empty() {
        return DVector::zeros(samples.length());
    }
    let mut states: BTreeMap<usize, Vec<[f64; PLAYS]>> = BTreeMap::new();
    let turns = samples.rows.iter().map(|row| {
        let state = states.entry(row.visit).or_insert_with(|| std::vec![[0.0; PLAYS]; samples.joints()]);
        let mut turns = std::vec![0.0; samples.joints()];
        for &(effect, joint) in &laws {
            let twist = row.twists[joint];
            let torque = twist.dot(&row.wrench);
            state[joint] = plays(effect, torque, state[joint]);
            let own = description.joints[joint].compliance();
            turns[joint] += turn(effect, own, row.q[joint], torque, state[joint]).unwrap_or(0.0);
        }
        turns
    });
    let turns: Vec<Vec<f64>> = turns.collect();
    let by_all = |at: usize, row: &Sample| -> Vector6<f64> {
        row.twists.iter().zip(&turns[at]).map(|(twist, turn)| twist * *turn).sum()
    };
    samples.stacked_with(|at, row| row.read(&by_all(at, row)), |at, k| turns[at][samples.encoders[k] - 1])
}
