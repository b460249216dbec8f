//! Flange, spindle and tool: a turn and a displacement at the flange frame's
//! origin, the same in every direction, `h s s^T` for three axes each.

use super::{Kind, Offers, Part, Scene, two_compliances};
use robstiff::elements::Spring;

/// The kind.
pub static KIND: Kind = Kind {
    name: "tool_compliance",
    of_rig: false,
    words: |_| "the compliance of flange, spindle and tool".into(),
    explanation: "",
    offer,
    on_axes: None,
};

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let two = [("rotation", Spring::ToolRotation), ("translation", Spring::ToolTranslation)];
    two_compliances(scene, offers, Part::Tool, two);
}
