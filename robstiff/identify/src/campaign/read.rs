//! Reading a campaign: the YAML file that says what was measured.

use std::borrow::ToOwned;
use std::format;
use std::path::Path;
use std::string::{String, ToString};
use std::vec::Vec;

use robstiff_robots::document::{Document, Map, Node};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};
use robstiff_robots::{Description, JointKind, ReadError, catalogue};

use super::beyond::{told_angle, told_length};
use super::renamed::{self, Renamed, renamed};
use super::{Campaign, Data, Frame, Holdout, Noise, clamped, displacements, positions};
use robstiff_robots::table::{Table, text_of_sheet};

/// The fields of a campaign file.
pub const FIELDS: [&str; 12] = [
    "name",
    "date",
    "operator",
    "robot",
    "observations",
    "sheet",
    "kind",
    "columns",
    "wrench",
    "measured",
    "noise",
    "holdout",
];

/// Of those, the ones that are about poses and the tool: clamped axes have neither.
const OF_POSES: [&str; 3] = ["wrench", "measured", "holdout"];

/// What they say of frames and rotations: a weight pulls downwards, a tracker reads
/// points in a frame of its own. That the frame is the base's goes without saying.
const OF_DISPLACEMENTS: [(&str, &str); 4] =
    [("wrench", "frame"), ("measured", "frame"), ("measured", "along"), ("noise", "rotation")];

/// Where displacements are read, in which frame, and of a single gauge along which direction.
type Measured = ((Frame, [f64; 3]), Option<[f64; 3]>);

/// What the observations are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Displacement,
    Position,
    Clamped,
}

/// What the YAML file says.
struct Plan {
    name: String,
    date: String,
    operator: String,
    robot: String,
    observations: String,
    /// The sheet of a spreadsheet.
    sheet: Option<String>,
    kind: Kind,
    columns: Vec<Renamed>,
    wrench: (Frame, [f64; 3]),
    measured: Measured,
    noise: Noise,
    holdout: Option<Holdout>,
    /// The fields that are not used, with their lines.
    unused: Vec<(&'static str, usize)>,
    /// What is said of noise that no instrument has.
    noisy: Vec<String>,
}

impl Campaign {
    /// Reads a campaign, its robot and its observations.
    ///
    /// # Errors
    /// A file that cannot be read; everything that is wrong with the first
    /// file that has problems (campaign, robot, observations), each problem at
    /// its place.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        let (file, said) = (path.display().to_string(), text::read(path, MOST_OF_DOCUMENT)?);
        let document = Document::parse(&file, &said).map_err(ReadError::Invalid)?;
        let plan = plan(&document, folder);
        let plan = document.finish(plan).map_err(ReadError::Invalid)?;

        let (robot, robot_path) = catalogue::read(folder, Path::new(&plan.robot))?;
        let observations_path = folder.join(&plan.observations);
        let (table_name, text) =
            (observations_path.display().to_string(), text_of_sheet(&observations_path, plan.sheet.as_deref())?);
        let mut table = Table::parse(&table_name, &text).map_err(ReadError::Invalid)?;
        renamed::take(&mut table, &plan.columns, (&file, &said)).map_err(ReadError::Invalid)?;
        table.take_joints(robot.joints.len());
        let data = match plan.kind {
            Kind::Displacement => {
                displacements::read(&table, &robot, plan.wrench, plan.measured).map(Data::Displacement)
            }
            Kind::Clamped => clamped::read(&table, &robot).map(Data::Clamped),
            Kind::Position => positions::read(&table, &robot, plan.wrench.1, plan.measured.0.1).map(Data::Position),
        };
        let (data, of_table) = table.finish(data).map_err(ReadError::Invalid)?;
        let unused = plan.unused.iter().map(|(field, line)| {
            let kind = if plan.kind == Kind::Clamped { "clamped" } else { "position" };
            format!("{}: `{field}` on line {line} is not used with `kind: {kind}`", path.display())
        });
        let noisy = plan.noisy.iter().map(|said| format!("{}: {said}", path.display()));
        let far = [("wrench", plan.wrench.1), ("measured", plan.measured.0.1)].into_iter().filter_map(|(field, at)| {
            let distance = at.iter().map(|value| value * value).sum::<f64>().sqrt();
            (distance > FAR_FROM_TCP && plan.kind != Kind::Clamped).then(|| {
                let file = path.display();
                format!("{file}: `{field}` is at {distance:.0} m from the TCP: is it in metres, or in millimetres?")
            })
        });
        let poses = data.poses().len();
        let kept = plan.holdout.map(|holdout| holdout.count(poses)).filter(|kept| 2 * kept > poses);
        let kept = kept.map(|kept| format!("{}: `holdout` keeps {kept} of {poses} poses from the fit", path.display()));
        let of_robot = robot.warnings();
        let of_robot = of_robot.iter().map(|said| format!("{}: {said}", robot_path.display()));
        let of_axes = of_other_axes(plan.noise, &data, &robot);
        let of_axes = of_axes.map(|said| format!("{}: {said}", path.display()));
        let warnings =
            of_robot.chain(far).chain(noisy).chain(unused).chain(kept).chain(of_axes).chain(of_table).collect();
        Ok(Self {
            name: plan.name,
            date: plan.date,
            operator: plan.operator,
            path: path.to_owned(),
            robot_path,
            observations_path,
            robot,
            data,
            noise: plan.noise,
            holdout: plan.holdout,
            held_out: Vec::new(),
            warnings,
        })
    }
}

