//! Transform, frames, Jacobian, joint torques and deflection.

use robstiff_robots::effect::physics::PLAYS;
use robstiff_robots::{Description, JointKind};

use super::beam::Beam;
use super::chain::chain;
use super::elastic::Elastic;
use super::forward::{Forward, Frame, Stand, forward};
use super::vector::Vec3;
use super::waist::{Start, cheapest};
use super::weight;
use crate::graph::{Graph, Sym};

/// The 16 entries of the TCP's frame in the base frame, by rows.
pub fn transform<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    transform_from(g, &Start::at_base(g, robot))
}

pub(super) fn transform_from<'g>(g: &'g Graph, start: &Start<'g>) -> Vec<Sym<'g>> {
    let Frame { axes, origin } = start.forward().tcp;
    homogeneous(g, &Frame { axes: axes.map(|axis| start.to_base(axis)), origin: start.to_base(origin) }, "")
}

/// The frames behind the joints in the base frame, 16 entries each, by rows.
pub fn link_frames<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    let forward = forward(g, &chain(g, robot));
    (1..).zip(&forward.link_frames).flat_map(|(i, frame)| homogeneous(g, frame, &i.to_string())).collect()
}

fn homogeneous<'g>(g: &'g Graph, frame: &Frame<'g>, suffix: &str) -> Vec<Sym<'g>> {
    for (axis, letter) in frame.axes.iter().zip(['x', 'y', 'z']) {
        axis.named(&format!("{letter}{suffix}_"));
    }
    frame.origin.named(&format!("p{suffix}_"));
    let mut entries = Vec::with_capacity(16);
    for row in 0..3 {
        entries.extend(frame.axes.iter().map(|axis| axis[row]));
        entries.push(frame.origin[row]);
    }
    entries.extend([0.0, 0.0, 0.0, 1.0].map(|entry| g.number(entry)));
    entries
}

/// What a unit of each joint coordinate moves at the TCP, as the walk's
/// [`forward`](Start::forward) has it or in the base frame: the columns of the Jacobian.
struct Twists<'g> {
    translation: Vec<Vec3<'g>>,
    rotation: Vec<Vec3<'g>>,
}

impl<'g> Twists<'g> {
    fn to_base(&self, start: &Start<'g>) -> Self {
        let to_base = |vectors: &[Vec3<'g>]| vectors.iter().map(|&v| start.to_base(v)).collect();
        Self { translation: to_base(&self.translation), rotation: to_base(&self.rotation) }
    }

    /// `[z x lever; z]` for a revolute joint, `[z; 0]` for a prismatic one.
    fn of(g: &'g Graph, robot: &Description, forward: &Forward<'g>) -> Self {
        g.remark("What the joints move: z is an axis, l leads from it to the TCP.");
        let mut twists = Self { translation: Vec::new(), rotation: Vec::new() };
        for ((number, joint), stand) in (1..).zip(&robot.joints).zip(&forward.joints) {
            let axis = stand.axis.named(&format!("z{number}"));
            let lever = stand.lever.named(&format!("l{number}"));
            let (translation, rotation) = match joint.kind {
                JointKind::Revolute => (axis.cross(lever), axis),
                JointKind::Prismatic => (axis, Vec3::zero(g)),
            };
            twists.translation.push(translation.named(&format!("j{number}")));
            twists.rotation.push(rotation);
        }
        twists
    }

    /// `J^T F`.
    fn torques(&self, g: &'g Graph, force: Vec3<'g>, moment: Vec3<'g>) -> Vec<Sym<'g>> {
        g.remark("What the wrench puts on the joints.");
        let rows = (1..).zip(&self.translation).zip(&self.rotation);
        rows.map(|((i, t), r)| (t.dot(force) + r.dot(moment)).named(format!("tau{i}"))).collect()
    }
}

/// The Jacobian, 6 entries a column, column by column.
pub fn jacobian<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    cheapest(g, robot, |g, start| jacobian_from(g, start, robot))
}

pub(super) fn jacobian_from<'g>(g: &'g Graph, start: &Start<'g>, robot: &Description) -> Vec<Sym<'g>> {
    let twists = Twists::of(g, robot, &start.forward()).to_base(start);
    twists.translation.iter().zip(&twists.rotation).flat_map(|(t, r)| t.0.into_iter().chain(r.0)).collect()
}

fn wrench<'g>(g: &'g Graph, start: &Start<'g>) -> (Vec3<'g>, Vec3<'g>) {
    let part = |first: usize| start.from_base(Vec3(std::array::from_fn(|i| g.wrench(first + i))));
    (part(0), part(3))
}

