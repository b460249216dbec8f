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

/// One term of what a spring makes of a wrench `F`: a twist `share * moves (by^T F)`.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Its share of the compliance.
    pub share: f64,
    /// The twist `[d; r]` of the tool centre point per unit of the coordinate that yields.
    pub moves: Vector6<f64>,
    /// That of the coordinate whose torque counts: the same one, but for a coupling.
    pub by: Vector6<f64>,
}

impl Part {
    /// The twist under a wrench at the tool centre point (N, Nm), per unit of the compliance.
    pub fn twist(&self, wrench: &Vector6<f64>) -> Vector6<f64> {
        self.moves * (self.share * self.by.dot(wrench))
    }
}

impl Spring {
    /// The terms of what an arm that stands somewhere yields by.
    pub fn parts(&self, stand: &Stand, kinds: &[JointKind]) -> Vec<Part> {
        let tcp = &stand.tcp.at;
        let own = |share: f64, screw: Screw| {
            let moves = screw.twist_at(tcp);
            Part { share, moves, by: moves }
        };
        let joint = |joint: usize| stand.joint_screw(joint - 1, kinds[joint - 1]);
        let of_frame = |site: &Site, axes: &[usize], slides: bool| {
            let frame = match *site {
                Site::Base => &stand.base,
                Site::Joint(joint) => &stand.joints[joint - 1],
                Site::Flange => stand.flange(),
            };
            axes.iter().map(|&axis| own(1.0, Screw { axis: frame.axis(axis), through: frame.at, slides })).collect()
        };
        match self {
            Self::Joint(of) => vec![own(1.0, joint(*of))],
            Self::Coupling(of) => {
                let [i, j] = of.map(|of| joint(of).twist_at(tcp));
                vec![Part { share: 1.0, moves: i, by: j }, Part { share: 1.0, moves: j, by: i }]
            }
            Self::Turn(site, axes) => of_frame(site, axes, false),
            Self::Shift(site, axes) => of_frame(site, axes, true),
            Self::Bending(link) | Self::Torsion(link) => {
                let Some((from, along)) = beam(stand, *link) else { return Vec::new() };
                let axis = along.normalize();
                let turn = |axis: Vector3<f64>, through: Vector3<f64>| Screw { axis, through, slides: false };
                if let Self::Torsion(_) = self {
                    return vec![own(1.0, turn(axis, from))];
                }
                let across = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
                let both = [across, axis.cross(&across)];
                let at = |(place, weight)| both.map(|axis| own(weight, turn(axis, from + along * place)));
                GAUSS.into_iter().flat_map(at).collect()
            }
        }
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
                let found: Vector6<f64> = own.parts(&stand, &kinds).iter().map(|part| part.twist(&wrench)).sum();
                assert!((expected - found).amax() < 1e-10 * expected.amax().max(1.0), "{own:?} {expected} {found}");
            }
        }
    }
}
