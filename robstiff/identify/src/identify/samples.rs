//! A campaign's displacements seen from the robot: every row brought to the
//! base frame, with what turns loads and compliances into displacements.

use std::sync::Arc;

use nalgebra::{DVector, Vector3, Vector6};
use robstiff::Effect;
use robstiff::elements::{Spring, Torque, turn};
use robstiff_robots::Description;
use robstiff_robots::effect::physics::PLAYS;

use super::column::Column;
use crate::campaign::Displacements;
use crate::model::law::{play, unit_law};
use crate::model::spring::{ACROSS, ALL, Site};
use crate::model::{Frame, Term, World, described};
use crate::observe::Observation;
use crate::observe::displacement::Displacement;
use crate::observe::elastic::{Loaded, Sequence, yielding};
use crate::observe::equilibrium::{Beyond, beyond_linear};

/// The rows of a campaign of kind `displacement`, on a robot.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Axes per row: 3, or 6 where every row has a rotation.
    pub axes: usize,
    /// The joints (from 1) whose angle is read on the output side of the gear.
    pub encoders: Arc<[usize]>,
    /// The number of poses.
    pub poses: usize,
    /// The rows, in the campaign's order.
    pub rows: Vec<Sample>,
    /// The declared changes of joints' compliances with their own coordinates, which
    /// are shares of these and so grow with them.
    varying: Arc<[Effect]>,
    /// The arm and the rig as declared.
    world: Arc<World>,
    /// The arm under the loads.
    loaded: Arc<Loaded>,
    sequence: Arc<Sequence>,
}

/// One row: what pulled, what was read; everything in the base frame.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Index of the pose.
    pub pose: usize,
    /// Index of the visit.
    pub visit: usize,
    /// The tool centre point's frame.
    pub tcp: Frame,
    /// The wrench at the TCP (N, Nm).
    pub wrench: Vector6<f64>,
    /// From the TCP to the point whose displacement is read (m).
    pub marker: Vector3<f64>,
    /// The displacement read there (m), without what the motors let through.
    pub displacement: Vector3<f64>,
    /// The rotation read (rad).
    pub rotation: Vector3<f64>,
    /// What the motors let through of the load, as it is read (m).
    pub given: Vector3<f64>,
    /// By how much each joint that has an encoder turns beyond its motor (rad or
    /// m).
    pub turned: Vec<f64>,
}

impl Samples {
    /// The rows of a campaign on the robot of a description.
    pub fn of_description(description: &Description, data: &Displacements) -> Self {
        let observation = Displacement::new(description, data);
        let (parameters, values) = described::as_declared(description);
        let (world, readings) = (observation.world().clone(), observation.readings());
        let loaded = observation.loaded(&world, &parameters, &values);
        let (first, width) = (readings.width - observation.encoders.len(), readings.width);
        let row = |(i, row): (usize, &crate::campaign::Observation)| {
            let tcp = loaded.stands[loaded.station[i]].tcp;
            let read = &readings.values.as_slice()[i * width..][..width];
            let three = |from: usize| observation.in_base(i, &Vector3::from_column_slice(&read[from..from + 3]));
            let displacement = three(0);
            Sample {
                pose: row.pose,
                visit: row.visit,
                tcp,
                wrench: loaded.wrenches[i],
                marker: world.rig.marker(&tcp),
                displacement,
                rotation: if first > 3 { three(3) } else { Vector3::zeros() },
                given: observation.in_base(i, &row.displacement.into()) - displacement,
                turned: read[first..].to_vec(),
            }
        };
        Self {
            axes: first,
            encoders: observation.encoders.as_slice().into(),
            poses: data.poses.len(),
            rows: data.rows.iter().enumerate().map(row).collect(),
            varying: description.effects.iter().filter(|effect| is_share(effect)).copied().collect(),
            world: Arc::new(world),
            sequence: Arc::new(observation.sequence().clone()),
            loaded: Arc::new(loaded),
        }
    }

