//! Poses and loads that can be proposed.
//!
//! Poses fill the joints' ranges evenly (a Halton sequence, shifted by the
//! seed). A range is the campaign's and a quarter more on either side, within the
//! joint's limits with a margin. A joint without limits stays where the campaign has
//! been: what was reached once can be reached again.
//! The tool stays as high above the base's origin and as far from its vertical
//! as it did in the campaign. Whether the arm hits itself or its surroundings is
//! not known here.

use std::collections::BTreeMap;
use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_robots::Description;
use robstiff_robots::effect::gravity_sag::GRAVITY;

use super::regressors::Visit;
use super::{Options, can_follow};
use crate::campaign::{Campaign, Data, Displacements, Positions};
use crate::identify::Error;
use crate::model::Arm;

/// The bases of the sequence, a joint each.
const PRIMES: [u32; 8] = [2, 3, 5, 7, 11, 13, 17, 19];

/// Points of the sequence per pose wanted, before the region counts as empty.
const TRIES: usize = 100;

/// Where a robot may be sent, and how it may be pulled there.
#[derive(Clone, Debug)]
pub struct Space {
    robot: Description,
    /// The range of each joint (rad or m).
    pub ranges: Vec<[f64; 2]>,
    floor: f64,
    column: f64,
    /// The load sequences: forces and moments in the base frame (N, Nm).
    pub loads: Vec<Vec<[f64; 6]>>,
    /// The poses to choose from.
    pub poses: Vec<Vec<f64>>,
    /// What was taken for granted, a sentence each.
    pub assumptions: Vec<String>,
}

impl Space {
    /// The space around a campaign.
    ///
    /// # Errors
    /// A campaign of another kind; no pose in the region.
    pub fn new(campaign: &Campaign, options: &Options) -> Result<Self, Error> {
        can_follow(campaign)?;
        let visited: Vec<&[f64]> = match &campaign.data {
            Data::Displacement(data) => data.rows.iter().map(|row| &row.q[..]).collect(),
            Data::Position(data) => data.rows.iter().map(|row| &row.q[..]).collect(),
            Data::Clamped(_) => Vec::new(),
        };
        let mut assumptions = Vec::new();
        let ranges = ranges(campaign, &visited, options.margin, &mut assumptions);
        let seen: Vec<Vector3<f64>> = visited.iter().map(|q| tool_centre_point(&campaign.robot, q)).collect();
        let lowest = seen.iter().map(|point| height(&campaign.robot, point)).fold(f64::INFINITY, f64::min);
        let floor = options.floor.unwrap_or(lowest);
        let nearest = seen.iter().map(|point| from_vertical(&campaign.robot, point)).fold(f64::INFINITY, f64::min);
        assumptions.push(format!(
            "the tool stays at least {:.0} mm high and {:.0} mm from the vertical of the base{}",
            floor * 1e3,
            nearest * 1e3,
            if options.floor.is_none() { ", as in the campaign" } else { "" }
        ));
        let loads = match &campaign.data {
            Data::Displacement(data) => loads(data, options, &mut assumptions),
            Data::Position(data) => std::vec![payloads(data, options, &mut assumptions)?],
            Data::Clamped(_) => Vec::new(),
        };
        let mut space = Self {
            robot: campaign.robot.clone(),
            ranges,
            floor,
            column: nearest,
            loads,
            poses: Vec::new(),
            assumptions,
        };
        space.poses = space.spread(options.candidates.max(options.poses), options.seed);
        if space.poses.len() < options.poses {
            return Err(Error::NoPlan(format!(
                "within these limits and above {:.0} mm there are only {} poses of {} asked for",
                floor * 1e3,
                space.poses.len(),
                options.poses
            )));
        }
        Ok(space)
    }

    /// Every pose with every load sequence, those of a pose after each other.
    pub fn visits(&self) -> Vec<Visit> {
        let with = |q: &Vec<f64>| {
            let q = q.clone();
            self.loads.iter().map(move |loads| Visit { q: q.clone(), loads: loads.clone() })
        };
        self.poses.iter().flat_map(with).collect()
    }

    /// Whether a pose is in the region.
    pub fn reaches(&self, q: &[f64]) -> bool {
        let point = tool_centre_point(&self.robot, q);
        // A campaign's own poses are in its region, rounding or not.
        height(&self.robot, &point) >= self.floor - 1e-9 && from_vertical(&self.robot, &point) >= self.column - 1e-9
    }

