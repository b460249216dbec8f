//! The search for effects in absolute positions.
//!
//! Forward, an effect at a time, each in its own form: the model is fitted, turned to,
//! and every candidate tested against it. A kinematic table has some twenty numbers,
//! all of which can be a little off, so the search goes on for as long as something
//! is significant; and what a later effect makes superfluous is dropped again.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use super::bench::{Bench, Model, Proposed, TIE};
use super::structure::structure;
use crate::identify::positions::regression::STANDS;
use crate::identify::positions::wild::{Wild, wild_rows};
use crate::trace::bootstrap::{Reference, price};
use crate::trace::lack_of_fit::LackOfFit;
use crate::trace::model::{Fitted, Named, all_but};
use crate::trace::selection::{CURVATURE, Selection, WITHIN_REACH};
use crate::trace::settle::without_insignificant;
use crate::trace::step::{Against, Step};
use crate::trace::verdict::FEWEST_POSES;
use crate::trace::{Options, Progress};

/// Numbers of a table that can be told from each other, and a few effects besides.
const MOST_EFFECTS: usize = 24;

/// How many of the best by the linear fit are fitted in their own form.
const REFITTED: usize = 6;

/// How many of the best are extended where none of them passes alone.
const EXTENDED: usize = 8;

/// How many of the best with one effect replaced, or in another form, are tried without
/// what is superfluous then.
const REPLACED: usize = 24;

/// A model that is better by this is worth another look: odds of e to one.
const BETTER: f64 = 2.0;

/// What was found.
pub struct Searched<'c> {
    /// The regression, at the model.
    pub bench: Bench<'c>,
    /// The description's own numbers alone, of all rows.
    pub base: Model,
    /// The model.
    pub model: Model,
    /// How it was come to.
    pub selection: Selection,
    /// What it leaves.
    pub left: LackOfFit,
    /// The rows that are wild.
    pub wild: Wild,
    /// How many names were taken back.
    pub taken_back: usize,
    /// Why the data cannot tell, if so.
    pub too_little: Option<String>,
}

/// Searches for effects; `noise` is the one that is declared (m).
///
/// # Errors
/// Why not even the description's own numbers can be fitted.
pub fn search<'c>(
    mut bench: Bench<'c>,
    noise: Option<f64>,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<Searched<'c>, String> {
    let start = bench.prepared.state(bench.regression.numbers.len());
    let base = bench
        .solve(&[], &start)
        .ok_or_else(|| String::from("these positions do not tell the description's own numbers from each other"))?;
    bench.turn_to(&base);
    let too_little = too_little(&base);
    let mut course = Course::new(base.clone());
    if too_little.is_none() {
        course = course.run(&mut bench, false, options, progress).judged(&mut bench, false, noise, options, progress);
        if !course.left.structure && !course.unnamed {
            // With structure accounted for, rows need stand out from noise alone.
            let before = course.wild.rows.clone();
            let stay = course.leave_wild_out(&mut bench, true, Kept::WhereAnEffectSaysIt);
            if course.wild.rows != before || stay {
                course =
                    course.run(&mut bench, true, options, progress).judged(&mut bench, true, noise, options, progress);
            }
        }
    }
    let Course { model, wild, p_values, steps, unnamed, left, taken_back } = course;
    let fitted = Fitted { named: model.named.clone(), fit: model.solved.fit.clone(), bic: model.bic, physical: true };
    let selection = Selection { model: fitted, p_values, steps, unnamed };
    Ok(Searched { bench, base, model, selection, left, wild, taken_back, too_little })
}

/// A search on its way.
struct Course {
    model: Model,
    wild: Wild,
    p_values: Vec<f64>,
    steps: Vec<Step>,
    unnamed: bool,
    left: LackOfFit,
    taken_back: usize,
}

