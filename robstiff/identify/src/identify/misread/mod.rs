//! Whether a file was written otherwise than it is read.
//!
//! Two columns that are exchanged, a sign, a frame, an angle in another unit: a fit to such data
//! is worth nothing, and among effects of an arm one is found that looks a little like it. A
//! mistake is told by what undoing it does: it takes no number, and then the joints alone, each with
//! a compliance that is not negative, leave far less of the readings than the best model did.
//! Mistakes are made one at a time here; of two, none is found.
//!
//! Which mistakes there are, [`mistakes`] says.

mod axes;
mod displacements;
mod mistakes;
mod positions;

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

pub use self::displacements::in_displacements;
use self::mistakes::Mistake;
pub use self::positions::{apart, from_middle, in_positions};
use super::{Identification, NoiseSource};
use crate::campaign::{Campaign, Data};
use crate::words::micrometres;

/// A mistake leaves at most so much of what the best model leaves, by squares: none of an arm
/// that lacks something the catalogue has no name for comes near it by chance.
pub const FAR_LESS: f64 = 0.25;

/// What is left of one mistake is told from what is left of another by this factor, by squares.
pub const ALIKE: f64 = 1.5;

/// So many mistakes that do alike are reported.
const MOST_TOLD: usize = 3;

/// Rows that are looked at: more say no more of a mistake.
const ROWS: usize = 1000;

/// A fit that leaves no more than so many times the noise, where that is known otherwise, is not one
/// to files that say something else.
const NOISE: f64 = 3.0;

/// What files may have been written with.
pub struct Misread {
    /// The mistakes, each as the files have it; one of them was made.
    pub mistakes: Vec<String>,
    /// What is left where it is undone (m), the root mean square of one axis.
    pub left: f64,
}

/// What is the matter where the files of a campaign say something else than what was measured: that
/// with one mistake undone far less is left than `found` leaves.
pub fn misread(campaign: &Campaign, found: &Identification) -> Option<Misread> {
    let rms = found.rms?;
    let is_known = |source: NoiseSource| source != NoiseSource::Residuals;
    if found.noise.is_some_and(|(noise, source)| is_known(source) && rms <= NOISE * noise) {
        return None;
    }
    match &campaign.data {
        Data::Displacement(data) if !data.is_whole() => None,
        Data::Displacement(data) => {
            in_displacements(&campaign.robot, data, |row| !found.left_out.contains(&data.rows[row].line), rms, FAR_LESS)
        }
        Data::Position(data) => in_positions(&campaign.robot, data, rms),
        Data::Clamped(_) => None,
    }
}

impl Misread {
    /// What is the matter, in a sentence, where as the files are `rms` is left (m).
    pub fn sentence(&self, rms: f64) -> String {
        format!(
            "The files may say something else than what was measured: {}, and as the files are {} stay unaccounted for.",
            self.said(),
            micrometres(rms)
        )
    }

    /// Which mistakes may have been made, and what is left with that undone.
    pub fn said(&self) -> String {
        format!("{}; with that undone {} are left", self.mistakes.join(", or "), micrometres(self.left))
    }

    /// The mistakes that leave at most a share where they are undone and about as little as that
    /// which leaves least; `None` where there is none.
    fn likely(all: Vec<Mistake>, left: impl Fn(&Mistake) -> Option<Left>, most: f64) -> Option<Self> {
        let mut tried: Vec<(Left, Mistake)> =
            all.into_iter().filter_map(|mistake| Some((left(&mistake)?, mistake))).collect();
        tried.sort_by(|a, b| a.0.share().total_cmp(&b.0.share()));
        let least = tried.first()?.0;
        tried.retain(|(left, _)| left.share() <= most.min(ALIKE * least.share()));
        let told = tried.iter().take(MOST_TOLD).map(|(_, mistake)| mistake.to_string());
        let more = (tried.len() > MOST_TOLD).then(|| String::from("one of some more mistakes that do alike"));
        let mistakes: Vec<String> = told.chain(more).collect();
        (!mistakes.is_empty()).then(|| Self { mistakes, left: least.rms() })
    }
}

/// What is left of what is read.
#[derive(Clone, Copy)]
struct Left {
    /// The sum of squares that is left (m^2).
    squares: f64,
    /// That of what was read, of positions from their middle (m^2).
    read: f64,
    /// How many rows there are.
    rows: usize,
}

impl Left {
    /// The share of what was read that is left, by squares.
    fn share(&self) -> f64 {
        self.squares / self.read
    }

    /// The root mean square of one axis (m).
    fn rms(&self) -> f64 {
        (self.squares / (3 * self.rows) as f64).sqrt()
    }
}
