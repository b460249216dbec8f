//! A map's summary as JSON, and for a terminal.

use robstiff::nalgebra::Isometry3;
use robstiff_machining::map::{Axis, Column, Extreme, Measure, Summary, WorkpiecePlace, people};
use robstiff_robots::quantity::Dimension;
use serde_json::{Map, Value, json};

use super::table::{Counter, heading};
use crate::json;
use crate::text::{Table, capital, count, significant};

/// What a map came to, with all that is needed to say it.
pub struct Mapped {
    /// The robot's name.
    pub robot: String,
    /// The axes of the map.
    pub axes: Vec<Axis>,
    /// What was computed.
    pub measure: Measure,
    /// The columns.
    pub columns: Vec<Column>,
    /// The result.
    pub summary: Summary,
    /// Where a workpiece is best put, where that was asked.
    pub placements: Vec<Placed>,
    /// The frame of the positions in the base frame, where they have one of their own.
    pub frame: Option<Isometry3<f64>>,
}

/// The best place for a workpiece.
pub struct Placed {
    /// Its size (m).
    pub size: [f64; 3],
    /// The one turn of the tool (rad) for the whole workpiece; none, where each
    /// point has its own or there is none to choose.
    pub turn: Option<f64>,
    /// Whether each point has its own.
    pub each: bool,
    /// The place, where there is one.
    pub best: Option<WorkpiecePlace>,
}

impl Placed {
    /// What is said where there is no place.
    fn nowhere(&self) -> String {
        format!("a workpiece of {} mm has no place that is reached everywhere{}", lengths(self.size, " x "), self.how())
    }

    fn how(&self) -> String {
        match (self.turn, self.each) {
            (Some(turn), _) => {
                format!(", the tool turned by {} deg", significant(people(Dimension::Angle, turn), 6))
            }
            (None, true) => ", the tool turned as is best at each point".to_owned(),
            (None, false) => String::new(),
        }
    }
}

/// Lengths in mm, for people.
pub fn lengths(lengths: [f64; 3], between: &str) -> String {
    lengths.map(|length| significant(people(Dimension::Length, length), 6)).join(between)
}

impl Mapped {
    /// What the first column is, in words: "the deviation under the force ..".
    pub fn words(&self) -> String {
        match self.measure {
            Measure::Deviation(wrench) => {
                let of = |k: usize| [0, 1, 2].map(|i| significant(wrench[k + i], 4)).join(", ");
                let moment = if wrench.fixed_rows::<3>(3).norm() > 0.0 {
                    format!(" and the moment ({}) Nm", of(3))
                } else {
                    String::new()
                };
                format!("deviation under the force ({}) N{moment}", of(0))
            }
            Measure::AnyDirection(force) => {
                format!("deviation under {} N in the direction where it is largest", significant(force, 4))
            }
            Measure::Stiffness | Measure::Compliance => "stiffness in the weakest direction".to_owned(),
        }
    }

    /// Which value of each axis a cell has.
    pub fn indices(&self, cell: usize) -> Vec<usize> {
        Counter::new(self.axes.iter().map(|axis| axis.values.len()), cell).indices
    }

