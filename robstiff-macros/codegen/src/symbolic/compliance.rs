//! Cartesian compliance, carried from the TCP to the base.
//!
//! `H_x = J H_q J^T` is not formed from J. Instead the compliance of what lies
//! between the current frame and the TCP is kept, at the TCP but in the current
//! frame's axes, next to the lever from the frame's origin to the TCP. An
//! elastic element adds a few entries, in the frame where its own compliance is
//! sparse; a shift changes only the lever; a quarter turn is a relabelling; a
//! turn about z is 28 multiplications for the compliance and 4 for the lever.
//! For the five-axis arm with its two parallel axes that is 3 turns instead of
//! five outer products of full columns.

use robstiff_robots::{Description, JointKind};

use super::beam::Beam;
use super::chain::{Step, chain};
use super::elastic::Elastic;
use super::turning::Turning;
use super::vector::{AXES, Matrix3, Symmetric3, Vec3};
use crate::angle::Angle;
use crate::graph::{BlockTurn, Graph, Sym};
use crate::op::Id;

/// The 36 entries of `H_x` at the TCP in the base frame, by rows.
pub fn compliance<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    let elastic = Elastic::of(g, robot);
    let steps = chain(g, robot);
    g.remark("From the TCP towards the base.");
    let mut walker = Walker::at_tcp(g);
    for step in steps.iter().rev() {
        walker.back(step, robot, &elastic);
    }
    walker.settle();
    walker.name("");
    let Walker { tt, tr, rr, .. } = &walker;
    let entry = |i: usize, j: usize| match (i < 3, j < 3) {
        (true, true) => tt.at(i, j),
        (true, false) => tr[i][j - 3],
        (false, true) => tr[j][i - 3],
        (false, false) => rr.at(i - 3, j - 3),
    };
    (0..36).map(|k| entry(k / 6, k % 6)).collect()
}

/// Compliance at the TCP in the axes of the current frame, less a turn about
/// its z axis that is still pending.
struct Walker<'g> {
    g: &'g Graph,
    /// TCP minus the current frame's origin.
    lever: Vec3<'g>,
    /// Displacement per force.
    tt: Symmetric3<'g>,
    /// Displacement per moment.
    tr: Matrix3<'g>,
    /// Rotation per moment.
    rr: Symmetric3<'g>,
    /// Twists of joints whose coupling partner is still to come.
    twists: Vec<(usize, Twist<'g>)>,
    /// The turn about z that the above does not contain yet.
    pending: Angle,
}

/// What a unit of a joint coordinate moves at the TCP.
#[derive(Clone, Copy)]
struct Twist<'g> {
    translation: Vec3<'g>,
    rotation: Vec3<'g>,
}

impl<'g> Turning<'g> for Walker<'g> {
    fn graph(&self) -> &'g Graph {
        self.g
    }

    fn pending(&mut self) -> &mut Angle {
        &mut self.pending
    }

    /// `M <- R M R^T`.
    fn turn(&mut self, axis: usize, sin_cos: (Sym<'g>, Sym<'g>)) {
        let before = self.blocks();
        self.lever = self.lever.turned(axis, sin_cos);
        self.tt = turned_symmetric(&self.tt, axis, sin_cos);
        self.rr = turned_symmetric(&self.rr, axis, sin_cos);
        self.tr = turned_general(&self.tr, axis, sin_cos);
        for (_, twist) in &mut self.twists {
            twist.translation = twist.translation.turned(axis, sin_cos);
            twist.rotation = twist.rotation.turned(axis, sin_cos);
        }
        if axis == 2 {
            let sin_cos = (sin_cos.0.id(), sin_cos.1.id());
            self.g.block_turn(BlockTurn { sin_cos, before, after: self.blocks() });
        }
    }
}

impl<'g> Walker<'g> {
    fn at_tcp(g: &'g Graph) -> Self {
        Self {
            g,
            lever: Vec3::zero(g),
            tt: Symmetric3::zero(g),
            tr: [[g.number(0.0); 3]; 3],
            rr: Symmetric3::zero(g),
            twists: Vec::new(),
            pending: Angle::default(),
        }
    }

