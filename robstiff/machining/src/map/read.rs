//! Reading what to map.

use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3, Vector6};
use robstiff_robots::document::{Document, Map, Node};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::words::count;
use robstiff_robots::{Description, Diagnostics, Joint, JointKind, Placement};

use super::{Axis, Measure, Tool};

/// The fields of a map file.
pub const FIELDS: [&str; 6] = ["joints", "positions", "tool", "force", "moment", "measure"];

/// Values of an axis: more than any map has, and less than what fills a memory.
pub const MOST: i64 = 1_000_000;

/// Poses of a map: as many rows as readers hold that number them with 32 bits; as CSV
/// they would fill hundreds of gigabytes.
pub const MOST_POSES: u32 = u32::MAX;

/// What a map file asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// The space.
    pub over: Over,
    /// What is computed of each cell.
    pub measure: Measure,
}

/// The space of a map file.
#[derive(Clone, Debug, PartialEq)]
pub enum Over {
    /// Joint coordinates, an axis each.
    Joints(Vec<Axis>),
    /// Positions of the TCP.
    Positions(Box<Positions>),
}

impl Over {
    /// Its axes.
    pub fn axes(&self) -> &[Axis] {
        match self {
            Self::Joints(axes) => axes,
            Self::Positions(positions) => &positions.axes,
        }
    }
}

/// Positions of the TCP, and how the tool stands there.
#[derive(Clone, Debug, PartialEq)]
pub struct Positions {
    /// Where they are counted from, in the base frame.
    pub frame: Isometry3<f64>,
    /// x, y and z (m), in that frame.
    pub axes: [Axis; 3],
    /// How the tool stands there.
    pub tool: Tool,
}

impl Task {
    /// Reads a map file for a robot; `file` is the name that problems show.
    ///
    /// # Errors
    /// All that is wrong with the text, each problem with its place.
    pub fn parse(file: &str, text: &str, robot: &Description) -> Result<Self, Diagnostics> {
        let document = Document::parse(file, text)?;
        let task = task(&document, robot);
        document.finish(task)
    }
}

fn task(document: &Document, robot: &Description) -> Option<Task> {
    let map = document.root().map(&FIELDS)?;
    // Everything is read before anything is given up, to report all problems.
    let measure = measure(&map);
    let over = match (map.get("joints"), map.get("positions")) {
        (Some(node), None) => {
            if let Some(tool) = map.get("tool") {
                tool.error("joint coordinates say how the tool stands", "leave `tool` out, or give `positions`");
            }
            joints(&node, robot).filter(|axes| can_be_meant(&node, axes, 1)).map(Over::Joints)
        }
        (None, Some(node)) => {
            let (grid, tool) = (grid(&node), map.require("tool", "tool: {direction: [0, 0, -1]}"));
            let tool = tool.and_then(|node| self::tool(&node));
            grid.zip(tool)
                .filter(|((_, axes), tool)| can_be_meant(&node, axes, tool.turns.len().max(1)))
                .map(|((frame, axes), tool)| Over::Positions(Box::new(Positions { frame, axes, tool })))
        }
        (Some(_), Some(node)) => {
            node.error("a map is over joints or over positions, not both", "keep one of the two");
            None
        }
        (None, None) => {
            map.node().error(
                "what the map is over is missing",
                "give `joints`, one value or `{from, to, count}` each, or `positions: {x: .., y: .., z: ..}`",
            );
            None
        }
    };
    Some(Task { over: over?, measure: measure? })
}

/// Whether the cells of these axes, with so many turns each, are no more than anybody
/// can use.
fn can_be_meant(node: &Node<'_>, axes: &[Axis], turns: usize) -> bool {
    let counts = axes.iter().map(|axis| axis.values.len()).chain([turns]).filter(|&count| count > 1);
    let counts: Vec<usize> = counts.collect();
    // The product may be beyond any integer.
    let poses: f64 = counts.iter().map(|&count| count as f64).product();
    let most = f64::from(MOST_POSES);
    if poses > most {
        let counts: Vec<String> = counts.iter().map(|count| format!("{count}")).collect();
        let smaller = (most / poses).powf(1.0 / counts.len() as f64);
        node.error(
            format!("{} = {poses:.1e} poses are more than the {most:.1e} that a map may have", counts.join(" x ")),
            format!("divide each `count` by {:.0} or more", (1.0 / smaller).ceil().max(2.0)),
        );
    }
    poses <= most
}

#[derive(Clone, Copy)]
enum Kind {
    Deviation,
    Stiffness,
    Compliance,
}

