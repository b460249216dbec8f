//! What kinds offer: candidates with their forms, and the catalogue that they
//! make together.

use std::rc::Rc;
use std::string::String;
use std::vec::Vec;

use nalgebra::DVector;

use super::{Check, KINDS, Kind, MORE_THAN_NONE, NAMELESS, Number, Refine, Scene, TOOL_FRAME, Unsure};
use crate::trace::found::{EffectParameter, Place};
use crate::trace::point::Point;
use crate::trace::slip::Slipping;
use robstiff::Effect;

/// One way a candidate can be there.
#[derive(Clone)]
pub struct Variant {
    /// The columns in the problem.
    pub columns: Vec<usize>,
    /// How many numbers it takes, those out of a grid counting each as one.
    pub parameters: usize,
    /// The numbers out of a grid.
    pub shape: Vec<EffectParameter>,
    /// Names of the numbers where they are not those of the columns.
    pub names: &'static [&'static str],
    /// Its numbers between the values of the grid, where there is a between; a
    /// column then has one number out of the grid, its own.
    pub refine: Option<Refine>,
    /// Where such numbers go by this name.
    pub within: [f64; 2],
    /// What such a number is likely to be, before any data, and by what factor
    /// off, in logarithms; where data may say nothing of it.
    pub likely: Option<[f64; 2]>,
    /// What the readings may have besides that no column says, given the numbers.
    pub unsure: Option<Unsure>,
    /// Whether it is only there where the data do not show the forms with more numbers.
    pub in_place_of_more: bool,
}

impl Variant {
    /// One with these columns and numbers out of a grid, of which nothing more is known.
    pub fn new(columns: Vec<usize>, shape: Vec<EffectParameter>) -> Self {
        Self {
            parameters: columns.len() + shape.len(),
            columns,
            shape,
            names: &[],
            refine: None,
            within: [0.0, f64::INFINITY],
            likely: None,
            unsure: None,
            in_place_of_more: false,
        }
    }
}

/// An effect that may be missing.
#[derive(Clone)]
pub struct Candidate {
    /// The kind.
    pub kind: &'static Kind,
    /// Where it is.
    pub place: Place,
    /// The forms it can have.
    pub variants: Vec<Variant>,
    /// What physics asks beyond the ranges of its numbers.
    pub check: Option<Check>,
}

impl Candidate {
    /// What slips by it, if anything does.
    pub fn slipping(&self) -> Option<Slipping> {
        Slipping::of(self.kind)
    }

    /// The full name, `kind@at`.
    pub fn name(&self) -> String {
        std::format!("{}@{}", self.kind.name, self.place)
    }

    /// Whether it is no effect of the catalogue, and only held against those that are.
    pub fn is_nameless(&self) -> bool {
        NAMELESS.contains(&self.kind)
    }
}

/// What may be missing from a description.
pub struct Catalogue {
    /// The candidates.
    pub candidates: Vec<Candidate>,
    /// Their numbers; the columns of variants count from the description's own.
    pub numbers: Vec<Number>,
    /// Full names of what these data cannot show at all.
    pub invisible: Vec<String>,
}

/// A catalogue in the making.
pub struct Offers<'s> {
    kind: &'static Kind,
    declared: &'s [Effect],
    first: usize,
    catalogue: Catalogue,
}

/// A form of a candidate: some of its numbers, with those out of a grid.
#[derive(Clone)]
pub struct Form {
    /// Which of the numbers.
    pub numbers: Vec<usize>,
    /// The numbers out of a grid.
    pub shape: Vec<EffectParameter>,
    /// What it says besides that is no number to be found.
    pub marks: Vec<EffectParameter>,
    /// Names of the numbers where they are not their own.
    pub names: &'static [&'static str],
    /// Its numbers between the values of the grid, where there is a between.
    pub refine: Option<Refine>,
    /// Where such numbers go by this name.
    pub within: [f64; 2],
    /// What such a number is likely to be.
    pub likely: Option<[f64; 2]>,
    /// What the readings may have besides that no column says, given the numbers.
    pub unsure: Option<Unsure>,
    /// Whether it is only there where the data do not show the forms with more numbers.
    pub in_place_of_more: bool,
}

impl Form {
    /// Some of the numbers.
    pub fn of(numbers: impl IntoIterator<Item = usize>) -> Self {
        Self {
            numbers: numbers.into_iter().collect(),
            shape: Vec::new(),
            marks: Vec::new(),
            names: &[],
            refine: None,
            within: MORE_THAN_NONE,
            likely: None,
            unsure: None,
            in_place_of_more: false,
        }
    }

