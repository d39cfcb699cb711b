//! Form factors from points as JSON.

use super::super::json::field;
use super::POINT_FACTORS_SCHEMA;
use crate::factors::{By, PointFactors};
use crate::scene::{PolygonRef, Scene};
use glam::DVec3;
use serde::Serialize;
use std::io::{self, Write};

#[derive(Serialize)]
struct Row<'a> {
    point: [f64; 3],
    normal: [f64; 3],
    on: Option<u32>,
    factors: &'a [(u32, f64)],
    background: f64,
}

/// All that comes before the points. A polygon has the name of its object.
pub(super) fn start(out: &mut impl Write, scene: &Scene, by: By) -> io::Result<()> {
    writeln!(out, "{{")?;
    field(out, "schema", &POINT_FACTORS_SCHEMA)?;
    field(out, "by", &by.name())?;
    match by {
        By::Object => field(out, "names", &scene.objects())?,
        By::Polygon => {
            field(out, "names", &scene.polygons().map(PolygonRef::object_name).collect::<Vec<_>>())?;
        }
    }
    write!(out, "\"points\": [")
}

pub(super) fn write(
    out: &mut impl Write,
    number: u64,
    point: DVec3,
    normal: DVec3,
    factors: &PointFactors,
) -> io::Result<()> {
    out.write_all(if number == 0 { b"\n" } else { b",\n" })?;
    let PointFactors { on, factors, background } = factors;
    let on = on.map(|polygon| polygon.0);
    let row = Row { point: point.to_array(), normal: normal.to_array(), on, factors, background: *background };
    Ok(serde_json::to_writer(out, &row)?)
}

pub(super) fn finish(out: &mut impl Write, count: u64) -> io::Result<()> {
    out.write_all(if count == 0 { b"]\n}\n" } else { b"\n]\n}\n" })
}
