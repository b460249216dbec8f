//! The levers of joints in single numbers.

use std::mem::take;

use crate::angle::Angle;
use crate::graph::{Graph, Sym};
use crate::symbolic::chain::{Step, Tilt};
use crate::symbolic::turning::Turning;
use crate::symbolic::vector::{AXES, Vec3};

/// From each joint to the TCP, in the axes behind the turns about z that follow.
pub fn levers<'g>(g: &'g Graph, steps: &[Step<'g>]) -> Vec<Vec3<'g>> {
    let mut lever = Lever { g, vector: Vec3::zero(g), pending: Angle::default(), beside: Vec::new() };
    let mut levers = Vec::new();
    for step in steps.iter().rev() {
        match step {
            Step::Move(by) => lever.shift(*by),
            Step::Turn(angle) => lever.turn_all_later(angle),
            Step::Tilt(tilt) => lever.tilt_all(*tilt),
            Step::Joint(i) => {
                let own = lever.behind_turns();
                for (entry, axis) in own.0.into_iter().zip(AXES) {
                    entry.named(format!("r{}{axis}", i + 1));
                }
                levers.push(own);
            }
            _ => {}
        }
    }
    levers.reverse();
    levers
}

/// A vector to the TCP, in the axes of the current frame less a turn about z.
struct Lever<'g> {
    g: &'g Graph,
    vector: Vec3<'g>,
    pending: Angle,
    /// Moves between parallel axes, each in axes less a turn about z of its own: the one
    /// that the columns are turned by there, too.
    beside: Vec<(Vec3<'g>, Angle)>,
}

impl<'g> Lever<'g> {
    fn shift(&mut self, by: Vec3<'g>) {
        match self.pending.is_zero() {
            true => self.vector = self.vector + by,
            false => self.beside.push((by, Angle::default())),
        }
    }

    fn turn_all_later(&mut self, angle: &Angle) {
        self.turn_later(angle);
        for (_, own) in &mut self.beside {
            *own = take(own) + angle;
        }
    }

    fn tilt_all(&mut self, tilt: Tilt<'g>) {
        if tilt.is_half_turn_about_x() {
            for (by, angle) in &mut self.beside {
                *by = by.turned(tilt.axis, tilt.sin_cos);
                *angle = -take(angle);
            }
        } else {
            self.settle();
            for (by, angle) in take(&mut self.beside) {
                self.vector = self.vector + by.turned(2, self.g.sin_cos(&angle));
            }
        }
        self.tilt(tilt);
    }

    /// The whole vector in the axes behind the turns that are pending.
    fn behind_turns(&self) -> Vec3<'g> {
        let turned_back = |(by, angle): &(Vec3<'g>, Angle)| {
            let back = -self.pending.clone() + angle;
            by.turned(2, self.g.sin_cos(&back))
        };
        self.beside.iter().map(turned_back).fold(self.vector, |sum, by| sum + by)
    }
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
