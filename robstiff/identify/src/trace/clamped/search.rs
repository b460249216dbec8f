//! The search for effects on clamped axes.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use super::alike::Alike;
use super::apart::Apart;
use super::axes::Axes;
use super::bench::Bench;
use super::one_off::one_off;
use super::scatter::may_be_noise;
use super::standing::{Standing, no_axis, refitted};
use super::structure::structure;
use crate::campaign::ClampedRow;
use crate::identify::clamped::wild::Room;
use crate::trace::lack_of_fit::LackOfFit;
use crate::trace::model::{Fitted, Named};
use crate::trace::selection::{BETTER, Selection};
use crate::trace::settle::{dropped_step, without_insignificant};
use crate::trace::step::{Against, Step};
use crate::trace::verdict::FEWEST_POSES;
use crate::trace::{Options, Progress};

/// How many of the best are extended where none of them passes alone.
const EXTENDED: usize = 8;

/// What was found.
pub struct Found {
    /// The regression of the final model.
    pub bench: Bench,
    /// The model and how it was come to.
    pub selection: Selection,
    /// What it leaves.
    pub left: LackOfFit,
    /// The lines of rows that are wild, with the largest of their p-values.
    pub wild: (Vec<usize>, f64),
    /// Why the data cannot tell, if so.
    pub too_little: Option<String>,
}

