//! Numbers that a description takes: noise can take a fit beyond them, a coupling
//! beyond what leaves `H_q` positive definite, a softening beyond the compliance
//! that it takes from. A description with such numbers could not be read back.

use std::vec::Vec;

use robstiff_robots::Description;
use robstiff_robots::effect::Place;

use super::normal::{Fit, Normal, Sign, Tie};
use robstiff::Effect;

/// The largest share of what would leave a joint without compliance that is kept.
const NEXT_TO: f64 = 0.999;

/// Halvings in the search for a share.
const HALVINGS: usize = 30;

/// Times that the rest is fitted again: bounds that are no more than tangents move by
/// less each time.
const PASSES: usize = 12;

/// Whether a description can be read back.
pub fn is_readable(description: &Description) -> bool {
    Description::parse("", &description.to_yaml()).is_ok()
}

/// Least squares with signs of some columns, the first of which are the joints' own
/// compliances, with effects held next to the largest numbers that a description
/// takes. `description` is that of a fit and tells of each effect in it the places of
/// its numbers among the columns. `None` where no numbers of these do.
pub fn readable(
    total: &Normal,
    fit: &Fit,
    signs: &[Sign],
    description: impl Fn(&Fit) -> (Description, Vec<Vec<usize>>),
) -> Option<Fit> {
    let mut fit = fit.clone();
    let mut ties: Vec<Option<Tie>> = std::vec![None; fit.columns.len()];
    for _ in 0..PASSES {
        let (found, places) = description(&fit);
        if is_readable(&found) {
            return Some(fit);
        }
        let shares = shares(&found, &places)?;
        for (effect, (share, places)) in found.effects.iter().zip(shares.iter().zip(&places)) {
            if *share < 1.0 {
                for &k in places {
                    ties[k] = Some(tie(&found, effect, share * fit.coefficients[k], &fit.columns)?);
                }
            }
        }
        fit = total.solve_tied(&fit.columns, signs, &ties)?;
    }
    None
}

/// What holds a number of an effect at a bound that moves with the compliances of its
/// joints, to the first order where it is not in proportion: `sqrt(h_i h_j)`.
fn tie(description: &Description, effect: &Effect, at: f64, columns: &[usize]) -> Option<Tie> {
    let joints = match effect.place() {
        Place::Joint(joint) => std::vec![joint],
        Place::Joints(joints) => joints.to_vec(),
        _ => return None,
    };
    let mut tie = Tie::default();
    for joint in &joints {
        let own = description.joints[joint - 1].compliance();
        let part = at / joints.len() as f64;
        match columns.iter().position(|&column| column == joint - 1) {
            Some(place) if own > 0.0 => tie.to.push((place, part / own)),
            _ => tie.constant += part,
        }
    }
    Some(tie)
}

/// How much of each effect's numbers a description takes beside those before it; `None`
/// where it takes one of them at no size.
fn shares(description: &Description, places: &[Vec<usize>]) -> Option<Vec<f64>> {
    let mut known = Description { effects: Vec::new(), ..description.clone() };
    if !is_readable(&known) {
        return None;
    }
    let mut shares = Vec::new();
    for (effect, places) in description.effects.iter().zip(places) {
        let with = |share: f64| {
            let mut with = known.clone();
            with.effects.push(scaled(effect, share));
            with
        };
        let mut share = 1.0;
        if !is_readable(&with(1.0)) {
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if is_readable(&with(middle)) { low = middle } else { high = middle }
            }
            share = NEXT_TO * low;
            if low == 0.0 || places.is_empty() {
                return None;
            }
        }
        known = with(share);
        shares.push(share);
    }
    Some(shares)
}

/// An effect with so much of the numbers that a fit gives it.
fn scaled(effect: &Effect, share: f64) -> Effect {
    let mut scaled = *effect;
    match &mut scaled {
        Effect::JointCoupling { value, .. } => *value *= share,
        Effect::StiffnessNonlinearity { added, .. } => *added *= share,
        Effect::PoseDependentCompliance { cos1, sin1, cos2, sin2, .. } => {
            [cos1, sin1, cos2, sin2].into_iter().for_each(|number| *number *= share);
        }
        _ => {}
    }
    scaled
}
