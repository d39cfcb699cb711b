//! The matrix as lines of text.

use super::super::number::Shortest;
use super::rows::{Source, Unwritten};
use super::{BACKGROUND, BACKS};
use crate::factors::Row;
use std::io::{self, Write};

/// Writes rows one by one as the table of [`MatrixFormat::Csv`](super::MatrixFormat::Csv), to wherever that is: standard output, memory. What a
/// [`MatrixWriter`](super::MatrixWriter) offers beyond that needs a file.
///
/// ```
/// use nusselt::factors::{Entry, Row, Share};
/// use nusselt::io::matrix::MatrixCsv;
///
/// let share = |factor| Share { factor, error: 1e-9 };
/// let entries = vec![Entry { column: 4, share: share(0.25) }];
/// let row = Row { patch: 3, entries, backs: share(0.0), background: share(0.75), closure_raw: 1.0 };
/// let mut table = MatrixCsv::new(Vec::new())?;
/// table.row(&row)?;
/// assert_eq!(table.finish()?, b"row,column,factor,error\n3,4,0.25,1e-9\n3,background,0.75,1e-9\n");
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct MatrixCsv<W: Write>(W);

impl<W: Write> MatrixCsv<W> {
    /// Writes the header. `out` should be buffered.
    ///
    /// # Errors
    /// If writing fails.
    pub fn new(mut out: W) -> io::Result<Self> {
        out.write_all(b"row,column,factor,error\n")?;
        Ok(Self(out))
    }

    /// Writes the lines of a row: one for each share that is not zero.
    ///
    /// # Errors
    /// If writing fails.
    pub fn row(&mut self, row: &Row) -> io::Result<()> {
        let (out, patch) = (&mut self.0, row.patch);
        for entry in &row.entries {
            let (factor, error) = (Shortest(entry.share.factor), Shortest(entry.share.error));
            writeln!(out, "{patch},{},{factor},{error}", entry.column)?;
        }
        for (name, share) in [(BACKS, row.backs), (BACKGROUND, row.background)] {
            if share.factor != 0.0 {
                writeln!(out, "{patch},{name},{},{}", Shortest(share.factor), Shortest(share.error))?;
            }
        }
        Ok(())
    }

    /// Gives back what it was written to, flushed.
    ///
    /// # Errors
    /// If writing fails.
    pub fn finish(mut self) -> io::Result<W> {
        self.0.flush()?;
        Ok(self.0)
    }
}

pub(super) fn write(source: &Source, out: &mut impl Write) -> Result<(), Unwritten> {
    let mut table = MatrixCsv::new(out)?;
    source.for_each(|row| table.row(row))
}
