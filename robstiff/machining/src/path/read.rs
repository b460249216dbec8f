//! Reading a tool path: a CSV file with a point a row.

use std::path::Path;

use nalgebra::{Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::text::Lines;
use robstiff_robots::{Description, Diagnostics, ReadError};

use super::{Goal, Target, ToolPath, Waypoint};
use robstiff::JointKind;
use robstiff_robots::table::{Numbers, Record, Table, text_of};

/// A unit quaternion is rounded by less than this.
const ROUNDED: f64 = 1e-3;

/// Lengths beyond this (m) without a unit are probably in mm.
const FAR: f64 = 20.0;

/// Angles beyond this (rad) without a unit are probably in degrees.
const TWO_TURNS: f64 = 4.0 * core::f64::consts::PI;

/// Feeds beyond this (m/s) without a unit are probably in mm/min.
const FASTEST: f64 = 10.0;

/// Widths and depths of a cut beyond this (m) without a unit are probably in mm.
const WIDEST: f64 = 0.5;

/// Columns that a path may have beside it, as `robstiff path` writes them.
const BESIDE: [&str; 16] = [
    "Fx",
    "Fy",
    "Fz",
    "Mx",
    "My",
    "Mz",
    "deviation",
    "along",
    "normal",
    "axial",
    "error",
    "peak",
    "dx",
    "dy",
    "dz",
    "remaining",
];

/// What the file gives, by columns.
enum Columns {
    Joints(Vec<Numbers>),
    Poses([Numbers; 3], Orientations),
}

/// How the file gives orientations.
enum Orientations {
    /// `qw qx qy qz`.
    Quaternion([Numbers; 4]),
    /// `rx ry rz`.
    RotationVector([Numbers; 3]),
    /// `a b c`: turns about z, the new y and the new x.
    Angles([Numbers; 3]),
    /// `ux uy uz`.
    Axis([Numbers; 3]),
}

const ORIENTATION_HELP: &str = "give `qw,qx,qy,qz`, a rotation vector `rx [deg],ry [deg],rz [deg]`, \
     angles `a [deg],b [deg],c [deg]` about z, y, x, or the tool's axis `ux,uy,uz`";

impl ToolPath {
    /// Reads the tool path of a robot. `tool` is the axis in the TCP's frame
    /// that the columns `ux uy uz` give the direction of.
    ///
    /// # Errors
    /// A file that cannot be read; everything that is wrong with it, each
    /// problem at its place.
    pub fn read(path: impl AsRef<Path>, robot: &Description, tool: Unit<Vector3<f64>>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        Self::parse(&path.display().to_string(), &text_of(path)?, robot, tool).map_err(ReadError::Invalid)
    }

    /// Reads the tool path of a robot from a text; `file` is the name that
    /// problems show.
    ///
    /// # Errors
    /// Everything that is wrong with it, each problem at its place.
    pub fn parse(file: &str, text: &str, robot: &Description, tool: Unit<Vector3<f64>>) -> Result<Self, Diagnostics> {
        let table = Table::parse(file, text)?;
        let feed = table.numbers("feed", Dimension::Speed);
        let s = table.numbers("s", Dimension::Length);
        let rapid = table.numbers("rapid", Dimension::Number);
        let number = table.numbers("tool", Dimension::Number);
        let cut = ["ae", "ap"].map(|name| table.numbers(name, Dimension::Length));
        let columns = columns(&table, robot);
        for name in BESIDE {
            table.position(name);
        }
        let points = columns.and_then(|columns| {
            check_units(&table, &columns, robot);
            s.iter().for_each(|&column| LENGTHS.check(&table, column));
            feed.iter().for_each(|&column| FEEDS.check(&table, column));
            cut.iter().flatten().for_each(|&column| CUTS.check(&table, column));
            let mut last_s = f64::NEG_INFINITY;
            let rows = table.records.iter().map(|record| {
                let goal = goal(&table, record, &columns, tool);
                // A file with rapids has rows without a feed.
                let feed = feed.filter(|column| rapid.is_none() || !table.is_empty(record, *column));
                let feed = feed.map(|column| positive(&table, record, column));
                let s = s.map(|column| not_back(&table, record, column, &mut last_s));
                let rapid = rapid.map(|column| table.number(record, column));
                let filled = |column: Option<Numbers>| column.filter(|column| !table.is_empty(record, *column));
                let number = filled(number).map(|column| tool_number(&table, record, column));
                let [width, depth] = cut.map(|column| filled(column).map(|column| section(&table, record, column)));
                let is_wrong = [feed, s, rapid, width, depth].contains(&Some(None)) || number == Some(None);
                if is_wrong {
                    return None;
                }
                let rapid = rapid.flatten().is_some_and(|rapid| rapid != 0.0);
                let (feed, s, tool) = (feed.flatten(), s.flatten(), number.flatten());
                let (line, spindle, width, depth) = (record.line, None, width.flatten(), depth.flatten());
                Some(Waypoint { line, goal: goal?, feed, s, rapid, spindle, tool, width, depth })
            });
            // Every row is checked before any gives the file up.
            rows.collect::<Vec<_>>().into_iter().collect::<Option<Vec<_>>>()
        });
        if let Some(warning) = points.as_deref().and_then(shorter_than_straight) {
            table.warn(&warning);
        }
        let (points, warnings) = table.finish(points)?;
        let is_program = false;
        Ok(Self { file: file.to_owned(), points, warnings, is_program, tool, lines: Lines::new(text.to_owned()) })
    }

    /// A line of the file (from 1); empty where there is no such line.
    pub fn line(&self, line: usize) -> &str {
        self.lines.line(line)
    }
}

fn columns(table: &Table<'_>, robot: &Description) -> Option<Columns> {
    let dimension = |kind| if kind == JointKind::Revolute { Dimension::Angle } else { Dimension::Length };
    if table.position("q1").is_some() {
        let columns: Vec<Option<Numbers>> = (1..)
            .zip(&robot.joints)
            .map(|(number, joint)| table.require(&format!("q{number}"), dimension(joint.kind)))
            .collect();
        if table.position("x").is_some() {
            table.warn("the joint coordinates are used, not the poses");
            // Each is known, and none is said to be unused.
            table.ask_for(&["y", "z", "qw", "qx", "qy", "qz", "rx", "ry", "rz", "a", "b", "c", "ux", "uy", "uz"]);
        }
        if table.position("remaining").is_some() {
            table.warn("the path is corrected already: its points are what to command, not where the tool is to be");
        }
        return columns.into_iter().collect::<Option<Vec<_>>>().map(Columns::Joints);
    }
    let all = |names: [&str; 3], dimension| three(names.map(|name| table.require(name, dimension)));
    let position = all(["x", "y", "z"], Dimension::Length);
    let has = |name: &str| table.position(name).is_some();
    let given: Vec<&str> = ["qw", "rx", "a", "ux"].into_iter().filter(|name| has(name)).collect();
    let orientation = match given.as_slice() {
        ["qw"] => {
            let rest = all(["qx", "qy", "qz"], Dimension::Number);
            let w = table.require("qw", Dimension::Number);
            w.zip(rest).map(|(w, [x, y, z])| Orientations::Quaternion([w, x, y, z]))
        }
        ["rx"] => all(["rx", "ry", "rz"], Dimension::Angle).map(Orientations::RotationVector),
        ["a"] => all(["a", "b", "c"], Dimension::Angle).map(Orientations::Angles),
        ["ux"] => all(["ux", "uy", "uz"], Dimension::Number).map(Orientations::Axis),
        [] => {
            table.report_header("the orientation of the tool is missing", ORIENTATION_HELP);
            None
        }
        several => {
            let several = several.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" and ");
            table.report_header(&format!("the orientation is given twice, by {several}"), "keep one of them");
            None
        }
    };
    Some(Columns::Poses(position?, orientation?))
}

