//! Tables as Parquet, written a group of rows at a time.

use parquet::basic::{ConvertedType, LogicalType, Repetition, Type as PhysicalType};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::io::{self, Write};
use std::sync::Arc;

/// What is in a column; no cell is ever empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Column {
    Whole,
    Text,
    Real,
}

/// The cells of a column in some rows.
pub(super) enum Values<'a> {
    Whole(&'a [i64]),
    Text(&'a [String]),
    Real(&'a [f64]),
}

pub(super) struct ParquetTable<W: Write + Send>(SerializedFileWriter<W>);

impl<W: Write + Send> ParquetTable<W> {
    /// So many rows make a group.
    pub(super) const ROWS: usize = 1 << 18;

    pub(super) fn new(out: W, name: &str, columns: &[(&str, Column)]) -> io::Result<Self> {
        let fields = columns.iter().map(|&(name, column)| {
            let (physical, converted, logical) = match column {
                Column::Whole => (PhysicalType::INT64, ConvertedType::NONE, None),
                Column::Text => (PhysicalType::BYTE_ARRAY, ConvertedType::UTF8, Some(LogicalType::String)),
                Column::Real => (PhysicalType::DOUBLE, ConvertedType::NONE, None),
            };
            let field = Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED);
            field.with_converted_type(converted).with_logical_type(logical).build().map(Arc::new)
        });
        let fields = fields.collect::<Result<Vec<_>, _>>().map_err(failed)?;
        let schema = Type::group_type_builder(name).with_fields(fields).build().map_err(failed)?;
        let properties = WriterProperties::builder().set_created_by("nusselt".to_owned()).build();
        SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties)).map(Self).map_err(failed)
    }

    /// Writes a group of rows: a slice for each of the columns, all of one length.
    pub(super) fn write(&mut self, values: &[Values<'_>]) -> io::Result<()> {
        self.try_to_write(values).map_err(failed)
    }

    fn try_to_write(&mut self, values: &[Values<'_>]) -> Result<(), ParquetError> {
        let mut group = self.0.next_row_group()?;
        for values in values {
            let Some(mut column) = group.next_column()? else { break };
            match values {
                Values::Whole(cells) => column.typed::<Int64Type>().write_batch(cells, None, None)?,
                Values::Real(cells) => column.typed::<DoubleType>().write_batch(cells, None, None)?,
                Values::Text(cells) => {
                    let cells: Vec<ByteArray> = cells.iter().map(|cell| cell.as_str().into()).collect();
                    column.typed::<ByteArrayType>().write_batch(&cells, None, None)?
                }
            };
            column.close()?;
        }
        group.close()?;
        Ok(())
    }

    pub(super) fn finish(self) -> io::Result<W> {
        self.0.into_inner().map_err(failed)
    }
}

fn failed(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(source) => *source,
            Err(source) => io::Error::other(source),
        },
        error => io::Error::other(error),
    }
}