/// Searches for effects, unless the numbers are in another unit and `other_unit` says so.
///
/// # Errors
/// Why not even the axes' compliances can be fitted.
pub fn search(
    axes: Axes,
    other_unit: Option<String>,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<Found, String> {
    let bench = Bench::new(axes, None);
    let base = bench.fit(&[]).ok_or_else(no_axis)?;
    if let Some(why) = other_unit.or_else(|| too_little(&bench)) {
        let selection = Selection { model: base, p_values: Vec::new(), steps: Vec::new(), unnamed: false };
        let left = LackOfFit::default();
        return Ok(Found { bench, selection, left, wild: (Vec::new(), 1.0), too_little: Some(why) });
    }
    let room = Room::new(&bench.axes.whole().rows);
    let found = from_start(Course::new(bench, base, room), options, progress)?;
    let (model, wild) = (&found.selection.model, &found.wild.0);
    if wild.is_empty() || found.leaves_something() || !may_be_noise(&found.bench, model, wild) {
        return Ok(found);
    }
    // Tests by random signs do not ask for noise that is the same everywhere; what is wild does.
    progress("searching again with all rows, for noise that grows with the torque");
    let whole = Bench::new(found.bench.axes.whole(), None);
    let base = whole.fit(&[]).ok_or_else(no_axis)?;
    from_start(Course::new(whole, base, Room::none()), options, progress)
}

/// What a search finds from its beginning on.
fn from_start(course: Course, options: &Options, progress: &Progress<'_>) -> Result<Found, String> {
    let room = course.room.clone();
    let first = to_end(course, options, progress)?;
    if !first.leaves_something() {
        return Ok(first);
    }
    // What is left beside one number of all axes speaks for what each has of its own.
    let apart = Apart::of(&first.bench, &first.selection.model).filter(Apart::is_as_good);
    let Some(Apart { found: (bench, model), .. }) = apart else { return Ok(first) };
    let mut course = Course::new(bench, model, room);
    course.at.wild.clone_from(&first.wild);
    course.steps.clone_from(&first.selection.steps);
    course.told_apart();
    let other = to_end(course, options, progress)?;
    Ok(if other.leaves_something() { first } else { other })
}

/// What a search finds that goes on from what it has.
fn to_end(mut course: Course, options: &Options, progress: &Progress<'_>) -> Result<Found, String> {
    course.run(options, progress)?;
    if course.set_apart() {
        course.run(options, progress)?;
    }
    if course.set_alike() {
        course.run(options, progress)?;
    }
    let (mut p_values, missing) = course.settle(options)?;
    if missing {
        // Once, for the same may be named and dropped time and again.
        (course.strict, course.unnamed) = (false, false);
        course.run(options, progress)?;
        (p_values, _) = course.settle(options)?;
    }
    let Course { at: Standing { bench, model, wild, .. }, steps, unnamed, .. } = course;
    progress("looking for structure in what is left");
    let left = structure(&bench, &model, options);
    let selection = Selection { model, p_values, steps, unnamed };
    Ok(Found { bench, selection, left, wild, too_little: None })
}

impl Found {
    /// Whether something is missing that has no name.
    fn leaves_something(&self) -> bool {
        self.left.structure || self.selection.unnamed
    }
}

/// A search on its way.
struct Course {
    at: Standing,
    /// How many rows may be left out.
    room: Room,
    /// Whether rows need stand out from noise alone: structure is accounted for.
    strict: bool,
    steps: Vec<Step>,
    unnamed: bool,
}

impl Course {
    /// One that begins with a model, and may leave so many rows out.
    fn new(bench: Bench, model: Fitted, room: Room) -> Self {
        Self { room, at: Standing::new(bench, model), strict: false, steps: Vec::new(), unnamed: false }
    }

    /// Adds effects for as long as something is missing.
    fn run(&mut self, options: &Options, progress: &Progress<'_>) -> Result<(), String> {
        loop {
            if self.at.bench.leaves_nothing(&self.at.model.fit) {
                return Ok(());
            }
            self.look_again()?;
            if self.at.bench.offered(&self.at.model.named).next().is_none() {
                return Ok(());
            }
            progress(&format!("searching for effect {}", self.at.model.named.len() + 1));
            let Some((mut step, single, missing)) = self.tested(options) else { return Ok(()) };
            if !missing {
                step.nothing_is_missing();
                self.steps.push(step);
                if self.strict {
                    return Ok(());
                }
                self.strict = true;
                if self.at.wild_rows(self.strict, &self.room).is_none() {
                    return Ok(());
                }
                continue;
            }
            let accepted = self.accepted(&single, options);
            // What a single row says better needs no effect.
            let bic = accepted.as_ref().map_or(self.at.model.bic, |better| better.bic);
            if let Some(line) = self.without_one(bic, options) {
                step.outcome = format!("line {line} alone says as much");
                self.steps.push(step);
                continue;
            }
            let Some(better) = accepted else {
                self.unnamed = true;
                step.none_passes();
                self.steps.push(step);
                return Ok(());
            };
            let before = (self.at.model.named.clone(), self.at.model.bic);
            self.turn_to(better, options);
            if before.0 == self.at.model.named && before.1 <= self.at.model.bic {
                self.unnamed = true;
                step.outcome = "something is missing, but no effect stays that would say it".to_string();
                self.steps.push(step);
                return Ok(());
            }
            step.came_to(&self.at.names());
            self.steps.push(step);
        }
    }

    /// Turns to effects of each axis where they say what all share better; whether they do.
    fn set_apart(&mut self) -> bool {
        let found = Apart::of(&self.at.bench, &self.at.model).filter(Apart::is_better);
        self.turned_to(found.map(|apart| apart.found))
    }

    /// Turns to gears that all lag or all creep where these data do not tell; whether it does.
    fn set_alike(&mut self) -> bool {
        let found = Alike::of(&self.at.bench, &self.at.model).filter(Alike::is_better);
        self.turned_to(found.map(|alike| alike.found))
    }

    /// Goes on from another model, if there is one; whether there is.
    fn turned_to(&mut self, found: Option<(Bench, Fitted)>) -> bool {
        let Some(found) = found else { return false };
        (self.at.bench, self.at.model) = found;
        (self.strict, self.unnamed) = (false, false);
        self.told_apart();
        true
    }

    /// Says what it has turned to.
    fn told_apart(&mut self) {
        let names: Vec<String> = self.at.names();
        let mut step = Step::bare(names.clone());
        step.came_to(&names);
        self.steps.push(step);
    }

    /// Drops the effects that rows which are left out by now, or effects named since, had made
    /// significant, one by one, and judges rows anew each time; the p-values of those that stay,
    /// and whether something is missing then, which those dropped had said better than others.
    fn settle(&mut self, options: &Options) -> Result<(Vec<f64>, bool), String> {
        let before = self.at.model.named.clone();
        let p_values = loop {
            let p_values = self.at.bench.p_values(&self.at.model.named, options);
            let fit = |rest: &[Named]| self.at.bench.fit(rest);
            let smaller = without_insignificant(&self.at.model.named, &p_values, options, fit);
            let Some((_, smaller)) = smaller else { break p_values };
            self.at.model = smaller;
            // A row that is wild now may take further names with it.
            self.look_again()?;
        };
        // Its form may have changed.
        let stays = |one: &Named| self.at.model.named.iter().any(|other| other.candidate == one.candidate);
        let dropped: Vec<Named> = before.into_iter().filter(|one| !stays(one)).collect();
        let tested = || self.tested(options).map(|(step, _, missing)| (step, missing));
        let told = dropped_step(&self.at.bench.candidates, &self.at.model.named, &dropped, tested);
        let Some((step, missing)) = told else { return Ok((p_values, false)) };
        self.steps.push(step);
        self.unnamed |= missing;
        Ok((p_values, missing))
    }

    /// Judges all rows anew.
    fn look_again(&mut self) -> Result<(), String> {
        self.at.look_again(self.strict, &self.room)
    }

    /// The tests of all candidates against the model, the models with one of them more, the
    /// best first, and whether something is missing, if only what physics does not allow.
    fn tested(&self, options: &Options) -> Option<(Step, Vec<Fitted>, bool)> {
        let (bench, model) = (&self.at.bench, &self.at.model);
        let test = bench.test(&model.named)?;
        let reference = test.reference(options.draws, options.seed);
        let statistics = bench.statistics(&test);
        let single = bench.extended(&model.named);
        let step = Step::against(&bench.candidates, &model.named, |candidate| {
            let with = single.iter().find(|fit| fit.named.iter().any(|one| one.candidate == candidate));
            Against {
                gains: statistics[candidate].map(|(statistic, _)| (statistic, reference.p_value(statistic))),
                bic: with.map(|with| with.bic),
                left_out_rms: with.map(|with| bench.left_out_rms(&with.fit)),
            }
        });
        let missing = statistics.iter().flatten().any(|(gains, _)| reference.p_value(*gains) <= options.alpha);
        Some((step, single, missing))
    }

    /// The first of the best models with one effect more that passes; where none does, with
    /// two. What says a little of many axes may stand before each of these, and not pass: then
    /// axes are asked one by one.
    fn accepted(&self, single: &[Fitted], options: &Options) -> Option<Fitted> {
        let (bench, model) = (&self.at.bench, &self.at.model);
        let pairs = || {
            let extended = single.iter().take(EXTENDED).flat_map(|one| bench.extended(&one.named));
            let mut pairs: Vec<Fitted> = extended.collect();
            pairs.sort_by(|a, b| a.bic.total_cmp(&b.bic));
            bench.accepted(&pairs, model, options)
        };
        let of_axis = |one: &Named| model.named.contains(one) || bench.axis_of(one.candidate).is_some();
        let of_axes = || {
            let own: Vec<Fitted> = single.iter().filter(|one| one.named.iter().all(of_axis)).cloned().collect();
            bench.accepted(&own, model, options)
        };
        bench.accepted(single, model, options).or_else(pairs).or_else(of_axes)
    }

    /// Leaves the row out that alone says what is missing better than a model of this
    /// criterion, if there is one; its line.
    fn without_one(&mut self, bic: f64, options: &Options) -> Option<usize> {
        let off = one_off(&self.at.bench, &self.at.model)?;
        // Not so of what is no number.
        let ClampedRow { axis, line, .. } = self.at.bench.axes.rows[off.row];
        if !(off.p <= options.alpha && off.bic < bic && self.at.room_in(&self.room).is_left(axis)) {
            return None;
        }
        let without = refitted(self.at.bench.axes.without(&[off.row]), &self.at.bench, &self.at.model)?;
        (self.at.bench, self.at.model) = without;
        self.at.wild.0.push(line);
        self.at.wild.1 = off.p.max(self.at.wild.1);
        self.at.kept = true;
        Some(line)
    }

    /// Goes on from a model, or from one that is better with one effect replaced, with
    /// numbers out of grids where they fit best.
    fn turn_to(&mut self, mut better: Fitted, options: &Options) {
        let replaced = self.at.bench.replaced(&better.named).into_iter().map(|(_, model)| model);
        let best = replaced.min_by(|a, b| a.bic.total_cmp(&b.bic)).filter(|best| best.bic < better.bic - BETTER);
        if let Some(other) = best.filter(|other| self.at.bench.is_significant(&other.named, options)) {
            better = other;
        }
        match self.at.bench.at_best(&better.named) {
            Some(best) => (self.at.bench, self.at.model) = best,
            None => self.at.model = better,
        }
        self.at.without_slips();
    }
}

/// Why rows cannot tell what is missing, if so: every row is a witness.
fn too_little(bench: &Bench) -> Option<String> {
    let (rows, numbers) = (bench.axes.rows.len(), bench.base);
    if bench.axes.rows.iter().all(|row| row.deflection == 0.0) {
        return Some(String::from("no axis moves in any row"));
    }
    (rows < FEWEST_POSES.max(3 * numbers)).then(|| {
        format!(
            "{rows} rows are too few to judge {numbers} axes by, at least {} are needed",
            FEWEST_POSES.max(3 * numbers)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Data;
    use crate::identify::clamped::slopes;
    use crate::trace::clamped::tests::{measured, ramp};
    use robstiff_robots::samples::five_axis;

    /// A name that stood on a row which is left out goes, and the row comes back.
    #[test]
    fn what_is_not_significant_does_not_stay_named() {
        let lost = |axis, torque: f64| if axis == 2 { 0.5e-4 * torque / torque.hypot(20.0) } else { 0.0 };
        let campaign = measured(&five_axis(), &ramp(14), 1, lost);
        let Data::Clamped(rows) = &campaign.data else { unreachable!("made of clamped axes") };
        let identified = slopes(&campaign, rows, &[]).expect("every axis is loaded");
        let whole = Bench::new(Axes::new(&campaign.robot, rows, &identified), None);
        let name = |one: &Named| whole.candidates[one.candidate].name();
        let truth = whole.extended(&[]).into_iter().find(|model| name(&model.named[0]) == "lost_motion@joint 2");
        let truth = truth.expect("it is in the catalogue").named;
        let besides = whole.extended(&truth);
        assert!(besides.len() > 5);
        for model in besides {
            let line = whole.axes.rows[40].line;
            let (bench, model) = refitted(whole.axes.without(&[40]), &whole, &model).expect("physically possible");
            let mut course = Course::new(bench, model, Room::new(rows));
            course.at.wild = (std::vec![line], 1e-6);
            let (p_values, _) = course.settle(&Options::default()).expect("the axes show their compliances");
            assert_eq!(course.at.model.named.iter().map(name).collect::<Vec<_>>(), ["lost_motion@joint 2"]);
            assert!(p_values.len() == 1 && p_values[0] < 0.001, "{p_values:?}");
            assert_eq!((course.at.bench.axes.rows.len(), course.at.wild.0.len()), (rows.len(), 0));
            let outcome = &course.steps.last().expect("it says what it dropped").outcome;
            assert!(outcome.starts_with("no longer significant: ") && !course.unnamed, "{outcome}");
        }
        // What is dropped may have said a little of what no one says then.
        let alone = whole.extended(&[]).into_iter().rfind(|model| model.named != truth).expect("it has others");
        let mut course = Course::new(Bench::new(whole.axes.clone(), None), alone, Room::new(rows));
        let (p_values, missing) = course.settle(&Options::default()).expect("the axes show their compliances");
        assert_eq!((p_values.len(), course.steps.len(), missing, course.unnamed), (0, 1, true, true));
        // The search goes on from there.
        course.run(&Options::default(), &|_| {}).expect("the axes show their compliances");
        assert_eq!(course.at.model.named.iter().map(name).collect::<Vec<_>>(), ["lost_motion@joint 2"]);
    }
}
