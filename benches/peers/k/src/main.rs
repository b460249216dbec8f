//! The crate k: its chain and its Jacobian, then `J H_q J^T` in its nalgebra.

use k::nalgebra::{DMatrix, DVector, Isometry3, Translation3, UnitQuaternion, Vector3};
use k::{JointType, NodeBuilder, SerialChain};
use robstiff_robots::Description;

#[path = "../../harness.rs"]
mod harness;

/// The chain of a DH table, whose last node is fixed to the tip, and the joint compliances.
struct Arm {
    chain: SerialChain<f64>,
    soft: DVector<f64>,
}

impl Arm {
    fn new(text: &str) -> Self {
        let joints = Description::parse("the robot", text).expect("it has no mistakes").joints;
        let mut before = Isometry3::identity();
        let mut nodes = Vec::new();
        for joint in &joints {
            let axis = Vector3::z_axis();
            let turn = UnitQuaternion::from_axis_angle(&axis, joint.theta);
            nodes.push(NodeBuilder::new().joint_type(JointType::Rotational { axis }).origin(before * turn).into_node());
            let twist = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), joint.alpha);
            before = Isometry3::from_parts(Translation3::new(joint.a, 0.0, joint.d), twist);
        }
        nodes.push(NodeBuilder::new().joint_type(JointType::Fixed).origin(before).into_node());
        nodes.windows(2).for_each(|pair| pair[1].set_parent(&pair[0]));
        Self {
            chain: SerialChain::from_end(nodes.last().expect("the tip at least")),
            soft: DVector::from_iterator(joints.len(), joints.iter().map(|joint| joint.compliance())),
        }
    }

    fn transform(&self, out: &mut [f64]) {
        self.chain.update_transforms();
        out.copy_from_slice(self.chain.end_transform().to_homogeneous().as_slice());
    }

    fn compliance(&self, jacobian: &DMatrix<f64>, out: &mut [f64]) {
        let mut soft = jacobian.clone();
        soft.column_iter_mut().zip(&self.soft).for_each(|(mut column, h)| column *= *h);
        let full = soft * jacobian.transpose();
        let upper = (0..6).flat_map(|i| (i..6).map(move |j| (i, j)));
        upper.zip(out).for_each(|(at, out)| *out = full[at]);
    }

    /// All ways, `ALL` the number of entries of T, J and H_x together.
    fn measure<const N: usize, const J: usize, const ALL: usize>(&self, robot: &str) {
        let poses = harness::poses::<N>();
        let way = |quantity| [robot, quantity, "crate k 0.32"];
        harness::one(way("T"), &poses, |q, out: &mut [f64; 16]| {
            self.chain.set_joint_positions_unchecked(q);
            self.transform(out);
        });
        harness::one(way("J"), &poses, |q, out: &mut [f64; J]| {
            self.chain.set_joint_positions_unchecked(q);
            out.copy_from_slice(k::jacobian(&self.chain).as_slice());
        });
        harness::one(way("H"), &poses, |q, out: &mut [f64; 21]| {
            self.chain.set_joint_positions_unchecked(q);
            self.compliance(&k::jacobian(&self.chain), out);
        });
        harness::one(way("TJH"), &poses, |q, out: &mut [f64; ALL]| {
            self.chain.set_joint_positions_unchecked(q);
            let jacobian = k::jacobian(&self.chain);
            out[..16].copy_from_slice(self.chain.end_transform().to_homogeneous().as_slice());
            out[16..16 + J].copy_from_slice(jacobian.as_slice());
            self.compliance(&jacobian, &mut out[16 + J..]);
        });
    }
}

fn main() {
    Arm::new(include_str!("../../../../robots/rv130hsc.yaml")).measure::<5, 30, 67>("R5");
    Arm::new(include_str!("../../../robots/six-axis.yaml")).measure::<6, 36, 73>("R6");
}
