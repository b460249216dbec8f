//! The force of an end mill, by the mechanistic model with linear edge forces,
//! or as it was measured.
//!
//! Every tooth meets, per unit of axial depth, the forces
//! `Ft = Ktc h + Kte`, `Fr = Krc h + Kre`, `Fa = Kac h + Kae` (tangential,
//! radial, axial), where `h = c sin phi` is the thickness of the chip and `c` the
//! feed per tooth. After Altintas, Manufacturing Automation (Cambridge, 2nd ed.
//! 2012), chapter 2.
//!
//! # Signs
//! Every force here acts **on the tool**: it is what pushes the robot. Its
//! components are along three unit vectors ([`CutFrame`]):
//! - `feed`: where the tool moves, relative to the workpiece;
//! - `normal = feed x axis`: to the left of the feed, looked at from the spindle;
//! - `axis`: from the spindle to the tip of the tool, so that a positive force
//!   pulls the tool out of its holder, as right-handed helices do; left-handed ones
//!   push it in.
//!
//! The spindle turns clockwise looked at from the spindle (`M3`). The angle `phi`
//! of a tooth counts from the normal, that way; the tooth cuts between the angles
//! of an [`Engagement`], within 0 and pi. In up (conventional) milling the wall
//! is left of the tool, at +normal, in down (climb) milling right of it, at
//! -normal. For spindles that turn the other way, mirror the cut: the normal
//! component changes its sign, and a left-handed helix is a right-handed one.
//!
//! # Units
//! SI: m, rad, N, Pa, N/m, rad/s; the files ([`CutFile`]) take those of the
//! workshop.

mod coefficients;
mod cut;
mod dynoware;
mod engagement;
mod file;
pub mod fit;
mod force;
mod frame;
mod kienzle;
mod measured;
mod records;
mod revolution;
#[cfg(feature = "schema")]
pub mod schema;
#[cfg(test)]
mod tests;

pub use coefficients::{Coefficients, Material, materials};
pub use cut::{Cut, EndMill};
pub use engagement::{Direction, Engagement};
pub use file::{CutFile, Forces};
pub use force::{Range, Revolution};
pub use frame::CutFrame;
pub use kienzle::{Kienzle, KienzleMaterial, kienzle_materials};
pub use measured::{ForceFrame, MeasuredForce, Sample};
pub use records::{Recorded, Records};
