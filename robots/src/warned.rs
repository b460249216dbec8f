//! What in a description is probably not what was meant, though a robot could be so.

use crate::angle::SNAP;
use crate::description::{Description, Joint};
use crate::effect::JointKind;
use crate::words::significant;
use std::f64::consts::FRAC_PI_2;

/// No gear, belt or spindle of an arm is so soft [rad/Nm or m/N]; any stiffness is far more.
const SOFTEST: f64 = 1e-2;

/// To so many decimals people round angles in rad.
const DECIMALS: std::ops::RangeInclusive<i32> = 2..=8;

impl Description {
    /// Sentences on numbers that are probably in another unit, or rounded where they should not
    /// be; nothing is wrong with them otherwise.
    pub fn warnings(&self) -> Vec<String> {
        (1..).zip(&self.joints).flat_map(|(number, joint)| soft(number, joint).chain(rounded(number, joint))).collect()
    }
}

fn soft(number: usize, joint: &Joint) -> impl Iterator<Item = String> {
    let (unit, stiffness) = match joint.kind {
        JointKind::Revolute => ("rad/Nm", "Nm/rad"),
        JointKind::Prismatic => ("m/N", "N/m"),
    };
    joint.compliance.iter().map(|part| part.value).filter(|value| *value > SOFTEST).map(move |value| {
        format!("joint {number} is as soft as {} {unit}: is `{stiffness}` meant?", significant(value))
    })
}

fn rounded(number: usize, joint: &Joint) -> impl Iterator<Item = String> {
    let angles = [("theta", joint.theta), ("alpha", joint.alpha)].into_iter();
    angles.filter_map(move |(name, angle)| {
        let degrees = 90.0 * rounded_turns(angle)?;
        Some(format!("{name} of joint {number} is {angle} rad, which looks rounded: is `{degrees} deg` meant?"))
    })
}

/// The quarter turns of which an angle (rad) has the first decimals.
fn rounded_turns(angle: f64) -> Option<f64> {
    let turns = (angle / FRAC_PI_2).round();
    let exact = turns * FRAC_PI_2;
    let is_cut = |decimals: i32| {
        let power = 10_f64.powi(decimals);
        let cut = [(exact * power).round() / power, (exact * power).trunc() / power];
        cut.iter().any(|cut| (cut - angle).abs() < 1e-12)
    };
    ((angle - exact).abs() > SNAP && turns != 0.0 && DECIMALS.into_iter().any(is_cut)).then_some(turns)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warned(joint: &str) -> Vec<String> {
        let text = format!("name: Arm\nconvention: standard\njoints:\n  - {{a: 1 m}}\n  - {{{joint}}}\n");
        Description::parse("arm.yaml", &text).unwrap_or_else(|problems| panic!("{problems}")).warnings()
    }

    #[test]
    fn a_stiffness_with_the_unit_of_a_compliance_is_asked_about() {
        let said = "joint 2 is as soft as 2.5e6 rad/Nm: is `Nm/rad` meant?";
        assert_eq!(warned("compliance: 2.5e6 rad/Nm"), [said]);
        assert_eq!(warned("compliance: {gear: 2e-7 rad/Nm, belt: 2.5e6 rad/Nm}"), [said]);
        let said = "joint 2 is as soft as 2e7 m/N: is `N/m` meant?";
        assert_eq!(warned("type: prismatic, compliance: 2e7 m/N"), [said]);
        assert_eq!(warned("compliance: 1e-3 rad/Nm"), Vec::<String>::new());
    }

    #[test]
    fn a_rounded_right_angle_is_asked_about() {
        let said = "alpha of joint 2 is -1.5708 rad, which looks rounded: is `-90 deg` meant?";
        assert_eq!(warned("alpha: -1.5708 rad"), [said]);
        let said = "theta of joint 2 is 3.1415 rad, which looks rounded: is `180 deg` meant?";
        assert_eq!(warned("theta: 3.1415"), [said]);
        assert_eq!(warned("alpha: 1.57").len(), 1);
        for exact in ["alpha: pi/2", "alpha: 1.5707963268", "alpha: 89.97 deg", "alpha: 1.56", "theta: 0.001"] {
            assert_eq!(warned(exact), Vec::<String>::new(), "{exact}");
        }
    }

    #[test]
    fn the_robots_of_the_catalogue_are_not_asked_about() {
        for (file, text) in crate::catalogue::catalogue() {
            let robot = Description::parse(file, text).unwrap_or_else(|problems| panic!("{problems}"));
            assert_eq!(robot.warnings(), Vec::<String>::new(), "{file}");
        }
    }
}
