//! An end mill in a cut.

use super::{Coefficients, Engagement};

/// A cylindrical end mill with evenly spaced teeth.
#[derive(Clone, Debug, PartialEq)]
pub struct EndMill {
    /// Diameter (m).
    pub diameter: f64,
    /// Number of teeth.
    pub teeth: usize,
    /// Helix angle (rad); positive for a right-handed helix, which pulls the tool out of
    /// its holder, negative for a left-handed one, which pushes it in.
    pub helix: f64,
    /// The radius of its corner (m): 0 of a flat end mill, half the diameter of a ball nose. It shapes what is met in a
    /// [stock](crate::engagement); a cut of a given width and depth is taken by the circumference alone.
    pub corner: f64,
    /// How far each tooth stands out beyond the mean radius (m), in the order
    /// in which they cut, as an indicator shows it; empty without runout.
    pub runout: Vec<f64>,
}

/// An end mill in a cut.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// The tool.
    pub mill: EndMill,
    /// What the material resists with; axial ones are those of a right-handed helix, and turn
    /// their sign with a left-handed one.
    pub coefficients: Coefficients,
    /// The angles of the cut.
    pub engagement: Engagement,
    /// Axial depth (m).
    pub depth: f64,
    /// Feed per tooth (m).
    pub feed_per_tooth: f64,
    /// Speed of the spindle (rad/s), where it is known.
    pub speed: Option<f64>,
}

impl Cut {
    /// The coefficients of the edges as they are inclined: chips flow along an inclined edge
    /// and drag it with them (Altintas, oblique cutting, where the axial coefficient has the
    /// sign of the inclination), so that a left-handed helix turns the axial force round.
    pub(crate) fn inclined(&self) -> Coefficients {
        let Coefficients { kac, kae, .. } = self.coefficients;
        let hand = if self.mill.helix < 0.0 { -1.0 } else { 1.0 };
        Coefficients { kac: hand * kac, kae: hand * kae, ..self.coefficients }
    }
}
