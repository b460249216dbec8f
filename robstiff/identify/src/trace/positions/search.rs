//! The search for effects in absolute positions.
//!
//! Forward, an effect at a time, each in its own form: the model is fitted, turned to,
//! and every candidate tested against it. A kinematic table has some twenty numbers,
//! all of which can be a little off, so the search goes on for as long as something
//! is significant; and what a later effect makes superfluous is dropped again.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::bench::{Bench, Model};
use super::beyond;
use super::course::{Course, Kept};
use super::stand_ins::instead_of_stand_ins;
use super::structure::structure;
use super::wander::instead_of_slips;
use crate::campaign::Campaign;
use crate::identify::in_other_unit;
use crate::identify::positions::wild::Wild;
use crate::trace::lack_of_fit::LackOfFit;
use crate::trace::model::Fitted;
use crate::trace::selection::Selection;
use crate::trace::verdict::too_few;
use crate::trace::wander::AGAIN;
use crate::trace::{Options, Progress, Rival};

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
    /// The full names of what was taken back.
    pub taken_back: Vec<String>,
    /// What is left looks like these, each as a noun for a sentence.
    pub looks_like: Vec<String>,
    /// Another model that is about as good, come to from elsewhere.
    pub rival: Option<Rival>,
    /// Why the data cannot tell, if so.
    pub too_little: Option<String>,
}

/// Searches for effects, and holds what is found against what has no name.
///
/// # Errors
/// Why not even the description's own numbers can be fitted.
pub fn search<'c>(
    campaign: &Campaign,
    mut bench: Bench<'c>,
    options: &Options,
    progress: &Progress<'_>,
) -> Result<Searched<'c>, String> {
    let noise = campaign.noise_of_reading();
    let start = bench.prepared.state(bench.regression.numbers.len());
    let base = bench
        .solve(&[], &start)
        .ok_or_else(|| String::from("these positions do not tell the description's own numbers from each other"))?;
    bench.turn_to(&base);
    let too_little = in_other_unit(campaign).or_else(|| too_little(&base));
    let (mut course, mut looks_like, mut rival) = (Course::new(base.clone()), Vec::<String>::new(), None);
    if too_little.is_none() {
        course = ended(course, &mut bench, noise, options, progress);
        // The stages of what goes on are those that were told before.
        let goes_on = |course: Course, wide: &mut Bench<'c>| ended(course, wide, noise, options, &|_| ());
        progress("holding faults of the rig against lengths");
        (course, rival) = instead_of_stand_ins(&mut bench, course, options, goes_on);
        progress("looking for what has no name in the catalogue");
        let mut instead = instead_of_slips(&mut bench, &course);
        if instead.is_none()
            && let Some(beyond) = beyond::search(campaign, &mut bench, &course, goes_on)
        {
            (bench, course, looks_like) = (beyond.bench, beyond.course, beyond.looks_like);
            rival = None;
            instead = instead_of_slips(&mut bench, &course);
        }
        if let Some((without, wanders)) = instead {
            (course, rival) = (without, None);
            looks_like.retain(|words| !words.starts_with(AGAIN));
            looks_like.push(wanders);
        }
        if !looks_like.is_empty() {
            course.left = structure(&bench, &course.model, noise, options);
            course.left.structure = true;
        }
    }
    let Course { model, wild, p_values, steps, unnamed, left, taken_back } = course;
    let fitted = Fitted { named: model.named.clone(), fit: model.solved.fit.clone(), bic: model.bic, physical: true };
    let selection = Selection { model: fitted, p_values, steps, unnamed };
    Ok(Searched { bench, base, model, selection, left, wild, taken_back, looks_like, rival, too_little })
}

/// A course at its end, from where it is; `noise` is the one that is declared (m).
fn ended(
    course: Course,
    bench: &mut Bench<'_>,
    noise: Option<f64>,
    options: &Options,
    progress: &Progress<'_>,
) -> Course {
    let mut course = course.run(bench, false, options, progress).judged(bench, false, noise, options, progress);
    if !course.left.structure && !course.unnamed {
        // With structure accounted for, rows need stand out from noise alone.
        let before = course.wild.rows.clone();
        let stay = course.leave_wild_out(bench, true, Kept::WhereAnEffectSaysIt);
        if course.wild.rows != before || stay {
            course = course.run(bench, true, options, progress).judged(bench, true, noise, options, progress);
        }
    }
    course
}

/// Why positions cannot tell what is missing, if so.
fn too_little(model: &Model) -> Option<String> {
    let (readings, numbers) = (model.solved.problem.total.rows, model.solved.fit.columns.len());
    let of_readings = || format!("{readings} coordinates are too few for {numbers} numbers");
    too_few(model.solved.problem.blocks.len()).or_else(|| (readings < 2 * numbers).then(of_readings))
}
