//! Effects for people.

use robstiff_robots::Effect;

/// Name, value in SI, and unit of every number of an effect, named as
/// descriptions name them.
pub fn parameters(effect: &Effect) -> Vec<(&'static str, f64, &'static str)> {
    let unit = |parameter: &robstiff_robots::effect::physics::Parameter| parameter.quantity.at(effect.place()).unit();
    effect.parameters().map(|(parameter, value)| (parameter.name, value, unit(parameter))).collect()
}

/// What an effect is, for a sentence: "the tilt of joint 3 ..".
pub fn words(effect: &Effect) -> String {
    effect.noun().to_string()
}
