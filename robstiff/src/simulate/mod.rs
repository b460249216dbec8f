//! Simulated campaigns: what a measurement would read on a robot that is not
//! quite what its description says.
//!
//! A [`Scenario`] says what is measured and what is hidden; [`simulate`] makes
//! the truth of it (joints off their declared compliance, effects that the
//! description lacks), draws poses and loads, and reads them with noise. The
//! result is a campaign as files, for trying a plan before renting a tracker.
//!
//! The displacement is that of the arm in its deformed shape
//! ([`deformed`](crate::elements::deformed)), what hysteresis remembers beginning anew
//! with each visit. Encoders on the output side of the gears read by how much the
//! joints turn, and nothing of bearings, links, the base and the tool. Neglected is
//! gravity, which loaded and unloaded readings have in common to first order.
//! It shares its formulas with tracing, so it says what a plan of measurements
//! can tell apart, and nothing on whether the formulas are right.

mod draw;
mod files;
mod forward;
mod read;
#[cfg(test)]
mod tests;

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use robstiff_robots::Description;

pub use files::Files;

use crate::Effect;
use crate::campaign::{Displacements, Frame, Holdout, Observation};
use crate::identify::Error;

/// What is to be measured, how well, and what the description is not told.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// What the campaign calls itself.
    pub name: String,
    /// Seed of everything random. Poses, loads, noise and the scatter of the
    /// joints have streams of their own: another noise keeps the poses.
    pub seed: u64,
    /// The poses.
    pub poses: Poses,
    /// Load sequences a pose, each with a direction of its own.
    pub visits: usize,
    /// The loads of a visit in order, as shares of its greatest.
    pub ramp: Vec<f64>,
    /// The greatest force of each visit (N).
    pub force: Pull,
    /// The greatest moment of each visit (Nm); none where only forces act.
    pub moment: Option<Pull>,
    /// The frame of forces and moments, and where they act, in the tool frame
    /// (m).
    pub wrench: (Frame, [f64; 3]),
    /// The frame of displacements, and where they are read, in the tool frame
    /// (m).
    pub measured: (Frame, [f64; 3]),
    /// One sigma of one position reading along x, y and z of the measuring
    /// frame (m).
    pub noise: [f64; 3],
    /// One sigma of one reading of the rotation about each axis (rad); none
    /// where rotations are not measured.
    pub rotation_noise: Option<f64>,
    /// One sigma of one reading of each joint's encoder on the output side of
    /// its gear (rad or m); none where there are no such encoders.
    pub encoder_noise: Option<Vec<f64>>,
    /// Whether the campaign file states the noise.
    pub states_noise: bool,
    /// Whether the rows of a visit share one unloaded reading.
    pub shares_unloaded: bool,
    /// Effects that the description is not told of.
    pub hidden: Vec<Effect>,
    /// The parts of the joints' compliances are off their declared values by up
    /// to this fraction, all deviations equally likely.
    pub scatter: f64,
    /// Passed on to the campaign file.
    pub holdout: Option<Holdout>,
}

/// The poses of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub enum Poses {
    /// So many, drawn.
    Drawn {
        /// How many.
        count: usize,
        /// The range of each joint's coordinate (rad or m), all values equally
        /// likely.
        within: Vec<[f64; 2]>,
        /// The least height of the tool centre point above the origin of frame 0,
        /// along z of the base frame (m).
        floor: Option<f64>,
        /// Its least distance from the vertical through the origin of frame 0
        /// (m).
        column: Option<f64>,
    },
    /// These: joint coordinates (rad or m).
    Listed(Vec<Vec<f64>>),
}

/// Forces or moments.
#[derive(Clone, Debug, PartialEq)]
pub struct Pull {
    /// Least and greatest size (N or Nm), all sizes in between equally likely.
    pub bounds: [f64; 2],
    /// The directions (of any length), taken in turn from visit to visit; none:
    /// drawn, all equally likely.
    pub directions: Vec<[f64; 3]>,
}

/// A campaign that was simulated.
#[derive(Clone, Debug)]
pub struct Simulated {
    /// What was asked for.
    pub scenario: Scenario,
    /// The robot as declared.
    pub declared: Description,
    /// The robot as it is.
    pub truth: Description,
    /// The rows, with noise, as a campaign's reader would give them; lines
    /// count from 2, after the header.
    pub data: Displacements,
}

/// Measures a scenario on a robot.
///
/// # Errors
/// No pose in the working region; hidden effects that no robot with these
/// joints can have, once the joints are scattered; loads, compliances or noise so
/// large that readings are no numbers.
pub fn simulate(declared: &Description, scenario: &Scenario) -> Result<Simulated, Error> {
    let truth = truth(declared, scenario)?;
    let mut data = draw::loads(&truth, scenario)?;
    forward::read(&truth, scenario, &mut data);
    draw::noise(scenario, &mut data);
    draw::encoder_noise(scenario, &mut data);
    if !data.rows.iter().all(is_finite) {
        let error = "there are readings beyond all numbers: loads, compliances, levers or noise are too large";
        return Err(Error(String::from(error)));
    }
    Ok(Simulated { scenario: scenario.clone(), declared: declared.clone(), truth, data })
}

/// Whether all of a row are numbers, in the units of the files, too.
fn is_finite(row: &Observation) -> bool {
    let read = row.displacement.iter().chain(row.rotation.iter().flatten()).chain(row.encoders.iter().flatten());
    row.wrench.iter().chain(&row.q).chain(read).all(|value| (value * 1e6).is_finite())
}

/// The robot as it is: joints scattered, hidden effects added.
fn truth(declared: &Description, scenario: &Scenario) -> Result<Description, Error> {
    let mut truth = declared.clone();
    draw::scatter(scenario, &mut truth);
    truth.effects.extend(&scenario.hidden);
    let hidden: Vec<String> = scenario.hidden.iter().map(ToString::to_string).collect();
    let hidden =
        if hidden.is_empty() { String::from("nothing is hidden") } else { format!("hidden: {}", hidden.join(", ")) };
    truth.source = format!(
        "Simulated truth behind a campaign, seed {}: joints off their declared compliance by up to {} %, {hidden}.",
        scenario.seed,
        scenario.scatter * 100.0
    );
    // What reads a description knows what physics asks of one.
    Description::parse("truth.yaml", &truth.to_yaml())
        .map_err(|problems| Error(format!("no robot can be like this, once its joints are scattered:\n{problems}")))
}
