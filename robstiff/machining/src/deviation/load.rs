//! The force of a cut along a path.

use std::sync::Arc;

use nalgebra::{Matrix3, Unit, Vector3, Vector6};

use super::{Contact, Load, Revolutions, Surface, width};
use crate::engagement::{Bite, Met, Sector, Stretch, Survey};
use crate::milling::{Cut, CutFrame, Direction, Engagement, Forces};
use crate::path::follow::MOST_SHOWN;
use crate::path::{PathPoint, SolvedPath, ToolPath, Waypoint};
use crate::stability::along::Cutting;
use robstiff_robots::Diagnostics;

/// Width and depth change by this share of themselves for the slope of the force.
const CHANGE: f64 = 1e-4;

/// A width is the tool's within this part of it.
const ROUNDING: f64 = 1e-9;

/// What cuts along a path.
///
/// What the tool meets at a point is that of the way to it: from the stock, where there is a survey of it and the tool's
/// axis is along that one's z; else as the path says it (`ae`, `ap`); else as the cut says it. Nothing
/// acts in rapids and in the air. A survey leaves tilted segments for which the path says nothing without a
/// force.
#[derive(Clone, Copy, Debug)]
pub struct Operation<'c> {
    /// The force of tools that are not among the others.
    pub forces: &'c Forces,
    /// The forces of others by the number of the tool.
    pub tools: &'c [(u32, Forces)],
    /// Whether a tooth takes the feed that the path has, in place of the cut's: over the teeth that pass in its time, by the
    /// path's spindle speed or where that is unknown or 0 the cut's.
    pub at_feeds: bool,
    /// What is met, segment by segment.
    pub survey: Option<&'c Survey>,
    /// So many angles of a revolution count, and those at which an arc begins or ends; `None` for
    /// the mean alone.
    pub angles: Option<usize>,
}

/// What a cut pushes the tool with at every point of a path: the mean force, turned
/// by feed and tool axis, or as recorded along the axes of the base's or the TCP's
/// frame; nothing in rapids. `axis` is that of the tool in the TCP's frame, from the spindle to the
/// tip.
///
/// The force of the model follows a displacement across the wall (which changes
/// the width) and along the axis (which changes the depth); a measured one stays.
pub fn load_of_cut<const N: usize>(
    forces: &Forces,
    path: &SolvedPath<N>,
    axis: Unit<Vector3<f64>>,
    surface: Surface,
) -> Load {
    Operation { forces, tools: &[], at_feeds: false, survey: None, angles: None }.load(path, axis, surface)
}

/// The same with the feed that the path has at every point, in place of the cut's: a tooth takes
/// the feed over the teeth that pass in its time, by the path's spindle speed or where that is
/// unknown or 0 the cut's. Measured forces stay as they are.
pub fn load_at_feeds<const N: usize>(
    forces: &Forces,
    path: &SolvedPath<N>,
    axis: Unit<Vector3<f64>>,
    surface: Surface,
) -> Load {
    Operation { forces, tools: &[], at_feeds: true, survey: None, angles: None }.load(path, axis, surface)
}

/// What is met on the way to a point.
enum At<'s> {
    Air,
    /// Nobody knows the direction: a plunge.
    Undirected,
    /// What the cut says.
    OfCut,
    /// These stretches of a length (m).
    Stretches(&'s [Stretch], f64),
    /// This.
    Given(Bite),
}

/// What acts at a point, along the axes of its force.
#[derive(Clone, Copy)]
struct Acting {
    mean: Vector3<f64>,
    response: Matrix3<f64>,
    wall: f64,
}

