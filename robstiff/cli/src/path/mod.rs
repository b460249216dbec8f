//! `robstiff path`: the joint coordinates of a tool path, how far forces push the
//! tool off it, and what to command instead.

mod chatter;
pub mod cutting;
pub mod deviation;
pub mod doubts;
mod facts;
mod job;
mod robot_program;
mod stock;

use std::fmt::Write as _;
use std::path::PathBuf;

use robstiff::Robot;
use robstiff::nalgebra::{Matrix4, Rotation3, SVector, Unit, UnitQuaternion, Vector3};
use robstiff_machining::cell::{Cell, TooFast};
use robstiff_machining::inverse::Inverse;
use robstiff_machining::path::{Jump, Known, ToolPath};
use robstiff_machining::program::angles::to_wxyz;
use robstiff_robots::quantity::Dimension;
use robstiff_robots::{Description, JointKind};
use serde_json::json;

use crate::failure::Failure;
use crate::json::Lazy;
use crate::output::{self, Files};
use crate::text::{Table, cell, count, decimals};
use crate::{input, json};
use chatter::Chatter;
use cutting::{Cutting, CuttingRequest};
use robot_program::RobotProgramArguments;

/// Jumps that are shown; the others are counted.
const MOST_JUMPS: usize = 20;

/// Joint coordinates of a tool path, how far a cut pushes the tool off it, and the corrected path
///
/// The path is a program of a machine tool (G-code or APT), or a table.
/// PATH.csv has a point a row: `x y z` and an orientation (`qw qx qy qz`, a
/// rotation vector `rx ry rz`, angles `a b c` about z, y, x, or the direction
/// `ux uy uz` of the tool's axis), or joint coordinates `q1`..; each column as
/// `name [unit]`. See robstiff/docs/commands/path.md.
#[derive(clap::Args)]
pub struct Arguments {
    /// The robot's description, or the name of a robot in the catalogue; left out with `--cell`
    #[arg(value_name = "ROBOT.yaml", required_unless_present = "cell")]
    robot: Option<PathBuf>,
    /// The tool path: a table, G-code (.ngc, .nc, .tap, .gcode, .cnc) or APT (.apt, .cls, .cl)
    #[arg(value_name = "PATH")]
    path: Option<PathBuf>,
    #[command(flatten)]
    cell: input::CellArgument,
    /// Write joint coordinates and poses of every point to FILE; with `--program` the program's files into a folder
    #[arg(long, value_name = "FILE|DIR")]
    out: Option<PathBuf>,
    /// The posture to begin near: joint coordinates in rad (or m), or with their unit as in "0.5, 30 deg, -pi/2"
    #[arg(long, value_name = "q1,q2,..", allow_hyphen_values = true)]
    start: Option<String>,
    /// Where the frame of the path's poses stands in the base frame: x, y, z, then roll, pitch, yaw, as in
    /// "1500 mm, 0, 800 mm, 0, 0, 90 deg"
    #[arg(long, value_name = "x,y,z,roll,pitch,yaw", allow_hyphen_values = true)]
    place: Option<String>,
    /// The axis in the TCP's frame that `ux uy uz` point along: x, y, z, -x, -y or -z; of a program that from the spindle
    /// to the tip. Where left out, that of the cell, or z where the description tells it
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = input::tool_axis)]
    tool_axis: Option<Unit<Vector3<f64>>>,
    /// Write the same as JSON to FILE
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    #[command(flatten)]
    cutting: cutting::ForceArguments,
    #[command(flatten)]
    program: input::ProgramArguments,
    #[command(flatten)]
    robot_program: RobotProgramArguments,
}

