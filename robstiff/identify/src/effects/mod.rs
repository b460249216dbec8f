//! What a description or a file may lack: one kind a file, all in the registry.
//!
//! A *kind* says at which places of a scene it can be, in which *forms*, and which parameters each
//! form has. A *candidate* is a kind at a place; it is there in one of its forms or not at all. All
//! candidates are there from the start. Those without a name in a description are candidates like
//! all others: where one of them wins, no name is given, and the report says what it looks like.

mod approach;
mod base_compliance;
mod base_slip;
mod creep;
mod depends_on_other;
mod dh_error;
mod encoder_scale;
mod gravity_sag;
mod grows_with_load;
mod grows_with_place;
mod hardening;
mod harmonics;
mod hysteresis;
mod joint_coupling;
mod joint_zero_offset;
mod kinematic_coupling;
mod lagging;
mod lever_arm;
mod link_compliance;
mod load_cell_bias;
mod load_cell_misalignment;
mod load_cell_scale;
mod load_friction;
mod lost_motion;
mod outliers;
mod own_weight;
mod own_weight_tilt;
mod pose_dependent_compliance;
mod quadratic;
mod reflector_offset;
mod reflector_slip;
mod scene;
mod stiffness_nonlinearity;
mod thermal_drift;
mod tool_compliance;
mod tracker_misalignment;
mod tracker_scale;
mod transmission_error;
mod transverse_compliance;
mod unloaded_reading;
mod wandering;

use core::fmt;
use std::rc::Rc;

use robstiff::Effect;
use robstiff_robots::Place as Part;

pub use outliers::KIND as OUTLIERS;
pub use scene::{Scene, Shapes, What};

use crate::model::law::under_weight;
use crate::model::{Parameter, Size, Term};

/// Every kind there is.
pub static REGISTRY: [&Kind; 40] = [
    &thermal_drift::KIND,
    &creep::KIND,
    &load_cell_bias::KIND,
    &load_cell_scale::KIND,
    &load_cell_misalignment::KIND,
    &lever_arm::KIND,
    &tracker_misalignment::KIND,
    &tracker_scale::KIND,
    &reflector_offset::KIND,
    &base_slip::KIND,
    &reflector_slip::KIND,
    &unloaded_reading::KIND,
    &outliers::KIND,
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
    &gravity_sag::KIND,
    &own_weight::KIND,
    &own_weight_tilt::KIND,
    &transmission_error::KIND,
    &encoder_scale::KIND,
    &kinematic_coupling::KIND,
    &approach::KIND,
    &harmonics::KIND,
    &grows_with_load::KIND,
    &load_friction::KIND,
    &grows_with_place::KIND,
    &quadratic::KIND,
    &depends_on_other::KIND,
    &lagging::KIND,
    &hardening::KIND,
    &wandering::KIND,
];

/// A kind of effect.
pub struct Kind {
    /// Its name, as in `kind@at`.
    pub name: &'static str,
    /// Whose it is.
    pub side: Side,
    /// What it is, as a noun for a sentence, given where it is and its numbers.
    pub words: fn(&Place, &[Number]) -> String,
    /// What causes it and what one does about it, in full sentences; empty where descriptions take
    /// the effect, whose catalogue says it.
    pub explanation: &'static str,
    /// Adds its candidates.
    pub offer: fn(&Scene<'_>, &mut Offers),
}

/// Whose an effect is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The robot's; a description has a word for it.
    Robot,
    /// A fault of the measurement: corrected for, and never written into the robot.
    Rig,
    /// It has no name in a description.
    Unnamed,
}

impl PartialEq for Kind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl fmt::Debug for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// Where an effect is; displays as `kind@at` spells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A part of the robot.
    Part(Part),
    /// The measurement.
    Rig,
}

impl From<Part> for Place {
    fn from(part: Part) -> Self {
        Self::Part(part)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Part(part) => part.fmt(f),
            Self::Rig => f.write_str("rig"),
        }
    }
}

impl Place {
    /// `joint 3`, `the base`: the place in a sentence.
    pub fn words(&self) -> String {
        match self {
            Self::Part(entry @ Part::Entry(_)) => entry.to_string(),
            Self::Part(part) => part.words().to_string(),
            Self::Rig => "the measurement".into(),
        }
    }
}

/// A number of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// One standard deviation; none of what was chosen and not fitted, as a line or an order.
    pub std: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
}

/// A form in which a candidate can be there.
#[derive(Clone)]
pub struct Form {
    /// What tells it from the candidate's other forms.
    pub label: String,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Its numbers that are chosen and not fitted, such as a knee.
    pub shape: Vec<Number>,
    /// What it is in a description, given the values of the parameters.
    pub written: Option<Written>,
    /// Whether it lies between others of a grid, and counts as one with them.
    pub between: bool,
    /// Full names of effects that do exactly the same, and are no candidates of their own therefore.
    pub same: Vec<&'static str>,
    /// The joint (from 1) of whose likely compliance the parameters are shares.
    pub share_of: Option<usize>,
}

/// Forms near what was found of a number that is chosen: they count as one with those of a grid.
fn near_found(
    scene: &Scene<'_>,
    number: &'static str,
    place: impl Into<Place>,
    form: impl Fn(f64) -> Form,
) -> Vec<Form> {
    scene.found(number, place).into_iter().map(|found| Form { between: true, ..form(found) }).collect()
}

/// Forms of laws of a gear, each about the load alone and, where gears may carry a weight, about all of that.
fn about_weight(scene: &Scene<'_>, mut forms: Vec<Form>) -> Vec<Form> {
    if scene.may_preload() {
        let preloaded: Vec<Form> = forms.iter().map(Form::preloaded).collect();
        forms.extend(preloaded);
    }
    forms
}

