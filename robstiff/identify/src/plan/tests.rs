use std::vec;
use std::vec::Vec;

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::advice::remedies;
use super::criterion::{Criterion, Judge};
use super::exchange::Search;
use super::regressors::{Regressors, Sensor, Visit};
use super::rivals::{Contest, Number, Rival, Rivals};

const NUMBERS: usize = 5;

const CRITERIA: [Criterion; 4] = [Criterion::D, Criterion::Ds, Criterion::T, Criterion::Compound];

/// Candidates of three readings each, two loads a pose; the last two numbers are
/// rivals beside the first three.
fn setting(poses: usize) -> (Rivals, DMatrix<f64>, Vec<DMatrix<f64>>, Vec<Visit>) {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut gram = |rows: usize| {
        let rows = DMatrix::from_fn(rows, NUMBERS, |_, _| random.random_range(-1.0..1.0));
        rows.tr_mul(&rows)
    };
    let rival = |column| Rival { columns: vec![column], values: vec![2.0], parameters: 1 };
    let rivals = Rivals {
        nuisance: Vec::new(),
        model: (0..4).map(|column| Number { column, name: "h".into(), unit: "1", value: 1.0 }).collect(),
        effects: vec![3],
        pairs: vec![Contest::new(["a@x".into(), "b@y".into()], [rival(3), rival(4)], vec![0, 1, 2])],
    };
    let known = gram(8);
    let visits = (0..2 * poses).map(|k| Visit { q: vec![(k / 2) as f64], loads: vec![[k as f64; 6]] });
    (rivals, known, (0..2 * poses).map(|_| gram(3)).collect(), visits.collect())
}

#[test]
fn exchange_is_never_worse_than_its_start() {
    let (rivals, known, information, visits) = setting(30);
    let judge = Judge::new(&known, &rivals, 1.0);
    let search = Search { judge: &judge, known: &known, information: &information, visits: &visits };
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for criterion in CRITERIA {
        let best = search.value(criterion, &search.best(criterion, 6, 4, 1));
        let greedy = search.greedy(criterion, 6);
        for start in (0..10).map(|_| search.drawn(6, &mut random)).chain([greedy.clone()]) {
            let end = search.exchange(criterion, start.clone());
            assert!(search.value(criterion, &end) >= search.value(criterion, &start));
            // What was drawn has room to get better, and gets better.
            assert!(start == greedy || search.value(criterion, &end) > search.value(criterion, &start) + 0.01);
            let poses: Vec<f64> = end.iter().map(|&k| visits[k].q[0]).collect();
            assert!((1..6).all(|k| !poses[..k].contains(&poses[k])), "{poses:?}");
        }
        assert!(best >= search.value(criterion, &greedy));
    }
}

/// Against every set there is.
#[test]
fn exchange_finds_the_best_of_few() {
    let (rivals, known, information, visits) = setting(8);
    let judge = Judge::new(&known, &rivals, 1.0);
    let search = Search { judge: &judge, known: &known, information: &information, visits: &visits };
    for criterion in CRITERIA {
        let pairs = (0..16).flat_map(|i| (i + 1..16).map(move |j| [i, j])).filter(|[i, j]| i / 2 != j / 2);
        let best = pairs.map(|pair| search.value(criterion, &pair)).fold(f64::NEG_INFINITY, f64::max);
        let found = search.value(criterion, &search.best(criterion, 2, 3, 1));
        assert!((found - best).abs() < 1e-9, "{criterion:?}: {found} {best}");
    }
}

/// The separation is what least squares leaves of the truth's readings.
#[test]
fn separation_is_what_the_wrong_model_leaves() {
    let mut random = ChaCha8Rng::seed_from_u64(9);
    let columns = DMatrix::from_fn(40, NUMBERS, |_, _| random.random_range(-1.0..1.0));
    let (rivals, ..) = setting(1);
    let gram = columns.tr_mul(&columns);
    let judge = Judge::new(&gram, &rivals, 0.25);
    let left = |truth: usize, wrong: usize| {
        let readings: DVector<f64> = columns.column(truth) * 2.0;
        let model = columns.select_columns(&[0, 1, 2, wrong]);
        let fitted = model.clone().svd(true, true).solve(&readings, 1e-12).expect("it has vectors");
        (&readings - model * fitted).norm_squared() / 0.25
    };
    let expected = left(3, 4).min(left(4, 3)).sqrt();
    assert!((judge.separations(&gram)[0] / expected - 1.0).abs() < 1e-6);
    // The standard deviations are those of least squares.
    let model = columns.select_columns(&[0, 1, 2, 3]);
    let inverse = model.tr_mul(&model).try_inverse().expect("independent");
    for (k, std) in judge.stds(&gram).into_iter().enumerate() {
        assert!((std / (0.25 * inverse[(k, k)]).sqrt() - 1.0).abs() < 1e-6);
    }
}

/// One column is another, but for what the core takes up.
#[test]
fn aliases_have_no_angle() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    let mut columns = DMatrix::from_fn(40, NUMBERS, |_, _| random.random_range(-1.0..1.0));
    let (rivals, ..) = setting(1);
    let judge = |columns: &DMatrix<f64>| Judge::new(&columns.tr_mul(columns), &rivals, 1.0);
    assert_eq!(judge(&columns).separable(&columns.tr_mul(&columns)), [0]);
    let alias = columns.column(3) * 3.0 + columns.column(1) * 2.0;
    columns.set_column(4, &alias);
    let gram = columns.tr_mul(&columns);
    assert!(judge(&columns).separable(&gram).is_empty() && judge(&columns).angle(&gram, 0) < 1e-4);
}

/// Two effects that are one to visits, and two to encoders.
struct Alike {
    known: DMatrix<f64>,
    apart: DMatrix<f64>,
}

impl Regressors for Alike {
    fn variance(&self) -> f64 {
        1.0
    }

    fn readings(&self, _: &[Visit]) -> usize {
        40
    }

    fn sensors(&self) -> Vec<Sensor> {
        vec![Sensor::Lever, Sensor::Encoders]
    }

    fn known(&self) -> DMatrix<f64> {
        self.known.clone()
    }

    fn likely(&self) -> DMatrix<f64> {
        0.0 * &self.known
    }

    fn information(&self, visits: &[Visit], besides: Option<Sensor>) -> Vec<DMatrix<f64>> {
        let gives = if besides == Some(Sensor::Encoders) { &self.apart } else { &self.known };
        visits.iter().map(|_| gives.clone()).collect()
    }
}

/// Sensors that tell rivals apart are said to, and no others.
#[test]
fn remedies_are_what_tells_apart() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let mut columns = DMatrix::from_fn(40, NUMBERS, |_, _| random.random_range(-1.0..1.0));
    let apart = columns.tr_mul(&columns);
    let alias = columns.column(3) * 3.0;
    columns.set_column(4, &alias);
    let alike = Alike { known: columns.tr_mul(&columns), apart };
    let (rivals, .., visits) = setting(1);
    let judge = Judge::new(&alike.known, &rivals, 1.0);
    let found = remedies(&alike, &judge, &visits, (&rivals.pairs[0], 0), 0.0);
    let [found] = &found[..] else { panic!("{found:?}") };
    assert!(found.words.starts_with("encoders") && found.separation.is_some_and(|sigmas| sigmas > 3.0), "{found:?}");
}
