//! A campaign's displacements seen from the robot: every row brought to the
//! base frame, with the geometry that turns loads and compliances into displacements.

use std::sync::Arc;
use std::vec::Vec;

use nalgebra::{DVector, Matrix3, Matrix4, Matrix6, SVector, Vector3, Vector6};
use robstiff_robots::Description;
use robstiff_robots::effect::physics::PLAYS;

use super::column::Column;
use super::setup::Setup;
use crate::campaign::{Displacements, Frame};
use crate::observe::encoders::Encoders;
use robstiff::elements::{Geometry, Pose, Spring, Torque, turn};
use robstiff::{Effect, JointKind, Robot};

/// The rows of a campaign of kind `displacement`, on a robot.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Turning or sliding, a joint each.
    pub joint_kinds: Vec<JointKind>,
    /// Axes per row: 3, or 6 where every row has a rotation.
    pub axes: usize,
    /// The joints (from 1) whose angle is read on the output side of the gear.
    pub encoders: Arc<[usize]>,
    /// The number of poses.
    pub poses: usize,
    /// The declared changes of joints' compliances with their own coordinates, which
    /// are shares of these and so grow with them.
    pub varying: Arc<[Effect]>,
    /// The rows, in the campaign's order.
    pub rows: Vec<Sample>,
}

/// One row: where the robot stood, what pulled, what was read; everything in
/// the base frame.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Index of the pose.
    pub pose: usize,
    /// Index of the visit.
    pub visit: usize,
    /// Joint coordinates (rad or m).
    pub q: Vec<f64>,
    /// Frame 0.
    pub base: Matrix4<f64>,
    /// The frames on whose z axes the joints act; one for all rows in a row
    /// with the same joint coordinates.
    pub joint_frames: Arc<[Matrix4<f64>]>,
    /// The columns of the Jacobian, `[d; r]` of the TCP per unit of each joint.
    pub twists: Arc<[Vector6<f64>]>,
    /// What the arm's own weight puts on the gear of each joint (Nm or N).
    pub preload: Arc<[f64]>,
    /// Frame n.
    pub flange: Matrix4<f64>,
    /// The tool centre point's frame.
    pub tcp: Matrix4<f64>,
    /// The wrench at the TCP (N, Nm).
    pub wrench: Vector6<f64>,
    /// From the TCP to the point whose displacement is read (m).
    pub marker: Vector3<f64>,
    /// The displacement read there (m), without what the motors let through.
    pub displacement: Vector3<f64>,
    /// The rotation read (rad).
    pub rotation: Vector3<f64>,
    /// How a displacement or rotation in the base frame is seen in the
    /// readings.
    pub seen: Matrix3<f64>,
    /// What the motors let through of the load, as it is read: displacement (m)
    /// and rotation (rad).
    pub given: Vector6<f64>,
    /// By how much each joint that has an encoder turns beyond its motor (rad or
    /// m).
    pub turned: Vec<f64>,
}

/// Where the arm stands: what a pose's rows have in common.
struct Stand {
    base: Matrix4<f64>,
    joint_frames: Arc<[Matrix4<f64>]>,
    twists: Arc<[Vector6<f64>]>,
    preload: Arc<[f64]>,
    flange: Matrix4<f64>,
    tcp: Matrix4<f64>,
}

impl Stand {
    fn at<const N: usize>(robot: &impl Robot<N>, q: &SVector<f64, N>) -> Self {
        let pose = Pose::of(robot, q);
        let geometry = pose.geometry();
        Self {
            base: geometry.base,
            joint_frames: geometry.joint_frames.into(),
            twists: (1..=N).map(|joint| geometry.joint_twist(joint)).collect(),
            preload: robot.preload(q).as_slice().into(),
            flange: geometry.flange,
            tcp: geometry.tcp,
        }
    }

    fn of(row: &Sample) -> Self {
        Self {
            base: row.base,
            joint_frames: Arc::clone(&row.joint_frames),
            twists: Arc::clone(&row.twists),
            preload: Arc::clone(&row.preload),
            flange: row.flange,
            tcp: row.tcp,
        }
    }
}

impl Samples {
    /// The rows of a campaign on the robot of a description.
    pub fn of_description(description: &Description, data: &Displacements) -> Self {
        robstiff::with_robot!(description, |robot| Self::new(&robot, data))
    }

