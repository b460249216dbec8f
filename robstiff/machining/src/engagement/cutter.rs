//! The shape that an end mill sweeps.

use core::f64::consts::FRAC_PI_2;

/// An end mill as a body of revolution: flat, with a corner radius (bull nose) or round (ball nose).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutter {
    /// Diameter (m).
    pub diameter: f64,
    /// The radius of the corner (m): 0 of a flat end mill, half the diameter of a ball nose.
    pub corner: f64,
}

/// What of a cutter lies between two heights above its tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice {
    /// The lower height (m).
    pub from: f64,
    /// The upper one (m); infinite at the circumference.
    pub to: f64,
    /// The radius (m), in the mean over the height.
    pub radius: f64,
    /// The angle between the tool's axis and the normal of the surface there (rad), a right angle
    /// at the circumference.
    pub lead: f64,
}

/// Slices of a corner, each over the same angle.
const OF_CORNER: usize = 9;

impl Cutter {
    /// Its radius (m).
    pub fn radius(&self) -> f64 {
        0.5 * self.diameter
    }

    /// The radius of what is flat at its tip (m).
    pub fn flat(&self) -> f64 {
        (self.radius() - self.corner).max(0.0)
    }

    /// How high its surface is above the tip (m), so far from the axis (m), within the radius.
    pub fn rise(&self, distance: f64) -> f64 {
        let out = (distance - self.flat()).clamp(0.0, self.corner);
        self.corner - (self.corner * self.corner - out * out).sqrt()
    }

    /// Its radius at a height above the tip (m).
    pub fn radius_at(&self, height: f64) -> f64 {
        let down = (self.corner - height).clamp(0.0, self.corner);
        self.flat() + (self.corner * self.corner - down * down).sqrt()
    }

    /// Its slices, from the tip up.
    pub fn slices(&self) -> Vec<Slice> {
        let step = FRAC_PI_2 / OF_CORNER as f64;
        let height =
            |k: usize| if k == OF_CORNER { self.corner } else { self.corner * (1.0 - (step * k as f64).cos()) };
        // The area beside the axis of the circle's segment up to an angle.
        let area = |angle: f64| 0.5 * self.corner * self.corner * (angle - angle.sin() * angle.cos());
        let of_corner = (0..OF_CORNER).map(|k| {
            let (from, to) = (height(k), height(k + 1));
            let radius = self.flat() + (area(step * (k + 1) as f64) - area(step * k as f64)) / (to - from);
            Slice { from, to, radius, lead: step * (k as f64 + 0.5) }
        });
        let side = Slice { from: self.corner, to: f64::INFINITY, radius: self.radius(), lead: FRAC_PI_2 };
        let of_corner = of_corner.filter(|_| self.corner > 0.0);
        of_corner.chain([side]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radius_and_height_belong_together() {
        for corner in [0.002, 0.01] {
            let cutter = Cutter { diameter: 0.02, corner };
            for height in [0.1, 0.5, 0.9].map(|part| part * corner) {
                assert!((cutter.rise(cutter.radius_at(height)) - height).abs() < 1e-15);
            }
            let slices = cutter.slices();
            assert!(slices.windows(2).all(|pair| pair[0].to == pair[1].from && pair[0].radius < pair[1].radius));
            assert_eq!((slices[0].from, slices[9].radius), (0.0, 0.01));
        }
        let flat = Cutter { diameter: 0.02, corner: 0.0 };
        assert_eq!((flat.rise(0.0099), flat.radius_at(0.0), flat.slices().len()), (0.0, 0.01, 1));
    }
}
