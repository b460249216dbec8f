//! Counts the reachable poses that inverse kinematics misses, for every robot of
//! the catalogue.

use std::thread;
use std::time::Instant;

use clap::Parser;
use nalgebra::Vector3;
use robstiff::Robot;
use robstiff_tests::arms;
use robstiff_tests::reach::{Asked, Reached, reach};

/// Solves reachable poses drawn at random, for every robot of the catalogue
#[derive(Parser)]
#[command(name = "reach")]
struct Arguments {
    /// Poses of each robot
    #[arg(long, default_value_t = 1_000_000)]
    count: usize,
    /// Seed of the poses
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads
    #[arg(long, default_value_t = 2)]
    jobs: usize,
}

fn main() {
    let arguments = Arguments::parse();
    println!(
        "| robot | asked for | poses | missed | largest distance [m] | largest angle [rad] | us a pose and thread |"
    );
    println!("|---|---|---|---|---|---|---|");
    all(&arms::AbbIrb6600, Asked::Pose, &arguments);
    all(&arms::AbbIrb6640, Asked::Pose, &arguments);
    all(&arms::FanucM900ib700, Asked::Pose, &arguments);
    all(&arms::FanucR2000ic, Asked::Pose, &arguments);
    all(&arms::KukaKr210L150, Asked::Pose, &arguments);
    all(&arms::KukaKr270R2700, Asked::Pose, &arguments);
    all(&arms::StaubliRx160, Asked::Pose, &arguments);
    all(&arms::Rv130hsc, Asked::Pose, &arguments);
    all(&arms::Rv130hsc, Asked::Axis(Vector3::x_axis()), &arguments);
    all(&arms::Rv130hsc, Asked::Axis(Vector3::z_axis()), &arguments);
}

/// A line of the table.
fn all<const N: usize, R: Robot<N> + Sync>(robot: &R, asked: Asked, arguments: &Arguments) {
    let (start, jobs) = (Instant::now(), arguments.jobs.max(1));
    let reached = thread::scope(|scope| {
        let share = |job: usize| arguments.count / jobs + usize::from(job < arguments.count % jobs);
        let seed = |job: usize| arguments.seed.wrapping_mul(1000) + job as u64;
        let threads: Vec<_> =
            (0..jobs).map(|job| scope.spawn(move || reach(robot, asked, share(job), seed(job)))).collect();
        let each = threads.into_iter().map(|thread| thread.join().expect("no thread panics"));
        each.fold(Reached::default(), Reached::and)
    });
    let asked = match asked {
        Asked::Pose => "pose".to_owned(),
        Asked::Axis(tool) => format!("position and {} axis", ["x", "y", "z"][tool.iamax()]),
    };
    let each = start.elapsed().as_secs_f64() * 1e6 * jobs as f64 / reached.tried.max(1) as f64;
    println!(
        "| {} | {asked} | {} | {} | {:.1e} | {:.1e} | {each:.1} |",
        robot.name(),
        reached.tried,
        reached.missed,
        reached.distance,
        reached.angle
    );
}
