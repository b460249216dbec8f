//! Maps chunk by chunk.

use core::ops::Range;
use std::vec::Vec;

use super::{Evaluate, Measure, Space, Summary};

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

/// Maps a space: computes it chunk by chunk, makes something of each chunk, and
/// hands that over in order. `encode` runs on all cores with the feature `rayon`,
/// beside the chunks that come next; what waits is a few chunks for each core.
///
/// # Errors
/// The first that `take` returns; nothing is computed after it.
pub fn stream<const N: usize, E: Send, X: Send>(
    robot: &impl Evaluate<N>,
    space: &impl Space<N>,
    measure: &Measure,
    encode: impl Fn(&Chunk) -> E + Sync,
    mut take: impl FnMut(E) -> Result<(), X> + Send,
) -> Result<Summary, X> {
    let cells = space.cells();
    let step = |cells: Range<usize>| {
        let columns = space.compute(robot, measure, cells.clone());
        let chunk = Chunk { cells, columns };
        (Summary::of(&chunk, measure), encode(&chunk))
    };
    let mut summary = Summary::default();
    let mut hand_over = |done: Vec<(Summary, E)>| {
        for (part, encoded) in done {
            summary = core::mem::take(&mut summary).and(part, measure);
            take(encoded)?;
        }
        Ok(())
    };
    let size = space.chunk();
    let chunks = (0..cells).step_by(size).map(|start| start..cells.min(start + size));
    in_order(chunks, step, &mut hand_over)?;
    Ok(summary)
}

#[cfg(feature = "rayon")]
fn in_order<R: Send, X: Send>(
    mut chunks: impl Iterator<Item = Range<usize>>,
    step: impl Fn(Range<usize>) -> R + Sync,
    hand_over: &mut (impl FnMut(Vec<R>) -> Result<(), X> + Send),
) -> Result<(), X> {
    use rayon::prelude::*;

    let mut done = Vec::new();
    // One group is handed over while the next is computed.
    loop {
        let group: Vec<Range<usize>> = chunks.by_ref().take(4 * rayon::current_num_threads()).collect();
        if group.is_empty() {
            break;
        }
        let compute = || group.into_par_iter().map(&step).collect();
        let (next, handed) = rayon::join(compute, || hand_over(core::mem::take(&mut done)));
        handed?;
        done = next;
    }
    hand_over(done)
}

#[cfg(not(feature = "rayon"))]
fn in_order<R: Send, X: Send>(
    chunks: impl Iterator<Item = Range<usize>>,
    step: impl Fn(Range<usize>) -> R + Sync,
    hand_over: &mut (impl FnMut(Vec<R>) -> Result<(), X> + Send),
) -> Result<(), X> {
    for chunk in chunks {
        hand_over(std::vec![step(chunk)])?;
    }
    Ok(())
}
