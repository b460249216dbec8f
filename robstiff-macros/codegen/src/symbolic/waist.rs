//! The first joint's turn, left for the end.
//!
//! What is calculated without it lies in the plane of the next joints while
//! their axes are parallel, where a third of the entries is zero; one turn of
//! the results then costs less than turning each axis on the way. Which is the
//! cheaper depends on the arm and on what is asked for, so both are counted.
//! The transform alone has four vectors to turn and gains nothing. Gain:
//! `benches/README.md`.

use robstiff_robots::Description;

use super::chain::chain;
use super::forward::{Forward, forward};
use super::step::Step;
pub use super::step::without_waist;
use super::vector::Vec3;
use crate::angle::Angle;
use crate::function::Function;
use crate::graph::{Graph, Sym};

/// Where a walk starts, and what its vectors still have to be turned by, about
/// the base's z axis.
pub struct Start<'g> {
    g: &'g Graph,
    steps: Vec<Step<'g>>,
    rest: Angle,
}

impl<'g> Start<'g> {
    /// At the base: nothing is left.
    pub fn at_base(g: &'g Graph, robot: &Description) -> Self {
        Self { g, steps: chain(g, robot), rest: Angle::default() }
    }

    /// Behind the first joint, where there is a [waist](without_waist).
    fn at_waist(g: &'g Graph, robot: &Description) -> Option<Self> {
        let (steps, rest) = without_waist(&chain(g, robot))?;
        Some(Self { g, steps, rest })
    }

    /// Frames and levers, all less the rest of the turn.
    pub fn forward(&self) -> Forward<'g> {
        forward(self.g, &self.steps)
    }

    /// A vector of [`forward`](Self::forward) in the base frame.
    pub fn to_base(&self, v: Vec3<'g>) -> Vec3<'g> {
        if self.rest.is_zero() { v } else { v.turned(2, self.g.sin_cos(&self.rest)) }
    }

    /// A vector of the base frame as those of [`forward`](Self::forward).
    pub fn from_base(&self, v: Vec3<'g>) -> Vec3<'g> {
        if self.rest.is_zero() { v } else { v.turned(2, self.g.sin_cos(&-self.rest.clone())) }
    }
}

/// Runs an algorithm from where it takes the fewest operations.
pub fn cheapest<'g>(
    g: &'g Graph,
    robot: &Description,
    algorithm: impl for<'h> Fn(&'h Graph, &Start<'h>) -> Vec<Sym<'h>>,
) -> Vec<Sym<'g>> {
    let has_waist = Start::at_waist(&Graph::new(), robot).is_some();
    let operations = |function: Function| function.cost().mul + function.cost().add;
    let at_waist = has_waist
        && operations(Function::of(|g| algorithm(g, &Start::at_waist(g, robot).expect("it has one"))))
            < operations(Function::of(|g| algorithm(g, &Start::at_base(g, robot))));
    let start = if at_waist { Start::at_waist(g, robot) } else { None };
    algorithm(g, &start.unwrap_or_else(|| Start::at_base(g, robot)))
}
