//! What a map comes to.

use super::{Chunk, Measure};

/// A cell that stands out.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// Its number.
    pub cell: usize,
    /// Its columns, in SI.
    pub values: Vec<f64>,
}

/// The first column over all cells, in SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// How many cells there are.
    pub cells: usize,
    /// How many of them no pose reaches.
    pub unreachable: usize,
    /// At how many no force moves the tool, so that the stiffness there has no end.
    pub rigid: usize,
    /// The mean over those that are reached and finite.
    pub mean: f64,
    /// The cell where the measure is best, the first where several are.
    pub best: Option<Extreme>,
    /// The cell where it is worst, the first where several are.
    pub worst: Option<Extreme>,
    /// How many are in the mean.
    finite: usize,
}

impl Summary {
    /// Of a chunk.
    pub fn of(chunk: &Chunk, measure: &Measure) -> Self {
        let figures = &chunk.columns[0];
        let (mut sum, mut finite, mut unreachable, mut rigid) = (0.0, 0, 0, 0);
        let (mut best, mut worst): (Option<usize>, Option<usize>) = (None, None);
        for (i, &figure) in figures.iter().enumerate() {
            if figure.is_nan() {
                unreachable += 1;
                continue;
            }
            if figure.is_finite() {
                (sum, finite) = (sum + figure, finite + 1);
            } else if !measure.worse_is_larger() {
                rigid += 1;
            }
            if best.is_none_or(|k| measure.is_worse(figures[k], figure)) {
                best = Some(i);
            }
            if worst.is_none_or(|k| measure.is_worse(figure, figures[k])) {
                worst = Some(i);
            }
        }
        let extreme = |i: usize| Extreme {
            cell: chunk.cells.start + i,
            values: chunk.columns.iter().map(|column| column[i]).collect(),
        };
        Self {
            cells: figures.len(),
            unreachable,
            rigid,
            mean: if finite > 0 { sum / finite as f64 } else { f64::NAN },
            best: best.map(extreme),
            worst: worst.map(extreme),
            finite,
        }
    }

    /// This and the chunks behind it.
    #[must_use]
    pub fn and(mut self, next: Self, measure: &Measure) -> Self {
        let finite = self.finite + next.finite;
        self.mean = match (self.finite, next.finite) {
            (0, _) => next.mean,
            (_, 0) => self.mean,
            (a, b) => (self.mean * a as f64 + next.mean * b as f64) / finite as f64,
        };
        self.finite = finite;
        self.cells += next.cells;
        self.unreachable += next.unreachable;
        self.rigid += next.rigid;
        let figure = |extreme: &Option<Extreme>| extreme.as_ref().map(|extreme| extreme.values[0]);
        let beats = |next: f64, own: Option<f64>, than: fn(&Measure, f64, f64) -> bool| {
            own.is_none_or(|own| than(measure, next, own))
        };
        if figure(&next.best).is_some_and(|next| beats(next, figure(&self.best), |m, a, b| m.is_worse(b, a))) {
            self.best = next.best;
        }
        if figure(&next.worst).is_some_and(|next| beats(next, figure(&self.worst), Measure::is_worse)) {
            self.worst = next.worst;
        }
        self
    }
}
