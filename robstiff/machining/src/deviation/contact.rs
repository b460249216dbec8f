//! What acts on the tool along a path.

use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::{Matrix3, Vector3, Vector6};

use crate::engagement::Bite;
use crate::milling::{Cut, CutFrame};

/// Which surface is machined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// A wall, by the circumference of the tool.
    Side,
    /// A floor, by its tip.
    Face,
}

/// What acts on the tool at one point of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The wrench at the TCP in the base frame (N, Nm) where the tool is on the path.
    pub wrench: Vector6<f64>,
    /// What a displacement of the TCP from the path adds to the force, 3 x 3 in the
    /// base frame (N/m).
    pub response: Matrix3<f64>,
    /// Feed, normal and axis in the base frame; `None` where the tool plunges or
    /// stays in place.
    pub frame: Option<CutFrame>,
    /// The unit vector into the part, across the machined surface, in the base frame.
    pub into: Option<Vector3<f64>>,
    /// What turns the forces of a [revolution](Load::revolution) into the base frame.
    pub turn: Matrix3<f64>,
}

/// What acts on the tool along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Point by point, as many as the path has.
    pub contacts: Vec<Contact>,
    /// What acts over a revolution.
    pub revolution: Revolutions,
    /// The lines at which there is no force because the tool plunges or stays in
    /// place, so that the cut has no direction. Forces along the axes of the base's
    /// or the TCP's frame need none.
    pub undirected: Vec<usize>,
}

impl Load {
    /// The same with each force of a revolution looked at (N, along the axes that
    /// the cut's force has).
    #[must_use]
    pub fn with_revolution(mut self, forces: Vec<Vector3<f64>>) -> Self {
        self.revolution = Revolutions::Same(forces);
        self
    }

    /// The forces of a revolution at a point (N, along the axes that the cut's force has); none where
    /// only the mean counts.
    pub fn revolution(&self, point: usize) -> Cow<'_, [Vector3<f64>]> {
        match &self.revolution {
            Revolutions::None => Cow::Borrowed(&[]),
            Revolutions::Same(forces) => Cow::Borrowed(forces),
            Revolutions::Each { met, angles } => met[point]
                .as_ref()
                .map_or(Cow::Borrowed(&[][..]), |(cut, bite)| Cow::Owned(bite.extremes(cut, *angles))),
        }
    }
}

/// The forces of a revolution along a path.
#[derive(Clone, Debug, PartialEq)]
pub enum Revolutions {
    /// Only the mean counts.
    None,
    /// These (N), at any of its angles, at each point.
    Same(Vec<Vector3<f64>>),
    /// Those of what each point meets, and with which cut, at so many angles.
    Each {
        /// Point by point; none without a force.
        met: Vec<Option<(Cut, Arc<Bite>)>>,
        /// How many.
        angles: usize,
    },
}
