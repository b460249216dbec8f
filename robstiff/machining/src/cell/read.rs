//! Reading a cell.

use std::path::{Path, PathBuf};

use nalgebra::{Matrix3, Unit, Vector3};
use robstiff_robots::angle::snapped;
use robstiff_robots::document::{Document, Map, Node};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};
use robstiff_robots::words::count;
use robstiff_robots::{Description, Joint, JointKind, Placement, ReadError, catalogue};

use super::parts::{Cell, Program, Spindle, Tool, Work, rotation};
use crate::nc::{Machine, OFFSETS};

/// The fields of a cell.
pub(super) const FIELDS: [&str; 10] =
    ["name", "robot", "spindle", "tools", "tool", "work", "stock", "joint_speeds", "cut", "program"];

/// Those of a spindle.
pub(super) const SPINDLE: [&str; 4] = ["xyz", "rpy", "axis", "speeds"];

/// Those of a tool.
pub(super) const TOOL: [&str; 5] = ["name", "length", "diameter", "corner_radius", "teeth"];

/// Those of the stock.
pub(super) const STOCK: [&str; 2] = ["from", "to"];

/// Those of what programs assume.
pub(super) const PROGRAM: [&str; 5] = ["machine", "center", "pivot_length", "tcp", "arc_tolerance"];

/// Those of the place of the work: a frame, or frames by their names.
const WORK: [&str; 11] = ["xyz", "rpy", "G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"];

/// Frames turned against each other by less are parallel (rad).
const PARALLEL: f64 = 1e-9;

impl Cell {
    /// Reads a cell and its robot: a file with its path from the cell's folder, or the name of a robot in
    /// the catalogue.
    ///
    /// # Errors
    /// A file that cannot be read; everything that is wrong with the cell, each problem at its place; or
    /// with the description of the robot.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let text = text::read(path, MOST_OF_DOCUMENT)?;
        Self::parse(&path.display().to_string(), &text, path.parent().unwrap_or(Path::new("")))
    }

    /// Reads a cell; `file` is the name that problems show, `folder` what the paths in it start from.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(file: &str, text: &str, folder: &Path) -> Result<Self, ReadError> {
        let document = Document::parse(file, text).map_err(ReadError::Invalid)?.wary();
        let cell = cell(file, &document, folder);
        document.finish(cell).map_err(ReadError::Invalid)?
    }

    /// Whether a text is that of a cell, rather than of a robot's description or of a campaign.
    pub fn is_one(text: &str) -> bool {
        let Ok(document) = Document::parse("", text) else { return false };
        let root = document.root();
        let Some(map) = root.is_map().then(|| root.any_map("")).flatten() else { return false };
        let has = |field: &&str| map.get(field).is_some();
        FIELDS.iter().any(|field| !["name", "tool"].contains(field) && has(field))
            && !["joints", "convention", "observations"].iter().any(has)
    }
}

