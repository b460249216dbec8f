//! Reading measured modes.

use core::convert::Infallible;
use core::f64::consts::TAU;
use std::path::{Path, PathBuf};

use nalgebra::{Matrix3, Vector3};
use robstiff_robots::document::{Document, Map, Node};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};
use robstiff_robots::{Diagnostics, ReadError};

use super::responses::{Fit, FitError, FittedModes, MOST_MODES, Motion, Responses};
use super::{MeasuredMode, Modes, Spring};

/// The fields of the file.
pub const FIELDS: [&str; 4] = ["modes", "massless", "responses", "frame"];

/// Those of a mode.
pub const MODE: [&str; 4] = ["frequency", "damping", "stiffness", "direction"];

/// Those of a spring.
pub const SPRING: [&str; 2] = ["stiffness", "direction"];

/// Those of responses.
pub const RESPONSES: [&str; 5] = ["file", "measured", "from", "to", "modes"];

/// What may be measured.
pub const MEASURED: [&str; 3] = ["receptance", "mobility", "accelerance"];

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
    /// The modes, in the order of the file; of those that were fitted the lowest frequency first.
    pub modes: Vec<MeasuredMode>,
    /// What gives way without mass.
    pub massless: Vec<Spring>,
    /// The frame of their directions.
    pub frame: ModesFrame,
    /// The file of the responses to which they were fitted, with how well.
    pub fit: Option<(PathBuf, Fit)>,
    /// What the reader noticed without refusing the files.
    pub warnings: Vec<String>,
}

/// What the YAML file says.
enum Said {
    Modes(Vec<MeasuredMode>, Vec<Spring>),
    Responses(Asked),
}

/// What it says of responses.
struct Asked {
    path: PathBuf,
    motion: Motion,
    band: [f64; 2],
    modes: Option<usize>,
}

impl ModesFile {
    /// Reads the modes, and where the file names responses fits them to these.
    ///
    /// # Errors
    /// A file that cannot be read; everything that is wrong with the first file that has problems, each problem
    /// at its place; responses that no modes fit.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&path.display().to_string(), &text::read(path, MOST_OF_DOCUMENT)?, folder)
    }

    /// Reads the modes; `file` is the name that problems show, `folder` what the path of responses starts from.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(file: &str, text: &str, folder: &Path) -> Result<Self, ReadError> {
        let document = Document::parse(file, text).map_err(ReadError::Invalid)?.wary();
        let said = said(&document, folder);
        let (said, frame) = document.finish(said).map_err(ReadError::Invalid)?;
        let asked = match said {
            Said::Modes(modes, massless) => {
                return Ok(Self { modes, massless, frame, fit: None, warnings: Vec::new() });
            }
            Said::Responses(asked) => asked,
        };
        let (responses, warnings) = Responses::read(&asked.path, asked.motion, asked.band)?;
        let FittedModes { modes, massless, fit } =
            responses.fit(asked.modes).map_err(|error| ReadError::Invalid(refused(file, text, error)))?;
        Ok(Self { modes, massless, frame, fit: Some((asked.path, fit)), warnings })
    }

    /// The modes in the base frame, with the rotation of the TCP's frame there. `None` where the
    /// numbers are beyond all reason, see [`Modes::measured`].
    pub fn in_base(&self, tool: &Matrix3<f64>) -> Option<Modes> {
        let rotation = match self.frame {
            ModesFrame::Base => Matrix3::identity(),
            ModesFrame::Tool => *tool,
        };
        let modes: Vec<MeasuredMode> =
            self.modes.iter().map(|mode| MeasuredMode { direction: rotation * mode.direction, ..*mode }).collect();
        let massless: Vec<Spring> =
            self.massless.iter().map(|spring| Spring { direction: rotation * spring.direction, ..*spring }).collect();
        Modes::measured(&modes)?.with_massless(&massless)
    }
}

/// What is said where no modes fit the responses, at the place where they are asked for.
fn refused(file: &str, text: &str, error: FitError) -> Diagnostics {
    let help = match error {
        FitError::Incomplete => "measure the responses along x, y and z to one force at least".to_owned(),
        FitError::TooFewLines { .. } => {
            "ask for fewer, widen the band, or record longer: the lines are as far apart as one over the time"
                .to_owned()
        }
        FitError::TooManyModes { found, .. } => format!("ask for {found} or fewer, or widen the band"),
        FitError::NoMode => "set the band, `from` and `to`, about the peaks of the responses".to_owned(),
        FitError::Unexplained(_) => {
            "is `measured` right, and the sign of each response? set the band, `from` and `to`, \
                                     about the peaks, or ask for more modes: `modes: 4`"
                .to_owned()
        }
    };
    let document = match Document::parse(file, text) {
        Ok(document) => document,
        Err(problems) => return problems,
    };
    let node = document.root().any_map("").and_then(|map| map.get("responses"));
    let modes = node.as_ref().and_then(|node| node.any_map("")).and_then(|map| map.get("modes"));
    let is_of_modes = matches!(error, FitError::TooFewLines { .. } | FitError::TooManyModes { .. });
    let place = modes.filter(|_| is_of_modes).or(node).unwrap_or_else(|| document.root());
    place.error(error.to_string(), help);
    match document.finish::<Infallible>(None) {
        Ok(never) => match never {},
        Err(problems) => problems,
    }
}

