//! What the benchmarks measure, each as a function of its own, so that a
//! profile shows it under its name.

use robstiff::nalgebra::{Matrix4, Matrix6, SMatrix, SVector, Vector6};
use robstiff::{Generic, Robot, Statics, upper_triangle};
use robstiff_robots::Description;

robstiff::robot!("rv130hsc.yaml");
robstiff::robot!("fanuc-r2000ic.yaml");
robstiff::robot!("kuka-kr270-r2700.yaml");

/// Poses all over the workspace of an arm with `N` joints.
pub fn poses<const N: usize>(count: usize) -> Vec<SVector<f64, N>> {
    (0..count).map(|k| SVector::from_fn(|i, _| 2.0 * f64::sin(1.7 * k as f64 + 2.3 * i as f64))).collect()
}

/// The five-axis arm, read at run time.
pub fn generic() -> Generic<5> {
    let text = robstiff_robots::catalogue::find("rv130hsc.yaml").expect("it is in the catalogue");
    let description = Description::parse("rv130hsc.yaml", text).expect("it has no mistakes");
    Generic::new(&description).expect("it has five joints")
}

/// `H_x`, five axes.
#[inline(never)]
pub fn compliance(q: &SVector<f64, 5>, out: &mut Matrix6<f64>) {
    *out = Rv130hsc.compliance(q);
}

/// The upper triangle of `H_x`, five axes.
#[inline(never)]
pub fn triangle(q: &SVector<f64, 5>, out: &mut [f64; 21]) {
    *out = upper_triangle(&Rv130hsc.compliance(q));
}

/// The upper triangle of `H_x`, six axes with a spherical wrist.
#[inline(never)]
pub fn triangle_of_six(q: &SVector<f64, 6>, out: &mut [f64; 21]) {
    *out = upper_triangle(&KukaKr270R2700.compliance(q));
}

/// `H_x`, six axes.
#[inline(never)]
pub fn compliance_of_six(q: &SVector<f64, 6>, out: &mut Matrix6<f64>) {
    *out = FanucR2000ic.compliance(q);
}

/// The transform, five axes.
#[inline(never)]
pub fn transform(q: &SVector<f64, 5>, out: &mut Matrix4<f64>) {
    *out = Rv130hsc.transform(q);
}

/// The Jacobian, five axes.
#[inline(never)]
pub fn jacobian(q: &SVector<f64, 5>, out: &mut SMatrix<f64, 6, 5>) {
    *out = Rv130hsc.jacobian(q);
}

/// Transform, Jacobian and `H_x` of one pose, five axes.
#[inline(never)]
pub fn statics(q: &SVector<f64, 5>, out: &mut Statics<5, f64>) {
    *out = Rv130hsc.statics(q);
}

/// The deflection, five axes.
#[inline(never)]
pub fn deflection(q: &SVector<f64, 5>, wrench: &Vector6<f64>, out: &mut Vector6<f64>) {
    *out = Rv130hsc.deflection(q, wrench);
}

/// Five sines and cosines.
#[inline(never)]
pub fn five_angles(q: &[f64; 5], out: &mut [(f64, f64); 5]) {
    *out = robstiff::Real::sin_cos_all(*q);
}

/// The trace of the translational block of `H_x`, five axes.
#[inline(never)]
pub fn trace(q: &SVector<f64, 5>) -> f64 {
    let compliance = Rv130hsc.compliance(q);
    compliance[(0, 0)] + compliance[(1, 1)] + compliance[(2, 2)]
}

/// A wrench (N, Nm).
pub const WRENCH: Vector6<f64> = Vector6::new(300.0, -500.0, 700.0, 40.0, -60.0, 80.0);
