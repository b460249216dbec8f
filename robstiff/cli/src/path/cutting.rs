//! What forces do to the tool along a path: read, computed.

use std::path::PathBuf;

use robstiff::Robot;
use robstiff::nalgebra::{Matrix4, Unit, Vector3, Vector6};
use robstiff_machining::cell::Cell;
use robstiff_machining::compensation::{CompensatedPoint, Keep, Sensitivity, compensate, sensitivity};
use robstiff_machining::deviation::{
    Deviation, ForceTable, Load, Operation, Stretch, Surface, blame, load_at_feeds, load_of_cut, removal_rate,
};
use robstiff_machining::engagement::Stock;
use robstiff_machining::milling::{CutFile, ForceFrame, Forces};
use robstiff_machining::path::{SolvedPath, ToolPath};

use super::chatter::{Chatter, ChatterArguments, ChatterRequest};
use super::doubts::{complain_of_diameter, complain_of_feed, complain_of_size, lacks_wall};
use super::stock::{Engaged, StockArguments, StockRequest};
use crate::failure::Failure;
use crate::input::{Setup, tolerance, tool_axis};
use crate::output::{self, Files};
use crate::{forces, input};

/// Angles of a revolution that are looked at, besides those at which teeth begin and end to cut.
const ANGLES: usize = 72;

/// How wrong the model is taken to be.
pub const WRONG: f64 = 0.1;

