//! `robstiff correct`: a robot program whose positions make up for the arm.

mod files;
mod page;

use std::path::PathBuf;

use robstiff::Generic;
use robstiff::nalgebra::{Isometry3, SVector, Unit, Vector3};
use robstiff_machining::controller::{Followed, Frames, Nominal, Postures, Stop, placement};
use robstiff_machining::program::{self, Document, TextFile};
use robstiff_robots::Description;
use robstiff_robots::quantity::Dimension;

use crate::failure::Failure;
use crate::input::{self, NamedFrame, positive};
use crate::output::{self, Files};
use crate::path::cutting::{Cutting, CuttingRequest, ForceArguments};

/// A robot program whose positions make up for the arm's deviations, all else as it was
///
/// Reads KRL (.src, with its .dat), RAPID (.mod) and FANUC TP programs as text (.ls). See
/// robstiff/docs/commands/correct.md.
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue; it has a `controller`; left out with `--cell`
    #[arg(value_name = "ROBOT.yaml", required = true)]
    robot: Option<PathBuf>,
    /// The program; the `.dat` of a `.src` and routines that it calls are found beside it
    #[arg(value_name = "PROGRAM", required_unless_present = "cell")]
    program: Vec<PathBuf>,
    #[command(flatten)]
    cell: input::CellArgument,
    /// Write the corrected files, under their names, into a folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write what is corrected as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// The posture before the first motion: joint coordinates in rad (or m), or with their unit as in "0.5, 30 deg, -pi/2"
    #[arg(long, value_name = "q1,q2,..", allow_hyphen_values = true)]
    start: Option<String>,
    /// A tool that the program takes from the controller, in its flange, as in "1 = 0, 0, 250 mm, 0, 90 deg, 0" or
    /// "1 = description"; for each of them
    #[arg(long, value_name = "NAME=x,y,z,roll,pitch,yaw", allow_hyphen_values = true, value_parser = input::named_frame)]
    tool_data: Vec<NamedFrame>,
    /// A work frame that the program takes from the controller, in its world; for each of them
    #[arg(long, value_name = "NAME=x,y,z,roll,pitch,yaw", allow_hyphen_values = true, value_parser = input::named_frame)]
    work_data: Vec<NamedFrame>,
    /// The axis of the tool in the TCP's frame, from the spindle to the tip: x, y, z, -x, -y or -z
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = input::tool_axis)]
    tool_axis: Option<Unit<Vector3<f64>>>,
    /// Linear motions at this speed or above cut nothing
    #[arg(long, value_name = "SPEED", value_parser = positive(Dimension::Speed))]
    rapid_from: Option<f64>,
    /// The positions were taught on this arm: correct for the force alone
    #[arg(long)]
    taught: bool,
    #[command(flatten)]
    cutting: ForceArguments,
}

/// Corrects the program.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    // With a cell all that is given beside it are programs.
    let (first, mut programs) = (arguments.robot.as_ref(), arguments.program.clone());
    let first = first.filter(|_| !arguments.cell.is_given());
    if arguments.cell.is_given() {
        programs.splice(0..0, arguments.robot.clone());
    }
    let (mut setup, _) = arguments.cell.setup(first, None, "robstiff correct PROGRAM")?;
    setup.mount()?;
    let mut files = Files::default();
    setup.protect(&mut files);
    let spindle = setup.spindle("--tool-axis", arguments.tool_axis.map(Unit::into_inner))?;
    let request = arguments.cutting.read(&setup, spindle, setup.place(), &mut files)?.map(CuttingRequest::compensating);
    let nominal = input::nominal(setup.robot_file(), &setup.robot)?;
    let robot = setup.robot;
    if request.is_some() {
        input::refuse_if_rigid(&robot, "`robstiff correct` with a cut or forces")?;
    }
    let start = match &arguments.start {
        Some(text) => Some(input::coordinates_of("--start", text, &robot)?),
        None => None,
    };
    let (language, sources) = files::gather(&programs)?;
    sources.iter().for_each(|source| files.protect(&source.path));
    let texts: Vec<TextFile> = sources.iter().map(files::Source::text_file).collect();
    let targets: Vec<PathBuf> = match &arguments.out {
        Some(folder) => sources.iter().map(|source| folder.join(source.name())).collect(),
        None => Vec::new(),
    };
    files.foresee(targets.iter().chain(&arguments.json))?;
    let document = program::read(language, texts)?;
    let job = Job {
        arguments,
        robot: &robot,
        nominal: nominal.as_ref(),
        document: &document,
        start: start.as_deref(),
        tool: spindle.unwrap_or(Vector3::z_axis()),
        request: request.as_ref(),
    };
    let corrected = output::working("correcting the program", |_| with_arm!(&robot, |arm| job.correct(&arm)))?;
    for ((path, source), file) in targets.iter().zip(&sources).zip(&corrected.files) {
        files.add(path, source.with_mark(&file.text));
    }
    if let Some(path) = &arguments.json {
        files.add_document(path, &page::document(&robot, &document, &corrected))?;
    }
    let said = files.write()?;
    output::print(page::page(&robot, &document, &corrected) + &said)
}

