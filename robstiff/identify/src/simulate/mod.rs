//! Simulated campaigns: what a measurement would read on a robot that is not
//! quite what its description says.
//!
//! A [`Scenario`] says what is measured and what is hidden; [`simulate`] makes
//! the truth of it (joints off their declared compliance, effects that the
//! description lacks), draws poses and loads, and reads them with noise. The
//! result is a campaign as files, for trying a plan before renting a tracker.
//!
//! Displacements and positions are those of the model that tracing fits: what joints yield in the
//! arm's deformed shape, all else to first order, what hysteresis remembers beginning anew with each
//! visit; payloads are not remembered. Encoders on the output side of the gears read by how much the
//! joints turn, and nothing of bearings, links, the base and the tool. Neglected is gravity, which
//! loaded and unloaded readings have in common to first order, but for what `gravity_sag` says. As it
//! shares its formulas with tracing, it says what a plan of measurements can tell apart, and nothing
//! on whether the formulas are right.

mod displacements;
mod draw;
mod files;
mod positions;
mod read;
mod refused;
#[cfg(feature = "schema")]
pub mod schema;
#[cfg(test)]
mod tests;

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use robstiff_robots::Description;

pub use files::Files;
pub use refused::{Part, Refused};

use crate::campaign::{Data, Frame, Holdout};
use robstiff::Effect;

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
    /// How often the robot comes to each pose.
    pub visits: usize,
    /// What acts, and what is read of it.
    pub measures: Measures,
    /// Where wrenches act or payloads hang, in the tool frame (m).
    pub wrench_at: [f64; 3],
    /// The point that is read, in the tool frame (m).
    pub measured_at: [f64; 3],
    /// One sigma of one position reading along x, y and z of the measuring
    /// frame (m).
    pub noise: [f64; 3],
    /// Whether the campaign file states the noise.
    pub states_noise: bool,
    /// Effects that the description is not told of.
    pub hidden: Vec<Effect>,
    /// The parts of the joints' compliances are off their declared values by up
    /// to this fraction, all deviations equally likely.
    pub scatter: f64,
    /// Passed on to the campaign file.
    pub holdout: Option<Holdout>,
}

/// What acts on the robot, and what is read of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Measures {
    /// Forces; displacements are read.
    Displacements(UnderForces),
    /// Payloads; absolute positions are read, by a tracker that stands anywhere.
    Positions(UnderPayloads),
}

impl Measures {
    /// The name of the file of observations.
    pub fn file(&self) -> &'static str {
        match self {
            Self::Displacements(_) => "loads.csv",
            Self::Positions(_) => "positions.csv",
        }
    }
}

/// Forces and moments, and how displacements under them are read.
#[derive(Clone, Debug, PartialEq)]
pub struct UnderForces {
    /// The loads of a visit in order, as shares of its greatest.
    pub ramp: Vec<f64>,
    /// The greatest force of each visit (N), which has a direction of its own.
    pub force: Pull,
    /// The greatest moment of each visit (Nm); none where only forces act.
    pub moment: Option<Pull>,
    /// The frame of forces and moments, and that of displacements.
    pub frames: [Frame; 2],
    /// One sigma of one reading of the rotation about each axis (rad); none
    /// where rotations are not measured.
    pub rotation_noise: Option<f64>,
    /// One sigma of one reading of each joint's encoder on the output side of
    /// its gear (rad or m); none where there are no such encoders.
    pub encoder_noise: Option<Vec<f64>>,
    /// Whether the loads of a ramp follow each other and share one unloaded reading; else each
    /// has its own before it, and is a visit of its own.
    pub shares_unloaded: bool,
}

/// Payloads, and how well the robot comes to its poses.
#[derive(Clone, Debug, PartialEq)]
pub struct UnderPayloads {
    /// The payloads of a visit in order (kg).
    pub payloads: Vec<f64>,
    /// One sigma of where the robot comes to at each visit, along each axis (m).
    pub repeatability: f64,
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
    pub data: Data,
}

/// Measures a scenario on a robot.
///
/// # Errors
/// No pose in the working region; hidden effects that no robot with these
/// joints can have, once the joints are scattered; loads, compliances or noise so
/// large that no campaign may have such readings.
pub fn simulate(declared: &Description, scenario: &Scenario) -> Result<Simulated, Refused> {
    let truth = truth(declared, scenario)?;
    let poses = draw::poses(&truth, scenario)?;
    let (data, is_readable) = match &scenario.measures {
        Measures::Displacements(under) => {
            let data = displacements::measured(&truth, scenario, under, &poses);
            let readable = data.rows.iter().all(displacements::is_readable);
            (Data::Displacement(data), readable)
        }
        Measures::Positions(under) => {
            let data = positions::measured(&truth, scenario, under, &poses);
            let readable = data.rows.iter().all(positions::is_readable);
            (Data::Position(data), readable)
        }
    };
    if !is_readable {
        return Err(Refused {
            part: Part::Loads,
            message: String::from("there are readings beyond what a campaign may have"),
            help: String::from("smaller loads, compliances, levers or noise"),
        });
    }
    Ok(Simulated { scenario: scenario.clone(), declared: declared.clone(), truth, data })
}

/// The robot as it is: joints scattered, hidden effects added.
fn truth(declared: &Description, scenario: &Scenario) -> Result<Description, Refused> {
    let mut truth = declared.clone();
    draw::scatter(scenario, &mut truth);
    truth.effects.extend(&scenario.hidden);
    let hidden: Vec<String> = scenario.hidden.iter().map(ToString::to_string).collect();
    let hidden =
        if hidden.is_empty() { String::from("nothing is hidden") } else { format!("hidden: {}", hidden.join(", ")) };
    truth.source = format!(
        "Simulated truth behind a campaign, seed {}: joints off their declared compliance by up to {} %, {hidden}.",
        scenario.seed,
        // 0.29 times 100 is 28.999999999999996.
        (scenario.scatter * 1e8).round() / 1e6
    );
    // What reads a description knows what physics asks of one.
    Description::parse("truth.yaml", &truth.to_yaml())
        .map_err(|problems| refused::no_robot(&problems, declared.effects.len()))
}