impl Operation<'_> {
    /// What it pushes the tool with at every point of a path, as [`load_of_cut`].
    ///
    /// # Panics
    /// If the survey has another number of segments than the path has points.
    pub fn load<const N: usize>(&self, path: &SolvedPath<N>, axis: Unit<Vector3<f64>>, surface: Surface) -> Load {
        let count = path.points.len();
        assert!(self.survey.is_none_or(|survey| survey.segments.len() == count), "a segment for every point");
        // Neighbours mostly have the same feed, and the same cut.
        let mut last: Option<(*const Forces, Option<f64>, Acting)> = None;
        let mut undirected: Vec<usize> = Vec::new();
        let mut met = Vec::new();
        let contacts = path.points.iter().enumerate().map(|(i, point)| {
            let forces = self.forces_of(point.tool);
            let wall_of_cut = match forces {
                Forces::Model(cut) => cut.engagement.wall().unwrap_or(1.0),
                Forces::Measured { .. } => 1.0,
            };
            let idle = contact(point, axis, surface, wall_of_cut);
            let at = self.met(i, point, forces);
            if self.angles.is_some() {
                met.push(None);
            }
            if point.rapid || matches!(at, At::Air) {
                return idle;
            }
            let turn = forces.to_base(idle.frame.as_ref(), &rotation(point));
            let Some(turn) = turn.filter(|_| !matches!(at, At::Undirected)) else {
                if undirected.last() != Some(&point.line) {
                    undirected.push(point.line);
                }
                return idle;
            };
            let acting = match (forces, &at) {
                (Forces::Measured { .. }, _) => {
                    Acting { mean: forces.mean(), response: Matrix3::zeros(), wall: wall_of_cut }
                }
                (Forces::Model(cut), At::OfCut) => {
                    let (feed, key) = (self.feed_per_tooth(cut, point), core::ptr::from_ref(forces));
                    let known = last.filter(|(of, at, _)| *of == key && *at == feed).map(|(.., acting)| acting);
                    let acting = known.unwrap_or_else(|| {
                        let cut = with_feed(cut, feed);
                        Acting { mean: cut.mean_force(), response: response(&cut), wall: wall_of_cut }
                    });
                    last = Some((key, feed, acting));
                    acting
                }
                (Forces::Model(cut), _) => {
                    let cut = with_feed(cut, self.feed_per_tooth(cut, point));
                    acting(&cut, &at, wall_of_cut)
                }
            };
            if let (Some(last), Forces::Model(cut)) = (met.last_mut(), forces) {
                let cut = with_feed(cut, self.feed_per_tooth(cut, point));
                *last = worst(&cut, &at).map(|bite| (cut, bite));
            }
            let mut contact = contact(point, axis, surface, acting.wall);
            let force = turn * acting.mean;
            contact.wrench = Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
            contact.response = turn * acting.response * turn.transpose();
            contact.turn = turn;
            contact
        });
        let contacts = contacts.collect();
        let revolution = match self.angles {
            Some(angles) => Revolutions::Each { met, angles },
            None => Revolutions::None,
        };
        Load { contacts, revolution, undirected }
    }

    /// Holds the widths that a path gives against the tools.
    ///
    /// # Errors
    /// The points at which a cut would be wider than its tool, or on no side of it.
    pub fn check(&self, path: &ToolPath) -> Result<(), Diagnostics> {
        let problem = |point: &Waypoint| {
            let Forces::Model(cut) = self.forces_of(point.tool) else { return None };
            let (width, diameter) = (point.width?, cut.mill.diameter);
            let mm = |length: f64| 1e3 * length;
            if width > diameter * (1.0 + ROUNDING) {
                let message = format!("a cut of {} mm is wider than its tool, {} mm", mm(width), mm(diameter));
                return Some(path.diagnostic(
                    point.line,
                    message,
                    "`ae` is the radial width of the cut, at most the diameter",
                ));
            }
            let is_one_sided = width > 0.0 && width < diameter * (1.0 - ROUNDING);
            (is_one_sided && cut.engagement.wall().is_none()).then(|| {
                let message = format!("nobody knows on which side the tool cuts {} mm", mm(width));
                path.diagnostic(
                    point.line,
                    message,
                    "write `milling: up` or `milling: down` and a `width` in the cut's file",
                )
            })
        };
        let problems = path.points.iter().filter(|point| !point.rapid).filter_map(problem);
        Diagnostics::new(problems.take(MOST_SHOWN).collect()).map_or(Ok(()), Err)
    }

    /// How fast the tool goes to a point (m/s), where that is known.
    pub fn feed_speed<const N: usize>(&self, point: &PathPoint<N>) -> Option<f64> {
        let of_cut = match self.forces_of(point.tool) {
            Forces::Model(cut) => cut.feed_speed(),
            Forces::Measured { .. } => None,
        };
        point.feed.filter(|_| self.at_feeds).or(of_cut)
    }

    /// What is cut along a path, where the model says it and somebody knows the speed of the spindle: at each point
    /// what is met where the mean force is largest on the way there.
    pub fn cutting<const N: usize>(&self, path: &SolvedPath<N>, axis: Unit<Vector3<f64>>) -> Vec<Cutting<N>> {
        let mut before = None;
        let cutting = path.points.iter().enumerate().filter_map(|(i, point)| {
            let length = before.replace(point.s).map_or(0.0, |before| point.s - before);
            let forces = self.forces_of(point.tool);
            let Forces::Model(cut) = forces else { return None };
            let at = self.met(i, point, forces);
            if point.rapid || matches!(at, At::Air | At::Undirected) {
                return None;
            }
            let speed = point.spindle.map(f64::abs).filter(|speed| *speed > 0.0).or(cut.speed)?;
            let cut = with_feed(cut, self.feed_per_tooth(cut, point));
            let bite = worst(&cut, &at)?;
            let frame = contact(point, axis, Surface::Side, 1.0).frame?;
            let of_sector = |sector: &Sector| Cut { engagement: sector.engagement, depth: sector.depth, ..cut.clone() };
            let cuts: Vec<Cut> = bite.sectors.iter().map(of_sector).collect();
            (!cuts.is_empty()).then_some(Cutting { point: i, q: point.q, frame, cuts, speed, length })
        });
        cutting.collect()
    }

    fn forces_of(&self, tool: Option<u32>) -> &Forces {
        let of_tool = tool.and_then(|tool| self.tools.iter().find(|(number, _)| *number == tool));
        of_tool.map_or(self.forces, |(_, forces)| forces)
    }

    fn met<const N: usize>(&self, i: usize, point: &PathPoint<N>, forces: &Forces) -> At<'_> {
        let given = match forces {
            Forces::Model(cut) => given(point, cut),
            Forces::Measured { .. } => None,
        };
        let Some(segment) = self.survey.map(|survey| &survey.segments[i]) else { return given.unwrap_or(At::OfCut) };
        match (&segment.met, forces) {
            (Met::Air | Met::Collision, _) => At::Air,
            // A record has its force whatever it was that it cut.
            (_, Forces::Measured { .. }) => At::OfCut,
            (Met::Tilted, Forces::Model(_)) => given.unwrap_or(At::Air),
            (Met::Plunge, Forces::Model(_)) => At::Undirected,
            (Met::Cut(stretches), Forces::Model(_)) => At::Stretches(stretches, segment.length),
        }
    }

    /// The feed of a tooth at a point (m), where it is not the cut's.
    fn feed_per_tooth<const N: usize>(&self, cut: &Cut, point: &PathPoint<N>) -> Option<f64> {
        let feed = point.feed.filter(|_| self.at_feeds)?;
        let speed = point.spindle.map(f64::abs).filter(|speed| *speed > 0.0).or(cut.speed)?;
        Some(feed * core::f64::consts::TAU / (speed * cut.mill.teeth as f64))
    }
}

