//! Faults of the rig, as absolute positions show them.

use std::boxed::Box;
use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;
use robstiff_robots::{Description, Placement};

use super::offers::{Form, Number, Offer, any};
use crate::campaign::Positions;
use crate::identify::positions::model::{Enters, LENGTH_STEP, Model, Moved, Seen};
use crate::trace::catalogue::{Kind, LEVER_ARM, POINT, REFLECTOR_OFFSET, TRACKER_SCALE};
use crate::trace::found::Place;

/// The step of central differences of where a payload hangs (m), by which a deflection
/// goes in proportion.
const LEVER_STEP: f64 = 1e-2;

/// Neither a reflector nor a payload is farther off (m).
const FARTHEST: f64 = 0.5;

/// No slip or drift is longer (m).
pub const LONGEST: f64 = 0.1;

/// More than this is another unit and no scale: a tracker reads to some millionths, and an arm
/// forty kelvin warmer than its table, of aluminium, is longer by this much (1).
const MOST_SCALE: f64 = 1e-3;

/// The point that is read is elsewhere on the tool, along one of its axes or anywhere.
pub fn reflector() -> Offer {
    elsewhere(&REFLECTOR_OFFSET, LENGTH_STEP, |model, k, by| model.marker[k] += by)
}

/// The payload hangs elsewhere on the tool, likewise.
pub fn lever_arm() -> Offer {
    elsewhere(&LEVER_ARM, LEVER_STEP, |model, k, by| model.hook[k] += by)
}

/// A point of the tool is elsewhere; `moves` moves it along an axis.
fn elsewhere(kind: &'static Kind, step: f64, moves: fn(&mut Model, usize, f64)) -> Offer {
    let number = |k: usize| Number {
        name: POINT[k],
        unit: "m",
        range: [-FARTHEST, FARTHEST],
        enters: Enters::Model(Rc::new(move |model: &mut Model, by| moves(model, k, by)), step),
    };
    Offer {
        kind,
        place: Place::Rig,
        numbers: (0..3).map(number).collect(),
        forms: [0..1, 1..2, 2..3, 0..3].map(Form::of).into(),
        possible: any(),
    }
}

/// A unit makes lengths longer, by such a share in each row. Of what is read later the
/// whole length is taken for one of them.
pub fn longer(lengths: &[Vector3<f64>], by_row: &[f64]) -> Enters {
    let last = by_row.last().copied().unwrap_or_default();
    let rows = lengths.iter().zip(by_row).map(|(length, by)| length * *by).collect();
    Enters::Reading(Rc::new(Moved { rows, later: Box::new(move |seen| seen.point * last) }))
}

/// What moves the readings of a campaign, whatever the robot does.
pub struct Rig {
    /// What is read, as the arm as described has it.
    pub seen: Vec<Seen>,
    /// From frame 0 to the flange, the arm's own lengths, in the base frame (m).
    pub spans: Rc<[Vector3<f64>]>,
}

impl Rig {
    /// The rows of a campaign.
    pub fn new(robot: &Description, data: &Positions) -> Self {
        let bare = Description { tool: Placement::default(), ..robot.clone() };
        let foot = Vector3::from(robot.base.xyz);
        let at_flange = Model { marker: Vector3::zeros(), ..Model::new(&bare, data) };
        let spans = at_flange.points(data).into_iter().map(|flange| flange - foot).collect();
        Self { seen: Model::new(robot, data).seen(data), spans }
    }

    /// All lengths are read by the same share too long. From where does not matter, for
    /// where the robot stands is fitted.
    pub fn scale(&self) -> Offer {
        let lengths: Vec<Vector3<f64>> = self.seen.iter().map(|seen| seen.point).collect();
        let enters = longer(&lengths, &vec![1.0; lengths.len()]);
        Offer {
            kind: &TRACKER_SCALE,
            place: Place::Rig,
            numbers: vec![Number { name: "scale", unit: "1", range: [-MOST_SCALE, MOST_SCALE], enters }],
            forms: vec![Form::of([0])],
            possible: any(),
        }
    }
}
