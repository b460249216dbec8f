//! Reading a cut.

use std::path::{Path, PathBuf};

use nalgebra::{Matrix3, Vector3};
use robstiff_robots::ReadError;
use robstiff_robots::document::{Document, Map, Node};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};

use super::{
    Coefficients, Cut, CutFrame, Direction, EndMill, Engagement, ForceFrame, Kienzle, MeasuredForce, coefficients,
    kienzle, kienzle_materials, materials,
};
use robstiff_robots::table::text_of;

/// The fields of a cut.
pub const FIELDS: [&str; 13] = [
    "name",
    "tool",
    "material",
    "coefficients",
    "kienzle",
    "milling",
    "width",
    "engagement",
    "depth",
    "feed",
    "feed_speed",
    "speed",
    "measured",
];

/// A cut as its YAML file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct CutFile {
    /// What the file calls itself.
    pub name: String,
    /// Where the coefficients come from: the table's source, or empty where they
    /// are the file's own or the force is measured.
    pub source: String,
    /// The force.
    pub forces: Forces,
    /// The file with the measured forces, as resolved from the cut's folder.
    pub measured_path: Option<PathBuf>,
    /// What the reader noticed without refusing the files.
    pub warnings: Vec<String>,
}

/// Where the force of a cut comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Forces {
    /// The mechanistic model.
    Model(Cut),
    /// A record.
    Measured {
        /// The record.
        force: MeasuredForce,
        /// Speed of the spindle (rad/s), where it is known.
        speed: Option<f64>,
    },
}

impl Forces {
    /// The mean force on the tool (N): of the model along feed, normal and axis of
    /// the cut, of a record along its own axes.
    pub fn mean(&self) -> Vector3<f64> {
        match self {
            Self::Model(cut) => cut.mean_force(),
            Self::Measured { force, speed } => force.mean(*speed),
        }
    }

    /// What turns such a force into the robot's base frame, with the rotation of the
    /// TCP's frame. The model needs the cut's frame there, a record only where its
    /// forces are along that; `None` where it is missing.
    pub fn to_base(&self, cut: Option<&CutFrame>, tool: &Matrix3<f64>) -> Option<Matrix3<f64>> {
        match self {
            Self::Model(_) => cut.map(CutFrame::matrix),
            Self::Measured { force, .. } => force.to_base(cut, tool),
        }
    }
}

/// What the file says of measured forces.
struct Record {
    file: String,
    frame: ForceFrame,
    on_workpiece: bool,
    speed: Option<f64>,
}

/// What the YAML file says.
enum Said {
    Model(Cut, String),
    Measured(Record),
}

impl CutFile {
    /// Reads a cut and, where it names them, its measured forces.
    ///
    /// # Errors
    /// A file that cannot be read; everything that is wrong with the first file
    /// that has problems, each problem at its place.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        Self::parse(
            &path.display().to_string(),
            &text::read(path, MOST_OF_DOCUMENT)?,
            path.parent().unwrap_or(Path::new("")),
        )
    }

    /// Reads a cut; `file` is the name that problems show, `folder` what the
    /// path of measured forces starts from.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(file: &str, text: &str, folder: &Path) -> Result<Self, ReadError> {
        let document = Document::parse(file, text).map_err(ReadError::Invalid)?;
        let said = said(&document, folder);
        // In a document of its own, so that what is wrong is reported once.
        let bare = Document::parse(file, text).map(|document| bare(&document)).map_err(ReadError::Invalid)?;
        let mut doubts: Vec<String> = bare.iter().map(|said| format!("{file}: {said}")).collect();
        let (name, said) = document.finish(said).map_err(ReadError::Invalid)?;
        let record = match said {
            Said::Model(cut, source) => {
                let forces = Forces::Model(cut);
                return Ok(Self { name, source, forces, measured_path: None, warnings: doubts });
            }
            Said::Measured(record) => record,
        };
        let path = folder.join(&record.file);
        let text = text_of(&path)?;
        let parsed = MeasuredForce::parse(&path.display().to_string(), &text, record.frame, record.on_workpiece);
        let (force, warnings) = parsed.map_err(ReadError::Invalid)?;
        doubts.extend(warnings);
        let forces = Forces::Measured { force, speed: record.speed };
        Ok(Self { name, source: String::new(), forces, measured_path: Some(path), warnings: doubts })
    }
}

