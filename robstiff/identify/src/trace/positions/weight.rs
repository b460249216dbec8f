//! Weight that the description does not know: links that are heavier than it says or have
//! their mass elsewhere, where it says nothing of masses all that hangs on a joint, a
//! compensator that lifts.
//!
//! What hangs on a joint turns its gear by the sine of the angle between the link and the
//! plumb line, and those before it as well. Of a shoulder behind an upright first axis that
//! is the sine of its own coordinate: a periodic error of order 1 is then the same, exactly,
//! under any payload. So weight is held against names like whatever has [none](super::nameless),
//! and is told beside those that it does as well.

use std::boxed::Box;
use std::format;
use std::rc::Rc;
use std::string::{String, ToString};
use std::vec;
use std::vec::Vec;

use nalgebra::{Point3, Vector3};
use robstiff_robots::Description;
use robstiff_robots::effect::Place as Part;
use robstiff_robots::effect::gravity_sag::GRAVITY;

use super::bench::{Bench, Model};
use super::frames::{Frames, frames};
use super::nameless::FOLLOWER;
use super::offers::{Form, Number, Offer, any};
use super::rig::Rig;
use crate::campaign::Positions;
use crate::identify::positions::model::{Enters, Moved, Seen};
use crate::trace::NamedEffect;
use crate::trace::catalogue::{Kind, MOST_SAG, place_words};
use crate::trace::model::all_but;
use robstiff::JointKind;

/// Something hangs on a joint.
pub static WEIGHT: Kind =
    Kind { name: "unknown_weight", words: |found| format!("unknown weight on {}", place_words(found)), ..FOLLOWER };

/// The name of the catalogue for what weight does.
pub const SAG: &str = "gravity_sag@robot";

/// No joint of an arm gives way to its weight by more (rad).
const MOST_TURNED: f64 = 2e-3;

/// What may hang on each joint that turns and yields: so much more of the mass that the
/// description says its link has, where that is, or anything anywhere on the link.
pub fn offers(robot: &Description, data: &Positions, rig: &Rig) -> Vec<Offer> {
    let joints = frames(robot, &data.rows);
    let hangs = |&link: &usize| robot.joints[link].kind == JointKind::Revolute && robot.joints[link].compliance() > 0.0;
    (0..robot.joints.len()).filter(hangs).map(|link| on(robot, rig, &joints, link)).collect()
}

/// What may hang on a joint, by the index of its link.
fn on(robot: &Description, rig: &Rig, joints: &[Frames], link: usize) -> Offer {
    let own = robot.joints[link].compliance();
    let anywhere = |name, moment: &dyn Fn(&Frames, usize) -> Vector3<f64>| Number {
        name,
        unit: "rad",
        range: [-MOST_TURNED, MOST_TURNED],
        enters: turned(robot, rig, joints, link, moment),
    };
    let across = |at: usize| {
        move |frames: &Frames, _: usize| {
            let x: Vector3<f64> = frames.links[link].column(0).xyz();
            [x, frames.axes[link].0.cross(&x)][at] / own
        }
    };
    let mut numbers = vec![anywhere("x", &across(0)), anywhere("y", &across(1))];
    let mut forms = vec![Form::of(0..2)];
    if let Some(declared) = robot.links.get(link).filter(|link| link.mass > 0.0) {
        let center = Point3::from(declared.center_of_mass);
        let weight = GRAVITY * declared.mass;
        let whole = move |frames: &Frames, joint: usize| {
            (frames.links[link].transform_point(&center).coords - frames.axes[joint].1) * weight
        };
        let enters = turned(robot, rig, joints, link, whole);
        numbers.push(Number { name: "share", unit: "1", range: [-1.0, MOST_SAG], enters });
        forms.push(Form::of([2]));
    }
    Offer { kind: &WEIGHT, place: Part::Joint(link + 1).into(), numbers, forms, possible: any() }
}

/// A unit hangs on a link with a first moment about each joint before it, in the base frame
/// (Nm): the joints turn by what they yield, which is little, so their turns add up.
fn turned(
    robot: &Description,
    rig: &Rig,
    joints: &[Frames],
    link: usize,
    moment: impl Fn(&Frames, usize) -> Vector3<f64>,
) -> Enters {
    let turns = |&joint: &usize| robot.joints[joint].kind == JointKind::Revolute;
    let of_row = |(frames, seen): (&Frames, &Seen)| -> Vector3<f64> {
        let by_joint = (0..=link).filter(turns).map(|joint| {
            let (axis, through) = frames.axes[joint];
            let torque = axis.dot(&moment(frames, joint).cross(&-Vector3::z()));
            axis.cross(&(seen.point - through)) * (robot.joints[joint].compliance() * torque)
        });
        by_joint.sum()
    };
    let rows = joints.iter().zip(&rig.seen).map(of_row).collect();
    // What has no name is never asked of what is read later.
    Enters::Reading(Rc::new(Moved { rows, later: Box::new(|_| Vector3::zeros()) }))
}

/// How weight is told from what it does as well; `None` where no effect is listed beside it.
pub fn how_to_tell(effects: &[NamedEffect]) -> Option<String> {
    let does = |named: &&NamedEffect| named.same_as.iter().any(|name| name == SAG);
    let names: Vec<String> = effects.iter().filter(does).map(|named| named.effect.to_string()).collect();
    (!names.is_empty()).then(|| {
        format!(
            "; weight that the description does not know (masses, a compensator) does the same as {}, which the torques \
             of the motors at rest would tell",
            names.join(" and ")
        )
    })
}

/// What weight in place of each effect of a model leaves (m^2), on the joint where that is least.
pub fn in_place(bench: &Bench<'_>, robot: &Description, model: &Model) -> Vec<Option<f64>> {
    if model.named.is_empty() {
        return Vec::new();
    }
    let first = bench.candidates.len();
    let (wide, model) = bench.clone().widened(model, offers(robot, bench.prepared.data, &bench.rig));
    let least = |k: usize| {
        let rest = all_but(&model.named, k);
        let with = (first..wide.candidates.len()).filter_map(|candidate| wide.with(&rest, candidate));
        with.map(|other| other.rss).min_by(f64::total_cmp)
    };
    (0..model.named.len()).map(least).collect()
}