/// Solves the path.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (robot, behind) = (arguments.robot.as_ref(), arguments.path.as_ref());
    let (mut setup, file) = arguments.cell.setup(robot, behind, "robstiff path PATH")?;
    let file = file.ok_or_else(|| Failure::Usage("no PATH is given".to_owned()))?;
    let start = match &arguments.start {
        Some(text) => Some(input::coordinates_of("--start", text, &setup.robot)?),
        None => None,
    };
    let place = arguments.place.as_deref().map(place).transpose().map_err(Failure::Usage)?;
    let opened = setup.open(&input::Asked {
        path: &file,
        tool_axis: arguments.tool_axis,
        spindle_axis: arguments.cutting.spindle_axis(),
        place,
        program: &arguments.program,
    })?;
    let path = &opened.path;
    if start.is_some() && path.gives_joints() {
        return Err(Failure::Usage(format!(
            "--start: {} gives joint coordinates, which are taken as they are",
            file.display()
        )));
    }
    let program = arguments.robot_program.read(setup.robot_file(), &setup.robot, &file, arguments.out.as_ref())?;
    let out = arguments.out.as_ref().filter(|_| program.is_none());
    let mut files = Files::default();
    let request = arguments.cutting.read(&setup, opened.spindle, opened.place, &mut files)?;
    if let (Some(request), Some(cell)) = (&request, setup.cell()) {
        request.complain_of_tool(cell, path)?;
    }
    let robot = &setup.robot;
    if request.is_some() {
        input::refuse_if_rigid(robot, "`robstiff path` with a cut or forces")?;
    }
    setup.protect(&mut files);
    files.protect(&file);
    let foreseen = program.as_ref().map(|program| program.foreseen());
    files.foresee(out.into_iter().chain(&arguments.json).chain(foreseen.iter().flatten()))?;
    let solved = output::working("solving the path", |_| {
        with_arm!(robot, |robot| solve(&robot, path, setup.cell(), start.as_deref(), request.as_ref()))
    })?;
    for fast in &solved.too_fast {
        output::complain(format_args!("warning: {}", too_fast(fast, robot, &path.file)));
    }
    if let Some(out) = out {
        files.add(out, table(robot, &solved));
    }
    let mut document = document(robot, &solved);
    let axis = opened.tool_axis.filter(|_| !path.gives_joints()).map(|axis| input::axis_name(&axis));
    let mut page = page(robot, &file.display().to_string(), &solved, axis);
    let mut job_json = None;
    if let Some(program) = &program {
        let commanded = solved.commanded();
        let sent = with_arm!(robot, |arm| program.compose(&arm, robot, path, &opened.place, &commanded))?;
        document.push(("program", sent.document().into()));
        page += &sent.page();
        let facts = facts::Facts {
            robot,
            cell: setup.cell(),
            path,
            place: &opened.place,
            stock: request.as_ref().and_then(CuttingRequest::stock),
            feed: program.feed(),
            files: sent.names(),
        };
        let [of_json, of_html] = sent.job;
        files.add(of_html, job::html(&facts.job(&solved)));
        sent.files.into_iter().for_each(|(path, text)| files.add(path, text));
        job_json = Some(of_json);
    }
    let document = Lazy::Fields(document);
    for path in job_json.iter().chain(&arguments.json) {
        files.add_document(path, &document)?;
    }
    let said = files.write()?;
    output::print(page + &said)
}

/// A path solved, whatever the number of joints.
struct Solved {
    points: Vec<Point>,
    jumps: Vec<Jump>,
    closed_form: bool,
    cutting: Option<Cutting>,
    too_fast: Vec<TooFast>,
}

struct Point {
    line: usize,
    q: Vec<f64>,
    pose: Matrix4<f64>,
    tangent: Option<[f64; 3]>,
    s: f64,
    feed: Option<f64>,
    rapid: bool,
    spindle: Option<f64>,
    tool: Option<u32>,
}

impl Solved {
    /// The points with the joint coordinates to command: those of the corrected path where there is one.
    fn commanded(&self) -> Vec<(&Point, &[f64])> {
        let corrected = self.cutting.as_ref().and_then(|cutting| cutting.corrected.as_ref());
        let q = |i: usize| corrected.map_or(&self.points[i].q, |corrected| &corrected.points[i].q).as_slice();
        self.points.iter().enumerate().map(|(i, point)| (point, q(i))).collect()
    }
}

fn solve<const N: usize>(
    robot: &impl Robot<N>,
    path: &ToolPath,
    cell: Option<&Cell>,
    start: Option<&[f64]>,
    request: Option<&CuttingRequest>,
) -> Result<Solved, Failure> {
    let start = start.map(SVector::<f64, N>::from_column_slice);
    let speeds = cell.map_or(&[][..], |cell| &cell.joint_speeds);
    let mut solved = path.solve_knowing(robot, start.as_ref(), &Known { speeds, ..Known::default() })?;
    let cutting = match request {
        None => None,
        Some(request) => {
            let engaged = request.engaged(path, &solved)?;
            // What acts on a tool is the same at every turn about it, so that these can be chosen for the forces.
            if path.is_planned(robot) {
                let forces = request.forces(path, &solved, engaged.as_ref())?;
                solved = path.solve_knowing(robot, start.as_ref(), &Known { speeds, forces: &forces })?;
            }
            Some(request.compute_engaged(robot, path, &solved, engaged)?)
        }
    };
    let too_fast = cell.map(|cell| cell.too_fast(&solved)).unwrap_or_default();
    let points = solved.points.into_iter().map(|point| Point {
        line: point.line,
        q: point.q.iter().copied().collect(),
        pose: point.pose,
        tangent: point.tangent.map(|tangent| tangent.into_inner().into()),
        s: point.s,
        feed: point.feed,
        rapid: point.rapid,
        spindle: point.spindle,
        tool: point.tool,
    });
    let closed_form = Inverse::new(robot).has_closed_form();
    Ok(Solved { points: points.collect(), jumps: solved.jumps, closed_form, cutting, too_fast })
}

