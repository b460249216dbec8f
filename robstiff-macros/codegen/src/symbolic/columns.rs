//! Frames column by column: a second formulation for scalars that compute with
//! four numbers as with one.
//!
//! From the base to the tip a turn is `x <- c x + s y`, `y <- c y - s x` of
//! whole axes, without the zeros that single numbers leave out and without
//! their products of angles. What a joint moves at the TCP is `z x lever`, and
//! with the lever in the joint's own axes that is `u y - v x`: the levers are
//! carried from the tip to the base in single numbers, at most four products a turn.
//! The compliance is the sum of `h (T, R) (T, R)^T` over the joints, by cyclic
//! diagonals. Gain: `benches/README.md`.

use robstiff_robots::{Description, JointKind};

use super::chain::{Step, chain};
use super::column::{Column, Signed};
use super::elastic::Elastic;
use super::turning::Turning;
use super::vector::{AXES, Vec3};
use crate::angle::Angle;
use crate::graph::{Graph, Sym};

/// The four columns of the TCP's frame in the base frame.
pub fn transform<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    let mut walker = Walker::at_base(g);
    let steps = chain(g, robot);
    for (k, step) in steps.iter().enumerate() {
        // A move by the axes as they stay takes fewer products.
        if !turns_further(&steps[k..]) {
            walker.settle();
        }
        walker.step(step);
    }
    walker.settle();
    homogeneous(walker.axes, walker.origin)
}

/// The Jacobian, 6 entries a column, column by column.
pub fn jacobian<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    entries(&Arm::of(g, robot).joints)
}

/// The four columns of the transform, the entries of the Jacobian and of the compliance.
pub fn statics<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    let arm = Arm::of(g, robot);
    let compliance = compliance_of(g, robot, &arm);
    [homogeneous(arm.axes, arm.origin), entries(&arm.joints), compliance].concat()
}

/// The 36 entries of the compliance by rows; as without columns, where it is not
/// of joints alone.
pub fn compliance<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    compliance_of(g, robot, &Arm::of(g, robot))
}

fn compliance_of<'g>(g: &'g Graph, robot: &Description, arm: &Arm<'g>) -> Vec<Sym<'g>> {
    let elastic = Elastic::of(g, robot);
    if elastic.is_of_joints() { of_joints(g, &arm.joints, &elastic) } else { super::compliance(g, robot) }
}

/// Whether a turn about the same axis follows.
fn turns_further(steps: &[Step<'_>]) -> bool {
    let mut turns = steps.iter().filter(|step| match step {
        Step::Tilt(tilt) => !tilt.is_half_turn_about_x(),
        step => matches!(step, Step::Turn(_)),
    });
    matches!(turns.next(), Some(Step::Turn(_)))
}

/// The columns of the TCP's frame.
fn homogeneous<'g>(axes: [Signed<'g>; 3], origin: Column<'g>) -> Vec<Sym<'g>> {
    let [x, y, z] = axes.map(|axis| axis.column().direction());
    [x.named("x_"), y.named("y_"), z.named("z_"), origin.named("p_")].map(Column::whole).to_vec()
}

fn entries<'g>(joints: &[Twist<'g>]) -> Vec<Sym<'g>> {
    joints.iter().flat_map(|joint| [joint.translation, joint.rotation].map(|part| part.vector().0)).flatten().collect()
}

/// What a unit of a joint coordinate moves at the TCP, in the base frame.
#[derive(Clone, Copy)]
struct Twist<'g> {
    translation: Column<'g>,
    rotation: Column<'g>,
}

/// From the base to the tip.
struct Walker<'g> {
    g: &'g Graph,
    axes: [Signed<'g>; 3],
    origin: Column<'g>,
    /// A turn about z that the axes do not contain yet.
    pending: Angle,
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
        self.axes[i] = Signed::combined((u, c), (v, s));
        self.axes[j] = Signed::combined((v, c), (u, -s));
    }
}