    /// Takes one step back towards the base.
    fn back(&mut self, step: &Step<'g>, robot: &Description, elastic: &Elastic<'g>) {
        match step {
            Step::Move(by) => self.lever = self.lever + self.without_pending(*by),
            Step::Turn(angle) => self.turn_later(angle),
            Step::Tilt(tilt) => self.tilt(*tilt),
            Step::Joint(i) => self.joint(*i, robot.joints[*i].kind, elastic),
            Step::Link(i, along) => {
                // Before the turn, the length is a constant.
                let length_squared = along.dot(*along);
                let beam = Beam::of(self.g, self.without_pending(*along), length_squared, elastic.link[*i]);
                if let Some(beam) = beam {
                    self.g.remark(format!("With link {}.", i + 1));
                    self.link(&beam);
                }
            }
            Step::Base => {
                self.g.remark("From the base to the TCP.");
                self.add_about_z(elastic.base.0, self.g.number(0.0), elastic.base.1, elastic.base.1);
            }
            Step::Flange => {
                self.g.remark("From the flange to the TCP.");
                self.add_about_z(elastic.tool.0, elastic.tool.0, elastic.tool.1, elastic.tool.1);
            }
            Step::LinkFrame(_) => {}
        }
    }

    /// A vector of the current frame in the walker's axes.
    fn without_pending(&self, v: Vec3<'g>) -> Vec3<'g> {
        v.turned(2, self.g.sin_cos(&-self.pending.clone()))
    }

    fn is_rigid(&self) -> bool {
        self.tt.is_zero() && self.rr.is_zero()
    }

    fn joint(&mut self, i: usize, kind: JointKind, elastic: &Elastic<'g>) {
        if self.is_rigid() {
            // Nothing to turn yet but the lever.
            self.settle();
        }
        let number = i + 1;
        self.g.remark(format!("From joint {number} to the TCP."));
        self.lever.named(&format!("r{number}"));
        let zero = self.g.number(0.0);
        let h = elastic.unloaded_joint(i);
        match kind {
            JointKind::Revolute => self.add_about_z(elastic.transverse[i], h, zero, zero),
            JointKind::Prismatic => self.add_about_z(elastic.transverse[i], zero, zero, h),
        }
        for &([first, second], c) in &elastic.coupling {
            if second == i {
                let twist = self.twist();
                self.twists.push((second, twist));
            }
            if first == i {
                self.g.remark(format!("With the coupling of joints {number} and {}.", second + 1));
                let partner =
                    self.twists.iter().find(|(joint, _)| *joint == second).expect("the later joint came first");
                self.couple(self.twist(), partner.1, c);
            }
        }
        self.name(&number.to_string());
    }

    /// The twist of a revolute joint at the current origin.
    fn twist(&self) -> Twist<'g> {
        let rotation = Vec3::unit(self.g, 2);
        Twist { translation: rotation.cross(self.lever), rotation }
    }

    fn couple(&mut self, a: Twist<'g>, b: Twist<'g>, c: Sym<'g>) {
        let outer = |u: Vec3<'g>, v: Vec3<'g>, i: usize, j: usize| c * u[i] * v[j];
        let (at, ar, bt, br) = (a.translation, a.rotation, b.translation, b.rotation);
        self.tt = self.tt + Symmetric3::from_fn(|i, j| outer(at, bt, i, j) + outer(bt, at, i, j));
        self.rr = self.rr + Symmetric3::from_fn(|i, j| outer(ar, br, i, j) + outer(br, ar, i, j));
        self.add_to_tr(|i, j| outer(at, br, i, j) + outer(bt, ar, i, j));
    }

    /// Adds an element at the current origin whose compliance is the same
    /// after any turn about z: `across` about or along x and y, `along` about
    /// or along z.
    fn add_about_z(&mut self, turn_across: Sym<'g>, turn_along: Sym<'g>, move_across: Sym<'g>, move_along: Sym<'g>) {
        let rr = Symmetric3::diagonal(self.g, [turn_across, turn_across, turn_along]);
        let tt = Symmetric3::diagonal(self.g, [move_across, move_across, move_along]);
        self.add(self.lever, tt, rr);
    }

    /// A beam that begins here.
    fn link(&mut self, beam: &Beam<'g>) {
        let (tt, rr) = beam.compliance();
        self.add(beam.middle(self.lever), tt, rr);
    }

