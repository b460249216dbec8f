//! The force of a cut along a path.

use nalgebra::{Matrix3, Unit, Vector3, Vector6};

use super::{Contact, Load, Surface, width};
use crate::milling::{Cut, CutFrame, Direction, Engagement, Forces};
use crate::path::{PathPoint, SolvedPath};

/// Width and depth change by this share of themselves for the slope of the force.
const CHANGE: f64 = 1e-4;

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
    load(forces, path, (axis, surface), |_| None)
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
    load(forces, path, (axis, surface), |point| {
        let Forces::Model(cut) = forces else { return None };
        let speed = point.spindle.map(f64::abs).filter(|speed| *speed > 0.0).or(cut.speed)?;
        Some(point.feed? * core::f64::consts::TAU / (speed * cut.mill.teeth as f64))
    })
}

/// `feed_per_tooth` is that of a point (m), where it is not the cut's.
fn load<const N: usize>(
    forces: &Forces,
    path: &SolvedPath<N>,
    (axis, surface): (Unit<Vector3<f64>>, Surface),
    feed_per_tooth: impl Fn(&PathPoint<N>) -> Option<f64>,
) -> Load {
    let wall = match forces {
        Forces::Model(cut) => cut.engagement.wall().unwrap_or(1.0),
        Forces::Measured { .. } => 1.0,
    };
    let of = |feed: Option<f64>| match (forces, feed) {
        (Forces::Model(cut), Some(feed_per_tooth)) => {
            let cut = Cut { feed_per_tooth, ..cut.clone() };
            (cut.mean_force(), response(&cut))
        }
        (Forces::Model(cut), None) => (cut.mean_force(), response(cut)),
        (Forces::Measured { .. }, _) => (forces.mean(), Matrix3::zeros()),
    };
    // Neighbours mostly have the same feed.
    let mut last = (None, of(None));
    let mut undirected: Vec<usize> = Vec::new();
    let contacts = path.points.iter().map(|point| {
        let mut contact = contact(point, axis, surface, wall);
        if point.rapid {
            return contact;
        }
        let Some(turn) = forces.to_base(contact.frame.as_ref(), &rotation(point)) else {
            if undirected.last() != Some(&point.line) {
                undirected.push(point.line);
            }
            return contact;
        };
        let feed = feed_per_tooth(point);
        if last.0 != feed {
            last = (feed, of(feed));
        }
        let (mean, response) = last.1;
        let force = turn * mean;
        contact.wrench = Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
        contact.response = turn * response * turn.transpose();
        contact.turn = turn;
        contact
    });
    let contacts = contacts.collect();
    Load { contacts, revolution: Vec::new(), undirected }
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