/// What is to be done.
struct Job<'j> {
    arguments: &'j Arguments,
    robot: &'j Description,
    nominal: Option<&'j Description>,
    document: &'j Document,
    start: Option<&'j [f64]>,
    /// From the spindle to the tip, in the TCP's frame.
    tool: Unit<Vector3<f64>>,
    request: Option<&'j CuttingRequest>,
}

/// A corrected program, whatever the number of joints.
struct Corrected {
    motions: Vec<Motion>,
    files: Vec<TextFile>,
    cutting: Option<Cutting>,
    /// Motions that are then in another posture or turn than the program says, and which.
    otherwise: Vec<(usize, String)>,
}

/// A motion of it.
struct Motion {
    file: usize,
    line: usize,
    rapid: bool,
    /// Joint coordinates (rad or m) to which the controller takes the arm with the program as it was, and corrected.
    before: Vec<f64>,
    after: Vec<f64>,
    /// How far the position is moved, as the controller has it (m); `None` for one that stays as it is.
    shift: Option<f64>,
}

impl Job<'_> {
    fn correct<const N: usize>(&self, _: &Generic<N>) -> Result<Corrected, Failure> {
        let nominal = Nominal::<N>::new(self.robot, self.nominal).map_err(Failure::new)?;
        let postures = Postures::new(&nominal);
        let start = self.start.map(SVector::<f64, N>::from_column_slice);
        let frames = self.frames(&nominal);
        let followed = Followed::new(self.document, &postures, &frames, start.as_ref())?;
        if followed.stops.is_empty() {
            let name = &self.document.files()[0].name;
            return Err(Failure::new(format_args!("{name}: the program has no joint or linear motion to correct")));
        }
        if self.request.is_some() {
            followed.one_tool()?;
        }
        let tool = placement(&nominal.tool_of_arm(&followed.tool));
        let arm = Generic::<N>::new(&Description { tool, ..self.robot.clone() }).expect("the tool adds no joint");
        let (path, solved) = followed.path(&arm, self.tool, self.arguments.taught)?;
        let cutting = self.request.map(|request| request.compute(&arm, &path, &solved)).transpose()?;
        let commanded: Vec<SVector<f64, N>> = match cutting.as_ref().and_then(|cutting| cutting.corrected.as_ref()) {
            Some(corrected) => corrected.points.iter().map(|point| SVector::from_column_slice(&point.q)).collect(),
            None => solved.points.iter().map(|point| point.q).collect(),
        };
        let (positions, otherwise) = followed.positions(&postures, &commanded);
        let files = followed.files(&positions)?;
        let moves = self.document.moves().zip(&positions).zip(followed.stops.iter().zip(&commanded));
        let motions = moves.map(|((to, position), (stop, q))| {
            let shift = (to.position != *position).then(|| shift(&nominal, &followed.tool, [&stop.q, q]));
            motion(stop, q, shift)
        });
        Ok(Corrected { motions: motions.collect(), files, cutting, otherwise })
    }

    fn frames<const N: usize>(&self, nominal: &Nominal<N>) -> Frames {
        let tools = self
            .arguments
            .tool_data
            .iter()
            .map(|frame| (frame.name.clone(), frame.pose.unwrap_or_else(|| nominal.tool(&self.robot.tool))));
        let works =
            self.arguments.work_data.iter().map(|frame| {
                (frame.name.clone(), frame.pose.unwrap_or_else(|| nominal.in_world(&Isometry3::identity())))
            });
        Frames { tools: tools.collect(), works: works.collect(), rapid_from: self.arguments.rapid_from }
    }
}

/// How far the tip of a tool is moved, as the controller has it (m).
fn shift<const N: usize>(nominal: &Nominal<N>, tool: &Isometry3<f64>, [from, to]: [&SVector<f64, N>; 2]) -> f64 {
    let [from, to] = [from, to].map(|q| nominal.pose(q, tool).translation.vector);
    (to - from).norm()
}

fn motion<const N: usize>(stop: &Stop<N>, q: &SVector<f64, N>, shift: Option<f64>) -> Motion {
    let list = |q: &SVector<f64, N>| q.iter().copied().collect();
    let after = if shift.is_some() { q } else { &stop.q };
    Motion { file: stop.file, line: stop.line, rapid: stop.rapid, before: list(&stop.q), after: list(after), shift }
}
