//! Postures all over the joint space, for descents to start from.

use core::f64::consts::PI;

use nalgebra::{Matrix4, SVector, Vector3};

use super::descent::Bounds;
use super::target::{Target, translation};
use robstiff::{JointKind, Robot};

/// How many postures are known.
const POSTURES: usize = 2000;

/// Postures with the poses of the tool that belong to them.
#[derive(Clone, Debug)]
pub struct Starts<const N: usize> {
    postures: Vec<(SVector<f64, N>, Matrix4<f64>)>,
    origin: Vector3<f64>,
    longest: f64,
}

impl<const N: usize> Starts<N> {
    /// Postures within the limits; a revolute joint without limits has a whole
    /// turn, a prismatic one the arm's own size to either side.
    pub fn new<R: Robot<N>>(robot: &R, limits: &Bounds<N>, reach: f64) -> Self {
        let kinds = robot.joint_kinds();
        let ranges: Bounds<N> = core::array::from_fn(|i| {
            let half = if kinds[i] == JointKind::Revolute { PI } else { reach };
            let [low, high] = limits[i];
            match (low.is_finite(), high.is_finite()) {
                (true, true) => [low, high],
                (true, false) => [low, low + 2.0 * half],
                (false, true) => [high - 2.0 * half, high],
                (false, false) => [-half, half],
            }
        });
        let strides = strides::<N>();
        let postures = (1..=POSTURES).map(|k| {
            let even = |i: usize| (0.5 + k as f64 * strides[i]).fract();
            let q = SVector::from_fn(|i, _| ranges[i][0] + (ranges[i][1] - ranges[i][0]) * even(i));
            (q, robot.transform(&q))
        });
        let slide = |i: usize| ranges[i].iter().map(|end| end.abs()).fold(0.0, f64::max);
        let slides: f64 = (0..N).filter(|&i| kinds[i] == JointKind::Prismatic).map(slide).sum();
        Self { postures: postures.collect(), origin: translation(&robot.base()), longest: reach + slides }
    }

    /// The postures from which it is nearest to the target, with angles
    /// weighed by a length `scale` (m).
    pub fn nearest_first(&self, target: &Target, count: usize, scale: f64) -> Vec<SVector<f64, N>> {
        let size = |pose: &Matrix4<f64>| {
            let (shift, turn) = target.apart(pose);
            shift.norm_squared() + turn.norm_squared() * scale * scale
        };
        let mut ranked: Vec<(f64, usize)> =
            self.postures.iter().enumerate().map(|(index, (_, pose))| (size(pose), index)).collect();
        ranked.sort_by(|one, other| one.0.total_cmp(&other.0));
        ranked.iter().take(count).map(|&(_, index)| self.postures[index].0).collect()
    }

    /// The origin of frame 0 in the base frame (m).
    pub fn origin(&self) -> Vector3<f64> {
        self.origin
    }

    /// No posture brings the TCP further from there than this (m).
    pub fn longest(&self) -> f64 {
        self.longest
    }
}

/// The length of the arm's links end to end, with the tool (m); 1 for an arm
/// without any.
pub fn reach<const N: usize, R: Robot<N>>(robot: &R) -> f64 {
    let zero = SVector::<f64, N>::zeros();
    let frames = robot.link_frames(&zero);
    let mut last = translation(&robot.base());
    let mut reach = 0.0;
    for point in frames.iter().map(translation).chain([translation(&robot.transform(&zero))]) {
        reach += (point - last).norm();
        last = point;
    }
    if reach > 0.0 { reach } else { 1.0 }
}

/// The strides of evenly spread points from 0 to 1 in `N` dimensions: powers of
/// the generalised golden ratio (Roberts 2018).
fn strides<const N: usize>() -> [f64; N] {
    let mut ratio: f64 = 2.0;
    for _ in 0..60 {
        ratio = (1.0 + ratio).powf(1.0 / (N as f64 + 1.0));
    }
    core::array::from_fn(|i| ratio.powi(-(i as i32 + 1)))
}
