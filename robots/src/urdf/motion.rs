//! How a joint of a URDF file moves: its axis and its limits.

use nalgebra::{Unit, Vector3};
use roxmltree::Node;

use super::read::{Reader, element};
use crate::quantity::Dimension;

/// As a limit (rad or m) a way to write that there is none: also in degrees or millimetres
/// no joint goes so far.
const NO_LIMIT: f64 = 1e5;

impl Reader<'_> {
    /// The axis of a joint that moves.
    pub(super) fn axis(&mut self, node: Node<'_, '_>) -> Option<Unit<Vector3<f64>>> {
        let Some(axis) = element(node, "axis") else {
            self.warn(node, &format!("{} has no `axis`: it is x, as URDF has it", joint(node)));
            return Some(Vector3::x_axis());
        };
        let direction = Vector3::from(self.numbers(axis, "xyz", Dimension::Number)?);
        // Of any length, also of one whose square is too large.
        let direction = direction / direction.amax().max(1.0);
        let unit = Unit::try_new(direction, 1e-9);
        if unit.is_none() {
            self.report(&axis.range(), "the axis has no direction", "e.g. `<axis xyz=\"0 0 1\"/>`");
        }
        unit
    }

    /// The limits of a joint that has any.
    pub(super) fn limits(&mut self, node: Node<'_, '_>, kind: Option<&str>) -> Option<[f64; 2]> {
        let limit = element(node, "limit").filter(|_| matches!(kind, Some("revolute" | "prismatic")))?;
        let dimension = if kind == Some("prismatic") { Dimension::Length } else { Dimension::Angle };
        if let [Some(missing), None] | [None, Some(missing)] =
            ["lower", "upper"].map(|name| (!limit.has_attribute(name)).then_some(name))
        {
            self.warn(limit, &format!("the limit of {} has no `{missing}`: it is 0, as URDF has it", joint(node)));
        }
        let mut end = |name: &str| {
            let Some(word) = limit.attribute(name) else { return Some(0.0) };
            if word.trim().parse::<f64>().is_ok_and(|value| value.abs() >= NO_LIMIT) {
                let place = limit.attribute_node(name).map_or(limit.range(), |attribute| attribute.range_value());
                let help = match dimension {
                    Dimension::Angle => "leave `limit` out, or make it a joint of type `continuous`",
                    _ => "leave `limit` out where there is none",
                };
                self.report(&place, &format!("`{}` is no limit of a joint", word.trim()), help);
                return None;
            }
            self.numbers(limit, name, dimension).map(|[value]| value)
        };
        let (low, high) = (end("lower"), end("upper"));
        let (low, high) = (low?, high?);
        if low > high {
            self.report(&limit.range(), "the lower limit is above the upper", "write the smaller one as `lower`");
            return None;
        }
        // Both zero or left out is how generators write that there is none.
        if low == high && low != 0.0 {
            self.report(&limit.range(), "a joint between these limits cannot move", "make it a joint of type `fixed`");
        }
        (low < high).then_some([low, high])
    }
}

/// A joint by its name.
fn joint(node: Node<'_, '_>) -> String {
    format!("the joint `{}`", node.attribute("name").unwrap_or_default())
}