    /// The number of joints.
    pub fn joints(&self) -> usize {
        self.loaded.kinds.len()
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
        let Some(yielding) = yielding(&term_of(column), &self.loaded, &self.sequence, &self.encoders) else {
            return DVector::zeros(self.length());
        };
        let share = |at: usize| self.share(column, at);
        let read = |at: usize, row: &Sample| row.read(&(yielding.twists[at] * share(at)));
        self.stacked_with(read, |at, k| yielding.turns[k][at] * share(at))
    }

    /// What a unit of a column's number is at a row: of a
    /// joint whose compliance varies with its coordinate it is a share.
    fn share(&self, column: Column, row: usize) -> f64 {
        let Column::Spring(Spring::Joint(joint)) = column else { return 1.0 };
        let q = self.sequence.q[joint - 1][row];
        let of_joint = self.varying.iter().filter(|effect| effect.row() == Some(joint));
        let change = |effect: &Effect| turn(effect, 1.0, q, Torque::of(1.0), [0.0; PLAYS]).unwrap_or(0.0);
        1.0 + of_joint.map(change).sum::<f64>()
    }

    /// The twist of the TCP per unit of each joint at a row: the columns of the Jacobian.
    pub fn twists(&self, row: usize) -> &[Vector6<f64>] {
        &self.loaded.twists[self.loaded.station[row]]
    }

    /// The second order of the joints' springs, of these compliances (rad/Nm or m/N), at a row.
    pub fn beyond_linear(&self, row: usize, compliance: &[f64]) -> Beyond {
        let q: Vec<f64> = self.sequence.q.iter().map(|of_joint| of_joint[row]).collect();
        let rest = (&self.loaded.stands[self.loaded.station[row]], q.as_slice(), [].as_slice());
        let own = (self.loaded.kinds.as_slice(), compliance);
        beyond_linear(&self.world, own, rest, &self.rows[row].wrench, self.twists(row))
    }

    /// The visit of each row.
    pub fn visits(&self) -> Vec<usize> {
        self.rows.iter().map(|row| row.visit).collect()
    }

    /// Stacks one vector of six a row and its index, its first [`axes`](Self::axes) numbers, and
    /// what the encoders read: of a row, by its index, and an encoder.
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

/// What a unit of a column's number does.
fn term_of(column: Column) -> Term {
    use crate::model::Spring as Of;
    match column {
        Column::Spring(spring) => Term::Spring(match spring {
            Spring::Joint(joint) => Of::Joint(joint),
            Spring::Coupling(joints) => Of::Coupling(joints),
            Spring::Transverse(joint) => Of::Turn(Site::Joint(joint), ACROSS),
            Spring::LinkBending(link) => Of::Bending(link),
            Spring::LinkTorsion(link) => Of::Torsion(link),
            Spring::BaseTilt => Of::Turn(Site::Base, ACROSS),
            Spring::BaseTranslation => Of::Shift(Site::Base, ALL),
            Spring::ToolRotation => Of::Turn(Site::Flange, ALL),
            Spring::ToolTranslation => Of::Shift(Site::Flange, ALL),
        }),
        Column::Knee { joint, knee } => {
            Term::Law(joint, unit_law(Effect::StiffnessNonlinearity { joint, added: 1.0, knee }))
        }
        Column::Gap { joint, knee } => Term::Law(joint, unit_law(Effect::LostMotion { joint, gap: 1.0, knee })),
        Column::Play { joint, radius, .. } => Term::Law(joint, play(radius)),
    }
}

impl Sample {
    /// An elastic twist of the TCP as it is read at the marker: `[I, -[p_r -
    /// p]x]`.
    pub fn read(&self, twist: &Vector6<f64>) -> Vector6<f64> {
        let moved: Vector3<f64> = twist.fixed_rows::<3>(0).into_owned();
        let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
        stack(&(moved + turn.cross(&self.marker)), &turn)
    }
}

/// A translation and a rotation as one vector of six.
pub fn stack(translation: &Vector3<f64>, rotation: &Vector3<f64>) -> Vector6<f64> {
    let mut six = Vector6::zeros();
    six.fixed_rows_mut::<3>(0).copy_from(translation);
    six.fixed_rows_mut::<3>(3).copy_from(rotation);
    six
}
