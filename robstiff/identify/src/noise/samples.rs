//! A campaign's displacements seen from the robot: every row brought to the base frame.

use nalgebra::{DVector, Vector3, Vector6};
use robstiff_robots::Description;

use crate::campaign::Displacements;
use crate::model::{Frame, described};
use crate::observe::Observation;
use crate::observe::displacement::Displacement;
use crate::observe::elastic::Loaded;

/// The rows of a campaign of kind `displacement`, on a robot.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Axes per row: 3, or 6 where every row has a rotation.
    pub axes: usize,
    /// The number of poses.
    pub poses: usize,
    /// The rows, in the campaign's order.
    pub rows: Vec<Sample>,
    /// The arm under the loads.
    loaded: Loaded,
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
}

impl Samples {
    /// The rows of a campaign on the robot of a description, which an observation is of.
    pub fn of(observation: &Displacement<'_>, description: &Description, data: &Displacements) -> Self {
        let (parameters, values) = described::as_declared(description);
        let (world, readings) = (observation.world().clone(), observation.readings());
        let loaded = observation.loaded(&world, &parameters, &values);
        let axes = readings.width - observation.encoders.len();
        let row = |(i, row): (usize, &crate::campaign::Observation)| {
            let tcp = loaded.stands[loaded.station[i]].tcp;
            let [displacement, rotation] = in_base(observation, &readings.values, i);
            Sample {
                pose: row.pose,
                visit: row.visit,
                tcp,
                wrench: loaded.wrenches[i],
                marker: world.rig.marker(&tcp),
                displacement,
                rotation,
                given: observation.in_base(i, &row.displacement.into()) - displacement,
            }
        };
        let rows = data.rows.iter().enumerate().map(row).collect();
        Self { axes, poses: data.poses.len(), rows, loaded }
    }

    /// The same with this much, stacked as an observation of them stacks readings, taken from what was read.
    #[must_use]
    pub fn less(mut self, observation: &Displacement<'_>, stacked: &DVector<f64>) -> Self {
        for (i, row) in self.rows.iter_mut().enumerate() {
            let [displacement, rotation] = in_base(observation, stacked, i);
            row.displacement -= displacement;
            row.rotation -= rotation;
        }
        self
    }

    /// The displacement (m) and the rotation (rad) of a row, the first [`axes`](Self::axes) of both.
    pub fn reading(&self, row: usize) -> Vec<f64> {
        let row = &self.rows[row];
        row.displacement.iter().chain(&row.rotation).copied().take(self.axes).collect()
    }

    /// The twist of the TCP per unit of each joint at a row: the columns of the Jacobian.
    pub fn twists(&self, row: usize) -> &[Vector6<f64>] {
        &self.loaded.twists[self.loaded.station[row]]
    }

    /// The visit of each row.
    pub fn visits(&self) -> Vec<usize> {
        self.rows.iter().map(|row| row.visit).collect()
    }
}

/// What stacked readings have of a row, in the base frame: the displacement (m), and the rotation (rad) where it is read.
fn in_base(observation: &Displacement<'_>, stacked: &DVector<f64>, row: usize) -> [Vector3<f64>; 2] {
    let readings = observation.readings();
    let read = &stacked.as_slice()[row * readings.width..][..readings.width];
    let three = |from: usize| observation.in_base(row, &Vector3::from_column_slice(&read[from..from + 3]));
    [three(0), if readings.channels.contains(&1) { three(3) } else { Vector3::zeros() }]
}

impl Sample {
    /// An elastic twist of the TCP as it is read at the marker: `[I, -[p_r -
    /// p]x]`.
    pub fn read(&self, twist: &Vector6<f64>) -> Vector6<f64> {
        let moved: Vector3<f64> = twist.fixed_rows::<3>(0).into_owned();
        let turn: Vector3<f64> = twist.fixed_rows::<3>(3).into_owned();
        let moved = moved + turn.cross(&self.marker);
        Vector6::new(moved.x, moved.y, moved.z, turn.x, turn.y, turn.z)
    }
}
