//! What yields in proportion to the load.
//!
//! Every elastic coordinate turns about an axis, or slides along it, by its compliance times the
//! torque (or force) on it. With the twist `s` of the tool centre point per unit of the coordinate,
//! a wrench `F` there moves the tool by `h s s^T F`.

use nalgebra::{Vector3, Vector6};
use robstiff::JointKind;

use super::arm::{Screw, Stand};

/// Elastic coordinates that share one compliance (rad/Nm or m/N). Joints and links count from 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Spring {
    /// A joint along its own coordinate.
    Joint(usize),
    /// The entry of the joint compliance matrix that two joints share.
    Coupling([usize; 2]),
    /// A turn about some of the axes of a frame.
    Turn(Site, &'static [usize]),
    /// A shift along some of the axes of a frame.
    Shift(Site, &'static [usize]),
    /// The bending of a uniform, round beam from the origin of a link's joint frame to the next
    /// one: `L / EI` in both planes.
    Bending(usize),
    /// Its torsion: `L / GJ`.
    Torsion(usize),
}

/// A frame of the arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Site {
    /// Frame 0.
    Base,
    /// A joint's frame.
    Joint(usize),
    /// Frame n.
    Flange,
}

/// The axes across z, and all of them.
pub const ACROSS: &[usize] = &[0, 1];
/// See [`ACROSS`].
pub const ALL: &[usize] = &[0, 1, 2];
/// One axis each.
pub const EACH: [&[usize]; 3] = [&[0], &[1], &[2]];

/// Places and weights of Gauss' rule with three points on a beam of length 1: exact for polynomials
/// of order 5, and the bending of a beam is one of order 2.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 0.277_777_777_777_777_8),
    (0.5, 0.444_444_444_444_444_4),
    (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
];

impl Spring {
    /// Hands over the twists of the tool centre point per unit of each coordinate, with the share
    /// of the compliance that it has. A coupling has none of its own.
    fn coordinates(&self, stand: &Stand, kinds: &[JointKind], mut of: impl FnMut(f64, Vector6<f64>)) {
        let tcp = &stand.tcp.at;
        let mut of_frame = |site: &Site, axes: &[usize], slides: bool| {
            let frame = match *site {
                Site::Base => &stand.base,
                Site::Joint(joint) => &stand.joints[joint - 1],
                Site::Flange => stand.flange(),
            };
            for &axis in axes {
                of(1.0, Screw { axis: frame.axis(axis), through: frame.at, slides }.twist_at(tcp));
            }
        };
        match self {
            Self::Joint(joint) => of(1.0, stand.joint_screw(joint - 1, kinds[joint - 1]).twist_at(tcp)),
            Self::Coupling(_) => {}
            Self::Turn(site, axes) => of_frame(site, axes, false),
            Self::Shift(site, axes) => of_frame(site, axes, true),
            Self::Bending(link) | Self::Torsion(link) => {
                let Some((from, along)) = beam(stand, *link) else { return };
                let axis = along.normalize();
                let turn = |axis: Vector3<f64>, through: Vector3<f64>| Screw { axis, through, slides: false };
                if let Self::Torsion(_) = self {
                    return of(1.0, turn(axis, from).twist_at(tcp));
                }
                let across = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
                for (place, weight) in GAUSS {
                    for axis in [across, axis.cross(&across)] {
                        of(weight, turn(axis, from + along * place).twist_at(tcp));
                    }
                }
            }
        }
    }

    /// The twist `[d; r]` (m, rad) of the tool centre point under a wrench there (N, Nm), per unit of
    /// the compliance.
    pub fn twist(&self, stand: &Stand, kinds: &[JointKind], wrench: &Vector6<f64>) -> Vector6<f64> {
        if let Self::Coupling([i, j]) = self {
            let [i, j] = [i, j].map(|joint| stand.joint_screw(joint - 1, kinds[joint - 1]).twist_at(&stand.tcp.at));
            return i * j.dot(wrench) + j * i.dot(wrench);
        }
        let mut twist = Vector6::zeros();
        self.coordinates(stand, kinds, |share, of| twist += of * (share * of.dot(wrench)));
        twist
    }

    /// By how much a joint (from 1) turns for a unit of the compliance, given the torque of each.
    pub fn turn_of(&self, joint: usize, torque: impl Fn(usize) -> f64) -> f64 {
        match *self {
            Self::Joint(own) if own == joint => torque(joint),
            Self::Coupling([i, j]) if i == joint => torque(j),
            Self::Coupling([i, j]) if j == joint => torque(i),
            _ => 0.0,
        }
    }
}

/// The beam of a link (from 1): where it begins and its way to the next joint; none where joints
/// meet.
fn beam(stand: &Stand, link: usize) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let from = stand.joints[link - 1].at;
    let along = stand.joints.get(link)?.at - from;
    (along.norm() > 1e-6).then_some((from, along))
}

#[cfg(test)]
mod tests {
    use nalgebra::SVector;
    use robstiff::elements::{self, Pose};
    use robstiff::{Generic, Robot};
    use robstiff_robots::samples::{odd, poses};

    use super::super::Arm;
    use super::*;

    /// The runtime has the same springs, with closed formulas for the beam.
    #[test]
    fn springs_are_those_of_the_runtime() {
        let description = odd();
        let robot = Generic::<6>::new(&description).expect("six joints");
        let (arm, kinds) = (Arm::of(&description), robot.joint_kinds());
        let wrench = Vector6::new(300.0, -200.0, 500.0, 20.0, -30.0, 10.0);
        let same = [
            (Spring::Joint(2), elements::Spring::Joint(2)),
            (Spring::Joint(3), elements::Spring::Joint(3)),
            (Spring::Coupling([2, 4]), elements::Spring::Coupling([2, 4])),
            (Spring::Turn(Site::Joint(3), ACROSS), elements::Spring::Transverse(3)),
            (Spring::Turn(Site::Base, ACROSS), elements::Spring::BaseTilt),
            (Spring::Shift(Site::Base, ALL), elements::Spring::BaseTranslation),
            (Spring::Turn(Site::Flange, ALL), elements::Spring::ToolRotation),
            (Spring::Shift(Site::Flange, ALL), elements::Spring::ToolTranslation),
            (Spring::Bending(2), elements::Spring::LinkBending(2)),
            (Spring::Torsion(4), elements::Spring::LinkTorsion(4)),
        ];
        for q in poses::<6>() {
            let stand = arm.stand(&q, &[]);
            let pose = Pose::of(&robot, &SVector::from(q));
            for (own, runtime) in &same {
                let expected = pose.geometry().unit_compliance(*runtime) * wrench;
                let found = own.twist(&stand, &kinds, &wrench);
                assert!((expected - found).amax() < 1e-10 * expected.amax().max(1.0), "{own:?} {expected} {found}");
            }
        }
    }
}
