//! `robstiff map`: stiffness and deviation all over a space.

mod document;
mod slices;
mod table;
mod tape;

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use indicatif::{ProgressBar, ProgressStyle};
use robstiff::map::read::{Over, Task};
use robstiff::map::{Axis, CHUNK, Chunk, Evaluate, JointSpace, Measure, Space, Summary, stream};
use robstiff_robots::Description;

use crate::failure::Failure;
use crate::output::{self, Files, Growing};
use crate::{input, json};
use document::Mapped;
use slices::{Dot, Slices};
use table::Table;
use tape::Tape;

/// Stiffness, weakest direction or deviation all over joint space, a plane or a box
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue
    #[arg(value_name = "ROBOT.yaml")]
    robot: PathBuf,
    /// What to map
    #[arg(value_name = "MAP.yaml")]
    map: PathBuf,
    /// Write every cell to FILE
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write the summary as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Maps.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, _) = input::robot(&arguments.robot)?;
    let task = task(&arguments.map, &robot)?;
    let mut files = Files::default();
    files.protect(&arguments.robot);
    files.protect(&arguments.map);
    let mapped = match robot.joints.len() {
        1 => map::<1>(&robot, &task, arguments, &mut files),
        2 => map::<2>(&robot, &task, arguments, &mut files),
        3 => map::<3>(&robot, &task, arguments, &mut files),
        4 => map::<4>(&robot, &task, arguments, &mut files),
        5 => map::<5>(&robot, &task, arguments, &mut files),
        6 => map::<6>(&robot, &task, arguments, &mut files),
        7 => map::<7>(&robot, &task, arguments, &mut files),
        _ => map::<8>(&robot, &task, arguments, &mut files),
    }?;
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&mapped.json()));
    }
    let said = files.write()?;
    output::print(mapped.page() + &said)
}

fn task(path: &Path, robot: &Description) -> Result<Task, Failure> {
    let text =
        fs::read_to_string(path).map_err(|error| Failure::new(format!("cannot read {}: {error}", path.display())))?;
    Ok(Task::parse(&path.display().to_string(), &text, robot)?)
}

fn map<const N: usize>(
    robot: &Description,
    task: &Task,
    arguments: &Arguments,
    files: &mut Files,
) -> Result<Mapped, Failure> {
    let tape = Tape::<N>::new(robot);
    let summary = match &task.over {
        Over::Joints(axes) => {
            let axes: &[Axis; N] = axes.as_slice().try_into().expect("the reader checked the count");
            let mut tables = Vec::new();
            let space = JointSpace::new(axes, &mut tables);
            write(&tape, &space, &task.measure, arguments, files)?
        }
        Over::Positions { .. } => todo!(),
    };
    Ok(Mapped { robot: robot.name.clone(), ..summary })
}

/// What is made of a chunk.
struct Pieces {
    cells: usize,
    lines: Vec<u8>,
    dots: Vec<Dot>,
}

/// Maps a space to the files that are asked for.
fn write<const N: usize>(
    robot: &impl Evaluate<N>,
    space: &impl Space<N>,
    measure: &Measure,
    arguments: &Arguments,
    files: &mut Files,
) -> Result<Mapped, Failure> {
    let columns = [measure.columns(), &space.columns()].concat();
    let table = Table::new(space.axes(), &columns);
    let mut csv = arguments.csv.as_deref().map(|path| files.grow(path)).transpose()?;
    let mut slices = Slices::new(space.axes(), measure).filter(|_| false);
    if let Some(csv) = &mut csv {
        put(csv, table.header().as_bytes())?;
    }
    let progress = progress(space.cells());
    let encode = |chunk: &Chunk| Pieces {
        cells: chunk.cells.len(),
        lines: if arguments.csv.is_some() { table.lines(chunk) } else { Vec::new() },
        dots: Vec::new(),
    };
    let take = |pieces: Pieces| {
        progress.inc(pieces.cells as u64);
        if let Some(slices) = &mut slices {
            slices.draw(pieces.dots);
        }
        csv.as_mut().map_or(Ok(()), |csv| put(csv, &pieces.lines))
    };
    let summary = stream(robot, space, measure, encode, take);
    progress.finish_and_clear();
    let summary: Summary = summary?;
    for growing in csv {
        files.grown(growing)?;
    }
    Ok(Mapped { robot: String::new(), axes: space.axes().to_vec(), measure: *measure, columns, summary })
}

fn put(file: &mut Growing, bytes: &[u8]) -> Result<(), Failure> {
    file.write_all(bytes)
        .map_err(|error: io::Error| Failure::new(format!("cannot write {}: {error}", file.path().display())))
}

/// Shows on a terminal how far it is, where that takes a while.
fn progress(cells: usize) -> ProgressBar {
    if cells < 4 * CHUNK {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{wide_bar} {human_pos} of {human_len} cells ({eta})");
    ProgressBar::new(cells as u64).with_style(style.expect("the template is one"))
}
