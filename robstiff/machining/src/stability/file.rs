//! Reading measured modes.

use core::f64::consts::TAU;
use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use robstiff_robots::ReadError;
use robstiff_robots::document::{Document, Map, Node};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};

use super::{MeasuredMode, Modes};

/// The fields of the file.
pub const FIELDS: [&str; 2] = ["modes", "frame"];

/// Those of a mode.
pub const MODE: [&str; 4] = ["frequency", "damping", "stiffness", "direction"];

/// The frame of the directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModesFrame {
    /// The robot's base frame.
    Base,
    /// The tool's (TCP's) frame.
    Tool,
}

/// The modes of the tool on the arm as a YAML file has them, measured in one pose.
#[derive(Clone, Debug, PartialEq)]
pub struct ModesFile {
    /// The modes, in the order of the file.
    pub modes: Vec<MeasuredMode>,
    /// The frame of their directions.
    pub frame: ModesFrame,
}

impl ModesFile {
    /// Reads the modes.
    ///
    /// # Errors
    /// A file that cannot be read; everything that is wrong with it, each problem at its place.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        Self::parse(&path.display().to_string(), &text::read(path, MOST_OF_DOCUMENT)?)
    }

    /// Reads the modes; `file` is the name that problems show.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(file: &str, text: &str) -> Result<Self, ReadError> {
        let document = Document::parse(file, text).map_err(ReadError::Invalid)?.wary();
        let said = said(&document);
        document.finish(said).map_err(ReadError::Invalid)
    }

    /// The modes in the base frame, with the rotation of the TCP's frame there. `None` where the
    /// numbers are beyond all reason, see [`Modes::measured`].
    pub fn in_base(&self, tool: &Matrix3<f64>) -> Option<Modes> {
        let rotation = match self.frame {
            ModesFrame::Base => Matrix3::identity(),
            ModesFrame::Tool => *tool,
        };
        let turned = |mode: &MeasuredMode| MeasuredMode { direction: rotation * mode.direction, ..*mode };
        Modes::measured(&self.modes.iter().map(turned).collect::<Vec<_>>())
    }
}

const EXAMPLE: &str = "{frequency: 15.2 Hz, damping: 0.03, stiffness: 0.8 N/um, direction: [1, 0, 0]}";

fn said(document: &Document) -> Option<ModesFile> {
    let map = document.root().map(&FIELDS)?;
    // Everything is read before anything is given up, to report all problems.
    let modes = map.require("modes", &format!("modes: [{EXAMPLE}]")).and_then(|node| {
        let items = node.sequence()?;
        if items.is_empty() {
            node.error("there is no mode", format!("write at least one, e.g. `{EXAMPLE}`"));
            return None;
        }
        let modes: Vec<Option<MeasuredMode>> = items.iter().map(mode).collect();
        modes.into_iter().collect::<Option<Vec<_>>>()
    });
    let frame = map
        .require("frame", "frame: base")
        .and_then(|node| node.choice(&[("base", ModesFrame::Base), ("tool", ModesFrame::Tool)]));
    Some(ModesFile { modes: modes?, frame: frame? })
}

fn mode(node: &Node<'_>) -> Option<MeasuredMode> {
    let map = node.map(&MODE)?;
    let frequency = measured(&map, "frequency", Dimension::Frequency, "15.2 Hz");
    let damping = map.require("damping", "damping: 0.03").and_then(|node| {
        let damping = node.quantity(Dimension::Number)?;
        if !(damping > 0.0 && damping < 1.0) {
            node.error("a measured damping ratio is above 0 and below 1", "e.g. `0.03`, which is 3 %");
            return None;
        }
        Some(damping)
    });
    // Stiffnesses are read as their inverse.
    let compliance = measured(&map, "stiffness", Dimension::LinearCompliance, "0.8 N/um");
    let direction = map.require("direction", "direction: [1, 0, 0]").and_then(|node| {
        let direction = Vector3::from(node.quantities::<3>(Dimension::Number)?);
        if direction.norm() == 0.0 {
            node.error(
                "a direction of zero length points nowhere",
                "e.g. `[0.7, -0.2, 0.1]`; the length does not count",
            );
            return None;
        }
        Some(direction)
    });
    Some(MeasuredMode {
        frequency: TAU * frequency?,
        damping: damping?,
        stiffness: compliance?.recip(),
        direction: direction?,
    })
}

/// A quantity above zero, which has a unit: in SI a stiffness of 0.8 is next to nothing.
fn measured(map: &Map<'_>, field: &str, dimension: Dimension, example: &str) -> Option<f64> {
    let node = map.require(field, &format!("{field}: {example}"))?;
    if node.is_suspect() {
        node.error(format!("`{field}` has no unit"), format!("write e.g. `{example}`"));
        return None;
    }
    let value = node.quantity(dimension)?;
    if value <= 0.0 {
        node.error(format!("a {field} above zero is expected here"), format!("e.g. `{example}`"));
        return None;
    }
    Some(value)
}
