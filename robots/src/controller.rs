//! What the controller of a robot calls its joints, and where it counts from.

use crate::placement::Placement;

/// How a controller sees its robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Controller {
    /// How the pendant's coordinates become joint coordinates, one a joint.
    pub joints: Vec<Pendant>,
    /// The controller's world in the base frame.
    pub world: Placement,
    /// The controller's flange, in which its tools stand, in the flange frame.
    pub flange: Placement,
    /// The description that the controller itself solves with, as a path from this
    /// file; `None` where that is the robot's table without effects.
    pub nominal: Option<String>,
}

/// How the coordinate of a joint follows from what the pendant shows:
/// `q = offset + sign (t + sum of factor t_j)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Pendant {
    /// Whether the two count in opposite directions: the sign is -1.
    pub reversed: bool,
    /// The coordinate where the pendant shows 0 for all joints (rad or m).
    pub offset: f64,
    /// What joints before it add: the joint (from 1) and its factor. FANUC counts joint
    /// 3 from the ground: `(2, 1.0)`.
    pub add: Vec<(usize, f64)>,
}

impl Default for Pendant {
    fn default() -> Self {
        Self { reversed: false, offset: 0.0, add: Vec::new() }
    }
}

impl Pendant {
    fn sign(&self) -> f64 {
        if self.reversed { -1.0 } else { 1.0 }
    }

    /// What the joints before add to a pendant whose coordinates these are (rad or m).
    fn added(&self, t: &[f64]) -> f64 {
        self.add.iter().map(|&(joint, factor)| factor * t[joint - 1]).sum()
    }
}

impl Controller {
    /// The joint coordinates (rad or m) where the pendant shows these (rad or m), one a
    /// joint.
    ///
    /// # Panics
    /// If there is another number of them than of joints.
    pub fn pendant_to_q(&self, t: &[f64]) -> Vec<f64> {
        assert_eq!(t.len(), self.joints.len(), "a coordinate for each joint");
        self.joints.iter().zip(t).map(|(joint, own)| joint.offset + joint.sign() * (own + joint.added(t))).collect()
    }

    /// What the pendant shows (rad or m) at joint coordinates (rad or m), one a joint.
    ///
    /// # Panics
    /// If there is another number of them than of joints.
    pub fn q_to_pendant(&self, q: &[f64]) -> Vec<f64> {
        assert_eq!(q.len(), self.joints.len(), "a coordinate for each joint");
        let mut t = Vec::with_capacity(q.len());
        for (joint, q) in self.joints.iter().zip(q) {
            // Only joints before it add to it, and they are known by now.
            let added = joint.added(&t);
            t.push(joint.sign() * (q - joint.offset) - added);
        }
        t
    }
}