/// What is said of a joint that the path moves faster than it can.
fn too_fast(fast: &TooFast, robot: &Description, file: &str) -> String {
    let joint = &robot.joints[fast.joint - 1];
    let [speed, most] = [fast.speed, fast.most].map(|speed| decimals(joint.for_people(speed), 1));
    let (unit, points) = (joint.people_unit(), count(fast.points, "point"));
    format!(
        "{file}:{}: joint {} would move at {speed} {unit}/s, and can at {most} {unit}/s; too fast to {points}",
        fast.line, fast.joint
    )
}

/// A frame from `x,y,z,roll,pitch,yaw`, as `--place` gives it.
pub fn place(given: &str) -> Result<Matrix4<f64>, String> {
    let parts: Vec<&str> = given.split(',').collect();
    let [x, y, z, roll, pitch, yaw] = parts[..] else {
        return Err(format!("--place gives {}, six are needed", count(parts.len(), "number")));
    };
    let read = |text, dimension| input::with_unit(text, dimension).map_err(|error| format!("--place: {error}"));
    let turn = Rotation3::from_euler_angles(
        read(roll, Dimension::Angle)?,
        read(pitch, Dimension::Angle)?,
        read(yaw, Dimension::Angle)?,
    );
    let at = [x, y, z].map(|text| read(text, Dimension::Length));
    let [x, y, z] = at;
    Ok(Matrix4::new_translation(&Vector3::new(x?, y?, z?)) * turn.to_homogeneous())
}

/// What people are told: length, ranges of the joints, changes of posture.
fn page(robot: &Description, file: &str, solved: &Solved, axis: Option<String>) -> String {
    let length = solved.points.last().map_or(0.0, |point| point.s - solved.points[0].s);
    let points = count(solved.points.len(), "point");
    let rapids = match solved.points.iter().filter(|point| point.rapid).count() {
        0 => String::new(),
        rapids => format!(" ({rapids} by rapids)"),
    };
    let mut page = format!("{} on {file}: {points}{rapids}, {} mm, all reached", robot.name, decimals(length * 1e3, 1));
    page += if solved.closed_form { " (closed form)" } else { " (damped least squares)" };
    page += &axis.map(|axis| format!(", tool along {axis} of the TCP's frame")).unwrap_or_default();
    page += "\n\n";
    let mut table = Table::new(1, ["", "from", "to", "limits", ""]);
    for (i, joint) in robot.joints.iter().enumerate() {
        let of = || solved.points.iter().map(|point| point.q[i]);
        let [least, most] = [of().fold(f64::INFINITY, f64::min), of().fold(f64::NEG_INFINITY, f64::max)];
        let limits = joint.limits.map(|limits| limits.map(|limit| joint.for_people(limit)));
        table.row([
            format!("joint {}", i + 1),
            decimals(joint.for_people(least), 2),
            decimals(joint.for_people(most), 2),
            limits.map_or("none".to_owned(), |[low, high]| format!("[{low}, {high}]")),
            joint.people_unit().to_owned(),
        ]);
    }
    page += &table.to_string();
    if !solved.jumps.is_empty() {
        page += "\nThe arm changes its posture between\n";
    }
    for jump in solved.jumps.iter().take(MOST_JUMPS) {
        let joint = &robot.joints[jump.joint - 1];
        writeln!(
            page,
            "  lines {} and {}: joint {} moves by {} {}, halfway the tool is {} mm and {} deg off",
            jump.lines[0],
            jump.lines[1],
            jump.joint,
            decimals(joint.for_people(jump.change), 1),
            joint.people_unit(),
            decimals(jump.off.distance * 1e3, 1),
            decimals(jump.off.angle.to_degrees(), 1),
        )
        .expect("a string takes any text");
    }
    if solved.jumps.len() > MOST_JUMPS {
        page += &format!("  and {} more\n", solved.jumps.len() - MOST_JUMPS);
    }
    if let Some(cutting) = &solved.cutting {
        page += &deviation::page(cutting);
        page += &cutting.chatter.as_ref().map(Chatter::page).unwrap_or_default();
    }
    page
}

