//! A search on its way: what is named, which rows are left out, and when names go again.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use super::bench::{Bench, Model};
use super::crowd::single_rows;
use super::proposals::{extended, sideways, tested, without_borrowed, without_superfluous};
use super::structure::structure;
use crate::identify::positions::regression::STANDS;
use crate::identify::positions::wild::Wild;
use crate::probability::schwarz;
use crate::trace::lack_of_fit::LackOfFit;
use crate::trace::model::Named;
use crate::trace::settle::{dropped_step, without_insignificant};
use crate::trace::step::Step;
use crate::trace::{Options, Progress};

/// Numbers of a table that can be told from each other, and a few effects besides.
const MOST_EFFECTS: usize = 24;

/// The numbers of a wild row: which one it is, and where it is instead.
const WILD: usize = 4;

/// A search on its way.
pub struct Course {
    /// The model.
    pub model: Model,
    /// The rows that are wild.
    pub wild: Wild,
    /// The p-value of each of the model's effects.
    pub p_values: Vec<f64>,
    /// What was tested on the way.
    pub steps: Vec<Step>,
    /// Whether something is missing for which no effect passed every test.
    pub unnamed: bool,
    /// What the model leaves.
    pub left: LackOfFit,
    /// The full names of what was taken back.
    pub taken_back: Vec<String>,
}

impl Course {
    /// One that begins with a model.
    pub fn new(model: Model) -> Self {
        Self {
            model,
            wild: Wild::default(),
            p_values: Vec::new(),
            steps: Vec::new(),
            unnamed: false,
            left: LackOfFit::default(),
            taken_back: Vec::new(),
        }
    }

    /// Schwarz's criterion on all rows, by which courses compare that leave others out: a row
    /// that is wild is fitted exactly, and costs which row it is, and where it is instead.
    pub fn bic_of_all(&self, bench: &Bench<'_>) -> f64 {
        let (solved, wild) = (&self.model.solved, self.wild.rows.len());
        let numbers = bench.parameters(&self.model.named) + WILD * wild;
        schwarz(solved.fit.rss, (solved.problem.total.rows + 3 * wild) as f64, numbers as f64)
    }

    /// Adds effects for as long as something is missing.
    pub fn run(mut self, bench: &mut Bench<'_>, strict: bool, options: &Options, progress: &Progress<'_>) -> Self {
        let mut tried: Vec<Vec<Named>> = Vec::new();
        let mut kept = Kept::WhereAnEffectSaysIt;
        loop {
            let stay = self.leave_wild_out(bench, strict, kept);
            let model = &self.model;
            if model.leaves_nothing() {
                break;
            }
            progress(&format!("searching for effect {}", model.named.len() + 1));
            let Some((mut step, singles, reference, missing)) = tested(bench, model, options) else { break };
            let is_full = model.named.len() >= MOST_EFFECTS;
            if missing && (is_full || tried.contains(&model.named)) {
                self.unnamed = true;
                if is_full {
                    step.too_many(MOST_EFFECTS)
                } else {
                    step.none_passes()
                }
                self.steps.push(step);
                break;
            }
            let better = if missing { extended(bench, model, &singles, options) } else { None };
            if better.is_none() && stay {
                step.outcome = "no effect passes in whose favour wild rows had stayed".to_string();
                self.steps.push(step);
                kept = Kept::Never;
                continue;
            }
            if !missing {
                step.nothing_is_missing();
                self.steps.push(step);
                break;
            }
            tried.push(model.named.clone());
            let Some(mut better) = better else {
                self.unnamed = true;
                step.none_passes();
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
    pub fn leave_wild_out(&mut self, bench: &mut Bench<'_>, strict: bool, kept: Kept) -> bool {
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
        let dropped: Vec<Named> = before.into_iter().filter(|one| !self.model.named.contains(one)).collect();
        let tested = || tested(bench, &self.model, options).map(|(step, _, _, missing)| (step, missing));
        if let Some((step, missing)) = dropped_step(&bench.candidates, &self.model.named, &dropped, tested) {
            self.steps.push(step);
            self.unnamed |= missing;
        }
    }

    /// Asks how sure the effects are and whether structure is left, and takes names back
    /// that may be borrowed.
    pub fn judged(
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
            let gone = self.model.named.iter().filter(|one| !rest.named.contains(one));
            self.taken_back.extend(gone.map(|one| bench.candidates[one.candidate].name()));
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

/// When rows that are wild at a model stay all the same.
#[derive(Clone, Copy, PartialEq)]
pub enum Kept {
    /// Where an effect says what they do with fewer numbers.
    WhereAnEffectSaysIt,
    /// Never: no such effect passed the tests.
    Never,
}

/// What is wild at a model where no row is left out, and whether it stays for an
/// effect's sake; it is none then.
fn wild_at(bench: &mut Bench<'_>, model: &Model, strict: bool, kept: Kept) -> (Wild, bool) {
    let wild = single_rows(bench, model, strict).unwrap_or_default();
    if wild.rows.is_empty() || kept == Kept::Never {
        return (wild, false);
    }
    bench.turn_to(model);
    let readings = bench.readings() as f64;
    let numbers = (STANDS + bench.chosen(&model.named).len() + WILD * wild.rows.len()) as f64;
    let bic = schwarz(wild.rss, readings, numbers);
    // A slip that only the first or the last row has is that row: with as many numbers.
    let fewer = bic - readings.ln();
    match bench.extended(&model.named).first() {
        Some(best) if best.bic < fewer => (Wild::default(), true),
        _ => (wild, false),
    }
}

#[cfg(test)]
mod tests {
    use robstiff_robots::{Description, catalogue};

    use super::*;
    use crate::campaign::Data;
    use crate::campaign::made_positions::Plan;
    use robstiff::Effect;

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
