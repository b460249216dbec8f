//! A measuring campaign on a simulated arm.

use std::ops::Range;

use nalgebra::Vector3;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_robots::{Description, Effect, JointKind};

use super::encoders::{Encoders, MOST_JOINTS, Turns};
use super::frame::in_frame;
use super::gear::Moment;
use super::hidden::Hidden;
use super::noise::{Stream, direction, normal, tail, wild};
use super::rig::{Creep, Rig, Stand};
use super::{Arm, PosedArm};

/// Draws of one pose before giving up on the working region.
const TRIES: usize = 10_000;

/// What is measured on which arm, and how well.
///
/// The poses, the loads, the noise, its tails, the order and the outliers come
/// from random streams of their own: with the same seed, another noise or
/// another hidden effect leaves the poses and the loads as they are.
///
/// A load is put on as soon as the reading before it is taken, and read one
/// pace later; a visit begins with the arm unloaded and at rest. Where each row
/// has an unloaded reading of its own, the arm is unloaded before it for half a
/// pace.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The arm as it really is; its effects are in the measurements too.
    pub truth: Description,
    /// What no description is told of.
    pub hidden: Vec<Hidden>,
    /// Number of poses.
    pub poses: usize,
    /// Load sequences a pose, each with its own direction.
    pub visits: usize,
    /// The loads of a visit, in order, as shares of the visit's greatest load;
    /// 0 is a check without load, and a negative share pulls the other way.
    pub ramp: Vec<f64>,
    /// Bounds of the visits' greatest force (N).
    pub force: [f64; 2],
    /// Bounds of the visits' greatest moment (Nm), in a direction of its own;
    /// none where the load is a force alone.
    pub moment: Option<[f64; 2]>,
    /// Noise of one position reading on each axis, one sigma (m).
    pub noise: f64,
    /// Noise of one reading of the rotation about each axis, one sigma (rad);
    /// none where rotations are not measured.
    pub rotation_noise: Option<f64>,
    /// The noise of x, y and z, of position and rotation, in these multiples.
    pub axis_noise: [f64; 3],
    /// Degrees of freedom of Student's distribution, 3 or more, that the noise
    /// of a reading has; normal noise where there is none.
    pub tails: Option<usize>,
    /// Encoders that are read with every row, where there are any.
    pub encoders: Option<Encoders>,
    /// Whether `campaign.yaml` states the noise.
    pub states_noise: bool,
    /// Whether the rows of a visit share one unloaded reading, or each row has
    /// its own and counts as a visit. A displacement is a loaded minus an
    /// unloaded reading.
    pub shares_unloaded: bool,
    /// Whether all unloaded readings are taken in a round before the first
    /// load, and not with the loads they belong to. What changes in the hours
    /// between is then in the displacements.
    pub unloaded_first: bool,
    /// Whether the visits come in random order, not pose after pose.
    pub shuffled: bool,
    /// Whether the file gives wrenches in the tool frame, not in the base
    /// frame.
    pub wrench_in_tool: bool,
    /// Where the loads act, and moments are taken about (m), in the tool frame.
    pub hook: [f64; 3],
    /// Where the readings are taken (m), in the tool frame.
    pub marker: [f64; 3],
    /// Whether the file gives displacements and rotations in the tool frame of
    /// the unloaded arm, not in the base frame.
    pub measured_in_tool: bool,
    /// From one row to the next (s).
    pub pace: f64,
    /// By how much the temperature in the hall swings about its rise (K).
    pub swing: f64,
    /// The TCP stays at least this high in the base frame (m).
    pub floor: f64,
    /// The TCP stays at least this far from the vertical through the origin of
    /// frame 0 (m).
    pub column: f64,
    /// Seed of everything random.
    pub seed: u64,
}

