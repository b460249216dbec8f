//! The springs of an arm, how far each lets go, and chains of them.

use nalgebra::Vector3;

use super::equilibrium::{Attached, Pull};
use super::frame::{Frame, exp};

/// How a spring lets go.
#[derive(Clone, Copy, Debug)]
pub(super) enum Motion {
    /// By a finite turn, a rotation vector in the spring's frame.
    Turn,
    /// By a shift in the spring's frame.
    Slide,
}

/// How far a spring lets go under its generalised force.
#[derive(Clone, Copy, Debug)]
pub(super) enum Response {
    /// Compliance about or along x, y, z of the spring's frame (rad/Nm or m/N).
    Linear(Vector3<f64>),
    /// About or along z only, as the [`JointLaw`](super::gear::JointLaw) says for this joint, from 0.
    Joint(usize),
    /// About x and y alike, with a compliance that falls with the moment `m`
    /// there: `compliance m / sqrt(1 + (m / knee)^2)`.
    Stiffening { compliance: f64, knee: f64 },
    /// Along or about x only, half a gap (m or rad) to the side of the force or moment, with
    /// a knee (N or Nm).
    Gap { gap: f64, knee: f64 },
}

impl Response {
    /// How far it lets go, and the integral of that over the force (J); joints
    /// have a law of their own.
    pub fn alone(&self, work: &Vector3<f64>) -> (Vector3<f64>, f64) {
        match *self {
            Self::Linear(compliance) => {
                let by = compliance.component_mul(work);
                (by, 0.5 * work.dot(&by))
            }
            Self::Joint(_) => (Vector3::zeros(), 0.0),
            Self::Stiffening { compliance, knee } => {
                let across = Vector3::new(work.x, work.y, 0.0);
                let bend = 1_f64.hypot(across.norm() / knee);
                (across * (compliance / bend), compliance * knee * knee * (bend - 1.0))
            }
            Self::Gap { gap, knee } => {
                let size = work.x.hypot(knee);
                (Vector3::x() * (0.5 * gap * work.x / size), 0.5 * gap * (size - knee))
            }
        }
    }
}

/// A spring, and the rigid piece that leads to it.
#[derive(Clone, Debug)]
pub(super) struct Spring {
    /// The spring's frame in that of the spring before, as that one has moved.
    pub rod: Frame,
    pub motion: Motion,
    pub response: Response,
}

impl Spring {
    /// Its frame after it has let go.
    pub fn let_go(&self, frame: &Frame, by: &Vector3<f64>) -> Frame {
        match self.motion {
            Motion::Turn => Frame { turn: frame.turn * exp(by), ..*frame },
            Motion::Slide => Frame { origin: frame.origin + frame.turn * by, ..*frame },
        }
    }
}

/// A chain under construction, from the base outwards.
pub(super) struct Chain {
    pub springs: Vec<Spring>,
    /// The rigid piece since the last spring.
    pub rod: Frame,
    /// What pulls at it.
    pub attached: Vec<Attached>,
}

impl Chain {
    /// With nothing but where the first piece begins.
    pub fn at(base: Frame) -> Self {
        Self { springs: Vec::new(), rod: base, attached: Vec::new() }
    }

    pub fn rigid(&mut self, piece: &Frame) {
        self.rod = self.rod.then(piece);
    }

    pub fn push(&mut self, motion: Motion, response: Response) {
        let rod = std::mem::replace(&mut self.rod, Frame::identity());
        self.springs.push(Spring { rod, motion, response });
    }

    /// Lets something pull at a point `at` (m) in the frame that the chain has
    /// come to.
    pub fn attached(&mut self, at: Vector3<f64>, pull: Pull) {
        let at = self.rod.origin + self.rod.turn * at;
        self.attached.push(Attached { after: self.springs.len(), at, pull });
    }

    pub fn spring(&mut self, motion: Motion, compliance: Vector3<f64>) {
        self.push(motion, Response::Linear(compliance));
    }
}
