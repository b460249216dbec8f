//! What may be missing from a model of absolute positions: the catalogue, as it
//! shows there.
//!
//! An effect of the robot enters the description itself, so what is fitted is what is
//! written. Compliances show under payloads only. Faults of the [`Rig`] move what is
//! read, or the point that is read; a turn or shift of the frame is none, for where
//! the robot stands in it is fitted with everything.

use std::rc::Rc;
use std::vec;
use std::vec::Vec;

use robstiff_robots::Description;
use robstiff_robots::effect::Place as Part;

use super::rig::{Rig, lever_arm, reflector};
use crate::campaign::{Campaign, Positions};
use crate::identify::normal::Sign;
use crate::identify::positions::model::{ANGLE_STEP, COMPLIANCE_STEP, Enters, LENGTH_STEP, Model, SHARE_STEP};
use crate::identify::setup::coordinate_entry;
use crate::trace::catalogue::{
    BASE_COMPLIANCE, DH_ENTRIES, DH_ERROR, DH_MOST, DH_UNITS, EITHER, GRAVITY_SAG, HARDENING_KNEES, JOINT_COUPLING,
    JOINT_ZERO_OFFSET, Kind, LARGEST_WAVE, LINK_COMPLIANCE, LOST_KNEES, LOST_MOTION, MOST_SAG,
    POSE_DEPENDENT_COMPLIANCE, STIFFNESS_NONLINEARITY, STRAY_COUPLING, TOOL_COMPLIANCE, TRANSMISSION_ERROR,
    TRANSVERSE_COMPLIANCE, WAVE_ORDERS, WIDEST_GAP, ZERO_MOST, drives, without_drive,
};
use crate::trace::found::{EffectParameter, Found, Place};
use robstiff::{Effect, JointKind};

/// Steps of central differences of entries of a table that are angles and lengths.
const STEPS: [f64; 2] = [ANGLE_STEP, LENGTH_STEP];

/// Knees of gears that are looked for, as fractions of the largest torque that they carry.
const NARROWEST_KNEE: f64 = 1.0 / 256.0;
const WIDEST_KNEE: f64 = 4.0;

/// A number of an effect.
#[derive(Clone)]
pub struct Number {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The values that are physically possible, exclusive.
    pub range: [f64; 2],
    /// What a unit of it does.
    pub enters: Enters,
}

impl Number {
    /// Which values a fit may give it.
    pub fn sign(&self) -> Sign {
        if self.range[0] >= 0.0 { Sign::Nonnegative } else { Sign::Free }
    }
}

/// A form of an effect: some of its numbers, by index, and what it says besides.
pub struct Form {
    /// The numbers.
    pub numbers: Vec<usize>,
    /// Numbers out of a grid.
    pub shape: Vec<EffectParameter>,
    /// What it says besides that is no number to be found.
    pub marks: Vec<EffectParameter>,
    /// What the one of these may be between those of the grid, if anything.
    pub between: Option<Between>,
}

/// What a number out of a grid may be between those of the grid: the knee of a gear's
/// law, the time constant of what settles.
#[derive(Clone)]
pub struct Between {
    /// The values that are possible.
    pub range: [f64; 2],
    /// What values are parts of: the largest torque, the time that the campaign took.
    pub whole: f64,
    /// How the numbers of the form enter with another value.
    pub enters: Rc<dyn Fn(f64) -> Vec<Enters>>,
}

impl Form {
    /// Some numbers alone.
    pub fn of(numbers: impl IntoIterator<Item = usize>) -> Self {
        Self { numbers: numbers.into_iter().collect(), shape: vec![], marks: vec![], between: None }
    }
}

/// An effect that may be missing, with its forms.
pub struct Offer {
    /// The kind.
    pub kind: &'static Kind,
    /// Where it is.
    pub place: Place,
    /// Its numbers.
    pub numbers: Vec<Number>,
    /// Its forms.
    pub forms: Vec<Form>,
    /// Whether the numbers of a form are possible together.
    pub possible: Possible,
}

