//! A measuring campaign on a simulated arm.

use std::ops::Range;

use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_robots::{Description, Effect, JointKind};

use super::Arm;

/// Draws of one pose before giving up on the working region.
const TRIES: usize = 10_000;

/// Seconds from one row to the next.
const PACE: f64 = 60.0;

/// What is measured on which arm, and how well.
///
/// The poses, the loads and the noise come from random streams of their own:
/// with the same seed, another noise or another hidden effect leaves the poses
/// and the loads as they are.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The arm as it really is; its effects are in the measurements too.
    pub truth: Description,
    /// Effects that no description is told of.
    pub hidden: Vec<Effect>,
    /// Number of poses.
    pub poses: usize,
    /// Load sequences a pose, each with its own direction.
    pub visits: usize,
    /// The loads of a visit, in order, as shares of the visit's greatest load.
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
    /// Whether `campaign.yaml` states the noise.
    pub states_noise: bool,
    /// Whether the rows of a visit share one unloaded reading, or each row has
    /// its own. A displacement is a loaded minus an unloaded reading.
    pub shares_unloaded: bool,
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
            hidden,
            poses: 40,
            visits: 2,
            ramp: vec![0.35, 0.7, 1.0, 0.7, 0.35],
            force: [500.0, 1300.0],
            moment: None,
            noise: 8e-6,
            rotation_noise: None,
            states_noise: false,
            shares_unloaded: true,
            floor: 0.1,
            column: 0.6,
            seed,
        }
    }

    /// Measures.
    ///
    /// # Panics
    ///
    /// Where an effect does not fit the arm, the arm buckles, or no pose within
    /// the joints' limits keeps the TCP within the working region.
    pub fn run(&self) -> Simulated {
        let arm = Arm::new(&self.truth, &self.hidden);
        let [mut poses, mut loads, mut noise] = [0, 1, 2].map(|stream| {
            let mut random = ChaCha8Rng::seed_from_u64(self.seed);
            random.set_stream(stream);
            random
        });
        let mut rows = Vec::with_capacity(self.poses * self.visits * self.ramp.len());
        for pose in 0..self.poses {
            let q = self.pose(&arm, &mut poses);
            let posed = arm.at(&q);
            for visit in 0..self.visits {
                let greatest = self.greatest(&mut loads);
                let mut unloaded = self.reading(&mut noise);
                for (count, share) in self.ramp.iter().enumerate() {
                    let wrench = greatest.map(|component| component * share);
                    let settled = posed.settle(&wrench);
                    if count > 0 && !self.shares_unloaded {
                        unloaded = self.reading(&mut noise);
                    }
                    let loaded = self.reading(&mut noise);
                    let read = |exact: [f64; 3], first: usize| {
                        std::array::from_fn(|axis| exact[axis] + loaded[first + axis] - unloaded[first + axis])
                    };
                    let time = PACE * (rows.len() + 1) as f64;
                    rows.push(Row {
                        pose,
                        visit: pose * self.visits + visit,
                        time,
                        // A hall that warms up over a morning.
                        temperature: 21.0 - 4.0 * (-time / 7200.0).exp_m1(),
                        q: q.clone(),
                        wrench,
                        displacement: read(settled.displacement, 0),
                        rotation: self.rotation_noise.map(|_| read(settled.rotation, 3)),
                        exact_displacement: settled.displacement,
                        exact_rotation: settled.rotation,
                    });
                }
            }
        }
        Simulated { scenario: self.clone(), rows }
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
    fn reading(&self, random: &mut ChaCha8Rng) -> [f64; 6] {
        let turn = self.rotation_noise.unwrap_or(0.0);
        [self.noise, self.noise, self.noise, turn, turn, turn].map(|sigma| sigma * normal(random))
    }
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

/// A standard normal variate (Box and Muller).
fn normal(random: &mut ChaCha8Rng) -> f64 {
    // The logarithm needs a number above zero.
    let radius = (-2.0 * (1.0 - random.random::<f64>()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.random::<f64>()).cos()
}

/// A direction, all equally likely.
fn direction(random: &mut ChaCha8Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| normal(random)).normalize()
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
    /// Temperature in the hall (C); nothing depends on it.
    pub temperature: f64,
    /// Joint coordinates (rad or m).
    pub q: Vec<f64>,
    /// Wrench `[f; m]` (N, Nm) at the TCP, in the base frame.
    pub wrench: [f64; 6],
    /// Measured displacement of the TCP (m), in the base frame.
    pub displacement: [f64; 3],
    /// Measured rotation of the tool (rad), in the base frame, if measured.
    pub rotation: Option<[f64; 3]>,
    /// The displacement without noise (m).
    pub exact_displacement: [f64; 3],
    /// The rotation without noise (rad).
    pub exact_rotation: [f64; 3],
}

#[cfg(test)]
mod tests {
    use super::super::{five_axis, six_axis};
    use super::*;

    fn tilt() -> Vec<Effect> {
        vec![Effect::TransverseCompliance { joint: 3, value: 6e-7 }]
    }

    #[test]
    fn the_seed_says_it_all() {
        let scenario = Scenario::new(five_axis(), tilt(), 7);
        assert_eq!(scenario.run(), scenario.run());
        let other = Scenario { seed: 8, ..scenario.clone() }.run();
        assert_ne!(scenario.run().rows[0].q, other.rows[0].q);
        assert_ne!(scattered(&five_axis(), 0.7..1.3, 1), scattered(&five_axis(), 0.7..1.3, 2));
    }

    #[test]
    fn another_noise_or_effect_keeps_poses_and_loads() {
        let one = Scenario::new(six_axis(), tilt(), 3).run();
        let other =
            Scenario { rotation_noise: Some(5e-5), noise: 0.0, hidden: Vec::new(), ..one.scenario.clone() }.run();
        for (one, other) in one.rows.iter().zip(&other.rows) {
            assert_eq!((&one.q, one.wrench), (&other.q, other.wrench));
            assert_ne!(one.exact_displacement, other.exact_displacement);
            assert_eq!(other.displacement, other.exact_displacement);
        }
    }

    #[test]
    fn rows_come_in_visits_and_ramps() {
        for truth in [five_axis(), six_axis()] {
            let scenario = Scenario { moment: Some([50.0, 200.0]), ..Scenario::new(truth, Vec::new(), 11) };
            let rows = scenario.run().rows;
            assert_eq!(rows.len(), 400);
            for (index, row) in rows.iter().enumerate() {
                assert_eq!((row.pose, row.visit), (index / 10, index / 5));
                let peak = &rows[index / 5 * 5 + 2].wrench;
                let share = [0.35, 0.7, 1.0, 0.7, 0.35][index % 5];
                assert!(row.wrench.iter().zip(peak).all(|(value, peak)| *value == share * peak));
                let size = |first: usize| Vector3::from_row_slice(&peak[first..first + 3]).norm();
                assert!((500.0..=1300.0).contains(&size(0)) && (50.0..=200.0).contains(&size(3)));
                for (q, joint) in row.q.iter().zip(&scenario.truth.joints) {
                    let [low, high] = joint.limits.unwrap();
                    assert!((low..=high).contains(q));
                }
                let [x, y, z] = Arm::new(&scenario.truth, &[]).tcp(&row.q);
                assert!(z >= 0.1 && x.hypot(y) >= 0.6);
                // A tenth of a millimetre to a few, as on the real machines.
                let moved = Vector3::from(row.exact_displacement).norm();
                assert!((1e-5..1.5e-2).contains(&moved), "{moved}");
            }
        }
    }

    /// Sums of the noise of each visit, and the sum of squares about the
    /// visits' means, over all three axes, by their expected values without
    /// anything shared.
    fn between_and_within(shares_unloaded: bool) -> [f64; 2] {
        let rows = Scenario { shares_unloaded, poses: 1000, ..Scenario::new(five_axis(), Vec::new(), 5) }.run().rows;
        let (mut between, mut within) = (0.0, 0.0);
        for visit in rows.chunks(5) {
            for axis in 0..3 {
                let noise = visit.iter().map(|row| (row.displacement[axis] - row.exact_displacement[axis]) / 8e-6);
                let mean = noise.clone().sum::<f64>() / 5.0;
                between += mean * mean;
                within += noise.map(|value| (value - mean).powi(2)).sum::<f64>();
            }
        }
        let count = 3.0 * 2000.0;
        [between / count, within / (4.0 * count)]
    }

    #[test]
    fn noise_is_shared_within_a_visit() {
        // Variance of a visit's mean and of a row about it, in sigma squared:
        // shared 1 + 1/5 and 1; each its own 2/5 and 2. The estimates from 6000
        // means scatter by 1.8 %, those from 24000 degrees of freedom by 0.9 %.
        let [between, within] = between_and_within(true);
        assert!((between / 1.2 - 1.0).abs() < 0.06 && (within - 1.0).abs() < 0.03, "{between} {within}");
        let [between, within] = between_and_within(false);
        assert!((between / 0.4 - 1.0).abs() < 0.06 && (within / 2.0 - 1.0).abs() < 0.03, "{between} {within}");
    }

    #[test]
    fn directions_favour_none() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mean = (0..20_000).map(|_| direction(&mut random)).sum::<Vector3<f64>>() / 20_000.0;
        assert!(mean.amax() < 0.02);
    }

    #[test]
    fn scattered_stays_within_the_factors() {
        let declared = six_axis();
        for (one, other) in scattered(&declared, 0.7..1.3, 4).joints.iter().zip(&declared.joints) {
            assert!((0.7..1.3).contains(&(one.compliance() / other.compliance())));
        }
    }
}
