//! A factor that all joints have in common: no robot is a thousand times as compliant as
//! its maker says, but a force in another unit makes it so, and fits as well.

use core::f64::consts::PI;
use std::format;
use std::string::String;
use std::vec::Vec;

use super::{Estimate, Visibility};
use crate::campaign::{Campaign, Data};

/// No joints are all off from what is declared by more than this factor.
pub const FARTHEST: f64 = 30.0;

/// A factor that is in common is each joint's own within this one, or within what its value
/// is sure to.
const ALIKE: f64 = 3.0;

/// Factors between units of one prefix and another, thousands, and within how many times of one the
/// joints' factor is near it.
const THOUSANDS: [f64; 3] = [1e3, 1e6, 1e9];

/// Pairs of units of angles that are taken for each other, the finer first, and how many of it the
/// other is. Others are less than [`FARTHEST`] of each other, or thousands.
const ANGLES: [([&str; 2], f64); 6] = [
    (["deg", "rad"], 180.0 / PI),
    (["arcmin", "rad"], 60.0 * 180.0 / PI),
    (["arcsec", "rad"], 3600.0 * 180.0 / PI),
    (["urad", "deg"], 1e6 * PI / 180.0),
    (["urad", "arcmin"], 1e6 * PI / 180.0 / 60.0),
    (["arcsec", "mrad"], 3.6 * 180.0 / PI),
];

/// The factor of joints is near that of a pair of angles within this one: pairs are closer to each
/// other than thousands are.
const NEAR: f64 = 1.5;

/// How it begins what is said of a factor that no robot has.
pub const ALL_JOINTS: &str = "all joints come out about";

/// How it begins what would be right.
pub(crate) const HEADER: &str = "the header of the table has to say what unit its numbers are in, as";

/// What looks like a unit that was taken for another, in a sentence: that all joints which
/// the data see, two at least, come out off from their declared compliances by about one
/// factor, beyond 30 either way. `estimates` are of the campaign's robot, its joints first.
pub fn off_by_one_factor(campaign: &Campaign, estimates: &[Estimate]) -> Option<String> {
    let factor = common_factor(campaign, estimates)?;
    let (times, likely) = (times(factor), likely(campaign, factor));
    Some(format!("All joints come out about {times} as declared: {likely} looks like that."))
}

/// The same of a factor that lies between units, as one that is no robot's: why nothing can be
/// made of such data, and what would be right.
pub(crate) fn other_unit(campaign: &Campaign, estimates: &[Estimate]) -> Option<String> {
    let factor = common_factor(campaign, estimates)?;
    (is_of_thousands(factor) || of_angles(campaign, factor).is_some()).then(|| {
        let header = match &campaign.data {
            Data::Displacement(_) => "`Fx [N]` or `dx [um]`",
            Data::Clamped(_) => "`torque [Nm]` or `deflection [urad]`",
            Data::Position(_) => "`payload [kg]` or `px [mm]`",
        };
        let (times, likely) = (times(factor), likely(campaign, factor));
        format!(
            "{ALL_JOINTS} {times} as declared: {likely} looks like that; {HEADER} {header} does; where the \
             description is what is off, declare no compliances"
        )
    })
}

/// By what factor all joints are off, as [`off_by_one_factor`] tells it.
fn common_factor(campaign: &Campaign, estimates: &[Estimate]) -> Option<f64> {
    let joints = estimates.iter().take(campaign.robot.joints.len());
    let seen = joints.filter(|joint| joint.visibility == Visibility::Seen && joint.declared > 0.0);
    // With two standard deviations of each.
    let of = |joint: &Estimate| (joint.value / joint.declared, 2.0 * joint.std.unwrap_or(0.0) / joint.declared);
    let mut factors: Vec<(f64, f64)> = seen.map(of).collect();
    factors.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (median, _) = factors.get(factors.len() / 2).copied().filter(|_| factors.len() > 1)?;
    let is_alike =
        |&(factor, unsure): &(f64, f64)| factor + unsure >= median / ALIKE && factor - unsure <= median * ALIKE;
    let is_one = median > 0.0 && !(FARTHEST.recip()..FARTHEST).contains(&median) && factors.iter().all(is_alike);
    is_one.then_some(median)
}

