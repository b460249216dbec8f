//! Traces simulated campaigns of absolute positions by the hundred and counts what
//! came of them.

use clap::Parser;
use robstiff_tests::matrix::interval::interval;
use robstiff_tests::parallel;
use robstiff_tests::positions::{Came, Drawn, draw, run};
use robstiff_tests::reliability;

/// Traces simulated campaigns of absolute positions, and judges what is said of them
#[derive(Parser)]
#[command(name = "positions")]
struct Arguments {
    /// Campaigns of each group
    #[arg(long, default_value_t = 100)]
    count: u64,
    /// Seed of all of them
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads
    #[arg(long, default_value_t = 2)]
    jobs: usize,
    /// Tell of those that are not as they should be
    #[arg(long)]
    wrong: bool,
}

/// What is hidden in a group: so many effects, and whether something outside the
/// catalogue; with what should come of it.
const GROUPS: [(&str, usize, bool); 5] = [
    ("nothing: nothing named", 0, false),
    ("one effect: named, and nothing else", 1, false),
    ("two effects: both named, and nothing else", 2, false),
    ("four effects: all named, and nothing else", 4, false),
    ("something outside the catalogue: no names told as the whole truth", 0, true),
];

fn main() {
    let arguments = Arguments::parse();
    println!("| hidden | runs that matter | as it should be |\n|---|---:|---|");
    let (mut numbers, mut claims) = ([0; 2], Vec::new());
    for (group, (name, effects, outside)) in (0..).zip(GROUPS) {
        let seeds = (0..arguments.count).map(|run| arguments.seed * 1_000_000 + group * 100_000 + run);
        let drawn: Vec<Drawn> = seeds.map(|seed| draw(effects, outside, seed)).filter(|drawn| drawn.matters).collect();
        let came = parallel::each(&drawn, arguments.jobs, run);
        let is_right = |came: &&Came| if outside { !came.whole_truth } else { came.right };
        let right = came.iter().filter(is_right).count();
        for came in came.iter().filter(|came| arguments.wrong && !is_right(came)) {
            eprintln!("{}", came.told);
        }
        let [low, high] = interval(right, came.len()).map(|bound| 100.0 * bound);
        println!("| {name} | {} | {right} [{low:.0}-{high:.0} %] |", came.len());
        for came in came {
            (0..2).for_each(|k| numbers[k] += came.numbers[k]);
            claims.extend(came.claims.into_iter().filter(|_| !outside));
        }
    }
    println!("\nIntervals of 95 % held the truth for {} of {} numbers.", numbers[1], numbers[0]);
    print!("\n{}", reliability::table(&claims));
}
