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