#[derive(clap::Args)]
#[command(next_help_heading = "Deviation under forces")]
pub struct ForceArguments {
    /// The force on the tool along the path, a row for each point or by arc length
    #[arg(long, value_name = "FORCES.csv", conflicts_with = "cut", group = "load")]
    forces: Option<PathBuf>,
    /// What the columns of `--forces` are along
    #[arg(long, value_name = "FRAME", default_value = "base", value_enum, requires = "forces", conflicts_with = "cut")]
    force_frame: Frame,
    /// The cut that pushes the tool (robstiff/docs/commands/forces.md), in place of that of the cell
    #[arg(long, value_name = "CUT.yaml", group = "load")]
    cut: Option<PathBuf>,
    /// Another cut to compare it with
    #[arg(long, value_name = "CUT.yaml", conflicts_with = "forces")]
    against: Option<PathBuf>,
    /// Judge by the worst force of a revolution, not the mean
    #[arg(long, conflicts_with = "forces")]
    peak: bool,
    /// The machined surface: a wall beside the tool, or the floor at its tip; side where left out
    #[arg(long, value_name = "SURFACE", value_enum)]
    surface: Option<Machined>,
    /// From the spindle to the tip, in the TCP's frame; where left out, that of the cell, or the axis of `--tool-axis`
    /// without its sign
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = tool_axis)]
    spindle_axis: Option<Unit<Vector3<f64>>>,
    /// Say where the error of the surface is within this, either way, e.g. "0.1 mm" or "IT9 of 50 mm"
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = tolerance)]
    tolerance: Option<f64>,
    /// Correct the path for the force: `--out` has what to command
    #[arg(long)]
    compensate: bool,
    #[command(flatten)]
    stock: StockArguments,
    #[command(flatten)]
    chatter: ChatterArguments,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Frame {
    Base,
    Tool,
    Cut,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Machined {
    Side,
    Face,
}

/// Where forces come from.
enum Source {
    Table(ForceTable, ForceFrame),
    Cut(CutFile),
}

/// What is asked for, read.
pub struct CuttingRequest {
    source: Source,
    name: String,
    against: Option<(CutFile, String)>,
    peak: bool,
    surface: Surface,
    axis: Unit<Vector3<f64>>,
    tolerance: Option<f64>,
    compensate: bool,
    stock: StockRequest,
    chatter: Option<ChatterRequest>,
}

/// What the forces do, whatever the number of joints.
pub struct Cutting {
    /// The file that the forces are from.
    pub name: String,
    /// The machined surface.
    pub surface: &'static str,
    /// Whether the wall is taken to be left of the tool because nothing says where it is.
    pub takes_left: bool,
    /// What is cut where, from a stock.
    pub engaged: Option<Engaged>,
    /// Point by point.
    pub deviation: Deviation,
    /// Lines without a force, for want of a direction.
    pub undirected: Vec<usize>,
    /// The tolerance, and where it holds (m).
    pub tolerance: Option<(f64, Vec<Stretch>)>,
    /// Shares of the error: over the points that break the tolerance, else all with a force.
    pub blame: Vec<(String, f64)>,
    /// The two cuts side by side.
    pub compared: Option<[Compared; 2]>,
    /// The corrected path.
    pub corrected: Option<Corrected>,
    /// Where the arm chatters, where that is asked.
    pub chatter: Option<Chatter>,
}

/// A cut among others.
pub struct Compared {
    /// Its file.
    pub name: String,
    /// What it removes (m^3/s).
    pub removal: Option<f64>,
    /// The size of the mean force, at the point where it is largest (N).
    pub force: f64,
    /// The largest distance from the path (m), where anything pushes.
    pub distance: Option<f64>,
    /// The largest error, with its sign (m), where there is a surface.
    pub error: Option<f64>,
}

/// A corrected path.
pub struct Corrected {
    pub points: Vec<CorrectedPoint>,
    pub rounds: usize,
    pub sensitivity: Sensitivity,
    /// Joints and effects, in the order of the sensitivity.
    pub elements: Vec<String>,
}

pub struct CorrectedPoint {
    pub q: Vec<f64>,
    pub pose: Matrix4<f64>,
    /// What acts on the tool where it then is, in the base frame (N, Nm).
    pub wrench: [f64; 6],
    pub correction: [f64; 3],
    pub remaining: f64,
    pub rounds: usize,
}

impl ForceArguments {
    /// From the spindle to the tip, where it is given.
    pub fn spindle_axis(&self) -> Option<Unit<Vector3<f64>>> {
        self.spindle_axis
    }

    /// The first option that needs a force.
    fn asked(&self) -> Option<&'static str> {
        let asked = [
            ("--compensate", self.compensate),
            ("--tolerance", self.tolerance.is_some()),
            ("--spindle-axis", self.spindle_axis.is_some()),
            ("--surface", self.surface.is_some()),
            ("--against", self.against.is_some()),
            ("--peak", self.peak),
            ("--stock", self.stock.is_given()[0]),
            ("--cut-of", self.stock.is_given()[1]),
        ];
        asked.into_iter().find(|(_, asked)| *asked).map(|(name, _)| name).or(self.chatter.asked())
    }

    /// Reads what is named; `None` where there is no force.
    pub fn read(
        &self,
        setup: &Setup,
        spindle: Option<Unit<Vector3<f64>>>,
        place: Matrix4<f64>,
        files: &mut Files,
    ) -> Result<Option<CuttingRequest>, Failure> {
        let mut cut = |path: &PathBuf| -> Result<(CutFile, String), Failure> {
            let file = input::cut(path)?;
            forces::protect(files, path, &file);
            Ok((file, path.display().to_string()))
        };
        let against = self.against.as_ref().map(&mut cut).transpose()?;
        let asked = self.asked();
        // The cut of a cell asks for nothing by itself.
        let is_asked = self.cut.is_some() || self.forces.is_some() || asked.is_some();
        let path = setup.cut(self.cut.as_ref()).filter(|path| is_asked || !input::is_left_out(setup, path));
        let (source, name) = match (&self.forces, path) {
            (Some(path), _) => {
                let table = ForceTable::read(path)?;
                for warning in &table.warnings {
                    output::complain(format_args!("warning: {warning}"));
                }
                files.protect(path);
                let frame = match self.force_frame {
                    Frame::Base => ForceFrame::Base,
                    Frame::Tool => ForceFrame::Tool,
                    Frame::Cut => ForceFrame::Cut,
                };
                (Source::Table(table, frame), path.display().to_string())
            }
            (None, Some(path)) => {
                let (file, name) = cut(&path)?;
                (Source::Cut(file), name)
            }
            (None, None) => {
                return match asked {
                    Some(name) => Err(Failure::Usage(format!(
                        "{name} needs a force: give `--cut CUT.yaml` or `--forces FORCES.csv`"
                    ))),
                    None => Ok(None),
                };
            }
        };
        let surface = match self.surface {
            None | Some(Machined::Side) => Surface::Side,
            Some(Machined::Face) => Surface::Face,
        };
        let axis = spindle.ok_or_else(|| setup.lacks_axis("--spindle-axis"))?;
        let (peak, tolerance, compensate) = (self.peak, self.tolerance, self.compensate);
        let has_tool = matches!(&source, Source::Cut(file) if matches!(file.forces, Forces::Model(_)));
        let of_cell = setup.cell().filter(|_| has_tool).and_then(|cell| cell.stock);
        let of_cell = of_cell.and_then(|[from, to]| Stock::of_corners(&from, &to));
        let stock = self.stock.read(of_cell, place, files)?;
        let chatter = self.chatter.read(setup, files)?;
        if let (Some(name), false) = (self.chatter.asked(), has_tool) {
            return Err(Failure::Usage(format!(
                "{name}: a measured force does not say how it changes with the chip; give the cut with tool and material"
            )));
        }
        Ok(Some(CuttingRequest { source, name, against, peak, surface, axis, tolerance, compensate, stock, chatter }))
    }
}