/// The torques `J^T F` that a wrench which acts on the TCP puts on the joints.
pub fn joint_torques<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    cheapest(g, robot, |g, start| {
        let (force, moment) = wrench(g, start);
        Twists::of(g, robot, &start.forward()).torques(g, force, moment)
    })
}

/// What the arm's own weight puts on the gears before any load does, a joint each.
pub fn preload<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    weight::preload(g, robot).unwrap_or_else(|| vec![g.number(0.0); robot.joints.len()])
}

/// Displacement and rotation of the TCP under a wrench, `J (H_q (J^T F))` and
/// what the effects add, without forming a compliance matrix; of a robot that
/// was never loaded.
pub fn deflection<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    cheapest(g, robot, |g, start| loaded(g, robot, start, |_| [g.number(0.0); PLAYS]).0)
}

/// The same after other loads, and then the play operators that are in use, in
/// the order of [`plays`].
pub fn deflection_with<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    cheapest(g, robot, |g, start| {
        let (displacement, plays) = loaded(g, robot, start, |joint| std::array::from_fn(|k| g.play(joint, k)));
        [displacement, plays].concat()
    })
}

/// The play operators in use, each by its joint and its number there, from 0.
pub fn plays(robot: &Description) -> Vec<(usize, usize)> {
    let joints = robot.effects.iter().filter_map(|effect| Some((effect.row()? - 1, effect.plays_in_use())));
    joints.flat_map(|(joint, count)| (0..count).map(move |k| (joint, k))).collect()
}

fn loaded<'g>(
    g: &'g Graph,
    robot: &Description,
    start: &Start<'g>,
    before: impl Fn(usize) -> [Sym<'g>; PLAYS],
) -> (Vec<Sym<'g>>, Vec<Sym<'g>>) {
    let elastic = Elastic::of(g, robot);
    let forward = start.forward();
    let (force, moment) = wrench(g, start);
    let mut sum = Displacement { force, moment, translation: Vec3::zero(g), rotation: Vec3::zero(g) };
    let twists = Twists::of(g, robot, &forward);
    let (turns, plays) = joint_turns(g, &elastic, &twists.torques(g, force, moment), before);
    g.remark("What these turns make at the TCP.");
    sum.by_joints(&twists, &turns);
    sum.by_tilts(g, &forward, &elastic);
    sum.by_links(g, &forward, &elastic);
    sum.by_base_and_tool(g, &forward, &elastic);
    g.remark("In the axes of the base.");
    let displacement = [sum.translation, sum.rotation].map(|part| start.to_base(part).0);
    (displacement.concat(), plays)
}

/// The displacement of the TCP under a wrench, element by element.
struct Displacement<'g> {
    force: Vec3<'g>,
    moment: Vec3<'g>,
    translation: Vec3<'g>,
    rotation: Vec3<'g>,
}

