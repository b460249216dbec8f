//! Traces simulated campaigns by the hundred and counts what came of them.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fs, process, thread};

use clap::{Parser, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use robstiff_tests::matrix::{Case, Group, POSES, Record, groups, run_keeping, shares, table};
use robstiff_tests::reliability::{self, Claim};

/// Traces simulated campaigns with something hidden in them, and judges what is said of them
#[derive(Parser)]
#[command(name = "matrix")]
struct Arguments {
    /// How many campaigns, shared out among the groups
    #[arg(long, default_value_t = 496)]
    count: usize,
    /// Seed of all of them
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only these groups: kinds, or nothing, one, two, three, outside, beside
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// Only this arm
    #[arg(long)]
    arm: Option<ArmName>,
    /// Poses of each campaign, of ten rows each
    #[arg(long, default_value_t = POSES)]
    poses: usize,
    /// Threads
    #[arg(long, default_value_t = 2)]
    jobs: usize,
    /// Where all runs are written, and beside it all numbers with an interval and all classes
    #[arg(long, default_value = "target/matrix.csv")]
    csv: PathBuf,
    /// Where the reliability diagram is drawn
    #[arg(long)]
    diagram: Option<PathBuf>,
    /// A folder for all campaigns, to trace one by hand
    #[arg(long)]
    keep: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum ArmName {
    Five,
    Six,
}

fn main() {
    let arguments = Arguments::parse();
    let chosen: Vec<Group> = groups().into_iter().filter(|group| is_asked_for(*group, &arguments.only)).collect();
    if chosen.is_empty() {
        let names: Vec<&str> = groups().into_iter().map(Group::name).collect();
        eprintln!("there is no group of that name; there are: {}", names.join(", "));
        process::exit(2);
    }
    let cases = cases(&chosen, &arguments);
    let records = run_all(&cases, arguments.jobs.max(1), arguments.keep.as_deref());
    print!("{}", table::markdown(&records));
    // What is outside the catalogue has no probability: that of a name is of the candidates that there are.
    let inside = records.iter().filter(|record| !record.ready.case.group.hides_what_is_outside());
    let claims: Vec<Claim> = inside.flat_map(|record| record.claims.iter().cloned()).collect();
    let named: Vec<Claim> = claims.iter().filter(|claim| claim.why_not.is_none()).cloned().collect();
    print!(
        "\nAll classes:\n\n{}\nThose that are named:\n\n{}",
        reliability::table(&claims),
        reliability::table(&named)
    );
    if let Some(folder) = arguments.csv.parent() {
        fs::create_dir_all(folder).unwrap_or_else(|problem| fail(&arguments.csv, &problem));
    }
    let write = |path: &Path, text: String| fs::write(path, text).unwrap_or_else(|problem| fail(path, &problem));
    write(&arguments.csv, table::csv(&records));
    write(&arguments.csv.with_extension("numbers.csv"), table::numbers_csv(&records));
    write(&arguments.csv.with_extension("claims.csv"), table::claims_csv(&records));
    if let Some(path) = &arguments.diagram {
        write(path, reliability::diagram(&claims));
    }
}

fn fail(path: &Path, problem: &std::io::Error) -> ! {
    eprintln!("{}: {problem}", path.display());
    process::exit(1)
}

fn is_asked_for(group: Group, only: &[String]) -> bool {
    let family = match group {
        Group::One(_) => "one",
        Group::Outside(_) => "outside",
        _ => group.name(),
    };
    only.is_empty() || only.iter().any(|asked| asked == group.name() || asked == family)
}

/// The groups' shares of the count, at least one each.
fn cases(chosen: &[Group], arguments: &Arguments) -> Vec<Case> {
    let fits = |case: &Case| arguments.arm.is_none_or(|arm| case.six_axes == (arm == ArmName::Six));
    let of = |(group, count): (Group, usize)| {
        let endless =
            (0..).map(move |replicate| Case { poses: arguments.poses, ..Case::new(group, replicate, arguments.seed) });
        endless.filter(fits).take(count).collect::<Vec<_>>()
    };
    shares(chosen, arguments.count).flat_map(of).collect()
}

fn run_all(cases: &[Case], jobs: usize, keep: Option<&Path>) -> Vec<Record> {
    let progress =
        if std::io::stderr().is_terminal() { ProgressBar::new(cases.len() as u64) } else { ProgressBar::hidden() };
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len}, {eta} left").expect("a template that is right");
    progress.set_style(style);
    let next = AtomicUsize::new(0);
    let records = Mutex::new(Vec::with_capacity(cases.len()));
    thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(case) = cases.get(index) else { break };
                    let record = run_keeping(case.clone(), keep);
                    records.lock().expect("no thread panics with it").push((index, record));
                    progress.inc(1);
                }
            });
        }
    });
    progress.finish_and_clear();
    let mut records = records.into_inner().expect("all threads are done");
    records.sort_by_key(|(index, _)| *index);
    records.into_iter().map(|(_, record)| record).collect()
}
