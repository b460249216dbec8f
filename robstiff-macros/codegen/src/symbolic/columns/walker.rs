//! Frames in columns, carried from the base to the tip.

use crate::angle::Angle;
use crate::graph::{Graph, Sym};
use crate::symbolic::column::{Column, Signed};
use crate::symbolic::step::Step;
use crate::symbolic::turning::Turning;
use crate::symbolic::vector::Vec3;

/// From the base to the tip.
pub(super) struct Walker<'g> {
    pub g: &'g Graph,
    pub axes: [Signed<'g>; 3],
    pub origin: Column<'g>,
    /// A turn about z that the axes do not contain yet.
    pub pending: Angle,
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
    pub fn at_base(g: &'g Graph) -> Self {
        Self {
            g,
            axes: std::array::from_fn(|axis| Signed::of(Column::unit(g, axis))),
            origin: Column::unit(g, 3),
            pending: Angle::default(),
        }
    }

    pub fn step(&mut self, step: &Step<'g>) {
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
pub(super) fn along<'g>(point: Column<'g>, axes: [Signed<'g>; 3], by: Vec3<'g>) -> Column<'g> {
    (0..3).fold(point, |point, axis| axes[axis].added(point, by[axis]))
}