impl Course {
    /// One that begins with a model.
    fn new(model: Model) -> Self {
        Self {
            model,
            wild: Wild::default(),
            p_values: Vec::new(),
            steps: Vec::new(),
            unnamed: false,
            left: LackOfFit { tests: Vec::new(), structure: false, fraction: 0.0, depends_on: Vec::new() },
            taken_back: 0,
        }
    }

    /// Adds effects for as long as something is missing.
    fn run(mut self, bench: &mut Bench<'_>, strict: bool, options: &Options, progress: &Progress<'_>) -> Self {
        let mut tried: Vec<Vec<Named>> = Vec::new();
        let mut kept = Kept::WhereAnEffectSaysIt;
        while self.model.named.len() < MOST_EFFECTS && !tried.contains(&self.model.named) {
            let stay = self.leave_wild_out(bench, strict, kept);
            let model = &self.model;
            if model.leaves_nothing() {
                break;
            }
            progress(&format!("searching for effect {}", model.named.len() + 1));
            let Some((mut step, singles, reference, missing)) = tested(bench, model, options) else { break };
            let better = if missing { extended(bench, model, &singles, options) } else { None };
            if better.is_none() && stay {
                step.outcome = "no effect passes in whose favour wild rows had stayed".to_string();
                self.steps.push(step);
                kept = Kept::Never;
                continue;
            }
            if !missing {
                step.outcome = "nothing is missing significantly".to_string();
                self.steps.push(step);
                break;
            }
            tried.push(model.named.clone());
            let Some(mut better) = better else {
                self.unnamed = true;
                step.outcome = "something is missing, but no effect passes every test".to_string();
                self.steps.push(step);
                break;
            };
            bench.turn_to(&better);
            better = sideways(bench, better, &reference, options);
            better = without_superfluous(bench, better, &reference, options);
            better = bench.at_its_moments(better);
            better = bench.reshaped(better);
            let names: Vec<String> = better.named.iter().map(|one| bench.candidates[one.candidate].name()).collect();
            step.came_to(&names);
            self.steps.push(step);
            bench.turn_to(&better);
            self.model = better;
        }
        self
    }

    /// Leaves the rows out that are wild at the model, and no others; whether such rows
    /// stay for an effect's sake. All is as it was where physics does not allow the model
    /// without them.
    fn leave_wild_out(&mut self, bench: &mut Bench<'_>, strict: bool, kept: Kept) -> bool {
        let left_out = bench.rows.left_out.clone();
        bench.rows.left_out.fill(false);
        let (wild, mut stay) = wild_at(bench, &self.model, strict, kept);
        wild.rows.iter().for_each(|&row| bench.rows.left_out[row] = true);
        if bench.rows.left_out == left_out {
            self.wild = wild;
        } else if let Some(model) = bench.solve(&self.model.named, &self.model.solved.state) {
            (self.model, self.wild) = (model, wild);
        } else {
            bench.rows.left_out = left_out;
            stay = false;
        }
        bench.turn_to(&self.model);
        stay
    }

    /// Drops the effects that are not significant beside the others, one by one, and judges
    /// rows anew each time.
    fn settle(&mut self, bench: &mut Bench<'_>, strict: bool, options: &Options) {
        let before = self.model.named.clone();
        loop {
            let Model { named, solved, .. } = &self.model;
            self.p_values = (0..named.len()).map(|k| bench.p_value(named, k, options)).collect();
            let solve = |rest: &[Named]| bench.solve(rest, &solved.state);
            let Some((_, smaller)) = without_insignificant(named, &self.p_values, options, solve) else { break };
            bench.turn_to(&smaller);
            self.model = smaller;
            self.leave_wild_out(bench, strict, Kept::Never);
        }
        let name = |one: &Named| bench.candidates[one.candidate].name();
        let dropped: Vec<String> = before.iter().filter(|one| !self.model.named.contains(one)).map(name).collect();
        if dropped.is_empty() {
            return;
        }
        let (mut step, missing) = match tested(bench, &self.model, options) {
            Some((step, _, _, missing)) => (step, missing),
            None => (Step::bare(self.model.named.iter().map(name).collect()), false),
        };
        step.dropped(&dropped);
        self.steps.push(step);
        // What they had said better than others may still be missing.
        self.unnamed |= missing;
    }

