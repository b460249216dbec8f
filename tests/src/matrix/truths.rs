//! What numbers should come out, where the told model has the numbers that were
//! hidden.
//!
//! - A model that leaves out a number that was hidden, a link's torsion beside its
//!   bending, has others in its place; so does one with fewer play operators, or of
//!   other radii. Their values are those of another model. Then neither the joints are compared nor the numbers of
//!   that effect nor, where it is the operators that are fewer, anything of that
//!   joint. A soft base and a soft tool share one translation.
//! - A drift moves a reading by how much warmer it was than at the unloaded one, hours before: a file says when the
//!   former was taken, and the numbers of a trace are of that. A trace has another law of time for creep.
//! - A load cell of which all axes read too much by the same factor is the same as
//!   softer joints, so a trace tells the scale of two axes against the third, and
//!   all loads and compliances as that one has them.
//! - Faults of a load cell act one after the other, in the simulator in the order
//!   they were drawn in, in tracing always in the same. Of several, no number is
//!   compared.

use crate::judge_tracing::{Name, Told};
use crate::simulator::Hidden;

/// What numbers should come out.
#[derive(Clone, Debug, PartialEq)]
pub struct Truths {
    /// By full name of what is hidden, its numbers by theirs.
    pub effects: Vec<(String, Vec<(String, f64)>)>,
    /// The joints' compliances; none where they cannot be compared.
    pub joints: Option<Vec<f64>>,
}

impl Truths {
    /// What should come out of a campaign that hides these, on joints of these
    /// compliances (rad/Nm), where a trace told what it told.
    pub fn of(told: &Told, hidden: &[Hidden], joints: Vec<f64>) -> Self {
        let named = |hidden: &Hidden| told.names.iter().find(|named| named.name == hidden.name());
        let cells = hidden.iter().filter(|hidden| hidden.name().starts_with("load_cell")).count();
        let common = hidden.iter().find_map(|one| common_scale(one, named(one)?)).unwrap_or(1.0);
        let others: Vec<String> =
            hidden.iter().filter(|one| !same_operators(one, named(one))).map(Hidden::place).collect();
        let mut effects = Vec::new();
        let mut whole = cells < 2;
        for one in hidden {
            let (name, Some(told)) = (one.name(), named(one)) else { continue };
            whole &= tells_all(one, told) && same_operators(one, Some(told)) && same_radii(one, told);
            let is_another = others.contains(&one.place())
                || !tells_all(one, told)
                || !same_radii(one, told)
                // A trace has the growth over a factor of e, and what drifted between a reading and the unloaded one.
                || matches!(one, Hidden::Creep { .. } | Hidden::ThermalDrift { .. });
            if is_another || (cells > 1 && name.starts_with("load_cell")) {
                continue;
            }
            let as_told = |(number, value): (String, f64)| {
                let unit = told.parameters.iter().find(|told| told.name == number).map_or("", |told| told.unit);
                let value = match unit {
                    _ if matches!(one, Hidden::LoadCellScale { .. }) => (1.0 + value) / common - 1.0,
                    "rad/Nm" | "m/N" => value * common,
                    "Nm" | "N" => value / common,
                    _ => value,
                };
                (number, value)
            };
            let translates = |name: &str| hidden.iter().any(|hidden| hidden.name() == name);
            let shared = translates("base_compliance@base") && translates("tool_compliance@tool");
            let own = one.parameters().into_iter().filter(|(number, _)| !(shared && number == "translation"));
            effects.push((name, own.map(as_told).collect()));
        }
        let joints = whole.then(|| joints.into_iter().map(|compliance| compliance * common).collect());
        Self { effects, joints }
    }
}

/// Whether a name has all numbers of what is hidden; of a load cell's scale, two
/// of three.
fn tells_all(hidden: &Hidden, told: &Name) -> bool {
    let tells = |name: &str| told.parameters.iter().any(|number| number.name == name);
    let missing = hidden.parameters().iter().filter(|(name, value)| *value != 0.0 && !tells(name)).count();
    missing <= usize::from(matches!(hidden, Hidden::LoadCellScale { .. }))
}

