//! Products of powers that are to be certain numbers: linear equations in the logarithms,
//! kept as factors, for which a rounding is one of the last place.

use std::collections::BTreeMap;

use crate::op::Id;

/// `product of scale^power = value`, of positive scales.
#[derive(Clone, Debug)]
pub(super) struct Equation {
    powers: BTreeMap<Id, f64>,
    value: f64,
}

impl Equation {
    /// `one = value * product of others`.
    pub fn new(one: Id, value: f64, others: &[Id]) -> Self {
        let mut powers = BTreeMap::from([(one, 1.0)]);
        for &other in others {
            *powers.entry(other).or_default() -= 1.0;
        }
        powers.retain(|_, power| *power != 0.0);
        Self { powers, value }
    }

    /// With one of its scales as another equation says it is.
    fn with(mut self, other: &Solved) -> Self {
        let Some(power) = self.powers.remove(&other.scale) else { return self };
        for (&id, own) in &other.powers {
            *self.powers.entry(id).or_default() += power * own;
        }
        // Powers are small fractions, of which rounding may leave something.
        self.powers.retain(|_, power| power.abs() > 1e-9);
        self.value /= power_of(other.value, power);
        self
    }
}

/// A scale by those that are free: `scale = value * product of scale^power`.
#[derive(Debug)]
struct Solved {
    scale: Id,
    powers: BTreeMap<Id, f64>,
    value: f64,
}

/// Equations that do not contradict each other, each solved for a scale that those after
/// it do not contain.
#[derive(Debug, Default)]
pub(super) struct System {
    solved: Vec<Solved>,
}

impl System {
    /// Demands an equation; false, and without effect, if others contradict it.
    pub fn demand(&mut self, equation: Equation) -> bool {
        let Equation { mut powers, value } = self.solved.iter().fold(equation, Equation::with);
        let Some((&scale, &power)) = powers.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) else {
            return is_one(value);
        };
        powers.remove(&scale);
        powers.values_mut().for_each(|other| *other /= -power);
        self.solved.push(Solved { scale, powers, value: power_of(value, 1.0 / power) });
        true
    }

    /// The scales that are not 1, where those are 1 that may be any.
    pub fn scales(&self) -> BTreeMap<Id, f64> {
        let mut scales = BTreeMap::new();
        for Solved { scale, powers, value } in self.solved.iter().rev() {
            let others = powers.iter().map(|(id, &power)| power_of(scales.get(id).copied().unwrap_or(1.0), power));
            let value = value * others.product::<f64>();
            scales.insert(*scale, value);
        }
        scales.retain(|_, scale| *scale != 1.0);
        scales
    }
}

/// Exact where it can be.
fn power_of(value: f64, power: f64) -> f64 {
    if power == 1.0 {
        value
    } else if power == -1.0 {
        value.recip()
    } else {
        value.powf(power)
    }
}

/// Whether it is 1 but for rounding.
pub(super) fn is_one(value: f64) -> bool {
    (value - 1.0).abs() < ROUNDING
}

/// More than some dozens of products are off, and less than descriptions tell apart.
const ROUNDING: f64 = 1e-14;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_contradicts_is_refused_and_changes_nothing() {
        let mut system = System::default();
        assert!(system.demand(Equation::new(2, 1.0, &[0, 1])));
        assert!(system.demand(Equation::new(3, 1.0, &[2, 2])));
        assert!(system.demand(Equation::new(3, 9.0, &[])));
        assert!(system.demand(Equation::new(2, 3.0, &[])));
        assert!(!system.demand(Equation::new(2, 4.0, &[])));
        assert!(system.demand(Equation::new(0, 6.0, &[])));
        assert_eq!(system.scales(), BTreeMap::from([(0, 6.0), (1, 0.5), (2, 3.0), (3, 9.0)]));
    }

    #[test]
    fn thirds_cancel() {
        let mut system = System::default();
        assert!(system.demand(Equation::new(0, 1.0, &[1, 1, 1, 1])));
        assert!(system.demand(Equation::new(2, 8.0, &[1, 1, 1])));
        assert!(system.demand(Equation::new(2, 1.0, &[0, 0])));
        let scales = system.scales();
        let scale = |id: Id| scales.get(&id).copied().unwrap_or(1.0);
        assert!((scale(0) / scale(1).powi(4) - 1.0).abs() < 1e-14);
        assert!((scale(2) / scale(1).powi(3) - 8.0).abs() < 1e-13);
        assert!((scale(2) / scale(0).powi(2) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn what_may_be_any_is_one() {
        let mut system = System::default();
        assert!(system.demand(Equation::new(4, 2.0, &[7])));
        let scales = system.scales();
        assert!(scales == BTreeMap::from([(4, 2.0)]) || scales == BTreeMap::from([(7, 0.5)]));
    }
}
