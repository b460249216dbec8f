//! A robot alone, or in its cell: what a path needs to know of either.

use std::path::{Path, PathBuf};

use robstiff::nalgebra::{Matrix4, Unit, Vector3};
use robstiff_machining::cell::{Cell, Tool, axis_of};
use robstiff_machining::path::ToolPath;
use robstiff_robots::Description;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};

use super::ProgramArguments;
use super::options::axis_name;
use crate::failure::Failure;
use crate::output::{self, Files};

/// A robot, by its description or by the cell that it stands in.
pub struct Setup {
    /// The robot, with the tool in its spindle once that is known.
    pub robot: Description,
    cell: Option<Cell>,
    file: PathBuf,
}

/// What the options say of a path.
pub struct Asked<'a> {
    pub path: &'a Path,
    /// The axis that the file gives the direction of.
    pub tool_axis: Option<Unit<Vector3<f64>>>,
    /// From the spindle to the tip.
    pub spindle_axis: Option<Unit<Vector3<f64>>>,
    /// Where the path's frame stands in the base frame (m).
    pub place: Option<Matrix4<f64>>,
    pub program: &'a ProgramArguments,
}

/// A path, in the base frame.
pub struct Opened {
    pub path: ToolPath,
    /// The axis that the file gives the direction of, where anything says it.
    pub tool_axis: Option<Unit<Vector3<f64>>>,
    /// From the spindle to the tip, where anything says it.
    pub spindle: Option<Unit<Vector3<f64>>>,
    /// Where the path's frame stands in the base frame (m).
    pub place: Matrix4<f64>,
}

// No doc comment: clap would take it for that of the command.
#[derive(clap::Args)]
pub struct CellArgument {
    /// The cell that the robot stands in (robstiff/docs/cell.md), in place of ROBOT.yaml
    #[arg(long, value_name = "CELL.yaml")]
    cell: Option<PathBuf>,
}

impl CellArgument {
    /// Whether there is one.
    pub fn is_given(&self) -> bool {
        self.cell.is_some()
    }

    /// Reads the robot, or the cell with its robot, and says what is doubtful in it; with what comes behind the
    /// robot, which with a cell comes alone. `command` is how to call it.
    pub fn setup(
        &self,
        first: Option<&PathBuf>,
        second: Option<&PathBuf>,
        command: &str,
    ) -> Result<(Setup, Option<PathBuf>), Failure> {
        match (&self.cell, first, second) {
            (Some(_), _, Some(_)) => Err(Failure::Usage(format!(
                "the cell names its robot: leave ROBOT.yaml out, `{command} --cell CELL.yaml`"
            ))),
            (Some(cell), behind, None) => Ok((of_cell(cell)?, behind.cloned())),
            (None, Some(robot), behind) => Ok((of_robot(robot)?, behind.cloned())),
            (None, None, _) => Err(Failure::Usage("give ROBOT.yaml, or `--cell CELL.yaml`".to_owned())),
        }
    }
}

fn of_robot(path: &Path) -> Result<Setup, Failure> {
    Ok(Setup { robot: super::robot(path)?.0, cell: None, file: path.to_owned() })
}

fn of_cell(path: &Path) -> Result<Setup, Failure> {
    let cell = Cell::read(path)?;
    for warning in cell.robot.warnings() {
        output::complain(format_args!("warning: {}: {warning}", cell.robot_path.display()));
    }
    Ok(Setup { robot: cell.robot.clone(), cell: Some(cell), file: path.to_owned() })
}

/// Whether there is a file with a cell. A pipe, which can be read but once, has none.
pub(super) fn is_cell(path: &Path) -> bool {
    path.is_file() && text::read(path, MOST_OF_DOCUMENT).is_ok_and(|text| Cell::is_one(&text))
}

impl Setup {
    /// The cell, if it is one.
    pub fn cell(&self) -> Option<&Cell> {
        self.cell.as_ref()
    }

    /// The file of the robot's description, or its name in the catalogue.
    pub fn robot_file(&self) -> &Path {
        self.cell.as_ref().map_or(&self.file, |cell| &cell.robot_path)
    }

    /// Where the work frame stands in the base frame (m).
    pub fn place(&self) -> Matrix4<f64> {
        self.cell.as_ref().and_then(Cell::place).unwrap_or_else(Matrix4::identity)
    }

    /// Its files, which are not to be overwritten.
    pub fn protect(&self, files: &mut Files) {
        files.protect(&self.file);
        if let Some(cell) = &self.cell {
            files.protect(&cell.robot_path);
        }
    }

