//! Forward kinematics, base to tip.

use super::step::Step;
use super::turning::Turning;
use super::vector::Vec3;
use crate::angle::Angle;
use crate::graph::{Graph, Sym};

/// A frame in the base frame: its axes and its origin.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'g> {
    /// The x, y and z axis.
    pub axes: [Vec3<'g>; 3],
    /// The origin.
    pub origin: Vec3<'g>,
}

/// A link as a vector between two joint origins, in the base frame.
#[derive(Clone, Copy, Debug)]
pub struct Segment<'g> {
    /// From the TCP's view: TCP minus the link's beginning.
    pub lever: Vec3<'g>,
    /// The link's end minus its beginning.
    pub along: Vec3<'g>,
    /// The square of its length (m^2).
    pub length_squared: Sym<'g>,
}

/// Where everything is at one pose, in the base frame.
#[derive(Debug)]
pub struct Forward<'g> {
    /// Frame 0, whose axes the foundation tilts about.
    pub base: Stand<'g>,
    /// Axis and lever of each joint.
    pub joints: Vec<Stand<'g>>,
    /// The links between the joints, n - 1 of them.
    pub links: Vec<Segment<'g>>,
    /// The frames behind the joints.
    pub link_frames: Vec<Frame<'g>>,
    /// The flange.
    pub flange: Stand<'g>,
    /// The tool centre point.
    pub tcp: Frame<'g>,
}

/// A z axis, where it stands, and the lever from there to the TCP.
#[derive(Clone, Copy, Debug)]
pub struct Stand<'g> {
    /// The axis, of length one.
    pub axis: Vec3<'g>,
    /// The frame's origin.
    pub origin: Vec3<'g>,
    /// TCP minus the frame's origin.
    pub lever: Vec3<'g>,
}

struct Walker<'g> {
    g: &'g Graph,
    axes: [Vec3<'g>; 3],
    /// A turn about the z axis that the axes do not contain yet.
    pending: Angle,
    origin: Vec3<'g>,
}

impl<'g> Turning<'g> for Walker<'g> {
    fn graph(&self) -> &'g Graph {
        self.g
    }

    fn pending(&mut self) -> &mut Angle {
        &mut self.pending
    }

    fn turn(&mut self, axis: usize, (s, c): (Sym<'g>, Sym<'g>)) {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let (u, v) = (self.axes[i], self.axes[j]);
        self.axes[i] = u.scaled(c) + v.scaled(s);
        self.axes[j] = v.scaled(c) - u.scaled(s);
    }
}

impl<'g> Walker<'g> {
    /// A vector of the current frame in the base frame.
    fn in_base(&self, v: Vec3<'g>) -> Vec3<'g> {
        let v = v.turned(2, self.g.sin_cos(&self.pending));
        self.axes[0].scaled(v[0]) + self.axes[1].scaled(v[1]) + self.axes[2].scaled(v[2])
    }

    fn frame(&self) -> Frame<'g> {
        let mut settled = Walker { g: self.g, axes: self.axes, pending: self.pending.clone(), origin: self.origin };
        settled.settle();
        Frame { axes: settled.axes, origin: settled.origin }
    }
}

/// Walks the chain from the base to the TCP.
pub fn forward<'g>(g: &'g Graph, steps: &[Step<'g>]) -> Forward<'g> {
    g.remark("Axes and origins, from the base to the tip.");
    let mut walker = Walker {
        g,
        axes: std::array::from_fn(|axis| Vec3::unit(g, axis)),
        pending: Angle::default(),
        origin: Vec3::zero(g),
    };
    // Levers are sums of the moves from the TCP backwards: remember after how
    // many moves each thing stood.
    let mut moves: Vec<Vec3<'g>> = Vec::new();
    let mut base = None;
    let mut flange = None;
    let mut joints = Vec::new();
    let mut links = Vec::new();
    let mut link_frames = Vec::new();
    for step in steps {
        let here = (moves.len(), walker.axes[2], walker.origin);
        match step {
            Step::Move(by) => {
                let by = walker.in_base(*by);
                walker.origin = walker.origin + by;
                moves.push(by);
            }
            Step::Turn(angle) => walker.turn_later(angle),
            Step::Tilt(tilt) => walker.tilt(*tilt),
            Step::Base => base = Some(here),
            Step::Joint(_) => joints.push(here),
            Step::Link(_, along) => links.push((moves.len(), walker.in_base(*along), along.dot(*along))),
            Step::LinkFrame(_) => link_frames.push(walker.frame()),
            Step::Flange => flange = Some(here),
        }
    }
    g.remark("From the origins to the TCP.");
    let mut levers = vec![Vec3::zero(g)];
    for &by in moves.iter().rev() {
        levers.push(by + levers[levers.len() - 1]);
    }
    levers.reverse();
    let stand = |(at, axis, origin)| Stand { axis, origin, lever: levers[at] };
    Forward {
        base: stand(base.expect("every chain has a base")),
        joints: joints.into_iter().map(stand).collect(),
        links: links
            .into_iter()
            .map(|(at, along, length_squared)| Segment { lever: levers[at], along, length_squared })
            .collect(),
        link_frames,
        flange: stand(flange.expect("every chain has a flange")),
        tcp: walker.frame(),
    }
}
