//! Reading a tool path from a program of a machine tool.

use std::path::Path;

use nalgebra::{Unit, Vector3};
use robstiff_robots::table::text_of;
use robstiff_robots::text::Lines;
use robstiff_robots::{Description, Diagnostic, Diagnostics, Line, ReadError};

use super::{Goal, Orientation, Target, ToolPath, Waypoint};
use crate::nc::{Format, Move, Options, Reader};

/// Points of a program, arcs split: a gigabyte, and more than anybody mills.
const MOST_POINTS: usize = 5_000_000;

impl ToolPath {
    /// Reads a tool path by the end of its file's name: G-code (`.ngc`, `.nc`, `.tap`, `.gcode`,
    /// `.cnc`), APT (`.apt`, `.cls`, `.cl`), else a table as [`read`](Self::read) does. `tool` is the
    /// axis in the TCP's frame whose direction the file gives; of a program that is the one from
    /// the spindle to the tip.
    ///
    /// # Errors
    /// A file that cannot be read; everything that is wrong with it, each problem at its place.
    pub fn open(
        path: impl AsRef<Path>,
        robot: &Description,
        tool: Unit<Vector3<f64>>,
        options: &Options,
    ) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let Some(format) = Format::of(path) else { return Self::read(path, robot, tool) };
        Self::of_program(format, &path.display().to_string(), text_of(path)?, tool, options).map_err(ReadError::Invalid)
    }

    /// The tool path of a program; `file` is the name that problems show.
    ///
    /// # Errors
    /// Everything that is wrong with it, each problem at its place.
    pub fn of_program(
        format: Format,
        file: &str,
        text: String,
        tool: Unit<Vector3<f64>>,
        options: &Options,
    ) -> Result<Self, Diagnostics> {
        let lines = Lines::new(text);
        let mut reader = Reader::new(format, file, &lines, options);
        let (mut points, mut problems) = (Vec::new(), Vec::new());
        let whole = |number: usize, message: &str, help: &str| {
            Diagnostic::of_line(file, Line { number, text: lines.line(number) }, message, help)
        };
        for each in &mut reader {
            match each {
                Ok(each) if points.len() >= MOST_POINTS => {
                    let help = "split the program, or allow for a larger `--arc-tolerance`";
                    problems.push(whole(each.line, "the program has more than 5000000 points", help));
                    break;
                }
                Ok(each) => points.push(waypoint(&each, tool)),
                Err(problem) => problems.push(problem),
            }
        }
        let warnings = reader.warnings();
        if problems.is_empty() && points.is_empty() {
            problems.push(whole(1, "the program never says where the tool is", "X, Y and Z, by G0, G1 or GOTO"));
        }
        match Diagnostics::new(problems) {
            Some(problems) => Err(problems),
            None => Ok(Self { file: file.to_owned(), points, warnings, is_program: true, tool, lines }),
        }
    }
}

fn waypoint(each: &Move, tool: Unit<Vector3<f64>>) -> Waypoint {
    let orientation = Orientation::Axis { tool, direction: -each.axis };
    Waypoint {
        line: each.line,
        goal: Goal::Tool(Target { position: each.point, orientation }),
        feed: each.feed,
        s: None,
        rapid: each.rapid,
        spindle: Some(each.spindle),
        tool: each.tool,
        width: None,
        depth: None,
    }
}
