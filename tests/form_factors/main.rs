//! Form factors between patches, against references that share nothing with how they are computed.

mod closed_forms;
mod hidden;
mod meshes;
mod references;
mod rows;
#[path = "../../examples/form_factors/scenes.rs"]
mod scenes;

use nusselt::factors::{Exchange, ExchangeOptions, PatchPlan, Row};
use nusselt::scene::{Material, Scene};

const TOLERANCES: [f64; 3] = [1e-4, 1e-6, 1e-8];

/// A scene of convex polygons given by their corners.
fn scene_of(polygons: &[Vec<[f64; 3]>]) -> Scene {
    let vertices: Vec<[f64; 3]> = polygons.concat();
    let mut next = 0;
    let faces = polygons.iter().map(|polygon| {
        next += polygon.len();
        (next - polygon.len()..next).collect()
    });
    let faces: Vec<Vec<usize>> = faces.collect();
    Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("a sound scene")
}

fn exchange(scene: &Scene, plan: PatchPlan, tolerance: f64) -> Exchange {
    Exchange::new(scene, plan, ExchangeOptions { tolerance, ..ExchangeOptions::default() }).expect("sound options")
}

fn all_rows(exchange: &Exchange) -> Vec<Row> {
    (0..exchange.patches().len()).map(|patch| exchange.row(patch).expect("a row")).collect()
}

fn factor(row: &Row, column: u32) -> f64 {
    row.entries.iter().find(|entry| entry.column == column).map_or(0.0, |entry| entry.share.factor)
}

/// A rectangle with a corner and two sides; its front is on the side of u x v.
fn rectangle(origin: [f64; 3], u: [f64; 3], v: [f64; 3]) -> Vec<[f64; 3]> {
    let at = |s: f64, t: f64| [0, 1, 2].map(|k| origin[k] + s * u[k] + t * v[k]);
    vec![at(0., 0.), at(1., 0.), at(1., 1.), at(0., 1.)]
}

/// The six faces of a box, with fronts inside or outside.
fn cuboid(low: [f64; 3], high: [f64; 3], inside: bool) -> Vec<Vec<[f64; 3]>> {
    let mut faces = Vec::new();
    for axis in 0..3 {
        for (value, is_high) in [(low[axis], false), (high[axis], true)] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |p: f64, q: f64| {
                let mut corner = [value; 3];
                (corner[u], corner[v]) = (p, q);
                corner
            };
            let mut face = vec![
                corner(low[u], low[v]),
                corner(high[u], low[v]),
                corner(high[u], high[v]),
                corner(low[u], high[v]),
            ];
            if is_high == inside {
                face.reverse();
            }
            faces.push(face);
        }
    }
    faces
}
