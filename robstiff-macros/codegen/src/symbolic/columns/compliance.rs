//! The compliance of joints: the sum of `h (T, R) (T, R)^T`.

use std::ops::Range;

use super::arm::{Arm, Twist};
use crate::graph::{Graph, Sym};
use crate::symbolic::column::Column;
use crate::symbolic::elastic::Elastic;

/// Whether the joints' twists are computed for others, too.
#[derive(Clone, Copy, PartialEq)]
pub enum Twists {
    Computed,
    Unneeded,
}

/// The 36 entries of the compliance of joints alone, by rows.
pub fn of_joints<'g>(g: &'g Graph, arm: &Arm<'g>, elastic: &Elastic<'g>, twists: Twists) -> Vec<Sym<'g>> {
    let mut parts = parts(g, arm, elastic, twists);
    // What is known first is summed first, a constant before all else.
    parts.sort_by_key(|part| part.translation.whole().ready());
    let (constant, others): (Vec<_>, Vec<_>) = parts.iter().partition(|part| part.rotation.is_constant());
    let mut sum = Sum::zero(g);
    parts.iter().for_each(|part| part.translation_onto(&mut sum));
    constant.into_iter().chain(others).for_each(|part| part.rotation_onto(&mut sum));
    sum.entries()
}

/// Something that yields: by `h (T, R) (T, R)^T`.
struct Part<'g> {
    translation: Column<'g>,
    rotation: Column<'g>,
    /// In all directions, unless its root is in the columns already.
    h: Option<Column<'g>>,
}

impl<'g> Part<'g> {
    fn translation_onto(&self, sum: &mut Sum<'g>) {
        let moved = self.times_h(self.translation);
        sum.tt.add(moved, self.translation);
        sum.tr.add(moved, self.rotation);
    }

    fn rotation_onto(&self, sum: &mut Sum<'g>) {
        sum.rr.add(self.rotation, self.times_h(self.rotation));
    }

    fn times_h(&self, column: Column<'g>) -> Column<'g> {
        self.h.map_or(column, |h| column.times(h))
    }
}

/// What yields: all joints about axes that are parallel, one after the other, together.
fn parts<'g>(g: &'g Graph, arm: &Arm<'g>, elastic: &Elastic<'g>, twists: Twists) -> Vec<Part<'g>> {
    let joints = &arm.joints;
    let lasts = (0..joints.len()).filter(|&i| joints[i].beyond.is_none());
    let groups: Vec<_> = lasts.scan(0, |first, last| Some((std::mem::replace(first, last + 1), last))).collect();
    let mut parts: Vec<Vec<Part<'g>>> = Vec::new();
    let mut behind: Option<Group<'g>> = None;
    // From the tip on: what a joint moves may be said by those behind it.
    for (first, last) in groups.into_iter().rev() {
        let compliances: Vec<Sym<'g>> = (first..=last).map(|i| elastic.unloaded_joint(i)).collect();
        let constants: Option<Vec<f64>> =
            compliances.iter().map(|h| h.constant().filter(|&value| value >= 0.0)).collect();
        let group =
            constants.map(|constants| Group::of(g, arm, first..last + 1, &constants, (twists, behind.as_ref())));
        parts.push(match &group {
            Some(group) => group.parts(),
            None => {
                let alone = |(&Twist { translation, rotation, .. }, h)| Part {
                    translation,
                    rotation,
                    h: Some(Column::thrice(h)),
                };
                joints[first..=last].iter().zip(compliances).map(alone).collect()
            }
        });
        behind = group.filter(Group::turns);
    }
    parts.into_iter().rev().flatten().collect()
}

/// Joints about parallel axes, of constant compliances: together at a middle axis, where
/// the mean of their translations is, weighted by the compliances, and each besides by what
/// it is off the middle, which moves the TCP and does not turn it (as the parallel axis
/// theorem splits moments of inertia). So only one of them takes products of translation
/// and rotation. The roots of the compliances are in the columns, where they meet other
/// constants. Gain: `benches/README.md`.
struct Group<'g> {
    g: &'g Graph,
    /// By how much each but one is off the middle, times the root.
    off: Vec<Column<'g>>,
    /// From the last joint to the first, with the share of each that leads to the middle.
    steps: Vec<(Column<'g>, f64)>,
    last: Twist<'g>,
    /// What the middle axis moves, times the root.
    middle: Column<'g>,
    /// The root of the sum of the compliances.
    root: f64,
}