fn with_feed(cut: &Cut, feed_per_tooth: Option<f64>) -> Cut {
    Cut { feed_per_tooth: feed_per_tooth.unwrap_or(cut.feed_per_tooth), ..cut.clone() }
}

/// What the path says is met at a point, where it does.
fn given<const N: usize>(point: &PathPoint<N>, cut: &Cut) -> Option<At<'static>> {
    if point.width.is_none() && point.depth.is_none() {
        return None;
    }
    let (depth, diameter) = (point.depth.unwrap_or(cut.depth), cut.mill.diameter);
    if depth <= 0.0 || point.width.is_some_and(|width| width <= 0.0) {
        return Some(At::Air);
    }
    let direction = if cut.engagement.wall() == Some(1.0) { Direction::Up } else { Direction::Down };
    let engagement = match point.width {
        Some(width) => Engagement::of_width(direction, width.min(diameter), diameter)?,
        None => cut.engagement,
    };
    Some(At::Given(Bite::of_engagement(engagement, depth, diameter)))
}

/// The mean over what is met.
fn acting(cut: &Cut, at: &At<'_>, wall: f64) -> Acting {
    let step = |bite: &Bite| CHANGE * bite.width.min(bite.depth);
    let of = |bite: &Bite| (bite.mean_force(cut), Matrix3::from_columns(&bite.response(cut, step(bite))));
    match at {
        At::Given(bite) => {
            let (mean, response) = of(bite);
            Acting { mean, response, wall: bite.wall().unwrap_or(1.0) }
        }
        At::Stretches(stretches, length) => {
            let (mut mean, mut response) = (Vector3::zeros(), Matrix3::zeros());
            // The side of the wall on most of the way.
            let mut sides = 0.0;
            for Stretch { length: part, bite } in *stretches {
                let (force, slope) = of(bite);
                let share = part / length;
                (mean, response) = (mean + force * share, response + slope * share);
                sides += bite.wall().unwrap_or(0.0) * part;
            }
            Acting { mean, response, wall: if sides < 0.0 { -1.0 } else { 1.0 } }
        }
        At::Air | At::Undirected | At::OfCut => Acting { mean: cut.mean_force(), response: response(cut), wall },
    }
}