    /// Poses that fill the region evenly.
    fn spread(&self, count: usize, seed: u64) -> Vec<Vec<f64>> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let shift: Vec<f64> = self.ranges.iter().map(|_| random.random::<f64>()).collect();
        let pose = |index: usize| -> Vec<f64> {
            let coordinate = |(joint, &[low, high]): (usize, &[f64; 2])| {
                let share = (radical_inverse(index as u64, PRIMES[joint]) + shift[joint]).fract();
                low + (high - low) * share
            };
            self.ranges.iter().enumerate().map(coordinate).collect()
        };
        (1..=TRIES * count).map(pose).filter(|q| self.reaches(q)).take(count).collect()
    }
}

/// The digits of a number behind the point, in reverse.
fn radical_inverse(mut index: u64, base: u32) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0 / f64::from(base));
    while index > 0 {
        value += (index % u64::from(base)) as f64 * digit;
        index /= u64::from(base);
        digit /= f64::from(base);
    }
    value
}

/// So much of what the campaign ranged over is added on either side of it, and at least so much of
/// the limits.
const NEAR: f64 = 0.25;
const AT_LEAST: f64 = 0.1;

/// A joint's limits without a margin at either end, a share of the range between them.
fn within([low, high]: [f64; 2], margin: f64) -> [f64; 2] {
    let margin = margin * (high - low);
    [low + margin, high - margin]
}

fn ranges(campaign: &Campaign, visited: &[&[f64]], margin: f64, assumptions: &mut Vec<String>) -> Vec<[f64; 2]> {
    let mut without = Vec::new();
    let range = |(index, joint): (usize, &robstiff_robots::Joint)| {
        let seen = visited.iter().map(|q| q[index]);
        let seen = seen.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| [low.min(q), high.max(q)]);
        let Some(limits) = joint.limits else {
            let [low, high] = seen.map(|q| joint.for_people(q));
            without.push(format!("{} [{low:.0}, {high:.0}] {}", index + 1, joint.people_unit()));
            return seen;
        };
        let inside = within(limits, margin);
        let more = (NEAR * (seen[1] - seen[0])).max(AT_LEAST * (limits[1] - limits[0]));
        let near = [(seen[0] - more).max(inside[0]), (seen[1] + more).min(inside[1])];
        // A campaign may have been at a limit, or beyond it.
        if near[0] < near[1] { near } else { inside }
    };
    let ranges = campaign.robot.joints.iter().enumerate().map(range).collect();
    if without.len() < campaign.robot.joints.len() {
        assumptions.push(format!(
            "the joints stay near the campaign's range, and {} inside the limits of the description",
            percent(margin)
        ));
    }
    if !without.is_empty() {
        let joints = without.join(", ");
        assumptions.push(format!("joints without limits in the description stay in the campaign's range: {joints}"));
    }
    ranges
}

/// A margin as it is reported.
fn percent(margin: f64) -> String {
    format!("{} % of the range", (margin * 1e3).round() / 10.0)
}

/// A joint that turns and has no limits is not turned further than this either way (rad).
const WITHOUT_LIMITS: f64 = core::f64::consts::FRAC_PI_2;

/// The tool stays so far above the base and from its vertical, as shares of the farthest that it reaches:
/// an arm that folds up hits itself.
const LOW: f64 = 0.1;
const CLOSE: f64 = 0.25;

/// Poses looked at for how far the tool reaches.
const REACHES: usize = 200;

