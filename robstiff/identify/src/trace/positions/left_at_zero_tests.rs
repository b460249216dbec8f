//! What numbers that are left at zero do to how sure the others are.

use std::string::ToString;
use std::vec;
use std::vec::Vec;

use nalgebra::DMatrix;
use robstiff_robots::effect::DhEntry;

use super::bench::{Bench, Model};
use super::spread::{spread_as_declared, spread_of};
use super::tests::six_axis;
use crate::campaign::Data;
use crate::campaign::made_positions::Plan;
use crate::identify::positions::regression::STANDS;
use crate::trace::model::Named;
use robstiff::Effect;

/// So many standard deviations off is no chance.
const BEYOND: f64 = 3.5;

/// A campaign with something hidden, of which some is named: what is done with the model.
fn named<T>(hidden: &[Effect], names: &[Effect], seed: u64, of: impl FnOnce(&Bench<'_>, &Model) -> T) -> T {
    let campaign = Plan { hidden: hidden.to_vec(), ..Plan::new(six_axis(), seed) }.run();
    let Data::Position(data) = &campaign.data else { unreachable!("made of positions") };
    let mut bench = Bench::new(&campaign, data).expect("they tell where the robot stands");
    let candidate = |effect: &Effect| {
        let is_it = |at: &usize| bench.candidates[*at].name() == effect.to_string();
        Named { candidate: (0..bench.candidates.len()).find(is_it).expect("in the catalogue"), variant: 0 }
    };
    let mut names: Vec<Named> = names.iter().map(candidate).collect();
    names.sort_unstable();
    let start = bench.prepared.state(bench.regression.numbers.len());
    let model = bench.solve(&names, &start).expect("physically possible");
    bench.turn_to(&model);
    of(&bench, &model)
}

/// Standard deviations of the effects named, in the order of the model.
fn stds(bench: &Bench<'_>, spread: &DMatrix<f64>) -> Vec<f64> {
    let own = bench.prepared.seen().len();
    (own..spread.nrows()).map(|k| spread[(k, k)].sqrt()).collect()
}

/// Numbers of a table that is off in most of them, but for the twist of the wrist's fifth axis,
/// which positions hardly tell from the length before it.
fn most_of_a_table() -> Vec<Effect> {
    let twist = |row, value| Effect::DhError { entry: DhEntry::Alpha(row), value };
    vec![
        Effect::JointZeroOffset { joint: 2, value: 8e-4 },
        Effect::JointZeroOffset { joint: 3, value: -1.1e-3 },
        Effect::JointZeroOffset { joint: 4, value: 9e-4 },
        Effect::JointZeroOffset { joint: 5, value: -7e-4 },
        Effect::DhError { entry: DhEntry::A(1), value: 4e-4 },
        Effect::DhError { entry: DhEntry::A(2), value: -3e-4 },
        Effect::DhError { entry: DhEntry::A(3), value: 5e-4 },
        Effect::DhError { entry: DhEntry::D(4), value: 3e-4 },
        Effect::DhError { entry: DhEntry::D(5), value: -4e-4 },
        twist(1, 6e-4),
        twist(2, -5e-4),
        twist(3, 4e-4),
        twist(4, -6e-4),
    ]
}

/// Where most of a table is off, what is not named may be, too: no number is told surer than
/// that lets it be.
#[test]
fn numbers_not_named_count_where_most_of_a_table_is_off() {
    for seed in 0..4 {
        let names = most_of_a_table();
        let hidden = [names.clone(), vec![Effect::DhError { entry: DhEntry::Alpha(5), value: 3e-4 }]].concat();
        named(&hidden, &names, seed, |bench, model| {
            let (told, noise) = (stds(bench, &spread_of(bench, model)), stds(bench, &spread_as_declared(model)));
            let mut beyond = 0;
            for (one, (told, noise)) in model.named.iter().zip(told.iter().zip(&noise)) {
                let name = bench.candidates[one.candidate].name();
                let hidden = names.iter().find(|effect| effect.to_string() == name).expect("it is named");
                let value = model.solved.state.values[bench.variant(*one).columns[0] - STANDS];
                let off = (value - hidden.numbers()[0]).abs();
                assert!(off < BEYOND * told, "{seed} {name}: {value} {told}");
                beyond += usize::from(off > BEYOND * noise);
            }
            assert!(beyond > 0, "{seed}: the twist shows in none");
        });
    }
}

/// Where one number of a table is off, the others hardly count.
#[test]
fn numbers_not_named_hardly_count_where_one_is_off() {
    for seed in 0..4 {
        let one = [Effect::DhError { entry: DhEntry::A(2), value: 4e-4 }];
        named(&one, &one, seed, |bench, model| {
            let (told, noise) = (stds(bench, &spread_of(bench, model))[0], stds(bench, &spread_as_declared(model))[0]);
            assert!(told < 1.1 * noise && told > noise, "{seed}: {told} {noise}");
        });
    }
}
