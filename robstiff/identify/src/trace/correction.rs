//! A correction that is no physics: what is left of a campaign by smooth functions
//! of pose and force, where nothing in the catalogue accounts for it.
//!
//! The displacement that is left is put down to joints that turn by more or less
//! under their torque, wherever all joints stand and however large it is: `sum_i
//! J_i tau_i sum_k w_ik phi_k`, `phi` being 1, `cos q_j` and `sin q_j` of every
//! joint, and the size of the torque. The weights are those of a ridge
//! regression (Hoerl and Kennard, Technometrics 12, 1970); how strong the ridge is
//! is found by leaving out poses in turn. It has no name, it explains nothing, and
//! it knows nothing of poses and forces beyond those it was made from. So it is
//! never written into a description, and there is none unless it predicts poses
//! that took no part in making it better than the model alone, by more than
//! twice the standard error of that over poses.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use nalgebra::{Cholesky, DMatrix, DVector, SVector, Vector6};

use super::Trace;
use crate::campaign::{Campaign, Data};
use crate::identify::normal::Normal;
use crate::identify::samples::{Sample, Samples};
use robstiff::elements::Pose;
use robstiff::{JointKind, Robot};

/// A correction with what it is good for.
#[derive(Clone, Debug, PartialEq)]
pub struct Correction {
    /// The functions it is made of, each in words: `joint 3: cos q2`, by which
    /// the turn of joint 3 over its torque (rad/Nm or m/N) goes with `cos q2`.
    pub features: Vec<String>,
    /// The weight of each.
    pub weights: Vec<f64>,
    /// The ridge, as a share of the mean square of each feature.
    pub ridge: f64,
    /// The error on poses that took no part in it (m), without and with it.
    pub unseen: [f64; 2],
    /// How many poses these were.
    pub judged_on: usize,
    /// The coordinates it was made from (rad or m), least and most, by joint.
    pub range: Vec<[f64; 2]>,
    /// The largest force it was made from (N).
    pub largest_force: f64,
    /// The largest torque on each joint (Nm or N), by which torques are measured.
    pub largest_torques: Vec<f64>,
}

/// Ridges that are tried.
const RIDGES: [f64; 8] = [1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0];

/// Parts that poses are shared out to, each left out in turn.
const PARTS: usize = 5;

/// It has to win by so many standard errors over poses.
const WINS: f64 = 2.0;

/// With fewer poses there is nothing to leave out.
const FEWEST_POSES: usize = 10;

impl Correction {
    /// The correction of what a trace leaves, where it is worth having. Poses that
    /// were held out judge it, or where none were, each in its turn.
    pub fn of(campaign: &Campaign, trace: &Trace) -> Option<Self> {
        let Data::Displacement(data) = &campaign.data else { return None };
        if data.poses.len() < FEWEST_POSES {
            return None;
        }
        let samples = Samples::of_description(&trace.description, data);
        let is_wild = |line: usize| trace.effects.iter().any(|named| named.lines.contains(&line));
        let kept: Vec<usize> = (0..samples.rows.len()).filter(|&row| !is_wild(data.rows[row].line)).collect();
        let largest_torque =
            |joint: usize| samples.torques(joint).into_iter().map(f64::abs).fold(f64::MIN_POSITIVE, f64::max);
        let largest_torques: Vec<f64> = (1..=samples.joints()).map(largest_torque).collect();
        let rows = Rows::new(&samples, &kept, &largest_torques, trace);
        let held_out: Vec<bool> = data.poses.iter().map(|id| trace.held_out.contains(id)).collect();
        let (made, judged) = rows.judged(&held_out);
        let made_from = || kept.iter().map(|&row| &samples.rows[row]).filter(|row| !held_out[row.pose]);
        let gains: Vec<f64> = judged.iter().map(|pose| pose.without - pose.with).collect();
        if gains.len() < 2 || !wins(&gains) {
            return None;
        }
        let components: usize = judged.iter().map(|pose| pose.components).sum();
        let rms = |of: fn(&Judged) -> f64| (judged.iter().map(of).sum::<f64>() / components.max(1) as f64).sqrt();
        let range = (0..samples.joints()).map(|joint| {
            let q = || made_from().map(|row| row.q[joint]);
            [q().fold(f64::INFINITY, f64::min), q().fold(f64::NEG_INFINITY, f64::max)]
        });
        let force = |row: &Sample| row.wrench.fixed_rows::<3>(0).norm();
        Some(Self {
            features: names(&samples.joint_kinds),
            weights: made.weights.iter().copied().collect(),
            ridge: made.ridge,
            unseen: [rms(|pose| pose.without), rms(|pose| pose.with)],
            judged_on: gains.len(),
            range: range.collect(),
            largest_force: made_from().map(force).fold(0.0, f64::max),
            largest_torques,
        })
    }