impl<'g> Group<'g> {
    fn of(
        g: &'g Graph,
        arm: &Arm<'g>,
        joints: Range<usize>,
        compliances: &[f64],
        (twists, behind): (Twists, Option<&Self>),
    ) -> Self {
        let at = joints.end - 1;
        let (zero, last) = (Column::zero(g), arm.joints[at]);
        let number = |value: f64| Column::thrice(g.number(value));
        let (mut steps, mut off): (Vec<(Column<'g>, f64)>, Vec<_>) = (Vec::new(), Vec::new());
        let mut total = compliances[compliances.len() - 1];
        for (joint, own) in joints.zip(compliances).rev().skip(1) {
            steps.extend(arm.joints[joint].beyond.map(|step| (step, 0.0)));
            // Of two that are rigid it does not matter.
            let share = own / (total + own).max(f64::MIN_POSITIVE);
            let root = (total * share).sqrt();
            total += own;
            let sum = |sum: Column<'g>, &(step, share): &(_, f64)| sum.plus_product(step, number(root * (1.0 - share)));
            off.push(steps.iter().fold(zero, sum));
            steps.iter_mut().for_each(|(_, middle)| *middle += share * (1.0 - *middle));
        }
        let root = total.sqrt();
        let to_middle = steps.iter().fold(zero, |sum, &(step, share)| sum.plus_product(step, number(root * share)));
        let middle = if twists == Twists::Computed || last.rotation == zero || root == 0.0 {
            to_middle.plus_product(last.translation, number(root))
        } else {
            let onto = (!steps.is_empty()).then_some(to_middle);
            arm.moves_times(at, g.number(root), onto, behind.map(|group| |axis| group.moved(axis)))
        };
        Self { g, off, steps, last, middle, root }
    }

    fn turns(&self) -> bool {
        self.last.rotation != Column::zero(self.g)
    }

    fn parts(&self) -> Vec<Part<'g>> {
        let zero = Column::zero(self.g);
        let off = self.off.iter().map(|&translation| Part { translation, rotation: zero, h: None });
        let rotation = self.last.rotation.times(Column::thrice(self.g.number(self.root)));
        off.chain([Part { translation: self.middle, rotation, h: None }]).collect()
    }

    /// What the first joint moves along an axis, part by part: the rest of the steps, and what
    /// the middle moves, or of a joint alone products that wait for no column.
    fn moved(&self, axis: usize) -> Vec<Sym<'g>> {
        let steps = self.steps.iter().map(|&(step, share)| step.early_at(axis) * self.g.number(1.0 - share));
        let of_last = match self.last.translation.product_at(axis) {
            Some(product) if self.steps.is_empty() => product,
            // Of what is rigid there is no middle.
            _ if self.root == 0.0 => self.last.translation.at(axis),
            _ => self.middle.at(axis) * self.g.number(self.root.recip()),
        };
        steps.chain([of_last]).collect()
    }
}

/// The blocks of a compliance.
struct Sum<'g> {
    tt: Outer<'g>,
    tr: Outer<'g>,
    rr: Outer<'g>,
}

impl<'g> Sum<'g> {
    fn zero(g: &'g Graph) -> Self {
        Self { tt: Outer::zero(g), tr: Outer::zero(g), rr: Outer::zero(g) }
    }

    fn entries(&self) -> Vec<Sym<'g>> {
        let entry = |i: usize, j: usize| match (i < 3, j < 3) {
            (true, true) => self.tt.at_symmetric(i, j),
            (true, false) => self.tr.at(i, j - 3),
            (false, true) => self.tr.at(j, i - 3),
            (false, false) => self.rr.at_symmetric(i - 3, j - 3),
        };
        (0..36).map(|k| entry(k / 6, k % 6)).collect()
    }
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
