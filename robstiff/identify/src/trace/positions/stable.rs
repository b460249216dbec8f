//! That the couplings of a model of positions are possible together.

use nalgebra::DVector;

use super::bench::Bench;
use super::written::of_numbers;
use crate::identify::positions::regression::STANDS;
use crate::trace::catalogue::JOINT_COUPLING;
use crate::trace::model::Named;

impl Bench<'_> {
    /// Whether a load can do no negative work on the robot of a model in which a coupling is
    /// named, by the coefficients of its fit.
    pub(super) fn is_stable(&self, named: &[Named], coefficients: &DVector<f64>) -> bool {
        if !named.iter().any(|one| self.candidates[one.candidate].kind == &JOINT_COUPLING) {
            return true;
        }
        let mut with = self.prepared.start.description.clone();
        let chosen = self.chosen(named);
        let value = |number: usize| {
            let at = chosen.iter().position(|&of| of == number);
            at.map_or(0.0, |at| coefficients[STANDS + at])
        };
        for number in self.prepared.seen() {
            self.prepared.own[number].set(&mut with, value(number));
        }
        with.effects.extend(named.iter().filter_map(|&one| of_numbers(self, one, value).effect()));
        with.is_stable()
    }
}

#[cfg(test)]
mod tests {
    use std::vec;
    use std::vec::Vec;

    use super::*;
    use crate::campaign::Data;
    use crate::campaign::made_positions::Plan;
    use crate::trace::positions::tests::six_axis;

    /// Two couplings of one joint, each weak enough for its two joints.
    #[test]
    fn couplings_are_possible_together_or_not() {
        let mut robot = six_axis();
        // Beside the axis of joint 6, so that it is loaded.
        robot.tool.xyz[0] += 0.2;
        let campaign = Plan { payloads: vec![0.0, 250.0], ..Plan::new(robot, 1) }.run();
        let Data::Position(data) = &campaign.data else { unreachable!("made of positions") };
        let bench = Bench::new(&campaign, data).expect("they tell where the robot stands");
        let named = |name: &str| {
            let candidate = bench.candidates.iter().position(|candidate| candidate.name() == name);
            Named { candidate: candidate.expect("in the catalogue"), variant: 0 }
        };
        let (first, second) = (named("joint_coupling@joints 4,5"), named("joint_coupling@joints 5,6"));
        let declared = |joint: usize| bench.prepared.own[joint - 1].value;
        let seen = bench.prepared.seen();
        let is_possible = |of: &[(Named, [usize; 2])], share: f64| {
            let own = seen.iter().map(|&number| bench.prepared.own[number].value);
            let couplings = of.iter().map(|&(_, [i, j])| share * (declared(i) * declared(j)).sqrt());
            let coefficients: Vec<f64> = core::iter::repeat_n(0.0, STANDS).chain(own).chain(couplings).collect();
            let model: Vec<Named> = of.iter().map(|(one, _)| *one).collect();
            bench.is_physical(&model, &DVector::from_vec(coefficients))
        };
        let (first, second) = ((first, [4, 5]), (second, [5, 6]));
        assert!(is_possible(&[first], 0.8) && is_possible(&[second], 0.8) && !is_possible(&[second], 1.1));
        assert!(is_possible(&[first, second], 0.6));
        assert!(!is_possible(&[first, second], 0.8));
    }
}
