//! The stock before it is cut.

use nalgebra::Vector3;

/// A prism of material along z: an outline between two heights.
#[derive(Clone, Debug, PartialEq)]
pub struct Stock {
    /// Its corners in x and y (m), in order, either way round.
    outline: Vec<[f64; 2]>,
    /// The height of its underside (m).
    bottom: f64,
    /// The height of its top (m).
    top: f64,
}

/// What is less is rounding (m).
const THICK: f64 = 1e-9;

impl Stock {
    /// The box between two opposite corners (m); `None` where it has no volume.
    pub fn of_corners(one: &Vector3<f64>, other: &Vector3<f64>) -> Option<Self> {
        let (low, high) = (one.inf(other), one.sup(other));
        let outline = [[low.x, low.y], [high.x, low.y], [high.x, high.y], [low.x, high.y]];
        Self::of_outline(outline.into(), low.z, high.z)
    }

    /// The prism of an outline (m), its corners in order, either way round, between two heights
    /// (m); `None` where it has no volume.
    pub fn of_outline(outline: Vec<[f64; 2]>, bottom: f64, top: f64) -> Option<Self> {
        let is_finite = outline.iter().flatten().chain([&bottom, &top]).all(|number| number.is_finite());
        let is_solid = outline.len() >= 3 && area(&outline).abs() > THICK * THICK && top - bottom > THICK;
        (is_finite && is_solid).then_some(Self { outline, bottom, top })
    }

    /// The height of its underside (m).
    pub fn bottom(&self) -> f64 {
        self.bottom
    }

    /// How thick it is (m).
    pub fn thickness(&self) -> f64 {
        self.top - self.bottom
    }

    /// Its corners in x and y (m), in order.
    pub fn outline(&self) -> &[[f64; 2]] {
        &self.outline
    }
}

/// The area within a polygon, negative where it goes round clockwise.
fn area(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    0.5 * outline.iter().zip(next).map(|(one, other)| one[0] * other[1] - one[1] * other[0]).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stock_has_a_volume() {
        let at = |x, y, z| Vector3::new(x, y, z);
        let stock = Stock::of_corners(&at(0.1, 0.2, 0.0), &at(0.0, 0.0, -0.01)).unwrap();
        assert_eq!((stock.bottom(), stock.thickness(), area(stock.outline())), (-0.01, 0.01, 0.1 * 0.2));
        assert_eq!(Stock::of_corners(&at(0.1, 0.2, 0.0), &at(0.0, 0.0, 0.0)), None);
        assert_eq!(Stock::of_corners(&at(0.1, 0.2, f64::NAN), &at(0.0, 0.0, 1.0)), None);
        assert_eq!(Stock::of_outline(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]], 0.0, 1.0), None);
        assert!(Stock::of_outline(vec![[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]], 0.0, 1.0).is_some());
    }
}
