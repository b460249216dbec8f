//! A map as CSV: a line a cell, the coordinates that vary before the columns.

use robstiff_machining::map::{Axis, Chunk, Column};

/// How cells are written down.
pub struct Table {
    axes: Vec<Written>,
    columns: Vec<Column>,
}

/// An axis with its values as text.
struct Written {
    name: String,
    values: Vec<String>,
}

impl Table {
    /// A table of a map's columns; an axis with one value has none.
    pub fn new(axes: &[Axis], columns: &[Column]) -> Self {
        let axes = axes.iter().map(|axis| Written {
            name: format!("{} [{}]", axis.name, axis.unit()),
            values: match axis.values.len() {
                1 => vec![String::new()],
                count => (0..count).map(|index| axis.for_people(index).to_string()).collect(),
            },
        });
        Self { axes: axes.collect(), columns: columns.to_vec() }
    }

    /// The first line.
    pub fn header(&self) -> String {
        let axes = self.axes.iter().filter(|axis| axis.values.len() > 1).map(|axis| axis.name.clone());
        axes.chain(self.columns.iter().map(heading)).collect::<Vec<_>>().join(",") + "\n"
    }

    /// The lines of a chunk. Values have single precision; where there is none the field is empty.
    pub fn lines(&self, chunk: &Chunk) -> Vec<u8> {
        let mut lines = Vec::with_capacity(chunk.cells.len() * 12 * (self.axes.len() + self.columns.len()));
        let mut at = Counter::new(self.axes.iter().map(|axis| axis.values.len()), chunk.cells.start);
        let mut number = zmij::Buffer::new();
        for cell in 0..chunk.cells.len() {
            let mut comma = false;
            for (axis, &index) in self.axes.iter().zip(&at.indices).filter(|(axis, _)| axis.values.len() > 1) {
                if comma {
                    lines.push(b',');
                }
                comma = true;
                lines.extend_from_slice(axis.values[index].as_bytes());
            }
            for (column, values) in self.columns.iter().zip(&chunk.columns) {
                if comma {
                    lines.push(b',');
                }
                comma = true;
                if let Some(value) = single(values[cell], column) {
                    lines.extend_from_slice(number.format_finite(value).as_bytes());
                }
            }
            lines.push(b'\n');
            at.advance();
        }
        lines
    }
}

/// `deviation [um]`.
pub fn heading(column: &Column) -> String {
    if column.unit.is_empty() { column.name.to_owned() } else { format!("{} [{}]", column.name, column.unit) }
}

/// A value as files hold it; none, where no pose reaches the cell or nothing gives way in it, and
/// of a number that single precision does not hold.
pub fn single(value: f64, column: &Column) -> Option<f32> {
    // No negative zero.
    let value = (value * column.scale) as f32 + 0.0;
    value.is_finite().then_some(value)
}

/// How many numbers of a chunk are too large for single precision.
pub fn too_large(chunk: &Chunk, columns: &[Column]) -> usize {
    let of_column = |(column, values): (&Column, &Vec<f64>)| {
        values.iter().filter(|value| value.is_finite() && single(**value, column).is_none()).count()
    };
    columns.iter().zip(&chunk.columns).map(of_column).sum()
}

/// The indices of cell after cell, the first fastest.
pub struct Counter {
    lengths: Vec<usize>,
    /// Those of the cell that it stands at.
    pub indices: Vec<usize>,
}

impl Counter {
    /// Stands at a cell.
    pub fn new(lengths: impl IntoIterator<Item = usize>, cell: usize) -> Self {
        let lengths: Vec<usize> = lengths.into_iter().collect();
        let mut rest = cell;
        let index = |length: &usize| {
            let index = rest % length;
            rest /= length;
            index
        };
        let indices = lengths.iter().map(index).collect();
        Self { lengths, indices }
    }

    /// Goes on to the next cell.
    pub fn advance(&mut self) {
        for (index, length) in self.indices.iter_mut().zip(&self.lengths) {
            *index += 1;
            if *index < *length {
                return;
            }
            *index = 0;
        }
    }
}