fn quaternion(pose: &Matrix4<f64>) -> [f64; 4] {
    let rotation = Rotation3::from_matrix_unchecked(pose.fixed_view::<3, 3>(0, 0).into_owned());
    to_wxyz(&UnitQuaternion::from_rotation_matrix(&rotation))
}

/// A row for each point, which the command reads again; with the joint coordinates
/// and poses to command where the path is corrected.
fn table(robot: &Description, solved: &Solved) -> String {
    let mut csv = String::new();
    for (number, joint) in (1..).zip(&robot.joints) {
        csv += &format!("q{number} [{}],", joint.people_unit());
    }
    csv += "x [mm],y [mm],z [mm],qw,qx,qy,qz,s [mm]";
    let has_feed = solved.points.iter().any(|point| point.feed.is_some());
    csv += if has_feed { ",feed [mm/min]" } else { "" };
    let has_rapid = solved.points.iter().any(|point| point.rapid);
    csv += if has_rapid { ",rapid" } else { "" };
    let cutting = solved.cutting.as_ref().map(|cutting| (cutting, deviation::Columns::of(cutting)));
    if let Some((cutting, has)) = cutting {
        csv += &format!(",{}", deviation::columns(cutting, has));
    }
    csv.push('\n');
    let corrected = solved.cutting.as_ref().and_then(|cutting| cutting.corrected.as_ref());
    for (i, point) in solved.points.iter().enumerate() {
        let (q, pose) = match corrected.map(|corrected| &corrected.points[i]) {
            Some(corrected) => (&corrected.q, &corrected.pose),
            None => (&point.q, &point.pose),
        };
        for (&q, joint) in q.iter().zip(&robot.joints) {
            // All digits: the file is read again.
            let unit = if joint.kind == JointKind::Revolute { 1_f64.to_radians() } else { 1e-3 };
            csv += &format!("{},", cell(q / unit, 10));
        }
        let position: Vec<String> = (0..3).map(|axis| cell(pose[(axis, 3)] * 1e3, 6)).collect();
        let turn = quaternion(pose).map(|part| cell(part, 12));
        csv += &format!("{},{},{}", position.join(","), turn.join(","), cell(point.s * 1e3, 6));
        if has_feed {
            csv += &format!(",{}", point.feed.map(|feed| cell(feed * 6e4, 6)).unwrap_or_default());
        }
        if has_rapid {
            csv += if point.rapid { ",1" } else { ",0" };
        }
        if let Some((cutting, has)) = cutting {
            csv += &format!(",{}", deviation::cells(cutting, has, i));
        }
        csv.push('\n');
    }
    csv
}

/// Everything in SI units.
fn document<'s>(robot: &Description, solved: &'s Solved) -> Vec<(&'static str, Lazy<'s>)> {
    let length = solved.points.last().map_or(0.0, |point| point.s - solved.points[0].s);
    let point = |point: &Point| {
        json!({
            "line": point.line,
            "q": json::numbers(point.q.iter().copied()),
            "position_m": json::numbers((0..3).map(|axis| point.pose[(axis, 3)])),
            "quaternion_wxyz": json::numbers(quaternion(&point.pose)),
            "feed_direction": point.tangent.map(json::numbers),
            "s_m": json::number(point.s),
            "feed_m_per_s": point.feed.map(json::number),
            "rapid": point.rapid,
        })
    };
    let jump = |jump: &Jump| {
        json!({
            "lines": jump.lines,
            "joint": jump.joint,
            "change": json::number(jump.change),
            "off_m": json::number(jump.off.distance),
            "off_rad": json::number(jump.off.angle),
        })
    };
    let mut document = vec![
        ("robot", json!(robot.name).into()),
        ("closed_form", json!(solved.closed_form).into()),
        ("length_m", json::number(length).into()),
        ("points", Lazy::list(&solved.points, point)),
        ("jumps", Lazy::list(&solved.jumps, jump)),
    ];
    if let Some(cutting) = &solved.cutting {
        document.push(("deviation", deviation::document(cutting)));
        document.extend(cutting.chatter.as_ref().map(|chatter| ("chatter", chatter.document().into())));
    }
    document
}
