//! JSON that is written as it is made up: memory does not grow with the number of rows.

use serde::Serialize;
use std::io::{self, Write};

/// A field that others follow, on a line of its own.
pub(super) fn field(out: &mut impl Write, name: &str, value: &impl Serialize) -> io::Result<()> {
    write!(out, "\"{name}\": ")?;
    serde_json::to_writer(&mut *out, value)?;
    writeln!(out, ",")
}

/// A list with an item a line, without what follows it.
pub(super) fn rows<W: Write, T>(
    out: &mut W,
    name: &str,
    items: impl IntoIterator<Item = T>,
    mut write_row: impl FnMut(&mut W, T) -> io::Result<()>,
) -> io::Result<()> {
    write!(out, "\"{name}\": [")?;
    for (k, item) in items.into_iter().enumerate() {
        out.write_all(if k == 0 { b"\n" } else { b",\n" })?;
        write_row(out, item)?;
    }
    write!(out, "\n]")
}
