//! Reading a list of recorded forces with the cut of each.

use std::path::{Path, PathBuf};

use nalgebra::{Matrix3, Vector3};
use robstiff_robots::ReadError;
use robstiff_robots::document::{Document, Map, Node};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::table::text_of;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};

use super::{Coefficients, Cut, ForceFrame, MeasuredForce, file};

/// The fields of a list of records; all but the first five a record may have itself.
pub const FIELDS: [&str; 14] = [
    "name",
    "on",
    "axes",
    "records",
    "source",
    "tool",
    "milling",
    "width",
    "engagement",
    "depth",
    "feed",
    "feed_speed",
    "speed",
    "file",
];

/// Those of the list alone.
const OF_ALL: usize = 5;

/// A force that was recorded in a cut whose conditions are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// The record's file.
    pub path: PathBuf,
    /// The cut; its coefficients, which are to be found, are zero.
    pub cut: Cut,
    /// The force on the tool along feed, normal and axis of the cut.
    pub force: MeasuredForce,
}

/// Records of one material and tool.
#[derive(Clone, Debug, PartialEq)]
pub struct Records {
    /// What the file calls itself.
    pub name: String,
    /// Who measured, with what.
    pub source: String,
    /// The records, in the file's order.
    pub records: Vec<Recorded>,
    /// What the readers noticed without refusing the files.
    pub warnings: Vec<String>,
}

/// What the list says of a record.
struct Said {
    path: PathBuf,
    cut: Cut,
}

/// The list, as it is read before its records.
struct List {
    name: String,
    source: String,
    axes: Axes,
    /// The line of axes that are those of no right-handed dynamometer.
    mirrored: Option<usize>,
    said: Vec<Said>,
}

/// Which column is along feed, normal and axis, and its sign on the tool.
type Axes = [(usize, f64); 3];

impl Records {
    /// Reads a list of records, and the records.
    ///
    /// # Errors
    /// A file that cannot be read; everything that is wrong with the first file that has
    /// problems, each problem at its place.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let text = text::read(path, MOST_OF_DOCUMENT)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let file = path.display().to_string();
        let document = Document::parse(&file, &text).map_err(ReadError::Invalid)?;
        let list = list(&document, folder);
        let List { name, source, axes, mirrored, said } = document.finish(list).map_err(ReadError::Invalid)?;
        let mirrored = mirrored.map(|line| {
            format!(
                "{file}:{line}: feed, normal and axis are mirrored, if the axes of the dynamometer are right-handed: the \
                 normal is feed x axis, so that one of the signs may be wrong"
            )
        });
        let mut records = Self { name, source, records: Vec::new(), warnings: mirrored.into_iter().collect() };
        for Said { path, cut } in said {
            let text = text_of(&path)?;
            let parsed = MeasuredForce::parse(&path.display().to_string(), &text, ForceFrame::Cut, false);
            let (mut force, warnings) = parsed.map_err(ReadError::Invalid)?;
            for sample in &mut force.samples {
                let read = sample.force;
                sample.force = Vector3::from(axes.map(|(column, sign)| sign * read[column]));
            }
            records.warnings.extend(warnings);
            records.records.push(Recorded { path, cut, force });
        }
        Ok(records)
    }
}