impl CuttingRequest {
    /// What the path cuts from, in its frame.
    pub fn stock(&self) -> Option<&Stock> {
        self.stock.stock()
    }

    /// Says so where the cell has another tool in the spindle than the cut.
    pub fn complain_of_tool(&self, cell: &Cell, path: &ToolPath) -> Result<(), Failure> {
        match &self.source {
            Source::Cut(file) => complain_of_diameter(cell, path, &self.name, &file.forces),
            Source::Table(..) => Ok(()),
        }
    }

    /// The same with the path corrected.
    pub fn compensating(self) -> Self {
        Self { compensate: true, ..self }
    }

    /// Computes what the forces do.
    pub fn compute<const N: usize>(
        &self,
        robot: &impl Robot<N>,
        path: &ToolPath,
        solved: &SolvedPath<N>,
    ) -> Result<Cutting, Failure> {
        let engaged = self.engaged(path, solved)?;
        self.compute_engaged(robot, path, solved, engaged)
    }

    /// What is cut where, from a stock; complains of what does not fit.
    pub fn engaged<const N: usize>(&self, path: &ToolPath, solved: &SolvedPath<N>) -> Result<Option<Engaged>, Failure> {
        let Source::Cut(file) = &self.source else { return Ok(None) };
        if !self.stock.has_stock() {
            complain_of_feed(file, &self.name, path, self.peak);
        }
        self.stock.complain_of_tools(&self.name, path)?;
        let engaged = self.stock.survey(file, &self.name, solved, self.axis)?;
        engaged.iter().for_each(|engaged| engaged.complain(path));
        Ok(engaged)
    }

    /// What acts on the tool at each point, in the base frame (N, Nm).
    pub fn forces<const N: usize>(
        &self,
        path: &ToolPath,
        solved: &SolvedPath<N>,
        engaged: Option<&Engaged>,
    ) -> Result<Vec<Vector6<f64>>, Failure> {
        let load = self.load_of_source(path, solved, engaged)?;
        Ok(load.contacts.iter().map(|contact| contact.wrench).collect())
    }

