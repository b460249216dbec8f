//! Planning: which poses and loads to measure next.
//!
//! The way of the data: [`rivals`] takes from a trace the effects that the
//! campaign could not tell apart, each with its size; [`space`] draws poses and
//! loads that can be measured; [`regressors`] says what each would show, through
//! adapters to the regressions that tracing uses, of [`displacements`] and of
//! absolute [`positions`]; [`criterion`] turns that into what is known after a set
//! of measurements; [`exchange`] looks for the best set; [`advice`] says what else
//! would do where no pose does.
//!
//! Everything expected is to first order, with the noise that the trace found
//! and each rival in turn taken for the truth at the size that fits best, the knees
//! of gears held at the best of a grid. The measurements are visits like the campaign's own,
//! with its sequence of loads, of displacements with one unloaded reading for each.

pub mod advice;
pub mod criterion;
pub mod displacements;
pub mod exchange;
pub mod first;
#[cfg(test)]
mod first_tests;
pub mod positions;
pub mod regressors;
pub mod rivals;
pub mod space;
#[cfg(test)]
mod tests;

use std::string::String;
use std::vec::Vec;

use nalgebra::DMatrix;
use robstiff_robots::effect::gravity_sag::GRAVITY;

pub use advice::Remedy;
pub use criterion::Criterion;
pub use regressors::{Sensor, Visit};
pub use rivals::Group;

use self::criterion::Judge;
use self::exchange::{Search, in_order, refine};
use self::regressors::Regressors;
use self::rivals::{Rivals, groups};
use self::space::Space;
use crate::campaign::{Campaign, Data};
use crate::identify::Error;
use crate::identify::prepare::Prepared;
use crate::trace::{Proposal, Trace};

/// What to plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How many poses to propose.
    pub poses: usize,
    /// What they are to be best at.
    pub criterion: Criterion,
    /// Seed of the candidates and of the starts; one seed gives one plan.
    pub seed: u64,
    /// How many poses to choose from; each comes with several loads.
    pub candidates: usize,
    /// How many starts of the search.
    pub starts: usize,
    /// The greatest force (N); the campaign's where there is none.
    pub force: Option<f64>,
    /// The greatest moment (Nm); the campaign's where there is none.
    pub moment: Option<f64>,
    /// The least height of the tool centre point above the origin of frame 0,
    /// along z of the base frame (m); the campaign's lowest where there is none.
    pub floor: Option<f64>,
    /// How far joints stay inside their limits, as a share of the range between these.
    pub margin: f64,
}

/// Measured poses are approached from either side, and a limit of a description is that of a data
/// sheet: a twentieth of the range at either end is not used.
pub const MARGIN: f64 = 0.05;

impl Default for Options {
    fn default() -> Self {
        Self {
            poses: 10,
            criterion: Criterion::Compound,
            seed: 1,
            candidates: 150,
            starts: 3,
            force: None,
            moment: None,
            floor: None,
            margin: MARGIN,
        }
    }
}

/// What to measure next, and what that is expected to give.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The measurements, the one that gives most first.
    pub proposals: Vec<Planned>,
    /// What is to be told apart.
    pub pairs: Vec<Pair>,
    /// The numbers of the description and of the effects named.
    pub numbers: Vec<Number>,
    /// What was taken for granted, a sentence each.
    pub assumptions: Vec<String>,
}

/// A measurement that is proposed.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// The pose, and the loads of the visit in order (N, Nm) in the base frame,
    /// acting where the campaign's do; of payloads, their weight.
    pub visit: Visit,
    /// The greatest load (N, Nm), in the base frame.
    pub greatest: [f64; 6],
    /// The rivals that it separates most, by their index in [`Plan::pairs`].
    pub separates: Option<usize>,
    /// The separation of each pair (sigmas) with this and those before it.
    pub separation: Vec<f64>,
    /// The standard deviation of each number with this and those before it.
    pub std: Vec<f64>,
}

