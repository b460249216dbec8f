//! Absolute positions of a reflector on the tool, as a tracker that stands anywhere
//! reads them: the arm in its deformed shape, under its own weight and a payload.

use std::fmt::Write as _;

use nalgebra::Vector3;
use rand::RngExt;
use robstiff_robots::{Description, Joint, JointKind};

use super::arm::GRAVITY;
use super::frame::Frame;
use super::noise::{Stream, normal};
use super::rig::Rig;
use super::{Arm, Hidden};

/// How long a row takes (s).
const A_ROW: f64 = 60.0;

/// A campaign of positions.
#[derive(Clone, Debug)]
pub struct Positions {
    /// The arm as it is.
    pub truth: Description,
    /// What else there is of the arm; of the rig `BaseSlip`, `TrackerScale`, `Expansion`,
    /// `ThermalDrift`, `ReflectorSlip`, and what the fields below say.
    pub hidden: Vec<Hidden>,
    /// How many poses, and how often the arm comes to each.
    pub poses: [usize; 2],
    /// The payloads of a visit (kg), which hang at the TCP.
    pub payloads: Vec<f64>,
    /// Where the reflector is, in the tool frame (m).
    pub reflector: [f64; 3],
    /// One sigma of a reading on each axis, and of where the arm comes to (m).
    pub noise: [f64; 2],
    /// Rows, from 0, that are off (m).
    pub wild: Vec<(usize, [f64; 3])>,
    /// Seed of everything random.
    pub seed: u64,
}

impl Positions {
    /// Sixty poses, each come to once without a payload; noise as of a tracker.
    pub fn new(truth: Description, seed: u64) -> Self {
        Self {
            truth,
            hidden: Vec::new(),
            poses: [60, 1],
            payloads: vec![0.0],
            reflector: [0.04, -0.02, 0.11],
            noise: [20e-6, 20e-6],
            wild: Vec::new(),
            seed,
        }
    }

    /// `campaign.yaml` of the reflector at a place in the tool frame (m).
    pub fn campaign(reflector: [f64; 3]) -> String {
        let [x, y, z] = reflector;
        format!(
            "name: a tracker\nrobot: robot.yaml\nobservations: positions.csv\nkind: position\n\
             measured: {{at: [{x} m, {y} m, {z} m]}}\n"
        )
    }

    /// The table: degrees or millimetres, kilograms.
    pub fn table(&self) -> String {
        let (mut noise, mut drawn) = (Stream::Noise.of(self.seed), Stream::Poses.of(self.seed));
        let [poses, visits] = self.poses;
        let coordinates: Vec<Vec<f64>> = (0..poses)
            .map(|_| self.truth.joints.iter().map(|joint| within(joint, drawn.random_range(0.0..1.0))).collect())
            .collect();
        let mut three = |sigma: f64| Vector3::from_fn(|_, _| sigma * normal(&mut noise));
        let tracker = Frame { origin: three(4.0), ..Frame::turned(three(1.0)) };
        let arm = self.hidden.iter().fold(Arm::new(&self.truth, &[]), Arm::hiding);
        let (rows, mut row) = (poses * visits * self.payloads.len(), 0);
        let hall = Rig::new(&arm, &self.hidden, A_ROW * rows as f64, 0.0, false);
        let warms = self.hidden.iter().any(|hidden| matches!(hidden, Hidden::Expansion { .. }));
        let mut table = String::from("pose,visit,time [min]");
        if warms {
            table += ",temperature";
        }
        for (number, joint) in (1..).zip(&self.truth.joints) {
            let unit = if joint.kind == JointKind::Revolute { "deg" } else { "mm" };
            write!(table, ",q{number} [{unit}]").expect("a text");
        }
        table += ",payload [kg],px [mm],py [mm],pz [mm]\n";
        for visit in 0..poses * visits {
            let pose = visit % poses;
            let q = &coordinates[pose];
            let comes_to = three(self.noise[1]);
            for &payload in &self.payloads {
                let time = A_ROW * row as f64;
                let grown = hall.grown(time);
                let posed = grown.as_ref().unwrap_or(&arm).at(q);
                let settled = posed.settle(&[0.0, 0.0, -GRAVITY * payload, 0.0, 0.0, 0.0]);
                let tool = Frame::turned(settled.rotation.into()).turn * posed.tool();
                let tcp = Vector3::from(posed.tcp()) + Vector3::from(settled.displacement);
                let mut at = tcp + tool * Vector3::from(self.reflector) + comes_to;
                let is_after = |when: f64| row as f64 >= when * rows as f64;
                for hidden in &self.hidden {
                    match hidden {
                        Hidden::BaseSlip { shift, turn, when } if is_after(*when) => {
                            at = Frame::turned((*turn).into()).turn * at + Vector3::from(*shift);
                        }
                        Hidden::ReflectorSlip { shift, when } if is_after(*when) => {
                            at += tool * Vector3::from(*shift);
                        }
                        Hidden::ThermalDrift { rate, follows } => {
                            at += Vector3::from(*rate) * hall.drift(*follows, time);
                        }
                        _ => {}
                    }
                }
                let off: Vector3<f64> =
                    self.wild.iter().filter(|(of, _)| *of == row).map(|(_, off)| Vector3::from(*off)).sum();
                let read = tracker.turn * at * hall.scale() + tracker.origin + three(self.noise[0]) + off;
                write!(table, "{pose},{visit},{row}").expect("a text");
                if warms {
                    write!(table, ",{}", hall.temperature(time)).expect("a text");
                }
                for (q, joint) in q.iter().zip(&self.truth.joints) {
                    let q = if joint.kind == JointKind::Revolute { q.to_degrees() } else { q * 1e3 };
                    write!(table, ",{q}").expect("a text");
                }
                let [x, y, z] = <[f64; 3]>::from(read * 1e3);
                writeln!(table, ",{payload},{x},{y},{z}").expect("a text");
                row += 1;
            }
        }
        table
    }
}

/// A coordinate of a joint, a part of the way through what it reaches about zero (rad
/// or m).
fn within(joint: &Joint, part: f64) -> f64 {
    let about = if joint.kind == JointKind::Revolute { 1.2 } else { 0.4 };
    let [least, most] = joint.limits.unwrap_or([-about, about]);
    let (from, to) = (least.max(-about), most.min(about));
    if from < to { from + part * (to - from) } else { least + part * (most - least) }
}
