// What one writes without a library for robots: a loop over the DH table in
// nalgebra's matrices of fixed size, and `J H_q J^T`.

use robstiff::nalgebra::{Matrix4, Matrix6, SMatrix, SVector};
use robstiff_robots::Description;

/// A row of the DH table, with the sine and cosine of its twist.
struct Row {
    theta: f64,
    d: f64,
    a: f64,
    twist: (f64, f64),
}

/// An arm with `N` turning joints.
pub struct Arm<const N: usize> {
    rows: [Row; N],
    soft: SVector<f64, N>,
}

impl<const N: usize> Arm<N> {
    pub fn new(description: &Description) -> Self {
        let joints = &description.joints;
        Self {
            rows: std::array::from_fn(|i| Row {
                theta: joints[i].theta,
                d: joints[i].d,
                a: joints[i].a,
                twist: joints[i].alpha.sin_cos(),
            }),
            soft: SVector::from_fn(|i, _| joints[i].compliance()),
        }
    }

    /// The frames of the joints, and the tip.
    fn frames(&self, q: &SVector<f64, N>) -> ([Matrix4<f64>; N], Matrix4<f64>) {
        let mut frame = Matrix4::identity();
        let joints = std::array::from_fn(|i| {
            let Row { theta, d, a, twist: (sa, ca) } = self.rows[i];
            let (s, c) = (theta + q[i]).sin_cos();
            #[rustfmt::skip]
            let link = Matrix4::new(
                c, -s * ca, s * sa, a * c,
                s, c * ca, -c * sa, a * s,
                0.0, sa, ca, d,
                0.0, 0.0, 0.0, 1.0,
            );
            let joint = frame;
            frame *= link;
            joint
        });
        (joints, frame)
    }

    pub fn transform(&self, q: &SVector<f64, N>) -> Matrix4<f64> {
        self.frames(q).1
    }

    /// Translation first; and the tip's frame.
    pub fn jacobian(&self, q: &SVector<f64, N>) -> (SMatrix<f64, 6, N>, Matrix4<f64>) {
        let (joints, tip) = self.frames(q);
        let mut jacobian = SMatrix::<f64, 6, N>::zeros();
        for (i, joint) in joints.iter().enumerate() {
            let axis = joint.fixed_view::<3, 1>(0, 2).into_owned();
            let arm = tip.fixed_view::<3, 1>(0, 3) - joint.fixed_view::<3, 1>(0, 3);
            jacobian.fixed_view_mut::<3, 1>(0, i).copy_from(&axis.cross(&arm));
            jacobian.fixed_view_mut::<3, 1>(3, i).copy_from(&axis);
        }
        (jacobian, tip)
    }

    pub fn compliance(&self, jacobian: &SMatrix<f64, 6, N>) -> Matrix6<f64> {
        let mut soft = *jacobian;
        soft.column_iter_mut().zip(&self.soft).for_each(|(mut column, h)| column *= *h);
        soft * jacobian.transpose()
    }
}
