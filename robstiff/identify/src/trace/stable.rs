//! What physics says against a model as a whole, and in which words.
//!
//! Each coupling may be weak enough for its two joints, and the joints' compliance matrix `H_q`
//! with all of them still not be positive definite.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::catalogue::JOINT_COUPLING;
use super::model::{Fitted, Named, Setting};
use super::written::plain;
use crate::identify::baseline::{declared, with_values};
use crate::identify::element_name;
use crate::identify::normal::Fit;

impl Setting<'_> {
    /// Holds `H_q` of a fit as a whole against physics, where a coupling is named.
    ///
    /// # Errors
    /// That the couplings are too strong together.
    pub(super) fn check_couplings(&self, fit: &Fit, named: &[Named]) -> Result<(), String> {
        let is_coupling = |one: &Named| self.candidates[one.candidate].kind == &JOINT_COUPLING;
        if !named.iter().any(is_coupling) || self.is_stable(fit, named) {
            return Ok(());
        }
        let is_possible = self.nearer(fit).is_some_and(|nearer| self.is_stable(&nearer, named));
        is_possible.then_some(()).ok_or_else(|| String::from("the couplings would be too strong together"))
    }

    /// That a number of the description would be below zero, by its column.
    pub(super) fn below_zero(&self, column: usize) -> String {
        let number = &declared(self.point.description)[column];
        let name = element_name(self.point.description, number);
        match number.effect {
            None => format!("{name} would have a negative compliance"),
            Some(_) => format!("{name} would be negative"),
        }
    }

    /// Whether a description with the numbers of a fit is one that loads do no negative work on.
    fn is_stable(&self, fit: &Fit, named: &[Named]) -> bool {
        let description = self.point.description;
        let mut values: Vec<f64> = declared(description).iter().map(|number| number.value).collect();
        values[..self.joint_values.len()].copy_from_slice(&self.joint_values);
        for (&column, &value) in fit.columns.iter().zip(fit.coefficients.iter()) {
            if let Some(own) = values.get_mut(column) {
                *own = value;
            }
        }
        let model = Fitted { named: named.to_vec(), fit: fit.clone(), bic: f64::INFINITY, physical: false };
        let mut with = with_values(description, &values);
        with.effects.extend(named.iter().filter_map(|&one| plain(self, &model, one).effect()));
        with.is_stable()
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use robstiff_robots::{Description, catalogue};

    use crate::campaign::made::Plan;
    use crate::identify::prepare::Prepared;
    use crate::trace::bench::Bench;
    use crate::trace::model::Named;

    /// Two couplings of one joint, each weak enough for its two joints.
    #[test]
    fn couplings_are_possible_together_or_not() {
        let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
        let mut robot = Description::parse("robot.yaml", text).expect("of the catalogue");
        // Beside the axis of joint 6, so that it is loaded.
        robot.tool.xyz[0] += 0.2;
        // So little noise that it leaves no room beyond what is possible.
        let campaign = Plan { robot, noise: [1e-7; 3], ..Plan::new(1) }.run();
        let prepared = Prepared::new(&campaign).expect("displacements");
        let bench = Bench::new(&campaign, &prepared).expect("every joint is seen");
        let setting = bench.at(&[]).expect("no effects");
        let named = |name: &str| {
            let candidate = bench.candidates().iter().position(|candidate| candidate.name() == name);
            Named { candidate: candidate.expect("in the catalogue"), variant: 0 }
        };
        let (first, second) = (named("joint_coupling@joints 4,5"), named("joint_coupling@joints 5,6"));
        let is_possible = |of: &[(Named, [usize; 2])], share: f64| {
            let mut model: Vec<Named> = of.iter().map(|(one, _)| *one).collect();
            model.sort_unstable();
            let mut fit = setting.fit_loosely(&model).expect("the poses tell them apart").fit;
            for (one, [i, j]) in of {
                let at = fit.columns.iter().position(|column| *column == setting.variant(*one).columns[0]);
                let bound = (setting.joint_value(&fit, *i) * setting.joint_value(&fit, *j)).sqrt();
                fit.coefficients[at.expect("its own model has it")] = share * bound;
            }
            setting.judge(&model, fit).is_ok()
        };
        let (first, second) = ((first, [4, 5]), (second, [5, 6]));
        assert!(is_possible(&[first], 0.8) && is_possible(&[second], 0.8));
        assert!(is_possible(&[first, second], 0.6));
        assert!(!is_possible(&[first, second], 0.8));
    }
}
