//! Form factors from points as Parquet.

use super::super::parquet::{Column, ParquetTable, Values};
use super::BACKGROUND;
use crate::factors::PointFactors;
use std::io::{self, Write};

pub(super) struct Parquet<W: Write + Send> {
    table: ParquetTable<W>,
    names: Option<Vec<String>>,
    points: Vec<i64>,
    cells: Vec<String>,
    factors: Vec<f64>,
}

impl<W: Write + Send> Parquet<W> {
    pub(super) fn new(out: W, names: Option<&[String]>) -> io::Result<Self> {
        let columns = [("point", Column::Whole), ("name", Column::Text), ("factor", Column::Real)];
        let table = ParquetTable::new(out, "point_factors", &columns)?;
        let names = names.map(<[String]>::to_vec);
        Ok(Self { table, names, points: Vec::new(), cells: Vec::new(), factors: Vec::new() })
    }

    pub(super) fn write(&mut self, point: u64, factors: &PointFactors) -> io::Result<()> {
        for &(index, factor) in &factors.factors {
            let name = self.names.as_ref().map_or_else(|| index.to_string(), |names| names[index as usize].clone());
            self.add(point, name, factor)?;
        }
        if factors.background > 0.0 {
            self.add(point, BACKGROUND.to_owned(), factors.background)?;
        }
        Ok(())
    }

    fn add(&mut self, point: u64, name: String, factor: f64) -> io::Result<()> {
        self.points.push(point as i64);
        self.cells.push(name);
        self.factors.push(factor);
        if self.points.len() == ParquetTable::<W>::ROWS { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        let Self { table, points, cells, factors, .. } = self;
        table.write(&[Values::Whole(points), Values::Text(cells), Values::Real(factors)])?;
        points.clear();
        cells.clear();
        factors.clear();
        Ok(())
    }

    pub(super) fn finish(mut self) -> io::Result<W> {
        if !self.points.is_empty() {
            self.flush()?;
        }
        self.table.finish()
    }
}
