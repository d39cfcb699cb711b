//! Form factors from points as lines of text.

use super::super::number::Shortest;
use super::super::quoted::quoted;
use super::BACKGROUND;
use crate::factors::PointFactors;
use std::io::{self, Write};

pub(super) struct Csv<W> {
    out: W,
    /// Of the objects, as they are written.
    names: Option<Vec<String>>,
}

impl<W: Write> Csv<W> {
    pub(super) fn new(mut out: W, names: Option<&[String]>) -> io::Result<Self> {
        out.write_all(b"point,name,factor\n")?;
        Ok(Self { out, names: names.map(|names| names.iter().map(|name| quoted(name).into_owned()).collect()) })
    }

    pub(super) fn write(&mut self, point: u64, factors: &PointFactors) -> io::Result<()> {
        let Self { out, names } = self;
        for &(index, factor) in &factors.factors {
            let factor = Shortest(factor);
            match names {
                Some(names) => writeln!(out, "{point},{},{factor}", names[index as usize])?,
                None => writeln!(out, "{point},{index},{factor}")?,
            }
        }
        if factors.background > 0.0 {
            writeln!(out, "{point},{BACKGROUND},{}", Shortest(factors.background))?;
        }
        Ok(())
    }

    pub(super) fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }

    pub(super) fn finish(self) -> W {
        self.out
    }
}