/// How many times as compliant or stiff that is.
fn times(factor: f64) -> String {
    let which = if factor > 1.0 { "compliant" } else { "stiff" };
    format!("{} times as {which}", one_digit(factor.max(factor.recip())))
}

/// Whether a factor is one of prefixes.
fn is_of_thousands(factor: f64) -> bool {
    let off = factor.max(factor.recip());
    THOUSANDS.iter().any(|unit| (unit / ALIKE..=unit * ALIKE).contains(&off))
}

/// The pair of units of angles that a factor is of; in campaigns that read none, of what a
/// description declares its compliances in.
fn of_angles(campaign: &Campaign, factor: f64) -> Option<[&'static str; 2]> {
    let off = factor.max(factor.recip());
    let is_read = matches!(campaign.data, Data::Clamped(_));
    let of_descriptions = |units: [&str; 2]| matches!(units, ["deg" | "arcmin", "rad"]);
    let near = ANGLES
        .into_iter()
        .filter(|&(units, unit)| (unit / NEAR..=unit * NEAR).contains(&off) && (is_read || of_descriptions(units)));
    let apart = |unit: f64| (off / unit).ln().abs();
    near.min_by(|a, b| apart(a.1).total_cmp(&apart(b.1))).map(|(units, _)| units)
}

/// What such a factor may come from.
fn likely(campaign: &Campaign, factor: f64) -> String {
    let (off, is_softer) = (factor.max(factor.recip()), factor > 1.0);
    let taken = |[fine, coarse]: [&str; 2]| {
        let [was, read] = if is_softer { [fine, coarse] } else { [coarse, fine] };
        format!("in {was} taken for {read}")
    };
    let of_angles = of_angles(campaign, factor).map(|units| match &campaign.data {
        Data::Clamped(_) => format!("a deflection {},", taken(units)),
        _ => format!("a compliance declared in another unit, as {} for {},", units[0], units[1]),
    });
    if off < 100.0 {
        return of_angles.unwrap_or_else(|| String::from("a compliance declared in another unit, as deg for rad,"));
    }
    if !is_of_thousands(factor)
        && let Some(said) = of_angles
    {
        return said;
    }
    let thousands = (off.log10() / 3.0).round();
    let [large, fine] = match thousands as i32 {
        ..=1 => [["k", ""], ["u", "m"]],
        2 => [["M", ""], ["u", ""]],
        _ => [["G", ""], ["n", ""]],
    };
    let of = |prefixes: [&str; 2], unit: &str| {
        taken(prefixes.map(|prefix| format!("{prefix}{unit}")).each_ref().map(|unit| unit.as_str()))
    };
    let of_thousands = match &campaign.data {
        Data::Displacement(_) => format!("a force {}, or a displacement {},", of(large, "N"), of(fine, "m")),
        Data::Clamped(_) => format!("a torque {}, or a deflection {},", of(large, "Nm"), of(fine, "rad")),
        Data::Position(_) => String::from("a payload or a position in another unit,"),
    };
    // Some pairs of angles are near thousands.
    match of_angles {
        Some(of_angles) => format!("{of_thousands} or {of_angles}"),
        None => of_thousands,
    }
}

