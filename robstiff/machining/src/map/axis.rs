//! The axes of a map.

use robstiff_robots::quantity::Dimension;

/// A coordinate of a space and the values it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// `q2`, `x`.
    pub name: String,
    /// An angle or a length.
    pub dimension: Dimension,
    /// Its values in rad or m; one, where it is fixed.
    pub values: Vec<f64>,
}

impl Axis {
    /// `count` angles from one to the other (rad), both included; the first alone
    /// where it is one.
    pub fn angles(name: &str, from: f64, to: f64, count: usize) -> Self {
        Self::between(name, Dimension::Angle, from, to, count)
    }

    /// `count` lengths from one to the other (m), both included; the first alone
    /// where it is one.
    pub fn lengths(name: &str, from: f64, to: f64, count: usize) -> Self {
        Self::between(name, Dimension::Length, from, to, count)
    }

    /// `count` values from one to the other, both included, in SI.
    pub fn between(name: &str, dimension: Dimension, from: f64, to: f64, count: usize) -> Self {
        let last = count.saturating_sub(1).max(1) as f64;
        // The ends are met exactly.
        let value = |i: usize| {
            let share = i as f64 / last;
            from * (1.0 - share) + to * share
        };
        Self { name: name.to_owned(), dimension, values: (0..count).map(value).collect() }
    }

    /// Whether it takes more than one value.
    pub fn varies(&self) -> bool {
        self.values.len() > 1
    }

    /// The unit in which a machinist reads it: `deg` or `mm`.
    pub fn unit(&self) -> &'static str {
        if self.dimension == Dimension::Angle { "deg" } else { "mm" }
    }

    /// A value in that unit, without the rounding of the change of units.
    pub fn for_people(&self, index: usize) -> f64 {
        people(self.dimension, self.values[index])
    }
}

/// An angle in degrees or a length in millimetres, to a billionth of it.
pub fn people(dimension: Dimension, value: f64) -> f64 {
    let value = if dimension == Dimension::Angle { value.to_degrees() } else { value * 1e3 };
    (value * 1e9).round() / 1e9 + 0.0
}