/// The cell, or why the robot's own file cannot be read.
fn cell(file: &str, document: &Document, folder: &Path) -> Option<Result<Cell, ReadError>> {
    let map = document.root().map(&FIELDS)?;
    // Everything is read before anything is given up, to report all problems.
    let name = map.get("name").map_or(Some(String::new()), |node| node.text().map(ToOwned::to_owned));
    let robot = map.require("robot", "robot: rv130hsc").and_then(|node| robot(&node, folder));
    let spindle = map.get("spindle").map_or(Some(None), |node| spindle(&node).map(Some));
    let tools = map.get("tools").map_or(Some(Vec::new()), |node| {
        if map.get("spindle").is_none() {
            node.error(
                "a tool stands in a spindle, and the cell has none",
                "add it, with the direction from its nose to the tip, e.g. `spindle: {axis: z}`",
            );
        }
        tools(&node)
    });
    let tool = map.get("tool").map_or(Some(None), |node| mounted(&node, tools.as_deref()).map(Some));
    let work = map.get("work").map_or(Some(None), |node| work(&node).map(Some));
    let stock = map.get("stock").map_or(Some(None), |node| stock(&node).map(Some));
    let known = robot.as_ref().and_then(|read| read.as_ref().ok()).map(|(robot, _)| robot);
    let joint_speeds = map.get("joint_speeds").map_or(Some(Vec::new()), |node| joint_speeds(&node, known));
    let cut = map.get("cut").map_or(Some(None), |node| existing(&node, folder).map(Some));
    let program = map.get("program").map_or(Some(Program::default()), |node| program(&node));
    let (name, spindle, tools, tool, work, stock) = (name?, spindle?, tools?, tool?, work?, stock?);
    let (joint_speeds, cut, program, file) = (joint_speeds?, cut?, program?, file.to_owned());
    Some(robot?.map(|(robot, robot_path)| Cell {
        name,
        file,
        robot,
        robot_path,
        spindle,
        tools,
        tool,
        work,
        stock,
        joint_speeds,
        cut,
        program,
    }))
}

/// The robot, or why its own file cannot be read; `None` where there is no such file.
fn robot(node: &Node<'_>, folder: &Path) -> Option<Result<(Description, PathBuf), ReadError>> {
    let name = node.text()?;
    let path = folder.join(name);
    if !path.is_file() && catalogue::find(name).is_none() {
        let help = format!("write its path from the folder of this file, or a name: {}", catalogue::names());
        node.error(format!("there is no file {}, and no robot of that name in the catalogue", path.display()), help);
        return None;
    }
    Some(catalogue::read(folder, Path::new(name)))
}

/// A file by its path from the folder of the cell.
fn existing(node: &Node<'_>, folder: &Path) -> Option<PathBuf> {
    let path = folder.join(node.text()?);
    if !path.is_file() {
        node.error(format!("there is no file {}", path.display()), "write the path from the folder of this file");
        return None;
    }
    Some(path)
}

/// A field that may be left out.
fn optional<T>(map: &Map<'_>, field: &str, read: impl FnOnce(&Node<'_>) -> Option<T>) -> Option<Option<T>> {
    map.get(field).map_or(Some(None), |node| read(&node).map(Some))
}

/// An axis by its name.
fn axis(node: &Node<'_>) -> Option<Unit<Vector3<f64>>> {
    let [x, y, z] = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
    node.choice(&[("x", x), ("y", y), ("z", z), ("-x", -x), ("-y", -y), ("-z", -z)])
}

fn spindle(node: &Node<'_>) -> Option<Spindle> {
    let map = node.map(&SPINDLE)?;
    let xyz = optional(&map, "xyz", |node| node.quantities::<3>(Dimension::Length));
    let rpy = optional(&map, "rpy", |node| node.quantities::<3>(Dimension::Angle));
    let axis = map.require("axis", "axis: z").and_then(|node| axis(&node));
    let speeds = optional(&map, "speeds", |node| {
        let speeds = node.quantities::<2>(Dimension::RotationalSpeed)?;
        if speeds[0] <= 0.0 || speeds[0] >= speeds[1] {
            node.error("the least speed is not above zero and below the highest", "e.g. `[3000 rpm, 24000 rpm]`");
            return None;
        }
        Some(speeds)
    });
    let (xyz, rpy) = (xyz?, rpy?);
    let is_given = xyz.is_some() || rpy.is_some();
    let nose = Placement { xyz: xyz.unwrap_or_default(), rpy: rpy.unwrap_or_default().map(snapped) };
    Some(Spindle { nose: is_given.then_some(nose), axis: axis?, speeds: speeds? })
}

const TOOLS_HELP: &str = "name the tools by their numbers, e.g. `T1: {length: 120 mm, diameter: 16 mm}`";

