//! What may be off between a campaign's file and what happened: the robot's
//! kinematics, the load cell, where the load acts, the tracker, where it looks.
//! Each number is zero where the file and the description are right.

use std::sync::Arc;
use std::vec;
use std::vec::Vec;

use nalgebra::{Matrix3, Rotation3, Vector3, Vector6};
use robstiff_robots::Description;

use crate::campaign::{Displacements, Frame};

/// A setting of everything that enters the forward model of a campaign other
/// than linearly.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// What is to be added to the rows of the DH table, `[theta, d, a, alpha]`
    /// (rad, m); theta of a joint that turns is its zero offset.
    pub table: Vec<[f64; 4]>,
    /// What is to be added to joint coordinates and varies with them.
    pub waves: Vec<Wave>,
    /// The load cell's faults that are constant in the base frame.
    pub in_base: LoadCell,
    /// Those that are constant in the tool frame.
    pub in_tool: LoadCell,
    /// Where the wrench acts less where the file says, in the tool frame (m).
    pub lever: Vector3<f64>,
    /// The point that is read less the one that the file says, in the tool frame (m).
    pub marker: Vector3<f64>,
    /// The turn of what is read, in the frame of the readings (rad).
    pub tracker: Vector3<f64>,
    /// What a step of the displacement grows by in a decade of the time since
    /// it was made, as a share of it, and when that begins (s or rows).
    pub creep: [f64; 2],
    /// How far the joints stand aside under the robot's own weight, by row of
    /// the campaign and joint (rad or m), and how much of it is so.
    pub sag: Option<(f64, Arc<Vec<Vec<f64>>>)>,
    /// By how much of itself the load of each row of the campaign is another, each with how much
    /// of it is so.
    pub loads: Vec<(f64, Arc<[f64]>)>,
}

/// A periodic error of a joint's coordinate: `cos cos(k q) + sin sin(k q)`
/// (rad).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// The joint, from 1.
    pub joint: usize,
    /// `k`.
    pub order: f64,
    /// The amplitude of the cosine (rad).
    pub cos: f64,
    /// The amplitude of the sine (rad).
    pub sin: f64,
}

/// What makes of the force that a file gives the force that acted:
/// `R(turn) (1 + scale) f + bias`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadCell {
    /// A rotation vector (rad); moments turn alike.
    pub turn: Vector3<f64>,
    /// By axis.
    pub scale: Vector3<f64>,
    /// (N).
    pub bias: Vector3<f64>,
}

impl Setup {
    /// File and description are right.
    pub fn as_declared(joints: usize) -> Self {
        Self {
            table: vec![[0.0; 4]; joints],
            waves: Vec::new(),
            in_base: LoadCell::default(),
            in_tool: LoadCell::default(),
            lever: Vector3::zeros(),
            marker: Vector3::zeros(),
            tracker: Vector3::zeros(),
            creep: [0.0, 1.0],
            sag: None,
            loads: Vec::new(),
        }
    }

    /// The description with its table corrected.
    pub fn description(&self, declared: &Description) -> Description {
        let mut corrected = declared.clone();
        for (joint, [theta, d, a, alpha]) in corrected.joints.iter_mut().zip(&self.table) {
            joint.theta += theta;
            joint.d += d;
            joint.a += a;
            joint.alpha += alpha;
        }
        corrected
    }

    /// The joint coordinates of a row with what varies with them added.
    pub fn coordinates(&self, row: usize, read: &[f64]) -> Vec<f64> {
        let mut q = read.to_vec();
        for wave in &self.waves {
            let angle = wave.order * read[wave.joint - 1];
            q[wave.joint - 1] += wave.cos * angle.cos() + wave.sin * angle.sin();
        }
        if let Some((share, sag)) = &self.sag {
            q.iter_mut().zip(&sag[row]).for_each(|(q, sag)| *q += share * sag);
        }
        q
    }

    /// The wrench at the TCP in the base frame (N, Nm) of one that a file
    /// gives; `tool` turns the tool frame into the base frame.
    pub fn wrench(&self, data: &Displacements, tool: &Matrix3<f64>, read: &[f64; 6]) -> Vector6<f64> {
        let frame = if data.wrench_frame == Frame::Tool { *tool } else { Matrix3::identity() };
        let mut force = frame * Vector3::from_column_slice(&read[..3]);
        let mut moment = frame * Vector3::from_column_slice(&read[3..]);
        for (frame, cell) in [(Matrix3::identity(), &self.in_base), (*tool, &self.in_tool)] {
            if *cell != LoadCell::default() {
                let turn = Rotation3::new(cell.turn);
                let scaled = (frame.transpose() * force).component_mul(&cell.scale.add_scalar(1.0));
                force = frame * (turn * scaled + cell.bias);
                moment = frame * (turn * (frame.transpose() * moment));
            }
        }
        let lever = tool * (Vector3::from(data.wrench_at) + self.lever);
        let mut wrench = Vector6::zeros();
        wrench.fixed_rows_mut::<3>(0).copy_from(&force);
        wrench.fixed_rows_mut::<3>(3).copy_from(&(moment + lever.cross(&force)));
        wrench
    }

    /// What acts in a row of the campaign of a unit that the file gives.
    pub fn of_load(&self, row: usize) -> f64 {
        1.0 + self.loads.iter().map(|(share, factors)| share * factors[row]).sum::<f64>()
    }

    /// How a vector in the base frame is seen among the readings, which were
    /// brought to the base frame by the tool frame `declared`; `tool` is where
    /// that is.
    pub fn seen(&self, data: &Displacements, declared: &Matrix3<f64>, tool: &Matrix3<f64>) -> Matrix3<f64> {
        let turn = Rotation3::new(self.tracker).into_inner();
        match data.measured_frame {
            Frame::Base => turn,
            Frame::Tool => declared * turn * tool.transpose(),
        }
    }
}
