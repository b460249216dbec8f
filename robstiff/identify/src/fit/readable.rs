//! Numbers that a description takes: noise can take a fit beyond them, a coupling beyond what leaves `H_q`
//! positive definite, a softening beyond the compliance that it takes from. A description with such numbers
//! could not be read back.

use robstiff_robots::Description;

use robstiff::Effect;

/// The largest share of what would leave a joint without compliance that is kept.
const NEXT_TO: f64 = 0.999;

/// Halvings in the search for a share.
const HALVINGS: usize = 30;

/// Whether a description can be read back.
pub fn is_readable(description: &Description) -> bool {
    Description::parse("", &description.to_yaml()).is_ok()
}

/// How much of each effect's numbers a description takes beside those before it; `None` where it takes one of
/// them at no size.
pub fn shares(description: &Description) -> Option<Vec<f64>> {
    let mut known = Description { effects: Vec::new(), ..description.clone() };
    if !is_readable(&known) {
        return None;
    }
    let mut shares = Vec::new();
    for effect in &description.effects {
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
            if low == 0.0 {
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
        _ => {}
    }
    scaled
}