/// Whether numbers are possible together, on joints of some compliances (rad/Nm or m/N),
/// by the joint.
pub type Possible = Rc<dyn Fn(&[f64], &dyn Fn(usize) -> f64) -> bool>;

/// Where it is enough that each number is possible.
pub fn any() -> Possible {
    Rc::new(|_, _| true)
}

/// Everything that may be missing, in the order of the catalogue.
pub fn offers(campaign: &Campaign, data: &Positions, rig: &Rig) -> Vec<Offer> {
    let robot = &campaign.robot;
    let joints = 1..=robot.joints.len();
    let turns = |joint: &usize| robot.joints[joint - 1].kind == JointKind::Revolute;
    let mut all = vec![];
    let loaded = data.rows.iter().any(|row| row.payload > 0.0);
    all.extend(rig.drift(data));
    all.extend(loaded.then(lever_arm));
    all.push(rig.scale());
    all.push(reflector());
    all.extend(rig.slip_of_reflector(data));
    all.extend(rig.slip_of_base(data));
    if loaded {
        all.push(springs(&TOOL_COMPLIANCE, Part::Tool, &[("rotation", "rad/Nm"), ("translation", "m/N")]));
        all.push(springs(&BASE_COMPLIANCE, Part::Base, &[("tilt", "rad/Nm"), ("translation", "m/N")]));
        all.extend(joints.clone().map(|joint| springs(&TRANSVERSE_COMPLIANCE, Part::Joint(joint), &[("h", "rad/Nm")])));
        let links = (1..robot.joints.len()).filter(|&link| !robot.is_stroke(link));
        all.extend(
            links.map(|link| {
                springs(&LINK_COMPLIANCE, Part::Link(link), &[("bending", "rad/Nm"), ("torsion", "rad/Nm")])
            }),
        );
        all.extend(couplings(robot));
        all.extend(gears(robot, data));
    }
    all.extend(joints.clone().map(|joint| zero(robot, joint)));
    all.extend(joints.clone().flat_map(|row| table(robot, row)));
    all.extend(joints.filter(turns).map(waves));
    all.extend(robot.links.iter().any(|link| link.mass > 0.0).then(sag));
    let declared = |offer: &Offer| {
        let own = Found::new(offer.kind, offer.place, vec![]).effect_on(robot);
        own.is_some_and(|own| robot.effects.iter().any(|effect| effect.is_same(&own)))
    };
    all.retain(|offer| !declared(offer));
    all
}

/// How a number of an effect enters the description, the others being zero but those
/// given.
fn of_effect(kind: &'static Kind, part: Part, at: usize, others: Vec<f64>, step: f64) -> Enters {
    let enters = move |model: &mut Model, by: f64| {
        let mut numbers = others.clone();
        numbers[at] = by;
        let effect =
            Effect::of_kind(kind.name, part, &numbers).expect("an effect of the catalogue with all its numbers");
        model.description.effects.push(effect);
    };
    Enters::Model(Rc::new(enters), step)
}

/// An effect with one number in the description.
fn one(kind: &'static Kind, part: Part, number: (&'static str, &'static str), range: [f64; 2], step: f64) -> Offer {
    let enters = of_effect(kind, part, 0, vec![0.0], step);
    let numbers = vec![Number { name: number.0, unit: number.1, range, enters }];
    Offer { kind, place: part.into(), numbers, forms: vec![Form::of([0])], possible: any() }
}

/// An elastic part with one or two compliances, of which one or both can be there.
fn springs(kind: &'static Kind, part: Part, numbers: &[(&'static str, &'static str)]) -> Offer {
    let of = |(at, &(number, unit)): (usize, &(&'static str, &'static str))| {
        let enters = of_effect(kind, part, at, vec![0.0; numbers.len()], COMPLIANCE_STEP);
        Number { name: number, unit, range: [0.0, f64::INFINITY], enters }
    };
    let forms: &[&[usize]] = if numbers.len() == 1 { &[&[0]] } else { &[&[0], &[1], &[0, 1]] };
    Offer {
        kind,
        place: part.into(),
        numbers: numbers.iter().enumerate().map(of).collect(),
        forms: forms.iter().map(|numbers| Form::of(numbers.iter().copied())).collect(),
        possible: any(),
    }
}

