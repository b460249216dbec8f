//! `robstiff map`: stiffness and deviation all over a space.

mod columns;
mod contour;
mod document;
mod heat;
mod page;
mod raster;
mod slices;
mod table;
mod tape;

use std::convert::Infallible;
use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};

use indicatif::{HumanCount, ProgressBar, ProgressStyle};
use robstiff::Generic;
use robstiff::nalgebra::Isometry3;
use robstiff_machining::map::read::{Over, Positions, Task};
use robstiff_machining::map::{Axis, CartesianSpace, Chunk, JointSpace, Measure, Survey, Tool, best_placement};
use robstiff_robots::Description;
use robstiff_robots::document::{Document, Node};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};

use crate::failure::Failure;
use crate::output::{self, Files, Growing};
use crate::text::count;
use crate::{input, json};
use columns::{Columns, RowGroup};
use document::{Mapped, Placed};
use slices::{Dot, Slices};
use table::Table;
use tape::Tape;

/// Cells that are told wherever the messages go: as CSV they are a gigabyte.
const MANY: usize = 10_000_000;

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
    /// Write every cell as Parquet to FILE
    #[arg(long, value_name = "FILE")]
    parquet: Option<PathBuf>,
    /// Draw the map to FILE
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write a page with the map, that tells the value wherever one points, to FILE
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Look for the best place for a workpiece of this size along x, y and z, e.g. "400 x 300 x 100 mm"
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true, value_parser = size)]
    place: Option<[f64; 3]>,
    /// Write the summary as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Maps.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, _) = input::robot(&arguments.robot)?;
    // Where the tool gets is in a map as well, but no place is better than another.
    match arguments.place {
        Some(_) => input::refuse_if_rigid(&robot, "`robstiff map --place`")?,
        None => input::complain_if_rigid(&robot),
    }
    let task = task(&arguments.map, &robot)?;
    // Before what may take minutes.
    let varying = task.over.axes().iter().filter(|axis| axis.varies()).count();
    if varying < 2
        && let Some(path) = arguments.svg.as_ref().or(arguments.html.as_ref())
    {
        return Err(Failure::Usage(format!(
            "{} is a picture, which needs two coordinates that vary; in {} {varying} does",
            path.display(),
            arguments.map.display()
        )));
    }
    let mut files = Files::default();
    files.protect(&arguments.robot);
    files.protect(&arguments.map);
    let Arguments { csv, parquet, svg, html, json, .. } = arguments;
    files.foresee([csv, parquet, svg, html, json].into_iter().flatten())?;
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
    if mapped.summary.unreachable == mapped.summary.cells {
        // A page without a number, and tables of nothing.
        return Err(Failure::new(format_args!(
            "{}: no pose reaches any of it\n{}",
            arguments.map.display(),
            mapped.page().trim_end()
        )));
    }
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&mapped.json()));
    }
    // The map is an answer, also that no place in it will do: it shows where it has holes.
    if let Some(said) = mapped.unplaced() {
        let map = arguments.map.display();
        output::complain(format_args!(
            "warning: {map}: {said}; what would help is a smaller one, a wider map or more turns"
        ));
    }
    let said = files.write()?;
    output::print(mapped.page() + &said)
}

/// Stops, before what may take minutes, where a workpiece (m) is larger than the map.
fn refuse_if_larger(size: [f64; 3], axes: &[Axis; 3], map: &Path) -> Result<(), Failure> {
    let spans = [0, 1, 2].map(|k| axes[k].values[axes[k].values.len() - 1] - axes[k].values[0]);
    if size.iter().zip(spans).all(|(size, span)| size * (1.0 - 1e-9) <= span) {
        return Ok(());
    }
    Err(Failure::new(format_args!(
        "{}: a workpiece of {} mm is larger than the map, {} mm; make the map wider, or the workpiece smaller",
        map.display(),
        document::lengths(size, " x "),
        document::lengths(spans, " x ")
    )))
}

fn task(path: &Path, robot: &Description) -> Result<Task, Failure> {
    let text = text::read(path, MOST_OF_DOCUMENT)?;
    let file = path.display().to_string();
    // Beyond the joints' limits they are refused, so before.
    if let Some(asked) = are_degrees(&file, &text, robot) {
        output::complain(format_args!("warning: {file}: {asked}"));
    }
    Ok(Task::parse(&file, &text, robot)?)
}

