//! A simulated campaign as files.

use std::fmt::Write as _;
use std::format;
use std::string::String;

use super::{Measures, Simulated, UnderForces};
use crate::campaign::{Data, Displacements, Frame, Positions};
use robstiff::JointKind;

/// The texts of a simulated campaign's files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Files {
    /// `campaign.yaml`, which names the next two.
    pub campaign: String,
    /// The observations, with their file's name: `loads.csv` in degrees or
    /// millimetres, newtons, micrometres and microradians; `positions.csv` in degrees
    /// or millimetres, kilograms and millimetres.
    pub observations: (&'static str, String),
    /// `robot.yaml`: the robot as declared.
    pub robot: String,
    /// `truth.yaml`: the robot as it is, which no command but `predict` should
    /// be told.
    pub truth: String,
}

impl Simulated {
    /// The texts of the files.
    pub fn files(&self) -> Files {
        let rows = match (&self.data, &self.scenario.measures) {
            (Data::Displacement(data), Measures::Displacements(under)) => self.loads(data, under),
            (Data::Position(data), Measures::Positions(_)) => self.positions(data),
            _ => unreachable!("what is simulated is what the scenario measures"),
        };
        let name = self.scenario.measures.file();
        let (campaign, observations) = (self.campaign(name), (name, rows));
        Files { campaign, observations, robot: self.declared.to_yaml(), truth: self.truth.to_yaml() }
    }

    fn campaign(&self, observations: &str) -> String {
        let scenario = &self.scenario;
        let (kind, [wrench, measured], rotation, missed) = match &scenario.measures {
            Measures::Displacements(under) => ("displacement", under.frames, under.rotation_noise, 0.0),
            Measures::Positions(under) => ("position", [Frame::Base; 2], None, under.repeatability),
        };
        let mut text = format!(
            "name: {}\nrobot: robot.yaml\nobservations: {observations}\nkind: {kind}\nwrench: {}\nmeasured: {}\n",
            quoted(&scenario.name),
            place(wrench, scenario.wrench_at),
            place(measured, scenario.measured_at)
        );
        // One number for the three axes: their root mean square.
        let noise = scenario.noise.iter().fold(0.0, |sum: f64, sigma| sum.hypot(*sigma)) / 3_f64.sqrt();
        let noise = noise.hypot(missed);
        if scenario.states_noise && noise > 0.0 {
            let rotation = rotation.filter(|sigma| *sigma > 0.0);
            let rotation = rotation.map(|sigma| format!(", rotation: {} urad", micro(sigma)));
            text += &format!("noise: {{displacement: {} um{}}}\n", micro(noise), rotation.unwrap_or_default());
        }
        if let Some(holdout) = scenario.holdout {
            text += &format!("holdout: {{fraction: {}, seed: {}}}\n", holdout.fraction, holdout.seed);
        }
        text
    }

    fn loads(&self, data: &Displacements, under: &UnderForces) -> String {
        let columns = if under.encoder_noise.is_some() { &["q", "j"][..] } else { &["q"] };
        let mut text = self.header(columns) + ",Fx [N],Fy [N],Fz [N]";
        if under.moment.is_some() {
            text += ",Mx [Nm],My [Nm],Mz [Nm]";
        }
        text += ",dx [um],dy [um],dz [um]";
        if under.rotation_noise.is_some() {
            text += ",rx [urad],ry [urad],rz [urad]";
        }
        text.push('\n');
        for row in &data.rows {
            let coordinates = self.for_people(row.q.iter().chain(row.encoders.iter().flatten()));
            let wrench = &row.wrench[..if under.moment.is_some() { 6 } else { 3 }];
            let readings = row.displacement.iter().chain(row.rotation.iter().flatten()).map(|value| value * 1e6);
            let values = row.time.into_iter().chain(coordinates).chain(wrench.iter().copied()).chain(readings);
            line(&mut text, [&data.poses[row.pose], &data.visits[row.visit]], values);
        }
        text
    }

    fn positions(&self, data: &Positions) -> String {
        let mut text = self.header(&["q"]) + ",payload [kg],px [mm],py [mm],pz [mm]\n";
        for row in &data.rows {
            let read = row.position.iter().map(|value| value * 1e3);
            let values = row.time.into_iter().chain(self.for_people(row.q.iter())).chain([row.payload]).chain(read);
            line(&mut text, [&data.poses[row.pose], &data.visits[row.visit]], values);
        }
        text
    }

    /// The first columns of a table, up to those of joints, which have these letters.
    fn header(&self, columns: &[&str]) -> String {
        let mut text = String::from("pose,visit,time [s]");
        for column in columns {
            for (number, joint) in (1..).zip(&self.truth.joints) {
                let unit = if joint.kind == JointKind::Revolute { "deg" } else { "mm" };
                write!(text, ",{column}{number} [{unit}]").expect("a string takes any text");
            }
        }
        text
    }

    /// Joint coordinates, those of all joints in turn, in degrees or millimetres.
    fn for_people<'a>(&self, coordinates: impl Iterator<Item = &'a f64>) -> impl Iterator<Item = f64> {
        coordinates.zip(self.truth.joints.iter().cycle()).map(|(q, joint)| match joint.kind {
            JointKind::Revolute => q.to_degrees(),
            JointKind::Prismatic => q * 1e3,
        })
    }
}

/// One row of a table, with all the digits it has. What is no number leaves its field empty.
fn line(text: &mut String, [pose, visit]: [&str; 2], values: impl Iterator<Item = f64>) {
    *text += &format!("{pose},{visit}");
    for value in values {
        text.push(',');
        if value.is_finite() {
            write!(text, "{value}").expect("a string takes any text");
        }
    }
    text.push('\n');
}

/// In millionths, without the rounding of the multiplication: to 15 digits, so that
/// what is above zero stays above it.
fn micro(value: f64) -> f64 {
    format!("{:.14e}", value * 1e6).parse().expect("a number that was written")
}

fn place(frame: Frame, at: [f64; 3]) -> String {
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