impl Space {
    /// The space of a robot of which nothing was measured, without loads.
    ///
    /// # Errors
    /// A joint that slides and has no limits; too few poses in the region.
    pub fn of_robot(robot: &Description, options: &Options) -> Result<Self, Error> {
        let mut assumptions = Vec::new();
        let (mut ranges, mut without) = (Vec::new(), Vec::new());
        for (number, joint) in (1..).zip(&robot.joints) {
            ranges.push(match (joint.limits, joint.kind) {
                (Some(limits), _) => within(limits, options.margin),
                (None, robstiff::JointKind::Revolute) => {
                    without.push(format!("{number}"));
                    [-WITHOUT_LIMITS, WITHOUT_LIMITS]
                }
                (None, robstiff::JointKind::Prismatic) => {
                    return Err(Error::NoPlan(format!(
                        "joint {number} slides and has no `limits` in the description: how far may it go?"
                    )));
                }
            });
        }
        if without.len() < robot.joints.len() {
            assumptions.push(format!("the joints stay {} inside their limits", percent(options.margin)));
        }
        if !without.is_empty() {
            assumptions.push(format!(
                "joints without limits in the description stay within 90 deg of zero: {}",
                without.join(", ")
            ));
        }
        let mut space = Self {
            robot: robot.clone(),
            ranges,
            floor: f64::NEG_INFINITY,
            column: 0.0,
            loads: Vec::new(),
            poses: Vec::new(),
            assumptions,
        };
        let reach = |q: &Vec<f64>| {
            let point = tool_centre_point(robot, q);
            from_vertical(robot, &point).hypot(height(robot, &point))
        };
        let reach = space.spread(REACHES, options.seed).iter().map(reach).fold(0.0, f64::max);
        space.floor = options.floor.unwrap_or(LOW * reach);
        space.column = CLOSE * reach;
        space.assumptions.push(format!(
            "the tool stays at least {:.0} mm above the base's origin and {:.0} mm from its vertical",
            space.floor * 1e3,
            space.column * 1e3
        ));
        // In whole degrees and millimetres, as people type them.
        let rounded =
            |q: Vec<f64>| -> Vec<f64> { q.iter().zip(&robot.joints).map(|(&q, joint)| whole(joint, q)).collect() };
        let inside = |q: &Vec<f64>| {
            let mut joints = q.iter().zip(&space.ranges);
            joints.all(|(q, [low, high])| (*low..=*high).contains(q)) && space.reaches(q)
        };
        let wanted = options.candidates.max(options.poses);
        let mut poses: Vec<Vec<f64>> = Vec::new();
        for q in space.spread(2 * wanted, options.seed).into_iter().map(rounded).filter(inside) {
            if poses.len() < wanted && !poses.contains(&q) {
                poses.push(q);
            }
        }
        if poses.len() < options.poses {
            return Err(Error::NoPlan(format!(
                "within these limits and above {:.0} mm there are only {} poses of {} asked for",
                space.floor * 1e3,
                poses.len(),
                options.poses
            )));
        }
        space.poses = poses;
        Ok(space)
    }
}

/// A coordinate in whole degrees or millimetres.
fn whole(joint: &robstiff_robots::Joint, q: f64) -> f64 {
    let unit = match joint.kind {
        robstiff::JointKind::Revolute => 1_f64.to_radians(),
        robstiff::JointKind::Prismatic => 1e-3,
    };
    (q / unit).round() * unit
}

/// Directions to pull in: along the axes, the diagonals of the faces and those of
/// the cube; downwards where there is a choice, as weights pull.
pub(super) fn directions() -> Vec<Vector3<f64>> {
    let mut found: Vec<Vector3<f64>> = Vec::new();
    for code in 0..27 {
        let direction = Vector3::from([code / 9, code / 3 % 3, code % 3].map(|digit: i32| f64::from(digit - 1)));
        let first = [-direction.z, direction.x, direction.y].into_iter().find(|value| *value != 0.0);
        if first.is_some_and(|value| value > 0.0) {
            found.push(direction.normalize());
        }
    }
    found
}

/// The load sequences that can be proposed.
fn loads(data: &Displacements, options: &Options, assumptions: &mut Vec<String>) -> Vec<Vec<[f64; 6]>> {
    let size = |part: &[f64]| part.iter().map(|value| value * value).sum::<f64>().sqrt();
    let most = |of: &dyn Fn(&[f64; 6]) -> f64| data.rows.iter().map(|row| of(&row.wrench)).fold(0.0, f64::max);
    let force = options.force.unwrap_or_else(|| most(&|wrench| size(&wrench[..3])));
    let moment = options.moment.unwrap_or_else(|| most(&|wrench| size(&wrench[3..])));
    let whose = |given: Option<f64>| if given.is_some() { "as asked for" } else { "the campaign's greatest" };
    assumptions.push(format!("forces of {force:.0} N, {}", whose(options.force)));
    if moment > 0.0 {
        assumptions.push(format!("moments of {moment:.0} Nm, {}", whose(options.moment)));
    }
    let ramp = ramp(data);
    let told: Vec<String> = ramp.iter().map(|share| format!("{:.0} %", share * 100.0)).collect();
    assumptions.push(format!("a visit loads to {}, with one unloaded reading, as the campaign does", told.join(", ")));
    let mut moments = std::vec![Vector3::zeros()];
    if moment > 0.0 {
        moments.extend((0..6).map(|k| Vector3::ith(k / 2, if k % 2 == 0 { moment } else { -moment })));
    }
    let directions = directions();
    let pulls = directions.iter().flat_map(|direction| moments.iter().map(move |moment| (direction * force, moment)));
    let loads = pulls.map(|(force, moment)| {
        let load = |share: &f64| {
            let (force, moment) = (force * *share, moment * *share);
            [force.x, force.y, force.z, moment.x, moment.y, moment.z]
        };
        ramp.iter().map(load).collect()
    });
    loads.collect()
}