    /// What it adds to the displacement `[d; r]` of the TCP (m, rad) of the robot
    /// it was made for, under a wrench at the TCP (N, Nm), both in the base frame,
    /// at joint coordinates `q` (rad or m).
    ///
    /// # Panics
    /// If there is not one coordinate for each joint.
    pub fn displacement<const N: usize>(
        &self,
        robot: &impl Robot<N>,
        q: &SVector<f64, N>,
        wrench: &Vector6<f64>,
    ) -> Vector6<f64> {
        assert_eq!(N, self.largest_torques.len(), "one coordinate for each joint");
        let pose = Pose::of(robot, q);
        let twists: Vec<Vector6<f64>> = (1..=N).map(|joint| pose.geometry().joint_twist(joint)).collect();
        let features = features(&robot.joint_kinds(), &self.largest_torques, q.as_slice(), &twists, wrench);
        self.weights.iter().zip(features).map(|(weight, feature)| feature * *weight).sum()
    }
}

/// Whether the mean is above zero by more than chance gives.
fn wins(gains: &[f64]) -> bool {
    let count = gains.len() as f64;
    let mean = gains.iter().sum::<f64>() / count;
    let variance = gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / (count - 1.0);
    mean > WINS * (variance / count).sqrt()
}

/// The twists of the TCP that go with each function of pose and load; the
/// coordinate of a joint that slides makes no wave.
fn features(
    joints: &[JointKind],
    largest: &[f64],
    q: &[f64],
    twists: &[Vector6<f64>],
    wrench: &Vector6<f64>,
) -> Vec<Vector6<f64>> {
    let turning = joints.iter().zip(q).filter(|(kind, _)| **kind == JointKind::Revolute);
    let waves: Vec<f64> = std::iter::once(1.0).chain(turning.flat_map(|(_, q)| [q.cos(), q.sin()])).collect();
    let of_joint = |(twist, largest): (&Vector6<f64>, &f64)| {
        let (twist, torque) = (*twist, twist.dot(wrench));
        let size = torque.abs() / largest;
        waves.clone().into_iter().chain([size]).map(move |wave| twist * (torque * wave))
    };
    twists.iter().zip(largest).flat_map(of_joint).collect()
}

fn names(joints: &[JointKind]) -> Vec<String> {
    let turning = (1..).zip(joints).filter(|(_, kind)| **kind == JointKind::Revolute);
    let waves = turning.flat_map(|(joint, _)| [format!("cos q{joint}"), format!("sin q{joint}")]);
    let all: Vec<String> = std::iter::once("1".to_string()).chain(waves).chain(["torque".to_string()]).collect();
    (1..=joints.len()).flat_map(|joint| all.iter().map(move |wave| format!("joint {joint}: {wave}"))).collect()
}

/// Features and what is left, three components a row.
struct Rows {
    x: DMatrix<f64>,
    y: DVector<f64>,
    /// Which of them are of each pose.
    of_pose: Vec<Vec<usize>>,
}

/// Weights, and the ridge that they were found with.
struct Made {
    ridge: f64,
    weights: DVector<f64>,
}

/// The squares left of a pose without and with weights (m^2), and of how many components.
struct Judged {
    without: f64,
    with: f64,
    components: usize,
}