fn couplings(robot: &Description) -> Vec<Offer> {
    drives(robot).into_iter().map(|pair| coupling(&JOINT_COUPLING, pair)).collect()
}

/// A coupling of two joints. Which are possible, they are together.
fn coupling(kind: &'static Kind, pair: [usize; 2]) -> Offer {
    let part = Part::Joints(pair);
    let any = [f64::NEG_INFINITY, f64::INFINITY];
    Offer { kind, ..one(&JOINT_COUPLING, part, ("value", "rad/Nm"), any, COMPLIANCE_STEP) }
}

/// Couplings of joints that share no drive, which have no name.
pub fn stray_couplings(robot: &Description, data: &Positions) -> Vec<Offer> {
    let loaded = data.rows.iter().any(|row| row.payload > 0.0);
    let pairs = if loaded { without_drive(robot) } else { vec![] };
    let declared = |pair: &[usize; 2]| {
        robot.effects.iter().any(|effect| JOINT_COUPLING.is_of(effect) && effect.place() == Part::Joints(*pair))
    };
    pairs.into_iter().filter(|pair| !declared(pair)).map(|pair| coupling(&STRAY_COUPLING, pair)).collect()
}

/// Gears that give way other than in proportion to what a payload loads them with, the
/// knee one of several parts of the largest torque that they carry; or not alike at all angles.
fn gears(robot: &Description, data: &Positions) -> Vec<Offer> {
    let torques = Model::new(robot, data).torques(data);
    let largest = |joint: usize| torques.iter().map(|row| row[joint - 1].whole().abs()).fold(0.0, f64::max);
    let heaviest = torques.iter().flatten().map(|torque| torque.load.abs()).fold(0.0, f64::max);
    let law = |kind: &'static Kind, joint: usize, number: &'static str, range: [f64; 2], knees: &[f64], widest: f64| {
        let revolute = robot.joints[joint - 1].kind == JointKind::Revolute;
        let (turn, torque) = if revolute { ("rad", "Nm") } else { ("m", "N") };
        let (unit, step) = match number {
            "gap" => (turn, ANGLE_STEP),
            _ if revolute => ("rad/Nm", COMPLIANCE_STEP),
            _ => ("m/N", COMPLIANCE_STEP),
        };
        let largest = largest(joint);
        let knees: Vec<f64> = knees.iter().map(|part| part * largest).collect();
        let enters = move |knee| of_effect(kind, Part::Joint(joint), 0, vec![0.0, knee], step);
        let number = |&knee: &f64| Number { name: number, unit, range, enters: enters(knee) };
        let range_of_knee = [NARROWEST_KNEE * largest, widest * largest];
        let between = Between { range: range_of_knee, whole: largest, enters: Rc::new(move |knee| vec![enters(knee)]) };
        let form = |(k, &value): (usize, &f64)| Form {
            shape: vec![EffectParameter { name: "knee", value, std: None, unit: torque }],
            between: Some(between.clone()),
            ..Form::of([k])
        };
        let place = Part::Joint(joint).into();
        let (numbers, forms) = (knees.iter().map(number).collect(), knees.iter().enumerate().map(form).collect());
        // The unloaded joint keeps some compliance.
        let possible: Possible = match kind == &STIFFNESS_NONLINEARITY {
            true => Rc::new(move |added, of| added[0] > -of(joint)),
            false => any(),
        };
        Offer { kind, place, numbers, forms, possible }
    };
    // What a payload does not load but by rounding has no law to show.
    let is_loaded = |joint: &usize| torques.iter().any(|row| row[joint - 1].load.abs() > 1e-9 * heaviest);
    let loaded: Vec<usize> = (1..=robot.joints.len()).filter(is_loaded).collect();
    let hardening = |&joint: &usize| {
        let range = [f64::NEG_INFINITY, f64::INFINITY];
        law(&STIFFNESS_NONLINEARITY, joint, "added", range, &HARDENING_KNEES, WIDEST_KNEE)
    };
    let lost = |&joint: &usize| law(&LOST_MOTION, joint, "gap", [0.0, WIDEST_GAP], &LOST_KNEES, EITHER[1]);
    let varies = |&&joint: &&usize| robot.joints[joint - 1].kind == JointKind::Revolute;
    let varying = loaded.iter().filter(varies).map(|&joint| varying(joint));
    loaded.iter().map(hardening).chain(loaded.iter().map(lost)).chain(varying).collect()
}