/// Two rivals.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Their full names.
    pub names: [String; 2],
    /// How far the wrong one is off (sigmas): the square root of the expected
    /// difference in chi-square, for the less clear of the two being the truth.
    pub now: f64,
    /// The same with all proposals measured.
    pub after: f64,
    /// The logarithm of the Bayes factor that is to be expected then at least,
    /// by the Schwarz criterion; natural.
    pub log_bayes: f64,
    /// The angle between what the two show (rad), with everything else fitted
    /// again, over every pose and load that could be proposed.
    pub angle: f64,
    /// What comes of it.
    pub outlook: Outlook,
    /// What would tell them apart beyond more poses, the best first.
    pub remedies: Vec<Remedy>,
}

/// Whether two rivals can be told apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outlook {
    /// The proposals are expected to.
    Separable,
    /// It takes about so many poses like the proposed.
    Slow(usize),
    /// No pose and load can: they show the same.
    Alias,
}

/// One number and how well it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// `joint 3`, or an effect's number.
    pub name: String,
    /// Its value: of displacements in the linear fit that the plan is made with, knees held at
    /// the best of a grid, so not quite what a trace says, which fits each in its own form.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// One standard deviation with the campaign as it is, from the noise alone; that of a trace is
    /// of what each pose leaves, and mostly larger.
    pub now: f64,
    /// The same with all proposals measured.
    pub after: f64,
}

/// Rivals closer than this after all proposals are not told apart by them: the
/// level of [`same_as`](crate::trace::NamedEffect::same_as), a likelihood ratio
/// of 2.33 standard errors, is met in half the campaigns there.
pub const TOLD_APART: f64 = 3.0;

/// Whether measurements after a campaign can be planned.
///
/// # Errors
/// A campaign of another kind.
pub fn can_follow(campaign: &Campaign) -> Result<(), Error> {
    match &campaign.data {
        Data::Displacement(_) | Data::Position(_) => Ok(()),
        Data::Clamped(_) => Err(Error::OtherCampaign(String::from(
            "planning needs a campaign of kind `displacement` or `position`; what clamped axes leave open `trace` \
                 tells, and torques both ways, in steps up and down again, tell most of a gear",
        ))),
    }
}

/// Plans the measurements after a campaign that was traced.
///
/// # Errors
/// A campaign of another kind, or one that shows none of the robot's compliances; no pose that
/// could be proposed.
pub fn plan(campaign: &Campaign, trace: &Trace, options: &Options) -> Result<Plan, Error> {
    plan_between(campaign, trace, &groups(trace), options)
}

/// The same with other rivals than those of the trace, by their full names: to
/// ask what it would take to tell these apart.
///
/// # Errors
/// As [`plan`].
pub fn plan_between(campaign: &Campaign, trace: &Trace, groups: &[Group], options: &Options) -> Result<Plan, Error> {
    let space = Space::new(campaign, options)?;
    match &campaign.data {
        Data::Position(data) => {
            let (adapter, rivals) = positions::Adapter::new(campaign, data, trace, groups)?;
            Ok(best(&adapter, &rivals, &space, options))
        }
        Data::Displacement(_) | Data::Clamped(_) => {
            let prepared = Prepared::new(campaign)?;
            let (adapter, rivals) = displacements::Adapter::new(campaign, &prepared, trace, groups)?;
            Ok(best(&adapter, &rivals, &space, options))
        }
    }
}

/// The best visits that are found.
fn best(regressors: &impl Regressors, rivals: &Rivals, space: &Space, options: &Options) -> Plan {
    let visits = space.visits();
    let judge = Judge::new(&regressors.known(), rivals, regressors.variance());
    let information: Vec<DMatrix<f64>> = regressors.information(&visits, None);
    let everything = information.iter().sum::<DMatrix<f64>>() + regressors.known();
    let open = judge.separable(&everything);
    let judge = judge.with_pairs(open.clone());
    let search = Search { judge: &judge, known: &regressors.known(), information: &information, visits: &visits };
    let chosen = search.best(options.criterion, options.poses, options.starts, options.seed);
    let chosen: Vec<Visit> = chosen.into_iter().map(|k| visits[k].clone()).collect();
    let chosen = refine(&judge, regressors, space, options.criterion, chosen);
    let chosen = in_order(&judge, regressors, options.criterion, chosen);
    let told = Told { regressors, rivals, judge: &judge, everything: &everything, open: &open };
    told.plan(&chosen, space.assumptions.clone())
}

