//! The model a description already has, as columns of a regression: its joint
//! compliances and the effects it declares.

use std::vec::Vec;

use nalgebra::DVector;
use robstiff_robots::{Description, Part};

use super::column::Column;
use super::normal::{Normal, Sign, independent};
use robstiff::Effect;
use robstiff::elements::{Spring, springs};

/// One number of a description that measurements can change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Declared {
    /// Its column.
    pub column: Column,
    /// The value the description gives.
    pub value: f64,
    /// What values it may take.
    pub sign: Sign,
    /// The effect it belongs to, by index; a joint's own compliance has none.
    pub effect: Option<usize>,
}

/// The numbers of a description: the joints' compliances in order, then those
/// of its effects.
pub fn declared(description: &Description) -> Vec<Declared> {
    let joints = description.joints.iter().enumerate().map(|(i, joint)| Declared {
        column: Column::Spring(Spring::Joint(i + 1)),
        value: joint.compliance(),
        sign: Sign::Nonnegative,
        effect: None,
    });
    let effects = description.effects.iter().enumerate().flat_map(|(index, effect)| {
        columns_of(effect).into_iter().map(move |(column, value)| Declared {
            column,
            value,
            sign: sign_of(column),
            effect: Some(index),
        })
    });
    joints.chain(effects).collect()
}

/// The columns of an effect and its values: of what gives way, all but a share of a
/// joint's compliance, which is in the joint's own column.
pub fn columns_of(effect: &Effect) -> Vec<(Column, f64)> {
    match *effect {
        Effect::StiffnessNonlinearity { joint, added, knee } => std::vec![(Column::Knee { joint, knee }, added)],
        Effect::LostMotion { joint, gap, knee } => std::vec![(Column::Gap { joint, knee }, gap)],
        Effect::Hysteresis { joint, radius1, weight1, radius2, weight2, radius3, weight3 } => {
            let operators = [(radius1, weight1), (radius2, weight2), (radius3, weight3)].into_iter().enumerate();
            let in_use = operators.filter(|(_, (_, weight))| *weight != 0.0);
            in_use.map(|(operator, (radius, weight))| (Column::Play { joint, operator, radius }, weight)).collect()
        }
        _ => springs(effect).map(|(spring, value)| (Column::Spring(spring), value)).collect(),
    }
}

/// Compliances and play are not negative; a coupling and a change with torque can be.
pub fn sign_of(column: Column) -> Sign {
    match column {
        Column::Spring(Spring::Coupling(_)) | Column::Knee { .. } => Sign::Free,
        Column::Spring(_) | Column::Gap { .. } | Column::Play { .. } => Sign::Nonnegative,
    }
}

/// What a campaign can say about a number.
#[derive(Clone, Debug, PartialEq)]
pub enum Visibility {
    /// It was identified.
    Seen,
    /// Its displacement is lost in the noise, or zero; it kept its value.
    Unseen,
    /// The readings are a sum with those of other numbers (by index); it kept
    /// its value and they took up the rest.
    Confounded(Vec<usize>),
}

/// A column whose readings are this small against the largest is zero but for rounding.
const ZERO_COLUMN: f64 = 1e-7;

/// Which of the first `count` columns of a regression, those of the description,
/// the campaign can see at all, by the geometry of poses and loads.
pub fn visibility(total: &Normal, count: usize) -> Vec<Visibility> {
    let gram = &total.gram;
    let columns: Vec<usize> = (0..count).collect();
    let largest = columns.iter().map(|&i| gram[(i, i)]).fold(0.0, f64::max);
    let (kept, _) = independent(gram, &columns, largest * ZERO_COLUMN * ZERO_COLUMN);
    columns
        .iter()
        .map(|&i| match (kept.contains(&i), gram[(i, i)] > largest * ZERO_COLUMN * ZERO_COLUMN) {
            (true, _) => Visibility::Seen,
            (false, false) => Visibility::Unseen,
            (false, true) => Visibility::Confounded(parts_of(total, i, &kept)),
        })
        .collect()
}

/// The columns whose sum another column is.
fn parts_of(normal: &Normal, column: usize, kept: &[usize]) -> Vec<usize> {
    let Some(inverse) = normal.inverse(kept) else { return Vec::new() };
    let along = DVector::from_fn(kept.len(), |k, _| normal.gram[(kept[k], column)]);
    let shares = inverse * along;
    let size = |k: usize| shares[k] * shares[k] * normal.gram[(kept[k], kept[k])];
    let whole = normal.gram[(column, column)];
    (0..kept.len()).filter(|&k| size(k) > PART_OF_A_SUM * whole).map(|k| kept[k]).collect()
}

/// A column contributes to another when its part of the energy is more than
/// this.
const PART_OF_A_SUM: f64 = 1e-6;

/// A description with other values of its numbers, in the order of
/// [`declared`].
pub fn with_values(description: &Description, values: &[f64]) -> Description {
    let mut changed = description.clone();
    declared(description).iter().zip(values).for_each(|(number, &value)| number.set(&mut changed, value));
    changed
}

impl Declared {
    /// Gives a description another value of it. The parts of a compound joint keep their
    /// proportion: the measurement sees their sum.
    pub fn set(&self, description: &mut Description, value: f64) {
        match (self.effect, self.column) {
            (None, Column::Spring(Spring::Joint(joint))) => {
                set_compliance(&mut description.joints[joint - 1].compliance, value);
            }
            (Some(effect), column) => set_parameter(&mut description.effects[effect], column, value),
            (None, _) => unreachable!("only joints' own compliances belong to no effect"),
        }
    }
}

/// Sets the compliance of a joint; of a compound one the parts keep their
/// proportion.
pub fn set_compliance(parts: &mut Vec<Part>, value: f64) {
    let sum: f64 = parts.iter().map(|part| part.value).sum();
    if parts.is_empty() {
        parts.push(Part { name: std::string::String::new(), value });
    } else if sum > 0.0 {
        parts.iter_mut().for_each(|part| part.value *= value / sum);
    } else {
        let count = parts.len() as f64;
        parts.iter_mut().for_each(|part| part.value = value / count);
    }
}

/// Sets the parameter of an effect that a column belongs to.
pub fn set_parameter(effect: &mut Effect, column: Column, number: f64) {
    match (effect, column) {
        (Effect::TransverseCompliance { value, .. }, _) | (Effect::JointCoupling { value, .. }, _) => *value = number,
        (Effect::LinkCompliance { bending, .. }, Column::Spring(Spring::LinkBending(_))) => *bending = number,
        (Effect::LinkCompliance { torsion, .. }, _) => *torsion = number,
        (Effect::BaseCompliance { tilt, .. }, Column::Spring(Spring::BaseTilt)) => *tilt = number,
        (Effect::BaseCompliance { translation, .. }, _) => *translation = number,
        (Effect::ToolCompliance { rotation, .. }, Column::Spring(Spring::ToolRotation)) => *rotation = number,
        (Effect::ToolCompliance { translation, .. }, _) => *translation = number,
        (Effect::StiffnessNonlinearity { added, knee, .. }, column) => {
            *added = number;
            if let Column::Knee { knee: at, .. } = column {
                *knee = at;
            }
        }
        (Effect::LostMotion { gap, .. }, _) => *gap = number,
        (Effect::Hysteresis { weight1, weight2, weight3, .. }, Column::Play { operator, .. }) => {
            *[weight1, weight2, weight3][operator] = number;
        }
        (effect, column) => unreachable!("{effect} has no column {column:?}"),
    }
}