/// The weights of the payloads of a visit, in the order of the campaign's usual one; where
/// it has no visits of several rows, of the least and the greatest.
fn payloads(data: &Positions, options: &Options, assumptions: &mut Vec<String>) -> Result<Vec<[f64; 6]>, Error> {
    let refused =
        |what: &str| Err(Error::NoPlan(format!("{what}, but payloads pull by their weight, as the campaign's do")));
    let greatest = data.rows.iter().map(|row| row.payload).fold(0.0, f64::max);
    if options.moment.is_some() {
        return refused("a greatest moment is given");
    }
    assumptions.push(String::from("the tracker sees the reflector at every pose, and stays where it is"));
    if greatest == 0.0 {
        if options.force.is_some() {
            return refused("a greatest force is given, and these positions have no payload");
        }
        assumptions.push(String::from("there is no payload, as in the campaign"));
        return Ok(std::vec![[0.0; 6]]);
    }
    let most = options.force.map_or(greatest, |force| force / GRAVITY);
    let visit = usual(data.rows.iter().map(|row| row.visit));
    let usual: Vec<f64> = data.rows.iter().filter(|row| row.visit == visit).map(|row| row.payload).collect();
    let least = data.rows.iter().map(|row| row.payload).fold(greatest, f64::min);
    let payloads = match usual.len() {
        0 | 1 if least < greatest => std::vec![least, greatest],
        0 | 1 => std::vec![greatest],
        _ => usual,
    };
    let payloads: Vec<f64> = payloads.into_iter().map(|payload| payload * most / greatest).collect();
    let told: Vec<String> = payloads.iter().map(|payload| format!("{payload:.0} kg")).collect();
    let whose = if options.force.is_some() { "the greatest of the weight asked for" } else { "as the campaign's" };
    assumptions.push(format!("a visit has payloads of {}, {whose}", told.join(", ")));
    Ok(payloads.into_iter().map(|payload| [0.0, 0.0, -GRAVITY * payload, 0.0, 0.0, 0.0]).collect())
}

/// The first visit of the most common length, by the visits of all rows in order.
fn usual(of_rows: impl Iterator<Item = usize>) -> usize {
    let mut lengths: Vec<usize> = Vec::new();
    for visit in of_rows {
        lengths.resize(lengths.len().max(visit + 1), 0);
        lengths[visit] += 1;
    }
    let mut common: BTreeMap<usize, usize> = BTreeMap::new();
    for length in &lengths {
        *common.entry(*length).or_default() += 1;
    }
    let usual = common.into_iter().max_by_key(|&(length, count)| (count, length)).map_or(1, |(length, _)| length);
    lengths.iter().position(|length| *length == usual).unwrap_or(0)
}

/// The loads of the campaign's usual visit as shares of its greatest.
fn ramp(data: &Displacements) -> Vec<f64> {
    let visit = usual(data.rows.iter().map(|row| row.visit));
    let of = |visit: usize| data.rows.iter().filter(move |row| row.visit == visit);
    let dot = |a: &[f64; 6], b: &[f64; 6]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let greatest = of(visit).map(|row| row.wrench).max_by(|a, b| dot(a, a).total_cmp(&dot(b, b)));
    let Some(greatest) = greatest.filter(|greatest| dot(greatest, greatest) > 0.0) else { return std::vec![1.0] };
    // Sequences that turn as they grow count by what they have along the greatest.
    of(visit).map(|row| dot(&row.wrench, &greatest) / dot(&greatest, &greatest)).collect()
}

fn tool_centre_point(robot: &Description, q: &[f64]) -> Vector3<f64> {
    Arm::of(robot).stand(q, &[]).tcp.at
}

fn height(robot: &Description, point: &Vector3<f64>) -> f64 {
    point.z - robot.base.xyz[2]
}

fn from_vertical(robot: &Description, point: &Vector3<f64>) -> f64 {
    let [x, y, _] = robot.base.xyz;
    (point.x - x).hypot(point.y - y)
}
