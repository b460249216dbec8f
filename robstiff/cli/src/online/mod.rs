//! `robstiff online`: what a correction while cutting leaves of the deviation.

mod bound;
mod loads;
mod page;
mod reach;

use std::path::{Path, PathBuf};

use robstiff::Generic;
use robstiff::nalgebra::{Matrix4, Unit, Vector3};
use robstiff_machining::online::{Controller, Limits, Sensing, Servo};
use robstiff_robots::Description;
use robstiff_robots::quantity::Dimension;

use crate::failure::Failure;
use crate::input::{Force, axis, force, positive, tool_axis};
use crate::output::{self, Files};
use crate::{input, json};
use loads::LoadRequest;

/// At which frequencies a force comes and goes where nothing else is said (Hz).
const FREQUENCIES: [f64; 6] = [0.2, 0.5, 1.0, 2.0, 5.0, 10.0];

/// By what share of themselves a controller takes the joints' compliances for too small where
/// nothing else is said.
const TOO_STIFF: f64 = 0.1;

/// What a correction of the joint targets while cutting leaves of the deviation
///
/// Each control step reads a force sensor, or encoders on the output side of the
/// gears, and shifts the joint targets; that acts after a delay and through the
/// position loops. Along a path with a cut or recorded forces, or at a pose under
/// a force by its frequency. See robstiff/docs/commands/online.md.
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue; left out with `--cell`
    #[arg(value_name = "ROBOT.yaml", required_unless_present = "cell")]
    robot: Option<PathBuf>,
    /// The tool path (robstiff/docs/commands/path.md); without it, a pose
    #[arg(value_name = "PATH")]
    path: Option<PathBuf>,
    #[command(flatten)]
    cell: input::CellArgument,
    #[command(flatten)]
    load: LoadArguments,
    #[command(flatten)]
    control: ControlArguments,
    #[command(flatten)]
    program: input::ProgramArguments,
    /// What the controller takes the robot for; where left out, the robot with the own compliance of every joint
    /// 10 % too small
    #[arg(long, value_name = "MODEL.yaml")]
    model: Option<PathBuf>,
    /// Write what is left to FILE: by frequency, or at each point of the path or record
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write the same as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

#[derive(clap::Args)]
#[command(next_help_heading = "What pushes the tool")]
struct LoadArguments {
    /// The cut; at a pose a record of forces over time is played once, any other cut comes and goes with a frequency
    #[arg(long, value_name = "CUT.yaml", conflicts_with_all = ["forces", "force"])]
    cut: Option<PathBuf>,
    /// The force along the path, a row for each point or by arc length, in the base frame
    #[arg(long, value_name = "FORCES.csv", conflicts_with = "force")]
    forces: Option<PathBuf>,
    /// A force at a pose, in the base frame, e.g. "0, 0, -400 N"
    #[arg(long, value_name = "Fx,Fy,Fz", allow_hyphen_values = true, value_parser = force)]
    force: Option<Force>,
    #[command(flatten)]
    at: input::At,
    /// Where the feed of a cut at a pose goes, in the base frame; 1,0,0 where left out
    #[arg(long, value_name = "x,y,z", allow_hyphen_values = true, value_parser = axis, conflicts_with = "force")]
    toward: Option<Vector3<f64>>,
    /// Frequencies at which the force at a pose comes and goes; where left out, "0.2, 0.5, 1, 2, 5, 10 Hz"
    #[arg(long, value_name = "FREQUENCIES", allow_hyphen_values = true, value_parser = frequencies)]
    frequencies: Option<Frequencies>,
    /// The speed along a path that does not say it, e.g. "600 mm/min"
    #[arg(long, value_name = "SPEED", conflicts_with_all = ["force", "at"], allow_hyphen_values = true, value_parser = positive(Dimension::Speed))]
    feed: Option<f64>,
    /// Where the frame of the path's poses stands in the base frame: x, y, z, then roll, pitch, yaw, as in
    /// "1500 mm, 0, 800 mm, 0, 0, 90 deg"
    #[arg(long, value_name = "x,y,z,roll,pitch,yaw", allow_hyphen_values = true, value_parser = crate::path::place)]
    place: Option<Matrix4<f64>>,
    /// The axis in the TCP's frame that `ux uy uz` point along, and that of the spindle: x, y, z, -x, -y or -z. Where left
    /// out, that of the cell, or z where the description tells it
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = tool_axis, conflicts_with = "force")]
    tool_axis: Option<Unit<Vector3<f64>>>,
    /// From the spindle to the tip, in the TCP's frame; where left out, that of the cell, or `--tool-axis`, along a table
    /// without its sign
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = tool_axis, conflicts_with = "force")]
    spindle_axis: Option<Unit<Vector3<f64>>>,
}

