//! The robot program of a path.

use std::path::{Path, PathBuf};

use robstiff::Generic;
use robstiff::nalgebra::{Matrix4, SVector};
use robstiff_machining::controller::{
    Composed, Nominal, Order, Postures, Sent, Targets, Uncomposable, compose, files, isometry_of,
};
use robstiff_machining::path::ToolPath;
use robstiff_machining::program::{Frame, Instruction, Language, TextFile, Zone};
use robstiff_robots::Description;
use robstiff_robots::quantity::Dimension;
use serde_json::{Value, json};

use super::Point;
use crate::failure::Failure;
use crate::input::{self, RobotLanguage, positive};
use crate::text::count;

/// Names of programs that all languages take, with what is added where a program is split.
const LONGEST_NAME: usize = 19;

/// Problems that are shown.
const MOST_SHOWN: usize = 10;

// No doc comment: clap would take it for that of the command.
#[derive(clap::Args)]
#[command(next_help_heading = "The path as a robot program")]
pub struct RobotProgramArguments {
    /// Write a program of the robot's controller, job.json and job.html into the folder `--out`
    #[arg(long, value_name = "LANGUAGE", value_enum, requires = "out")]
    program: Option<RobotLanguage>,
    /// The program's name; that of the path's file where left out
    #[arg(long, value_name = "NAME", requires = "program")]
    name: Option<String>,
    /// Positions as poses or as angles of the joints; where left out what fits arm and language
    #[arg(long, value_name = "WHICH", value_enum, requires = "program")]
    targets: Option<Which>,
    /// The name or number under which the controller has the tool
    #[arg(long, value_name = "NAME", requires = "program")]
    tool_data: Option<String>,
    /// The name or number under which the controller has the frame of the path
    #[arg(long, value_name = "NAME", requires = "program")]
    work_data: Option<String>,
    /// How fast joint motions are: "10 %" of the fastest (KRL, LS), "200 mm/s" (RAPID), "30 deg/s" (UR); these
    /// where left out
    #[arg(long, value_name = "SPEED", requires = "program")]
    rapid_speed: Option<String>,
    /// The feed where the path has none
    #[arg(long, value_name = "SPEED", requires = "program", value_parser = positive(Dimension::Speed))]
    feed: Option<f64>,
    /// How near the tool passes the points of a cut: "0.1 mm" (KRL, RAPID, UR), "50 %" (LS); it stops there where left out
    #[arg(long, value_name = "HOW", requires = "program")]
    blend: Option<String>,
    /// What starts the spindle, in the language; `{rpm}` stands for its speed
    #[arg(long, value_name = "TEXT", requires = "program")]
    spindle_on: Option<String>,
    /// What stops the spindle, in the language
    #[arg(long, value_name = "TEXT", requires = "program")]
    spindle_off: Option<String>,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Which {
    Poses,
    Joints,
}

/// What is asked for, read.
pub struct ProgramRequest {
    order: Order,
    nominal: Option<Description>,
    folder: PathBuf,
}

/// A program of a path.
pub struct Sending {
    /// Its files, in the folder.
    pub files: Vec<(PathBuf, String)>,
    /// Where job.json and job.html go.
    pub job: [PathBuf; 2],
    composed: Composed,
    language: Language,
    stops: bool,
    nominal: Option<String>,
}

impl RobotProgramArguments {
    /// Reads what is asked for; `None` where it is no program.
    pub fn read(
        &self,
        robot_file: &Path,
        robot: &Description,
        path: &Path,
        out: Option<&PathBuf>,
    ) -> Result<Option<ProgramRequest>, Failure> {
        let (Some(language), Some(folder)) = (self.program.map(Language::from), out) else { return Ok(None) };
        let nominal = input::nominal(robot_file, robot)?;
        let usage = |option: &str, why: String| Failure::Usage(format!("{option}: {why}"));
        let rapid = self.rapid_speed.as_deref().unwrap_or(match language {
            Language::Krl | Language::Ls => "10 %",
            Language::Rapid => "200 mm/s",
            Language::Ur => "30 deg/s",
        });
        let rapid = input::joint_speed(rapid, language).map_err(|why| usage("--rapid-speed", why))?;
        let zone = match &self.blend {
            Some(text) => input::blend(text, language).map_err(|why| usage("--blend", why))?,
            None => Zone::Fine,
        };
        let names = match language {
            // Without a number KRL has the frames in the program.
            Language::Krl => ["", ""],
            Language::Rapid | Language::Ur => ["tRobstiff", "wRobstiff"],
            Language::Ls => ["1", "1"],
        };
        let frame = |given: &Option<String>, name: &str| Frame {
            name: given.clone().unwrap_or_else(|| name.to_owned()),
            pose: None,
        };
        let order = Order {
            language,
            name: self.name.clone().unwrap_or_else(|| name_of(path)),
            tool: frame(&self.tool_data, names[0]),
            work: frame(&self.work_data, names[1]),
            targets: self.targets.map(|which| if which == Which::Poses { Targets::Poses } else { Targets::Joints }),
            rapid,
            feed: self.feed,
            zone,
            spindle: [self.spindle_on.clone(), self.spindle_off.clone()],
        };
        Ok(Some(ProgramRequest { order, nominal, folder: folder.clone() }))
    }
}

impl ProgramRequest {
    /// The files that will come of it for certain.
    pub fn foreseen(&self) -> [PathBuf; 3] {
        let end = match self.order.language {
            Language::Krl => "src",
            Language::Rapid => "mod",
            Language::Ls => "ls",
            Language::Ur => "script",
        };
        let name = match self.order.language {
            Language::Ls => self.order.name.to_ascii_uppercase(),
            _ => self.order.name.clone(),
        };
        let [document, page] = self.job();
        [self.folder.join(format!("{name}.{end}")), document, page]
    }

