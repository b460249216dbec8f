//! The numbers of a description that joints and effects have, as named symbols.

use robstiff_robots::effect::physics;
use robstiff_robots::{Description, Effect, Joint, Place};

use crate::angle::Angle;
use crate::graph::{Graph, Sym};

/// Says in the code that what follows is of an effect.
pub fn remark(g: &Graph, effect: &Effect) {
    g.remark(format!("Of {}.", effect.noun()));
}

/// The joints' own compliance (rad/Nm or m/N).
pub fn joint_compliances<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    let joint = |(i, joint): (usize, &Joint)| {
        let unit = joint.kind.compliance().unit();
        g.named_number(&format!("H{i}"), joint.compliance(), &format!("Compliance of joint {i} ({unit})."))
    };
    (1..).zip(&robot.joints).map(joint).collect()
}

/// Sine and cosine of whole multiples of a joint's coordinate.
pub fn harmonic<'g>(g: &'g Graph, joint: usize) -> impl Fn(f64) -> (Sym<'g>, Sym<'g>) {
    move |order| g.sin_cos(&Angle::multiple(joint, order as i32))
}

/// The numbers of an effect under the names that generated code gives them.
pub fn parameters<'g>(g: &'g Graph, effect: &Effect) -> Vec<Sym<'g>> {
    let place = effect.place();
    let suffix = match place {
        Place::Joint(number) | Place::Link(number) => number.to_string(),
        Place::Joints([i, j]) => format!("{i}_{j}"),
        Place::Entry(entry) => format!("_{}", entry.to_string().to_uppercase()),
        Place::Base | Place::Tool | Place::Robot => String::new(),
    };
    let named = |(parameter, value): (&physics::Parameter, f64)| {
        let unit = match parameter.quantity.at(place).unit() {
            "" => String::new(),
            unit => format!(" ({unit})"),
        };
        g.named_number(
            &format!("{}{suffix}", parameter.symbol),
            value,
            &format!("{} of {}{unit}.", parameter.what, place.words()),
        )
    };
    effect.parameters().map(named).collect()
}