/// The first proposals, as a trace holds them: what separates rivals.
///
/// # Errors
/// As [`plan`].
pub fn next(campaign: &Campaign, trace: &Trace, count: usize) -> Result<Vec<Proposal>, Error> {
    if groups(trace).iter().all(|group| group.names.len() < 2) {
        return Ok(Vec::new());
    }
    let plan = plan(campaign, trace, &Options { poses: count, starts: 1, ..Options::default() })?;
    let proposal = |planned: &Planned| {
        let [x, y, z, ..] = planned.greatest;
        Some(Proposal {
            q: planned.visit.q.clone(),
            force: [x, y, z],
            payload: matches!(campaign.data, Data::Position(_)).then_some(-z / GRAVITY),
            separates: plan.pairs[planned.separates?].names.clone(),
        })
    };
    Ok(plan.proposals.iter().filter_map(proposal).collect())
}

/// What tells what is to be expected of visits.
struct Told<'p, R> {
    regressors: &'p R,
    rivals: &'p Rivals,
    judge: &'p Judge,
    /// What all that could be measured would give.
    everything: &'p DMatrix<f64>,
    /// The pairs that differ in that.
    open: &'p [usize],
}

impl<R: Regressors> Told<'_, R> {
    /// What is expected of the chosen visits, in their order.
    fn plan(&self, chosen: &[Visit], assumptions: Vec<String>) -> Plan {
        let (proposals, sum) = self.proposals(chosen);
        let known = self.regressors.known();
        let [before, after] = [&known, &sum].map(|information| self.judge.separations(information));
        let pairs = (0..self.rivals.pairs.len()).map(|k| self.pair(chosen, k, before[k], after[k])).collect();
        let [now, then] = [&known, &sum].map(|information| self.judge.stds(information));
        let number = |(number, (now, after)): (&rivals::Number, (f64, f64))| Number {
            name: number.name.clone(),
            value: number.value,
            unit: number.unit,
            now,
            after,
        };
        let numbers = self.rivals.model.iter().zip(now.into_iter().zip(then)).map(number).collect();
        Plan { proposals, pairs, numbers, assumptions }
    }

    /// The visits with what is known after each, and what is known after all.
    fn proposals(&self, chosen: &[Visit]) -> (Vec<Planned>, DMatrix<f64>) {
        let mut sum = self.regressors.known();
        let mut last = self.judge.separations(&sum);
        let mut proposals = Vec::new();
        for (visit, information) in chosen.iter().zip(self.regressors.information(chosen, None)) {
            sum += information;
            let separation = self.judge.separations(&sum);
            // What the harmonic mean of the criterion gains from the pair.
            let share = |separation: &[f64], k: usize| (separation[k] * separation[k]).max(f64::MIN_POSITIVE).recip();
            let gain = |&k: &usize| share(&last, k) - share(&separation, k);
            let separates = self.open.iter().copied().max_by(|a, b| gain(a).total_cmp(&gain(b)));
            proposals.push(Planned {
                visit: visit.clone(),
                greatest: visit.greatest(),
                separates,
                separation: separation.clone(),
                std: self.judge.stds(&sum),
            });
            last = separation;
        }
        (proposals, sum)
    }

    /// A pair of rivals, by index, with its separation (sigmas) before and after the visits.
    fn pair(&self, chosen: &[Visit], k: usize, now: f64, after: f64) -> Pair {
        let contest = &self.rivals.pairs[k];
        let outlook = if !self.open.contains(&k) {
            Outlook::Alias
        } else if after >= TOLD_APART {
            Outlook::Separable
        } else {
            let gain = (after * after - now * now) / chosen.len().max(1) as f64;
            let lacking = TOLD_APART * TOLD_APART - now * now;
            Outlook::Slow((lacking / gain.max(f64::MIN_POSITIVE)).ceil().min(1e6) as usize)
        };
        let remedies = match outlook {
            Outlook::Separable => Vec::new(),
            _ => advice::remedies(self.regressors, self.judge, chosen, (contest, k), after),
        };
        let readings = self.regressors.readings(chosen) as f64;
        // Of the less clear of the two, the one with more numbers.
        let further = contest.further_numbers() as f64;
        let log_bayes = 0.5 * (after * after - further * readings.ln());
        let angle = self.judge.angle(self.everything, k);
        Pair { names: contest.names.clone(), now, after, log_bayes, angle, outlook, remedies }
    }
}
