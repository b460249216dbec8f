//! That the effects of a description leave its joints' compliance positive.

use crate::description::{Description, Joint};
use crate::document::Node;
use crate::effect::{Effect, Place};

/// `H_q`, scaled to a diagonal of ones, that is as near to singular as this counts as
/// singular: on which side of it such a matrix is, rounding decides.
const ROUNDING: f64 = 1e-12;

impl Description {
    /// Whether a load can do no negative work on the robot: the joints' compliance matrix `H_q`
    /// with all couplings in it is positive definite, its diagonal what the effects of each joint
    /// leave of its compliance at the least.
    pub fn is_stable(&self) -> bool {
        let mut least: Vec<f64> = self.joints.iter().map(Joint::compliance).collect();
        for effect in &self.effects {
            if let Place::Joint(joint) = effect.place() {
                least[joint - 1] += effect.least(self.joints[joint - 1].compliance());
            }
        }
        let mut scaled = uncoupled(least.len());
        let fits = |effect: &Effect| match effect {
            Effect::JointCoupling { joints, value } => couple(&mut scaled, *joints, *value, bound(&least, *joints)),
            _ => true,
        };
        self.effects.iter().all(fits) && is_positive_definite(&mut scaled)
    }
}

/// `H_q` of joints that are not coupled, scaled to a diagonal of ones, so that no product
/// underflows.
fn uncoupled(count: usize) -> Vec<Vec<f64>> {
    (0..count).map(|i| (0..count).map(|j| f64::from(u8::from(i == j))).collect()).collect()
}

/// What a coupling of two joints must stay below (rad/Nm), by what is left of their compliances.
fn bound(least: &[f64], [i, j]: [usize; 2]) -> f64 {
    least[i - 1].max(0.0).sqrt() * least[j - 1].max(0.0).sqrt()
}

/// Puts a coupling into a scaled `H_q`; whether it is below its bound.
fn couple(scaled: &mut [Vec<f64>], [i, j]: [usize; 2], value: f64, bound: f64) -> bool {
    let fits = value.abs() < bound * (1.0 - ROUNDING);
    if fits {
        scaled[j - 1][i - 1] = value / bound;
    }
    fits
}

/// What is left of each joint's compliance where all its effects together take
/// away the most; each by itself has been checked.
fn least_compliances(items: &[Node], effects: &[Option<Effect>], joints: &[Joint]) -> Vec<f64> {
    let mut least: Vec<f64> = joints.iter().map(Joint::compliance).collect();
    for (item, effect) in items.iter().zip(effects) {
        let Some((effect, Place::Joint(joint))) = effect.as_ref().map(|effect| (effect, effect.place())) else {
            continue;
        };
        let taken = effect.least(joints[joint - 1].compliance());
        least[joint - 1] += taken;
        if taken < 0.0 && least[joint - 1] <= 0.0 {
            item.error(
                format!("with the effects before, joint {joint} would have no compliance left"),
                "weaken one of them: together they must leave the joint's compliance positive",
            );
        }
    }
    least
}

/// That the joints' compliance matrix `H_q` with all couplings in it is
/// positive definite: a load can do no negative work on the robot. The diagonal
/// is the joints' least compliance over all torques.
pub(super) fn check_couplings(items: &[Node], effects: &[Option<Effect>], joints: &[Joint]) {
    let least = least_compliances(items, effects, joints);
    let mut scaled = uncoupled(joints.len());
    let mut last = None;
    let mut all_fit = true;
    for (item, effect) in items.iter().zip(effects) {
        let Some(Effect::JointCoupling { joints: pair, value }) = effect else { continue };
        let [i, j] = *pair;
        let bound = bound(&least, *pair);
        if couple(&mut scaled, *pair, *value, bound) {
            last = Some(item);
            continue;
        }
        all_fit = false;
        let own = |joint: usize| joints[joint - 1].compliance();
        let (message, help) = if let Some(rigid) = pair.iter().find(|&&joint| own(joint) == 0.0) {
            (format!("joint {rigid} is rigid, and what does not yield cannot be coupled"), "leave the coupling out")
        } else if bound == 0.0 {
            // What takes all of a compliance has been reported.
            continue;
        } else {
            let is_taken = pair.iter().any(|&joint| least[joint - 1] < own(joint));
            let of = if is_taken { ", of what the effects leave of the two compliances" } else { "" };
            let most = format!("sqrt(h_{i} h_{j}) = {bound:.3e} rad/Nm{of}");
            (format!("the coupling must be weaker than {most}"), "else a load could do negative work")
        };
        let field = item.any_map("").and_then(|map| map.get("value"));
        field.as_ref().unwrap_or(item).error(message, help);
    }
    if let (Some(last), true) = (last, all_fit && !is_positive_definite(&mut scaled)) {
        last.error(
            "the couplings are too strong together: the joints' compliance matrix is not positive definite",
            "weaken one of them, else a load could do negative work",
        );
    }
}

/// Cholesky decomposition in place, of the lower triangle.
fn is_positive_definite(matrix: &mut [Vec<f64>]) -> bool {
    for i in 0..matrix.len() {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let rest = matrix[i][j] - sum;
            if i == j && rest <= ROUNDING {
                return false;
            }
            matrix[i][j] = if i == j { rest.sqrt() } else { rest / matrix[j][j] };
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_is_positive_definite_or_not() {
        let mut weak = vec![vec![1.0], vec![0.7, 1.0], vec![0.7, 0.7, 1.0]];
        assert!(is_positive_definite(&mut weak));
        let mut strong = vec![vec![1.0], vec![0.7, 1.0], vec![0.7, -0.7, 1.0]];
        assert!(!is_positive_definite(&mut strong));
        let mut singular = vec![vec![1.0], vec![0.8, 1.0], vec![0.6, 0.0, 1.0]];
        assert!(!is_positive_definite(&mut singular));
    }
}