/// What has no unit: in SI a depth of 2 is 2 m.
fn bare(document: &Document) -> Vec<String> {
    let Some(map) = map_of(document.root()) else { return Vec::new() };
    let tool = map.get("tool").and_then(map_of);
    let fields = [
        (tool.as_ref(), "diameter", "m", "mm"),
        (tool.as_ref(), "corner", "m", "mm"),
        (Some(&map), "width", "m", "mm"),
        (Some(&map), "depth", "m", "mm"),
        (Some(&map), "feed", "m a tooth", "mm/tooth"),
        (Some(&map), "feed_speed", "m/s", "mm/min"),
        (Some(&map), "speed", "rad/s", "rpm"),
    ];
    let bare = |&(map, field, _, _): &(Option<&Map<'_>>, &str, &str, &str)| {
        map.and_then(|map| map.get(field)).is_some_and(|node| node.is_number())
    };
    let mut asked: Vec<String> =
        fields.into_iter().filter(bare).map(|(_, field, si, unit)| taken_in(field, si, unit)).collect();
    // Zero is the same in every unit.
    let any = |nodes: &[Node<'_>]| {
        nodes.iter().any(|node| node.is_number() && node.quantity(Dimension::Number).is_some_and(|value| value != 0.0))
    };
    let runout = tool.and_then(|tool| tool.get("runout")).filter(Node::is_sequence);
    if runout.and_then(|node| node.sequence()).is_some_and(|items| any(&items)) {
        asked.push(taken_in("runout", "m", "um"));
    }
    let own = map.get("coefficients").and_then(map_of);
    let along: Vec<Map<'_>> = own.iter().flat_map(Map::fields).filter_map(|(_, node)| map_of(node)).collect();
    for (field, si, unit) in [("cutting", "Pa", "N/mm2"), ("edge", "N/m", "N/mm")] {
        if any(&along.iter().filter_map(|map| map.get(field)).collect::<Vec<_>>()) {
            asked.push(taken_in(field, si, unit));
        }
    }
    let law = map.get("kienzle").and_then(map_of);
    if law.and_then(|law| law.get("kc11")).is_some_and(|node| node.is_number()) {
        asked.push(taken_in("kc11", "Pa", "N/mm2"));
    }
    asked
}

