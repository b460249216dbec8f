//! What the arm's own weight puts on its joints, where the description has masses.

use nalgebra::Vector3;
use robstiff::JointKind;
use robstiff_robots::effect::gravity_sag::GRAVITY;
use robstiff_robots::{Description, Link};

use super::Stand;

/// The masses of an arm.
#[derive(Clone, Debug)]
pub struct Weight {
    links: Vec<Link>,
    /// Which share of the weight gears carry before any load, as declared (`gravity_preload`).
    pub preload: f64,
}

impl Weight {
    /// Of a description.
    pub fn of(description: &Description) -> Self {
        let share = description.effects.iter().filter_map(robstiff::elements::share_of_preload::<f64>).sum();
        Self { links: description.links.clone(), preload: share }
    }

    /// Whether any mass is known.
    pub fn is_known(&self) -> bool {
        self.links.iter().any(|link| link.mass > 0.0)
    }

    /// The torque of all that hangs on a joint (from 0) about its axis (Nm; the force along it (N) of
    /// one that slides). Gravity points against z of the base frame.
    pub fn torque(&self, stand: &Stand, kinds: &[JointKind], joint: usize) -> f64 {
        let screw = stand.joint_screw(joint, kinds[joint]);
        let behind = self.links.iter().zip(&stand.links).skip(joint);
        let of = |(link, frame): (&Link, &super::Frame)| {
            let down = Vector3::new(0.0, 0.0, -GRAVITY * link.mass);
            screw.at(&frame.point(&link.center_of_mass.into())).dot(&down)
        };
        behind.map(of).sum()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::SVector;
    use robstiff::{Effect, Generic, Robot};
    use robstiff_robots::samples::{odd, poses};

    use super::super::Arm;
    use super::*;

    #[test]
    fn torques_are_those_of_the_generic_robot() {
        let mut description = odd();
        description.effects = vec![Effect::GravityPreload { share: 1.0 }];
        let link = |k: f64| Link { mass: 100.0 - 10.0 * k, center_of_mass: [0.1 * k, -0.2, 0.05] };
        description.links = (0..6).map(|k| link(f64::from(k))).collect();
        let robot = Generic::<6>::new(&description).expect("six joints");
        let (arm, weight, kinds) = (Arm::of(&description), Weight::of(&description), robot.joint_kinds());
        for q in poses::<6>() {
            let (stand, expected) = (arm.stand(&q, &[]), robot.preload(&SVector::from(q)));
            for joint in 0..6 {
                assert!((weight.torque(&stand, &kinds, joint) - expected[joint]).abs() < 1e-9);
            }
        }
    }
}