/// Asks whether `joints` without a unit are in degrees, as of `--at`; in a document of its own,
/// so that what is wrong with the file is left for its reader to report.
fn are_degrees(file: &str, text: &str, robot: &Description) -> Option<String> {
    let document = Document::parse(file, text).ok()?;
    let joints = document.root().any_map("")?.get("joints")?.sequence()?;
    let number = |node: &Node<'_>| node.is_number().then(|| node.quantity(Dimension::Number)).flatten();
    let bare = |node: &Node<'_>| {
        if !node.is_map() {
            return number(node);
        }
        let ends = node.any_map("")?;
        let ends = ["from", "to"].into_iter().filter_map(|end| number(&ends.get(end)?));
        ends.max_by(|one, other| one.abs().total_cmp(&other.abs()))
    };
    input::are_degrees(joints.iter().map(bare), robot)
}

fn map<const N: usize>(
    robot: &Description,
    task: &Task,
    arguments: &Arguments,
    files: &mut Files,
) -> Result<Mapped, Failure> {
    let tape = Tape::<N>::new(robot);
    let mut mapped = match &task.over {
        Over::Joints(axes) => {
            if arguments.place.is_some() {
                return Err(Failure::Usage("--place needs a map over positions, this one is over joints".to_owned()));
            }
            let axes: &[Axis; N] = axes.as_slice().try_into().expect("the reader checked the count");
            let mut tables = Vec::new();
            let space = JointSpace::new(axes, &mut tables);
            write(&Survey::new(&tape, &space, &task.measure), arguments, files)?
        }
        Over::Positions(positions) => {
            let Positions { frame, axes, tool } = positions.as_ref();
            if let Some(size) = arguments.place {
                refuse_if_larger(size, axes, &arguments.map)?;
            }
            let generic = Generic::<N>::new(robot).expect("this arm has the same count");
            let space = CartesianSpace::new(&generic, axes.clone(), tool.clone()).in_frame(*frame);
            let mut mapped = write(&Survey::new(&tape, &space, &task.measure), arguments, files)?;
            mapped.mapped.frame = Some(*frame).filter(|frame| *frame != Isometry3::identity());
            if let Some(size) = arguments.place {
                mapped.mapped.placements = place(&tape, &generic, positions, &task.measure, size, &mapped.values);
            }
            mapped
        }
    };
    mapped.mapped.robot.clone_from(&robot.name);
    let pictures = [(&arguments.svg, page::svg as fn(&Mapped, &Slices) -> String), (&arguments.html, page::html)];
    for (path, draw) in pictures.into_iter().filter_map(|(path, draw)| Some((path.as_ref()?, draw))) {
        let slices = mapped.slices.as_ref().expect("it was asked before whether two coordinates vary");
        files.add(path, draw(&mapped.mapped, slices));
    }
    Ok(mapped.mapped)
}

/// The best places for a workpiece: with the tool turned at each point as is best
/// there, and with one turn for all of it.
fn place<const N: usize>(
    tape: &Tape<N>,
    robot: &Generic<N>,
    Positions { frame, axes, tool }: &Positions,
    measure: &Measure,
    size: [f64; 3],
    values: &[f64],
) -> Vec<Placed> {
    let several = tool.turns.len() > 1;
    let best = best_placement(axes, values, size, measure);
    let each = Placed { size, turn: None, each: several, best };
    if !several {
        return vec![each];
    }
    let with = |&turn: &f64| {
        let one = Tool { turns: vec![turn], ..tool.clone() };
        let space = CartesianSpace::new(robot, axes.clone(), one).in_frame(*frame);
        let values = figures(&Survey::new(tape, &space, measure));
        Placed { size, turn: Some(turn), each: false, best: best_placement(axes, &values, size, measure) }
    };
    let better = |one: Placed, other: Placed| match (&one.best, &other.best) {
        (Some(a), Some(b)) if !measure.is_clearly_worse(a.worst, b.worst) => one,
        (Some(_), None) => one,
        _ => other,
    };
    tool.turns.iter().map(with).reduce(better).into_iter().chain([each]).collect()
}

/// The first column at all cells.
fn figures(survey: &Survey<'_>) -> Vec<f64> {
    let mut values = Vec::with_capacity(survey.cells);
    let figures = |chunk: &Chunk| chunk.columns[0].clone();
    let done: Result<_, Infallible> = survey.stream(figures, |figures| {
        values.extend(figures);
        Ok(())
    });
    let Ok(_) = done;
    values
}

/// A map that was written.
struct Written {
    mapped: Mapped,
    slices: Option<Slices>,
    /// The first column at all cells, where a workpiece is to be placed.
    values: Vec<f64>,
}

/// What is made of a chunk.
struct Pieces {
    cells: usize,
    lines: Vec<u8>,
    group: Option<parquet::errors::Result<RowGroup>>,
    dots: Vec<Dot>,
    values: Vec<f64>,
    /// Numbers that the tables do not hold.
    too_large: usize,
}

