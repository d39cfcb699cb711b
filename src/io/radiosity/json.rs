//! Radiosities as JSON.

use crate::factors::PatchInfo;
use crate::io::json::{field, rows};
use crate::radiosity::{Balance, Solver};
use crate::scene::PolygonId;
use glam::DVec3;
use serde::Serialize;
use std::io::{self, BufWriter, Write};

/// The schema's name.
pub const RADIOSITY_SCHEMA: &str = "nusselt.radiosity/1";

/// What a table of radiosities is made of.
#[derive(Clone, Copy)]
pub struct RadiosityTable<'a> {
    /// The solution.
    pub solver: &'a Solver<'a>,
    /// The patches.
    pub patches: &'a [PatchInfo],
    /// The polygon of the scene that each is part of.
    pub of: &'a [PolygonId],
    /// The middle of each.
    pub centers: &'a [DVec3],
    /// The ambient term of each ([`Solver::ambient`]), if it is to be told; radiosities are without it.
    pub ambient: Option<&'a [DVec3]>,
}

#[derive(Serialize)]
struct PatchRow<'a> {
    name: &'a str,
    polygon: u32,
    area: f64,
    center: [f64; 3],
    emission: [f64; 3],
    reflectance: [f64; 3],
    radiosity: [f64; 3],
    unshot: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    ambient: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct BalanceRow {
    emitted: [f64; 3],
    absorbed: [f64; 3],
    backs: [f64; 3],
    background: [f64; 3],
    unshot: [f64; 3],
    defect: f64,
}

/// Writes all patches with their radiosities, and where the power that is emitted goes.
///
/// # Errors
/// Those of `out`.
pub fn write_radiosity_json(table: &RadiosityTable<'_>, out: impl Write) -> io::Result<()> {
    let mut out = BufWriter::new(out);
    let RadiosityTable { solver, patches, of, centers, ambient } = *table;
    writeln!(out, "{{")?;
    field(&mut out, "schema", &RADIOSITY_SCHEMA)?;
    field(&mut out, "shots", &solver.state().shots)?;
    let balance = solver.balance();
    let Balance { emitted, absorbed, backs, background, unshot, .. } = balance;
    let [emitted, absorbed, backs, background, unshot] =
        [emitted, absorbed, backs, background, unshot].map(|power| power.to_array());
    let row = BalanceRow { emitted, absorbed, backs, background, unshot, defect: balance.defect() };
    field(&mut out, "balance", &row)?;
    rows(&mut out, "patches", 0..patches.len(), |out, k| {
        let row = PatchRow {
            name: &patches[k].name,
            polygon: of[k].0,
            area: patches[k].area,
            center: centers[k].to_array(),
            emission: solver.emission()[k].to_array(),
            reflectance: solver.reflectance()[k].to_array(),
            radiosity: solver.radiosity()[k].to_array(),
            unshot: solver.state().unshot[k].to_array(),
            ambient: ambient.map(|ambient| ambient[k].to_array()),
        };
        serde_json::to_writer(out, &row).map_err(io::Error::from)
    })?;
    writeln!(out, "\n}}")?;
    out.flush()
}
