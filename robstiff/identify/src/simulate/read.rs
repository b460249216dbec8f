//! Reading a scenario.

mod measured;

use std::borrow::ToOwned;
use std::format;
use std::path::Path;
use std::string::{String, ToString};
use std::vec::Vec;

use robstiff_robots::document::{Document, Map, Node};
use robstiff_robots::quantity::Dimension;
use robstiff_robots::text::{self, MOST_OF_DOCUMENT};
use robstiff_robots::words;
use robstiff_robots::{Description, Diagnostics, Joint, ReadError};

use self::measured::{Measured, measured};
use super::{Measures, Poses, Scenario};
use crate::campaign::read::{NOISIEST, holdout};
use robstiff::{Effect, JointKind};

/// The fields of a scenario.
pub const FIELDS: [&str; 16] = [
    "name", "kind", "seed", "poses", "visits", "ramp", "force", "moment", "payloads", "wrench", "measured", "noise",
    "unloaded", "hidden", "scatter", "holdout",
];

/// More of anything than a campaign on a real robot has, and less than what
/// fills a machine's memory.
pub const MOST: i64 = 100_000;

/// The same for the rows, which is what the memory is filled by.
const MOST_ROWS: usize = 1_000_000;

/// Larger than anything that is measured (N, Nm, m, rad), and small enough for
/// what is computed of it to be numbers.
const LARGEST: f64 = 1e9;

impl Scenario {
    /// Reads a scenario for a robot.
    ///
    /// # Errors
    /// A file that cannot be read, and everything [`parse`](Self::parse) finds.
    pub fn read(path: impl AsRef<Path>, robot: &Description) -> Result<Self, ReadError> {
        let path = path.as_ref();
        Self::parse(&path.display().to_string(), &text::read(path, MOST_OF_DOCUMENT)?, robot)
            .map_err(ReadError::Invalid)
    }

    /// Reads a scenario; `file` is the name that problems show.
    ///
    /// # Errors
    /// All that is wrong with the text, each problem with its place.
    pub fn parse(file: &str, text: &str, robot: &Description) -> Result<Self, Diagnostics> {
        let document = Document::parse(file, text)?.wary();
        let scenario = scenario(&document, robot);
        document.finish(scenario)
    }
}

fn scenario(document: &Document, robot: &Description) -> Option<Scenario> {
    let map = document.root().map(&FIELDS)?;
    // Everything is read before anything is given up, to report all problems.
    let name = map.get("name").map_or(Some(String::new()), |node| node.text().map(ToOwned::to_owned));
    let seed = map.require("seed", "seed: 1").and_then(|node| seed(&node));
    let poses = map.require("poses", "poses: {count: 40, floor: 100 mm}").and_then(|node| poses(&node, &robot.joints));
    let visits = map.get("visits").map_or(Some(1), |node| count(&node));
    let measured = measured(&map, &robot.joints);
    let hidden = map.get("hidden").map_or(Some(Vec::new()), |node| hidden(&node, robot));
    let scatter = map.get("scatter").map_or(Some(0.0), |node| scatter(&node));
    let holdout = holdout(&map);
    let few = few_rows(&map, poses.as_ref(), visits, measured.as_ref().map(|read| &read.measures));
    let Measured { measures, wrench_at, measured_at, noise, states_noise } = measured?;
    few?;
    Some(Scenario {
        name: name?,
        seed: seed?,
        poses: poses?,
        visits: visits?,
        measures,
        wrench_at,
        measured_at,
        noise,
        states_noise,
        hidden: hidden?,
        scatter: scatter?,
        holdout: holdout?,
    })
}

fn seed(node: &Node<'_>) -> Option<u64> {
    let seed = u64::try_from(node.integer(1)?).ok();
    if seed.is_none() {
        node.error("a seed is not negative", "e.g. `1`");
    }
    seed
}

fn count(node: &Node<'_>) -> Option<usize> {
    let count = node.integer(40)?;
    if !(1..=MOST).contains(&count) {
        node.error(format!("a number from 1 to {MOST} is expected here, not {count}"), "e.g. `40`");
        return None;
    }
    usize::try_from(count).ok()
}

/// That there are not more rows than a machine can hold, once all that they are
/// counted by is known.
fn few_rows(map: &Map<'_>, poses: Option<&Poses>, visits: Option<usize>, measures: Option<&Measures>) -> Option<()> {
    let poses = match poses? {
        Poses::Drawn { count, .. } => *count,
        Poses::Listed(poses) => poses.len(),
    };
    let (loads, field, what) = match measures? {
        Measures::Displacements(under) => (under.ramp.len(), "ramp", "loads"),
        Measures::Positions(under) => (under.payloads.len(), "payloads", "payloads"),
    };
    let visits = visits?;
    let rows = poses.saturating_mul(visits).saturating_mul(loads);
    if rows <= MOST_ROWS {
        return Some(());
    }
    let node = ["visits", field, "poses"].iter().find_map(|field| map.get(field))?;
    node.error(
        format!(
            "{poses} poses with {visits} visits of {loads} {what} are {rows} rows, more than the {MOST_ROWS} that a \
             campaign may have"
        ),
        format!("take fewer poses, visits or {what}"),
    );
    None
}

/// A value that can be computed with.
fn computable(node: &Node<'_>, value: f64) -> Option<f64> {
    if value.abs() > LARGEST {
        node.error("this is beyond anything that is measured", format!("at most {LARGEST:e} N, Nm, m or rad"));
        return None;
    }
    Some(value)
}

fn sigma(node: &Node<'_>, dimension: Dimension) -> Option<f64> {
    computable(node, node.nonnegative(dimension)?)
}

