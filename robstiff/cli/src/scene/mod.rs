//! `robstiff view`: the arm, its compliance and a path as a page that turns.

mod content;
mod page;
mod picture;

use std::path::PathBuf;

use robstiff_identify::campaign::JointTable;
use robstiff_robots::Description;

use crate::failure::Failure;
use crate::input::{Force, force, tolerance};
use crate::output::{self, Files};
use crate::text::{count, significant};
use crate::{effect, input, json};
use content::{Kind, Row, Scene};

/// The arm in 3-D with its compliance ellipsoids, at a pose, along a path or over a campaign, as a page
///
/// The page needs nothing beside it. It turns with the mouse, a finger or the
/// arrow keys; without scripts and on paper it is a drawing.
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue; left out with `--cell`
    #[arg(value_name = "ROBOT.yaml", required_unless_present = "cell")]
    robot: Option<PathBuf>,
    #[command(flatten)]
    cell: input::CellArgument,
    #[command(flatten)]
    at: input::At,
    /// A table of joint coordinates `q1 [deg]` .. and, where there are, forces `Fx [N]` .. and moments `Mx [Nm]` .., row by row
    #[arg(long, value_name = "SOLVED.csv", conflicts_with_all = ["campaign", "at"])]
    path: Option<PathBuf>,
    /// The poses of a campaign, with the displacements that it measured and those that the robot predicts, or how far
    /// positions are off
    #[arg(long, value_name = "CAMPAIGN.yaml", conflicts_with_all = ["force", "at"])]
    campaign: Option<PathBuf>,
    /// The force on the tool in the base frame, e.g. "0, 0, -400 N"; the path's own where left out
    #[arg(long, value_name = "Fx,Fy,Fz", allow_hyphen_values = true, value_parser = force)]
    force: Option<Force>,
    /// The column of the path that colours it; the deviation under the force where left out
    #[arg(long, value_name = "NAME", requires = "path", conflicts_with_all = ["campaign", "at"])]
    column: Option<String>,
    /// How large what colours the poses may be, either way, e.g. "0.1 mm" or "IT9 of 50 mm": marked on the scale, with pass or fail at the top
    #[arg(long, value_name = "LENGTH", conflicts_with = "at", value_parser = tolerance)]
    tolerance: Option<f64>,
    /// The page
    #[arg(long, value_name = "PAGE.html")]
    out: PathBuf,
    /// Write what is drawn as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Draws.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (mut setup, more) = arguments.cell.setup(arguments.robot.as_ref(), None, "robstiff view")?;
    if more.is_some() {
        return Err(Failure::Usage("the cell names its robot: leave ROBOT.yaml out".to_owned()));
    }
    setup.mount()?;
    let robot = &setup.robot;
    input::complain_if_rigid(robot);
    let mut files = Files::default();
    setup.protect(&mut files);
    arguments.path.iter().for_each(|path| files.protect(path));
    files.foresee(arguments.json.iter().chain([&arguments.out]))?;
    let scene = if let Some(path) = &arguments.campaign {
        let campaign = input::campaign(path)?;
        files.protect_campaign(&campaign);
        Scene::of_campaign(robot, &campaign)?
    } else if let Some(path) = &arguments.path {
        // As in the header, the name may carry its unit.
        let column = arguments.column.as_deref().map(|name| name.split('[').next().unwrap_or(name).trim());
        let table = JointTable::read(path, robot, column)?;
        for warning in &table.warnings {
            output::complain(format_args!("warning: {warning}"));
        }
        Scene::new(robot, Kind::Path, &rows(table, arguments.force)).coloured_by(column)
    } else {
        let q = arguments.at.pose(robot)?;
        let row = Row { q, wrench: arguments.force.map(Force::wrench), value: None, rapid: false };
        Scene::new(robot, Kind::Pose, &[row])
    };
    let scene = scene.within(arguments.tolerance)?;
    let document = scene.document(robot);
    files.add(&arguments.out, page::html(robot, &scene, &document));
    if let Some(path) = &arguments.json {
        files.add(path, json::document(&document));
    }
    let said = files.write()?;
    output::print(summary(robot, &scene) + &said)
}

fn rows(table: JointTable, force: Option<Force>) -> Vec<Row> {
    let JointTable { q, wrenches, column, rapids, .. } = table;
    let rows = q.into_iter().enumerate().map(|(k, q)| Row {
        q,
        wrench: force.map(Force::wrench).or_else(|| Some(wrenches.as_ref()?[k])),
        value: column.as_ref().and_then(|column| Some((column.values[k]?, column.unit.clone()))),
        rapid: rapids.as_ref().is_some_and(|rapids| rapids[k]),
    });
    rows.collect()
}

fn summary(robot: &Description, scene: &Scene) -> String {
    let mut said = format!("{}: {}", robot.name, count(scene.rows, "pose"));
    if scene.poses.len() < scene.rows {
        said += &format!(", one in {} drawn, and the extremes", scene.stride);
    }
    said.push('\n');
    let softest = scene.poses.iter().filter_map(|pose| pose.principal).map(|principal| principal[0]);
    if let Some(softest) = softest.max_by(f64::total_cmp) {
        let of = effect::unloaded(robot).map(|of| format!(", {of}")).unwrap_or_default();
        // Of a rigid arm nothing is soft.
        let softest = if softest > 0.0 { format!("{} um/N", significant(softest, 4)) } else { "rigid".to_owned() };
        said += &format!("softest direction: {softest}{of}\n");
    }
    if let Some(values) = &scene.values {
        let unit = if values.unit.is_empty() { String::new() } else { format!(" {}", values.unit) };
        let [least, most] = [values.least, values.most].map(|value| significant(value, 4));
        let range = if least == most { least } else { format!("{least} to {most}") };
        said += &format!("{}: {range}{unit}\n", values.name);
        said.extend(values.verdict().map(|(_, verdict)| verdict.replace('µ', "u") + "\n"));
    }
    said
}