    /// Asks how sure the effects are and whether structure is left, and takes names back
    /// that may be borrowed.
    fn judged(
        mut self,
        bench: &mut Bench<'_>,
        strict: bool,
        noise: Option<f64>,
        options: &Options,
        progress: &Progress<'_>,
    ) -> Self {
        self.settle(bench, strict, options);
        progress("looking for structure in what is left");
        self.left = structure(bench, &self.model, noise, options);
        while self.left.structure
            && let Some(rest) = without_borrowed(bench, &self.model, &self.left)
        {
            self.taken_back += self.model.named.len() - rest.named.len();
            bench.turn_to(&rest);
            self.model = rest;
            self.settle(bench, strict, options);
            self.left = structure(bench, &self.model, noise, options);
            // What a name had accounted for is there, found by a test or not.
            self.left.structure = true;
        }
        self
    }
}

/// The tests of all candidates against a model, the models with one of them more, the best
/// first, the distribution of the largest statistic, and whether something is missing.
fn tested(bench: &Bench<'_>, model: &Model, options: &Options) -> Option<(Step, Vec<Proposed>, Reference, bool)> {
    let test = bench.test(&model.named)?;
    let reference = test.reference(options.draws, options.seed);
    let singles = bench.extended(&model.named);
    let statistics = test.statistics();
    let step = Step::against(&bench.candidates, &model.named, |candidate| {
        let with = singles.iter().find(|fit| fit.named.iter().any(|one| one.candidate == candidate));
        Against {
            gains: statistics[candidate].map(|(statistic, _)| (statistic, reference.p_value(statistic))),
            bic: with.map(|with| with.bic),
            left_out_rms: None,
        }
    });
    let missing = step.candidates.iter().any(|tested| tested.p_value <= options.alpha);
    Some((step, singles, reference, missing))
}

/// The first of the best models with one effect more that passes; where none does,
/// with two, of which each can keep the other from passing alone.
fn extended(bench: &Bench<'_>, model: &Model, singles: &[Proposed], options: &Options) -> Option<Model> {
    let passing = |proposals: &[Proposed]| {
        refitted(bench, proposals, model).into_iter().find(|better| passes(bench, model, better, options))
    };
    passing(singles).or_else(|| {
        let mut pairs: Vec<Proposed> =
            singles.iter().take(EXTENDED).flat_map(|one| bench.extended(&one.named)).collect();
        pairs.sort_by(|a, b| a.bic.total_cmp(&b.bic));
        passing(&pairs)
    })
}

/// Why positions cannot tell what is missing, if so.
fn too_little(model: &Model) -> Option<String> {
    let (poses, readings) = (model.solved.problem.blocks.len(), model.solved.problem.total.rows);
    let numbers = model.solved.fit.columns.len();
    if poses < FEWEST_POSES {
        let given = if poses == 1 { String::from("1 pose is") } else { format!("{poses} poses are") };
        return Some(format!("{given} too few to judge by, at least {FEWEST_POSES} are needed"));
    }
    (readings < 2 * numbers).then(|| format!("{readings} coordinates are too few for {numbers} numbers"))
}

/// When rows that are wild at a model stay all the same.
#[derive(Clone, Copy, PartialEq)]
enum Kept {
    /// Where an effect says what they do with fewer numbers.
    WhereAnEffectSaysIt,
    /// Never: no such effect passed the tests.
    Never,
}

