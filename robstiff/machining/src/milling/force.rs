//! What an end mill meets in a cut: mean force, force over a revolution, torque and power.

use nalgebra::Vector3;

use super::cut::Cut;
use super::revolution::{Piece, edges, force_at, mean_force, pieces};

impl Cut {
    /// The force on the tool averaged over a revolution (N), along feed,
    /// normal and axis; in closed form.
    ///
    /// Without runout this is `N b c / 8 pi [..] + N b / 2 pi [..]` between the
    /// angles of the engagement, as in Altintas; with it each tooth has its own
    /// thickness of chip, and what it does not reach the next one cuts. Of the helix
    /// only its hand matters.
    pub fn mean_force(&self) -> Vector3<f64> {
        mean_force(self, &self.pieces())
    }

    /// The force on the tool (N) along feed, normal and axis with the tip of
    /// the first tooth at an angle (rad); exact along the helix.
    pub fn force_at(&self, angle: f64) -> Vector3<f64> {
        force_at(self, &self.pieces(), angle)
    }

    /// The force at so many angles, evenly spaced over a revolution, the first
    /// at 0.
    pub fn revolution(&self, count: usize) -> Revolution {
        let pieces = self.pieces();
        let angle = |k: usize| core::f64::consts::TAU * k as f64 / count as f64;
        Revolution { samples: (0..count).map(|k| (angle(k), force_at(self, &pieces, angle(k)))).collect() }
    }

    /// The same, and both sides of every angle at which some part of a tooth begins or ends to
    /// cut, where the force jumps or bends: for what is greatest and least, not for a mean.
    pub fn extremes(&self, count: usize) -> Revolution {
        let mut revolution = self.revolution(count);
        let pieces = self.pieces();
        revolution.samples.extend(edges(self, &pieces).map(|angle| (angle, force_at(self, &pieces, angle))));
        revolution.samples.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        revolution
    }

    /// The torque on the spindle averaged over a revolution (Nm).
    pub fn mean_torque(&self) -> f64 {
        // The tangential forces alone, at the tool's radius. Of chips from `phi = from` to
        // `phi = to` the mean is the integral of `ktc h + kte` over the angle.
        let tangential = |piece: &Piece| {
            let chip = piece.feed * (piece.from.cos() - piece.to.cos()) + piece.extra * (piece.to - piece.from);
            self.coefficients.ktc * chip + self.coefficients.kte * (piece.to - piece.from)
        };
        let sum: f64 = self.pieces().iter().flatten().map(tangential).sum();
        0.5 * self.mill.diameter * self.depth * sum / core::f64::consts::TAU
    }

    /// The mean power of the cut (W), where the speed is known.
    pub fn power(&self) -> Option<f64> {
        self.speed.map(|speed| speed * self.mean_torque())
    }

    /// The speed of the feed (m/s), where the spindle's is known.
    pub fn feed_speed(&self) -> Option<f64> {
        let teeth_per_second = self.speed? / core::f64::consts::TAU * self.mill.teeth as f64;
        Some(teeth_per_second * self.feed_per_tooth)
    }

    /// The time between two teeth (s), where the speed is known. With runout some teeth may not
    /// cut; it is that of all teeth.
    pub fn tooth_period(&self) -> Option<f64> {
        self.speed.map(|speed| core::f64::consts::TAU / (speed * self.mill.teeth as f64))
    }

    fn pieces(&self) -> Vec<Vec<Piece>> {
        pieces(&self.mill, self.engagement, self.feed_per_tooth)
    }
}

/// The force on the tool over a revolution.
#[derive(Clone, Debug, PartialEq)]
pub struct Revolution {
    /// The angle of the first tooth's tip (rad) and the force (N), along the
    /// axes of the frame that it was asked for in.
    pub samples: Vec<(f64, Vector3<f64>)>,
}

/// The least and the greatest of what changes over a revolution (N).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The least.
    pub least: f64,
    /// The greatest.
    pub greatest: f64,
}

impl Revolution {
    /// The mean of the samples.
    pub fn mean(&self) -> Vector3<f64> {
        self.samples.iter().map(|(_, force)| force).sum::<Vector3<f64>>() / self.samples.len().max(1) as f64
    }

    /// The least and the greatest component along an axis (0 to 2) among the
    /// samples.
    ///
    /// # Panics
    /// If there is no such axis.
    pub fn range(&self, axis: usize) -> Range {
        let none = Range { least: f64::INFINITY, greatest: f64::NEG_INFINITY };
        self.samples.iter().fold(none, |range, (_, force)| Range {
            least: range.least.min(force[axis]),
            greatest: range.greatest.max(force[axis]),
        })
    }

    /// The greatest size of the force among the samples (N).
    pub fn peak(&self) -> f64 {
        self.samples.iter().map(|(_, force)| force.norm()).fold(0.0, f64::max)
    }
}
