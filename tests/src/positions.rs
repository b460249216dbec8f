//! Campaigns of absolute positions drawn at random, and what tracing makes of them.

use std::f64::consts::PI;
use std::fs;

use nalgebra::{DMatrix, DVector};
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_identify::campaign::{Campaign, Noise};
use robstiff_identify::predict::predict;
use robstiff_identify::trace::{Options, Trace, Verdict, trace};
use robstiff_robots::{Description, Effect};

use crate::folder::Folder;
use crate::judge_tracing::{Name, Told, claims};
use crate::reliability::Claim;
use crate::simulator::{DhColumn, Follows, Hidden, Outside, Positions, five_axis, scattered, six_axis};

/// Payloads that show what yields (kg).
pub const PAYLOADS: [f64; 3] = [0.0, 100.0, 200.0];

/// What is hidden leaves at least this many times the noise, or does not matter.
const MATTERS: f64 = 2.0;

/// What is hidden in a campaign.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The campaign.
    pub positions: Positions,
    /// The robot as declared.
    pub declared: Description,
    /// Whether every one of what is hidden matters.
    pub matters: bool,
}

/// What came of one.
#[derive(Clone, Debug)]
pub struct Came {
    /// What is hidden, and what is told of it, for people.
    pub told: String,
    /// Whether all that is hidden is named, up to what is listed as alike, and nothing
    /// else, and that is the whole truth.
    pub right: bool,
    /// Whether names are told as the whole truth, or that nothing is missing.
    pub whole_truth: bool,
    /// Numbers of effects that were named as hidden, and those of them whose 95 %
    /// interval holds the truth.
    pub numbers: [usize; 2],
    /// The classes that a probability is reported of.
    pub claims: Vec<Claim>,
}

