//! The matrix as JSON. The lists come one after the other: the rows are gone through for each.

use super::super::json::{field, rows};
use super::FORM_FACTORS_SCHEMA;
use super::rows::{Source, Unwritten};
use crate::factors::{PatchInfo, PatchShape, Row};
use serde::Serialize;
use std::io::{self, Write};

#[derive(Serialize)]
struct Patch<'a> {
    name: &'a str,
    polygon: u32,
    area: f64,
    center: Option<[f64; 3]>,
    normal: Option<[f64; 3]>,
    /// Of a patch that is one convex piece.
    boundary: Option<Vec<[f64; 3]>>,
}

impl<'a> From<&'a PatchInfo> for Patch<'a> {
    fn from(patch: &'a PatchInfo) -> Self {
        let shape = patch.shape.as_ref();
        let boundary = shape.and_then(PatchShape::boundary);
        Self {
            name: &patch.name,
            polygon: patch.polygon.0,
            area: patch.area,
            center: shape.map(|shape| shape.center.into()),
            normal: shape.and_then(|shape| shape.normal).map(Into::into),
            boundary: boundary.map(|corners| corners.iter().map(|&p| p.into()).collect()),
        }
    }
}

pub(super) fn write<W: Write>(source: &Source, out: &mut W) -> Result<(), Unwritten> {
    writeln!(out, "{{")?;
    field(out, "schema", &FORM_FACTORS_SCHEMA)?;
    rows(out, "patches", &source.patches, |out, patch| Ok(serde_json::to_writer(out, &Patch::from(patch))?))?;
    write!(out, ",\n\"factors\": [")?;
    let mut is_first = true;
    source.for_each(|row| {
        for entry in &row.entries {
            out.write_all(if std::mem::take(&mut is_first) { b"\n" } else { b",\n" })?;
            serde_json::to_writer(&mut *out, &(row.patch, entry.column, entry.share.factor, entry.share.error))?;
        }
        Ok(())
    })?;
    write!(out, "\n]")?;
    list(source, out, "backs", |row| row.backs.factor)?;
    list(source, out, "background", |row| row.background.factor)?;
    list(source, out, "row_sums", Row::sum)?;
    list(source, out, "closure_raw", |row| row.closure_raw)?;
    Ok(write!(out, "\n}}\n")?)
}

/// A number for each row.
fn list(source: &Source, out: &mut impl Write, name: &str, of: impl Fn(&Row) -> f64) -> Result<(), Unwritten> {
    write!(out, ",\n\"{name}\": [")?;
    source.for_each(|row| {
        if row.patch > 0 {
            out.write_all(b", ")?;
        }
        // A sum of nothing is -0.
        serde_json::to_writer(&mut *out, &(of(row) + 0.0)).map_err(io::Error::from)
    })?;
    Ok(write!(out, "]")?)
}
