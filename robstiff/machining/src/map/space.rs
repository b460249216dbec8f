//! Spaces to map.

use core::array;
use core::ops::Range;

use super::{Axis, CHUNK, Column, Evaluate, Measure, Poses};
use robstiff::batch::Grid;

/// A grid of cells, the first axis fastest.
pub trait Space<const N: usize>: Sync {
    /// Its axes.
    fn axes(&self) -> &[Axis];

    /// What it tells of each cell behind the measure's columns.
    fn columns(&self) -> Vec<Column> {
        Vec::new()
    }

    /// How many cells it has.
    fn cells(&self) -> usize {
        self.axes().iter().map(|axis| axis.values.len()).product()
    }

    /// The columns of the measure and its own at some cells, in SI; NaN where no
    /// pose reaches the cell.
    fn compute(&self, robot: &impl Evaluate<N>, measure: &Measure, cells: Range<usize>) -> Vec<Vec<f64>>;

    /// How many cells are computed at a time.
    fn chunk(&self) -> usize {
        CHUNK
    }

    /// Which value of each axis a cell has.
    fn indices(&self, cell: usize) -> Vec<usize> {
        let mut rest = cell;
        let index = |axis: &Axis| {
            let index = rest % axis.values.len();
            rest /= axis.values.len();
            index
        };
        self.axes().iter().map(index).collect()
    }
}

/// A grid in joint space; a joint with one value stands still.
#[derive(Clone, Debug)]
pub struct JointSpace<'t, const N: usize> {
    axes: &'t [Axis; N],
    grid: Grid<'t, f64, N>,
}

impl<'t, const N: usize> JointSpace<'t, N> {
    /// The space of the coordinates of each joint (rad or m). `tables` is room for
    /// their sines and cosines.
    ///
    /// # Panics
    /// If there are more cells than a `usize` can count.
    pub fn new(axes: &'t [Axis; N], tables: &'t mut Vec<f64>) -> Self {
        let coordinates: [&[f64]; N] = array::from_fn(|joint| axes[joint].values.as_slice());
        *tables = vec![0.0; Grid::table_len(&coordinates)];
        Self { axes, grid: Grid::new(coordinates, tables) }
    }
}

impl<const N: usize> Space<N> for JointSpace<'_, N> {
    fn axes(&self) -> &[Axis] {
        self.axes
    }

    fn compute(&self, robot: &impl Evaluate<N>, measure: &Measure, cells: Range<usize>) -> Vec<Vec<f64>> {
        measure.compute(robot, Poses::Grid(self.grid.part(cells)))
    }
}