/// What values make of a description: the effects that go into it.
pub type Written = Rc<dyn Fn(&[f64]) -> Vec<Effect>>;

impl fmt::Debug for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.label, self.parameters.len())
    }
}

impl Form {
    /// A form with these parameters.
    pub fn new(label: impl Into<String>, parameters: Vec<Parameter>) -> Self {
        Self {
            label: label.into(),
            parameters,
            shape: Vec::new(),
            written: None,
            between: false,
            same: Vec::new(),
            share_of: None,
        }
    }

    /// The same, which a description writes so.
    #[must_use]
    pub fn written(mut self, of: impl Fn(&[f64]) -> Vec<Effect> + 'static) -> Self {
        self.written = Some(Rc::new(of));
        self
    }

    /// The same, which does exactly what an effect of another name does.
    #[must_use]
    pub fn same_as(mut self, name: &'static str) -> Self {
        self.same.push(name);
        self
    }

    /// The same with parameters that are shares of the likely compliance of a joint (from 1): a report has them of what
    /// was fitted.
    #[must_use]
    pub fn share_of(mut self, joint: usize) -> Self {
        self.share_of = Some(joint);
        self
    }

    /// The same with laws about all that a gear carries: a description declares the preload beside them.
    fn preloaded(&self) -> Self {
        let carried = |parameter: &Parameter| match &parameter.term {
            Term::Law(joint, law) => {
                Parameter { term: Term::Law(*joint, under_weight(law.clone())), ..parameter.clone() }
            }
            _ => parameter.clone(),
        };
        let of_law = self.written.clone();
        let written = move |values: &[f64]| {
            let mut effects = of_law.as_ref().map_or_else(Vec::new, |written| written(values));
            if !effects.is_empty() {
                effects.push(Effect::GravityPreload { share: 1.0 });
            }
            effects
        };
        let form = Self {
            label: format!("{}, under weight", self.label),
            parameters: self.parameters.iter().map(carried).collect(),
            ..self.clone()
        };
        form.with("preload", 1.0, "1").written(written)
    }

    /// The same with a number that is chosen.
    #[must_use]
    pub fn with(mut self, name: &'static str, value: f64, unit: &'static str) -> Self {
        self.shape.push(Number { name, value, std: None, unit });
        self
    }
}

/// A kind at a place.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The kind.
    pub kind: &'static Kind,
    /// Where it is.
    pub place: Place,
    /// Its forms.
    pub forms: Vec<Form>,
}

impl Candidate {
    /// Its full name, `kind@at`.
    pub fn name(&self) -> String {
        format!("{}@{}", self.kind.name, self.place)
    }
}

/// Collects candidates.
pub struct Offers {
    kind: &'static Kind,
    /// What was offered.
    pub candidates: Vec<Candidate>,
    /// The full names of what the description declares.
    declared: Vec<String>,
}

impl Offers {
    /// All candidates of a scene.
    pub fn of(scene: &Scene<'_>) -> Vec<Candidate> {
        let declared = scene.robot.effects.iter().filter(|effect| !effect.is_kinematic()).map(ToString::to_string);
        let mut offers = Self { kind: REGISTRY[0], candidates: Vec::new(), declared: declared.collect() };
        for kind in REGISTRY {
            offers.kind = kind;
            (kind.offer)(scene, &mut offers);
        }
        offers.candidates
    }

    /// Adds a candidate, if it has any form. What the description declares is fitted anyway; errors of
    /// the kinematics add up with what it declares.
    pub fn add(&mut self, place: impl Into<Place>, forms: Vec<Form>) {
        let candidate = Candidate { kind: self.kind, place: place.into(), forms };
        if !candidate.forms.is_empty() && !self.declared.contains(&candidate.name()) {
            self.candidates.push(candidate);
        }
    }
}

/// A kind of the registry by its name.
pub fn kind_of(name: &str) -> Option<&'static Kind> {
    REGISTRY.into_iter().find(|kind| kind.name == name)
}

/// The names of three components: of a point, a shift, a turn.
const POINT: [&str; 3] = ["x", "y", "z"];
const SHIFT: [&str; 3] = ["dx", "dy", "dz"];
const TURN: [&str; 3] = ["rx", "ry", "rz"];

/// Three numbers of the world, likely to be of one size.
fn three(
    names: [&'static str; 3],
    unit: &'static str,
    size: f64,
    changes: fn(&mut crate::model::World, usize, f64),
) -> Vec<Parameter> {
    let one = |k: usize| Parameter::of_world(names[k], unit, size, move |world, by| changes(world, k, by));
    (0..3).map(one).collect()
}

/// Three shifts of what is read, by what a row has of it.
fn three_readings(
    names: [&'static str; 3],
    unit: &'static str,
    size: f64,
    share: impl Fn(&crate::model::At<'_>) -> f64 + Clone + 'static,
) -> Vec<Parameter> {
    let one = |k: usize| {
        let share = share.clone();
        let of = move |at: &crate::model::At<'_>| nalgebra::Vector3::ith(k, share(at));
        Parameter::new(names[k], unit, Size::Of(size), Term::Reading(Rc::new(of)))
    };
    (0..3).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_there_once_and_explained() {
        for (k, kind) in REGISTRY.iter().enumerate() {
            assert!(REGISTRY[..k].iter().all(|other| other.name != kind.name), "{}", kind.name);
            let described = robstiff_robots::effect::CATALOGUE.iter().any(|about| about.kind == kind.name);
            assert_eq!(kind.explanation.is_empty(), described, "{}", kind.name);
        }
    }
}