    fn job(&self) -> [PathBuf; 2] {
        ["job.json", "job.html"].map(|name| self.folder.join(name))
    }

    /// The feed where the path has none (m/s).
    pub fn feed(&self) -> Option<f64> {
        self.order.feed
    }

    /// The program that sends a robot through points; the path's frame stands at `place` in the base frame.
    pub(super) fn compose<const N: usize>(
        &self,
        _: &Generic<N>,
        robot: &Description,
        path: &ToolPath,
        place: &Matrix4<f64>,
        points: &[(&Point, &[f64])],
    ) -> Result<Sending, Failure> {
        let nominal = Nominal::<N>::new(robot, self.nominal.as_ref()).map_err(Failure::new)?;
        let postures = Postures::new(&nominal);
        let mut order = self.order.clone();
        order.tool.pose = Some(nominal.tool(&robot.tool));
        order.work.pose = Some(nominal.in_world(&isometry_of(place)));
        let sent = points.iter().map(|(point, q)| Sent {
            line: point.line,
            q: SVector::from_column_slice(q),
            rapid: point.rapid,
            feed: point.feed,
            spindle: point.spindle,
            tool: point.tool,
        });
        let sent: Vec<Sent<N>> = sent.collect();
        let composed = compose(&postures, &sent, &order).map_err(|why| match why {
            Uncomposable::NoFeed(line) => {
                let help = "give it in the path, or for all points without one as `--feed \"20 mm/s\"`";
                Failure::Explained(path.diagnostic(line, why.to_string(), help).to_string())
            }
            Uncomposable::NoPosture(_) => Failure::new(format_args!("{why}; say `--targets joints`")),
            Uncomposable::Turntable => Failure::new(why),
        })?;
        let files = files(order.language, &composed.program).map_err(|wrong| {
            let shown: Vec<String> = wrong.iter().take(MOST_SHOWN).map(|one| format!("error: {one}")).collect();
            Failure::Explained(shown.join("\n"))
        })?;
        let files = files.into_iter().map(|TextFile { name, text }| (self.folder.join(name), text)).collect();
        let stops = order.zone == Zone::Fine && points.len() > 2;
        let nominal = self.nominal.as_ref().map(|nominal| nominal.name.clone());
        Ok(Sending { files, job: self.job(), composed, language: order.language, stops, nominal })
    }
}

impl Sending {
    /// What a person is shown.
    pub fn page(&self) -> String {
        let motions = count(self.composed.program.instructions.iter().filter(|one| is_motion(one)).count(), "motion");
        let targets = if self.composed.targets == Targets::Poses { "poses" } else { "angles of the joints" };
        let model = match &self.nominal {
            Some(name) => format!("{name}, the nominal description"),
            None => "the description's table without effects".to_owned(),
        };
        let language = self.language.word();
        let mut page = format!("\nProgram ({language}): {motions} to {targets}; the controller solves with {model}\n");
        if let Some(why) = &self.composed.why {
            page += &format!("positions are {targets}: {why}\n");
        }
        if self.composed.without_feed {
            page += "cuts move the joints, for which the language has no feed: they are as fast as `--rapid-speed`\n";
        }
        if self.stops {
            page += "the tool stops at every point; `--blend` lets it pass\n";
        }
        if self.language == Language::Ls && self.composed.targets == Targets::Poses {
            page += "tell the controller where UTOOL and UFRAME stand: the program has them as remarks alone\n";
        }
        page
    }

    /// The names of its files.
    pub fn names(&self) -> Vec<String> {
        let name = |path: &PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        self.files.iter().map(|(path, _)| name(path)).collect()
    }

    /// The same for programs.
    pub fn document(&self) -> Value {
        json!({
            "language": self.language.word(),
            "files": self.names(),
            "targets": if self.composed.targets == Targets::Poses { "poses" } else { "joints" },
            "why": self.composed.why,
            "nominal": self.nominal,
        })
    }
}

fn is_motion(instruction: &Instruction) -> bool {
    matches!(instruction, Instruction::Move(_))
}

/// The name of a program of a path's file.
fn name_of(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let letter = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    let name: String = stem.chars().map(letter).collect();
    let name = if name.starts_with(|first: char| first.is_ascii_alphabetic()) { name } else { format!("P{name}") };
    name.chars().take(LONGEST_NAME).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_has_a_name_that_controllers_take() {
        let names = ["a/pocket.csv", "7-slots.v2.ngc", "a_very_long_name_of_a_part.ngc", "ä.ngc"];
        let names = names.map(|path| name_of(Path::new(path)));
        assert_eq!(names, ["pocket", "P7_slots_v2", "a_very_long_name_of", "P_"]);
    }
}
