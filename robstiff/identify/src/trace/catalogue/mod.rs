//! The catalogue: every effect at every place it can be, one kind a file.
//!
//! A kind says where it can be, which numbers it takes and what a unit of each
//! does to the readings, and in which forms it can be there: a link that bends
//! but does not twist, a knee out of a grid. A candidate is a kind at a place,
//! with the best of its forms.
//!
//! The rig's kinds come first, and of exact aliases the first is named. What is
//! taken for a fault of the rig is left out of the description, which is then
//! no worse than before; what is taken for an effect of the robot is written
//! into it, and makes every prediction wrong. A wrong name costs less on that
//! side. Among the robot's, those with fewer parts come first: a translation
//! common to all poses is sooner the tool's than the base's, a tilt of the
//! foundation sooner that than joint 1's bearing, and one compliance at a joint
//! is simpler than a beam.

mod base_compliance;
mod base_slip;
mod creep;
mod dh_error;
mod gravity_preload;
mod gravity_sag;
mod hysteresis;
mod joint_coupling;
mod joint_zero_offset;
mod lever_arm;
mod link_compliance;
mod load_cell_bias;
mod load_cell_misalignment;
mod load_cell_scale;
mod lost_motion;
mod nameless;
mod offers;
mod outliers;
mod places;
mod pose_dependent_compliance;
mod reflector_offset;
mod reflector_slip;
mod stiffness_nonlinearity;
mod thermal_drift;
mod tool_compliance;
mod tracker_misalignment;
mod tracker_scale;
mod transmission_error;
mod transverse_compliance;

use std::rc::Rc;
use std::string::String;
use std::vec;
use std::vec::Vec;

use nalgebra::{DVector, Matrix3};
use robstiff_robots::effect::Place as Part;
use robstiff_robots::{Description, JointKind};

pub use self::base_compliance::KIND as BASE_COMPLIANCE;
pub use self::base_slip::{KIND as BASE_SLIP, LIKELY};
pub use self::creep::KIND as CREEP;
pub use self::dh_error::{ENTRIES as DH_ENTRIES, KIND as DH_ERROR, MOST as DH_MOST, UNITS as DH_UNITS};
pub use self::gravity_preload::KIND as GRAVITY_PRELOAD;
pub use self::gravity_sag::{KIND as GRAVITY_SAG, MOST as MOST_SAG};
pub use self::hysteresis::{KIND as HYSTERESIS, is_told as tells_hysteresis, is_told_on as axis_tells_hysteresis};
pub use self::joint_coupling::{KIND as JOINT_COUPLING, drives, without_drive};
pub use self::joint_zero_offset::{KIND as JOINT_ZERO_OFFSET, MOST as ZERO_MOST};
pub use self::lever_arm::KIND as LEVER_ARM;
pub use self::link_compliance::KIND as LINK_COMPLIANCE;
pub use self::load_cell_bias::KIND as LOAD_CELL_BIAS;
pub use self::lost_motion::{EITHER, KIND as LOST_MOTION, KNEES as LOST_KNEES, WIDEST as WIDEST_GAP};
pub use self::nameless::{LAG, NAMELESS, STRAY_COUPLING};
pub use self::offers::{Candidate, Catalogue, Form, Offers, Variant, catalogue, is_offered_as_change};
pub use self::outliers::KIND as OUTLIERS;
pub use self::pose_dependent_compliance::KIND as POSE_DEPENDENT_COMPLIANCE;
pub use self::reflector_offset::KIND as REFLECTOR_OFFSET;
pub use self::reflector_slip::KIND as REFLECTOR_SLIP;
pub use self::stiffness_nonlinearity::{KIND as STIFFNESS_NONLINEARITY, KNEES as HARDENING_KNEES};
pub use self::thermal_drift::KIND as THERMAL_DRIFT;
pub use self::tool_compliance::KIND as TOOL_COMPLIANCE;
pub use self::tracker_scale::KIND as TRACKER_SCALE;
pub use self::transmission_error::{KIND as TRANSMISSION_ERROR, MOST as LARGEST_WAVE, ORDERS as WAVE_ORDERS};
pub use self::transverse_compliance::KIND as TRANSVERSE_COMPLIANCE;
use super::clamped::{Axes, OnAxes};
use super::found::{Found, Place};
use super::point::Point;
use super::slip::{Moment, Moments};
use crate::campaign::Displacements;
use crate::identify::column::Column;
use crate::identify::normal::Sign;
use crate::identify::samples::{Samples, turn_of};
use crate::identify::setup::Setup;
use crate::identify::unit_of;
use robstiff::Effect;
use robstiff::elements::Spring;

/// A kind of effect.
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    /// Whether it is a fault of the measurement and no effect of the robot.
    pub of_rig: bool,
    /// What it is, as a noun for a sentence: "the tilt of joint 3 ..".
    pub words: fn(&Found) -> String,
    /// What causes it and what one does about it; empty where descriptions take
    /// the effect, whose catalogue says it.
    pub explanation: &'static str,
    /// Adds its candidates.
    pub offer: fn(&Scene<'_>, &mut Offers<'_>),
    /// What it does to axes that are loaded one by one, those before clamped;
    /// none where such readings cannot show it.
    pub on_axes: Option<fn(&Axes) -> Vec<OnAxes>>,
}