/// What is met where the mean force is largest.
fn worst(cut: &Cut, at: &At<'_>) -> Option<Arc<Bite>> {
    match at {
        At::Given(bite) => Some(Arc::new(bite.clone())),
        At::Stretches(stretches, _) => {
            let force = |stretch: &&Stretch| stretch.bite.mean_force(cut).norm();
            let worst = stretches.iter().max_by(|one, other| force(one).total_cmp(&force(other)));
            worst.map(|stretch| Arc::clone(&stretch.bite))
        }
        At::OfCut => Some(Arc::new(Bite::of_engagement(cut.engagement, cut.depth, cut.mill.diameter))),
        At::Air | At::Undirected => None,
    }
}

/// A contact without a force.
pub(super) fn contact<const N: usize>(
    point: &PathPoint<N>,
    axis: Unit<Vector3<f64>>,
    surface: Surface,
    wall: f64,
) -> Contact {
    let axis = rotation(point) * axis.into_inner();
    let frame = point.tangent.and_then(|feed| CutFrame::new(&axis, &feed));
    let into = match surface {
        Surface::Side => frame.map(|frame| frame.normal * wall),
        Surface::Face => Some(axis),
    };
    Contact { wrench: Vector6::zeros(), response: Matrix3::zeros(), frame, into, turn: Matrix3::identity() }
}

pub(super) fn rotation<const N: usize>(point: &PathPoint<N>) -> Matrix3<f64> {
    point.pose.fixed_view::<3, 3>(0, 0).into_owned()
}

/// What a displacement along feed, normal and axis adds to the mean force along
/// these (N/m), by central differences of the model.
fn response(cut: &Cut) -> Matrix3<f64> {
    let slope = |step: f64, at: &dyn Fn(f64) -> Option<Cut>| {
        let forces = at(step).zip(at(-step)).map(|(more, less)| more.mean_force() - less.mean_force());
        forces.map_or_else(Vector3::zeros, |change| change / (2.0 * step))
    };
    let (width, depth) = (width(cut), cut.depth);
    let across = cut.engagement.wall().map_or_else(Vector3::zeros, |wall| {
        let direction = if wall > 0.0 { Direction::Up } else { Direction::Down };
        let wider = |by: f64| {
            let engagement = Engagement::of_width(direction, width + by, cut.mill.diameter)?;
            Some(Cut { engagement, ..cut.clone() })
        };
        slope(width * CHANGE, &wider) * wall
    });
    let along = slope(depth * CHANGE, &|by| Some(Cut { depth: depth + by, ..cut.clone() }));
    Matrix3::from_columns(&[Vector3::zeros(), across, along])
}
