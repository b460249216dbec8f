//! Slips: at some moment the robot, or what reads it, moved on its mount, or the reflector
//! on the tool, and stayed there.

use std::boxed::Box;
use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use nalgebra::Vector3;
use robstiff_robots::effect::Place as Part;

use super::offers::{Form, Number, Offer, any};
use super::rig::{LONGEST, Rig};
use crate::campaign::Positions;
use crate::identify::positions::model::{Enters, LaterMoved, Moved, Seen};
use crate::trace::catalogue::{POINT, SHIFT, TURN};
use crate::trace::found::{EffectParameter, Place};
use crate::trace::slip::{SLIPPED_AT, Slipping};

/// A slip does not turn more (rad).
const MOST_TURNED: f64 = 0.05;

/// Moments are tried before every row, or where there are more, so many evenly; of large
/// campaigns, few, for every moment takes memory by the rows. One that is named is then
/// looked for between the others.
const FEWEST_MOMENTS: usize = 24;
const MOST_MOMENTS: usize = 200;
const ROWS_AND_MOMENTS: usize = 100_000;

/// A reflector sits elsewhere from this row on, or from a later one: one that slipped before is
/// one that is elsewhere, and a few rows beside it that may be wild. Where the robot stands is
/// fitted, so a base that slipped then is nothing but such rows.
const FIRST_OF_REFLECTOR: usize = 4;

/// How a slip says when it was.
pub fn line(data: &Positions, moment: usize) -> EffectParameter {
    EffectParameter { name: SLIPPED_AT, value: data.rows[moment].line as f64, std: None, unit: "1" }
}

/// The first row that a slip may be before.
pub fn first_moment(slipping: Slipping) -> usize {
    match slipping {
        Slipping::Base => 1,
        Slipping::Reflector => FIRST_OF_REFLECTOR,
    }
}

impl Rig {
    /// How many rows the moments that are tried are apart.
    pub fn apart(&self) -> usize {
        let rows = self.seen.len().max(1);
        rows.div_ceil((ROWS_AND_MOMENTS / rows).clamp(FEWEST_MOMENTS, MOST_MOMENTS))
    }

    /// What the numbers of a slip do to the rows from one on.
    pub fn slipped(&self, slipping: Slipping, moment: usize) -> Vec<Enters> {
        let from_then_on = |later: LaterMoved| {
            let of = |(row, seen)| if row < moment { Vector3::zeros() } else { later(seen) };
            let rows = self.seen.iter().enumerate().map(of).collect();
            Enters::Reading(Rc::new(Moved { rows, later }))
        };
        let axes = || (0..3).map(|k| Vector3::<f64>::ith(k, 1.0));
        if slipping == Slipping::Reflector {
            return axes().map(|axis| from_then_on(Box::new(move |seen| seen.tool * axis))).collect();
        }
        let middle = self.seen.iter().map(|seen| seen.point).sum::<Vector3<f64>>() / self.seen.len().max(1) as f64;
        let shift = |axis: Vector3<f64>| from_then_on(Box::new(move |_: &Seen| axis));
        let turn = |axis: Vector3<f64>| from_then_on(Box::new(move |seen| axis.cross(&(seen.point - middle))));
        axes().map(shift).chain(axes().map(turn)).collect()
    }

    /// The robot shifted at a moment, and may have turned as well.
    pub fn slip_of_base(&self, data: &Positions) -> Option<Offer> {
        self.slip(data, Slipping::Base, Part::Base.into(), &[SHIFT, TURN])
    }

    /// The reflector shifted on the tool at a moment.
    pub fn slip_of_reflector(&self, data: &Positions) -> Option<Offer> {
        self.slip(data, Slipping::Reflector, Place::Rig, &[POINT])
    }

    /// A slip with shifts, and turns if it has names for them.
    fn slip(&self, data: &Positions, of: Slipping, place: Place, names: &[[&'static str; 3]]) -> Option<Offer> {
        let units = [("m", LONGEST), ("rad", MOST_TURNED)];
        let (mut numbers, mut forms) = (Vec::new(), Vec::new());
        for moment in (first_moment(of)..self.seen.len()).step_by(self.apart()) {
            let first = numbers.len();
            let named = names.iter().zip(units).flat_map(|(names, unit)| names.map(|name| (name, unit)));
            numbers.extend(named.zip(self.slipped(of, moment)).map(|((name, (unit, most)), enters)| Number {
                name,
                unit,
                range: [-most, most],
                enters,
            }));
            for count in (1..=names.len()).map(|count| 3 * count) {
                forms.push(Form { shape: vec![line(data, moment)], ..Form::of(first..first + count) });
            }
        }
        (!forms.is_empty()).then_some(Offer { kind: of.kind(), place, numbers, forms, possible: any() })
    }
}