impl Kind {
    /// Whether an effect that a description has is of this kind.
    pub fn is_of(&self, effect: &Effect) -> bool {
        effect.kind() == self.name
    }
}

impl PartialEq for Kind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl core::fmt::Debug for Kind {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name)
    }
}

/// Every kind, in the order of precedence among exact aliases. What is wrong
/// with single rows (`outliers`) has no columns: it is found row by row.
pub static KINDS: [&Kind; 25] = [
    &thermal_drift::KIND,
    &creep::KIND,
    &load_cell_bias::KIND,
    &load_cell_scale::KIND,
    &load_cell_misalignment::KIND,
    &lever_arm::KIND,
    &tracker_misalignment::KIND,
    &tracker_scale::KIND,
    &reflector_offset::KIND,
    &outliers::KIND,
    &base_slip::KIND,
    &reflector_slip::KIND,
    &tool_compliance::KIND,
    &base_compliance::KIND,
    &transverse_compliance::KIND,
    &link_compliance::KIND,
    &joint_coupling::KIND,
    &stiffness_nonlinearity::KIND,
    &lost_motion::KIND,
    &hysteresis::KIND,
    &pose_dependent_compliance::KIND,
    &joint_zero_offset::KIND,
    &dh_error::KIND,
    &transmission_error::KIND,
    &gravity_sag::KIND,
];

/// The campaign that candidates are looked for in.
pub struct Scene<'c> {
    /// The description as declared.
    pub description: &'c Description,
    /// The rows of the table.
    pub data: &'c Displacements,
    /// The rows on the robot as declared.
    pub samples: &'c Samples,
    /// The compliance of each joint (rad/Nm or m/N), identified, from 0.
    pub compliance: Vec<f64>,
    /// When something may have slipped.
    pub moments: &'c Moments,
    /// Whether what is read may be elsewhere on the tool.
    pub elsewhere: bool,
}

impl Scene<'_> {
    /// The number of joints.
    pub fn joints(&self) -> usize {
        self.samples.joints()
    }

    /// Whether a joint (from 1) turns.
    pub fn turns(&self, joint: usize) -> bool {
        self.samples.joint_kinds[joint - 1] == JointKind::Revolute
    }

    /// The largest torque on a joint (from 1), without sign; none where no row
    /// loads it.
    pub fn largest_torque(&self, joint: usize) -> Option<f64> {
        let largest = self.samples.torques(joint).into_iter().map(f64::abs).fold(0.0, f64::max);
        // Below this share of what the load could do it is rounding.
        let possible = self.samples.rows.iter().map(|row| row.wrench.norm()).fold(0.0, f64::max);
        (largest > 1e-9 * possible).then_some(largest)
    }

    /// The largest torque that the gear of a joint (from 1) carries under the loads, without
    /// sign, what weighs on it included; none where no row loads it.
    pub fn largest_carried(&self, joint: usize) -> Option<f64> {
        self.largest_torque(joint)?;
        Some(self.samples.rows.iter().map(|row| row.torque(joint).whole().abs()).fold(0.0, f64::max))
    }

    /// The line of the first row after a slip, or of the last row.
    pub fn line(&self, moment: Moment) -> f64 {
        self.data.rows[moment.row.min(self.data.rows.len() - 1)].line as f64
    }

    /// The unit of a compliance of a joint (from 1).
    pub fn compliance_unit(&self, joint: usize) -> &'static str {
        if self.turns(joint) { "rad/Nm" } else { "m/N" }
    }

    /// The turn of the tool in the base frame as declared, by row.
    pub fn tools(&self) -> Vec<Matrix3<f64>> {
        self.samples.rows.iter().map(|row| turn_of(&row.tcp)).collect()
    }
}