fn measure(map: &Map<'_>) -> Option<Measure> {
    let words = [("deviation", Kind::Deviation), ("stiffness", Kind::Stiffness), ("compliance", Kind::Compliance)];
    let (force, moment) = (map.get("force"), map.get("moment"));
    let asked = match map.get("measure") {
        Some(node) => node.choice(&words)?,
        None if force.is_some() || moment.is_some() => Kind::Deviation,
        None => Kind::Stiffness,
    };
    if !matches!(asked, Kind::Deviation) {
        if let Some(load) = force.or(moment) {
            load.error("a stiffness has no load", "leave it out, or write `measure: deviation`");
            return None;
        }
        return Some(if matches!(asked, Kind::Stiffness) { Measure::Stiffness } else { Measure::Compliance });
    }
    if force.is_none() && moment.is_none() {
        map.node().error("a deviation is that under a force", "e.g. `force: [0, 400 N, -200 N]`, or `force: 500 N`");
        return None;
    }
    if let Some(force) = force.as_ref().filter(|force| !force.is_sequence()) {
        if let Some(moment) = moment {
            moment.error("a force of any direction comes without a moment", "give the force as `[x, y, z]`");
        }
        return force.positive(Dimension::Force).map(Measure::AnyDirection);
    }
    let of = |load: Option<Node<'_>>, dimension| load.map_or(Some([0.0; 3]), |node| node.quantities::<3>(dimension));
    let (force, moment) = (of(force, Dimension::Force), of(moment, Dimension::Torque));
    let ([fx, fy, fz], [mx, my, mz]) = (force?, moment?);
    Some(Measure::Deviation(Vector6::new(fx, fy, fz, mx, my, mz)))
}

fn joints(node: &Node<'_>, robot: &Description) -> Option<Vec<Axis>> {
    let items = node.sequence()?;
    if items.len() != robot.joints.len() {
        let message = format!("this gives {} for {}", count(items.len(), "item"), count(robot.joints.len(), "joint"));
        node.error(message, "give a value or `{from, to, count}` for each joint");
        return None;
    }
    let axes: Vec<Option<Axis>> = (1..)
        .zip(items.iter().zip(&robot.joints))
        .map(|(number, (item, joint))| {
            let dimension = match joint.kind {
                JointKind::Revolute => Dimension::Angle,
                JointKind::Prismatic => Dimension::Length,
            };
            let axis = axis(item, format!("q{number}"), dimension)?;
            within_limits(item, joint, &axis).then_some(axis)
        })
        .collect();
    axes.into_iter().collect()
}

fn within_limits(node: &Node<'_>, joint: &Joint, axis: &Axis) -> bool {
    let outside = axis.values.iter().find(|&&q| !joint.reaches(q));
    if let Some((what, &q)) = joint.outside_limits().zip(outside) {
        node.error(
            format!("{} {} is {what}", joint.for_people(q), joint.people_unit()),
            "the limits are those of the robot's description",
        );
        return false;
    }
    true
}

/// Where positions are counted from, and their axes.
fn grid(node: &Node<'_>) -> Option<(Isometry3<f64>, [Axis; 3])> {
    let map = node.map(&["frame", "x", "y", "z"])?;
    let frame = map.get("frame").map_or(Some(Isometry3::identity()), |node| frame(&node));
    let [x, y, z] = ["x", "y", "z"].map(|name| {
        let example = format!("{name}: 800 mm`, or `{name}: {{from: 1200 mm, to: 2000 mm, count: 81}}");
        map.require(name, &example).and_then(|node| axis(&node, name.into(), Dimension::Length))
    });
    Some((frame?, [x?, y?, z?]))
}

/// A frame in the base frame.
fn frame(node: &Node<'_>) -> Option<Isometry3<f64>> {
    let Placement { xyz: [x, y, z], rpy: [roll, pitch, yaw] } = Placement::read(node)?;
    Some(Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_euler_angles(roll, pitch, yaw)))
}

fn tool(node: &Node<'_>) -> Option<Tool> {
    let map = node.map(&["axis", "direction", "turn"])?;
    let [x, y, z] = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
    let axes = [("x", x), ("y", y), ("z", z), ("-x", -x), ("-y", -y), ("-z", -z)];
    let axis = map.get("axis").map_or(Some(z), |node| node.choice(&axes));
    let direction = map.require("direction", "direction: [0, 0, -1]").and_then(|node| {
        let direction = Unit::try_new(Vector3::from(node.quantities::<3>(Dimension::Number)?), 0.0);
        if direction.is_none() {
            node.error("this is no direction", "e.g. `[0, 0, -1]`, of any length but zero");
        }
        direction
    });
    let turn = map.get("turn").map_or(Some(None), |node| self::axis(&node, "turn".into(), Dimension::Angle).map(Some));
    Some(Tool { axis: axis?, direction: direction?, turns: turn?.map_or_else(Vec::new, |turn| turn.values) })
}

/// A value, or `{from, to, count}`.
fn axis(node: &Node<'_>, name: String, dimension: Dimension) -> Option<Axis> {
    if !node.is_map() {
        let value = node.quantity(dimension)?;
        return Some(Axis { name, dimension, values: std::vec![value] });
    }
    let map = node.map(&["from", "to", "count"])?;
    let end = |field: &str, example: &str| map.require(field, example).and_then(|node| node.quantity(dimension));
    let examples = if dimension == Dimension::Angle { ["-60 deg", "60 deg"] } else { ["1200 mm", "2000 mm"] };
    let (from, to) = (end("from", &format!("from: {}", examples[0])), end("to", &format!("to: {}", examples[1])));
    let count = map.require("count", "count: 50").and_then(|node| {
        let count = node.integer(50)?;
        if !(2..=MOST).contains(&count) {
            node.error(format!("a number from 2 to {MOST} is expected here, not {count}"), "e.g. `50`");
            return None;
        }
        usize::try_from(count).ok()
    });
    let (from, to, count) = (from?, to?, count?);
    if from >= to {
        let help = if from > to { "swap the two" } else { "a single value is written without `from` and `to`" };
        node.error("`from` is not below `to`", help);
        return None;
    }
    Some(Axis::between(&name, dimension, from, to, count))
}