impl Scenario {
    /// A campaign as one would plan it: 40 poses with two visits each, five
    /// loads up and down again to 500..1300 N, no moments, no rotations, 8 um
    /// of noise on each reading (not stated), one unloaded reading a visit.
    pub fn new(truth: Description, hidden: Vec<Effect>, seed: u64) -> Self {
        Self {
            truth,
            hidden: hidden.into_iter().map(Hidden::Elastic).collect(),
            poses: 40,
            visits: 2,
            ramp: vec![0.35, 0.7, 1.0, 0.7, 0.35],
            force: [500.0, 1300.0],
            moment: None,
            noise: 8e-6,
            rotation_noise: None,
            axis_noise: [1.0; 3],
            tails: None,
            encoders: None,
            states_noise: false,
            shares_unloaded: true,
            unloaded_first: false,
            shuffled: false,
            wrench_in_tool: false,
            hook: [0.0; 3],
            marker: [0.0; 3],
            measured_in_tool: false,
            pace: 60.0,
            swing: 0.0,
            floor: 0.1,
            column: 0.6,
            seed,
        }
    }

    /// The same campaign with something more hidden in it.
    #[must_use]
    pub fn hiding(mut self, hidden: impl Into<Hidden>) -> Self {
        self.hidden.push(hidden.into());
        self
    }

    /// Measures.
    ///
    /// # Panics
    ///
    /// Where an effect does not fit the arm, the arm buckles, or no pose within
    /// the joints' limits keeps the TCP within the working region.
    pub fn run(&self) -> Simulated {
        let declared = self.arm(&self.truth);
        let arm = self.hidden.iter().fold(declared.clone(), |arm, hidden| arm.hiding(hidden));
        let arm = arm.with_droop(self.encoders.and_then(|encoders| encoders.motors).unwrap_or(0.0));
        let mut plan = self.plan(&declared);
        if self.shuffled {
            plan.shuffle(&mut Stream::Order.of(self.seed));
        }
        let count = plan.len() * self.ramp.len();
        let round = match (self.unloaded_first, self.shares_unloaded) {
            (false, _) => 0,
            (true, true) => plan.len(),
            (true, false) => count,
        };
        let start = self.pace * round as f64;
        let end = start + self.pace * count as f64;
        let rig = Rig::new(&arm, &self.hidden, end, self.swing, self.measured_in_tool);
        let mut rows = Vec::with_capacity(count);
        let mut posed: Option<(usize, PosedArm)> = None;
        for (turn, visit) in plan.iter().enumerate() {
            if posed.as_ref().is_none_or(|(pose, _)| *pose != visit.pose) {
                posed = Some((visit.pose, arm.at(&visit.q)));
            }
            let (_, posed) = posed.as_ref().expect("it stands at the pose");
            self.measure(&rig, posed, visit, turn, start, &mut rows);
        }
        Simulated { scenario: self.clone(), rows }
    }

    /// The visits with all that is random about them, pose after pose.
    fn plan(&self, declared: &Arm) -> Vec<Visit> {
        let [mut poses, mut loads, mut noise, mut rare, mut tails] =
            [Stream::Poses, Stream::Loads, Stream::Noise, Stream::Wild, Stream::Tails].map(|one| one.of(self.seed));
        let mut angles = Stream::Encoders.of(self.seed);
        let encoders = self.encoders.unwrap_or(Encoders { output: None, apart: 0.0, motors: None });
        let mut plan = Vec::with_capacity(self.poses * self.visits);
        for pose in 0..self.poses {
            let q = self.pose(declared, &mut poses);
            let apart = encoders.of_pose(&mut angles);
            for visit in 0..self.visits {
                let greatest = self.greatest(&mut loads);
                let mut unloaded = self.reading(&mut noise, &mut tails);
                let readings = (0..self.ramp.len()).map(|count| {
                    if count > 0 && !self.shares_unloaded {
                        unloaded = self.reading(&mut noise, &mut tails);
                    }
                    let loaded = self.reading(&mut noise, &mut tails);
                    let of_row = encoders.of_row(&mut angles);
                    Reading {
                        noise: std::array::from_fn(|axis| loaded[axis] - unloaded[axis]),
                        wild: wild(&mut rare),
                        angles: std::array::from_fn(|joint| apart[joint] + of_row[joint]),
                    }
                });
                let readings = readings.collect();
                plan.push(Visit { pose, visit: pose * self.visits + visit, q: q.clone(), greatest, readings });
            }
        }
        plan
    }