    fn load_of_source<const N: usize>(
        &self,
        path: &ToolPath,
        solved: &SolvedPath<N>,
        engaged: Option<&Engaged>,
    ) -> Result<Load, Failure> {
        match &self.source {
            Source::Table(table, frame) => Ok(table.load(solved, *frame, self.axis, self.surface)?),
            Source::Cut(file) => self.load(file, &self.name, path, solved, engaged),
        }
    }

    /// What the forces do where it is known what is cut.
    pub fn compute_engaged<const N: usize>(
        &self,
        robot: &impl Robot<N>,
        path: &ToolPath,
        solved: &SolvedPath<N>,
        engaged: Option<Engaged>,
    ) -> Result<Cutting, Failure> {
        let load = self.load_of_source(path, solved, engaged.as_ref())?;
        has_direction(&load, &self.name, path)?;
        let deviation = Deviation::of(robot, solved, &load).map_err(Failure::new)?;
        let forces = match &self.source {
            Source::Cut(file) => Some(&file.forces),
            Source::Table(..) => None,
        };
        let tolerance = self.tolerance.map(|tolerance| (tolerance, deviation.stretches(tolerance)));
        let beyond = |i: usize, limit: f64| deviation.points[i].judged().is_some_and(|error| error.abs() > limit);
        let broken = self.tolerance.filter(|limit| (0..deviation.points.len()).any(|i| beyond(i, *limit)));
        let shares = blame(robot, solved, &load, &deviation, |i| match broken {
            Some(limit) => beyond(i, limit),
            None => deviation.points[i].in_cut(),
        });
        let blame = shares.into_iter().map(|(element, share)| (element.to_string(), share)).collect();
        let compared = match (&self.source, &self.against) {
            (Source::Cut(file), Some((other, name))) => {
                // Its feed may be another than the path's: that is what is compared.
                let other_engaged = self.stock.survey(other, name, solved, self.axis)?;
                let other_load = self.load(other, name, path, solved, other_engaged.as_ref())?;
                has_direction(&other_load, name, path)?;
                let other_deviation = Deviation::of(robot, solved, &other_load).map_err(Failure::new)?;
                let removal = |file: &CutFile, engaged: Option<&Engaged>| match (&file.forces, engaged) {
                    (_, Some(engaged)) => engaged.removal_rate(&self.operation(file, path, Some(engaged)), solved),
                    (Forces::Model(cut), None) => removal_rate(cut),
                    (Forces::Measured { .. }, None) => None,
                };
                let removals = [removal(file, engaged.as_ref()), removal(other, other_engaged.as_ref())];
                Some([compared(&self.name, removals[0], &deviation), compared(name, removals[1], &other_deviation)])
            }
            _ => None,
        };
        let corrected = if self.compensate { Some(self.correct(robot, path, solved, &load)?) } else { None };
        let chatter = match (&self.chatter, &self.source) {
            (Some(request), Source::Cut(file)) => {
                let operation = self.operation(file, path, engaged.as_ref());
                Some(request.compute(robot, (path, solved), &operation, self.axis)?)
            }
            _ => None,
        };
        // A cut's width says nothing where the stock does.
        complain_of_size(&self.name, forces.filter(|_| !self.stock.is_asked(path)), &deviation);
        Ok(Cutting {
            engaged,
            name: self.name.clone(),
            surface: if self.surface == Surface::Side { "side" } else { "face" },
            takes_left: self.surface == Surface::Side && !self.stock.has_stock() && lacks_wall(forces),
            deviation,
            undirected: load.undirected,
            tolerance,
            blame,
            compared,
            corrected,
            chatter,
        })
    }

