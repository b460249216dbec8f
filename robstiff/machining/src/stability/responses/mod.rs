//! Modes from measured frequency responses of the tool.
//!
//! The responses are those of one pose: how the tool moves along x, y and z by a force along one of them,
//! line by line over the frequency. The model is
//!
//! `G(i w) = sum s s^T / (w_k^2 - w^2 + 2 i z_k w_k w) - L / w^2 + U`,
//!
//! in which the mode `k` has the natural frequency `w_k`, the damping ratio `z_k` and the mass-normalised
//! shape `s`; `L` stands for the modes below the band, `U`, the residual flexibility, for those above it
//! (Ewins, Modal Testing, 2nd ed., Research Studies Press 2000).
//!
//! - The poles that all responses have in common begin with the least-squares complex frequency method:
//!   Guillaume, Verboven, Vanlanduit, Van der Auweraer, Peeters, A poly-reference implementation of the
//!   least-squares complex frequency-domain estimator, Proc. IMAC XXI (2003), here with one denominator for
//!   all responses, as Richardson and Formenti, Parameter estimation from frequency response measurements
//!   using rational fraction polynomials, Proc. IMAC I (1982), have it. Those that stay with the order
//!   are taken.
//! - All parameters are then fitted together to the responses as they were measured, by damped least squares,
//!   with shapes that are real, and the same for force and response: a structure is passive and reciprocal,
//!   and a single column of forces tells all of the shape.
//! - How many modes there are, and whether `L` and `U` are needed, says the information criterion of
//!   Schwarz, Annals of Statistics 6 (1978) 461-464.

mod choose;
mod linear;
mod lines;
mod model;
mod poles;
mod refine;
mod rest;
mod table;
mod units;

use core::fmt;

use nalgebra::Complex;

use super::{MeasuredMode, Spring};
use lines::Lines;

/// What a response is of a unit of force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// The displacement: receptance (m/N).
    Receptance,
    /// The velocity: mobility ((m/s)/N).
    Mobility,
    /// The acceleration: accelerance ((m/s^2)/N).
    Accelerance,
}

impl Motion {
    /// How often the displacement is differentiated.
    pub(super) const fn order(self) -> i32 {
        match self {
            Self::Receptance => 0,
            Self::Mobility => 1,
            Self::Accelerance => 2,
        }
    }

    /// A positive multiple of what a force along the response puts into a passive structure, of such a
    /// response to it.
    pub(super) fn power(self, value: Complex<f64>) -> f64 {
        match self {
            Self::Receptance => -value.im,
            Self::Mobility => value.re,
            Self::Accelerance => value.im,
        }
    }
}

/// The response along one direction to a force along one.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// The directions of the response and of the force: 0, 1, 2 are x, y, z.
    pub directions: [usize; 2],
    /// One for each frequency.
    pub values: Vec<Complex<f64>>,
}

/// Responses that were measured in one pose, at the same frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Responses {
    /// What was measured.
    pub motion: Motion,
    /// The frequencies (Hz), ascending and above zero.
    pub frequencies: Vec<f64>,
    /// The responses.
    pub all: Vec<Response>,
}

/// Modes that were fitted to responses.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedModes {
    /// The modes, the lowest frequency first.
    pub modes: Vec<MeasuredMode>,
    /// What gives way without mass: the modes above the band.
    pub massless: Vec<Spring>,
    /// How well they fit.
    pub fit: Fit,
}

/// How well modes fit responses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The first and the last frequency (Hz).
    pub band: [f64; 2],
    /// How many frequencies there are.
    pub lines: usize,
    /// How many responses.
    pub responses: usize,
    /// What modes and springs leave of the responses, over these (root mean squares).
    pub left: f64,
    /// The part of modes below the band, which are not among those found, over the responses (root mean
    /// squares).
    pub below: f64,
}

/// Why responses give no modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FitError {
    /// The responses do not have all three directions to one force, or the reverse.
    Incomplete,
    /// So many lines in the band are too few for so many modes.
    TooFewLines {
        /// The lines that there are.
        lines: usize,
        /// What the modes need.
        needed: usize,
        /// The modes.
        modes: usize,
    },
    /// Only so many modes stand out.
    TooManyModes {
        /// The modes that were found.
        found: usize,
        /// The modes that were asked for.
        asked: usize,
    },
    /// No mode in the band is one of a real structure.
    NoMode,
    /// The modes leave so much of the responses (root mean squares).
    Unexplained(f64),
}

/// Modes that may be asked for, at the most.
pub const MOST_MODES: usize = poles::MOST_ORDER / 2;

/// What modes may leave of the responses, over these: with more they explain less than they do not.
const MOST_LEFT: f64 = 0.5;

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Incomplete => f.write_str("no force has its responses along x, y and z"),
            Self::TooFewLines { lines, needed, modes } => {
                let of = if *modes == 1 { "mode needs" } else { "modes need" };
                write!(f, "{modes} {of} {needed} lines, and {lines} are in the band")
            }
            Self::TooManyModes { found, asked } => {
                write!(f, "{asked} modes are asked for, and the responses have {found}")
            }
            Self::NoMode => f.write_str("the responses have no mode in the band"),
            Self::Unexplained(left) => write!(f, "the modes leave {:.0} % of the responses", 100.0 * left),
        }
    }
}

impl core::error::Error for FitError {}

impl Responses {
    /// The modes, as many as are asked for, or as the responses tell.
    ///
    /// # Errors
    /// [`FitError`], where the responses do not give them.
    pub fn fit(&self, asked: Option<usize>) -> Result<FittedModes, FitError> {
        if !self.is_complete() {
            return Err(FitError::Incomplete);
        }
        let (lines, modes) = (self.frequencies.len(), asked.unwrap_or(1).max(1));
        let needed = poles::least_lines(modes);
        if lines < needed {
            return Err(FitError::TooFewLines { lines, needed, modes });
        }
        let lines = Lines::new(self);
        let fitted = units::unscaled(&lines, &choose::model(&lines, asked)?);
        if fitted.fit.left > MOST_LEFT { Err(FitError::Unexplained(fitted.fit.left)) } else { Ok(fitted) }
    }

    /// Whether all three directions respond to one force, or one responds to forces along all three.
    pub fn is_complete(&self) -> bool {
        let has = |i: usize, j: usize| self.all.iter().any(|one| [[i, j], [j, i]].contains(&one.directions));
        (0..3).any(|j| (0..3).all(|i| has(i, j)))
    }

    /// The places in [`all`](Self::all) of those along their force that no structure has: swinging with them it
    /// would give power to the hammer, by more than twice what chance makes of signs that mean nothing.
    pub fn impossible(&self) -> impl Iterator<Item = usize> {
        let takes = |response: &Response| {
            let powers = response.values.iter().map(|value| self.motion.power(*value));
            let (sum, squares) =
                powers.fold((0.0, 0.0), |(sum, squares), power| (sum + power, squares + power * power));
            sum < -2.0 * f64::sqrt(squares)
        };
        let is = move |response: &Response| response.directions[0] == response.directions[1] && takes(response);
        self.all.iter().enumerate().filter(move |(_, response)| is(response)).map(|(place, _)| place)
    }
}