    /// Takes the readings of a visit, the `turn`-th in time, whose loads begin
    /// after `start`.
    fn measure(&self, rig: &Rig<'_>, posed: &PosedArm, visit: &Visit, turn: usize, start: f64, rows: &mut Vec<Row>) {
        let (pace, loads) = (self.pace, self.ramp.len());
        let mut memory = posed.rested();
        let mut creep = [Creep::new(&self.hidden), Creep::new(&self.hidden)];
        // Gears give way further with the rest of the arm.
        let mut of_joints: [Option<Creep>; MOST_JOINTS] = std::array::from_fn(|_| Creep::new(&self.hidden));
        // The load of this moment, put on at `since`, read at `time`.
        let mut stand = |wrench: &[f64; 6], since: f64, time: f64| {
            let moment = Moment { held: time - since, warmer: rig.warmer(time) };
            let settled = posed.settle_after(wrench, &mut memory, moment);
            let moved = [settled.displacement, settled.rotation].map(Vector3::from);
            let grown = |(moved, creep): (Vector3<f64>, &mut Option<Creep>)| {
                moved + creep.as_mut().map_or_else(Vector3::zeros, |creep| creep.adds(&moved, since, time))
            };
            let [displacement, rotation] = &mut creep;
            let (displacement, rotation) = (grown((moved[0], displacement)), grown((moved[1], rotation)));
            let tool = posed.tool();
            let at = Vector3::from(posed.tcp()) + tool * self.read_at();
            let displacement = self.at_marker(&tool, displacement, &rotation);
            let grown = |(turn, creep): (f64, &mut Option<Creep>)| grown((Vector3::new(turn, 0.0, 0.0), creep)).x;
            let mut joints = settled.joints.into_iter().zip(&mut of_joints).map(grown);
            let turned = [std::array::from_fn(|_| joints.next().unwrap_or(0.0)), settled.motors];
            (Stand { time, q: &visit.q, at, tool, displacement, rotation }, turned)
        };
        let first = turn * loads;
        let before = |time: f64, index: usize| if self.unloaded_first { pace * (index + 1) as f64 } else { time };
        let begins = start + pace * first as f64;
        let (mut unloaded, _) = stand(&[0.0; 6], begins - pace, begins);
        let index = if self.shares_unloaded { turn } else { first };
        unloaded.time = before(if self.shares_unloaded { begins } else { begins + 0.5 * pace }, index);
        for (count, (share, reading)) in self.ramp.iter().zip(&visit.readings).enumerate() {
            let time = start + pace * (first + count + 1) as f64;
            let mut since = time - pace;
            if !self.shares_unloaded {
                if !self.unloaded_first {
                    since += 0.5 * pace;
                    if count > 0 {
                        (unloaded, _) = stand(&[0.0; 6], time - pace, since);
                    }
                }
                unloaded.time = before(since, first + count);
            }
            let acting = visit.greatest.map(|component| component * share);
            let (loaded, [joints, motors]) = stand(&acting, since, time);
            let (mut displacement, rotation) = rig.between(&unloaded, &loaded);
            for hidden in &self.hidden {
                if let Hidden::Outliers { share, size } = *hidden
                    && reading.wild.0 < share
                {
                    displacement = (Vector3::from(displacement) + reading.wild.1 * size).into();
                }
            }
            let read =
                |exact: [f64; 3], first: usize| std::array::from_fn(|axis| exact[axis] + reading.noise[first + axis]);
            let grew = count == 0 || share.abs() >= self.ramp[count - 1].abs();
            let cell = rig.cell(&acting, grew, (&visit.q, &loaded.tool));
            rows.push(Row {
                pose: visit.pose,
                visit: if self.shares_unloaded { visit.visit } else { visit.visit * loads + count },
                time,
                temperature: rig.temperature(time),
                q: visit.q.clone(),
                wrench: if self.wrench_in_tool { in_frame(&loaded.tool, &cell) } else { cell },
                acting,
                displacement: read(displacement, 0),
                rotation: self.rotation_noise.map(|_| read(rotation, 3)),
                exact_displacement: displacement,
                exact_rotation: rotation,
                encoders: self
                    .encoders
                    .and_then(|one| one.output)
                    .map(|_| visit.q.iter().enumerate().map(|(k, q)| q + joints[k] + reading.angles[k]).collect()),
                motors: self
                    .encoders
                    .and_then(|one| one.motors)
                    .map(|_| visit.q.iter().zip(motors).map(|(q, turned)| q + turned).collect()),
            });
        }
    }