fn list(document: &Document, folder: &Path) -> Option<List> {
    let map = document.root().map(&FIELDS[..FIELDS.len() - 1])?;
    let text = |field: &str| map.get(field).map_or(Some(String::new()), |node| node.text().map(str::to_owned));
    let (name, source) = (text("name"), text("source"));
    let on_workpiece =
        map.require("on", "on: workpiece").and_then(|node| node.choice(&[("tool", 1.0), ("workpiece", -1.0)]));
    let axes: Option<Axes> = map.get("axes").map_or(Some([(0, 1.0), (1, 1.0), (2, 1.0)]), |node| axes(&node));
    // Columns that are along the cut's own axes may have been turned before.
    let mirrored = map.get("axes").filter(|_| axes.is_some_and(|axes| is_right_handed(&axes))).map(|node| node.line());
    let list = map.require("records", "records: [{file: slot-1.csv, feed: 0.05 mm/tooth}, ..]")?;
    let records: Vec<Option<Said>> = list.sequence()?.iter().map(|node| record(&map, node, folder)).collect();
    if records.is_empty() {
        list.error("there are no records", "one at least for each feed: `- {file: slot-1.csv, feed: 0.05 mm/tooth}`");
        return None;
    }
    let records: Option<Vec<Said>> = records.into_iter().collect();
    let sign = on_workpiece?;
    let axes = axes?.map(|(column, along)| (column, sign * along));
    Some(List { name: name?, source: source?, axes, mirrored, said: records? })
}

/// Whether three axes are as those of a dynamometer are; those of a cut are left-handed.
fn is_right_handed(axes: &Axes) -> bool {
    let columns = axes.map(|(column, sign)| {
        let mut vector = Vector3::zeros();
        vector[column] = sign;
        vector
    });
    Matrix3::from_columns(&columns).determinant() > 0.0
}

/// `{feed: Fy, normal: Fx, axis: Fz}`.
fn axes(node: &Node<'_>) -> Option<Axes> {
    let map = node.map(&["feed", "normal", "axis"])?;
    let words = [("Fx", (0, 1.0)), ("Fy", (1, 1.0)), ("Fz", (2, 1.0))];
    let turned = [("-Fx", (0, -1.0)), ("-Fy", (1, -1.0)), ("-Fz", (2, -1.0))];
    let words = [words, turned].concat();
    let along = |name: &str| map.require(name, &format!("{name}: Fx")).and_then(|node| node.choice(&words));
    let [feed, normal, axis] = ["feed", "normal", "axis"].map(along);
    let axes: Axes = [feed?, normal?, axis?];
    let mut columns = axes.map(|(column, _)| column);
    columns.sort_unstable();
    if columns != [0, 1, 2] {
        node.error("a column is along two axes", "each of Fx, Fy and Fz once, e.g. `{feed: Fy, normal: Fx, axis: Fz}`");
        return None;
    }
    Some(axes)
}

fn record(all: &Map<'_>, node: &Node<'_>, folder: &Path) -> Option<Said> {
    let own = node.map(&FIELDS[OF_ALL..])?;
    // What a record does not say holds for all; what is missing is missed in the record.
    let of = |fields: &[&str]| {
        let said = |map: &Map<'_>| fields.iter().any(|field| map.get(field).is_some());
        if !said(&own) && said(all) { all } else { &own }
    };
    let path = own.require("file", "file: slot-1.csv").and_then(|node| {
        let path = folder.join(node.text()?);
        if !path.is_file() {
            node.error(format!("there is no file {}", path.display()), "write the path from the folder of this file");
            return None;
        }
        Some(path)
    });
    let mill = of(&["tool"])
        .require("tool", "tool: {diameter: 16 mm, teeth: 3, helix: 30 deg}")
        .and_then(|node| file::mill(&node));
    let diameter = mill.as_ref().map(|mill| mill.diameter);
    let engagement = file::engagement(of(&["milling", "width", "engagement"]), diameter);
    let depth = file::depth(of(&["depth"]), diameter);
    let speed = of(&["speed"]).get("speed");
    let speed = speed.map_or(Some(None), |node| node.positive(Dimension::RotationalSpeed).map(Some));
    let feed = file::feed(of(&["feed", "feed_speed"]), mill.as_ref(), speed);
    let cut = Cut {
        mill: mill?,
        coefficients: Coefficients::default(),
        engagement: engagement?,
        depth: depth?,
        feed_per_tooth: feed?,
        speed: speed?,
    };
    Some(Said { path: path?, cut })
}