fn map_of(node: Node<'_>) -> Option<Map<'_>> {
    node.is_map().then(|| node.any_map("")).flatten()
}

/// Asks whether a field without a unit is in another than that of SI.
fn taken_in(field: &str, si: &str, unit: &str) -> String {
    format!("`{field}` has no unit and is taken in {si}: is it in {unit}?")
}

fn said(document: &Document, folder: &Path) -> Option<(String, Said)> {
    let map = document.root().map(&FIELDS)?;
    let name = map.get("name").map_or(Some(String::new()), |node| node.text().map(ToOwned::to_owned));
    let speed = map.get("speed").map_or(Some(None), |node| node.positive(Dimension::RotationalSpeed).map(Some));
    let said = match map.get("measured") {
        Some(node) => record(&map, &node, folder, speed).map(Said::Measured),
        None => cut(&map, speed),
    };
    Some((name?, said?))
}

fn record(map: &Map<'_>, node: &Node<'_>, folder: &Path, speed: Option<Option<f64>>) -> Option<Record> {
    for field in FIELDS.iter().filter(|field| !["name", "speed", "measured"].contains(field)) {
        if let Some(other) = map.get(field) {
            other.error("a measured force needs no model of it", "keep `measured`, or what the model needs");
        }
    }
    let measured = node.map(&["file", "frame", "on"])?;
    let file = measured.require("file", "file: forces.csv").and_then(|node| {
        let name = node.text()?;
        let path = folder.join(name);
        if !path.is_file() {
            node.error(format!("there is no file {}", path.display()), "write the path from the folder of this file");
            return None;
        }
        Some(name.to_owned())
    });
    let frame = measured.require("frame", "frame: cut").and_then(|node| {
        node.choice(&[("cut", ForceFrame::Cut), ("base", ForceFrame::Base), ("tool", ForceFrame::Tool)])
    });
    let on_workpiece =
        measured.require("on", "on: workpiece").and_then(|node| node.choice(&[("tool", false), ("workpiece", true)]));
    Some(Record { file: file?, frame: frame?, on_workpiece: on_workpiece?, speed: speed? })
}

/// How deep a cut may be, in diameters of its tool.
const MOST_DIAMETERS: f64 = 1000.0;

fn cut(map: &Map<'_>, speed: Option<Option<f64>>) -> Option<Said> {
    // Everything is read before anything is given up, to report all problems.
    let mill = map.require("tool", "tool: {diameter: 16 mm, teeth: 3, helix: 30 deg}").and_then(|node| mill(&node));
    let resistance = resistance(map);
    let diameter = mill.as_ref().map(|mill| mill.diameter);
    let engagement = engagement(map, diameter);
    let depth = depth(map, diameter);
    let feed = feed(map, mill.as_ref(), speed);
    let ((resistance, source), engagement, feed_per_tooth) = (resistance?, engagement?, feed?);
    let coefficients = match resistance {
        Resistance::Linear(coefficients) => coefficients,
        Resistance::Kienzle(law) => law.coefficients(engagement, feed_per_tooth),
    };
    let cut = Cut { mill: mill?, coefficients, engagement, depth: depth?, feed_per_tooth, speed: speed? };
    Some(Said::Model(cut, source))
}

pub(super) fn depth(map: &Map<'_>, diameter: Option<f64>) -> Option<f64> {
    let node = map.require("depth", "depth: 2 mm")?;
    let depth = node.positive(Dimension::Length)?;
    // The flutes would go round without end.
    if diameter.is_some_and(|diameter| depth > MOST_DIAMETERS * diameter) {
        node.error(format!("the cut is more than {MOST_DIAMETERS} times as deep as the tool is wide"), "e.g. `2 mm`");
        return None;
    }
    Some(depth)
}

pub(super) fn mill(node: &Node<'_>) -> Option<EndMill> {
    let map = node.map(&["diameter", "teeth", "helix", "corner", "runout"])?;
    let diameter = map.require("diameter", "diameter: 16 mm").and_then(|node| node.positive(Dimension::Length));
    let teeth = map.require("teeth", "teeth: 3").and_then(|node| {
        let teeth = node.integer(3)?;
        if !(1..=100).contains(&teeth) {
            node.error(format!("a mill has 1 to 100 teeth, not {teeth}"), "e.g. `3`");
            return None;
        }
        usize::try_from(teeth).ok()
    });
    let helix = map.get("helix").map_or(Some(0.0), |node| {
        let helix = node.quantity(Dimension::Angle)?;
        if helix.abs() > 80_f64.to_radians() {
            node.error("a helix angle is between -80 and 80 degrees", "e.g. `30 deg`");
            return None;
        }
        Some(helix)
    });
    let corner = map.get("corner").map_or(Some(0.0), |node| {
        let corner = node.quantity(Dimension::Length)?;
        // Half of a diameter that was rounded is a ball nose.
        let Some(most) = diameter.map(|diameter| 0.5 * diameter) else { return Some(corner) };
        if !(0.0..=most * (1.0 + 1e-9)).contains(&corner) {
            node.error(
                "the radius of the corner is not between 0 and half the diameter",
                format!("0 of a flat end mill, `{} mm` of a ball nose", 1e3 * most),
            );
            return None;
        }
        Some(corner.min(most))
    });
    let runout = map.get("runout").map_or(Some(Vec::new()), |node| {
        let items = node.sequence()?;
        let out: Vec<Option<f64>> = items.iter().map(|item| item.quantity(Dimension::Length)).collect();
        if let Some(teeth) = teeth.filter(|teeth| *teeth != items.len()) {
            let message = format!("a mill with {teeth} teeth has {teeth} values, not {}", items.len());
            node.error(message, "how far each tooth stands out, in the order in which they cut, e.g. `[0 um, 12 um]`");
            return None;
        }
        out.into_iter().collect()
    });
    Some(EndMill { diameter: diameter?, teeth: teeth?, helix: helix?, corner: corner?, runout: runout? })
}

/// What the material resists with: as the model has it, or by a law that it follows nearly.
enum Resistance {
    Linear(Coefficients),
    Kienzle(Kienzle),
}

/// With where it comes from.
fn resistance(map: &Map<'_>) -> Option<(Resistance, String)> {
    let given = ["coefficients", "kienzle", "material"].into_iter().filter_map(|field| map.get(field));
    for other in given.skip(1) {
        other.error("a cut has a material, coefficients or a law of its own", "keep one of them");
    }
    if let Some(node) = map.get("coefficients") {
        let own = node.map(&["tangential", "radial", "axial"])?;
        return coefficients::read(&own).map(|coefficients| (Resistance::Linear(coefficients), String::new()));
    }
    if let Some(node) = map.get("kienzle") {
        return kienzle::read(&node).map(|(law, source)| (Resistance::Kienzle(law), source));
    }
    let node = map.require("material", "material: al7075-t6")?;
    let id = node.text()?;
    if kienzle_materials().iter().any(|material| material.id == id) {
        node.error(
            format!("of `{id}` the table has the tangential force only"),
            format!(
                "write in place of it `kienzle: {{material: {id}, radial: 0.3}}`, with your share of the radial force"
            ),
        );
        return None;
    }
    let materials = materials();
    let words: Vec<(&str, &super::Material)> =
        materials.iter().map(|material| (material.id.as_str(), material)).collect();
    let found = node.choice(&words)?;
    Some((Resistance::Linear(found.coefficients), format!("{}; {}", found.name, found.source)))
}

pub(super) fn engagement(map: &Map<'_>, diameter: Option<f64>) -> Option<Engagement> {
    if let Some(node) = map.get("engagement") {
        for field in ["milling", "width"] {
            if let Some(other) = map.get(field) {
                other.error(
                    "the angles of the engagement say this already",
                    "keep `engagement`, or `milling` and `width`",
                );
            }
        }
        let [entry, exit] = node.quantities::<2>(Dimension::Angle)?;
        let engagement = Engagement::between(entry, exit);
        if engagement.is_none() {
            node.error("the angles are not between 0 and 180 degrees, the lower first", "e.g. `[120 deg, 180 deg]`");
        }
        return engagement;
    }
    let direction = map
        .require("milling", "milling: down")
        .and_then(|node| node.choice(&[("up", Some(Direction::Up)), ("down", Some(Direction::Down)), ("slot", None)]));
    match direction? {
        None => {
            if let Some(other) = map.get("width") {
                other.error("a slot is as wide as the tool", "leave `width` out");
            }
            Some(Engagement::SLOT)
        }
        Some(direction) => {
            let node = map.require("width", "width: 4 mm")?;
            let width = node.positive(Dimension::Length)?;
            let diameter = diameter?;
            if width == diameter {
                node.error(
                    "a cut as wide as the tool is a slot, with a wall on either side",
                    "write `milling: slot`, and leave `width` out",
                );
                return None;
            }
            let engagement = Engagement::of_width(direction, width, diameter);
            if engagement.is_none() {
                let most = format!("a width of at most the tool's diameter, {} mm", diameter * 1e3);
                let help = if node.is_number() { format!("{most}; {}", taken_in("width", "m", "mm")) } else { most };
                node.error("the cut is wider than the tool", help);
            }
            engagement
        }
    }
}

/// The feed per tooth, as such or from the speeds of feed and spindle.
pub(super) fn feed(map: &Map<'_>, mill: Option<&EndMill>, speed: Option<Option<f64>>) -> Option<f64> {
    let (node, feed) = match map.get("feed_speed") {
        Some(node) => {
            if let Some(other) = map.get("feed") {
                other.error("the feed is given twice", "keep `feed` (per tooth) or `feed_speed`");
            }
            let feed_speed = node.positive(Dimension::Speed);
            let Some(speed) = speed? else {
                node.error("a speed of feed says nothing without the spindle's", "add `speed`, e.g. `speed: 9000 rpm`");
                return None;
            };
            let feed = feed_speed? / (speed / core::f64::consts::TAU * mill?.teeth as f64);
            (node, feed)
        }
        None => {
            let node = map.require("feed", "feed: 0.1 mm/tooth")?;
            let feed = node.positive(Dimension::FeedPerTooth)?;
            (node, feed)
        }
    };
    if let Some(mill) = mill.filter(|mill| feed >= 0.5 * mill.diameter) {
        let message = format!("a feed of {:.3} mm a tooth is not below the tool's radius", feed * 1e3);
        node.error(message, format!("the tool's diameter is {} mm; e.g. `feed: 0.1 mm/tooth`", mill.diameter * 1e3));
        return None;
    }
    Some(feed)
}
