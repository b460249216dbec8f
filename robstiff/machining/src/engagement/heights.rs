//! The stock as heights over a grid.

use nalgebra::{Vector2, Vector3};
use robstiff_robots::words::count;

use super::stock::Stock;

/// The pitch of the grid is this part of the smallest cutter's radius, where the memory is enough.
pub const FINE: f64 = 1.0 / 50.0;

/// The pitch is at most this part of it: a width of the cut is then off by a twentieth of the radius at
/// the most.
pub const COARSE: f64 = 1.0 / 20.0;

/// Cells of a grid, at most: 160 MB.
pub const MOST_CELLS: f64 = 4e7;

/// Removed layers that are thinner are rounding (m).
const THIN: f32 = 1e-7;

/// Heights of the material above the stock's underside.
///
/// The grid is turned against the axes by an angle whose tangent is the golden ratio: walls along an axis
/// or at 45 degrees then cross its cells at every offset, so that the mean place of a wall is right to much
/// less than a cell.
pub struct Heights {
    /// The corner of the first cell, in the grid's frame (m).
    corner: Vector2<f64>,
    /// The width of a cell (m).
    pitch: f64,
    /// Cells along both axes.
    size: [usize; 2],
    /// Of each cell's middle (m), row by row.
    cells: Vec<f32>,
    bottom: f64,
}

/// A stock that needs more cells than fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TooLarge {
    /// What the tools reach of it, along and across the grid (m).
    pub reached: [f64; 2],
    /// The radius of the smallest cutter (m).
    pub radius: f64,
}

impl core::fmt::Display for TooLarge {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let [along, across] = self.reached.map(|length| 1e3 * length);
        let most = 1e3 * (self.reached[0] * self.reached[1] / MOST_CELLS).sqrt() / COARSE;
        write!(
            f,
            "the tools reach {along:.0} x {across:.0} mm of the stock: with a tool of {} mm that is more than {}; write a \
             smaller stock, split the path, or leave out tools of less than {:.1} mm",
            2e3 * self.radius,
            count(MOST_CELLS as usize, "cell"),
            2.0 * most
        )
    }
}

impl core::error::Error for TooLarge {}

/// What is cut off a cell.
pub struct Removed {
    /// The cell's middle in the grid's frame (m).
    pub at: Vector2<f64>,
    /// The heights between which it was (m, from the zero of z).
    pub from: f64,
    pub to: f64,
}

impl Removed {
    /// How high it was (m).
    pub fn height(&self) -> f64 {
        self.to - self.from
    }
}

impl Heights {
    /// The stock where it is within the reach of points (x and y, m): `radii` are those of the smallest and the
    /// largest cutter.
    ///
    /// # Errors
    /// Where that needs more cells than fit.
    pub fn new(stock: &Stock, points: impl Iterator<Item = Vector2<f64>>, radii: [f64; 2]) -> Result<Self, TooLarge> {
        let [smallest, largest] = radii;
        let corners: Vec<Vector2<f64>> =
            stock.outline().iter().map(|&[x, y]| to_grid(&Vector3::new(x, y, 0.0)).xy()).collect();
        let margin = Vector2::repeat(largest);
        let around = |all: &mut dyn Iterator<Item = Vector2<f64>>| {
            let none = [Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY)];
            all.fold(none, |[low, high], point| [low.inf(&point), high.sup(&point)])
        };
        let of_stock = around(&mut corners.iter().copied());
        let of_path = around(&mut points.map(|point| to_grid(&point.push(0.0)).xy()));
        let low = of_stock[0].sup(&(of_path[0] - margin));
        let reached = (of_stock[1].inf(&(of_path[1] + margin)) - low).sup(&Vector2::zeros());
        let area = reached.x * reached.y;
        let pitch = (FINE * smallest).max((area / MOST_CELLS).sqrt());
        if pitch > COARSE * smallest {
            return Err(TooLarge { reached: reached.into(), radius: smallest });
        }
        let size = [reached.x, reached.y].map(|length| (length / pitch).ceil() as usize);
        let mut heights = Self { corner: low, pitch, size, cells: Vec::new(), bottom: stock.bottom() };
        heights.cells = vec![0.0; size[0] * size[1]];
        let height = stock.thickness() as f32;
        for row in 0..size[1] {
            let y = heights.middle(row, 1);
            for [from, to] in within(&corners, y) {
                let first = heights.cell_after(from, 0);
                let end = heights.cell_after(to, 0);
                heights.cells[row * size[0]..][first..end.max(first)].fill(height);
            }
        }
        Ok(heights)
    }

    /// The width of a cell (m).
    pub fn pitch(&self) -> f64 {
        self.pitch
    }

    /// Takes away, of the cells whose middles are within a distance (m) along both axes of a straight way between
    /// two points of the grid's frame, what is above a floor, and tells of each. `floor` gives the
    /// height (m, from the zero of z) for the middle of a cell, nowhere below `lowest` (m).
    pub fn cut(
        &mut self,
        [from, to]: [Vector2<f64>; 2],
        reach: f64,
        lowest: f64,
        floor: impl Fn(&Vector2<f64>) -> Option<f64>,
        mut tell: impl FnMut(Removed),
    ) {
        let (low, high) = (from.inf(&to).add_scalar(-reach), from.sup(&to).add_scalar(reach));
        let [columns, rows] = [0, 1].map(|axis| self.cell_after(low[axis], axis)..self.cell_after(high[axis], axis));
        let bottom = self.bottom;
        let over_bottom = |height: f64| ((height - bottom) as f32).max(0.0);
        let least = over_bottom(lowest) + THIN;
        for row in rows {
            let y = self.middle(row, 1);
            for column in columns.clone() {
                let old = self.cells[row * self.size[0] + column];
                // Most of what a tool passes over is cut already.
                if old <= least {
                    continue;
                }
                let at = Vector2::new(self.middle(column, 0), y);
                let Some(new) = floor(&at).map(over_bottom) else { continue };
                if old > new + THIN {
                    self.cells[row * self.size[0] + column] = new;
                    tell(Removed { at, from: bottom + f64::from(new), to: bottom + f64::from(old) });
                }
            }
        }
    }

    /// The middle of a row or column along an axis (m).
    fn middle(&self, index: usize, axis: usize) -> f64 {
        self.corner[axis] + (index as f64 + 0.5) * self.pitch
    }

    /// The first cell along an axis whose middle is at or beyond a place (m).
    fn cell_after(&self, place: f64, axis: usize) -> usize {
        let index = ((place - self.corner[axis]) / self.pitch - 0.5).ceil();
        // A float below zero becomes 0.
        (index as usize).min(self.size[axis])
    }
}

/// Turns a vector of the path's frame into that of the grid.
pub fn to_grid(vector: &Vector3<f64>) -> Vector3<f64> {
    let (sine, cosine) = (0.5 * (5_f64.sqrt() - 1.0)).atan().sin_cos();
    Vector3::new(cosine * vector.x + sine * vector.y, cosine * vector.y - sine * vector.x, vector.z)
}

/// Where a line along x is within a polygon.
fn within(corners: &[Vector2<f64>], y: f64) -> Vec<[f64; 2]> {
    let next = corners.iter().cycle().skip(1);
    let crossing = |(one, other): (&Vector2<f64>, &Vector2<f64>)| {
        let crosses = (one.y <= y) != (other.y <= y);
        crosses.then(|| one.x + (other.x - one.x) * (y - one.y) / (other.y - one.y))
    };
    let mut crossings: Vec<f64> = corners.iter().zip(next).filter_map(crossing).collect();
    crossings.sort_by(f64::total_cmp);
    crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
}
