//! What the arm's own weight puts on its joints.

use robstiff_robots::effect::gravity_sag::{GRAVITY, torque};
use robstiff_robots::{Description, Effect, Joint, JointKind, Place};

use super::forward::{Frame, forward};
use super::parameters::{joint_compliances, parameters};
use super::step::{Step, without_waist};
use super::upright::upright;
use super::vector::Vec3;
use crate::graph::{Graph, Sym};

/// By how much each joint yields (rad or m), if the description says that the
/// arm sags; `upright` is the chain of the arm without its sag.
pub fn sag<'g>(g: &'g Graph, robot: &Description, upright: &[Step<'g>]) -> Option<Vec<Sym<'g>>> {
    let share = share(g, robot, Effect::share_of_weight)?;
    let torques = torques(g, robot, upright);
    Some(joint_compliances(g, robot).into_iter().zip(torques).map(|(h, torque)| share * h * torque).collect())
}

/// What the weights put on the gear of each joint before any load does (Nm or N), if
/// the description says that gears carry them.
pub fn preload<'g>(g: &'g Graph, robot: &Description) -> Option<Vec<Sym<'g>>> {
    let share = share(g, robot, Effect::share_of_preload)?;
    let torques = torques(g, robot, &upright(g, robot));
    Some((1..).zip(torques).map(|(i, torque)| (share * torque).named(format!("tau0_{i}"))).collect())
}

fn share<'g>(g: &'g Graph, robot: &Description, of: fn(&Effect, &[Sym<'g>]) -> Option<Sym<'g>>) -> Option<Sym<'g>> {
    let of_robot = robot.effects.iter().filter(|effect| effect.place() == Place::Robot);
    of_robot.filter_map(|effect| of(effect, &parameters(g, effect))).reduce(|sum, more| sum + more)
}

/// The torque of what hangs on each joint (Nm, of sliding joints forces in N).
fn torques<'g>(g: &'g Graph, robot: &Description, upright: &[Step<'g>]) -> Vec<Sym<'g>> {
    // A turn about the vertical, which the base's z axis is, lifts nothing.
    let lifting = without_waist(upright).map_or_else(|| upright.to_vec(), |(steps, _)| steps);
    let stands = forward(g, &lifting);
    g.remark("What the weights put on the joints: g is a torque, w a force.");
    let mut torques = Vec::new();
    // Tip to base: what hangs on a joint is its link and what hangs on the next.
    let (mut weight, mut moment) = (g.number(0.0), [g.number(0.0); 2]);
    for (i, Joint { kind, .. }) in robot.joints.iter().enumerate().rev() {
        let own = link(g, robot, i);
        let centre = of_frame(&stands.link_frames[i], own.centre);
        weight = weight + own.weight;
        moment = [0, 1].map(|k| moment[k] + own.weight * centre[k]);
        let stand = &stands.joints[i];
        let torque = torque(*kind, stand.axis.0, stand.origin.0, weight, moment);
        let what = match kind {
            JointKind::Revolute => "g",
            JointKind::Prismatic => "w",
        };
        torques.push(torque.named(format!("{what}{}", i + 1)));
    }
    torques.reverse();
    torques
}

struct Link<'g> {
    weight: Sym<'g>,
    /// In the link's frame.
    centre: Vec3<'g>,
}

fn link<'g>(g: &'g Graph, robot: &Description, i: usize) -> Link<'g> {
    let (link, number) = (robot.links[i], i + 1);
    let weight =
        g.named_number(&format!("WEIGHT{number}"), GRAVITY * link.mass, &format!("Weight of link {number} (N)."));
    let along = |axis: usize, letter: &str| {
        let doc = format!("Centre of mass of link {number} in its frame, along {} (m).", letter.to_lowercase());
        g.named_number(&format!("CENTRE{number}_{letter}"), link.center_of_mass[axis], &doc)
    };
    Link { weight, centre: Vec3([along(0, "X"), along(1, "Y"), along(2, "Z")]) }
}

/// A point of a frame in the base frame.
fn of_frame<'g>(frame: &Frame<'g>, point: Vec3<'g>) -> Vec3<'g> {
    let [x, y, z] = frame.axes;
    frame.origin + x.scaled(point[0]) + y.scaled(point[1]) + z.scaled(point[2])
}