impl<'g> Displacement<'g> {
    /// Each joint along its coordinate.
    fn by_joints(&mut self, twists: &Twists<'g>, turns: &[Sym<'g>]) {
        for (i, &turn) in turns.iter().enumerate() {
            self.translation = self.translation + twists.translation[i].scaled(turn);
            self.rotation = self.rotation + twists.rotation[i].scaled(turn);
        }
    }

    /// Each joint about the axes across its own.
    fn by_tilts(&mut self, g: &'g Graph, forward: &Forward<'g>, elastic: &Elastic<'g>) {
        for ((number, stand), &transverse) in (1..).zip(&forward.joints).zip(&elastic.transverse) {
            if !transverse.is_zero() {
                g.remark(format!("And the tilt of joint {number} across its axis."));
                self.tilt(stand, transverse);
            }
        }
    }

    fn by_links(&mut self, g: &'g Graph, forward: &Forward<'g>, elastic: &Elastic<'g>) {
        for ((number, segment), &compliances) in (1..).zip(&forward.links).zip(&elastic.link) {
            let Some(beam) = Beam::of(g, segment.along, segment.length_squared, compliances) else { continue };
            g.remark(format!("And link {number}."));
            let middle = beam.middle(segment.lever);
            self.turn(beam.turn(self.moment_at(middle)), middle);
            self.translation = beam.shifted(self.translation, self.force);
        }
    }

    fn by_base_and_tool(&mut self, g: &'g Graph, forward: &Forward<'g>, elastic: &Elastic<'g>) {
        g.remark("And the base.");
        let (tilt, shift) = elastic.base;
        self.tilt(&forward.base, tilt);
        self.shift(self.force.scaled(shift));
        g.remark("And the tool.");
        let (turn, shift) = elastic.tool;
        let lever = forward.flange.lever;
        self.turn(self.moment_at(lever).scaled(turn), lever);
        self.shift(self.force.scaled(shift));
    }

    /// The moment at the point from which `lever` leads to the TCP.
    fn moment_at(&self, lever: Vec3<'g>) -> Vec3<'g> {
        self.moment + lever.cross(self.force)
    }

    fn tilt(&mut self, stand: &Stand<'g>, compliance: Sym<'g>) {
        self.turn(across(self.moment_at(stand.lever), stand.axis).scaled(compliance), stand.lever);
    }

    /// A small turn at the point from which `lever` leads to the TCP.
    fn turn(&mut self, by: Vec3<'g>, lever: Vec3<'g>) {
        self.shift(by.cross(lever));
        self.rotation = self.rotation + by;
    }

    fn shift(&mut self, by: Vec3<'g>) {
        self.translation = self.translation + by;
    }
}

/// The part of `v` across a unit vector.
fn across<'g>(v: Vec3<'g>, axis: Vec3<'g>) -> Vec3<'g> {
    v - axis.scaled(axis.dot(v))
}

/// What the joints yield under their torques, `H_q tau` with couplings and the
/// laws of joints; and the play operators after that.
fn joint_turns<'g>(
    g: &'g Graph,
    elastic: &Elastic<'g>,
    torques: &[Sym<'g>],
    before: impl Fn(usize) -> [Sym<'g>; PLAYS],
) -> (Vec<Sym<'g>>, Vec<Sym<'g>>) {
    g.remark("By how much the joints turn or slide.");
    let mut turns: Vec<Sym<'g>> = elastic.joint.iter().zip(torques).map(|(&h, &tau)| h * tau).collect();
    for &([i, j], c) in &elastic.coupling {
        turns[i] = turns[i] + c * torques[j];
        turns[j] = turns[j] + c * torques[i];
    }
    let mut all_plays = Vec::new();
    for law in &elastic.laws {
        let i = law.joint;
        law.remark(g);
        let plays = law.plays(torques[i], before(i));
        for (k, play) in (1..).zip(&plays) {
            play.named(format!("play{}_{k}", i + 1));
        }
        turns[i] = turns[i] + law.turn(g, elastic.joint[i], torques[i], &plays);
        all_plays.extend(plays);
    }
    ((1..).zip(turns).map(|(i, turn)| turn.named(format!("dq{i}"))).collect(), all_plays)
}