/// A compliance that varies with the joint's own angle, once or twice a turn or both.
fn varying(joint: usize) -> Offer {
    let number = |(at, number): (usize, &'static str)| Number {
        name: number,
        unit: "1",
        range: [-1.0, 1.0],
        enters: of_effect(&POSE_DEPENDENT_COMPLIANCE, Part::Joint(joint), at, vec![0.0; 4], SHARE_STEP),
    };
    Offer {
        kind: &POSE_DEPENDENT_COMPLIANCE,
        place: Part::Joint(joint).into(),
        numbers: ["cos1", "sin1", "cos2", "sin2"].into_iter().enumerate().map(number).collect(),
        forms: [0..2, 2..4, 0..4].map(Form::of).into(),
        // Something of the compliance is left at every angle.
        possible: Rc::new(|waves, _| waves.chunks(2).map(|wave| wave[0].hypot(wave[1])).sum::<f64>() < 1.0),
    }
}

/// A zero that is off: of a joint that slides by a length, which no description takes as
/// one.
fn zero(robot: &Description, joint: usize) -> Offer {
    let entry = coordinate_entry(robot.joints[joint - 1].kind);
    let (most, unit) = (ZERO_MOST[entry], ["rad", "m"][entry]);
    let mut offer = one(&JOINT_ZERO_OFFSET, Part::Joint(joint), ("offset", unit), [-most, most], STEPS[entry]);
    if robot.joints[joint - 1].kind == JointKind::Prismatic {
        let slides = move |model: &mut Model, by: f64| model.description.joints[joint - 1].d += by;
        offer.numbers[0].enters = Enters::Model(Rc::new(slides), LENGTH_STEP);
    }
    offer
}

/// The entries of a row of the DH table but the one that the joint's coordinate adds
/// to.
fn table(robot: &Description, row: usize) -> Vec<Offer> {
    let coordinate = coordinate_entry(robot.joints[row - 1].kind);
    let error = |entry: usize| {
        let (most, unit) = (DH_MOST[entry], DH_UNITS[entry]);
        let step = STEPS[usize::from(unit == "m")];
        one(&DH_ERROR, Part::Entry(DH_ENTRIES[entry](row)), ("value", unit), [-most, most], step)
    };
    (0..4).filter(|&entry| entry != coordinate).map(error).collect()
}

/// A periodic error of a joint, of one of several orders.
fn waves(joint: usize) -> Offer {
    let number = |(order, at, name_of): (f64, usize, &'static str)| Number {
        name: name_of,
        unit: "rad",
        range: [-LARGEST_WAVE, LARGEST_WAVE],
        enters: of_effect(&TRANSMISSION_ERROR, Part::Joint(joint), at, vec![order, 0.0, 0.0], ANGLE_STEP),
    };
    let form = |(k, &value): (usize, &f64)| Form {
        shape: vec![EffectParameter { name: "order", value, std: None, unit: "1" }],
        ..Form::of([2 * k, 2 * k + 1])
    };
    Offer {
        kind: &TRANSMISSION_ERROR,
        place: Part::Joint(joint).into(),
        numbers: WAVE_ORDERS.iter().flat_map(|&order| [(order, 2, "cos"), (order, 1, "sin")]).map(number).collect(),
        forms: WAVE_ORDERS.iter().enumerate().map(form).collect(),
        possible: any(),
    }
}

fn sag() -> Offer {
    one(&GRAVITY_SAG, Part::Robot, ("share", "1"), [0.0, MOST_SAG], SHARE_STEP)
}
