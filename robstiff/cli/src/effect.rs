//! Effects for people.

use robstiff_robots::Effect;

/// Name, value in SI, and unit of every number of an effect, named as
/// descriptions name them.
pub fn parameters(effect: &Effect) -> Vec<(&'static str, f64, &'static str)> {
    match *effect {
        Effect::TransverseCompliance { value, .. } | Effect::JointCoupling { value, .. } => {
            vec![("value", value, "rad/Nm")]
        }
        Effect::LinkCompliance { bending, torsion, .. } => {
            vec![("bending", bending, "rad/Nm"), ("torsion", torsion, "rad/Nm")]
        }
        Effect::BaseCompliance { tilt, translation } => {
            vec![("tilt", tilt, "rad/Nm"), ("translation", translation, "m/N")]
        }
        Effect::ToolCompliance { rotation, translation } => {
            vec![("rotation", rotation, "rad/Nm"), ("translation", translation, "m/N")]
        }
        Effect::StiffnessNonlinearity { added, knee, .. } => vec![("added", added, "rad/Nm"), ("knee", knee, "Nm")],
    }
}

/// What an effect is, for a sentence: "the tilt of joint 3 ..".
pub fn words(effect: &Effect) -> String {
    match *effect {
        Effect::TransverseCompliance { joint, .. } => {
            format!("the tilt of joint {joint} about the axes across its own (bearing, housing)")
        }
        Effect::LinkCompliance { link, bending, torsion } => {
            let motion = match (bending != 0.0, torsion != 0.0) {
                (true, false) => "bending",
                (false, true) => "torsion",
                _ => "bending and torsion",
            };
            format!("the {motion} of link {link}")
        }
        Effect::BaseCompliance { .. } => "the compliance of foundation and pedestal".to_owned(),
        Effect::ToolCompliance { .. } => "the compliance of flange, spindle and tool".to_owned(),
        Effect::JointCoupling { joints: [i, j], .. } => {
            format!("the coupling of joints {i} and {j} (belts, wrist gearing)")
        }
        Effect::StiffnessNonlinearity { joint, added, .. } => {
            let change = if added < 0.0 { "softening" } else { "hardening" };
            format!("the {change} of joint {joint} with torque")
        }
    }
}