impl<'g> Walker<'g> {
    fn at_base(g: &'g Graph) -> Self {
        Self {
            g,
            axes: std::array::from_fn(|axis| Signed::of(Column::unit(g, axis))),
            origin: Column::unit(g, 3),
            pending: Angle::default(),
        }
    }

    fn step(&mut self, step: &Step<'g>) {
        match step {
            Step::Move(by) => {
                let by = by.turned(2, self.g.sin_cos(&self.pending));
                self.origin = along(self.origin, self.axes, by);
            }
            Step::Turn(angle) => self.turn_later(angle),
            Step::Tilt(tilt) => self.tilt(*tilt),
            _ => {}
        }
    }
}

/// A point and a vector from there, in the given axes.
fn along<'g>(point: Column<'g>, axes: [Signed<'g>; 3], by: Vec3<'g>) -> Column<'g> {
    (0..3).fold(point, |point, axis| axes[axis].added(point, by[axis]))
}

/// The twists of all joints and the TCP's frame.
struct Arm<'g> {
    joints: Vec<Twist<'g>>,
    axes: [Signed<'g>; 3],
    origin: Column<'g>,
}

impl<'g> Arm<'g> {
    fn of(g: &'g Graph, robot: &Description) -> Self {
        let steps = chain(g, robot);
        // Where levers begin: at the base, and at every joint.
        let (base, levers) = levers(g, &steps);
        let mut walker = Walker::at_base(g);
        let (mut joints, mut waiting) =
            (Vec::new(), vec![Waiting { joint: None, z: walker.axes[2], is_mirrored: false }]);
        let zero = Column::zero(g);
        let mut origin = zero;
        let mut settled = |walker: &Walker<'g>, waiting: &mut Vec<Waiting<'g>>| {
            let [x, y, _] = walker.axes;
            for Waiting { joint, z, is_mirrored } in waiting.drain(..) {
                let y = y.negated_if(is_mirrored);
                let Some(joint) = joint else {
                    origin = along(Column::unit(g, 3), [x, y, z], base);
                    continue;
                };
                joints.push(match robot.joints[joint].kind {
                    JointKind::Revolute => {
                        let Vec3([along_x, along_y, _]) = levers[joint];
                        let translation = Signed::combined((y, along_x), (x, -along_y)).column();
                        Twist { translation: translation.named(&format!("j{}", joint + 1)), rotation: z.column() }
                    }
                    JointKind::Prismatic => Twist { translation: z.column(), rotation: zero },
                });
            }
        };
        for step in &steps {
            if let Step::Joint(i) = step {
                waiting.push(Waiting { joint: Some(*i), z: walker.axes[2], is_mirrored: false });
            }
            match step {
                Step::Tilt(tilt) if tilt.is_half_turn_about_x() => {
                    waiting.iter_mut().for_each(|stand| stand.is_mirrored = !stand.is_mirrored);
                }
                Step::Tilt(_) => {
                    walker.settle();
                    settled(&walker, &mut waiting);
                }
                _ => {}
            }
            walker.step(step);
        }
        walker.settle();
        settled(&walker, &mut waiting);
        Self { joints, axes: walker.axes, origin }
    }
}

/// A place whose lever is in the axes behind the turns that follow.
struct Waiting<'g> {
    /// The joint that stands there, or the base.
    joint: Option<usize>,
    z: Signed<'g>,
    /// Whether the y axis has changed its sign since.
    is_mirrored: bool,
}

/// A vector to the TCP, in the axes of the current frame less a turn about z.
struct Lever<'g> {
    g: &'g Graph,
    vector: Vec3<'g>,
    pending: Angle,
}

impl<'g> Turning<'g> for Lever<'g> {
    fn graph(&self) -> &'g Graph {
        self.g
    }

    fn pending(&mut self) -> &mut Angle {
        &mut self.pending
    }

    fn turn(&mut self, axis: usize, sin_cos: (Sym<'g>, Sym<'g>)) {
        self.vector = self.vector.turned(axis, sin_cos);
    }
}