    /// The rows of a campaign on a robot, generated or generic.
    pub fn new<const N: usize>(robot: &impl Robot<N>, data: &Displacements) -> Self {
        Self::on(robot, data, &Setup::as_declared(N), None)
    }

    /// The same rows, on the robot of the same description, where file and
    /// description are off by a setup. The readings stay as they are; what a
    /// model predicts of them changes.
    pub fn with_setup(&self, description: &Description, data: &Displacements, setup: &Setup) -> Self {
        robstiff::with_robot!(&setup.description(description), |robot| Self::on(&robot, data, setup, Some(self)))
    }

    fn on<const N: usize>(robot: &impl Robot<N>, data: &Displacements, setup: &Setup, known: Option<&Self>) -> Self {
        let with_rotations = data.rows.iter().all(|row| row.rotation.is_some());
        let mut rows: Vec<Sample> = Vec::with_capacity(data.rows.len());
        let mut encoders = if known.is_none() { Encoders::of(data) } else { Encoders::default() };
        for (i, row) in data.rows.iter().enumerate() {
            let q = setup.coordinates(i, &row.q);
            // The arm stands where it stood, as a rule: a pose has many rows.
            let stand = match rows.last().filter(|last| last.q == q) {
                Some(last) => Stand::of(last),
                None => Stand::at(robot, &SVector::<f64, N>::from_column_slice(&q)),
            };
            let Stand { base, joint_frames, twists, preload, flange, tcp } = stand;
            let tool = turn_of(&tcp);
            let declared = known.map_or(tool, |declared| turn_of(&declared.rows[i].tcp));
            let reads = if data.measured_frame == Frame::Tool { declared } else { Matrix3::identity() };
            let mut sample = Sample {
                pose: row.pose,
                visit: row.visit,
                q,
                base,
                joint_frames,
                twists,
                preload,
                flange,
                tcp,
                wrench: setup.wrench(data, &tool, &row.wrench) * setup.of_load(i),
                marker: tool * (Vector3::from(data.measured_at) + setup.marker),
                displacement: reads * Vector3::from(row.displacement),
                rotation: reads * Vector3::from(row.rotation.unwrap_or_default()),
                seen: setup.seen(data, &declared, &tool),
                given: Vector6::zeros(),
                turned: Vec::new(),
            };
            // What is read does not depend on the setup.
            if let Some(known) = known {
                (sample.given, sample.turned) = (known.rows[i].given, known.rows[i].turned.clone());
            } else {
                let by_motors = encoders.given.get(i).into_iter().flatten().zip(sample.twists.iter());
                sample.given = sample.read(&by_motors.map(|(turned, twist)| twist * *turned).sum());
                sample.turned = encoders.turned.get_mut(i).map(core::mem::take).unwrap_or_default();
            }
            sample.displacement -= sample.given.fixed_rows::<3>(0);
            sample.rotation -= sample.given.fixed_rows::<3>(3);
            rows.push(sample);
        }
        Self {
            joint_kinds: robot.joint_kinds().to_vec(),
            axes: if with_rotations { 6 } else { 3 },
            encoders: known.map_or_else(|| encoders.joints.into(), |known| Arc::clone(&known.encoders)),
            poses: data.poses.len(),
            varying: robot.effects().iter().filter(|effect| is_share(effect)).copied().collect(),
            rows,
        }
    }

    /// The number of joints.
    pub fn joints(&self) -> usize {
        self.joint_kinds.len()
    }

    /// What was read, stacked row by row with [`axes`](Self::axes) numbers
    /// each: displacement (m), then rotation (rad); and behind all of these, row by
    /// row, what each encoder reads (rad or m).
    pub fn readings(&self) -> DVector<f64> {
        self.stacked_with(|_, row| stack(&row.displacement, &row.rotation), |at, k| self.rows[at].turned[k])
    }

    /// The same with this much, stacked like [`readings`](Self::readings), taken from
    /// what was read.
    #[must_use]
    pub fn less(mut self, stacked: &DVector<f64>) -> Self {
        for i in 0..self.rows.len() {
            let of_encoders = self.encoders_of(i);
            let row = &mut self.rows[i];
            row.displacement -= stacked.fixed_rows::<3>(i * self.axes);
            if self.axes > 3 {
                row.rotation -= stacked.fixed_rows::<3>(i * self.axes + 3);
            }
            row.turned.iter_mut().zip(of_encoders).for_each(|(turned, at)| *turned -= stacked[at]);
        }
        self
    }

