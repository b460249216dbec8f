//! Maps chunk by chunk.

use core::ops::Range;

use super::{Axis, Chunk, Column, Evaluate, Measure, Space, Summary};

/// What a robot's measure is all over a space, to be computed: whatever the number of joints,
/// so that what is made of it is compiled once and not for each.
pub struct Survey<'a> {
    /// The axes of the space.
    pub axes: &'a [Axis],
    /// The columns of the measure, then those of the space.
    pub columns: Vec<Column>,
    /// What is computed of each cell.
    pub measure: Measure,
    /// How many cells there are.
    pub cells: usize,
    /// How many of them are computed at a time.
    pub chunk: usize,
    compute: Box<dyn Fn(Range<usize>) -> Vec<Vec<f64>> + Sync + 'a>,
}

impl<'a> Survey<'a> {
    /// What `measure` is of a robot all over `space`.
    pub fn new<const N: usize>(robot: &'a impl Evaluate<N>, space: &'a impl Space<N>, measure: &Measure) -> Self {
        let measure = *measure;
        Self {
            axes: space.axes(),
            columns: [measure.columns(), &space.columns()].concat(),
            measure,
            cells: space.cells(),
            chunk: space.chunk(),
            compute: Box::new(move |cells| space.compute(robot, &measure, cells)),
        }
    }

    /// Computes it chunk by chunk, makes something of each chunk, and hands that
    /// over in order. `encode` runs on all cores with the feature `rayon`,
    /// beside the chunks that come next; what waits is a few chunks for each core.
    ///
    /// # Errors
    /// The first that `take` returns; nothing is computed after it.
    pub fn stream<E: Send, X: Send>(
        &self,
        encode: impl Fn(&Chunk) -> E + Sync,
        mut take: impl FnMut(E) -> Result<(), X> + Send,
    ) -> Result<Summary, X> {
        let step = |cells: Range<usize>| {
            let columns = (self.compute)(cells.clone());
            let chunk = Chunk { cells, columns };
            (Summary::of(&chunk, &self.measure), encode(&chunk))
        };
        let mut summary = Summary::default();
        let mut hand_over = |done: Vec<(Summary, E)>| {
            for (part, encoded) in done {
                summary = core::mem::take(&mut summary).and(part, &self.measure);
                take(encoded)?;
            }
            Ok(())
        };
        let chunks = (0..self.cells).step_by(self.chunk).map(|start| start..self.cells.min(start + self.chunk));
        in_order(chunks, step, &mut hand_over)?;
        Ok(summary)
    }
}

/// Maps a space: [`Survey::stream`] of what `measure` is of a robot there.
///
/// # Errors
/// The first that `take` returns; nothing is computed after it.
pub fn stream<const N: usize, E: Send, X: Send>(
    robot: &impl Evaluate<N>,
    space: &impl Space<N>,
    measure: &Measure,
    encode: impl Fn(&Chunk) -> E + Sync,
    take: impl FnMut(E) -> Result<(), X> + Send,
) -> Result<Summary, X> {
    Survey::new(robot, space, measure).stream(encode, take)
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
