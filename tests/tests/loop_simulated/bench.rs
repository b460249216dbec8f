//! What all of these tests do: simulate a campaign, write it to files, read
//! them back and trace.

use std::fs;

use robstiff::Effect;
use robstiff_identify::campaign::Campaign;
use robstiff_identify::trace::{NamedEffect, Options, Trace, trace};
use robstiff_robots::Description;
use robstiff_tests::folder::Folder;
use robstiff_tests::judge_tracing::suspected;
use robstiff_tests::simulator::{Scenario, Simulated, five_axis, scattered, six_axis};

/// Noise of one reading on each axis, one sigma (m).
pub const NOISE: f64 = 1e-5;

/// What noise alone leaves of a displacement, a loaded less an unloaded reading
/// (m): the error that no description can get below.
pub const FLOOR: f64 = NOISE * std::f64::consts::SQRT_2;

/// What is added to a plan's seed for that of its joints' compliances.
pub const SCATTER_SEED: u64 = 1000;

/// A campaign of 40 poses with two visits each on an arm with hidden effects.
/// The compliances of its joints are up to 30 % from the declared ones.
pub fn plan(declared: &Description, hidden: &[Effect], seed: u64) -> Scenario {
    let truth = scattered(declared, 0.7..1.3, seed + SCATTER_SEED);
    Scenario { noise: NOISE, ..Scenario::new(truth, hidden.to_vec(), seed) }
}

/// The arm that a campaign is of: with even seeds the five-axis one, with odd ones the six-axis one.
pub fn arm(seed: u64) -> Description {
    if seed.is_multiple_of(2) { five_axis() } else { six_axis() }
}

/// A plan carried out, traced with the arm as declared.
pub fn traced(declared: &Description, hidden: &[Effect], seed: u64) -> Trace {
    trace_files(&plan(declared, hidden, seed).run(), declared, "")
}

/// Writes a campaign, with `more` lines in its `campaign.yaml`, and traces what
/// is read.
pub fn trace_files(simulated: &Simulated, declared: &Description, more: &str) -> Trace {
    trace_text(simulated, declared, &(simulated.campaign_yaml() + more))
}

/// The same with another text of `campaign.yaml`.
pub fn trace_text(simulated: &Simulated, declared: &Description, said: &str) -> Trace {
    let folder = Folder::new();
    simulated.write(&folder.0, &declared.to_yaml()).expect("a temporary folder");
    let path = folder.0.join("campaign.yaml");
    fs::write(&path, said).expect("a temporary file");
    let campaign = Campaign::read(&path).unwrap_or_else(|problem| panic!("{problem}"));
    assert_eq!((&campaign.robot, campaign.warnings.len()), (declared, 0), "{:?}", campaign.warnings);
    trace(&campaign, &Options::default(), &|_| {}).unwrap_or_else(|problem| panic!("{problem}"))
}

/// Whether a name stands for an effect: it is its own, or the data cannot tell
/// it from the effect.
pub fn stands_for(named: &NamedEffect, effect: &Effect) -> bool {
    let name = effect.to_string();
    named.effect.to_string() == name || named.same_as().contains(&name)
}

/// Whether each hidden effect has a name, and there are no others.
pub fn names_all(trace: &Trace, hidden: &[Effect]) -> bool {
    trace.effects.len() == hidden.len()
        && hidden.iter().all(|effect| trace.effects.iter().any(|named| stands_for(named, effect)))
}

/// A trace in a line, for when a count fails.
pub fn told(trace: &Trace) -> String {
    let effects: Vec<String> = trace
        .effects
        .iter()
        .map(|named| {
            let numbers: Vec<String> = named
                .effect
                .parameters
                .iter()
                .map(|p| format!("{} {:.3e} +- {:.0e}", p.name, p.value, p.std.unwrap_or(0.0)))
                .collect();
            format!("{} ({}) = {:?}", named.effect, numbers.join(", "), named.same_as())
        })
        .collect();
    let [identified, after] = [trace.identified, trace.after].map(|misfit| 1e6 * misfit.rms);
    let effects = if effects.is_empty() { "no name".into() } else { effects.join(" + ") };
    let suspected = suspected(trace);
    format!("{}, {identified:.1} -> {after:.1} um: {effects} ({}){suspected}", trace.verdict, trace.why)
}

/// What the final model leaves of the rows that belong to the others (m, one axis).
pub fn left(trace: &Trace) -> f64 {
    let is_off = |line: usize| trace.effects.iter().any(|named| named.lines.contains(&line));
    let rows = trace.residuals.iter().filter(|row| !is_off(row.line));
    let squares: Vec<f64> = rows.flat_map(|row| row.after).map(|one| one * one).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// Asserts that at least so many of the traces, each with its seed, are right.
pub fn assert_most(what: &str, least: usize, traces: &[(u64, Trace)], right: impl Fn(u64, &Trace) -> bool) {
    let right: Vec<bool> = traces.iter().map(|(seed, trace)| right(*seed, trace)).collect();
    let count = right.iter().filter(|right| **right).count();
    let line = |((seed, trace), right): (&(u64, Trace), &bool)| {
        format!("{} seed {seed}: {}", if *right { "right" } else { "WRONG" }, told(trace))
    };
    let all: Vec<String> = traces.iter().zip(&right).map(line).collect();
    // Seen when the test fails, or asked for with --nocapture.
    println!("{what}: {count} of {}\n{}", traces.len(), all.join("\n"));
    assert!(count >= least, "{what}: {count} of {} are right, at least {least} are expected", traces.len());
}