impl Rows {
    /// What a trace leaves of the rows that are kept.
    fn new(samples: &Samples, kept: &[usize], largest_torques: &[f64], trace: &Trace) -> Self {
        let mut x = DMatrix::zeros(3 * kept.len(), names(&samples.joint_kinds).len());
        let mut of_pose = std::vec![Vec::new(); samples.poses];
        for (i, &row) in kept.iter().enumerate() {
            let row = &samples.rows[row];
            let features = features(&samples.joint_kinds, largest_torques, &row.q, &row.twists, &row.wrench);
            for (k, feature) in features.iter().enumerate() {
                x.fixed_view_mut::<3, 1>(3 * i, k).copy_from(&row.read(feature).fixed_rows::<3>(0));
            }
            of_pose[row.pose].extend(3 * i..3 * i + 3);
        }
        let left = kept.iter().flat_map(|&row| trace.residuals[row].after);
        Self { x, y: DVector::from_iterator(3 * kept.len(), left), of_pose }
    }

    /// Weights, and poses that took no part in making such: those that were held out, or where
    /// none were all, a part at a time by the weights of the other parts.
    fn judged(&self, held_out: &[bool]) -> (Made, Vec<Judged>) {
        let poses = || 0..self.of_pose.len();
        if held_out.contains(&true) {
            let made = self.made(&|pose| !held_out[pose]);
            let judged = poses().filter(|&pose| held_out[pose]).filter_map(|pose| self.squares(pose, &made.weights));
            let judged = judged.collect();
            return (made, judged);
        }
        let mut judged = Vec::new();
        for part in 0..PARTS {
            let of_others = self.made(&|pose| pose % PARTS != part);
            let own = poses().filter(|pose| pose % PARTS == part);
            judged.extend(own.filter_map(|pose| self.squares(pose, &of_others.weights)));
        }
        (self.made(&|_| true), judged)
    }

    /// The weights from the poses of some kind, with the ridge that suits them.
    fn made(&self, is_asked: &dyn Fn(usize) -> bool) -> Made {
        let ridge = self.ridge(is_asked);
        Made { ridge, weights: self.solve(ridge, is_asked) }
    }

    /// The weights from the poses of some kind; features are measured by their own
    /// size.
    fn solve(&self, ridge: f64, is_asked: &dyn Fn(usize) -> bool) -> DVector<f64> {
        let asked = self.of_pose.iter().enumerate().filter(|(pose, _)| is_asked(*pose));
        let rows: Vec<usize> = asked.flat_map(|(_, rows)| rows).copied().collect();
        let (x, y) = (self.x.select_rows(&rows), self.y.select_rows(&rows));
        let Normal { mut gram, moment, .. } = Normal::new(&x, &y);
        let least = f64::EPSILON * gram.diagonal().max();
        for k in 0..gram.nrows() {
            gram[(k, k)] += ridge * gram[(k, k)] + least;
        }
        let none = DVector::zeros(x.ncols());
        Cholesky::new(gram).map_or(none, |factor| factor.solve(&moment))
    }

    /// The ridge by which parts of the poses of some kind, each left out in turn,
    /// are predicted best.
    fn ridge(&self, is_asked: &dyn Fn(usize) -> bool) -> f64 {
        let left = |ridge: f64| -> f64 {
            let part = |part: usize| {
                // Along diagonals: by the remainder, which poses that judge are shared out by, what is
                // left out there would be a part of its own here, and empty.
                let out = |pose: usize| (pose / PARTS + pose) % PARTS == part;
                let weights = self.solve(ridge, &|pose| is_asked(pose) && !out(pose));
                let judged = (0..self.of_pose.len()).filter(|&pose| is_asked(pose) && out(pose));
                judged.filter_map(|pose| self.squares(pose, &weights)).map(|judged| judged.with).sum::<f64>()
            };
            (0..PARTS).map(part).sum()
        };
        let tried = RIDGES.map(|ridge| (left(ridge), ridge));
        tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or(1.0, |(_, ridge)| ridge)
    }

    /// What is left of a pose; none where it has no rows.
    fn squares(&self, pose: usize, weights: &DVector<f64>) -> Option<Judged> {
        let rows = &self.of_pose[pose];
        let y = self.y.select_rows(rows);
        let with = &y - self.x.select_rows(rows) * weights;
        let judged = Judged { without: y.norm_squared(), with: with.norm_squared(), components: rows.len() };
        (!rows.is_empty()).then_some(judged)
    }
}
