//! The matrix as lines of text.

use super::super::number::Shortest;
use super::rows::{Source, Unwritten};
use super::{BACKGROUND, BACKS};
use std::io::Write;

pub(super) fn write(source: &Source, out: &mut impl Write) -> Result<(), Unwritten> {
    out.write_all(b"row,column,factor,error\n")?;
    source.for_each(|row| {
        let patch = row.patch;
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
    })
}
