//! Some cells of a map at a time.

use core::ops::Range;

/// Cells in a chunk, where one costs little.
pub const CHUNK: usize = 1 << 16;

/// Some cells of a map in a row.
#[derive(Clone, Debug)]
pub struct Chunk {
    /// Their numbers.
    pub cells: Range<usize>,
    /// The columns of the measure, then those of the space: `columns[k][i]` of the
    /// `i`-th of these cells, in SI; NaN where no pose reaches it.
    pub columns: Vec<Vec<f64>>,
}