/// Maps a space to the files that are asked for.
fn write(survey: &Survey<'_>, arguments: &Arguments, files: &mut Files) -> Result<Written, Failure> {
    let Survey { axes, ref columns, ref measure, cells, chunk, .. } = *survey;
    let table = Table::new(axes, columns);
    let cannot = |error: parquet::errors::ParquetError| Failure::new(format!("cannot write the Parquet file: {error}"));
    let groups = Columns::new(axes, columns).map_err(cannot)?;
    let mut csv = arguments.csv.as_deref().map(|path| files.grow(path)).transpose()?;
    let parquet = arguments.parquet.as_deref().map(|path| files.grow(path)).transpose()?;
    let mut parquet = parquet.map(|file| groups.file(file).map_err(cannot)).transpose()?;
    let drawn = arguments.svg.is_some() || arguments.html.is_some();
    let slices = drawn.then(|| Slices::new(axes, measure)).flatten();
    // What is drawn is looked up while the drawing goes on.
    let wanted = slices.as_ref().map(Slices::empty);
    let mut slices = slices;
    let mut values = Vec::new();
    if let Some(csv) = &mut csv {
        put(csv, table.header().as_bytes())?;
    }
    let is_table = arguments.csv.is_some() || arguments.parquet.is_some();
    announce(axes, cells);
    let progress = progress(cells, chunk);
    let encode = |chunk: &Chunk| Pieces {
        cells: chunk.cells.len(),
        lines: if arguments.csv.is_some() { table.lines(chunk) } else { Vec::new() },
        group: arguments.parquet.as_ref().map(|_| groups.encode(chunk)),
        dots: wanted.as_ref().map_or_else(Vec::new, |slices| slices.dots(chunk)),
        values: if arguments.place.is_some() { chunk.columns[0].clone() } else { Vec::new() },
        too_large: if is_table { table::too_large(chunk, columns) } else { 0 },
    };
    let mut too_large = 0;
    let take = |pieces: Pieces| {
        progress.inc(pieces.cells as u64);
        too_large += pieces.too_large;
        values.extend(pieces.values);
        if let Some(slices) = &mut slices {
            slices.draw(pieces.dots);
        }
        if let Some((file, group)) = parquet.as_mut().zip(pieces.group) {
            group.and_then(|group| columns::append(file, group)).map_err(cannot)?;
        }
        csv.as_mut().map_or(Ok(()), |csv| put(csv, &pieces.lines))
    };
    let summary = survey.stream(encode, take);
    progress.finish_and_clear();
    let summary = summary?;
    if too_large > 0 {
        let numbers = count(too_large, "number");
        output::complain(format_args!(
            "warning: {numbers} beyond single precision, 3.4e38: tables have no value there"
        ));
    }
    if let Some(csv) = csv {
        files.grown(csv)?;
    }
    if let Some(parquet) = parquet {
        files.grown(parquet.into_inner().map_err(cannot)?)?;
    }
    let (axes, columns) = (axes.to_vec(), columns.clone());
    let (robot, placements, frame) = (String::new(), Vec::new(), None);
    let mapped = Mapped { robot, axes, measure: *measure, columns, summary, placements, frame };
    Ok(Written { mapped, slices, values })
}

fn put(file: &mut Growing, bytes: &[u8]) -> Result<(), Failure> {
    file.write_all(bytes)
        .map_err(|error: io::Error| Failure::new(format!("cannot write {}: {error}", file.path().display())))
}

/// The size of a workpiece: `400 x 300 x 100 mm`.
fn size(text: &str) -> Result<[f64; 3], String> {
    let help = "a size is three lengths with their unit, e.g. `400 x 300 x 100 mm`";
    let parts: Vec<&str> = text.split(['x', '×']).map(str::trim).collect();
    let &[x, y, z] = parts.as_slice() else { return Err(help.to_owned()) };
    let lengths = input::three_with_unit([x, y, z], Dimension::Length)?;
    match lengths.iter().zip(parts).find(|(length, _)| **length < 0.0) {
        Some((_, part)) => Err(format!("{part} is negative; {help}")),
        None => Ok(lengths),
    }
}

/// Says how many cells are to be computed: on a terminal, and where they are many.
fn announce(axes: &[Axis], cells: usize) {
    if cells >= MANY || io::stderr().is_terminal() {
        let counts = axes.iter().filter(|axis| axis.varies()).map(|axis| axis.values.len().to_string());
        let counts: Vec<String> = counts.collect();
        let whole = if counts.len() > 1 { format!("{} = ", counts.join(" x ")) } else { String::new() };
        output::complain(format_args!("note: the map has {whole}{} cells", HumanCount(cells as u64)));
    }
}

/// Shows on a terminal how far it is, where that takes a while.
fn progress(cells: usize, chunk: usize) -> ProgressBar {
    if cells < 4 * chunk {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{wide_bar} {human_pos} of {human_len} cells ({eta})");
    ProgressBar::new(cells as u64).with_style(style.expect("the template is one"))
}
