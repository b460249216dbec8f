//! What a report shows, in the units it is shown in: lengths in um, which of clamped axes that
//! turn are angles in urad ([`Terms`]).

use super::terms::Terms;

/// A report on one campaign.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The robot's name.
    pub robot: String,
    /// One line on the robot.
    pub description: String,
    /// What the campaign calls itself, when it was measured and by whom.
    pub campaign: String,
    /// The finding in one sentence.
    pub headline: String,
    /// What it means, a sentence each.
    pub summary: Vec<String>,
    /// The verdict's word.
    pub verdict: String,
    /// Whether nothing is left open.
    pub conclusive: bool,
    /// The words for what was read.
    pub terms: Terms,
    /// Rows of the campaign.
    pub rows: usize,
    /// Poses of the campaign.
    pub poses: usize,
    /// One sigma of one axis of one reading (um).
    pub reading_um: f64,
    /// The same of what is read (um): more where that is a displacement, the
    /// difference of two readings, at most this.
    pub noise_um: f64,
    /// Where that is known from.
    pub noise_source: String,
    /// How the errors on unseen poses came about.
    pub unseen: String,
    /// What the readings were asked before any model.
    pub checks: Vec<Check>,
    /// Readings that do not belong, a sentence each.
    pub outliers: Vec<String>,
    /// The models, from the declared to the final one.
    pub stages: Vec<Stage>,
    /// The effects named.
    pub effects: Vec<Effect>,
    /// The effects that are not certain enough to be named.
    pub suspected: Vec<Effect>,
    /// The description's own numbers before and after.
    pub compliances: Vec<Compliance>,
    /// The error pose by pose.
    pub errors: Vec<PoseError>,
    /// Residual vectors of single rows.
    pub residuals: Vec<Residual>,
    /// The arm in its poses.
    pub arms: Vec<Arm>,
    /// What the residual depends on most.
    pub dependences: Vec<Dependence>,
    /// What else there could be, a sentence each.
    pub doubts: Vec<String>,
    /// The most probable sets of effects, the best first.
    pub sets: Vec<ProbableSet>,
    /// The search repeated without some poses.
    pub repeated: Repeated,
    /// What stays unexplained.
    pub unexplained: Unexplained,
    /// What to measure next.
    pub next: Vec<Next>,
    /// What the readers of the files noticed.
    pub warnings: Vec<String>,
    /// Where everything came from, a name and a text each.
    pub origins: Vec<(String, String)>,
}

impl Report {
    /// Whether the last model has more than the description's numbers fitted again.
    pub fn has_effects(&self) -> bool {
        !self.effects.is_empty() || !self.suspected.is_empty()
    }
}

/// A model and its error.
#[derive(Clone, Debug)]
pub struct Stage {
    /// Which model.
    pub name: String,
    /// What it is.
    pub remark: String,
    /// On the rows it was fitted to (um).
    pub rms_um: f64,
    /// On poses it has not seen (um).
    pub holdout_rms_um: f64,
}

/// An effect that was named, or is suspected.
#[derive(Clone, Debug)]
pub struct Effect {
    /// `kind@at`.
    pub name: String,
    /// What that is, in words, with its lines of the table.
    pub words: String,
    /// What causes it and what one does about it.
    pub explanation: String,
    /// Whether it is a fault of the measurement.
    pub of_rig: bool,
    /// Whether the description that is written has it.
    pub written: bool,
    /// Its numbers.
    pub numbers: Vec<Number>,
    /// The probability of its class, in words.
    pub probability: String,
    /// In how many of the repeated searches it is back, in words; empty where none was.
    pub recurs: String,
    /// The error on unseen poses with it and those before it (um); of a suspected one none.
    pub holdout_rms_um: f64,
    /// What these data cannot tell it from, in words.
    pub same_as: String,
    /// What keeps it from being named; empty where it is named.
    pub why_not: String,
}

/// A number of an effect, in SI.
#[derive(Clone, Debug)]
pub struct Number {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// One sigma, where there is one.
    pub std: Option<f64>,
    /// Its unit.
    pub unit: String,
}

/// One of the description's own numbers in the three models.
#[derive(Clone, Debug)]
pub struct Compliance {
    /// `joint 3`, or an effect's number.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// As declared.
    pub declared: f64,
    /// Fitted again, and one sigma; none where the data cannot see it.
    pub identified: Option<(f64, f64)>,
    /// With the effects.
    pub after: Option<(f64, f64)>,
}

/// The error in one pose, each the rms over its rows of one axis (um).
#[derive(Clone, Debug)]
pub struct PoseError {
    /// The pose's id.
    pub id: String,
    /// Of the description as declared.
    pub declared: f64,
    /// With the joints identified again.
    pub identified: f64,
    /// With the effects.
    pub after: f64,
    /// What the effects add that are written into the robot.
    pub contribution: f64,
    /// Whether the pose was held out.
    pub held_out: bool,
    /// Whether a reading of it does not belong to the others.
    pub outlying: bool,
}

/// Residuals of one row (um) in the base frame.
#[derive(Clone, Copy, Debug)]
pub struct Residual {
    /// With the joints identified again.
    pub before: [f64; 3],
    /// With the effects.
    pub after: [f64; 3],
}

/// The arm in one pose.
#[derive(Clone, Debug)]
pub struct Arm {
    /// The pose's id.
    pub id: String,
    /// From the ground to the TCP, joint by joint (m).
    pub points: Vec<[f64; 3]>,
    /// The residual of the row of its largest force, the joints identified
    /// again (um).
    pub before: [f64; 3],
    /// The same with the effects.
    pub after: [f64; 3],
}

/// The residual against one quantity.
#[derive(Clone, Debug)]
pub struct Dependence {
    /// The quantity.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The component of the residual.
    pub axis: usize,
    /// Which share of its variance a parabola accounts for, before and after.
    pub share: [f64; 2],
    /// The quantity, and the residual before and after (um).
    pub points: Vec<[f64; 3]>,
}

/// A set of effects.
#[derive(Clone, Debug)]
pub struct ProbableSet {
    /// Full names with their forms; none of the joints alone.
    pub names: Vec<String>,
    /// Its probability, in words.
    pub probability: String,
}

/// The search repeated without some poses.
#[derive(Clone, Debug, Default)]
pub struct Repeated {
    /// How many times.
    pub folds: usize,
    /// Full names, each with the share of the searches that found it.
    pub names: Vec<(String, String)>,
}

/// What stays unexplained.
#[derive(Clone, Debug, Default)]
pub struct Unexplained {
    /// The fraction of the residual variance that is not noise.
    pub fraction: f64,
    /// On what it depends.
    pub depends_on: Vec<String>,
}

/// A measurement worth making.
#[derive(Clone, Debug)]
pub struct Next {
    /// The pose, one number with its unit a joint.
    pub pose: String,
    /// What the arm is loaded with, in words.
    pub load: String,
    /// What it separates, in words.
    pub separates: [String; 2],
}

/// A check of the readings before any model.
#[derive(Clone, Debug)]
pub struct Check {
    /// Its name.
    pub name: String,
    /// What it asks.
    pub question: String,
    /// What came of it.
    pub state: State,
    /// The statistic with its unit; empty where it could not be asked.
    pub found: String,
    /// The probability of that under noise alone, all checks counted.
    pub p_value: Option<f64>,
    /// What it means, or what it needs.
    pub said: String,
}

/// What came of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Nothing is wrong as far as one can tell.
    Holds,
    /// It fails.
    Violated,
    /// It fails, and what was named accounts for that.
    AccountedFor,
    /// These data cannot be asked.
    NotAsked,
}
