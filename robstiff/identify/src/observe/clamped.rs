//! Axes that are loaded one at a time, those before clamped.

use nalgebra::{DMatrix, DVector, Vector3};

use super::{Observation, Readings};
use crate::campaign::{ClampedRow, Frame};
use crate::model::{Arm, At, Parameter, Rig, Spring, Stand, Term, Torques, World};

/// A campaign of clamped axes. The rows of an axis are one sequence of loads, and one visit; its blocks
/// are parts of that sequence.
pub struct Clamped<'c> {
    rows: &'c [ClampedRow],
    readings: Readings,
    world: World,
    stand: Stand,
    /// The axes (from 1) that are loaded.
    pub axes: Vec<usize>,
    /// Zero for every joint: where the arm stands is not given.
    q: Vec<f64>,
}

impl<'c> Clamped<'c> {
    /// Of a campaign on the arm of a description.
    pub fn new(robot: &robstiff_robots::Description, rows: &'c [ClampedRow]) -> Self {
        let arm = Arm::of(robot);
        let mut axes: Vec<usize> = rows.iter().map(|row| row.axis).collect();
        axes.sort_unstable();
        axes.dedup();
        let axis = |row: &ClampedRow| axes.iter().position(|axis| *axis == row.axis).unwrap_or_default();
        let axis: Vec<usize> = rows.iter().map(axis).collect();
        let (block, stratum) = parts(&axis, axes.len());
        let q = vec![0.0; arm.joints()];
        let stand = arm.stand(&q, &[]);
        let readings = Readings {
            values: DVector::from_iterator(rows.len(), rows.iter().map(|row| row.deflection)),
            width: 1,
            reported: 1,
            // Each axis has a reading of its own.
            channels: vec![0],
            visit: axis,
            blocks: stratum.len(),
            stratum,
            block,
            force: vec![Vector3::zeros(); rows.len()],
            lines: rows.iter().map(|row| row.line).collect(),
            differences: true,
        };
        let rig = Rig::declared((Frame::Base, [0.0; 3]), (Frame::Base, [0.0; 3]));
        Self { rows, readings, world: World { arm, rig }, stand, axes, q }
    }

    /// The rows of an axis, in order.
    pub fn of_axis(&self, axis: usize) -> Vec<usize> {
        (0..self.rows.len()).filter(|&row| self.rows[row].axis == axis).collect()
    }

    fn at<'a>(&'a self, row: usize) -> At<'a> {
        At {
            row,
            q: &self.q,
            before: &self.q,
            time: row as f64 / self.rows.len().saturating_sub(1).max(1) as f64,
            in_visit: 60.0 * self.of_axis(self.rows[row].axis).iter().position(|r| *r == row).unwrap_or(0) as f64,
            warmer: 0.0,
            load: 0.0,
            growing: 1.0,
            place: Vector3::zeros(),
            stand: &self.stand,
        }
    }

    /// Puts the turn of a joint (from 1) by a law into a column.
    fn add_law(&self, joint: usize, law: &dyn Fn(&Torques<'_>) -> Vec<f64>, column: &mut DVector<f64>) {
        let rows = self.of_axis(joint);
        let load: Vec<f64> = rows.iter().map(|&row| self.rows[row].torque).collect();
        let none = vec![0.0; rows.len()];
        let in_visit: Vec<f64> = (0..rows.len()).map(|k| 60.0 * k as f64).collect();
        let visit = vec![0; rows.len()];
        let torques = Torques {
            load: &load,
            preload: &none,
            weight: &none,
            q: &none,
            all: &[],
            visit: &visit,
            in_visit: &in_visit,
        };
        rows.iter().zip(law(&torques)).for_each(|(&row, turn)| column[row] = turn);
    }

    fn column(&self, term: &Term) -> DVector<f64> {
        let mut column = DVector::zeros(self.rows.len());
        match term {
            Term::Spring(Spring::Joint(joint)) => {
                self.of_axis(*joint).into_iter().for_each(|row| column[row] = self.rows[row].torque);
            }
            Term::Law(joint, law) => self.add_law(*joint, &**law, &mut column),
            Term::Laws(law) => {
                self.axes.iter().for_each(|&joint| self.add_law(joint, &|torques| law(joint, torques), &mut column));
            }
            Term::Reading(of) => (0..self.rows.len()).for_each(|row| column[row] = of(&self.at(row)).x),
            _ => {}
        }
        column
    }
}

/// The loads of an axis are left out in so many parts: one axis says nothing of another, so each has to
/// be in every fit.
const PARTS: usize = 5;

/// The block of each row, and the axis of each block, by the axis of each row.
fn parts(axis: &[usize], axes: usize) -> (Vec<usize>, Vec<usize>) {
    let (mut block, mut stratum) = (vec![0; axis.len()], Vec::new());
    for of in 0..axes {
        let rows: Vec<usize> = (0..axis.len()).filter(|&row| axis[row] == of).collect();
        let parts = PARTS.min(rows.len());
        rows.iter().enumerate().for_each(|(k, &row)| block[row] = stratum.len() + k * parts / rows.len());
        stratum.extend(vec![of; parts]);
    }
    (block, stratum)
}

impl Observation for Clamped<'_> {
    fn readings(&self) -> &Readings {
        &self.readings
    }

    fn world(&self) -> &World {
        &self.world
    }

    fn predict(&self, _: &World, parameters: &[Parameter], values: &[f64]) -> DVector<f64> {
        let mut sum = DVector::zeros(self.rows.len());
        for (parameter, &value) in parameters.iter().zip(values).filter(|(_, value)| **value != 0.0) {
            sum += self.column(&parameter.term) * value;
        }
        sum
    }

    fn columns(&self, _: &World, parameters: &[Parameter], _: &[f64], of: &[usize]) -> DMatrix<f64> {
        let mut columns = DMatrix::zeros(self.rows.len(), of.len());
        for (k, &which) in of.iter().enumerate() {
            columns.set_column(k, &self.column(&parameters[which].term));
        }
        columns
    }

    fn each(&self, of: &mut dyn FnMut(&At<'_>)) {
        (0..self.rows.len()).for_each(|row| of(&self.at(row)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each part is a stretch of one axis, however the axes take turns.
    #[test]
    fn parts_are_stretches_of_one_axis() {
        let axis = [0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0];
        let (block, stratum) = parts(&axis, 2);
        assert_eq!(stratum, [0, 0, 0, 0, 0, 1, 1]);
        assert_eq!(block, [0, 0, 5, 1, 1, 2, 2, 6, 3, 3, 4]);
    }
}
