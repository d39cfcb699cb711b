//! The matrix in the exchange format of Matrix Market (Boisvert, Pozo and Remington 1996). Its header has the number of entries: the rows are
//! gone through twice.

use super::super::number::Shortest;
use super::rows::{Source, Unwritten};
use crate::factors::Row;
use std::io::Write;

pub(super) fn write(source: &Source, out: &mut impl Write) -> Result<(), Unwritten> {
    let count = source.patches.len() as u64;
    let mut entries = 0u64;
    source.for_each(|row| {
        entries += row.entries.len() as u64 + last(row, count).count() as u64;
        Ok(())
    })?;
    writeln!(out, "%%MatrixMarket matrix coordinate real general")?;
    writeln!(out, "% form factors; the last two columns are those to backs and to the background")?;
    writeln!(out, "{count} {} {entries}", count + 2)?;
    source.for_each(|row| {
        let number = u64::from(row.patch) + 1;
        for entry in &row.entries {
            writeln!(out, "{number} {} {}", u64::from(entry.column) + 1, Shortest(entry.share.factor))?;
        }
        last(row, count).try_for_each(|(column, factor)| writeln!(out, "{number} {column} {}", Shortest(factor)))
    })
}

/// Those of the last two columns that are not zero.
fn last(row: &Row, count: u64) -> impl Iterator<Item = (u64, f64)> {
    let both = [(count + 1, row.backs.factor), (count + 2, row.background.factor)];
    both.into_iter().filter(|(_, factor)| *factor != 0.0)
}