/// Reads a simulated campaign back from files, with its noise declared; `reflector` is where the
/// file says that it is.
///
/// # Panics
/// Where files cannot be written or the campaign cannot be read.
pub fn read(positions: &Positions, declared: &Description, reflector: [f64; 3]) -> Campaign {
    let folder = Folder::new();
    let write = |file: &str, text: &str| fs::write(folder.0.join(file), text).expect("a temporary file");
    write("robot.yaml", &declared.to_yaml());
    write("campaign.yaml", &Positions::campaign(reflector));
    write("positions.csv", &positions.table());
    let campaign = Campaign::read(folder.0.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    let noise = positions.noise[0].hypot(positions.noise[1]);
    let noise = Noise { displacement: (noise > 0.0).then_some(noise), rotation: None };
    Campaign { noise, ..campaign }
}

/// A campaign with so many effects of the catalogue hidden, or with something outside
/// it.
pub fn draw(effects: usize, outside: bool, seed: u64) -> Drawn {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let declared = if seed.is_multiple_of(2) { five_axis() } else { six_axis() };
    let mut positions = Positions::new(scattered(&declared, 0.7..1.3, seed), seed);
    if random.random::<bool>() {
        positions.payloads = PAYLOADS.to_vec();
    }
    while positions.hidden.len() < effects {
        let one = effect(&mut random, declared.joints.len(), positions.payloads.len() > 1);
        // Two at one place are one.
        if positions.hidden.iter().all(|other| other.name() != one.name()) {
            positions.hidden.push(one);
        }
    }
    if outside {
        positions.hidden.push(beyond(&mut random, declared.joints.len()));
    }
    let matters = positions.hidden.iter().all(|one| matters(one, &positions));
    Drawn { positions, declared, matters }
}

/// Whether an effect alone leaves more than noise when the robot's stand and its
/// compliances are fitted.
fn matters(hidden: &Hidden, positions: &Positions) -> bool {
    let noise = positions.noise[0].hypot(positions.noise[1]);
    let exact = Positions { hidden: vec![hidden.clone()], noise: [0.0; 2], ..positions.clone() };
    let campaign = read(&exact, &exact.truth, exact.reflector);
    let off = |robot: &Description| -> Option<DVector<f64>> {
        let rows = predict(robot, &campaign).ok()?.rows;
        Some(DVector::from_iterator(3 * rows.len(), rows.iter().flat_map(|row| row.off)))
    };
    let softer = |joint: usize| {
        let mut softer = exact.truth.clone();
        softer.joints[joint].compliance.iter_mut().for_each(|part| part.value *= 1.01);
        off(&softer)
    };
    let Some(declared) = off(&exact.truth) else { return false };
    let columns = (0..exact.truth.joints.len()).filter_map(|joint| Some(softer(joint)? - &declared));
    let columns = DMatrix::from_columns(&columns.collect::<Vec<_>>());
    let fitted = columns.clone().svd(true, true).solve(&declared, 1e-9 * declared.norm()).ok();
    let left = fitted.map_or(declared.clone(), |by| declared - columns * by);
    (left.norm_squared() / left.len() as f64).sqrt() >= MATTERS * noise
}

/// An effect of the catalogue, of a size that a robot has.
fn effect(random: &mut ChaCha8Rng, joints: usize, payloads: bool) -> Hidden {
    let sign = if random.random() { 1.0 } else { -1.0 };
    let size = |random: &mut ChaCha8Rng, least: f64, most: f64| sign * random.random_range(least..most);
    let joint = random.random_range(2..=joints);
    match random.random_range(0..if payloads { 14 } else { 9 }) {
        0 => Hidden::JointZeroOffset { joint, offset: size(random, 3e-4, 5e-3) },
        1 => Hidden::DhError { of: DhColumn::A, row: random.random_range(1..=joints), by: size(random, 1e-4, 2e-3) },
        2 => Hidden::DhError { of: DhColumn::D, row: joint, by: size(random, 1e-4, 2e-3) },
        3 => {
            Hidden::DhError { of: DhColumn::Alpha, row: random.random_range(1..=joints), by: size(random, 2e-4, 2e-3) }
        }
        4 => {
            let (order, sin) = (random.random_range(1..=3), size(random, 2e-4, 1e-3));
            Hidden::TransmissionError { joint, order, sin, cos: size(random, 1e-4, 5e-4) }
        }
        5 => {
            let when = random.random_range(0.2..0.8);
            let mut three = |most: f64| std::array::from_fn(|_| random.random_range(-most..most));
            Hidden::BaseSlip { shift: three(5e-4), turn: three(2e-4), when }
        }
        6 => Hidden::TrackerScale(size(random, 1e-4, 5e-4)),
        7 => Hidden::Expansion { rate: random.random_range(15e-6..60e-6), follows: Follows::Temperature },
        8 => {
            let rate = std::array::from_fn(|_| random.random_range(-4e-4..4e-4));
            Hidden::ThermalDrift { rate, follows: Follows::Settling(random.random_range(300.0..2000.0)) }
        }
        9 => Effect::TransverseCompliance { joint, value: random.random_range(2e-7..1.5e-6) }.into(),
        10 => {
            let added = random.random_range(2e-7..6e-7);
            Effect::StiffnessNonlinearity { joint, added, knee: random.random_range(200.0..1500.0) }.into()
        }
        11 => {
            let (gap, knee) = (random.random_range(1e-4..4e-4), random.random_range(20.0..150.0));
            Hidden::LostMotion { joint, gap, knee }
        }
        12 => Hidden::LeverArm(std::array::from_fn(|_| random.random_range(-0.2..0.2))),
        _ => {
            let (once, change) = (random.random::<bool>(), size(random, 0.1, 0.3));
            let (sin, cos) = random.random_range(0.0..PI).sin_cos();
            let of = |wave: f64| if once { [wave, 0.0] } else { [0.0, wave] };
            Hidden::PoseDependentCompliance { joint, cos: of(change * cos), sin: of(change * sin) }
        }
    }
}

/// What no effect of the catalogue is.
fn beyond(random: &mut ChaCha8Rng, joints: usize) -> Hidden {
    if random.random::<bool>() {
        let anchor = [random.random_range(-0.5..0.5), random.random_range(1.0..2.0), 2.5];
        return Hidden::Outside(Outside::Cable {
            link: 3,
            anchor,
            stiffness: random.random_range(1e3..4e3),
            length: 0.5,
        });
    }
    let order = *[4, 5, 6].choose(random).expect("three");
    let (sin, cos) = (random.random_range(2e-4..6e-4), random.random_range(-2e-4..2e-4));
    Hidden::TransmissionError { joint: random.random_range(2..joints), order, sin, cos }
}

/// Traces a campaign, and holds what is told against what is hidden.
///
/// # Panics
/// Where it cannot be traced.
pub fn run(drawn: &Drawn) -> Came {
    let campaign = read(&drawn.positions, &drawn.declared, drawn.positions.reflector);
    let trace = trace(&campaign, &Options::default(), &|_| {}).unwrap_or_else(|problem| panic!("{problem}"));
    let told = Told::of(&trace).names;
    let hidden = &drawn.positions.hidden;
    let is_one = |name: &Name, hidden: &Hidden| name.name == hidden.name() || name.same_as.contains(&hidden.name());
    let all = hidden.iter().all(|hidden| told.iter().any(|name| is_one(name, hidden)));
    let only = told.iter().all(|name| hidden.iter().any(|hidden| is_one(name, hidden)));
    let whole = if hidden.is_empty() { Verdict::Adequate } else { Verdict::Explained };
    let right = all && only && trace.verdict == whole;
    // What stands for two has the numbers of neither.
    let each = told.len() == hidden.len() && hidden.iter().all(|hidden| told.iter().any(|n| n.name == hidden.name()));
    let numbers = if right && each { numbers(&trace, hidden) } else { [0; 2] };
    let names = |names: Vec<String>| names.join(" + ");
    let told = format!(
        "seed {}: {}; told {} ({}): {}",
        drawn.positions.seed,
        names(hidden.iter().map(Hidden::name).collect()),
        trace.verdict,
        trace.why,
        names(told.into_iter().map(|name| name.name).collect())
    );
    let whole_truth = matches!(trace.verdict, Verdict::Explained | Verdict::Adequate);
    let hidden: Vec<String> = hidden.iter().map(Hidden::name).collect();
    Came { told, right, whole_truth, numbers, claims: claims(&trace, &hidden, |_, _| false) }
}

/// Of the numbers, but those of drifts, that were named as they are hidden, how many there are, and
/// how many have the truth within 1.96 standard deviations.
fn numbers(trace: &Trace, hidden: &[Hidden]) -> [usize; 2] {
    let mut count = [0; 2];
    // A trace has other numbers of these.
    let drifts = |hidden: &&Hidden| matches!(hidden, Hidden::Expansion { .. } | Hidden::ThermalDrift { .. });
    for hidden in hidden.iter().filter(|hidden| !drifts(hidden)) {
        let Some(named) = trace.effects.iter().find(|named| named.effect.to_string() == hidden.name()) else {
            continue;
        };
        // A simpler form has taken up the rest.
        let of_truth = hidden.parameters().iter().filter(|(_, truth)| *truth != 0.0).count();
        if named.effect.parameters.iter().filter(|number| number.std.is_some()).count() < of_truth {
            continue;
        }
        for (name, truth) in hidden.parameters() {
            let told = named.effect.parameters.iter().find(|number| number.name == name);
            let Some((value, std)) = told.and_then(|number| Some((number.value, number.std?))) else { continue };
            count[0] += 1;
            count[1] += usize::from((value - truth).abs() <= 1.96 * std);
        }
    }
    count
}
