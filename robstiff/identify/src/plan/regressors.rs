//! What planning asks of a model.

use std::vec::Vec;

use nalgebra::{DMatrix, Vector3};
use robstiff_robots::Description;
use robstiff_robots::effect::gravity_sag::GRAVITY;

use crate::campaign::Frame;
use crate::model::Arm;

/// A load sequence at one pose, of displacements with one unloaded reading.
#[derive(Clone, Debug, PartialEq)]
pub struct Visit {
    /// Joint coordinates (rad or m).
    pub q: Vec<f64>,
    /// The loads in order: forces (N) and moments (Nm) in the base frame,
    /// acting where the campaign's do.
    pub loads: Vec<[f64; 6]>,
}

impl Visit {
    /// The load with the greatest force, or moment where there is no force.
    pub fn greatest(&self) -> [f64; 6] {
        let size = |three: &[f64]| three.iter().map(|value| value * value).sum::<f64>();
        let larger = |a: &[f64; 6], b: &[f64; 6]| {
            size(&a[..3]).total_cmp(&size(&b[..3])).then(size(&a[3..]).total_cmp(&size(&b[3..])))
        };
        self.loads.iter().copied().max_by(larger).unwrap_or_default()
    }

    /// The payloads in order (kg) whose weights the loads are.
    pub fn payloads(&self) -> Vec<f64> {
        self.loads.iter().map(|load| -load[2] / GRAVITY).collect()
    }

    /// The loads in order as a campaign of this robot writes them down whose loads
    /// are in `frame`: forces (N) and moments (Nm).
    pub fn loads_in(&self, frame: Frame, robot: &Description) -> Vec<[f64; 6]> {
        if frame == Frame::Base {
            return self.loads.clone();
        }
        let turn = Arm::of(robot).stand(&self.q, &[]).tcp.turn.transpose();
        let turned = |load: &[f64; 6]| {
            let force = turn * Vector3::from_column_slice(&load[..3]);
            let moment = turn * Vector3::from_column_slice(&load[3..]);
            [force.x, force.y, force.z, moment.x, moment.y, moment.z]
        };
        self.loads.iter().map(turned).collect()
    }
}

/// One sigma of a rotation reading where the campaign states none (rad): that
/// of a laser tracker's six-axis probe at some metres.
pub const ROTATION_NOISE: f64 = 5e-5;

/// One sigma of an encoder on the output side of a gear (rad): one second of
/// arc.
pub const ENCODER_NOISE: f64 = 5e-6;

/// How much further out the second lever is, and how far aside the second reflector (m).
pub const REACH: f64 = 0.3;

/// The levels of [`Sensor::Levels`], as shares of the greatest load.
pub const LEVELS: [f64; 5] = [0.025, 0.25, 0.5, 1.0, -1.0];

/// Those of [`Sensor::Payloads`].
pub const PAYLOADS: [f64; 5] = [0.0, 0.1, 0.25, 0.5, 1.0];

/// What could be measured as well.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// The rotation of the tool, where it is not read already.
    Rotations,
    /// Encoders on the output side of every gear.
    Encoders,
    /// The same loads once more, acting and read [`REACH`] further out along the tool.
    Lever,
    /// Load levels from below 3 % of the greatest up, and with the sign
    /// reversed.
    Levels,
    /// A second reflector on the tool, [`REACH`] from the first along x of the tool frame.
    Reflector,
    /// Five payloads, none and 10 % of the greatest among them.
    Payloads,
}

/// What measurements show of a fixed list of numbers.
pub trait Regressors {
    /// The variance of one reading (m^2).
    fn variance(&self) -> f64;

    /// How many numbers the campaign and some visits read.
    fn readings(&self, visits: &[Visit]) -> usize;

    /// What could be measured as well.
    fn sensors(&self) -> Vec<Sensor>;

    /// The information of the campaign as it is, as that of a visit, with that of what is likely.
    fn known(&self) -> DMatrix<f64>;

    /// The part of that which is of what is likely alone, and of no reading.
    fn likely(&self) -> DMatrix<f64>;

    /// The information that each visit gives on the numbers: the Gram matrix of
    /// its whitened columns (those of a unit of each number), to be divided by
    /// the variance of one reading (m^2).
    fn information(&self, visits: &[Visit], besides: Option<Sensor>) -> Vec<DMatrix<f64>>;
}