#[derive(clap::Args)]
#[command(next_help_heading = "The control")]
struct ControlArguments {
    /// Control steps to compare, e.g. "12 ms, 4 ms, 1 ms"
    #[arg(long, value_name = "TIMES", default_value = "4 ms", allow_hyphen_values = true, value_parser = steps)]
    step: Steps,
    /// From a reading to the position loops; one control step where left out
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = not_negative)]
    delay: Option<f64>,
    /// The natural frequency of the position loops, of second order
    #[arg(long, value_name = "FREQUENCY", default_value = "15 Hz", allow_hyphen_values = true, value_parser = positive(Dimension::Frequency))]
    bandwidth: f64,
    /// Their damping ratio
    #[arg(long, value_name = "RATIO", default_value = "0.7", allow_hyphen_values = true, value_parser = positive(Dimension::Number))]
    loop_damping: f64,
    /// How far a joint may be corrected (a sliding one by as many m as this has rad)
    #[arg(long, value_name = "ANGLE", default_value = "5 mrad", allow_hyphen_values = true, value_parser = positive(Dimension::Angle))]
    most: f64,
    /// How fast a correction may change (rad/s, or m/s of a sliding joint)
    #[arg(long, value_name = "SPEED", default_value = "1 rad/s", allow_hyphen_values = true, value_parser = positive(Dimension::RotationalSpeed))]
    fastest: f64,
    /// For how long the last correction stays when the sensor falls silent, before it is withdrawn
    #[arg(long, value_name = "TIME", default_value = "20 ms", allow_hyphen_values = true, value_parser = not_negative)]
    hold: f64,
    /// When the sensor falls silent, and for how long, e.g. "2 s, 0.5 s"; not with a force by its frequency
    #[arg(long, value_name = "FROM,FOR", allow_hyphen_values = true, value_parser = loss)]
    lost: Option<Loss>,
}

/// Control steps (s).
#[derive(Clone, Debug)]
struct Steps(Vec<f64>);

/// Frequencies (Hz).
#[derive(Clone, Debug)]
struct Frequencies(Vec<f64>);

/// From when and for how long the sensor is silent (s).
#[derive(Clone, Copy, Debug)]
struct Loss([f64; 2]);

fn steps(text: &str) -> Result<Steps, String> {
    list(text, Dimension::Time).map(Steps)
}

fn frequencies(text: &str) -> Result<Frequencies, String> {
    list(text, Dimension::Frequency).map(Frequencies)
}

/// Quantities above zero between commas; those without a unit have that of the
/// last one.
fn list(text: &str, dimension: Dimension) -> Result<Vec<f64>, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let all = input::all_with_unit(&parts, dimension)?;
    all.into_iter().map(|value| input::above_zero(value, dimension)).collect()
}

fn not_negative(text: &str) -> Result<f64, String> {
    input::with_unit(text, Dimension::Time).and_then(from_zero)
}

fn from_zero(time: f64) -> Result<f64, String> {
    if time >= 0.0 { Ok(time) } else { Err("a time of 0 or more is expected here".to_owned()) }
}

fn loss(text: &str) -> Result<Loss, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let [_, _] = parts[..] else { return Err("two times are expected, e.g. \"2 s, 0.5 s\"".to_owned()) };
    let times = input::all_with_unit(&parts, Dimension::Time)?;
    Ok(Loss([from_zero(times[0])?, from_zero(times[1])?]))
}

