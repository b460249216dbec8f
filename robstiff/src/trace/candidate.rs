//! The catalogue: every effect at every place it can be, as columns of the
//! regression.

use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use robstiff_robots::Description;

use crate::identify::baseline::{columns_of, set_parameter};
use crate::identify::samples::{Column, Samples};
use crate::{Effect, JointKind};

/// The knees tried for a stiffness that changes with torque, as fractions of
/// the largest torque seen on the joint. A knee above it bends too little to
/// be told from a joint. The first is a sentinel: where it fits best, the change
/// is over before the loads begin, which is a step at zero torque (lost motion)
/// and no stiffness that changes.
const KNEES: [f64; 6] = [1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0, 1.0];

/// An effect that may be missing. What it is made of can be there in part (a
/// link that bends but does not twist) or with one of several knees; these are
/// its variants, and it is one candidate with the best of them.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The effect, its numbers zero.
    pub effect: Effect,
    /// Its variants.
    pub variants: Vec<Variant>,
}

/// The columns of one way a candidate can be there.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// The columns in the problem.
    pub columns: Vec<usize>,
    /// How many numbers it takes, a knee counting as one.
    pub parameters: usize,
    /// Whether it stands for something that the candidate is not: where it
    /// fits best, the candidate is none.
    pub sentinel: bool,
}

impl Candidate {
    /// The full name, `kind@at`.
    pub fn name(&self) -> String {
        self.effect.to_string()
    }
}

/// What may be missing from a description, and the columns it needs; these
/// follow `first` columns of the description's own.
pub fn catalogue(description: &Description, samples: &Samples, first: usize) -> (Vec<Candidate>, Vec<Column>) {
    let mut columns: Vec<Column> = Vec::new();
    let mut candidates = Vec::new();
    for effect in effects(samples) {
        let declared = |other: &Effect| other.kind() == effect.kind() && other.place() == effect.place();
        if description.effects.iter().any(declared) {
            continue;
        }
        let own = match effect {
            Effect::StiffnessNonlinearity { joint, .. } => knees(samples, joint),
            _ => columns_of(&effect).into_iter().map(|(column, _)| column).collect(),
        };
        let start = first + columns.len();
        let single = |parameters| {
            move |k: usize| Variant { columns: vec![start + k], parameters, sentinel: parameters > 1 && k == 0 }
        };
        let variants = match (&effect, own.len()) {
            (Effect::StiffnessNonlinearity { .. }, count) => (0..count).map(single(2)).collect(),
            (_, 2) => {
                let both = Variant { columns: vec![start, start + 1], parameters: 2, sentinel: false };
                (0..2).map(single(1)).chain([both]).collect()
            }
            (_, count) => (0..count).map(single(1)).collect(),
        };
        columns.extend(own);
        candidates.push(Candidate { effect, variants });
    }
    (candidates, columns)
}

/// Every effect at every place it can be on a robot. Of exact aliases the first
/// is named: a translation common to all poses is sooner the tool's than the
/// base's, a tilt of the foundation sooner that than joint 1's bearing, and one
/// compliance at a joint is simpler than a beam.
fn effects(samples: &Samples) -> Vec<Effect> {
    let joints = samples.joints();
    let revolute = |joint: usize| samples.joint_kinds[joint - 1] == JointKind::Revolute;
    let mut effects = vec![
        Effect::ToolCompliance { rotation: 0.0, translation: 0.0 },
        Effect::BaseCompliance { tilt: 0.0, translation: 0.0 },
    ];
    effects.extend((1..=joints).map(|joint| Effect::TransverseCompliance { joint, value: 0.0 }));
    effects.extend((1..joints).map(|link| Effect::LinkCompliance { link, bending: 0.0, torsion: 0.0 }));
    for j in 2..=joints {
        let pairs = (1..j).filter(|&i| revolute(i) && revolute(j) && share_a_drive(samples, i, j));
        effects.extend(pairs.map(|i| Effect::JointCoupling { joints: [i, j], value: 0.0 }));
    }
    effects.extend((1..=joints).map(|joint| Effect::StiffnessNonlinearity { joint, added: 0.0, knee: 1.0 }));
    effects
}

/// The first joint of a wrist, on arms that have one.
const WRIST: usize = 4;

/// Whether two joints can have a belt, rod or gear in common: neighbours with
/// parallel axes (a parallelogram, a drive further down) and the joints of a
/// wrist, whose shafts run in one another. Other pairs have no part through
/// which one could turn the other, and would only be names for something else.
fn share_a_drive(samples: &Samples, i: usize, j: usize) -> bool {
    let axis = |joint: usize| samples.rows[0].joint_frames[joint - 1].fixed_view::<3, 1>(0, 2).into_owned();
    let parallel = axis(i).cross(&axis(j)).norm() < PARALLEL;
    (j == i + 1 && parallel) || i >= WRIST
}

/// Axes within this angle are parallel (rad); description angles are exact.
const PARALLEL: f64 = 1e-6;

fn knees(samples: &Samples, joint: usize) -> Vec<Column> {
    let largest = samples.torques(joint).into_iter().map(f64::abs).fold(0.0, f64::max);
    if largest == 0.0 {
        return Vec::new();
    }
    KNEES.iter().map(|fraction| Column::Knee { joint, knee: fraction * largest }).collect()
}

/// The effect of a candidate with the numbers that were found.
pub fn with_numbers(effect: &Effect, numbers: &[(Column, f64)]) -> Effect {
    let mut effect = *effect;
    for &(column, number) in numbers {
        set_parameter(&mut effect, column, number);
    }
    effect
}