/// Whether a name has as many play operators as are hidden, if it is one that has
/// any.
fn same_operators(hidden: &Hidden, told: Option<&Name>) -> bool {
    let Hidden::Hysteresis { operators, .. } = hidden else { return true };
    let of = |told: &Name| told.parameters.iter().filter(|number| number.name.starts_with("weight")).count();
    told.is_some_and(|told| of(told) == operators.len())
}

/// Whether play operators are told with the radii that they have: weights of others are other numbers.
fn same_radii(hidden: &Hidden, told: &Name) -> bool {
    let is_radius = |(name, _): &(String, f64)| name.starts_with("radius");
    hidden.parameters().iter().filter(|one| is_radius(one)).all(|(name, radius)| {
        let told = told.parameters.iter().find(|number| number.name == *name);
        told.is_some_and(|number| (number.value / radius - 1.0).abs() < SAME_RADIUS)
    })
}

/// Radii that differ by less than this part are the same.
const SAME_RADIUS: f64 = 0.05;

/// The factor of the load cell's axes that are not told to be off.
fn common_scale(hidden: &Hidden, told: &Name) -> Option<f64> {
    let Hidden::LoadCellScale { scale, .. } = hidden else { return None };
    let axes = ["sx", "sy", "sz"].iter().zip(scale);
    let kept: Vec<f64> =
        axes.filter(|(name, _)| told.parameters.iter().all(|number| number.name != **name)).map(|(_, s)| *s).collect();
    Some(1.0 + kept.iter().sum::<f64>() / kept.len().max(1) as f64)
}

#[cfg(test)]
mod tests {
    use robstiff_identify::trace::Verdict;
    use robstiff_robots::Effect;

    use super::*;
    use crate::judge_tracing::Number;
    use crate::simulator::Mount;

    fn told(names: &[(&Hidden, &[(&str, &'static str)])]) -> Told {
        let number = |&(name, unit): &(&str, &'static str)| Number { name: name.into(), value: 1.0, std: None, unit };
        let name = |&(hidden, numbers): &(&Hidden, &[(&str, &'static str)])| Name {
            name: hidden.name(),
            same_as: Vec::new(),
            parameters: numbers.iter().map(number).collect(),
        };
        Told { verdict: Verdict::Explained, names: names.iter().map(name).collect(), joints: Vec::new() }
    }

    #[test]
    fn scales_are_told_against_the_axis_that_is_not() {
        let scale = Hidden::LoadCellScale { scale: [0.1, -0.1, 0.25], mount: Mount::Ground };
        let tilt: Hidden = Effect::TransverseCompliance { joint: 2, value: 2e-7 }.into();
        let told = told(&[(&scale, &[("sx", "1"), ("sy", "1")]), (&tilt, &[("h", "rad/Nm")])]);
        let truths = Truths::of(&told, &[scale, tilt], vec![1e-6]);
        let near = |value: f64, expected: f64| (value / expected - 1.0).abs() < 1e-12;
        assert!(matches!(truths.joints.as_deref(), Some(&[joint]) if near(joint, 1.25e-6)), "{truths:?}");
        let of = |effect: usize, number: usize| truths.effects[effect].1[number].1;
        assert!(near(of(0, 0), 1.1 / 1.25 - 1.0) && near(of(0, 1), 0.9 / 1.25 - 1.0), "{truths:?}");
        assert!(near(of(1, 0), 2.5e-7), "{truths:?}");
    }

    #[test]
    fn numbers_of_another_model_are_not_compared() {
        let beam: Hidden = Effect::LinkCompliance { link: 2, bending: 1e-7, torsion: 1e-7 }.into();
        let play = Hidden::Hysteresis { joint: 1, operators: vec![(10.0, 1e-7), (30.0, 1e-7)] };
        let both: &[(&str, &'static str)] = &[("bending", "rad/Nm"), ("torsion", "rad/Nm")];
        let of = |numbers| Truths::of(&told(&[(&beam, numbers)]), std::slice::from_ref(&beam), vec![1e-6]);
        assert!(of(both).joints.is_some() && of(&both[..1]).joints.is_none());
        let told = told(&[(&beam, both), (&play, &[("weight1", "rad/Nm"), ("radius1", "Nm")])]);
        let truths = Truths::of(&told, &[beam, play], vec![1e-6]);
        assert!(truths.joints.is_none() && truths.effects.len() == 1);
    }
}