/// Nothing on a tool is farther from the TCP (m).
const FAR_FROM_TCP: f64 = 5.0;

fn plan(document: &Document, folder: &Path) -> Option<Plan> {
    refuse_robot(document)?;
    let map = document.root().map(&FIELDS)?;
    let kinds = [("displacement", Kind::Displacement), ("position", Kind::Position), ("clamped", Kind::Clamped)];
    let text = |field: &str| match map.get(field) {
        Some(text) => text.text().map(ToOwned::to_owned),
        None => Some(String::new()),
    };
    let [name, date, operator] = ["name", "date", "operator"].map(text);
    let robot = file(&map, "robot", "robot: robot.yaml", folder);
    let observations = file(&map, "observations", "observations: loads.csv", folder);
    let sheet = map.get("sheet").map(|name| name.text().map(ToOwned::to_owned));
    let kind = map.require("kind", "kind: displacement").and_then(|node| node.choice(&kinds));
    let columns = renamed(&map);
    let wrench = place(&map, "wrench");
    let measured = measured(&map);
    let noise = noise(&map);
    let noisy = noise.map(|noise| noisy(&map, noise)).unwrap_or_default();
    let holdout = holdout(&map);
    let unused = kind.map(|kind| unused(&map, kind)).unwrap_or_default();
    Some(Plan {
        name: name?,
        date: date?,
        operator: operator?,
        robot: robot?,
        observations: observations?,
        sheet: sheet.map_or(Some(None), |name| name.map(Some))?,
        kind: kind?,
        columns: columns?,
        wrench: wrench?,
        measured: measured?,
        noise: noise?,
        holdout: holdout?,
        unused,
        noisy,
    })
}

/// `None` with the problem reported where the file is a robot's description.
fn refuse_robot(document: &Document) -> Option<()> {
    let root = document.root();
    let Some(map) = root.is_map().then(|| root.any_map("")).flatten() else { return Some(()) };
    let there = |field: &str| map.get(field).is_some();
    if there("joints") && !there("observations") && !there("robot") {
        root.error(
            "this is a robot's description, and no campaign",
            "give the campaign, a file with `robot:` and `observations:`; `robstiff start` makes one for a robot",
        );
        return None;
    }
    Some(())
}

/// The fields that are not used with a kind, with their lines.
fn unused(map: &Map<'_>, kind: Kind) -> Vec<(&'static str, usize)> {
    match kind {
        Kind::Displacement => Vec::new(),
        Kind::Clamped => OF_POSES.into_iter().filter_map(|field| Some((field, map.get(field)?.line()))).collect(),
        Kind::Position => {
            let inner = |(field, inner): (&str, &'static str)| {
                let said = map.get(field).filter(Node::is_map)?.any_map("")?.get(inner)?;
                (inner != "frame" || said.text() != Some("base")).then(|| (inner, said.line()))
            };
            OF_DISPLACEMENTS.into_iter().filter_map(inner).collect()
        }
    }
}

/// The noise that says nothing of clamped axes, for they turn, or for they slide.
fn of_other_axes(noise: Noise, data: &Data, robot: &Description) -> Option<String> {
    let Data::Clamped(rows) = data else { return None };
    let is = |kind: JointKind| rows.iter().all(|row| robot.joints[row.axis - 1].kind == kind);
    let (field, do_what) = match noise {
        Noise { displacement: Some(_), .. } if is(JointKind::Revolute) => ("displacement", "turn"),
        Noise { rotation: Some(_), .. } if is(JointKind::Prismatic) => ("rotation", "slide"),
        _ => return None,
    };
    Some(format!("`{field}` of the noise is not used with axes that {do_what}"))
}