/// From the base and from each joint to the TCP, in the axes behind the turns
/// about z that follow.
fn levers<'g>(g: &'g Graph, steps: &[Step<'g>]) -> (Vec3<'g>, Vec<Vec3<'g>>) {
    let mut lever = Lever { g, vector: Vec3::zero(g), pending: Angle::default() };
    let mut levers = Vec::new();
    for step in steps.iter().rev() {
        match step {
            Step::Move(by) => lever.vector = lever.vector + by.turned(2, g.sin_cos(&-lever.pending.clone())),
            Step::Turn(angle) => lever.turn_later(angle),
            Step::Tilt(tilt) => lever.tilt(*tilt),
            Step::Joint(i) => {
                levers.push(lever.vector);
                for (entry, axis) in lever.vector.0.into_iter().zip(AXES) {
                    entry.named(format!("r{}{axis}", i + 1));
                }
            }
            _ => {}
        }
    }
    levers.reverse();
    (lever.vector, levers)
}

/// The 36 entries of the compliance of joints alone, by rows.
fn of_joints<'g>(g: &'g Graph, joints: &[Twist<'g>], elastic: &Elastic<'g>) -> Vec<Sym<'g>> {
    let [mut tt, mut tr, mut rr] = std::array::from_fn(|_| Outer::zero(g));
    // Parallel axes turn the TCP alike.
    let mut directions: Vec<(Column<'g>, Sym<'g>)> = Vec::new();
    // What is known first is summed first.
    let mut order: Vec<usize> = (0..joints.len()).collect();
    order.sort_by_key(|&i| joints[i].translation.whole().ready());
    for i in order {
        let (Twist { translation, rotation }, h) = (joints[i], elastic.unloaded_joint(i));
        let moved = translation.times(Column::thrice(h));
        // Of a constant axis the product is one, too.
        let (one, other, axis) = match rotation.is_constant() {
            true => (translation, moved, rotation.scaled(h)),
            false => (moved, translation, rotation),
        };
        tt.add(one, other);
        tr.add(one, axis);
        match directions.iter_mut().find(|(axis, _)| *axis == rotation) {
            Some((_, sum)) => *sum = *sum + h,
            None => directions.push((rotation, h)),
        }
    }
    for (axis, h) in directions {
        rr.add(axis, axis.times(Column::thrice(h)));
    }
    let entry = |i: usize, j: usize| match (i < 3, j < 3) {
        (true, true) => tt.at_symmetric(i, j),
        (true, false) => tr.at(i, j - 3),
        (false, true) => tr.at(j, i - 3),
        (false, false) => rr.at_symmetric(i - 3, j - 3),
    };
    (0..36).map(|k| entry(k / 6, k % 6)).collect()
}

/// A sum of products `a b^T`, by its cyclic diagonals: xx, yy, zz; xy, yz, zx;
/// yx, zy, xz. They are products of whole columns, two of them moved on by an
/// entry; rows would take a copy of every entry into all lanes.
struct Outer<'g> {
    straight: Column<'g>,
    above: Column<'g>,
    below: Column<'g>,
}

impl<'g> Outer<'g> {
    fn zero(g: &'g Graph) -> Self {
        let zero = Column::zero(g);
        Self { straight: zero, above: zero, below: zero }
    }

    /// Adds `a b^T`.
    fn add(&mut self, a: Column<'g>, b: Column<'g>) {
        self.straight = self.straight.plus_product(a, b);
        self.above = self.above.plus_product(a, b.cycled());
        self.below = self.below.plus_product(a.cycled(), b);
    }

    fn at(&self, row: usize, column: usize) -> Sym<'g> {
        match (column + 3 - row) % 3 {
            0 => self.straight.at(row),
            1 => self.above.at(row),
            _ => self.below.at(column),
        }
    }

    /// Of a symmetric sum, without what is above: it is not computed then.
    fn at_symmetric(&self, row: usize, column: usize) -> Sym<'g> {
        if (column + 3 - row) % 3 == 1 { self.at(column, row) } else { self.at(row, column) }
    }
}