/// What a unit of a number does to the readings, stacked.
type Regressor = Rc<dyn Fn(&Point<'_>) -> DVector<f64>>;

/// How a number enters the forward model.
pub type Enters = Rc<dyn Fn(&mut Setup, f64)>;

/// What physics says against numbers, each with its name, given the compliance
/// of each joint (from 1).
type Check = Rc<dyn Fn(&[(&str, f64)], &dyn Fn(usize) -> f64) -> Result<(), String>>;

/// The numbers of a form with other values of those out of its grid.
pub type Refine = Rc<dyn Fn(&[f64]) -> Vec<Number>>;

/// Examples of what readings may have besides what the numbers of a form say.
pub type Unsure = Rc<dyn Fn(&Point<'_>, &[f64]) -> Vec<DVector<f64>>>;

/// A number of a candidate.
#[derive(Clone)]
pub struct Number {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The values that are physically possible, exclusive.
    pub range: [f64; 2],
    /// What a unit of it does to the readings, at a point.
    pub regressor: Regressor,
    /// How it enters the forward model, where it does so other than linearly.
    pub enters: Option<Enters>,
    /// The spring whose compliance it is, where it is one that holds for every load.
    pub spring: Option<Spring>,
    /// Whether it is elastic: it moves the arm, and is seen as the arm is.
    pub elastic: bool,
    /// Whether what it does creeps with the arm.
    pub creeps: bool,
    /// The joint (from 1) of whose compliance it is told as a share.
    pub share_of: Option<usize>,
}

impl Number {
    /// A number in which the readings are linear, the arm moving by it.
    pub fn elastic(
        name: &'static str,
        unit: &'static str,
        range: [f64; 2],
        of: impl Fn(&Point<'_>) -> DVector<f64> + 'static,
    ) -> Self {
        Self {
            name,
            unit,
            range,
            regressor: Rc::new(of),
            enters: None,
            spring: None,
            elastic: true,
            creeps: true,
            share_of: None,
        }
    }

    /// A number that adds to the readings, whatever the arm does.
    pub fn of_reading(
        name: &'static str,
        unit: &'static str,
        range: [f64; 2],
        of: impl Fn(&Point<'_>) -> DVector<f64> + 'static,
    ) -> Self {
        Self { elastic: false, creeps: false, ..Self::elastic(name, unit, range, of) }
    }

    /// The compliance of a spring.
    fn compliance(scene: &Scene<'_>, name: &'static str, range: [f64; 2], spring: Spring) -> Self {
        let column = Column::Spring(spring);
        let unit = unit_of(scene.description, column);
        let of = move |point: &Point<'_>| point.samples.column(column);
        Self { spring: Some(spring), ..Self::elastic(name, unit, range, of) }
    }

    /// A number of the setup.
    pub fn of_setup(
        name: &'static str,
        unit: &'static str,
        most: f64,
        enters: impl Fn(&mut Setup, f64) + 'static,
        of: impl Fn(&Point<'_>, &Enters) -> DVector<f64> + 'static,
    ) -> Self {
        let enters: Enters = Rc::new(enters);
        let own = Rc::clone(&enters);
        let number = Self::elastic(name, unit, [-most, most], move |point| of(point, &own));
        Self { enters: Some(enters), elastic: false, ..number }
    }

    /// What a unit of it does to the readings at a point, stacked.
    pub fn column(&self, point: &Point<'_>) -> DVector<f64> {
        let column = (self.regressor)(point);
        if self.creeps { point.with_creep(column) } else { column }
    }

    /// Which values a fit may give it.
    pub fn sign(&self) -> Sign {
        if self.range[0] >= 0.0 { Sign::Nonnegative } else { Sign::Free }
    }
}

/// Step of central differences of a wrench, in the number's own unit: rotations
/// are the only ones not linear.
pub const WRENCH_STEP: f64 = 1e-4;

/// A candidate with one compliance.
fn one_compliance(scene: &Scene<'_>, offers: &mut Offers<'_>, place: Part, name: &'static str, spring: Spring) {
    let number = Number::compliance(scene, name, MORE_THAN_NONE, spring);
    offers.add(place, vec![number], vec![Form::of([0])]);
}

/// A candidate with two compliances, of which one or both can be there.
fn two_compliances(scene: &Scene<'_>, offers: &mut Offers<'_>, place: Part, two: [(&'static str, Spring); 2]) {
    let number = |(name, spring)| Number::compliance(scene, name, MORE_THAN_NONE, spring);
    let forms = vec![Form::of([0]), Form::of([1]), Form::of([0, 1])];
    offers.add(place, two.into_iter().map(number).collect(), forms);
}

/// The range of a compliance.
const MORE_THAN_NONE: [f64; 2] = [0.0, f64::INFINITY];

/// The names of three components: of a point, a shift, a turn.
pub const POINT: [&str; 3] = ["x", "y", "z"];
pub const SHIFT: [&str; 3] = ["dx", "dy", "dz"];
pub const TURN: [&str; 3] = ["rx", "ry", "rz"];

/// The mark of components in the tool frame.
const TOOL_FRAME: &str = "tool_frame";

/// In which frame something is constant.
fn frame_words(found: &Found) -> &'static str {
    if found.value(TOOL_FRAME) == 1.0 { "tool frame" } else { "base frame" }
}

/// `joint 3`, `the base`: a place in a sentence.
pub fn place_words(found: &Found) -> String {
    match found.place() {
        Place::Part(entry @ Part::Entry(_)) => std::format!("{entry}"),
        Place::Part(part) => std::format!("{}", part.words()),
        place => std::format!("the {place}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_explained_once() {
        for kind in KINDS {
            let found = Found::new(kind, Place::Rig, Vec::new());
            assert!(found.explanation().ends_with('.'), "{}", kind.name);
            let described = robstiff_robots::effect::CATALOGUE.iter().any(|about| about.kind == kind.name);
            assert_eq!(kind.explanation.is_empty(), described, "{}", kind.name);
        }
    }
}
