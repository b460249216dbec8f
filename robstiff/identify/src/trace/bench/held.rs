//! Which of the description's numbers are held, where nothing but residuals tells the noise.
//!
//! A joint that moves the readings by less than their noise is held as declared, for its
//! estimate would be made of noise. Where the noise is what a model leaves, that must be a
//! model which lacks nothing: a wild row or a missing effect makes the noise look larger, and
//! a joint that is held for it though it shows leaves structure of its own, which effects get
//! named for. So joints in doubt are fitted while effects are searched for, and those that
//! are lost in what the model leaves in the end are held again.

use std::cell::OnceCell;
use std::string::String;
use std::vec::Vec;

use super::Bench;
use crate::identify::normal::{Fit, Sign};
use crate::identify::uncertainty::covariance;
use crate::identify::untold::untold;
use crate::trace::model::{Named, Setting};

impl Bench<'_> {
    /// Fits also the numbers whose [loss in the noise](crate::identify::prepare::Prepared::doubted)
    /// is in doubt; whether there are any.
    ///
    /// # Errors
    /// Why the description's own model cannot be fitted with them.
    pub fn fit_doubted(&mut self) -> Result<bool, String> {
        let doubted = &self.prepared.doubted;
        if doubted.is_empty() {
            return Ok(false);
        }
        let all = 0..self.own.len();
        let base: Vec<usize> = all.filter(|column| self.base.contains(column) || doubted.contains(column)).collect();
        self.fit_to(&base);
        self.set_up()?;
        Ok(true)
    }

    /// Holds those of them that are lost in what a model leaves, and any of the description's
    /// numbers that it does [not tell](untold) from what was declared; whether there are any.
    ///
    /// # Errors
    /// Why the model cannot be fitted.
    pub fn hold_lost(&mut self, named: &[Named]) -> Result<bool, String> {
        let mut changed = false;
        loop {
            let setting = self.at(named)?;
            let fitted = setting.fit(named)?;
            let is_doubted = |column: usize| self.prepared.doubted.contains(&column);
            let mut lost = self.prepared.lost(&setting.problem, &fitted.fit, is_doubted);
            if lost.is_empty() {
                lost.extend(self.untold(&setting, &fitted.fit));
            }
            if lost.is_empty() {
                return Ok(changed);
            }
            let base: Vec<usize> = self.base.iter().copied().filter(|column| !lost.contains(column)).collect();
            self.fit_to(&base);
            changed = true;
        }
    }

    /// The column of the description's number that a fit does not tell from what was declared.
    fn untold(&self, setting: &Setting<'_>, fit: &Fit) -> Option<usize> {
        let signs: Vec<Sign> = fit.columns.iter().map(|&column| setting.signs[column]).collect();
        let declared = |&column: &usize| self.prepared.own.get(column).map(|number| number.value);
        let declared: Vec<Option<f64>> = fit.columns.iter().map(declared).collect();
        let (problem, alone) = setting.alone(fit);
        let noise = self.prepared.declared_noise;
        let spread = covariance(&problem, &alone, &signs, noise);
        untold(&problem, &alone, &signs, &declared, &spread, noise).map(|place| fit.columns[place])
    }

    /// Fits these of the description's numbers, and no others.
    pub(super) fn fit_to(&mut self, base: &[usize]) {
        self.base = base.into();
        self.readings = OnceCell::new();
        self.forget();
    }
}

#[cfg(test)]
mod tests {
    use std::vec;

    use crate::campaign::made::Plan;
    use crate::campaign::{Campaign, Data};
    use crate::identify::column::Column;
    use crate::identify::prepare::Prepared;
    use crate::identify::{Visibility, identify};
    use crate::trace::Verdict;
    use crate::trace::tests::{names, traced};
    use robstiff::elements::Spring;

    /// One load a pose, of which only a fit tells the noise, on an arm whose wrist gives way by
    /// a third more than declared; the last row is off by so much (m).
    fn campaign(noise: f64, off: f64, seed: u64) -> Campaign {
        let plan = Plan { visits: 1, ramp: vec![1.0], shares_unloaded: false, noise: [noise; 3], ..Plan::new(seed) };
        let mut campaign = plan.run();
        let joints = &mut campaign.robot.joints[3..];
        joints.iter_mut().flat_map(|joint| &mut joint.compliance).for_each(|part| part.value /= 1.35);
        if let Data::Displacement(data) = &mut campaign.data {
            data.rows.last_mut().expect("it has rows").displacement[2] += off;
        }
        campaign
    }

    /// A wild row makes the noise look large enough to hide joints, for as long as it is not left
    /// out; held as declared, they would be curves of other joints.
    #[test]
    fn joints_that_a_wild_row_hides_are_seen_without_it() {
        for seed in 1..=6 {
            let campaign = campaign(5e-6, 10e-3, seed);
            let prepared = Prepared::new(&campaign).expect("displacements");
            assert!(!prepared.doubted.is_empty(), "{seed}");
            let found = traced(&campaign);
            // One load a pose, and no noise declared: nothing but the fit says how large it is.
            assert_eq!((names(&found), found.verdict), (vec!["outliers@rig".into()], Verdict::Partial), "{seed}");
            for joint in &found.estimates {
                assert_eq!(joint.visibility, Visibility::Seen, "{seed}: {joint:?}");
            }
        }
    }

    /// What noise hides in truth keeps the value that is declared, in tracing as in identifying.
    #[test]
    fn joints_that_noise_hides_stay_held() {
        let mut held = 0;
        for seed in 1..=6 {
            let campaign = campaign(2e-4, 0.0, seed);
            let (found, identified) = (traced(&campaign), identify(&campaign).expect("some joints are seen"));
            assert_eq!((names(&found), found.verdict), (vec![], Verdict::Adequate), "{seed}");
            for (joint, identified) in found.estimates.iter().zip(&identified.estimates) {
                assert_eq!(joint.visibility, identified.visibility, "{seed}: {joint:?}");
                let is_held = joint.visibility == Visibility::Unseen;
                assert!(!is_held || (joint.value == joint.declared && joint.std.is_none()), "{seed}: {joint:?}");
                held += usize::from(is_held);
            }
        }
        assert!(held > 0);
    }

    /// Once a tilt is named that a joint made up for which forces hardly turn, zero fits that joint
    /// no better than what is declared.
    #[test]
    fn a_joint_that_is_not_told_from_rigid_is_held() {
        for seed in 1..=3 {
            let mut plan = Plan { hidden: vec![(Column::Spring(Spring::Transverse(4)), 6e-6)], ..Plan::new(seed) };
            plan.robot.joints[4].a = 1e-3;
            let last = &traced(&plan.run()).estimates[4];
            assert!(!last.at_bound && last.visibility == Visibility::Unseen, "{seed}: {last:?}");
            assert!(last.value == last.declared && last.std.is_none(), "{seed}: {last:?}");
        }
    }
}
