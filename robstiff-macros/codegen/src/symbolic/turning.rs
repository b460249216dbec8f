//! What is turned on the way along a chain.

use std::mem::take;

use super::step::Tilt;
use crate::angle::Angle;
use crate::graph::{Graph, Sym};

/// Vectors and matrices that are carried from frame to frame. Turns about z stay
/// pending until another axis is turned about, so that parallel axes are one
/// angle.
pub trait Turning<'g> {
    /// Where its entries are.
    fn graph(&self) -> &'g Graph;

    /// A turn about z that it does not contain yet.
    fn pending(&mut self) -> &mut Angle;

    /// Turns everything about an axis, from 0, by an angle of this sine and
    /// cosine.
    fn turn(&mut self, axis: usize, sin_cos: (Sym<'g>, Sym<'g>));

    /// Turns about z, in time.
    fn turn_later(&mut self, angle: &Angle) {
        let pending = self.pending();
        *pending = take(pending) + angle;
    }

    /// Performs the pending turn.
    fn settle(&mut self) {
        let pending = take(self.pending());
        if !pending.is_zero() {
            let sin_cos = self.graph().sin_cos(&pending);
            self.turn(2, sin_cos);
        }
    }

    /// Performs a constant turn.
    fn tilt(&mut self, tilt: Tilt<'g>) {
        if tilt.is_half_turn_about_x() {
            // Rz(a) Rx(180) = Rx(180) Rz(-a): the turn may stay pending.
            let pending = self.pending();
            *pending = -take(pending);
        } else {
            self.settle();
        }
        self.turn(tilt.axis, tilt.sin_cos);
    }
}