    /// A pose within the limits and the working region.
    fn pose(&self, arm: &Arm, random: &mut ChaCha8Rng) -> Vec<f64> {
        for _ in 0..TRIES {
            let within = self.truth.joints.iter().map(|joint| match (joint.limits, joint.kind) {
                (Some([low, high]), _) => low..=high,
                (None, JointKind::Revolute) => -2.0..=2.0,
                (None, JointKind::Prismatic) => 0.0..=1.0,
            });
            let q: Vec<f64> = within.map(|range| random.random_range(range)).collect();
            let [x, y, z] = arm.tcp(&q);
            let [foot_x, foot_y, _] = self.truth.base.xyz;
            if z >= self.floor && (x - foot_x).hypot(y - foot_y) >= self.column {
                return q;
            }
        }
        panic!("{} has no pose in the working region", self.truth.name)
    }

    /// The greatest wrench of a visit.
    fn greatest(&self, random: &mut ChaCha8Rng) -> [f64; 6] {
        let mut pull = |[low, high]: [f64; 2]| direction(random) * random.random_range(low..=high);
        let force = pull(self.force);
        let moment = self.moment.map_or_else(Vector3::zeros, pull);
        [force.x, force.y, force.z, moment.x, moment.y, moment.z]
    }

    /// The noise of one reading, of the position and of the rotation.
    fn reading(&self, random: &mut ChaCha8Rng, tails: &mut ChaCha8Rng) -> [f64; 6] {
        let turn = self.rotation_noise.unwrap_or(0.0);
        let [x, y, z] = self.axis_noise;
        let sigma = [x * self.noise, y * self.noise, z * self.noise, x * turn, y * turn, z * turn];
        sigma.map(|sigma| {
            let tail = self.tails.map_or(1.0, |freedom| tail(freedom, tails));
            sigma * normal(random) * tail
        })
    }
}

/// A visit as planned.
struct Visit {
    pose: usize,
    visit: usize,
    q: Vec<f64>,
    greatest: [f64; 6],
    readings: Vec<Reading>,
}

/// What is random about a row.
struct Reading {
    /// Of the loaded less the unloaded reading.
    noise: [f64; 6],
    wild: (f64, Vector3<f64>),
    /// Of the encoders behind the gears (rad or m).
    angles: Turns,
}

/// The arm with every part of every joint's compliance changed by a random
/// factor out of `factors`: what a maker's data sheet and the machine in the
/// hall have in common.
pub fn scattered(arm: &Description, factors: Range<f64>, seed: u64) -> Description {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut arm = arm.clone();
    for part in arm.joints.iter_mut().flat_map(|joint| &mut joint.compliance) {
        part.value *= random.random_range(factors.clone());
    }
    arm
}

/// A campaign that was simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulated {
    /// What was asked for.
    pub scenario: Scenario,
    /// The measurements, visit after visit.
    pub rows: Vec<Row>,
}

/// One measurement, with the truth behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The pose, from 0.
    pub pose: usize,
    /// The load sequence, from 0, counted over the whole campaign.
    pub visit: usize,
    /// Time since the beginning (s).
    pub time: f64,
    /// Temperature in the hall (C).
    pub temperature: f64,
    /// Joint coordinates (rad or m).
    pub q: Vec<f64>,
    /// Wrench `[f; m]` (N, Nm) as the load cell has it, where the loads act, in
    /// the file's frame.
    pub wrench: [f64; 6],
    /// The wrench that really acts there (N, Nm), in the base frame.
    pub acting: [f64; 6],
    /// Measured displacement where the readings are taken (m), in the file's
    /// frame.
    pub displacement: [f64; 3],
    /// Measured rotation of the tool (rad), in the file's frame, if measured.
    pub rotation: Option<[f64; 3]>,
    /// The joints' coordinates behind the gears under the load (rad or m), where
    /// they are read.
    pub encoders: Option<Vec<f64>>,
    /// The same of the motors.
    pub motors: Option<Vec<f64>>,
    /// The displacement as it would be read without noise (m).
    pub exact_displacement: [f64; 3],
    /// The rotation as it would be read without noise (rad).
    pub exact_rotation: [f64; 3],
}
