//! Without a name: a joint that goes on turning under a load that stays on.

use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side, near_found};
use crate::model::law::turns_on;
use crate::model::{Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "lagging",
    side: Side::Unnamed,
    words: |place, _| format!("{} that goes on turning under a load that stays on", place.words()),
    explanation: "Nothing in the catalogue is like this: grease, seals or a belt that give way slowly. Wait the same time \
        before each reading, and write the time into the file.",
    offer,
};

/// The likely part of the joint's compliance that comes late.
const LIKELY: f64 = 0.3;

/// Times that are tried by which most of it has come (s).
const CONSTANTS: [f64; 3] = [5.0, 40.0, 320.0];

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if !scene.has_loads() || scene.visits >= scene.visit.len() {
        return;
    }
    for joint in scene.turning().into_iter().filter(|&joint| scene.is_driven(joint)) {
        let share = |grows: Box<dyn Fn(f64) -> f64>| {
            let term = Term::Law(joint, turns_on(scene.compliance[joint - 1], grows));
            vec![Parameter::new("share", "1", Size::Of(LIKELY), term).nonnegative()]
        };
        // A spring and a dashpot side by side (Kelvin, Voigt): it comes to an end. Creep does not.
        let ends = |constant: f64| {
            let share = share(Box::new(move |since| -(-since / constant).exp_m1()));
            Form::new(format!("within {constant} s"), share).with("constant", constant, "s")
        };
        let goes_on = Form::new("by the logarithm of time", share(Box::new(f64::ln_1p)));
        let between = near_found(scene, "constant", Part::Joint(joint), ends);
        let forms = CONSTANTS.into_iter().map(ends).chain([goes_on]).chain(between);
        offers.add(Part::Joint(joint), forms.map(|form| form.share_of(joint)).collect());
    }
}