/// The number of a tool: `T1`, or `1`.
fn number(name: &str) -> Option<u32> {
    let digits = name.strip_prefix(['T', 't']).unwrap_or(name);
    let is_whole = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    is_whole.then(|| digits.parse().ok()).flatten()
}

fn tools(node: &Node<'_>) -> Option<Vec<Tool>> {
    let map = node.any_map(TOOLS_HELP)?;
    let mut tools: Vec<Tool> = Vec::new();
    let (mut given, mut are_right) = (Vec::new(), true);
    for (name, node) in map.fields() {
        let Some(number) = number(name) else {
            node.error(format!("`{name}` is no number of a tool"), TOOLS_HELP);
            are_right = false;
            continue;
        };
        if given.contains(&number) {
            node.error(format!("the tool T{number} is given twice"), "keep one of the two");
            are_right = false;
        }
        given.push(number);
        match tool(number, &node) {
            Some(tool) => tools.push(tool),
            None => are_right = false,
        }
    }
    if given.is_empty() && are_right {
        node.error("at least one tool is expected here", TOOLS_HELP);
        return None;
    }
    are_right.then_some(tools)
}

fn tool(number: u32, node: &Node<'_>) -> Option<Tool> {
    let map = node.map(&TOOL)?;
    let name = optional(&map, "name", |node| node.text().map(ToOwned::to_owned));
    let length = map.require("length", "length: 120 mm").and_then(|node| node.positive(Dimension::Length));
    let diameter = optional(&map, "diameter", |node| node.positive(Dimension::Length));
    let corner_radius = optional(&map, "corner_radius", |node| {
        let radius = node.nonnegative(Dimension::Length)?;
        let diameter = diameter.flatten();
        // Half of a diameter in mm is not always the double nearest to it.
        if diameter.is_some_and(|diameter| radius > 0.5 * diameter * (1.0 + 1e-12)) {
            node.error("the corner is larger than half of the tool", "a ball has half of the `diameter` here");
            return None;
        }
        Some(radius)
    });
    let teeth = optional(&map, "teeth", |node| {
        let teeth = node.integer(3)?;
        if !(1..=100).contains(&teeth) {
            node.error(format!("a mill has 1 to 100 teeth, not {teeth}"), "e.g. `3`");
            return None;
        }
        usize::try_from(teeth).ok()
    });
    Some(Tool {
        number,
        name: name?.unwrap_or_default(),
        length: length?,
        diameter: diameter?,
        corner_radius: corner_radius?,
        teeth: teeth?,
    })
}

fn mounted(node: &Node<'_>, tools: Option<&[Tool]>) -> Option<u32> {
    let name = node.text()?;
    let number = number(name);
    // What is wrong with the tools is reported there.
    let Some(tools) = tools else { return number };
    let has = number.filter(|number| tools.iter().any(|tool| tool.number == *number));
    if has.is_none() {
        let names: Vec<String> = tools.iter().map(|tool| format!("`T{}`", tool.number)).collect();
        let help = if names.is_empty() { TOOLS_HELP.to_owned() } else { format!("there are {}", names.join(", ")) };
        node.error(format!("`tools` has no tool `{name}`"), help);
    }
    has
}