    /// The same, only there where the data do not show the forms with more numbers.
    pub fn in_place_of_more(mut self) -> Self {
        self.in_place_of_more = true;
        self
    }

    /// The same with a number out of a grid.
    pub fn with(mut self, name: &'static str, value: f64, unit: &'static str) -> Self {
        self.shape.push(EffectParameter { name, value, std: None, unit });
        self
    }

    /// The same with what its numbers are between the values of the grid.
    pub fn refined(mut self, refine: impl Fn(&[f64]) -> Vec<Number> + 'static) -> Self {
        self.refine = Some(Rc::new(refine));
        self
    }

    /// The same with numbers between the values of the grid that go by this
    /// name within bounds only.
    pub fn within(mut self, bounds: [f64; 2]) -> Self {
        self.within = bounds;
        self
    }

    /// The same with numbers between the values of the grid that are likely to be
    /// this, up or down by a factor whose logarithm is `spread`.
    pub fn likely(mut self, middle: f64, spread: f64) -> Self {
        self.likely = Some([middle, spread]);
        self
    }

    /// The same where readings may have something besides that no column says:
    /// examples of it, all as likely, given the numbers.
    pub fn unsure(mut self, of: impl Fn(&Point<'_>, &[f64]) -> Vec<DVector<f64>> + 'static) -> Self {
        self.unsure = Some(Rc::new(of));
        self
    }

    /// The same with its vector given in the tool frame, not in the base frame.
    pub fn in_tool(mut self) -> Self {
        self.marks.push(EffectParameter { name: TOOL_FRAME, value: 1.0, std: None, unit: "1" });
        self
    }
}

impl Offers<'_> {
    /// A candidate, unless the description declares it and fits it again: what it declares of the
    /// kinematics is offered as a change.
    pub fn add(&mut self, place: impl Into<Place>, numbers: Vec<Number>, forms: Vec<Form>) {
        self.add_checked(place, numbers, forms, None);
    }

    /// A candidate with what physics asks of it.
    pub fn add_checked(
        &mut self,
        place: impl Into<Place>,
        numbers: Vec<Number>,
        forms: Vec<Form>,
        check: Option<Check>,
    ) {
        let place = place.into();
        let same = |effect: &Effect| self.kind.is_of(effect) && place == Place::Part(effect.place());
        if self.declared.iter().any(|effect| same(effect) && !is_offered_as_change(effect)) {
            return;
        }
        let start = self.first + self.catalogue.numbers.len();
        let variant = |form: Form| Variant {
            columns: form.numbers.iter().map(|k| start + k).collect(),
            parameters: form.numbers.len() + form.shape.len(),
            shape: form.shape.into_iter().chain(form.marks).collect(),
            names: form.names,
            refine: form.refine,
            within: form.within,
            likely: form.likely,
            unsure: form.unsure,
            in_place_of_more: form.in_place_of_more,
        };
        let variants = forms.into_iter().map(variant).collect();
        self.catalogue.numbers.extend(numbers);
        self.catalogue.candidates.push(Candidate { kind: self.kind, place, variants, check });
    }

    /// Something that these data cannot show.
    pub fn invisible(&mut self, place: impl Into<Place>) {
        self.catalogue.invisible.push(std::format!("{}@{}", self.kind.name, place.into()));
    }
}

/// Whether a candidate may change a declared effect, whose numbers no column of the description
/// fits: errors of the kinematics add up.
pub fn is_offered_as_change(effect: &Effect) -> bool {
    matches!(effect, Effect::JointZeroOffset { .. } | Effect::DhError { .. } | Effect::TransmissionError { .. })
}

/// What may be missing from a scene's description; its columns follow `first`
/// columns of the description's own. If `wide`, with what has no name behind all that has.
pub fn catalogue(scene: &Scene<'_>, first: usize, wide: bool) -> Catalogue {
    let catalogue = Catalogue { candidates: Vec::new(), numbers: Vec::new(), invisible: Vec::new() };
    let mut offers = Offers { kind: KINDS[0], declared: &scene.description.effects, first, catalogue };
    let nameless: &[&Kind] = if wide { &NAMELESS } else { &[] };
    for &kind in KINDS.iter().chain(nameless) {
        offers.kind = kind;
        (kind.offer)(scene, &mut offers);
    }
    offers.catalogue
}
