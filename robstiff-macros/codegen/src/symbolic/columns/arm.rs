//! What every joint moves at the TCP.
//!
//! `z x lever` takes two products of columns, and the numbers of the lever. Where the next
//! joint has computed some of it, less is left to do:
//!
//! - About a parallel axis a joint moves the TCP as the next one does, and besides by
//!   `z x` what lies between the two, for which no lever is needed. The compliance makes
//!   more of that.
//! - Where the axis is one of the base frame's and the next joint's is across it, the
//!   lever's part along their common normal is an entry of what the next joint moves:
//!   of `z' x lever` the one along `z`.
//!
//! Gains: `benches/README.md`.

use robstiff_robots::{Description, JointKind};

use super::levers::levers;
use super::walker::{Walker, along};
use crate::graph::{Graph, Sym};
use crate::symbolic::chain::{Step, Tilt, chain};
use crate::symbolic::column::{Column, Signed};
use crate::symbolic::turning::Turning;
use crate::symbolic::vector::Vec3;

/// What a unit of a joint coordinate moves at the TCP, in the base frame.
#[derive(Clone, Copy)]
pub struct Twist<'g> {
    pub translation: Column<'g>,
    pub rotation: Column<'g>,
    /// Of a joint that turns about a parallel of the next one's axis, by how much its
    /// translation is more than that one's.
    pub beyond: Option<Column<'g>>,
}

/// The twists of all joints and the TCP's frame.
pub struct Arm<'g> {
    pub joints: Vec<Twist<'g>>,
    pub axes: [Signed<'g>; 3],
    pub origin: Column<'g>,
    stands: Vec<Stand<'g>>,
    levers: Vec<Vec3<'g>>,
}

impl<'g> Arm<'g> {
    pub fn of(g: &'g Graph, robot: &Description) -> Self {
        let steps = chain(g, robot);
        let levers = levers(g, &steps);
        let (stands, walker) = walk(g, robot, &steps);
        let (joints, levers) = twists(g, &stands, levers);
        let origin = match stands.first() {
            Some(first) => along(first.origin, first.axes, levers[0]),
            None => walker.origin,
        };
        Self { joints, axes: walker.axes, origin, stands, levers }
    }

    /// What a unit of a joint that turns moves at the TCP, times a number and added to `onto`,
    /// without that column itself: the number goes into the lever, which is a number, too.
    /// `moved` is what [`Stand::along_normal`] asks for, if it is not what the twists say.
    pub fn moves_times(
        &self,
        joint: usize,
        number: Sym<'g>,
        onto: Option<Column<'g>>,
        moved: Option<impl FnOnce(usize) -> Vec<Sym<'g>>>,
    ) -> Column<'g> {
        let (stand, mut lever) = (&self.stands[joint], self.levers[joint]);
        if let Some(along) = moved.and_then(|moved| stand.along_normal(moved)) {
            lever.0[0] = along;
        }
        stand.moves_times(lever, number, onto)
    }
}

/// Where all joints are, and the frame at the end of the chain.
fn walk<'g>(g: &'g Graph, robot: &Description, steps: &[Step<'g>]) -> (Vec<Stand<'g>>, Walker<'g>) {
    let mut walker = Walker::at_base(g);
    let mut stands: Vec<Stand<'g>> = Vec::new();
    // Stands whose axes are not turned yet by what follows about z.
    let mut waiting = 0;
    for step in steps {
        match step {
            Step::Joint(joint) => {
                let revolute = robot.joints[*joint].kind == JointKind::Revolute;
                stands.push(Stand::at(&walker, revolute));
            }
            Step::Tilt(tilt) => {
                if tilt.is_half_turn_about_x() {
                    stands[waiting..].iter_mut().for_each(Stand::mirror);
                } else {
                    walker.settle();
                    stands[waiting..].iter_mut().for_each(|stand| stand.settle(&walker));
                    waiting = stands.len();
                }
                stands.last_mut().into_iter().for_each(|last| last.tilt(tilt));
            }
            Step::Turn(_) => stands.last_mut().into_iter().for_each(Stand::turn),
            Step::Move(by) => stands.last_mut().into_iter().for_each(|last| last.shift(&walker, *by)),
            _ => {}
        }
        walker.step(step);
    }
    walker.settle();
    stands[waiting..].iter_mut().for_each(|stand| stand.settle(&walker));
    (stands, walker)
}

/// What the joints move at the TCP; and the levers, with the parts of them that the joints
/// behind have computed.
fn twists<'g>(g: &'g Graph, stands: &[Stand<'g>], mut levers: Vec<Vec3<'g>>) -> (Vec<Twist<'g>>, Vec<Vec3<'g>>) {
    let mut joints: Vec<Twist<'g>> = Vec::new();
    for (k, stand) in stands.iter().enumerate().rev() {
        // From the tip on: the next joint is the last of these.
        let next = joints.last().filter(|_| stands[k + 1].is_revolute);
        let along_normal = next.and_then(|_| stand.along_normal(|axis| moved(&joints, axis)));
        levers[k].0[0] = along_normal.unwrap_or(levers[k].0[0]);
        let beyond = stand.parallel.filter(|_| stand.is_revolute && next.is_some());
        let (translation, rotation) = match (stand.is_revolute, next.zip(beyond)) {
            (false, _) => (stand.axes[2].column(), Column::zero(g)),
            (true, Some((next, beyond))) => (next.translation.plus(beyond), stand.axes[2].column()),
            (true, None) => (stand.moves(levers[k]), stand.axes[2].column()),
        };
        joints.push(Twist { translation: translation.named(&format!("j{}", k + 1)), rotation, beyond });
    }
    joints.reverse();
    (joints, levers)
}