const EXAMPLE: &str = "{frequency: 15.2 Hz, damping: 0.03, stiffness: 0.8 N/um, direction: [1, 0, 0]}";

fn said(document: &Document, folder: &Path) -> Option<(Said, ModesFrame)> {
    let map = document.root().map(&FIELDS)?;
    // Everything is read before anything is given up, to report all problems.
    let said = match map.get("responses") {
        Some(node) => {
            for other in ["modes", "massless"].into_iter().filter_map(|field| map.get(field)) {
                other.error("the modes are those of `responses`", "keep one of them");
            }
            asked(&node, folder).map(Said::Responses)
        }
        None => table(&map),
    };
    let frame = map
        .require("frame", "frame: base")
        .and_then(|node| node.choice(&[("base", ModesFrame::Base), ("tool", ModesFrame::Tool)]));
    Some((said?, frame?))
}

fn table(map: &Map<'_>) -> Option<Said> {
    let modes = map.require("modes", &format!("modes: [{EXAMPLE}]")).and_then(|node| {
        let items = node.sequence()?;
        if items.is_empty() {
            node.error("there is no mode", format!("write at least one, e.g. `{EXAMPLE}`"));
            return None;
        }
        let modes: Vec<Option<MeasuredMode>> = items.iter().map(mode).collect();
        modes.into_iter().collect::<Option<Vec<_>>>()
    });
    let massless = map.get("massless").map_or(Some(Vec::new()), |node| {
        let springs: Vec<Option<Spring>> = node.sequence()?.iter().map(spring).collect();
        springs.into_iter().collect()
    });
    Some(Said::Modes(modes?, massless?))
}

fn asked(node: &Node<'_>, folder: &Path) -> Option<Asked> {
    let map = node.map(&RESPONSES)?;
    let path = map.require("file", "file: hammer.csv").and_then(|node| {
        let path = folder.join(node.text()?);
        if !path.is_file() {
            node.error(format!("there is no file {}", path.display()), "write the path from the folder of this file");
            return None;
        }
        Some(path)
    });
    let motions = [Motion::Receptance, Motion::Mobility, Motion::Accelerance];
    let words: Vec<(&str, Motion)> = MEASURED.into_iter().zip(motions).collect();
    let motion = map.require("measured", "measured: accelerance").and_then(|node| node.choice(&words));
    let bound = |field: &str, example: &str, without: f64| {
        map.get(field).map_or(Some(without), |_| measured(&map, field, Dimension::Frequency, example))
    };
    let (from, to) = (bound("from", "5 Hz", 0.0), bound("to", "60 Hz", f64::MAX));
    if let (Some(from), Some(to), Some(node)) = (from, to, map.get("to"))
        && from >= to
    {
        node.error("the band ends where it begins, or before", "e.g. `from: 5 Hz`, `to: 60 Hz`");
    }
    let modes = map.get("modes").map_or(Some(None), |node| {
        let asked = node.integer(4)?;
        let modes = usize::try_from(asked).ok().filter(|modes| (1..=MOST_MODES).contains(modes));
        if modes.is_none() {
            node.error(format!("1 to {MOST_MODES} modes can be asked for, not {asked}"), "e.g. `4`");
        }
        modes.map(Some)
    });
    Some(Asked { path: path?, motion: motion?, band: [from?, to?], modes: modes? })
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
    let spring = sprung(&map);
    let (frequency, damping, Spring { stiffness, direction }) = (TAU * frequency?, damping?, spring?);
    Some(MeasuredMode { frequency, damping, stiffness, direction })
}

fn spring(node: &Node<'_>) -> Option<Spring> {
    sprung(&node.map(&SPRING)?)
}

/// A stiffness along a direction.
fn sprung(map: &Map<'_>) -> Option<Spring> {
    // Stiffnesses are read as their inverse.
    let compliance = measured(map, "stiffness", Dimension::LinearCompliance, "0.8 N/um");
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
    Some(Spring { stiffness: compliance?.recip(), direction: direction? })
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
