//! The specific cutting force after Kienzle: `kc = kc1.1 (h / 1 mm)^-mc`.
//!
//! O. Kienzle, Die Bestimmung von Kräften und Leistungen an spanenden Werkzeugen und
//! Werkzeugmaschinen, VDI-Zeitschrift 94 (1952). The tangential force per depth of cut is
//! `kc1.1 h^(1 - mc)`. The model of the cut is linear in the chip: it takes the line
//! `Ktc h + Kte` that fits best over the chips of the cut.

use robstiff_robots::document::{Document, Map, Node};
use robstiff_robots::quantity::Dimension;

use super::{Coefficients, Engagement};

/// What a material resists with, by the thickness of the chip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kienzle {
    /// The specific cutting force of a chip of 1 mm (Pa), kc1.1.
    pub kc11: f64,
    /// How it falls with the thickness, mc: from 0 to less than 1.
    pub mc: f64,
    /// The radial force as a part of the tangential one.
    pub radial: f64,
    /// The axial force as a part of the tangential one.
    pub axial: f64,
}

/// A material as a source gives its specific cutting force.
#[derive(Clone, Debug, PartialEq)]
pub struct KienzleMaterial {
    /// What a cut file calls it.
    pub id: String,
    /// The material.
    pub name: String,
    /// Who measured it.
    pub source: String,
    /// The specific cutting force of a chip of 1 mm (Pa), kc1.1.
    pub kc11: f64,
    /// How it falls with the thickness, mc.
    pub mc: f64,
}

/// The thickness that kc1.1 is for (m).
const REFERENCE: f64 = 1e-3;

/// Angles of the engagement at which the line is fitted.
const ANGLES: usize = 400;

/// Chips that differ by less than this part have a tangent only.
const ALIKE: f64 = 1e-3;

impl Kienzle {
    /// The tangential force per depth (N/m) at a thickness of the chip (m).
    pub fn tangential(&self, chip: f64) -> f64 {
        self.kc11 * REFERENCE * (chip / REFERENCE).powf(1.0 - self.mc)
    }

    /// The coefficients whose force is nearest, in the least squares over the angles of an
    /// engagement, for a feed per tooth (m).
    pub fn coefficients(&self, engagement: Engagement, feed: f64) -> Coefficients {
        let Engagement { entry, exit } = engagement;
        let angle = |k: usize| entry + (exit - entry) * (k as f64 + 0.5) / ANGLES as f64;
        let chips: Vec<f64> = (0..ANGLES).map(|k| feed * angle(k).sin()).collect();
        let forces: Vec<f64> = chips.iter().map(|chip| self.tangential(*chip)).collect();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / ANGLES as f64;
        let (chip, force) = (mean(&chips), mean(&forces));
        let spread = chips.iter().map(|one| (one - chip).powi(2)).sum::<f64>();
        let product: f64 = chips.iter().zip(&forces).map(|(one, other)| (one - chip) * (other - force)).sum();
        let is_alike = spread < (ALIKE * chip).powi(2) * ANGLES as f64;
        let cutting = if is_alike { (1.0 - self.mc) * self.tangential(chip) / chip } else { product / spread };
        let edge = force - cutting * chip;
        Coefficients {
            ktc: cutting,
            kte: edge,
            krc: self.radial * cutting,
            kre: self.radial * edge,
            kac: self.axial * cutting,
            kae: self.axial * edge,
        }
    }
}

const TABLE: &str = include_str!("kienzle.yaml");

/// The table of materials that ships with robstiff, each with its source.
pub fn kienzle_materials() -> Vec<KienzleMaterial> {
    let document = Document::parse("kienzle.yaml", TABLE).expect("the table is YAML");
    let read = document.root().any_map("one material a field").and_then(|map| {
        let materials: Vec<Option<KienzleMaterial>> = map.fields().map(|(id, node)| material(id, &node)).collect();
        materials.into_iter().collect::<Option<Vec<_>>>()
    });
    document.finish(read).expect("the table has no mistakes")
}

fn material(id: &str, node: &Node<'_>) -> Option<KienzleMaterial> {
    let map = node.map(&["name", "source", "kc11", "mc"])?;
    let text = |field: &str| map.require(field, "a text").and_then(|node| Some(node.text()?.trim().to_owned()));
    let (name, source, numbers) = (text("name"), text("source"), numbers(&map));
    let (kc11, mc) = numbers?;
    Some(KienzleMaterial { id: id.to_owned(), name: name?, source: source?, kc11, mc })
}

/// `kc11` and `mc` of a map, which must be there.
fn numbers(map: &Map<'_>) -> Option<(f64, f64)> {
    let kc11 = map.require("kc11", "kc11: 1990 N/mm2").and_then(|node| node.positive(Dimension::Pressure));
    let mc = map.require("mc", "mc: 0.26").and_then(|node| {
        let mc = node.nonnegative(Dimension::Number)?;
        if mc >= 1.0 {
            node.error("mc is less than 1: a thicker chip takes no smaller force", "e.g. `0.26`");
            return None;
        }
        Some(mc)
    });
    Some((kc11?, mc?))
}

/// `{kc11: 1990 N/mm2, mc: 0.26, radial: 0.3}`, or a material of the table with the share; with what
/// its source says.
pub(super) fn read(node: &Node<'_>) -> Option<(Kienzle, String)> {
    let map = node.map(&["material", "kc11", "mc", "radial", "axial"])?;
    let law = match map.get("material") {
        Some(node) => {
            for field in ["kc11", "mc"] {
                if let Some(other) = map.get(field) {
                    other.error("the material says this already", "keep `material`, or `kc11` and `mc`");
                }
            }
            let materials = kienzle_materials();
            let words: Vec<(&str, &KienzleMaterial)> =
                materials.iter().map(|material| (material.id.as_str(), material)).collect();
            node.choice(&words).map(|found| ((found.kc11, found.mc), format!("{}; {}", found.name, found.source)))
        }
        None => numbers(&map).map(|numbers| (numbers, String::new())),
    };
    // Nobody's table of kc1.1 has it, and without it the tool would be pushed along the feed only.
    let radial = map
        .require("radial", "radial: 0.3, the radial force as a part of the tangential one")
        .and_then(|node| node.quantity(Dimension::Number));
    let axial = map.get("axial").map_or(Some(0.0), |node| node.quantity(Dimension::Number));
    let ((kc11, mc), source) = law?;
    Some((Kienzle { kc11, mc, radial: radial?, axial: axial? }, source))
}
