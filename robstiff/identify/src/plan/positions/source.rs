//! Which numbers of the regression of positions planning looks at, and which effects
//! rival: what the adapter of positions takes from a trace.

use std::string::{String, ToString};
use std::vec::Vec;

use crate::identify::Error;
use crate::identify::positions::model::State;
use crate::identify::positions::regression::STANDS;
use crate::plan::rivals::{Group, Number, Rival, Rivals, computed, pairs};
use crate::trace::Trace;
use crate::trace::catalogue::OUTLIERS;
use crate::trace::found::full_name;
use crate::trace::model::Named;
use crate::trace::positions::bench::{Bench, Model};

/// What a calibration asks for where nothing else is: the kinematics as declared.
const OF_THE_TABLE: [&str; 2] = ["joint_zero_offset", "dh_error"];

/// The rivals of a trace; the numbers of the regression that they and the model have, by
/// index; and the state of the model. In columns, where the robot stands comes first,
/// then those numbers.
///
/// # Errors
/// A trace of other positions than these.
pub fn rivals(bench: &mut Bench<'_>, trace: &Trace, groups: &[Group]) -> Result<(Rivals, Vec<usize>, State), Error> {
    leave_out_wild(bench, trace);
    let named = |effect: &crate::trace::NamedEffect| (effect.effect.to_string(), bench.named(&effect.effect));
    let named: Vec<(String, Option<Named>)> = trace.effects.iter().map(named).collect();
    let form = |name: &str| named.iter().find(|(other, _)| other == name).and_then(|(_, form)| *form);
    let start = bench.prepared.state(bench.regression.numbers.len());
    let without = |own: Option<&str>| {
        let others = named.iter().filter(|(name, _)| Some(name.as_str()) != own);
        let mut others: Vec<Named> = others.filter_map(|(_, form)| *form).collect();
        others.sort_unstable();
        others
    };
    let model = solved(bench, &without(None), &start)?;
    let own: Vec<usize> = bench.prepared.seen();
    let mut whole = bench.chosen(&model.named);
    let is_kinematic = |&number: &usize| bench.prepared.own.get(number).is_some_and(|own| !own.is_compliance());
    if whole.iter().all(is_kinematic) {
        bench.turn_to(&model);
        whole = with_the_table(bench, &whole);
    }
    let mut kept: Vec<usize> = Vec::new();
    let mut columns = |numbers: &[usize]| -> Vec<usize> {
        let mut place = |number: usize| {
            kept.iter().position(|&other| other == number).unwrap_or_else(|| {
                kept.push(number);
                kept.len() - 1
            })
        };
        numbers.iter().map(|&number| STANDS + place(number)).collect()
    };
    let stands: Vec<usize> = (0..STANDS).collect();
    let of_model = columns(&whole);
    let effects: Vec<usize> = whole.iter().copied().filter(|number| !own.contains(number)).collect();
    let effects = if model.named.is_empty() { Vec::new() } else { columns(&effects) };
    let mut contests = Vec::new();
    for Group { named: at, names } in groups {
        let at = at.map(|k| trace.effects[k].effect.to_string());
        let rest = solved(bench, &without(at.as_deref()), &model.solved.state)?;
        bench.turn_to(&rest);
        let core = [&stands[..], &columns(&bench.chosen(&rest.named))].concat();
        let found = computed(names).filter_map(|name| {
            let candidate = bench.candidates.iter().position(|candidate| candidate.name() == *name)?;
            let mut with = match form(name) {
                Some(form) => [&rest.named[..], &[form]].concat(),
                None => bench.with(&rest.named, candidate)?.named,
            };
            with.sort_unstable();
            let with = bench.solve(&with, &rest.solved.state)?;
            let one = *with.named.iter().find(|one| one.candidate == candidate)?;
            let form = bench.variant(one);
            let numbers: Vec<usize> = form.columns.iter().map(|column| column - STANDS).collect();
            let values = numbers.iter().map(|&number| with.solved.state.values[number]).collect();
            Some((name.clone(), Rival { columns: columns(&numbers), values, parameters: form.parameters }))
        });
        contests.extend(pairs(&found.collect::<Vec<_>>(), &core));
    }
    let number = |(&number, column)| told(bench, number, column, &model.solved.state);
    let numbers = whole.iter().zip(of_model).map(number).collect();
    let rivals = Rivals { nuisance: stands, model: numbers, effects, pairs: contests };
    Ok((rivals, kept, model.solved.state))
}

/// Leaves out the rows that a trace calls wild.
fn leave_out_wild(bench: &mut Bench<'_>, trace: &Trace) {
    let wild = trace.effects.iter().filter(|named| named.effect.kind() == OUTLIERS.name);
    let lines: Vec<usize> = wild.flat_map(|named| named.lines.iter().copied()).collect();
    for (left_out, row) in bench.rows.left_out.iter_mut().zip(&bench.prepared.data.rows) {
        *left_out = lines.contains(&row.line);
    }
}

fn solved(bench: &Bench<'_>, named: &[Named], from: &State) -> Result<Model, Error> {
    bench
        .solve(named, from)
        .ok_or_else(|| Error::NotShown(String::from("these positions do not tell the numbers of the trace")))
}

/// Some numbers with those of the table and of zeros that these positions tell from them
/// and each other and from another stand of the robot.
fn with_the_table(bench: &Bench<'_>, own: &[usize]) -> Vec<usize> {
    let candidates = bench.candidates.iter().filter(|candidate| OF_THE_TABLE.contains(&candidate.kind.name));
    let of_table = candidates.flat_map(|candidate| &candidate.variants[0].columns).map(|column| column - STANDS);
    bench.independent(&own.iter().copied().chain(of_table).collect::<Vec<usize>>())
}

/// What a number of the regression is, whose column is this among those kept.
fn told(bench: &Bench<'_>, number: usize, column: usize, state: &State) -> Number {
    let own = bench.prepared.own.len();
    let value = state.values[number];
    let Some(of_effect) = number.checked_sub(own) else {
        let own = &bench.prepared.own[number];
        return Number { column, name: own.name.clone(), unit: own.unit, value };
    };
    let of_catalogue = STANDS + number;
    let has = |variants: &[crate::trace::catalogue::Variant]| {
        variants.iter().any(|form| form.columns.contains(&of_catalogue))
    };
    let candidate = bench.candidates.iter().find(|candidate| has(&candidate.variants));
    let effect = candidate.map(|candidate| candidate.name()).unwrap_or_default();
    let number = &bench.numbers[of_effect];
    Number { column, name: full_name(&effect, number.name), unit: number.unit, value }
}
