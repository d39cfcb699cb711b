//! Keeping the evidence of a contour image.

use super::CERTIFICATE_SCHEMA;
use super::rows::{DomainRow, SceneSize, SliverRow, SplitterRow};
use crate::exact::Sign;
use crate::io::json::{field, rows};
use crate::scene::Scene;
use crate::verify::{Evidence, HalfSphere};
use serde::Serialize;
use std::io::{self, BufWriter, Write};

#[derive(Serialize)]
struct CellRow<'a> {
    piece: Option<u32>,
    sides: &'a [i64],
}

/// A splitter, counted from 1, with the sign that directions inside have.
fn signed(side: HalfSphere) -> i64 {
    let number = i64::from(side.splitter) + 1;
    if side.inside == Sign::Negative { -number } else { number }
}

/// Writes the evidence of an image of the scene, a cell and a splitter a line. It is written as it is
/// made up: memory does not grow with the number of cells.
///
/// ```
/// # use nusselt::bsp::{BspOptions, SceneBsp};
/// # use nusselt::contour::{Domain, Viewpoint};
/// use nusselt::io::{KeptCertificate, write_certificate};
/// let scene = nusselt::samples::cornell_box().to_builder().build()?;
/// let bsp = SceneBsp::build(&scene, &BspOptions::default())?;
/// let image = bsp.view(&Viewpoint::free(glam::DVec3::new(278.0, 273.0, 1.0)), &Domain::Sphere)?;
/// let mut file = Vec::new();
/// write_certificate(&image.evidence(), &scene, &mut file)?;
/// let kept = KeptCertificate::from_json(&file, "kept.json")?;
/// kept.fit(&scene, "kept.json")?;
/// kept.evidence.check(&scene, nusselt::verify::Arithmetic::Kernel)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of `out`.
pub fn write_certificate(evidence: &Evidence, scene: &Scene, out: impl Write) -> io::Result<()> {
    let mut out = BufWriter::new(out);
    write!(out, "{{")?;
    field(&mut out, "schema", &CERTIFICATE_SCHEMA)?;
    field(&mut out, "scene", &SceneSize::of(scene))?;
    field(&mut out, "eye", &evidence.eye.to_array())?;
    field(&mut out, "domain", &DomainRow::from(&evidence.domain))?;
    field(&mut out, "epsilon", &evidence.epsilon)?;
    rows(&mut out, "slivers", &evidence.slivers, |out, &sliver| {
        Ok(serde_json::to_writer(out, &SliverRow::from(sliver))?)
    })?;
    writeln!(out, ",")?;
    rows(&mut out, "splitters", &evidence.splitters, |out, &splitter| {
        Ok(serde_json::to_writer(out, &SplitterRow::from(splitter))?)
    })?;
    writeln!(out, ",")?;
    let mut sides = Vec::new();
    rows(&mut out, "cells", &evidence.cells, |out, cell| {
        sides.clear();
        sides.extend(cell.sides.iter().copied().map(signed));
        Ok(serde_json::to_writer(out, &CellRow { piece: cell.piece.map(|id| id.0), sides: &sides })?)
    })?;
    writeln!(out, "}}")?;
    out.flush()
}