/// A number above 1 to its first digit.
fn one_digit(value: f64) -> String {
    let ten = 10.0_f64.powf(value.log10().floor());
    format!("{:.0}", (value / ten).round() * ten)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::made::{Plan, displacements};
    use crate::identify::{Error, Identification, displacement};

    /// Without the refusal of what is in another unit.
    fn identify(campaign: &Campaign) -> Result<Identification, Error> {
        displacement::identify(campaign, displacements(campaign))
    }

    /// What is told of a campaign whose forces are as many times what they were.
    fn told(times: f64, of_one_joint: f64) -> Option<String> {
        let mut campaign = Plan::new(1).run_with(|_, row| row.wrench = row.wrench.map(|load| times * load));
        crate::fit::estimate::set_compliance(&mut campaign.robot.joints[1].compliance, of_one_joint);
        off_by_one_factor(&campaign, &identify(&campaign).expect("joints are seen").estimates)
    }

    #[test]
    fn a_factor_of_all_joints_is_told_as_a_unit() {
        let declared = Plan::new(1).robot.joints[1].compliance();
        assert_eq!(told(1.0, declared), None);
        // Of one joint it is that joint's.
        assert_eq!(told(1.0, declared / 1000.0), None);
        assert_eq!(told(0.1, declared), None);
        let softer = "All joints come out about 1000 times as compliant as declared: a force in kN taken for N, or a \
                      displacement in um taken for mm, looks like that.";
        assert_eq!(told(1e-3, declared).as_deref(), Some(softer));
        let stiffer = "All joints come out about 1000 times as stiff as declared: a force in N taken for kN, or a \
                       displacement in mm taken for um, looks like that.";
        assert_eq!(told(1e3, declared).as_deref(), Some(stiffer));
    }

    /// Degrees, minutes and seconds are no thousands of each other. What a description declares its
    /// compliances in is asked for where no angle is read.
    #[test]
    fn units_of_angles_are_told() {
        let robot = robstiff_robots::samples::five_axis();
        let row = |(k, axis): (usize, usize)| {
            let torque = 100.0 * (k % 4 + 1) as f64;
            let deflection = robot.joints[axis - 1].compliance() * torque;
            crate::campaign::ClampedRow { line: k + 2, axis, torque, deflection }
        };
        let rows: Vec<_> = (1..=5).flat_map(|axis| [axis; 4]).enumerate().map(row).collect();
        let refused = |times: f64| {
            let mut rows = rows.clone();
            rows.iter_mut().for_each(|row| row.deflection *= times);
            let campaign = crate::campaign::made::campaign(robot.clone(), Data::Clamped(rows));
            let found = crate::identify::clamped::identify(&campaign, clamped(&campaign)).expect("all are loaded");
            other_unit(&campaign, &found.estimates)
        };
        for (times, said) in [
            (1e6 * PI / 180.0, "a deflection in urad taken for deg, looks"),
            (180.0 / PI / 1e6, "a deflection in deg taken for urad, looks"),
            (180.0 / PI, "a deflection in deg taken for rad, looks"),
            (648_000.0 / PI, "a deflection in arcsec taken for rad, looks"),
            (290.9, "a deflection in urad taken for arcmin, looks"),
        ] {
            assert!(refused(times).is_some_and(|why| why.contains(said)), "{times}: {:?}", refused(times));
        }
        // No units are that far apart, nor is an arm.
        for times in [25.0, 100.0, 70_000.0] {
            assert_eq!(refused(times), None);
        }
        let arcmin = Plan::new(1).run_with(|_, row| row.displacement = row.displacement.map(|read| 3437.7 * read));
        let refused = crate::identify::identify(&arcmin).map(|_| ()).map_err(|why| std::format!("{why}"));
        assert!(refused.is_err_and(|why| why.contains("a compliance declared in another unit, as arcmin for rad")));
    }

    fn clamped(campaign: &Campaign) -> &[crate::campaign::ClampedRow] {
        let Data::Clamped(rows) = &campaign.data else { unreachable!("made of clamped axes") };
        rows
    }

    /// One joint that the data hardly show does not hide the unit of the others.
    #[test]
    fn a_joint_that_is_hardly_seen_may_have_another_factor() {
        let mut campaign = Plan::new(1).run_with(|_, row| row.wrench = row.wrench.map(|load| 1e-3 * load));
        crate::fit::estimate::set_compliance(&mut campaign.robot.joints[1].compliance, 1e-7);
        let mut estimates = identify(&campaign).expect("joints are seen").estimates;
        let last = estimates.iter_mut().rfind(|joint| joint.visibility == Visibility::Seen).expect("it is");
        last.value = 200.0 * last.declared;
        last.std = Some(20.0 * last.declared);
        assert_eq!(off_by_one_factor(&campaign, &estimates), None);
        let last = estimates.iter_mut().rfind(|joint| joint.visibility == Visibility::Seen).expect("it is");
        last.std = Some(100.0 * last.declared);
        assert!(off_by_one_factor(&campaign, &estimates).is_some());
    }
}
