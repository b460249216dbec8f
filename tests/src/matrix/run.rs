//! One campaign, written, read, traced and judged.

use std::path::{Path, PathBuf};
use std::time::Instant;
use std::{env, fs, process, thread};

use robstiff_identify::campaign::Campaign;
use robstiff_identify::predict::predict;
use robstiff_identify::trace::{Options, Trace, Verdict, trace};
use robstiff_robots::Description;

use super::alias::would_do;
use super::case::{Case, Expected, Group, Ready};
use super::truths::Truths;
use crate::judge_tracing::{Held, Judgement, Told, claims, held_joints, held_numbers, judge};
use crate::reliability::Claim;
use crate::simulator::{Hidden, Scenario, Simulated};

/// What is added to a campaign's seed for poses that it does not have.
const ELSEWHERE: u64 = 1 << 32;

/// What came of a case.
#[derive(Clone, Debug)]
pub struct Record {
    /// The case with its sizes.
    pub ready: Ready,
    /// The verdict; none where tracing failed.
    pub told: Option<Told>,
    /// The judgement.
    pub judgement: Judgement,
    /// What is left looks like these.
    pub looks_like: Vec<String>,
    /// The error on poses that the fit has not seen, after, over what noise
    /// alone would leave there.
    pub unseen: f64,
    /// What the written description errs by on ten other poses, without noise
    /// and without the faults of the rig, over what noise alone would leave.
    pub elsewhere: f64,
    /// The numbers of effects that have an interval.
    pub numbers: Vec<Held>,
    /// The same of joints' compliances.
    pub joints: Vec<Held>,
    /// The classes that a probability is reported of.
    pub claims: Vec<Claim>,
    /// How long tracing took (s).
    pub seconds: f64,
}

impl Record {
    /// Whether tracing did what was to be expected; none where nothing is.
    pub fn is_as_expected(&self) -> Option<bool> {
        let verdict = self.told.as_ref().map(|told| told.verdict);
        let names = self.told.as_ref().map_or(0, |told| told.names.len());
        match self.ready.expected {
            Expected::Nothing => Some(verdict.is_some() && names == 0),
            Expected::Names => Some(self.judgement.right),
            // An alias is right, too.
            Expected::Unseen => Some(verdict.is_some() && self.judgement.wrong.is_empty()),
            Expected::NoWholeTruth => Some(verdict.is_some() && !self.misleads()),
            Expected::Doubtful => None,
        }
    }

    /// Whether an effect that matters is hidden, alone, with others or beside something
    /// outside the catalogue.
    pub fn has_a_name_to_find(&self) -> bool {
        let Ready { case, expected, .. } = &self.ready;
        *expected == Expected::Names || (case.group == Group::Beside && *expected == Expected::NoWholeTruth)
    }

    /// Whether what is not the truth is said to be the whole of it: names that are not, or
    /// that nothing is missing although something is hidden that shows.
    pub fn misleads(&self) -> bool {
        let names_all = self.judgement.alone && !self.ready.case.group.hides_what_is_outside();
        let is_adequate = self.told.as_ref().is_some_and(|told| told.verdict == Verdict::Adequate);
        // Of what does not show no one can say that it is missing.
        let lacks_nothing = is_adequate && !self.ready.hides_what_shows();
        self.judgement.whole_truth && !names_all && !lacks_nothing
    }
}

/// Runs a case.
///
/// # Panics
/// Where a file cannot be written or the campaign cannot be read.
pub fn run(case: Case) -> Record {
    run_keeping(case, None)
}

/// Runs a case, and writes its campaign to a folder of its own in `kept`.
///
/// # Panics
/// Where a file cannot be written or the campaign cannot be read.
pub fn run_keeping(case: Case, kept: Option<&Path>) -> Record {
    let ready = case.ready();
    let simulated = ready.scenario.run();
    if let Some(kept) = kept {
        let folder = kept.join(format!("{}-{}", ready.case.group.name(), ready.case.replicate));
        simulated.write(&folder, &ready.declared.to_yaml()).expect("a folder to write to");
    }
    let campaign = read(&simulated, &ready.declared);
    let begun = Instant::now();
    let traced = trace(&campaign, &Options::default(), &|_| {});
    let seconds = begun.elapsed().as_secs_f64();
    // A displacement is the difference of two readings.
    let floor = ready.scenario.noise * std::f64::consts::SQRT_2;
    let Ok(traced) = traced else {
        let (unseen, elsewhere) = (f64::NAN, f64::NAN);
        let judgement = Judgement::default();
        return Record {
            ready,
            told: None,
            looks_like: Vec::new(),
            judgement,
            unseen,
            elsewhere,
            numbers: Vec::new(),
            joints: Vec::new(),
            claims: Vec::new(),
            seconds,
        };
    };
    let told = Told::of(&traced);
    let outside = ready.case.group.hides_what_is_outside();
    let hidden: &[Hidden] = match ready.case.group {
        // What is outside has no name to be found.
        Group::Outside(_) => &[],
        Group::Beside => &ready.scenario.hidden[..1],
        _ => &ready.scenario.hidden,
    };
    let names: Vec<String> = hidden.iter().map(Hidden::name).collect();
    let judgement = judge(&told, &names, |name, index| would_do(&ready, name, index));
    let joints = ready.scenario.truth.joints.iter().map(|joint| joint.compliance()).collect();
    let truths = Truths::of(&told, hidden, joints);
    // The joints are where they are only in a model that is the right one.
    let comparable = !outside && judgement.own && told.verdict != Verdict::Insufficient;
    let joints = truths.joints.filter(|_| comparable);
    Record {
        numbers: held_numbers(&told, &truths.effects),
        joints: joints.map_or_else(Vec::new, |truths| held_joints(&told, &truths)),
        unseen: traced.after.holdout_rms / floor,
        elsewhere: elsewhere(&ready, &traced) / floor,
        claims: claims(&traced, &names, |name, index| would_do(&ready, name, index)),
        judgement,
        looks_like: traced.looks_like,
        told: Some(told),
        ready,
        seconds,
    }
}