/// What is compared: a control step, what it reads, and what the controller knows.
#[derive(Clone, Debug)]
struct Variant {
    name: String,
    controller: Controller,
    /// Whether the controller has the robot as it is.
    knows: bool,
}

impl LoadArguments {
    /// Stops where an option is of a path and there is none, or of a pose and there is a path.
    fn fits(&self, path: Option<&Path>) -> Result<(), Failure> {
        let along =
            [("--forces", self.forces.is_some()), ("--feed", self.feed.is_some()), ("--place", self.place.is_some())];
        let at_pose = [
            ("--at", self.at.is_given()),
            ("--force", self.force.is_some()),
            ("--toward", self.toward.is_some()),
            ("--frequencies", self.frequencies.is_some()),
        ];
        let given = |options: &[(&'static str, bool)]| options.iter().find(|(_, given)| *given).map(|(name, _)| *name);
        match (path, given(&along), given(&at_pose)) {
            (None, Some(name), _) => Err(Failure::Usage(format!("{name} goes with a path, and none is given"))),
            (Some(path), _, Some(name)) => {
                Err(Failure::Usage(format!("{name} is for a pose, and {} is a path", path.display())))
            }
            _ => Ok(()),
        }
    }
}

impl ControlArguments {
    fn variants(&self, model: &str) -> Vec<Variant> {
        let of_step = |&step: &f64| {
            let variant = |sensor: &str, sensing, knows| Variant {
                name: format!("{} ms, {sensor}", crate::text::significant(step * 1e3, 4)),
                controller: Controller {
                    sensing,
                    step,
                    delay: self.delay.unwrap_or(step),
                    servo: Servo::SecondOrder { frequency: self.bandwidth, damping: self.loop_damping },
                    limits: Limits { size: self.most, rate: self.fastest, hold: self.hold },
                    damping: 1e-9,
                },
                knows,
            };
            [
                variant("force sensor", Sensing::Force, true),
                variant(&format!("force sensor, {model}"), Sensing::Force, false),
                variant("encoders behind the gears", Sensing::Encoders, true),
            ]
        };
        self.step.0.iter().flat_map(of_step).collect()
    }
}

/// Simulates.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, behind) = (arguments.robot.as_ref(), arguments.path.as_ref());
    let (mut setup, path) = arguments.cell.setup(robot, behind, "robstiff online PATH")?;
    arguments.load.fits(path.as_deref())?;
    input::refuse_if_rigid(&setup.robot, "`robstiff online`")?;
    let mut files = Files::default();
    let request = LoadRequest::read(arguments, path.as_deref(), &mut setup, &mut files)?;
    let robot = &setup.robot;
    let (model, name) = match &arguments.model {
        Some(path) => {
            let model = input::robot(path)?.0;
            // Of a cell it has the same tool in its spindle.
            let tool = if setup.cell().is_some() { robot.tool } else { model.tool };
            (Description { tool, ..model }, path.display().to_string())
        }
        None => (stiffer(robot), "model 10 % too stiff".to_owned()),
    };
    setup.protect(&mut files);
    arguments.model.iter().chain(&path).for_each(|path| files.protect(path));
    files.foresee(arguments.csv.iter().chain(&arguments.json))?;
    let variants = arguments.control.variants(&name);
    let silent = arguments.control.lost.map(|Loss([from, length])| from..from + length);
    let simulated = output::working("simulating the control", |_| {
        with_arm!(robot, |arm| {
            let model = Generic::new(&model).map_err(|error| Failure::new(format!("{name}: {error}")))?;
            request.simulate((&arm, &model), &variants, silent.as_ref())
        })
    })?;
    if let Some(path) = &arguments.csv {
        files.add(path, page::table(&simulated, &variants));
    }
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&page::document(robot, &simulated, &variants)));
    }
    let said = files.write()?;
    output::print(page::page(robot, &simulated, &variants, &arguments.control) + &said)
}

/// The same with the own compliance of every joint a tenth smaller.
fn stiffer(robot: &Description) -> Description {
    let mut stiffer = robot.clone();
    let parts = stiffer.joints.iter_mut().flat_map(|joint| &mut joint.compliance);
    parts.for_each(|part| part.value *= 1.0 - TOO_STIFF);
    stiffer
}