/// One sigma of what an instrument reads (m, rad). Without a unit it must be one that an
/// instrument can have in SI; with it, it may be any.
fn noise(node: &Node<'_>, dimension: Dimension) -> Option<f64> {
    let sigma = sigma(node, dimension)?;
    if node.is_suspect() && sigma > NOISIEST {
        let (si, usual) = (dimension.unit(), if dimension == Dimension::Angle { "urad" } else { "um" });
        node.error(
            format!("{sigma} {si} is more noise than any instrument has"),
            format!("in {usual}? write `{sigma} {usual}`, or the unit if it is `{sigma} {si}`"),
        );
        return None;
    }
    Some(sigma)
}

fn poses(node: &Node<'_>, joints: &[Joint]) -> Option<Poses> {
    let map = node.map(&["count", "within", "floor", "column", "list"])?;
    if let Some(list) = map.get("list") {
        if let Some(other) = ["count", "within", "floor", "column"].iter().find_map(|field| map.get(field)) {
            other.error("poses that are listed are not drawn", "keep `list`, or what poses are drawn by");
        }
        let items = list.sequence()?;
        if items.is_empty() {
            list.error("at least one pose is expected here", "one list of joint coordinates a pose");
        }
        let poses: Vec<Option<Vec<f64>>> = items.iter().map(|item| pose(item, joints)).collect();
        return poses.into_iter().collect::<Option<Vec<_>>>().filter(|poses| !poses.is_empty()).map(Poses::Listed);
    }
    let count = map.require("count", "count: 40").and_then(|node| self::count(&node));
    let within = match map.get("within") {
        Some(node) => within(&node, joints),
        None => limits(&map, joints),
    };
    let length = |field| map.get(field).map_or(Some(None), |node| node.quantity(Dimension::Length).map(Some));
    let (floor, column) = (length("floor"), length("column"));
    Some(Poses::Drawn { count: count?, within: within?, floor: floor?, column: column? })
}

fn dimension(joint: &Joint) -> Dimension {
    match joint.kind {
        JointKind::Revolute => Dimension::Angle,
        JointKind::Prismatic => Dimension::Length,
    }
}

/// The items of a list that has one for each joint.
fn for_each_joint<'d>(node: &Node<'d>, joints: &[Joint]) -> Option<Vec<Node<'d>>> {
    let items = node.sequence()?;
    if items.len() != joints.len() {
        let message =
            format!("this gives {} for {}", words::count(items.len(), "item"), words::count(joints.len(), "joint"));
        node.error(message, "give one for each joint");
        return None;
    }
    Some(items)
}

fn coordinate(node: &Node<'_>, joint: &Joint) -> Option<f64> {
    let q = computable(node, node.quantity(dimension(joint))?)?;
    if let Some(what) = joint.outside_limits().filter(|_| !joint.reaches(q)) {
        node.error(
            format!("{} {} is {what}", joint.for_people(q), joint.people_unit()),
            "the limits are those of the robot's description",
        );
        return None;
    }
    Some(q)
}

fn pose(node: &Node<'_>, joints: &[Joint]) -> Option<Vec<f64>> {
    let items = for_each_joint(node, joints)?;
    let q: Vec<Option<f64>> = items.iter().zip(joints).map(|(item, joint)| coordinate(item, joint)).collect();
    q.into_iter().collect()
}

fn within(node: &Node<'_>, joints: &[Joint]) -> Option<Vec<[f64; 2]>> {
    let items = for_each_joint(node, joints)?;
    let range = |(item, joint): (&Node<'_>, &Joint)| {
        let ends = item.sequence()?;
        let [low, high] = ends.as_slice() else {
            item.error("two values are expected here", "write `[lower, upper]`");
            return None;
        };
        let (low, high) = (coordinate(low, joint), coordinate(high, joint));
        let (low, high) = (low?, high?);
        if low > high {
            item.error("the lower end is above the upper one", "write `[lower, upper]`");
            return None;
        }
        Some([low, high])
    };
    let ranges: Vec<Option<[f64; 2]>> = items.iter().zip(joints).map(range).collect();
    ranges.into_iter().collect()
}

/// The joints' limits, where all have some.
fn limits(map: &Map<'_>, joints: &[Joint]) -> Option<Vec<[f64; 2]>> {
    if let Some(without) = joints.iter().position(|joint| joint.limits.is_none()) {
        map.node().error(
            format!("the description gives joint {} no limits to draw poses from", without + 1),
            "add a range for each joint, e.g. `within: [[-120 deg, 120 deg], ..]`, or limits to the description",
        );
        return None;
    }
    joints.iter().map(|joint| joint.limits).collect()
}

/// What the description is not told; `effects` as in a description.
fn hidden(node: &Node<'_>, robot: &Description) -> Option<Vec<Effect>> {
    let list = node.map(&["effects"])?.require("effects", "effects: [{kind: transverse_compliance, ..}]")?;
    let effects = robot.read_effects(&list)?;
    for (item, effect) in list.sequence()?.iter().zip(&effects) {
        if let Some(declared) = robot.effects.iter().find(|declared| declared.is_same(effect)) {
            // An error of theta is a zero offset by another name.
            let of_the_same = declared.to_string() != effect.to_string();
            let which = if of_the_same { format!(", which is the same as `{effect}`") } else { String::new() };
            item.error(
                format!("the description declares `{declared}` already{which}"),
                "hide what it lacks; what it says wrong about its joints is `scatter`",
            );
        }
    }
    Some(effects)
}

fn scatter(node: &Node<'_>) -> Option<f64> {
    let scatter = node.quantity(Dimension::Number)?;
    if !(0.0..1.0).contains(&scatter) {
        node.error("a fraction from 0 to below 1 is expected here", "e.g. `0.3` for joints up to 30 % off");
        return None;
    }
    Some(scatter)
}
