//! What a slip may as well be: a gear that remembers its loads shifts where they turn, too.

use std::format;
use std::string::String;
use std::vec::Vec;

use robstiff_robots::effect::Place as Part;

use super::axes::{SLIPPED_AXIS, axes_column};
use super::bench::Bench;
use crate::identify::clamped::regression::problem;
use crate::identify::normal::Sign;
use crate::trace::catalogue::{CREEP, HYSTERESIS, LOST_MOTION, STIFFNESS_NONLINEARITY, axis_tells_hysteresis};
use crate::trace::found::Place;
use crate::trace::model::{Fitted, Named, all_but};
use crate::trace::selection::WITHIN_REACH;
use crate::trace::slip::SLIPPED_AT;

/// So many steps of the torque, up to the largest, may be the end of a dead zone.
const RADII: u8 = 60;

/// A model without a slip.
pub struct Instead {
    /// The effect of the gear that takes the slip's place.
    pub name: String,
    /// With its numbers out of grids where they fit best.
    pub found: (Bench, Fitted),
}

/// Whether an effect shifts an axis from its first row on, as lost motion does that is loaded one
/// way: the gear is asked first.
pub fn shifts_all(bench: &Bench, one: Named) -> bool {
    let whole = bench.axes.whole();
    let first = |axis: usize| whole.rows[whole.rows_of(axis)[0]].line as f64;
    let line = bench.form(one).told.iter().find(|number| number.name == SLIPPED_AT);
    axis_of_slip(bench, one).zip(line).is_some_and(|(axis, line)| first(axis) == line.value)
}

/// The models in which the gear of the axis does what a slip of some effects had said, which
/// may be by other numbers of what is named already; the best first. A search by grids puts
/// a slip before them, which has no grid but that of the rows.
pub fn instead_of_slip(bench: &Bench, named: &[Named], slip: usize) -> Vec<Instead> {
    let Some(axis) = axis_of_slip(bench, named[slip]) else { return Vec::new() };
    let rest = all_but(named, slip);
    let of_gear = |candidate: usize| {
        let one = &bench.candidates[candidate];
        one.place == Part::Joint(axis).into()
            && [&HYSTERESIS, &STIFFNESS_NONLINEARITY, &LOST_MOTION, &CREEP].contains(&one.kind)
    };
    let with = |candidate: usize| {
        let mut other: Vec<Named> = rest.iter().copied().filter(|one| one.candidate != candidate).collect();
        other.push(Named { candidate, variant: 0 });
        other.sort_unstable();
        let found = bench.anew_in_any_form(&other, candidate)?;
        Some(Instead { name: bench.candidates[candidate].name(), found })
    };
    let mut found: Vec<Instead> = (0..bench.candidates.len()).filter(|&k| of_gear(k)).filter_map(with).collect();
    found.sort_by(|a, b| a.found.1.bic.total_cmp(&b.found.1.bic));
    found
}

/// The names of effects that say as much as a slip of a model.
pub fn as_good_as_slip(bench: &Bench, model: &Fitted, slip: usize) -> Vec<String> {
    let near = |bic: &f64| *bic < model.bic + WITHIN_REACH;
    let others = instead_of_slip(bench, &model.named, slip).into_iter();
    let gears = others.filter(|instead| near(&instead.found.1.bic)).map(|instead| instead.name);
    gears.chain(dead_zone(bench, model, slip).filter(|(_, bic)| near(bic)).map(|(name, _)| name)).collect()
}

/// The hysteresis of the axis where its loads never go back, a dead zone that is told as a curve
/// of the gear: its kink is more than the curve says, and may look like a slip beside it. With
/// the criterion of the model in which it takes the place of both.
fn dead_zone(bench: &Bench, model: &Fitted, slip: usize) -> Option<(String, f64)> {
    let axes = &bench.axes;
    let axis = axis_of_slip(bench, model.named[slip]).filter(|&axis| !axis_tells_hysteresis(axes, axis))?;
    let place = Place::from(Part::Joint(axis));
    let mut rest = all_but(&model.named, slip);
    rest.retain(|one| bench.candidates[one.candidate].place != place);
    let base: Vec<usize> = bench.columns(&rest);
    let raw = bench.raw.select_columns(&base);
    // The weight of a play is no less than zero, as compliances are: what hardens has no dead zone.
    let weight = base.len();
    let own = base.iter().map(|&column| bench.signs[column]);
    let signs: Vec<Sign> = own.chain([Sign::Nonnegative]).collect();
    let (rows, torques, largest) = (axes.rows_of(axis), axes.loads(axis), axes.largest(axis));
    let left = |radius: f64| {
        let turns = torques.iter().map(|torque| torque - torque.clamp(-radius, radius));
        let mut with = raw.clone().insert_column(weight, 0.0);
        with.set_column(weight, &axes_column(axes.rows.len(), &rows, turns));
        let all: Vec<usize> = (0..with.ncols()).collect();
        let fit = problem(&axes.rows, with).total.solve_signed(&all, &signs)?;
        (fit.coefficients[weight] > 0.0).then_some(fit.rss)
    };
    let radii = (1..RADII).map(|k| largest * f64::from(k) / f64::from(RADII));
    let rss = radii.filter_map(left).min_by(f64::total_cmp)?;
    Some((format!("{}@{place}", HYSTERESIS.name), bench.bic(rss, &rest, 2)))
}

/// The axis of a slip, if it is one.
fn axis_of_slip(bench: &Bench, one: Named) -> Option<usize> {
    let axis = bench.form(one).told.iter().find(|number| number.name == SLIPPED_AXIS)?;
    Some(axis.value as usize)
}
