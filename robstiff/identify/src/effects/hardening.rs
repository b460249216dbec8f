//! Without a name: a mount, a bearing or a tool that yields less and less as its load grows.

use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side, near_found};
use crate::model::spring::{ACROSS, EACH, Site, Spring};
use crate::model::{Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "hardening",
    side: Side::Unnamed,
    words: |place, _| format!("{} that yields less and less as its load grows, or is loose", place.words()),
    explanation: "Nothing in the catalogue is like this: a mat, a bearing without preload, a worn flange or taper. Check its \
        bolts and its seat.",
    offer,
};

/// Knees that are tried, over the largest load. What lies far below the first is loose.
const KNEES: [f64; 2] = [0.03, 0.25];

/// The likely part of the compliance of the first joints that it yields by under small loads, and what it comes to
/// under the largest, over theirs.
const LIKELY: f64 = 0.5;
const COMES_TO: f64 = 0.2;

/// What shifts does so by as much as it turns at this lever (1/m^2).
const SHIFTS: f64 = 1.0 / 3.0;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if !scene.has_loads() {
        return;
    }
    let form = |place: Part, (label, unit): (&str, &'static str), likely: f64, springs: &[Spring]| -> Vec<Form> {
        let of = |knee: f64| {
            let size = Size::Of(likely * LIKELY.max(COMES_TO / knee));
            let term = |spring: &Spring| Term::Hardening(spring.clone(), knee);
            let each = springs.iter().zip(NAMES);
            let each = each.map(|(spring, name)| Parameter::new(name, unit, size, term(spring)).nonnegative());
            let axes = if springs.len() == 1 { format!(" {:?}", springs[0]) } else { String::new() };
            Form::new(format!("{label}{axes}, knee {knee}"), each.collect()).with(KNEE, knee, "1")
        };
        let between = near_found(scene, KNEE, place, of);
        KNEES.into_iter().map(of).chain(between).collect()
    };
    let turns = ("turns", "rad/Nm");
    let mut tilt = |place, likely, site| {
        offers.add(place, form(place, turns, likely, &[Spring::Turn(site, ACROSS)]));
    };
    tilt(Part::Base, scene.middle, Site::Base);
    scene.joints().for_each(|joint| tilt(Part::Joint(joint), scene.likely(joint), Site::Joint(joint)));
    let mut tool = Vec::new();
    for (slides, of, likely) in [(true, ("shifts", "m/N"), SHIFTS * scene.middle), (false, turns, scene.middle)] {
        let each =
            EACH.map(|axes| if slides { Spring::Shift(Site::Flange, axes) } else { Spring::Turn(Site::Flange, axes) });
        tool.extend(each.chunks(1).chain([&each[..]]).flat_map(|springs| form(Part::Tool, of, likely, springs)));
    }
    offers.add(Part::Tool, tool);
}

/// The knee over the largest load.
const KNEE: &str = "knee_over_largest";

/// The names of the numbers.
const NAMES: [&str; 3] = ["x", "y", "z"];
