//! Faults of the rig, as absolute positions show them.

use std::boxed::Box;
use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;
use robstiff_robots::effect::Place as Part;
use robstiff_robots::{Description, Placement};

use super::offers::{Form, LENGTH_STEP, Number, Offer, any, kind};
use crate::campaign::Positions;
use crate::identify::positions::model::{Enters, LaterMoved, Model, Moved};
use crate::trace::found::{EffectParameter, Place};

/// A reflector is not farther off (m), nor a slip or a drift longer (m) or a slip
/// turned more (rad).
const FARTHEST: f64 = 0.5;
pub const LONGEST: f64 = 0.1;
const MOST_TURNED: f64 = 0.05;

/// More than this is another unit and no scale (1).
const MOST_SCALE: f64 = 0.01;

/// Moments at which the robot may have slipped are tried before every row, or where
/// there are more, so many evenly; of large campaigns, few, for every moment takes memory
/// by the rows. One that is named is then looked for between the others.
const FEWEST_MOMENTS: usize = 24;
const MOST_MOMENTS: usize = 200;
const ROWS_AND_MOMENTS: usize = 100_000;

const POINT: [&str; 3] = ["x", "y", "z"];
pub const SHIFT: [&str; 3] = ["dx", "dy", "dz"];
const TURN: [&str; 3] = ["rx", "ry", "rz"];

/// The point that is read is elsewhere on the tool, along one of its axes or anywhere.
pub fn reflector() -> Offer {
    let number = |k: usize| Number {
        name: POINT[k],
        unit: "m",
        range: [-FARTHEST, FARTHEST],
        enters: Enters::Model(Rc::new(move |model: &mut Model, by| model.marker[k] += by), LENGTH_STEP),
    };
    Offer {
        kind: kind("reflector_offset"),
        place: Place::Rig,
        numbers: (0..3).map(number).collect(),
        forms: [0..1, 1..2, 2..3, 0..3].map(Form::of).into(),
        possible: any,
    }
}

/// A unit makes lengths longer, by such a share in each row. Of what is read later the
/// whole length is taken for one of them.
pub fn longer(lengths: &[Vector3<f64>], by_row: &[f64]) -> Enters {
    let last = by_row.last().copied().unwrap_or_default();
    let rows = lengths.iter().zip(by_row).map(|(length, by)| length * *by).collect();
    Enters::Reading(Rc::new(Moved { rows, later: Box::new(move |point| point * last) }))
}

/// What moves the readings of a campaign, whatever the robot does.
pub struct Rig {
    /// The point that is read, in the base frame (m), and the middle of all.
    points: Vec<Vector3<f64>>,
    middle: Vector3<f64>,
    /// From frame 0 to the flange, the arm's own lengths, in the base frame (m).
    pub spans: Rc<[Vector3<f64>]>,
}

impl Rig {
    /// The rows of a campaign.
    pub fn new(robot: &Description, data: &Positions) -> Self {
        let points = Model::new(robot, data).points(data);
        let middle = points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
        let bare = Description { tool: Placement::default(), ..robot.clone() };
        let foot = Vector3::from(robot.base.xyz);
        let at_flange = Model { description: bare, marker: Vector3::zeros() };
        let spans = at_flange.points(data).into_iter().map(|flange| flange - foot).collect();
        Self { points, middle, spans }
    }

    /// All lengths are read by the same share too long. From where does not matter, for
    /// where the robot stands is fitted.
    pub fn scale(&self) -> Offer {
        let enters = longer(&self.points, &vec![1.0; self.points.len()]);
        Offer {
            kind: kind("tracker_scale"),
            place: Place::Rig,
            numbers: vec![Number { name: "scale", unit: "1", range: [-MOST_SCALE, MOST_SCALE], enters }],
            forms: vec![Form::of([0])],
            possible: any,
        }
    }

    /// How many rows the moments that are tried for a slip are apart.
    pub fn apart(&self) -> usize {
        let rows = self.points.len().max(1);
        rows.div_ceil((ROWS_AND_MOMENTS / rows).clamp(FEWEST_MOMENTS, MOST_MOMENTS))
    }

    /// What a shift along each axis, and a turn about each, do to the rows from one on.
    pub fn at_row(&self, moment: usize) -> [Enters; 6] {
        let from_then_on = |later: LaterMoved| {
            let of = |(row, point)| if row < moment { Vector3::zeros() } else { later(point) };
            let rows = self.points.iter().enumerate().map(of).collect();
            Enters::Reading(Rc::new(Moved { rows, later }))
        };
        let middle = self.middle;
        core::array::from_fn(|k| {
            let axis = Vector3::ith(k % 3, 1.0);
            match k < 3 {
                true => from_then_on(Box::new(move |_| axis)),
                false => from_then_on(Box::new(move |point| axis.cross(&(point - middle)))),
            }
        })
    }

    /// The robot shifted at a moment, and may have turned as well.
    pub fn slip(&self, data: &Positions) -> Option<Offer> {
        let (mut numbers, mut forms) = (Vec::new(), Vec::new());
        for moment in (1..self.points.len()).step_by(self.apart()) {
            let first = numbers.len();
            let named = SHIFT.into_iter().chain(TURN).zip(self.at_row(moment));
            numbers.extend(named.enumerate().map(|(k, (name, enters))| {
                let (unit, most) = if k < 3 { ("m", LONGEST) } else { ("rad", MOST_TURNED) };
                Number { name, unit, range: [-most, most], enters }
            }));
            for count in [3, 6] {
                forms.push(Form { shape: vec![line(data, moment)], ..Form::of(first..first + count) });
            }
        }
        let (kind, place) = (kind(SLIP), Part::Base.into());
        (!forms.is_empty()).then_some(Offer { kind, place, numbers, forms, possible: any })
    }
}

/// The kind of a slip.
pub const SLIP: &str = "base_slip";

/// The number by which a slip says when it was.
pub const SLIPPED_AT: &str = "line";

/// How a slip says when it was.
pub fn line(data: &Positions, moment: usize) -> EffectParameter {
    EffectParameter { name: SLIPPED_AT, value: data.rows[moment].line as f64, std: None, unit: "1" }
}
