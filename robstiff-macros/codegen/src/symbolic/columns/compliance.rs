//! The compliance of joints: the sum of `h (T, R) (T, R)^T`.

use super::arm::Twist;
use crate::graph::{Graph, Sym};
use crate::symbolic::column::Column;
use crate::symbolic::elastic::Elastic;

/// The 36 entries of the compliance of joints alone, by rows.
pub fn of_joints<'g>(g: &'g Graph, joints: &[Twist<'g>], elastic: &Elastic<'g>) -> Vec<Sym<'g>> {
    let mut parts = parts(g, joints, elastic);
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
fn parts<'g>(g: &'g Graph, joints: &[Twist<'g>], elastic: &Elastic<'g>) -> Vec<Part<'g>> {
    let mut parts = Vec::new();
    let mut first = 0;
    for last in (0..joints.len()).filter(|&i| joints[i].beyond.is_none()) {
        let group = &joints[first..=last];
        let compliances: Vec<Sym<'g>> = (first..=last).map(|i| elastic.unloaded_joint(i)).collect();
        let constants: Option<Vec<f64>> =
            compliances.iter().map(|h| h.constant().filter(|&value| value >= 0.0)).collect();
        match constants {
            Some(constants) => together(g, group, &constants, &mut parts),
            None => {
                let alone = |(&Twist { translation, rotation, .. }, h)| Part {
                    translation,
                    rotation,
                    h: Some(Column::thrice(h)),
                };
                parts.extend(group.iter().zip(compliances).map(alone));
            }
        }
        first = last + 1;
    }
    parts
}

/// Joints about parallel axes, of constant compliances: together at a middle axis, where
/// the mean of their translations is, weighted by the compliances, and each besides by what
/// it is off the middle, which moves the TCP and does not turn it (as the parallel axis
/// theorem splits moments of inertia). So only one of them takes products of translation
/// and rotation. The roots of the compliances are in the columns, where they meet other
/// constants. Gain: `benches/README.md`.
fn together<'g>(g: &'g Graph, joints: &[Twist<'g>], compliances: &[f64], parts: &mut Vec<Part<'g>>) {
    let (Some((last, nearer)), Some((&compliance, others))) = (joints.split_last(), compliances.split_last()) else {
        return;
    };
    let zero = Column::zero(g);
    let number = |value: f64| Column::thrice(g.number(value));
    // The steps from joint to joint so far, each with the share of it that leads to the middle.
    let mut steps: Vec<(Column<'g>, f64)> = Vec::new();
    let mut total = compliance;
    for (joint, own) in nearer.iter().zip(others).rev() {
        steps.extend(joint.beyond.map(|step| (step, 0.0)));
        // Of two that are rigid it does not matter.
        let share = own / (total + own).max(f64::MIN_POSITIVE);
        let root = (total * share).sqrt();
        total += own;
        let off = steps.iter().fold(zero, |sum, &(step, middle)| sum.plus_product(step, number(root * (1.0 - middle))));
        parts.push(Part { translation: off, rotation: zero, h: None });
        steps.iter_mut().for_each(|(_, middle)| *middle += share * (1.0 - *middle));
    }
    let root = total.sqrt();
    let to_middle = steps.iter().fold(zero, |sum, &(step, middle)| sum.plus_product(step, number(root * middle)));
    let translation = to_middle.plus_product(last.translation, number(root));
    parts.push(Part { translation, rotation: last.rotation.times(number(root)), h: None });
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
