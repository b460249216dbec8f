//! One campaign, written, read, traced and judged.

use std::path::PathBuf;
use std::time::Instant;
use std::{env, fs, process, thread};

use robstiff::campaign::Campaign;
use robstiff::identify::predict;
use robstiff::trace::{Options, Trace, Verdict, trace};
use robstiff_robots::Description;

use super::alias::would_do;
use super::case::{Case, Expected, Group, Ready};
use crate::judge_tracing::{Judgement, Told, joints_within, judge, numbers_within};
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
    /// The error on poses that the fit has not seen, after, over what noise
    /// alone would leave there.
    pub unseen: f64,
    /// What the written description errs by on ten other poses, without noise
    /// and without the faults of the rig, over what noise alone would leave.
    pub elsewhere: f64,
    /// Numbers of effects within their 95 % interval, of how many.
    pub numbers: (usize, usize),
    /// The same of joints' compliances.
    pub joints: (usize, usize),
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
            Expected::NoWholeTruth => Some(verdict.is_some() && !self.judgement.whole_truth),
            Expected::Doubtful => None,
        }
    }

    /// Whether names that are not the truth are said to be the whole truth.
    pub fn misleads(&self) -> bool {
        let names_all = match self.ready.case.group {
            Group::Outside(_) => false,
            _ => self.judgement.alone,
        };
        self.judgement.whole_truth && !names_all
    }
}

/// Runs a case.
///
/// # Panics
/// Where a file cannot be written or the campaign cannot be read.
pub fn run(case: Case) -> Record {
    let ready = case.ready();
    let simulated = ready.scenario.run();
    let campaign = read(&simulated, &ready.declared);
    let begun = Instant::now();
    let traced = trace(&campaign, &Options::default(), &|_| {});
    let seconds = begun.elapsed().as_secs_f64();
    // A displacement is the difference of two readings.
    let floor = ready.scenario.noise * std::f64::consts::SQRT_2;
    let Ok(traced) = traced else {
        let nothing = (0, 0);
        let (unseen, elsewhere) = (f64::NAN, f64::NAN);
        let judgement = Judgement::default();
        return Record { ready, told: None, judgement, unseen, elsewhere, numbers: nothing, joints: nothing, seconds };
    };
    let told = Told::of(&traced);
    let outside = matches!(ready.case.group, Group::Outside(_));
    let hidden: Vec<(String, Vec<(String, f64)>)> = match outside {
        // It has no name to be found.
        true => Vec::new(),
        false => ready.scenario.hidden.iter().map(|hidden| (hidden.name(), hidden.parameters())).collect(),
    };
    let names: Vec<String> = hidden.iter().map(|(name, _)| name.clone()).collect();
    let judgement = judge(&told, &names, |name, index| would_do(&ready, name, index));
    // The joints are where they are only in a model that is the right one.
    let truths: Vec<f64> = ready.scenario.truth.joints.iter().map(|joint| joint.compliance()).collect();
    let joints = match !outside && judgement.own && told.verdict != Verdict::Insufficient {
        true => joints_within(&told, &truths),
        false => (0, 0),
    };
    Record {
        numbers: numbers_within(&told, &hidden),
        joints,
        unseen: traced.after.holdout_rms / floor,
        elsewhere: elsewhere(&ready, &traced) / floor,
        judgement,
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
fn read(simulated: &Simulated, declared: &Description) -> Campaign {
    let thread: String = format!("{:?}", thread::current().id()).chars().filter(char::is_ascii_digit).collect();
    let folder: PathBuf = env::temp_dir().join(format!("robstiff-matrix-{}-{thread}", process::id()));
    simulated.write(&folder, &declared.to_yaml()).expect("a temporary folder");
    let campaign = Campaign::read(folder.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    fs::remove_dir_all(&folder).expect("the folder that was just made");
    campaign
}