    /// The cut: the one that is given, else that of the cell.
    pub fn cut(&self, given: Option<&PathBuf>) -> Option<PathBuf> {
        given.or(self.cell.as_ref().and_then(|cell| cell.cut.as_ref())).cloned()
    }

    /// Puts the tool into the spindle where there is no path.
    pub fn mount(&mut self) -> Result<(), Failure> {
        let Some(cell) = &self.cell else { return Ok(()) };
        let tool = cell.mounted().map_err(Failure::new)?;
        self.robot = cell.robot_with(tool);
        Ok(())
    }

    /// The axis of the spindle that the cell says.
    fn said(&self) -> Option<Unit<Vector3<f64>>> {
        self.cell.as_ref().and_then(|cell| cell.spindle.as_ref()).map(|spindle| spindle.axis)
    }

    /// From the spindle to the tip, where there is no path: as an option gives it, else as the cell or the
    /// description says it.
    pub fn spindle(&self, option: &str, given: Option<Vector3<f64>>) -> Result<Option<Unit<Vector3<f64>>>, Failure> {
        let given = given.map(Unit::new_normalize);
        self.refuse_other(option, given, false)?;
        Ok(given.or(self.said()).or_else(|| axis_of(&self.robot)))
    }

    /// Stops where an option gives another axis than the cell; `either_way`: with either sign.
    fn refuse_other(&self, option: &str, given: Option<Unit<Vector3<f64>>>, either_way: bool) -> Result<(), Failure> {
        let (Some(given), Some(said)) = (given, self.said()) else { return Ok(()) };
        let along = given.dot(&said);
        if (if either_way { along.abs() } else { along }) > 1.0 - 1e-9 {
            return Ok(());
        }
        Err(Failure::Usage(format!(
            "{option}: in {} the spindle is along {} of the TCP's frame; leave the option out, or change `axis` there",
            self.file.display(),
            axis_name(&said)
        )))
    }

    /// What is said where nothing tells the direction of the spindle.
    pub fn lacks_axis(&self, option: &str) -> Failure {
        Failure::Usage(format!(
            "nothing says where the spindle of {} points; give the axis of the TCP's frame from the spindle to the tip, \
             e.g. `{option} x` (or y, z, -x, -y, -z), or a cell with `spindle: {{axis: x}}`",
            self.robot.name
        ))
    }

    /// Reads a path, puts it where it is to be, and its tool into the spindle.
    pub fn open(&mut self, asked: &Asked<'_>) -> Result<Opened, Failure> {
        let options = asked.program.options(asked.path, self.cell.as_ref())?;
        let tool_axis = asked.tool_axis.or(self.said()).or_else(|| axis_of(&self.robot));
        let read = tool_axis.unwrap_or(Vector3::z_axis());
        let mut path = ToolPath::open(asked.path, &self.robot, read, &options)?;
        // A table may give the direction from the tip to the spindle.
        self.refuse_other("--tool-axis", asked.tool_axis, !path.is_program)?;
        self.refuse_other("--spindle-axis", asked.spindle_axis, false)?;
        if tool_axis.is_none() && path.gives_axes() {
            return Err(self.lacks_axis("--tool-axis"));
        }
        for warning in &path.warnings {
            output::complain(format_args!("warning: {warning}"));
        }
        if let Some(cell) = &self.cell {
            let tool: Option<&Tool> = cell.tool_on(&path)?;
            for doubt in cell.doubts(&path, tool) {
                output::complain(format_args!("warning: {doubt}"));
            }
            self.robot = cell.robot_with(tool);
        }
        if asked.place.is_some() {
            refuse_if_in_no_frame(&path)?;
        }
        let place = asked.place.or(self.cell.as_ref().and_then(Cell::place));
        if let Some(place) = &place {
            path = path.placed(place);
        }
        let from_file = tool_axis.map(|axis| from_spindle(axis, path.is_program));
        let spindle = asked.spindle_axis.or(self.said()).or(from_file);
        Ok(Opened { path, tool_axis, spindle, place: place.unwrap_or_else(Matrix4::identity) })
    }
}

/// That `--place` has a frame to put somewhere.
fn refuse_if_in_no_frame(path: &ToolPath) -> Result<(), Failure> {
    if path.gives_joints() {
        let message = format!("--place: {} gives joint coordinates, which stand in no frame", path.file);
        return Err(Failure::Usage(message));
    }
    Ok(())
}

/// From the spindle to the tip, where nothing else is said: of a program the tool's axis, of a table
/// that without its sign, which says how the file writes it.
fn from_spindle(tool_axis: Unit<Vector3<f64>>, is_program: bool) -> Unit<Vector3<f64>> {
    if is_program { tool_axis } else { Unit::new_unchecked(tool_axis.abs()) }
}
