//! The matrix as a table of Parquet.

use super::super::parquet::{Column, ParquetTable, Values};
use super::rows::{Source, Unwritten};
use super::{BACKGROUND, BACKS};
use crate::factors::Share;
use std::io::{self, Write};

pub(super) fn write<W: Write + Send>(source: &Source, out: &mut W) -> Result<(), Unwritten> {
    let mut rows = Waiting::new(out)?;
    source.for_each(|row| {
        for entry in &row.entries {
            rows.add(row.patch, entry.column.to_string(), entry.share)?;
        }
        for (name, share) in [(BACKS, row.backs), (BACKGROUND, row.background)] {
            if share.factor != 0.0 {
                rows.add(row.patch, name.to_owned(), share)?;
            }
        }
        Ok(())
    })?;
    rows.flush()?;
    rows.table.finish()?.flush()?;
    Ok(())
}

/// Rows of the table that are not written yet.
struct Waiting<W: Write + Send> {
    table: ParquetTable<W>,
    rows: Vec<i64>,
    columns: Vec<String>,
    factors: Vec<f64>,
    errors: Vec<f64>,
}

impl<W: Write + Send> Waiting<W> {
    fn new(out: W) -> io::Result<Self> {
        let columns =
            [("row", Column::Whole), ("column", Column::Text), ("factor", Column::Real), ("error", Column::Real)];
        let table = ParquetTable::new(out, "form_factors", &columns)?;
        Ok(Self { table, rows: Vec::new(), columns: Vec::new(), factors: Vec::new(), errors: Vec::new() })
    }

    fn add(&mut self, row: u32, column: String, share: Share) -> io::Result<()> {
        self.rows.push(i64::from(row));
        self.columns.push(column);
        self.factors.push(share.factor);
        self.errors.push(share.error);
        if self.rows.len() == ParquetTable::<W>::ROWS { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.rows.is_empty() {
            return Ok(());
        }
        let Self { table, rows, columns, factors, errors } = self;
        let values = [Values::Whole(rows), Values::Text(columns), Values::Real(factors), Values::Real(errors)];
        table.write(&values)?;
        rows.clear();
        columns.clear();
        factors.clear();
        errors.clear();
        Ok(())
    }
}
