//! What the laws of joints do that a description declares and no column fits:
//! backlash, play, a compliance that varies with the angle.

use std::collections::BTreeMap;
use std::vec::Vec;

use nalgebra::{DVector, Vector6};
use robstiff_robots::Description;
use robstiff_robots::effect::physics::PLAYS;

use super::baseline::columns_of;
use super::samples::Samples;
use crate::elements::{plays, turn};

/// The displacement of the marker (m), and rotation (rad), through them;
/// stacked like [`Samples::readings`]. The rows of a visit are one load
/// sequence, which begins on a robot that was never loaded.
pub fn turned_by_laws(description: &Description, samples: &Samples) -> DVector<f64> {
    let laws = description.effects.iter().filter(|effect| columns_of(effect).is_empty());
    let laws: Vec<_> = laws.filter_map(|effect| Some((effect, effect.row()? - 1))).collect();
    if laws.is_empty() {
        return DVector::zeros(samples.rows.len() * samples.axes);
    }
    let mut states: BTreeMap<usize, Vec<[f64; PLAYS]>> = BTreeMap::new();
    let twists = samples.rows.iter().map(|row| {
        let state = states.entry(row.visit).or_insert_with(|| std::vec![[0.0; PLAYS]; samples.joints()]);
        laws.iter().fold(Vector6::zeros(), |sum, &(effect, joint)| {
            let twist = row.twists[joint];
            let torque = twist.dot(&row.wrench);
            state[joint] = plays(effect, torque, state[joint]);
            let own = description.joints[joint].compliance();
            sum + twist * turn(effect, own, row.q[joint], torque, state[joint]).unwrap_or(0.0)
        })
    });
    let read: Vec<Vector6<f64>> = twists.zip(&samples.rows).map(|(twist, row)| row.read(&twist)).collect();
    DVector::from_iterator(
        samples.rows.len() * samples.axes,
        read.iter().flat_map(|six| six.iter().copied().take(samples.axes)),
    )
}
