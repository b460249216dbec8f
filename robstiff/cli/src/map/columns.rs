//! A map as Parquet: a row group a chunk, numbers of single precision.

use std::io::Write;
use std::sync::Arc;

use bytes::Bytes;
use parquet::basic::{Repetition, Type as Physical};
use parquet::column::writer::{ColumnCloseResult, get_column_writer, get_typed_column_writer_mut};
use parquet::data_type::FloatType;
use parquet::errors::Result;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedFileWriter, SerializedPageWriter, TrackedWrite};
use parquet::schema::types::{ColumnPath, SchemaDescriptor, Type};
use robstiff_machining::map::{Axis, Chunk, Column};

use super::table::{Counter, heading, single};

/// How chunks become row groups.
pub struct Columns {
    axes: Vec<Vec<f32>>,
    columns: Vec<Column>,
    schema: Arc<Type>,
    properties: Arc<WriterProperties>,
}

/// The columns of a chunk, encoded.
pub type RowGroup = Vec<(Bytes, ColumnCloseResult)>;

impl Columns {
    /// The columns of the table: coordinates that vary, then the map's.
    pub fn new(axes: &[Axis], columns: &[Column]) -> Result<Self> {
        let names = axes.iter().filter(|axis| axis.varies()).map(|axis| format!("{} [{}]", axis.name, axis.unit()));
        let names: Vec<String> = names.collect();
        let required = names.iter().cloned().map(|name| (name, Repetition::REQUIRED));
        // Where no pose reaches the cell, or nothing gives way in it, there is no value.
        let optional = columns.iter().map(|column| (heading(column), Repetition::OPTIONAL));
        let field = |(name, repetition): (String, Repetition)| {
            Type::primitive_type_builder(&name, Physical::FLOAT).with_repetition(repetition).build().map(Arc::new)
        };
        let fields = required.chain(optional).map(field).collect::<Result<Vec<_>>>()?;
        let schema = Type::group_type_builder("map").with_fields(fields).build()?;
        // Coordinates repeat, values do not.
        let mut properties =
            WriterProperties::builder().set_statistics_enabled(EnabledStatistics::Chunk).set_dictionary_enabled(false);
        for name in names {
            properties = properties.set_column_dictionary_enabled(ColumnPath::from(name), true);
        }
        let values = axes.iter().map(|axis| (0..axis.values.len()).map(|k| axis.for_people(k) as f32).collect());
        Ok(Self {
            axes: values.collect(),
            columns: columns.to_vec(),
            schema: Arc::new(schema),
            properties: Arc::new(properties.build()),
        })
    }

    /// A file to append row groups to.
    pub fn file<W: Write + Send>(&self, file: W) -> Result<SerializedFileWriter<W>> {
        SerializedFileWriter::new(file, self.schema.clone(), self.properties.clone())
    }

    /// Encodes a chunk.
    pub fn encode(&self, chunk: &Chunk) -> Result<RowGroup> {
        let schema = SchemaDescriptor::new(self.schema.clone());
        let count = chunk.cells.len();
        let varying: Vec<usize> = (0..self.axes.len()).filter(|&axis| self.axes[axis].len() > 1).collect();
        let mut coordinates = vec![Vec::with_capacity(count); varying.len()];
        let mut at = Counter::new(self.axes.iter().map(Vec::len), chunk.cells.start);
        for _ in 0..count {
            for (column, &axis) in coordinates.iter_mut().zip(&varying) {
                column.push(self.axes[axis][at.indices[axis]]);
            }
            at.advance();
        }
        let mut group = Vec::with_capacity(schema.num_columns());
        for values in &coordinates {
            group.push(self.column(&schema, group.len(), values, None)?);
        }
        for (column, values) in self.columns.iter().zip(&chunk.columns) {
            let there: Vec<i16> = values.iter().map(|&value| i16::from(single(value, column).is_some())).collect();
            let values: Vec<f32> = values.iter().filter_map(|&value| single(value, column)).collect();
            group.push(self.column(&schema, group.len(), &values, Some(&there))?);
        }
        Ok(group)
    }

    fn column(
        &self,
        schema: &SchemaDescriptor,
        index: usize,
        values: &[f32],
        there: Option<&[i16]>,
    ) -> Result<(Bytes, ColumnCloseResult)> {
        let mut bytes = TrackedWrite::new(Vec::new());
        let pages = Box::new(SerializedPageWriter::new(&mut bytes));
        let mut writer = get_column_writer(schema.column(index), self.properties.clone(), pages);
        let typed = get_typed_column_writer_mut::<FloatType>(&mut writer);
        typed.write_batch(values, there, None)?;
        let closed = writer.close()?;
        Ok((bytes.into_inner()?.into(), closed))
    }
}

/// Appends an encoded chunk to a file.
pub fn append<W: Write + Send>(file: &mut SerializedFileWriter<W>, group: RowGroup) -> Result<()> {
    let mut rows = file.next_row_group()?;
    for (bytes, closed) in group {
        rows.append_column(&bytes, closed)?;
    }
    rows.close().map(|_| ())
}