fn three(columns: [Option<Numbers>; 3]) -> Option<[Numbers; 3]> {
    let [x, y, z] = columns;
    Some([x?, y?, z?])
}

fn goal(table: &Table<'_>, record: &Record, columns: &Columns, tool: Unit<Vector3<f64>>) -> Option<Goal> {
    let (position, orientation) = match columns {
        Columns::Joints(columns) => {
            let q: Vec<Option<f64>> = columns.iter().map(|&column| table.number(record, column)).collect();
            return q.into_iter().collect::<Option<Vec<f64>>>().map(Goal::Joints);
        }
        Columns::Poses(position, orientation) => (table.all(record, *position), orientation),
    };
    let full = |rotation| super::Orientation::Full(rotation);
    let orientation = match orientation {
        Orientations::Quaternion(columns) => {
            let [w, x, y, z] = table.all(record, *columns)?;
            let quaternion = Quaternion::new(w, x, y, z);
            if (quaternion.norm() - 1.0).abs() > ROUNDED {
                let message = format!("the quaternion's length is {:.4}, not 1", quaternion.norm());
                table.report_number(
                    record,
                    columns[0],
                    &message,
                    "a turn is a quaternion of length 1, `qw` its scalar",
                );
                return None;
            }
            full(UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix())
        }
        Orientations::RotationVector(columns) => full(Rotation3::new(Vector3::from(table.all(record, *columns)?))),
        Orientations::Angles(columns) => {
            let [a, b, c] = table.all(record, *columns)?;
            full(Rotation3::from_euler_angles(c, b, a))
        }
        Orientations::Axis(columns) => {
            let direction = Vector3::from(table.all(record, *columns)?);
            let Some(direction) = Unit::try_new(direction, 1e-9) else {
                table.report_number(
                    record,
                    columns[0],
                    "the tool's axis has no direction",
                    "give a vector along it, e.g. `0,0,-1` for a tool that points down",
                );
                return None;
            };
            super::Orientation::Axis { tool, direction }
        }
    };
    Some(Goal::Tool(Target { position: Vector3::from(position?), orientation }))
}

