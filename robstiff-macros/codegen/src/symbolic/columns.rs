//! Frames column by column: a second formulation for scalars that compute with
//! four numbers as with one.
//!
//! From the base to the tip a turn is `x <- c x + s y`, `y <- c y - s x` of
//! whole axes, without the zeros that single numbers leave out and without
//! their products of angles. What a joint moves at the TCP is `z x lever`, and
//! with the lever in the joint's own axes that is `u y - v x`: the levers are
//! carried from the tip to the base in single numbers, at most four products a turn.
//! Where a joint's neighbour says some of it, less is computed (module `arm`).
//! The compliance is the sum of `h (T, R) (T, R)^T` over the joints, by cyclic
//! diagonals (module `compliance`). Gain: `benches/README.md`.

mod arm;
mod compliance;
mod levers;
mod walker;

use robstiff_robots::Description;

use self::arm::{Arm, Twist};
use self::compliance::Twists;
use self::walker::Walker;
use super::chain::{Step, chain};
use super::column::{Column, Signed};
use super::elastic::Elastic;
use super::turning::Turning;
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
    let compliance = compliance_of(g, robot, &arm, Twists::Computed);
    [homogeneous(arm.axes, arm.origin), entries(&arm.joints), compliance].concat()
}

/// The 36 entries of the compliance by rows; as without columns, where it is not
/// of joints alone.
pub fn compliance<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    compliance_of(g, robot, &Arm::of(g, robot), Twists::Unneeded)
}

fn compliance_of<'g>(g: &'g Graph, robot: &Description, arm: &Arm<'g>, twists: Twists) -> Vec<Sym<'g>> {
    let elastic = Elastic::of(g, robot);
    if elastic.is_of_joints() {
        compliance::of_joints(g, arm, &elastic, twists)
    } else {
        super::compliance::compliance(g, robot)
    }
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