/// A joint, and what follows it up to the next one.
struct Stand<'g> {
    g: &'g Graph,
    is_revolute: bool,
    /// Where it is.
    origin: Column<'g>,
    /// Its axes, behind all turns about parallels of z that follow.
    axes: [Signed<'g>; 3],
    /// Whether y has changed its sign since.
    is_mirrored: bool,
    /// While the axis stays parallel, `z x` the vector from here.
    parallel: Option<Column<'g>>,
    /// How far it goes along x, which is the common normal with the next axis if a twist
    /// follows and nothing else.
    normal: Option<Sym<'g>>,
    /// Sine of the twist, if that is a quarter turn.
    twist: Option<f64>,
    /// Whether the x that things were moved along is no longer the frame's.
    is_turned: bool,
}

impl<'g> Stand<'g> {
    fn at(walker: &Walker<'g>, is_revolute: bool) -> Self {
        let g = walker.g;
        Self {
            g,
            is_revolute,
            origin: walker.origin,
            axes: walker.axes,
            is_mirrored: false,
            parallel: Some(Column::zero(g)),
            normal: Some(g.number(0.0)),
            twist: None,
            is_turned: false,
        }
    }

    fn mirror(&mut self) {
        self.is_mirrored = !self.is_mirrored;
    }

    /// The axes are now those of the walker.
    fn settle(&mut self, walker: &Walker<'g>) {
        let [x, y, _] = walker.axes;
        self.axes = [x, y.negated_if(self.is_mirrored), self.axes[2]];
    }

    fn turn(&mut self) {
        self.is_turned |= self.twist.is_some() || self.normal.is_some_and(|along| !along.is_zero());
    }

    fn tilt(&mut self, tilt: &Tilt<'g>) {
        let sine = tilt.sin_cos.0.constant().filter(|sine| tilt.axis == 0 && sine.abs() == 1.0);
        self.twist = sine.filter(|_| self.parallel.is_some() && !self.is_turned);
        self.parallel = None;
    }

    fn shift(&mut self, walker: &Walker<'g>, by: Vec3<'g>) {
        let [x, y, _] = walker.axes;
        let (s, c) = self.g.sin_cos(&walker.pending);
        let moved = || {
            if by[1].is_zero() {
                // A length that scales the whole column meets the constants of a compliance.
                return Signed::combined((y, c), (x, -s)).column().scaled(by[0]);
            }
            let by = by.turned(2, (s, c));
            Signed::combined((y, by[0]), (x, -by[1])).column()
        };
        self.parallel = self.parallel.map(|sum| sum.plus(moved()));
        self.normal = self.normal.filter(|_| !self.is_turned).map(|sum| sum + by[0]);
    }

    /// What a unit of the joint moves at the end of a lever, which is in its axes.
    fn moves(&self, lever: Vec3<'g>) -> Column<'g> {
        let [x, y, _] = self.axes;
        Signed::combined((y, lever[0]), (x, -lever[1])).column()
    }

    /// The same times a number, and added to another column.
    fn moves_times(&self, lever: Vec3<'g>, number: Sym<'g>, onto: Option<Column<'g>>) -> Column<'g> {
        let [x, y, _] = self.axes;
        let mut parts = [(y, lever[0] * number), (x, -lever[1] * number)];
        match onto {
            Some(sum) => {
                // What is known later goes in later.
                parts.sort_by_key(|(axis, lever)| axis.column().whole().ready().max(lever.ready()));
                parts.into_iter().fold(sum, |sum, (axis, lever)| axis.added(sum, lever))
            }
            // A constant beside a column is one operand.
            None if lever[0].constant().and(lever[1].constant()).is_some() => {
                self.moves(lever).times(Column::thrice(number))
            }
            None => Signed::combined(parts[0], parts[1]).column(),
        }
    }

    /// The lever's part along x, where the twists behind say it: `moved` gives what the next
    /// joint moves along an axis, part by part, so that what is known last is added last.
    fn along_normal(&self, moved: impl FnOnce(usize) -> Vec<Sym<'g>>) -> Option<Sym<'g>> {
        let (sine, normal) = (self.twist?, self.normal?);
        let (axis, sign) = self.axes[2].column().unit_axis()?;
        let add = |along, entry| if sine * sign > 0.0 { along + entry } else { along - entry };
        Some(moved(axis).into_iter().fold(normal, add))
    }
}

/// What the last of the joints, from the tip on, moves along an axis, part by part.
fn moved<'g>(joints: &[Twist<'g>], axis: usize) -> Vec<Sym<'g>> {
    let mut parts = Vec::new();
    for twist in joints.iter().rev() {
        parts.push(twist.beyond.unwrap_or(twist.translation).early_at(axis));
        if twist.beyond.is_none() {
            break;
        }
    }
    parts
}