    /// How many numbers are read.
    pub fn length(&self) -> usize {
        self.rows.len() * (self.axes + self.encoders.len())
    }

    /// The same without the encoders.
    #[must_use]
    pub fn without_encoders(mut self) -> Self {
        self.encoders = Arc::new([]);
        self.rows.iter_mut().for_each(|row| row.turned.clear());
        self
    }

    /// Where the readings of a row's encoders are in a stacked vector.
    pub fn encoders_of(&self, row: usize) -> core::ops::Range<usize> {
        let first = self.rows.len() * self.axes + row * self.encoders.len();
        first..first + self.encoders.len()
    }

    /// What a unit of a column's number adds to the readings, stacked alike.
    pub fn column(&self, column: Column) -> DVector<f64> {
        match column {
            Column::Spring(spring @ Spring::Joint(joint)) => {
                let torques = self.torques(joint);
                self.turned(joint, |at| self.share(spring, &self.rows[at]) * torques[at])
            }
            Column::Knee { joint, .. } | Column::Gap { joint, .. } => {
                self.turned(joint, |at| column.turn(self.rows[at].torque(joint)))
            }
            Column::Play { joint, radius, .. } => {
                let plays = self.plays(joint, radius);
                self.turned(joint, |at| plays[at])
            }
            Column::Spring(spring) => self.under(&[(spring, 1.0)]),
        }
    }

    /// What a joint (from 1) adds that turns by an amount that depends on the row
    /// (rad or m), stacked alike.
    pub fn turned(&self, joint: usize, amount: impl Fn(usize) -> f64) -> DVector<f64> {
        let by_encoder = |at: usize, k: usize| if self.encoders[k] == joint { amount(at) } else { 0.0 };
        self.stacked_with(|at, row| row.read(&(row.twists[joint - 1] * amount(at))), by_encoder)
    }

    /// What springs, each with its compliance, add to the readings, stacked alike.
    pub fn under(&self, springs: &[(Spring, f64)]) -> DVector<f64> {
        let mut stacked = DVector::zeros(self.length());
        let mut compliance = Matrix6::zeros();
        for (i, row) in self.rows.iter().enumerate() {
            if i == 0 || !Arc::ptr_eq(&row.joint_frames, &self.rows[i - 1].joint_frames) {
                let geometry = self.geometry(row);
                let springs = springs.iter().filter(|(_, value)| *value != 0.0);
                let of = |&(spring, value): &(Spring, f64)| {
                    geometry.unit_compliance(spring) * (value * self.share(spring, row))
                };
                compliance = springs.map(of).sum();
            }
            let six = row.read(&(compliance * row.wrench));
            stacked.rows_mut(i * self.axes, self.axes).copy_from(&six.rows(0, self.axes));
            for (at, &joint) in self.encoders_of(i).zip(self.encoders.iter()) {
                let torque = |joint: usize| row.twists[joint - 1].dot(&row.wrench);
                let of = |&(spring, value): &(Spring, f64)| {
                    value * self.share(spring, row) * turn_of_joint(spring, joint, torque)
                };
                stacked[at] = springs.iter().map(of).sum();
            }
        }
        stacked
    }

    /// What a unit of a spring's compliance is at a row: of a
    /// joint whose compliance varies with its coordinate it is a share.
    pub fn share(&self, spring: Spring, row: &Sample) -> f64 {
        let Spring::Joint(joint) = spring else { return 1.0 };
        let of_joint = self.varying.iter().filter(|effect| effect.row() == Some(joint));
        let change =
            |effect: &Effect| turn(effect, 1.0, row.q[joint - 1], Torque::of(1.0), [0.0; PLAYS]).unwrap_or(0.0);
        1.0 + of_joint.map(change).sum::<f64>()
    }

    /// The torque of each row about a joint (from 1), `J_i^T F` (Nm or N).
    pub fn torques(&self, joint: usize) -> Vec<f64> {
        self.rows.iter().map(|row| row.torque(joint).load).collect()
    }

