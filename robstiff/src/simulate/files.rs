//! A simulated campaign as files.

use std::fmt::Write as _;
use std::format;
use std::string::String;

use super::Simulated;
use crate::JointKind;
use crate::campaign::{Frame, Observation};

/// The texts of a simulated campaign's files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Files {
    /// `campaign.yaml`, which names the next two.
    pub campaign: String,
    /// `loads.csv`, in degrees or millimetres, newtons, micrometres and
    /// microradians.
    pub loads: String,
    /// `robot.yaml`: the robot as declared.
    pub robot: String,
    /// `truth.yaml`: the robot as it is, which no command but `predict` should
    /// be told.
    pub truth: String,
}

impl Simulated {
    /// The texts of the files.
    pub fn files(&self) -> Files {
        Files {
            campaign: self.campaign(),
            loads: self.loads(),
            robot: self.declared.to_yaml(),
            truth: self.truth.to_yaml(),
        }
    }

    fn campaign(&self) -> String {
        let scenario = &self.scenario;
        let mut text = format!(
            "name: {}\nrobot: robot.yaml\nobservations: loads.csv\nkind: displacement\nwrench: {}\nmeasured: {}\n",
            quoted(&scenario.name),
            place(scenario.wrench),
            place(scenario.measured)
        );
        // One number for the three axes: their root mean square.
        let noise = scenario.noise.iter().fold(0.0, |sum: f64, sigma| sum.hypot(*sigma)) / 3_f64.sqrt();
        if scenario.states_noise && noise > 0.0 {
            let rotation = scenario.rotation_noise.filter(|sigma| *sigma > 0.0);
            let rotation = rotation.map(|sigma| format!(", rotation: {} urad", micro(sigma)));
            text += &format!("noise: {{displacement: {} um{}}}\n", micro(noise), rotation.unwrap_or_default());
        }
        if let Some(holdout) = scenario.holdout {
            text += &format!("holdout: {{fraction: {}, seed: {}}}\n", holdout.fraction, holdout.seed);
        }
        text
    }

    fn loads(&self) -> String {
        let mut text = String::from("pose,visit,time [s]");
        let columns = if self.scenario.encoder_noise.is_some() { &["q", "j"][..] } else { &["q"] };
        for column in columns {
            for (number, joint) in (1..).zip(&self.truth.joints) {
                let unit = if joint.kind == JointKind::Revolute { "deg" } else { "mm" };
                write!(text, ",{column}{number} [{unit}]").expect("a string takes any text");
            }
        }
        text += ",Fx [N],Fy [N],Fz [N]";
        if self.scenario.moment.is_some() {
            text += ",Mx [Nm],My [Nm],Mz [Nm]";
        }
        text += ",dx [um],dy [um],dz [um]";
        if self.scenario.rotation_noise.is_some() {
            text += ",rx [urad],ry [urad],rz [urad]";
        }
        text.push('\n');
        for row in &self.data.rows {
            self.line(&mut text, row);
        }
        text
    }

    /// One row of the table, with all the digits it has.
    fn line(&self, text: &mut String, row: &Observation) {
        let joints = self.truth.joints.iter().cycle();
        let coordinates = row.q.iter().chain(row.encoders.iter().flatten()).zip(joints);
        let coordinates = coordinates.map(|(q, joint)| match joint.kind {
            JointKind::Revolute => q.to_degrees(),
            JointKind::Prismatic => q * 1e3,
        });
        let wrench = &row.wrench[..if self.scenario.moment.is_some() { 6 } else { 3 }];
        let readings = row.displacement.iter().chain(row.rotation.iter().flatten()).map(|value| value * 1e6);
        *text += &format!("{},{}", self.data.poses[row.pose], self.data.visits[row.visit]);
        for value in row.time.into_iter().chain(coordinates).chain(wrench.iter().copied()).chain(readings) {
            write!(text, ",{value}").expect("a string takes any text");
        }
        text.push('\n');
    }
}

/// In millionths, without the rounding of the multiplication: to 15 digits, so that
/// what is above zero stays above it.
fn micro(value: f64) -> f64 {
    format!("{:.14e}", value * 1e6).parse().expect("a number that was written")
}

fn place((frame, at): (Frame, [f64; 3])) -> String {
    let frame = if frame == Frame::Base { "base" } else { "tool" };
    match at {
        [0.0, 0.0, 0.0] => format!("{{frame: {frame}, at: tcp}}"),
        [x, y, z] => format!("{{frame: {frame}, at: [{x} m, {y} m, {z} m]}}"),
    }
}

/// A text on one line, in quotes, as YAML reads it back.
fn quoted(text: &str) -> String {
    let clean: String = text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect();
    format!("\"{}\"", clean.replace('\\', "\\\\").replace('"', "\\\""))
}
