//! What of a map is drawn: slices along its first two axes that vary.

use robstiff_machining::map::{Axis, Chunk, Measure};

use super::table::Counter;

/// Slices of a map with more axes, at most.
const SLICES: usize = 6;

/// Pixels along an axis, at most.
const PIXELS: usize = 400;

/// Slices, side by side along the third axis that varies; where more vary, they
/// are through the middle.
pub struct Slices {
    /// Which axes are drawn: to the right, upwards.
    pub drawn: [usize; 2],
    /// Pixels to the right and upwards.
    pub pixels: [usize; 2],
    /// The slices.
    pub slices: Vec<Slice>,
    lengths: Vec<usize>,
    measure: Measure,
}

/// A slice.
pub struct Slice {
    /// The index of its cells along each axis that is not drawn.
    pub at: Vec<usize>,
    /// By rows from below, the first column of the measure in SI: the worst of the
    /// cells in the pixel; NaN where none is reached.
    pub values: Vec<f64>,
}

/// A cell that is drawn.
pub struct Dot {
    slice: usize,
    pixel: usize,
    value: f64,
}

impl Slices {
    /// The slices of a map, not filled yet; none, where less than two axes vary.
    pub fn new(axes: &[Axis], measure: &Measure) -> Option<Self> {
        let varying: Vec<usize> = (0..axes.len()).filter(|&axis| axes[axis].varies()).collect();
        let [right, up, beyond @ ..] = varying.as_slice() else { return None };
        let pixels = [right, up].map(|&axis| axes[axis].values.len().min(PIXELS));
        let middle: Vec<usize> = axes.iter().map(|axis| axis.values.len() / 2).collect();
        let slice = |at: Vec<usize>| Slice { at, values: vec![f64::NAN; pixels[0] * pixels[1]] };
        let slices = match beyond.first() {
            None => vec![slice(middle)],
            Some(&third) => {
                let (last, count) = (axes[third].values.len() - 1, axes[third].values.len().min(SLICES));
                let index = |k: usize| (k * last + (count - 1) / 2) / (count - 1).max(1);
                (0..count)
                    .map(|k| {
                        let mut at = middle.clone();
                        at[third] = index(k);
                        slice(at)
                    })
                    .collect()
            }
        };
        let lengths = axes.iter().map(|axis| axis.values.len()).collect();
        Some(Self { drawn: [*right, *up], pixels, slices, lengths, measure: *measure })
    }

    /// The same slices without values, to look cells up in.
    pub fn empty(&self) -> Self {
        let slices = self.slices.iter().map(|slice| Slice { at: slice.at.clone(), values: Vec::new() });
        Self { slices: slices.collect(), lengths: self.lengths.clone(), ..*self }
    }

    /// The cells of a chunk that are drawn.
    pub fn dots(&self, chunk: &Chunk) -> Vec<Dot> {
        let mut dots = Vec::new();
        let mut at = Counter::new(self.lengths.iter().copied(), chunk.cells.start);
        let aside: Vec<usize> = (0..self.lengths.len()).filter(|axis| !self.drawn.contains(axis)).collect();
        for &value in &chunk.columns[0] {
            let same = |slice: &Slice| aside.iter().all(|&axis| slice.at[axis] == at.indices[axis]);
            if let Some(slice) = self.slices.iter().position(same) {
                let [x, y] = [0, 1].map(|k| {
                    let axis = self.drawn[k];
                    at.indices[axis] * self.pixels[k] / self.lengths[axis]
                });
                dots.push(Dot { slice, pixel: x + self.pixels[0] * y, value });
            }
            at.advance();
        }
        dots
    }

    /// Draws cells.
    pub fn draw(&mut self, dots: Vec<Dot>) {
        for Dot { slice, pixel, value } in dots {
            let drawn = &mut self.slices[slice].values[pixel];
            if drawn.is_nan() || self.measure.is_worse(value, *drawn) {
                *drawn = value;
            }
        }
    }
}
