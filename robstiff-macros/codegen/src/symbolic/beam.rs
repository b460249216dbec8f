//! A round, uniform beam.
//!
//! As a compliance at its middle it is block diagonal: `bending` across and `torsion` along
//! it for turns, and `bending L^2 / 12` across it for shifts (integrate the turns of its
//! slices over their levers).

use super::vector::{Symmetric3, Vec3};
use crate::graph::{Graph, Sym};

/// A beam that yields.
pub struct Beam<'g> {
    g: &'g Graph,
    /// From its beginning to its end.
    along: Vec3<'g>,
    length_squared: Sym<'g>,
    bending: Sym<'g>,
    torsion: Sym<'g>,
}

impl<'g> Beam<'g> {
    /// The beam along a vector whose square is known; nothing, if it is a point or rigid.
    pub fn of(
        g: &'g Graph,
        along: Vec3<'g>,
        length_squared: Sym<'g>,
        (bending, torsion): (Sym<'g>, Sym<'g>),
    ) -> Option<Self> {
        if length_squared.is_zero() || (bending.is_zero() && torsion.is_zero()) {
            return None;
        }
        Some(Self { g, along, length_squared, bending, torsion })
    }

    /// The lever of its middle, from that of its beginning.
    pub fn middle(&self, lever: Vec3<'g>) -> Vec3<'g> {
        lever - self.along.scaled(self.g.number(0.5))
    }

    /// By how much it turns under a moment at its middle.
    pub fn turn(&self, moment: Vec3<'g>) -> Vec3<'g> {
        moment.scaled(self.bending) + self.along.scaled(self.beyond_bending() * self.along.dot(moment))
    }

    /// `sum` and by how much its end moves under a force, besides by the turn: added part by
    /// part, each product is taken up by a sum.
    pub fn shifted(&self, sum: Vec3<'g>, force: Vec3<'g>) -> Vec3<'g> {
        let bend = self.bend();
        sum + force.scaled(bend * self.length_squared) - self.along.scaled(bend * self.along.dot(force))
    }

    /// The compliance at its middle: displacement per force, rotation per moment.
    pub fn compliance(&self) -> (Symmetric3<'g>, Symmetric3<'g>) {
        let (along, bend) = (self.along, self.bend());
        let turned = along.scaled(self.beyond_bending());
        let shear = along.scaled(bend);
        let diagonal = |i: usize, j: usize, value: Sym<'g>| if i == j { value } else { self.g.number(0.0) };
        let rr = Symmetric3::from_fn(|i, j| turned[i] * along[j] + diagonal(i, j, self.bending));
        let tt = Symmetric3::from_fn(|i, j| diagonal(i, j, bend * self.length_squared) - shear[i] * along[j]);
        (tt, rr)
    }

    /// What torsion is more than bending, per square of the length.
    fn beyond_bending(&self) -> Sym<'g> {
        (self.torsion - self.bending) * self.length_squared.recip()
    }

    fn bend(&self) -> Sym<'g> {
        self.g.number(1.0 / 12.0) * self.bending
    }
}