    /// Adds `X C X^T` for the compliance `C = diag(tt, rr)` at the point from
    /// which `lever` leads to the TCP: a turn w there moves the TCP by
    /// `w x lever`.
    fn add(&mut self, lever: Vec3<'g>, tt: Symmetric3<'g>, rr: Symmetric3<'g>) {
        // moved[j]: displacement of the TCP per unit moment j.
        let moved: [Vec3<'g>; 3] = std::array::from_fn(|j| Vec3([rr.at(0, j), rr.at(1, j), rr.at(2, j)]).cross(lever));
        let lever_of: [Vec3<'g>; 3] = std::array::from_fn(|j| Vec3::unit(self.g, j).cross(lever));
        let by_turns = Symmetric3::from_fn(|i, j| {
            moved[0][i] * lever_of[0][j] + moved[1][i] * lever_of[1][j] + moved[2][i] * lever_of[2][j]
        });
        self.tt = self.tt + (by_turns + tt);
        self.rr = self.rr + rr;
        self.add_to_tr(|i, j| moved[j][i]);
    }

    fn add_to_tr(&mut self, entry: impl Fn(usize, usize) -> Sym<'g>) {
        for (i, row) in self.tr.iter_mut().enumerate() {
            for (j, sum) in row.iter_mut().enumerate() {
                *sum = *sum + entry(i, j);
            }
        }
    }

    /// The entries that a turn about z changes, the four blocks side by side.
    fn blocks(&self) -> [[Id; 4]; 5] {
        [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2)]
            .map(|(i, j)| [self.tt.at(i, j), self.rr.at(i, j), self.tr[i][j], self.tr[j][i]].map(Sym::id))
    }

    /// Names the entries for generated code.
    fn name(&self, suffix: &str) {
        for (i, row) in AXES.iter().enumerate() {
            for (j, column) in AXES.iter().enumerate() {
                self.tr[i][j].named(format!("tr{suffix}_{row}{column}"));
                if i <= j {
                    self.tt.at(i, j).named(format!("tt{suffix}_{row}{column}"));
                    self.rr.at(i, j).named(format!("rr{suffix}_{row}{column}"));
                }
            }
        }
    }
}

/// `R M R^T` for a symmetric M: 8 multiplications.
fn turned_symmetric<'g>(m: &Symmetric3<'g>, axis: usize, (s, c): (Sym<'g>, Sym<'g>)) -> Symmetric3<'g> {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut out = *m;
    let [aa, ab, _, bb] = turned_block([m.at(i, i), m.at(i, j), m.at(i, j), m.at(j, j)], (s, c));
    out.set(i, i, aa);
    out.set(i, j, ab);
    out.set(j, j, bb);
    out.set(i, axis, c * m.at(i, axis) - s * m.at(j, axis));
    out.set(j, axis, s * m.at(i, axis) + c * m.at(j, axis));
    out
}

/// `R M R^T` for any M: 12 multiplications.
fn turned_general<'g>(m: &Matrix3<'g>, axis: usize, (s, c): (Sym<'g>, Sym<'g>)) -> Matrix3<'g> {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut out = *m;
    [out[i][i], out[i][j], out[j][i], out[j][j]] = turned_block([m[i][i], m[i][j], m[j][i], m[j][j]], (s, c));
    out[i][axis] = c * m[i][axis] - s * m[j][axis];
    out[j][axis] = s * m[i][axis] + c * m[j][axis];
    out[axis][i] = c * m[axis][i] - s * m[axis][j];
    out[axis][j] = s * m[axis][i] + c * m[axis][j];
    out
}

/// `R [[aa, ab], [ba, bb]] R^T` in the plane. With `t = s (aa - bb) +
/// c (ab + ba)`, `s^2 + c^2 = 1` leaves four multiplications and no double
/// angle: `aa - s t`, `bb + s t`, `c t - ba`, `c t - ab`.
fn turned_block<'g>([aa, ab, ba, bb]: [Sym<'g>; 4], (s, c): (Sym<'g>, Sym<'g>)) -> [Sym<'g>; 4] {
    if c.is_zero() && s.squared().constant() == Some(1.0) {
        return [bb, -ba, -ab, aa];
    }
    if s.is_zero() {
        return [aa, ab, ba, bb];
    }
    let t = s * (aa - bb) + c * (ab + ba);
    let (st, ct) = (s * t, c * t);
    [aa - st, ct - ba, ct - ab, bb + st]
}