/// A file that the campaign names, by its path from the campaign's folder.
fn file(map: &Map<'_>, field: &str, example: &str, folder: &Path) -> Option<String> {
    let node = map.require(field, example)?;
    let name = node.text()?;
    let path = folder.join(name);
    let is_of_catalogue = field == "robot" && catalogue::find(name).is_some();
    if !path.is_file() && !is_of_catalogue {
        let shown = path.display();
        let message = match (path.is_dir(), path.exists()) {
            (true, _) => format!("{shown} is a folder, and no file"),
            // A pipe or a device, which is read once and may never end.
            (false, true) => format!("{shown} is no regular file"),
            (false, false) => format!("there is no file {shown}"),
        };
        let mut help = "write the path from the folder of this campaign file".to_string();
        if field == "robot" {
            help += &format!(", or a robot of the catalogue: {}", catalogue::names());
        }
        node.error(message, help);
        return None;
    }
    Some(name.to_owned())
}

/// `{frame: base, at: tcp}`; left out, that is what it is.
pub fn place(map: &Map<'_>, field: &str) -> Option<(Frame, [f64; 3])> {
    let Some(node) = map.get(field) else { return Some((Frame::Base, [0.0; 3])) };
    frame_and_point(&node.map(&["frame", "at"])?)
}

/// The same with the direction of a single gauge: `{along: [0, 0, 1]}`, of any length.
fn measured(map: &Map<'_>) -> Option<Measured> {
    let Some(node) = map.get("measured") else { return Some(((Frame::Base, [0.0; 3]), None)) };
    let said = node.map(&["frame", "at", "along"])?;
    let place = frame_and_point(&said);
    let Some(along) = said.get("along") else { return Some((place?, None)) };
    let vector = along.quantities::<3>(Dimension::Number)?;
    let length = vector.iter().map(|value| value * value).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        along.error("this vector has no direction", "e.g. `along: [0, 0, 1]`");
        return None;
    }
    Some((place?, Some(vector.map(|value| value / length))))
}

fn frame_and_point(place: &Map<'_>) -> Option<(Frame, [f64; 3])> {
    let frame = match place.get("frame") {
        Some(frame) => frame.choice(&[("base", Frame::Base), ("tool", Frame::Tool)]),
        None => Some(Frame::Base),
    };
    let at = match place.get("at") {
        Some(at) if at.is_sequence() => at.quantities::<3>(Dimension::Length),
        Some(at) => at.choice(&[("tcp", [0.0; 3])]),
        None => Some([0.0; 3]),
    };
    Some((frame?, at?))
}

fn noise(map: &Map<'_>) -> Option<Noise> {
    let Some(node) = map.get("noise") else { return Some(Noise::default()) };
    let noise = node.map(&["displacement", "rotation"])?;
    let one = |field: &str, dimension| noise.get(field).map(|node| node.positive(dimension));
    let (displacement, rotation) = (one("displacement", Dimension::Length), one("rotation", Dimension::Angle));
    if displacement == Some(None) || rotation == Some(None) {
        return None;
    }
    Some(Noise { displacement: displacement.flatten(), rotation: rotation.flatten() })
}

/// No instrument for deflections is so noisy (m, rad).
pub const NOISIEST: f64 = 0.01;

/// What is said of declared noise that no instrument has, with its line: mostly of micrometres
/// that no unit is written with.
fn noisy(map: &Map<'_>, noise: Noise) -> Vec<String> {
    let line = |field: &str| Some(map.get("noise")?.any_map("")?.get(field)?.line());
    let one = |field: &str, value: Option<f64>, told: fn(f64) -> String, most: &str| {
        let (value, line) = (value.filter(|value| *value > NOISIEST)?, line(field)?);
        let value = told(value);
        Some(format!("`{field}` of the noise on line {line} is {value}, more than {most}: is its unit missing?"))
    };
    let displacement = one("displacement", noise.displacement, told_length, "10 mm");
    let rotation = one("rotation", noise.rotation, told_angle, "10 mrad");
    displacement.into_iter().chain(rotation).collect()
}

#[allow(clippy::option_option, reason = "the outer one is a problem, the inner one a field left out")]
pub fn holdout(map: &Map<'_>) -> Option<Option<Holdout>> {
    let Some(node) = map.get("holdout") else { return Some(None) };
    let holdout = node.map(&["fraction", "seed"])?;
    let fraction = holdout.require("fraction", "fraction: 0.25").and_then(|node| {
        let fraction = node.quantity(Dimension::Number)?;
        if !(fraction > 0.0 && fraction < 1.0) {
            node.error("a fraction of the poses between 0 and 1 is expected here", "e.g. `0.25`");
            return None;
        }
        Some(fraction)
    });
    let seed = match holdout.get("seed") {
        Some(node) => node.integer(1).and_then(|seed| {
            let positive = u64::try_from(seed).ok();
            if positive.is_none() {
                node.error("a seed is not negative", "e.g. `1`");
            }
            positive
        }),
        None => Some(0),
    };
    Some(Some(Holdout { fraction: fraction?, seed: seed? }))
}
