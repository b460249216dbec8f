//! The elementary steps of a chain.

use super::vector::Vec3;
use crate::angle::Angle;
use crate::graph::Sym;

/// One step from a frame to the next. What stands in the frame that has been
/// reached (a joint, the foundation) is a step that does not move.
#[derive(Clone, Debug)]
pub enum Step<'g> {
    /// A shift along the axes of the current frame.
    Move(Vec3<'g>),
    /// A turn about the current z axis.
    Turn(Angle),
    /// A turn about the current axis 0 (x) or 1 (y) by a constant angle.
    Tilt(Tilt<'g>),
    /// Here is frame 0.
    Base,
    /// Joint `i` (from 0) acts on the current z axis, at the current origin.
    Joint(usize),
    /// Link `i` (from 0) begins at the current origin and ends a vector
    /// further, in the current axes.
    Link(usize, Vec3<'g>),
    /// Here is the frame of link `i` (from 0).
    LinkFrame(usize),
    /// Here is the flange frame.
    Flange,
}

/// A constant turn about x (0) or y (1).
#[derive(Clone, Copy, Debug)]
pub struct Tilt<'g> {
    /// The axis turned about.
    pub axis: usize,
    /// Sine and cosine.
    pub sin_cos: (Sym<'g>, Sym<'g>),
}

impl Tilt<'_> {
    /// Whether this is half a turn about x, which merely mirrors turns about z.
    pub fn is_half_turn_about_x(&self) -> bool {
        // The cosine alone is -1 by rounding, too.
        self.axis == 0 && self.sin_cos.0.is_zero() && self.sin_cos.1.constant() == Some(-1.0)
    }
}

/// Steps without the turn of the first joint, and that turn, if it is about the base's
/// z axis, if all moves before are along it, and if no parallel axis follows: turns about
/// parallel axes are one.
pub fn without_waist<'g>(steps: &[Step<'g>]) -> Option<(Vec<Step<'g>>, Angle)> {
    let is_turn = |step: &Step<'g>| matches!(step, Step::Turn(_) | Step::Tilt(_));
    let first = steps.iter().position(is_turn)?;
    let along_z = |step: &Step<'g>| match step {
        Step::Move(by) => by[0].is_zero() && by[1].is_zero(),
        _ => true,
    };
    let next = steps[first + 1..].iter().find(|step| is_turn(step));
    let settles = matches!(next, Some(Step::Tilt(tilt)) if !tilt.is_half_turn_about_x());
    let Step::Turn(angle) = &steps[first] else { return None };
    if angle.terms().is_empty() || !settles || !steps[..first].iter().all(along_z) {
        return None;
    }
    let mut rest = steps.to_vec();
    rest.remove(first);
    Some((rest, angle.clone()))
}