    /// What a cut of that name pushes the tool with along the path.
    fn load<const N: usize>(
        &self,
        file: &CutFile,
        name: &str,
        path: &ToolPath,
        solved: &SolvedPath<N>,
        engaged: Option<&Engaged>,
    ) -> Result<Load, Failure> {
        if self.stock.is_asked(path) {
            let operation = self.operation(file, path, engaged);
            operation.check(path)?;
            return Ok(operation.load(solved, self.axis, self.surface));
        }
        if !self.peak {
            return Ok(load_along(&file.forces, path, solved, self.axis, self.surface));
        }
        // A revolution is that of the cut, with its feed.
        let load = load_of_cut(&file.forces, solved, self.axis, self.surface);
        let revolution = match &file.forces {
            Forces::Model(cut) => Some(cut.extremes(ANGLES)),
            Forces::Measured { force, speed } => force.revolution(ANGLES, *speed),
        };
        let Some(revolution) = revolution else {
            let lacks = forces::lacks(&file.forces);
            return Err(Failure::new(format_args!("{name}: {lacks}, so nobody can tell the peak of a revolution")));
        };
        Ok(load.with_revolution(revolution.samples.into_iter().map(|(_, force)| force).collect()))
    }

    /// What cuts along the path, where more than the cut says it.
    fn operation<'c>(&'c self, file: &'c CutFile, path: &ToolPath, engaged: Option<&'c Engaged>) -> Operation<'c> {
        Operation {
            forces: &file.forces,
            tools: &self.stock.tools,
            at_feeds: path.is_program || engaged.is_some(),
            survey: engaged.map(Engaged::survey),
            angles: self.peak.then_some(ANGLES),
        }
    }

    fn correct<const N: usize>(
        &self,
        robot: &impl Robot<N>,
        path: &ToolPath,
        solved: &SolvedPath<N>,
        load: &Load,
    ) -> Result<Corrected, Failure> {
        let compensated = compensate(robot, solved, load, Keep::along(path, N, self.axis)).map_err(|missed| {
            let summary = missed.summary();
            match missed.diagnostics(path) {
                Some(problems) => Failure::Explained(format!("{problems}\n\n{summary}")),
                None => Failure::new(summary),
            }
        })?;
        let sensitivity = sensitivity(robot, solved, load, &compensated, WRONG).map_err(|why| {
            let percent = WRONG * 1e2;
            Failure::new(format_args!("if the arm were {percent} % softer or stiffer than described, {why}"))
        })?;
        let joints = (1..=N).map(|joint| format!("joint {joint}"));
        let elements = joints.chain(robot.effects().iter().map(ToString::to_string)).collect();
        let rounds = compensated.rounds();
        let point = |point: CompensatedPoint<N>| CorrectedPoint {
            q: point.q.iter().copied().collect(),
            pose: point.pose,
            wrench: point.wrench.into(),
            correction: point.correction.into(),
            remaining: point.remaining.distance,
            rounds: point.rounds,
        };
        Ok(Corrected { points: compensated.points.into_iter().map(point).collect(), rounds, sensitivity, elements })
    }
}

/// Refuses forces that have no direction at any point.
fn has_direction(load: &Load, name: &str, path: &ToolPath) -> Result<(), Failure> {
    if load.undirected.len() < load.contacts.len() {
        return Ok(());
    }
    Err(Failure::new(format!(
        "{}: no point lies across the tool from the one before, so {name} has no direction anywhere",
        path.file
    )))
}

/// The load of a cut: along a program with the program's feeds, along a table with the cut's.
pub fn load_along<const N: usize>(
    forces: &Forces,
    path: &ToolPath,
    solved: &SolvedPath<N>,
    axis: Unit<Vector3<f64>>,
    surface: Surface,
) -> Load {
    if path.is_program {
        load_at_feeds(forces, solved, axis, surface)
    } else {
        load_of_cut(forces, solved, axis, surface)
    }
}

fn compared(name: &str, removal: Option<f64>, deviation: &Deviation) -> Compared {
    let force = deviation.points.iter().map(|point| point.wrench.fixed_rows::<3>(0).norm()).fold(0.0, f64::max);
    let [distance, error] = [deviation.distances(), deviation.errors()].map(|of| of.map(|of| of.worst));
    Compared { name: name.to_owned(), removal, force, distance, error }
}