fn positive(table: &Table<'_>, record: &Record, column: Numbers) -> Option<f64> {
    let feed = table.number(record, column)?;
    if feed > 0.0 {
        return Some(feed);
    }
    table.report_number(
        record,
        column,
        "the feed is not positive",
        "how fast the tool moves, e.g. `feed [mm/min]`: `1200`",
    );
    None
}

/// The width or the depth of a cut.
fn section(table: &Table<'_>, record: &Record, column: Numbers) -> Option<f64> {
    let section = table.number(record, column)?;
    if section >= 0.0 {
        return Some(section);
    }
    let message = format!("`{}` is negative", table.name_of(column));
    let help =
        "`ae` is the radial width of the cut and `ap` its axial depth; 0 in the air, empty for that of the cut's file";
    table.report_number(record, column, &message, help);
    None
}

/// The number of a tool.
fn tool_number(table: &Table<'_>, record: &Record, column: Numbers) -> Option<u32> {
    let written = table.number(record, column)?;
    if written >= 0.0 && written.fract() == 0.0 && written <= f64::from(u32::MAX) {
        return Some(written as u32);
    }
    table.report_number(record, column, "a tool has a whole number", "that of the tool's table, e.g. `2`");
    None
}

fn not_back(table: &Table<'_>, record: &Record, column: Numbers, last: &mut f64) -> Option<f64> {
    let s = table.number(record, column)?;
    if s < *last {
        table.report_number(
            record,
            column,
            "the arc length is shorter than in the row before",
            "`s` is the length of the path so far; leave the column out to have it computed",
        );
        return None;
    }
    *last = s;
    Some(s)
}

/// What to warn of where the arc length grows by less than points are apart, as in another unit: no
/// path is shorter than the straight line.
fn shorter_than_straight(points: &[Waypoint]) -> Option<String> {
    let place = |point: &Waypoint| match &point.goal {
        Goal::Tool(target) => Some((point.line, point.s?, target.position)),
        Goal::Joints(_) => None,
    };
    points.windows(2).find_map(|pair| {
        let [(_, before, from), (line, s, to)] = [place(&pair[0])?, place(&pair[1])?];
        let (grown, apart) = (s - before, (to - from).norm());
        (grown < apart * (1.0 - SHORTER) - NO_LENGTH).then(|| {
            format!(
                "the arc length `s` grows by {:.6} mm on line {line}, and the points are {:.6} mm apart: is it in another \
                 unit? left out, it is computed",
                1e3 * grown,
                1e3 * apart
            )
        })
    })
}

/// An arc length is shorter than the straight line by this share, or by this much (m), for rounding.
const SHORTER: f64 = 1e-2;
const NO_LENGTH: f64 = 1e-5;

/// What numbers without a unit look like that are beyond some limit in SI.
pub struct Bare {
    limit: f64,
    what: &'static str,
    unit: &'static str,
}

/// Lengths in mm, not in m.
pub const LENGTHS: Bare = Bare { limit: FAR, what: "lengths in millimetres", unit: "mm" };

/// Angles in degrees, not in rad.
const ANGLES: Bare = Bare { limit: TWO_TURNS, what: "angles in degrees", unit: "deg" };

/// Widths and depths of cuts in mm, not in m.
const CUTS: Bare = Bare { limit: WIDEST, what: "widths or depths in millimetres", unit: "mm" };

/// Feeds in mm/min, not in m/s.
const FEEDS: Bare = Bare { limit: FASTEST, what: "feeds in millimetres a minute", unit: "mm/min" };

impl Bare {
    /// Warns of a column that looks like it.
    pub fn check(&self, table: &Table<'_>, column: Numbers) {
        if table.has_unit(column) {
            return;
        }
        let far = |record: &&Record| table.peek(record, column).is_some_and(|value| value.abs() > self.limit);
        if let Some(record) = table.records.iter().find(far) {
            let (name, Self { what, unit, .. }) = (table.name_of(column), self);
            table.warn(&format!(
                "{name} has no unit and is far out on line {}: are the {what}? write `{name} [{unit}]`",
                record.line
            ));
        }
    }
}

/// Warns of numbers without a unit that look like mm or degrees.
fn check_units(table: &Table<'_>, columns: &Columns, robot: &Description) {
    match columns {
        Columns::Joints(columns) => {
            for (&column, joint) in columns.iter().zip(&robot.joints) {
                if joint.kind == JointKind::Prismatic { LENGTHS } else { ANGLES }.check(table, column);
            }
        }
        Columns::Poses(position, orientation) => {
            position.iter().for_each(|&column| LENGTHS.check(table, column));
            if let Orientations::RotationVector(columns) | Orientations::Angles(columns) = orientation {
                columns.iter().for_each(|&column| ANGLES.check(table, column));
            }
        }
    }
}
