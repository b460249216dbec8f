//! Effects for people.

use robstiff_robots::{Description, Effect};

/// Name, value in SI, and unit of every number of an effect, named as
/// descriptions name them.
pub fn parameters(effect: &Effect) -> Vec<(&'static str, f64, &'static str)> {
    let unit = |parameter: &robstiff_robots::effect::physics::Parameter| parameter.quantity.at(effect.place()).unit();
    effect.parameters().map(|(parameter, value)| (parameter.name, value, unit(parameter))).collect()
}

/// What compliances are of, where an arm is another under a load than without: it has gears with
/// backlash or hysteresis, or that harden.
pub fn unloaded(robot: &Description) -> Option<&'static str> {
    let bends = |effect: &Effect| {
        matches!(effect, Effect::LostMotion { .. } | Effect::StiffnessNonlinearity { .. } | Effect::Hysteresis { .. })
    };
    robot
        .effects
        .iter()
        .any(bends)
        .then_some("for small forces on the unloaded arm: under a load its gears yield otherwise")
}

/// What an effect is, for a sentence: "the tilt of joint 3 ..".
pub fn words(effect: &Effect) -> String {
    effect.noun().to_string()
}
