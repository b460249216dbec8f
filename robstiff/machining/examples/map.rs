//! Maps of ten million poses of a generated robot: the deviation under one force,
//! and the stiffness from the whole compliance, written as CSV chunk by chunk.
//!
//! `cargo run --release -p robstiff-machining --features rayon --example map -- 10000000`
//! maps so many poses (a hundred thousand without the number), writes to
//! `target/map-*.csv`, and says how long it took.

use std::fs::File;
use std::io::{self, Write};
use std::time::Instant;

use robstiff::nalgebra::Vector6;
use robstiff_machining::map::{Axis, Chunk, JointSpace, Measure, stream};

robstiff::robot!("rv130hsc.yaml");

fn main() -> io::Result<()> {
    let poses: f64 = std::env::args().nth(1).map_or(1e5, |count| count.parse().expect("a number of poses"));
    let each = poses.cbrt().round() as usize;
    let degrees = |name, from: f64, to: f64, count| Axis::angles(name, from.to_radians(), to.to_radians(), count);
    let axes = [
        degrees("q1", -90.0, 90.0, each),
        degrees("q2", -60.0, 0.0, each),
        degrees("q3", 0.0, 60.0, each),
        degrees("q4", 0.0, 0.0, 1),
        degrees("q5", 60.0, 60.0, 1),
    ];
    let mut tables = Vec::new();
    let space = JointSpace::new(&axes, &mut tables);

    let force = Measure::Deviation(Vector6::new(0.0, 400.0, -200.0, 0.0, 0.0, 0.0)); // N, Nm
    for (measure, path) in [(force, "target/map-deviation.csv"), (Measure::Stiffness, "target/map-stiffness.csv")] {
        let start = Instant::now();
        let mut file = File::create(path)?;
        let lines = |chunk: &Chunk| {
            let mut lines = Vec::with_capacity(12 * chunk.cells.len());
            for (cell, value) in chunk.cells.clone().zip(&chunk.columns[0]) {
                writeln!(lines, "{cell},{value:e}").expect("memory takes any text");
            }
            lines
        };
        let summary = stream(&Rv130hsc, &space, &measure, lines, |lines| file.write_all(&lines))?;
        let worst = summary.worst.expect("there are cells");
        println!("{path}: {} cells in {:.2?}, the worst {:.3e}", summary.cells, start.elapsed(), worst.values[0]);
    }
    Ok(())
}
