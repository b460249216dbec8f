//! What a material resists a cutting edge with.

use robstiff_robots::document::{Document, Map, Node};
use robstiff_robots::quantity::Dimension;

/// Cutting coefficients (force per chip area, Pa) and edge coefficients
/// (force per length of the edge, N/m), tangential, radial and axial. Positive axial
/// ones pull a tool with a right-handed helix out of its holder; with a left-handed one they
/// push it in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coefficients {
    /// Tangential, per chip area (Pa).
    pub ktc: f64,
    /// Tangential, per length of the edge (N/m).
    pub kte: f64,
    /// Radial, per chip area (Pa).
    pub krc: f64,
    /// Radial, per length of the edge (N/m).
    pub kre: f64,
    /// Axial, per chip area (Pa).
    pub kac: f64,
    /// Axial, per length of the edge (N/m).
    pub kae: f64,
}

/// A material with a tool, as a source gives its coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// What a cut file calls it.
    pub id: String,
    /// The material and the tool.
    pub name: String,
    /// Who measured it.
    pub source: String,
    /// The coefficients.
    pub coefficients: Coefficients,
}

const TABLE: &str = include_str!("coefficients.yaml");

/// The table of materials that ships with robstiff, each with its source. The
/// same alloy differs by a factor of two between sources: a cut's own
/// coefficients are the rule, these are for a first estimate.
pub fn materials() -> Vec<Material> {
    let document = Document::parse("coefficients.yaml", TABLE).expect("the table is YAML");
    let read = document.root().any_map("one material a field").and_then(|map| {
        let materials: Vec<Option<Material>> = map.fields().map(|(id, node)| material(id, &node)).collect();
        materials.into_iter().collect::<Option<Vec<_>>>()
    });
    document.finish(read).expect("the table has no mistakes")
}

fn material(id: &str, node: &Node<'_>) -> Option<Material> {
    let map = node.map(&["name", "source", "tangential", "radial", "axial"])?;
    let text = |field: &str| map.require(field, "a text").and_then(|node| Some(node.text()?.trim().to_owned()));
    let (name, source, coefficients) = (text("name"), text("source"), read(&map));
    Some(Material { id: id.to_owned(), name: name?, source: source?, coefficients: coefficients? })
}

/// The coefficients in the fields `tangential`, `radial` and, where it is there,
/// `axial`, of a map; the first two must be there.
pub(super) fn read(map: &Map<'_>) -> Option<Coefficients> {
    let tangential = map.require("tangential", "tangential: {cutting: 631 N/mm2, edge: 13 N/mm}");
    let radial = map.require("radial", "radial: {cutting: 99 N/mm2, edge: 10 N/mm}");
    let tangential = tangential.and_then(|node| pair(&node));
    let radial = radial.and_then(|node| pair(&node));
    let axial = map.get("axial").map_or(Some((0.0, 0.0)), |node| pair(&node));
    let ((ktc, kte), (krc, kre), (kac, kae)) = (tangential?, radial?, axial?);
    Some(Coefficients { ktc, kte, krc, kre, kac, kae })
}

/// `{cutting: 631 N/mm2, edge: 13 N/mm}`, the second zero where it is left out.
fn pair(node: &Node<'_>) -> Option<(f64, f64)> {
    let map = node.map(&["cutting", "edge"])?;
    // Of either sign: the radial and the axial force may pull.
    let cutting = map.require("cutting", "cutting: 631 N/mm2").and_then(|node| node.quantity(Dimension::Pressure));
    let edge = map.get("edge").map_or(Some(0.0), |node| node.quantity(Dimension::LineForce));
    Some((cutting?, edge?))
}