/// The rms error of the description that tracing wrote on other poses of the
/// same robot, without noise and with a rig that is in order (m).
fn elsewhere(ready: &Ready, trace: &Trace) -> f64 {
    let of_the_robot = |hidden: &&Hidden| !hidden.is_of_the_rig() && !matches!(hidden, Hidden::BaseSlip { .. });
    let scenario = Scenario {
        poses: 10,
        seed: ready.scenario.seed.wrapping_add(ELSEWHERE),
        noise: 0.0,
        rotation_noise: None,
        hidden: ready.scenario.hidden.iter().filter(of_the_robot).cloned().collect(),
        ..ready.scenario.clone()
    };
    let campaign = read(&scenario.run(), &ready.declared);
    predict(&trace.description, &campaign).map_or(f64::NAN, |prediction| prediction.rms)
}

/// Writes a campaign and reads it, as a user would have it.
///
/// # Panics
/// Where a file cannot be written or the campaign cannot be read.
pub fn read(simulated: &Simulated, declared: &Description) -> Campaign {
    let thread: String = format!("{:?}", thread::current().id()).chars().filter(char::is_ascii_digit).collect();
    let folder: PathBuf = env::temp_dir().join(format!("robstiff-matrix-{}-{thread}", process::id()));
    simulated.write(&folder, &declared.to_yaml()).expect("a temporary folder");
    let campaign = Campaign::read(folder.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    fs::remove_dir_all(&folder).expect("the folder that was just made");
    campaign
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge_tracing::Name;

    /// What a tracing of a case would be taken for that comes to a verdict and to names.
    fn came(ready: &Ready, verdict: Verdict, names: &[&str]) -> Record {
        let name = |name: &&str| Name { name: (*name).into(), same_as: Vec::new(), parameters: Vec::new() };
        let told = Told { verdict, names: names.iter().map(name).collect(), joints: Vec::new() };
        let outside = ready.case.group.hides_what_is_outside();
        let hidden: Vec<String> = ready.scenario.hidden.iter().filter(|_| !outside).map(Hidden::name).collect();
        Record {
            ready: ready.clone(),
            judgement: judge(&told, &hidden, |_, _| false),
            told: Some(told),
            looks_like: Vec::new(),
            unseen: 1.0,
            elsewhere: 1.0,
            numbers: Vec::new(),
            joints: Vec::new(),
            claims: Vec::new(),
            seconds: 0.0,
        }
    }

    #[test]
    fn nothing_missing_misleads_where_something_shows() {
        use Verdict::{Adequate, Explained, Insufficient, Partial, Unexplained};
        let nothing = Case::new(Group::Nothing, 0, 7).ready();
        assert!(!came(&nothing, Adequate, &[]).misleads() && came(&nothing, Explained, &["sag@robot"]).misleads());
        let mut one = Case::new(Group::One("transverse_compliance"), 0, 7).ready();
        let name = one.scenario.hidden[0].name();
        assert_eq!(one.expected, Expected::Names);
        assert!(came(&one, Adequate, &[]).misleads() && !came(&one, Explained, &[&name]).misleads());
        assert!(!came(&one, Unexplained, &[]).misleads() && !came(&one, Partial, &["sag@robot"]).misleads());
        (one.left, one.expected) = (vec![0.1], Expected::Unseen);
        let unseen = came(&one, Adequate, &[]);
        assert!(!unseen.misleads() && unseen.is_as_expected() == Some(true));
        let outside = Case::new(Group::Outside("cable"), 2, 7).ready();
        assert_eq!(outside.expected, Expected::NoWholeTruth);
        for (verdict, is_right) in
            [(Adequate, false), (Explained, false), (Partial, true), (Unexplained, true), (Insufficient, true)]
        {
            let came = came(&outside, verdict, &[]);
            assert_eq!((came.is_as_expected(), came.misleads()), (Some(is_right), !is_right), "{verdict}");
        }
    }
}