/// What is wild at a model where no row is left out, and whether it stays for an
/// effect's sake; it is none then.
fn wild_at(bench: &mut Bench<'_>, model: &Model, strict: bool, kept: Kept) -> (Wild, bool) {
    let chosen = bench.chosen(&model.named);
    let (whole, _) = bench.regression.at(&model.solved.state, &chosen, &bench.rows);
    let wild = wild_rows(&whole, strict).unwrap_or_default();
    if wild.rows.is_empty() || kept == Kept::Never {
        return (wild, false);
    }
    bench.turn_to(model);
    let readings = whole.total.rows as f64;
    // Which row it is, and where it is instead.
    let numbers = (STANDS + chosen.len() + 4 * wild.rows.len()) as f64;
    let bic = readings * (wild.rss / readings).max(f64::MIN_POSITIVE).ln() + numbers * readings.ln();
    // A slip that only the first or the last row has is that row: with as many numbers.
    let fewer = bic - readings.ln();
    match bench.extended(&model.named).first() {
        Some(best) if best.bic < fewer => (Wild::default(), true),
        _ => (wild, false),
    }
}

/// The best of some proposals, given the best first, in their own form; among equals
/// the one that comes first in the catalogue.
fn refitted(bench: &Bench<'_>, proposals: &[Proposed], from: &Model) -> Vec<Model> {
    let Some(best) = proposals.first().map(|one| one.bic) else { return Vec::new() };
    let near = proposals.iter().take_while(|one| one.bic < best + CURVATURE).take(REFITTED);
    let mut models: Vec<Model> = near.filter_map(|one| bench.solve(&one.named, &from.solved.state)).collect();
    models.sort_by(|a, b| a.bic.total_cmp(&b.bic));
    let Some(best) = models.first().map(|one| one.bic) else { return Vec::new() };
    models.retain(|one| one.bic < best + WITHIN_REACH);
    let equal = models.iter().take_while(|one| one.bic < best + TIE).count();
    models[..equal].sort_by(|a, b| a.named.cmp(&b.named));
    models
}

/// Whether a model's new effects are significant, and it predicts poses left out
/// better than the smaller one.
fn passes(bench: &Bench<'_>, smaller: &Model, better: &Model, options: &Options) -> bool {
    let new = (0..better.named.len()).filter(|&k| !smaller.named.contains(&better.named[k]));
    bench.left_out_rms(&better.solved) < bench.left_out_rms(&smaller.solved)
        && new.map(|k| bench.p_value(&better.named, k, options)).all(|p| p <= options.alpha)
}

/// The model that is better with one effect replaced, or in another form, and without
/// what that makes superfluous, where there is one whose effects are all significant.
fn sideways(bench: &Bench<'_>, model: Model, reference: &Reference, options: &Options) -> Model {
    // An effect the less is worth no more than what its number costs.
    let worth = (model.solved.problem.total.rows as f64).ln() * model.named.len() as f64;
    let mut proposals = bench.reformed(&model.named);
    proposals.extend(bench.replaced(&model.named).into_iter().map(|(_, other)| other));
    proposals.retain(|other| other.bic < model.bic + worth);
    proposals.sort_by(|a, b| a.bic.total_cmp(&b.bic));
    let mut proposals: Vec<Proposed> = proposals.into_iter().take(REPLACED).map(|other| bench.pruned(other)).collect();
    proposals.retain(|other| other.bic < model.bic);
    proposals.sort_by(|a, b| a.bic.total_cmp(&b.bic));
    proposals.dedup_by(|a, b| a.named == b.named);
    let others = refitted(bench, &proposals, &model);
    let better = others.into_iter().find(|other| {
        other.bic < model.bic - BETTER && weakest(bench, other, reference).is_none_or(|(_, p)| p <= options.alpha)
    });
    better.unwrap_or(model)
}