    /// The unit of the first column.
    pub fn unit(&self) -> &'static str {
        self.columns[0].unit
    }

    /// A value of the first column for people.
    pub fn figure(&self, value: f64) -> String {
        if self.is_rigid(value) { "rigid".to_owned() } else { significant(value * self.columns[0].scale, 4) }
    }

    /// The same with its unit.
    pub fn with_unit(&self, value: f64) -> String {
        let figure = self.figure(value);
        if self.is_rigid(value) { figure } else { format!("{figure} {}", self.unit()) }
    }

    fn is_rigid(&self, value: f64) -> bool {
        value.is_infinite() && !self.measure.worse_is_larger()
    }

    /// What is said of cells where no force moves the tool, if there are any.
    pub fn rigid(&self) -> Option<String> {
        let rigid = self.summary.rigid;
        (rigid > 0).then(|| {
            let cells = count(rigid, "cell");
            format!("{cells} {} rigid: no force moves the tool there, and tables have no value", are(rigid))
        })
    }

    /// Where a cell is: `q1 = -30 deg, q2 = 12.5 deg`.
    pub fn place(&self, cell: usize) -> String {
        let at = self.indices(cell);
        let one = |(axis, index): (&Axis, usize)| {
            format!("{} = {} {}", axis.name, significant(axis.for_people(index), 6), axis.unit())
        };
        self.axes.iter().zip(at).filter(|(axis, _)| axis.varies()).map(one).collect::<Vec<_>>().join(", ")
    }

    /// The coordinates that stand still.
    pub fn fixed(&self) -> String {
        let one = |axis: &Axis| format!("{} = {} {}", axis.name, significant(axis.for_people(0), 6), axis.unit());
        self.axes.iter().filter(|axis| !axis.varies()).map(one).collect::<Vec<_>>().join(", ")
    }

    /// The frame that x, y and z count in, where it is not the base frame.
    pub fn framed(&self) -> Option<String> {
        let frame = self.frame?;
        let list =
            |values: [f64; 3], dimension| values.map(|value| significant(people(dimension, value), 6)).join(", ");
        let (roll, pitch, yaw) = frame.rotation.euler_angles();
        Some(format!(
            "x, y and z count from ({}) mm, turned by roll, pitch, yaw ({}) deg; forces and displacements are in the base frame",
            list(frame.translation.vector.into(), Dimension::Length),
            list([roll, pitch, yaw], Dimension::Angle)
        ))
    }

    /// The document.
    pub fn json(&self) -> Value {
        let axis = |axis: &Axis| {
            let last = axis.values.len() - 1;
            json!({
                "name": axis.name,
                "unit": axis.unit(),
                "from": json::number(axis.for_people(0)),
                "to": json::number(axis.for_people(last)),
                "count": axis.values.len(),
            })
        };
        json!({
            "robot": self.robot,
            "measure": self.words(),
            "unit": self.unit(),
            "frame": self.frame.map(|frame| {
                let (roll, pitch, yaw) = frame.rotation.euler_angles();
                json!({
                    "xyz_m": json::numbers(frame.translation.vector.iter().copied()),
                    "rpy_rad": json::numbers([roll, pitch, yaw]),
                })
            }),
            "axes": self.axes.iter().map(axis).collect::<Value>(),
            "cells": self.summary.cells,
            "unreachable": self.summary.unreachable,
            "rigid": self.summary.rigid,
            "mean": json::number(self.summary.mean * self.columns[0].scale),
            "best": self.extreme(self.summary.best.as_ref()),
            "worst": self.extreme(self.summary.worst.as_ref()),
            "placements": self.placements.iter().map(|placed| self.placed_json(placed)).collect::<Value>(),
        })
    }

    fn extreme(&self, extreme: Option<&Extreme>) -> Value {
        let Some(extreme) = extreme else { return Value::Null };
        let at = self.indices(extreme.cell);
        let mut object = Map::new();
        for (axis, index) in self.axes.iter().zip(at) {
            object.insert(format!("{} [{}]", axis.name, axis.unit()), json::number(axis.for_people(index)));
        }
        for (column, value) in self.columns.iter().zip(&extreme.values) {
            object.insert(heading(column), json::number(value * column.scale));
        }
        object.into()
    }

    fn placed_json(&self, placed: &Placed) -> Value {
        let mm = |lengths: [f64; 3]| json::numbers(lengths.map(|length| people(Dimension::Length, length)));
        json!({
            "size_mm": mm(placed.size),
            "turn_deg": placed.turn.map(|turn| json::number(people(Dimension::Angle, turn))),
            "turned_at_each_point": placed.each,
            "corner_mm": placed.best.map(|best| mm(best.corner)),
            "points": placed.best.map(|best| best.span.iter().product::<usize>()),
            "worst": placed.best.map(|best| json::number(best.worst * self.columns[0].scale)),
        })
    }

    /// Sentences on where a workpiece is best put.
    pub fn placed(&self) -> Vec<String> {
        let sentence = |placed: &Placed| {
            let Some(best) = placed.best else { return capital(&format!("{}.", placed.nowhere())) };
            format!(
                "A workpiece of {} mm is best put with its lower corner at ({}) mm{}: the worst of {} in it is {}.",
                lengths(placed.size, " x "),
                lengths(best.corner, ", "),
                placed.how(),
                count(best.span.iter().product(), "point"),
                self.with_unit(best.worst)
            )
        };
        self.placements.iter().map(sentence).collect()
    }

    /// What is said where a place was asked for, and there is none with any turn of the tool.
    pub fn unplaced(&self) -> Option<String> {
        // The last has at each point the turn that reaches it.
        self.placements.last().filter(|placed| placed.best.is_none()).map(Placed::nowhere)
    }

    /// The page for a terminal.
    pub fn page(&self) -> String {
        let Summary { cells, unreachable, mean, best, worst, .. } = &self.summary;
        let mut page = format!("{}: {} at {}\n", self.robot, self.words(), count(*cells, "cell"));
        if !self.fixed().is_empty() {
            page += &format!("with {}\n", self.fixed());
        }
        if let Some(frame) = self.framed() {
            page += &format!("{frame}\n");
        }
        if *unreachable > 0 {
            page += &format!("{} of them no pose reaches\n", unreachable);
        }
        if let Some(rigid) = self.rigid() {
            page += &format!("{rigid}\n");
        }
        let (Some(best), Some(worst)) = (best, worst) else {
            let over = self.axes.iter().any(|axis| axis.dimension == Dimension::Length);
            if over && unreachable == cells {
                page += &self.axes.iter().find_map(in_millimetres).unwrap_or_else(|| {
                    "is it in the robot's base frame, and does `axis` of the tool point along `direction`?\n".to_owned()
                });
            }
            return page + "\n";
        };
        let mut table = Table::new(1, [String::new(), heading(&self.columns[0]), "where".to_owned()]);
        table.row(["best".to_owned(), self.figure(best.values[0]), self.place(best.cell)]);
        table.row(["mean".to_owned(), self.figure(*mean), String::new()]);
        table.row(["worst".to_owned(), self.figure(worst.values[0]), self.place(worst.cell)]);
        page += &format!("\n{table}");
        if !matches!(self.measure, Measure::Deviation(_)) && worst.values[1].is_finite() {
            let [x, y, z] = [1, 2, 3].map(|k| crate::text::decimals(worst.values[k], 3));
            page += &format!("the weakest direction there is ({x}, {y}, {z}) in the base frame\n");
        }
        for sentence in self.placed() {
            page += &format!("\n{sentence}\n");
        }
        page + "\n"
    }
}

fn are(count: usize) -> &'static str {
    if count == 1 { "is" } else { "are" }
}

/// Nothing that an arm reaches is farther from its base (m).
const FARTHEST: f64 = 100.0;

/// Asks of positions farther than any arm reaches whether they are in millimetres.
fn in_millimetres(axis: &Axis) -> Option<String> {
    let far = axis.values.iter().copied().filter(|_| axis.dimension == Dimension::Length);
    let far = far
        .filter(|value| value.abs() > FARTHEST)
        .reduce(|one, other| if other.abs() > one.abs() { other } else { one })?;
    Some(format!("`{}` is up to {far} m away, farther than any arm reaches: in mm? write `{far} mm`\n", axis.name))
}
