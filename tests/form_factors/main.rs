//! Form factors between patches, against references that share nothing with how they are computed.

mod cases;
#[path = "../../examples/form_factors/city.rs"]
mod city;
mod closed_forms;
mod far;
mod hidden;
mod meshes;
mod reciprocal;
mod references;
mod rows;
mod slits;

use nusselt::factors::{Exchange, ExchangeOptions, PatchPlan, Row};
use nusselt::scene::Scene;

const TOLERANCES: [f64; 3] = [1e-4, 1e-6, 1e-8];

fn exchange(scene: &Scene, plan: PatchPlan, tolerance: f64) -> Exchange {
    Exchange::new(scene, plan, ExchangeOptions { tolerance, ..ExchangeOptions::default() }).expect("sound options")
}

fn all_rows(exchange: &Exchange) -> Vec<Row> {
    (0..exchange.patches().len()).map(|patch| exchange.row(patch).expect("a row")).collect()
}

fn factor(row: &Row, column: u32) -> f64 {
    row.entries.iter().find(|entry| entry.column == column).map_or(0.0, |entry| entry.share.factor)
}