/// The effect of a model that gains least, with the p-value of that much by the
/// distribution of the largest statistic at another step.
fn weakest(bench: &Bench<'_>, model: &Model, reference: &Reference) -> Option<(usize, f64)> {
    let variance = model.solved.fit.rss / model.solved.problem.freedom(&model.solved.fit);
    let p = |k: usize| {
        let rest = all_but(&model.named, k);
        let without = bench.solve(&rest, &model.solved.state).map_or(f64::INFINITY, |rest| rest.solved.fit.rss);
        let price = price(bench.variant(model.named[k]));
        reference.p_value((without - model.solved.fit.rss) / variance - price)
    };
    (0..model.named.len()).map(|k| (k, p(k))).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The model without effects that later ones made superfluous.
fn without_superfluous(bench: &mut Bench<'_>, mut model: Model, reference: &Reference, options: &Options) -> Model {
    while let Some((k, _)) = weakest(bench, &model, reference).filter(|(_, p)| *p > options.alpha) {
        let rest = all_but(&model.named, k);
        let Some(smaller) = bench.solve(&rest, &model.solved.state) else { break };
        bench.turn_to(&smaller);
        model = smaller;
    }
    model
}

/// The model without the effect that accounts for least, where that is less than what
/// is left beyond noise: it may be borrowed from what has no name. `None` where all
/// account for more.
fn without_borrowed(bench: &Bench<'_>, model: &Model, left: &LackOfFit) -> Option<Model> {
    let own = model.solved.fit.rss;
    let smaller = (0..model.named.len()).filter_map(|k| {
        let rest = all_but(&model.named, k);
        bench.solve(&rest, &model.solved.state)
    });
    let least = smaller.min_by(|a, b| a.solved.fit.rss.total_cmp(&b.solved.fit.rss))?;
    (least.solved.fit.rss - own < left.fraction * own).then_some(least)
}

#[cfg(test)]
mod tests {
    use robstiff_robots::{Description, catalogue};

    use super::*;
    use crate::Effect;
    use crate::campaign::Data;
    use crate::campaign::made_positions::Plan;

    /// A name that is not significant goes, and a row that fits comes back.
    #[test]
    fn what_is_not_significant_does_not_stay_named() {
        let text = catalogue::find("kuka-kr270-r2700").expect("in the catalogue");
        let robot = Description::parse("kuka-kr270-r2700.yaml", text).expect("a description");
        let hidden = std::vec![Effect::JointZeroOffset { joint: 3, value: 5e-3 }];
        let campaign = Plan { hidden, ..Plan::new(robot, 1) }.run();
        let Data::Position(data) = &campaign.data else { unreachable!("made of positions") };
        let mut bench = Bench::new(&campaign, data).expect("they tell where the robot stands");
        let start = bench.prepared.state(bench.regression.numbers.len());
        let base = bench.solve(&[], &start).expect("no effects");
        bench.turn_to(&base);
        let names = |bench: &Bench<'_>, named: &[Named]| -> Vec<String> {
            named.iter().map(|one| bench.candidates[one.candidate].name()).collect()
        };
        let single = bench.extended(&[]).into_iter();
        let truth = { single }.find(|one| names(&bench, &one.named) == ["joint_zero_offset@joint 3"]);
        let truth = bench.solve(&truth.expect("in the catalogue").named, &start).expect("physically possible");
        bench.turn_to(&truth);
        for besides in bench.extended(&truth.named).into_iter().take(3) {
            let model = bench.solve(&besides.named, &truth.solved.state).expect("physically possible");
            bench.rows.left_out[10] = true;
            bench.turn_to(&model);
            let mut course = Course::new(model);
            course.settle(&mut bench, false, &Options::default());
            assert_eq!(names(&bench, &course.model.named), ["joint_zero_offset@joint 3"]);
            assert!(course.p_values.len() == 1 && course.p_values[0] < 0.001, "{:?}", course.p_values);
            assert!(!bench.rows.left_out.contains(&true) && !course.unnamed);
            let [step] = &course.steps[..] else { panic!("{} steps", course.steps.len()) };
            assert!(step.outcome.starts_with("no longer significant: "), "{}", step.outcome);
        }
    }
}