fn work(node: &Node<'_>) -> Option<Work> {
    let mut offsets = [None; OFFSETS.len()];
    let any = node.any_map("say where the frame stands, e.g. `{xyz: [1.5 m, 0 m, 0.8 m]}`")?;
    if !any.fields().any(|(name, _)| OFFSETS.contains(&name)) {
        return Placement::read(node).map(|place| Work { place, offsets });
    }
    let map = node.map(&WORK)?;
    for field in ["xyz", "rpy"] {
        if let Some(node) = map.get(field) {
            node.error("frames with names have places of their own", "write it into each frame, e.g. `G54: {xyz: ..}`");
        }
    }
    let first = map.require("G54", "G54: {xyz: [1.5 m, 0 m, 0.8 m]}").and_then(|node| Placement::read(&node));
    let mut are_right = first.is_some();
    for (index, name) in OFFSETS.iter().enumerate() {
        let Some(node) = map.get(name).filter(|_| *name != "G54") else { continue };
        let (Some(frame), Some(first)) = (Placement::read(&node), first) else {
            are_right = false;
            continue;
        };
        let turn = rotation(&first).inverse();
        if (turn.matrix() * rotation(&frame).matrix() - Matrix3::identity()).amax() > PARALLEL {
            let help = "give both the same `rpy`; a workpiece that stands otherwise is another cell";
            node.error(format!("{name} is turned against G54, and a program has its axes along one frame"), help);
            are_right = false;
        }
        offsets[index] = Some(turn * (Vector3::from(frame.xyz) - Vector3::from(first.xyz)));
    }
    are_right.then_some(Work { place: first?, offsets })
}

fn stock(node: &Node<'_>) -> Option<[Vector3<f64>; 2]> {
    let map = node.map(&STOCK)?;
    let corner = |field: &str, example: &str| {
        map.require(field, example).and_then(|node| node.quantities::<3>(Dimension::Length)).map(Vector3::from)
    };
    let (from, to) = (corner("from", "from: [0 mm, 0 mm, -40 mm]"), corner("to", "to: [200 mm, 100 mm, 0 mm]"));
    let (from, to) = (from?, to?);
    if let Some(axis) = (0..3).find(|axis| from[*axis] >= to[*axis]) {
        let axis = ["x", "y", "z"][axis];
        node.error(format!("along {axis} the stock ends before it begins"), "`from` is the lower corner on all axes");
        return None;
    }
    Some([from, to])
}

fn joint_speeds(node: &Node<'_>, robot: Option<&Description>) -> Option<Vec<f64>> {
    let items = node.sequence()?;
    // What is wrong with the robot is reported there; without it nobody knows which joints slide.
    let Some(robot) = robot else { return Some(Vec::new()) };
    if robot.joints.len() != items.len() {
        let joints = count(robot.joints.len(), "joint");
        let help = "give one for each joint, e.g. `110 deg/s`";
        node.error(format!("{} has {joints}, not {}", robot.name, items.len()), help);
        return None;
    }
    let speed = |(item, joint): (&Node<'_>, &Joint)| {
        item.positive(match joint.kind {
            JointKind::Revolute => Dimension::RotationalSpeed,
            JointKind::Prismatic => Dimension::Speed,
        })
    };
    let speeds: Vec<Option<f64>> = items.iter().zip(&robot.joints).map(speed).collect();
    speeds.into_iter().collect()
}

fn program(node: &Node<'_>) -> Option<Program> {
    let map = node.map(&PROGRAM)?;
    let machine = optional(&map, "machine", |node| {
        Machine::parse(node.text()?).map_err(|help| node.error("these are no rotary axes", help)).ok()
    });
    let center = optional(&map, "center", |node| node.quantities::<3>(Dimension::Length))
        .map(|center| center.map(Vector3::from));
    let pivot_length = optional(&map, "pivot_length", |node| node.positive(Dimension::Length));
    let tcp = optional(&map, "tcp", |node| node.choice(&[("on", true), ("off", false)]));
    let arc_tolerance = optional(&map, "arc_tolerance", |node| node.positive(Dimension::Length));
    let mut are_right = true;
    for field in ["center", "pivot_length", "tcp"] {
        if let Some(node) = map.get(field).filter(|_| map.get("machine").is_none()) {
            node.error(format!("`{field}` is that of a machine"), "add its rotary axes, e.g. `machine: table A C`");
            are_right = false;
        }
    }
    let (center, pivot_length) = (center?, pivot_length?);
    let machine = machine?.map(|machine| Machine { center, pivot_length, ..machine });
    are_right.then_some(Program { machine, tcp: tcp?, arc_tolerance: arc_tolerance? })
}