    /// The play operator of a radius on the torque of a joint (from 1) after each row
    /// (Nm), counted from where it rests under the arm's own weight. The rows of a visit are
    /// one load sequence, which begins on a robot that was never loaded.
    pub fn plays(&self, joint: usize, radius: f64) -> Vec<f64> {
        let mut state = std::vec![0.0; self.rows.iter().map(|row| row.visit + 1).max().unwrap_or(0)];
        let play = Column::Play { joint, operator: 0, radius };
        let after = |row: &Sample| {
            let before = &mut state[row.visit];
            *before = play.after(row.torque(joint), *before);
            *before
        };
        self.rows.iter().map(after).collect()
    }

    /// The visit of each row.
    pub fn visits(&self) -> Vec<usize> {
        self.rows.iter().map(|row| row.visit).collect()
    }

    /// The geometry of one of the rows.
    pub fn geometry<'a>(&'a self, row: &'a Sample) -> Geometry<'a, f64> {
        Geometry {
            base: row.base,
            joint_frames: &row.joint_frames,
            joint_kinds: &self.joint_kinds,
            flange: row.flange,
            tcp: row.tcp,
        }
    }

    /// Stacks one vector of six a row, its first [`axes`](Self::axes) numbers.
    pub fn stacked(&self, of: impl Fn(&Geometry<'_, f64>, &Sample) -> Vector6<f64>) -> DVector<f64> {
        self.stacked_by(|_, row| of(&self.geometry(row), row))
    }

    /// The same of a row and its index.
    pub fn stacked_by(&self, of: impl Fn(usize, &Sample) -> Vector6<f64>) -> DVector<f64> {
        self.stacked_with(of, |_, _| 0.0)
    }

    /// The same with what the encoders read: of a row, by its index, and an
    /// encoder.
    pub fn stacked_with(
        &self,
        of: impl Fn(usize, &Sample) -> Vector6<f64>,
        encoder: impl Fn(usize, usize) -> f64,
    ) -> DVector<f64> {
        let mut stacked = DVector::zeros(self.length());
        for (i, row) in self.rows.iter().enumerate() {
            let six = of(i, row);
            stacked.rows_mut(i * self.axes, self.axes).copy_from(&six.rows(0, self.axes));
            self.encoders_of(i).enumerate().for_each(|(k, at)| stacked[at] = encoder(i, k));
        }
        stacked
    }
}

/// Whether an effect is a share of a joint's compliance.
pub fn is_share(effect: &Effect) -> bool {
    matches!(effect, Effect::PoseDependentCompliance { .. })
}

/// What a joint (from 1) turns by for a unit of a spring's compliance (rad or m),
/// given the torque of each joint.
pub fn turn_of_joint(spring: Spring, joint: usize, torque: impl Fn(usize) -> f64) -> f64 {
    match spring {
        Spring::Joint(own) if own == joint => torque(joint),
        Spring::Coupling([i, j]) if i == joint => torque(j),
        Spring::Coupling([i, j]) if j == joint => torque(i),
        _ => 0.0,
    }
}

impl Sample {
    /// What the load puts on a joint (from 1), beside what weighs on it.
    pub fn torque(&self, joint: usize) -> Torque {
        Torque { preload: self.preload[joint - 1], load: self.twists[joint - 1].dot(&self.wrench) }
    }

    /// An elastic twist of the TCP as it is read at the marker: `[I, -[p_r -
    /// p]x]`, turned as the row's setup has it.
    pub fn read(&self, twist: &Vector6<f64>) -> Vector6<f64> {
        let moved: Vector3<f64> = twist.fixed_rows::<3>(0).into_owned();
        let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
        let see = |vector: Vector3<f64>| self.seen * vector;
        stack(&see(moved + turn.cross(&self.marker)), &see(turn))
    }
}

/// The turn of a frame.
pub fn turn_of(frame: &Matrix4<f64>) -> Matrix3<f64> {
    frame.fixed_view::<3, 3>(0, 0).into_owned()
}

/// A translation and a rotation as one vector of six.
pub fn stack(translation: &Vector3<f64>, rotation: &Vector3<f64>) -> Vector6<f64> {
    let mut six = Vector6::zeros();
    six.fixed_rows_mut::<3>(0).copy_from(translation);
    six.fixed_rows_mut::<3>(3).copy_from(rotation);
    six
}
