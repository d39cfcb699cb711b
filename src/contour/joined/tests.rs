//! Joined cells, by labels of several kinds.

use super::Joiner;
use crate::contour::{Cell, ContourImage, Domain, SceneOrder, Viewpoint};
use crate::integral::solid_angle;
use crate::samples::{Kind, generate};
use crate::scene::{PolygonId, Side};
use glam::DVec3;
use std::collections::BTreeMap;

fn images() -> impl Iterator<Item = ContourImage> {
    Kind::ALL.into_iter().flat_map(|kind| (1..4).map(move |seed| (kind, seed))).map(|(kind, seed)| {
        let scene = generate(kind, 1_000, seed).unwrap().to_builder().build().unwrap();
        let eye = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, DVec3::new(0.3, 0.2, 0.0)).unwrap();
        SceneOrder::new(&scene).view(&eye, &Domain::Above).unwrap()
    })
}

/// What cells are joined by.
type By = fn(Cell<'_>) -> Option<u32>;

fn by_polygon(cell: Cell<'_>) -> Option<u32> {
    cell.polygon().map(|polygon| polygon.0)
}

/// Three labels, to test what does not hang on polygons.
fn by_thirds(cell: Cell<'_>) -> Option<u32> {
    by_polygon(cell).map(|polygon| polygon % 3)
}

fn by_lamp(cell: Cell<'_>) -> Option<u32> {
    let is_lit = |polygon| cell.image().scene().polygon(polygon).material().is_emitter();
    by_polygon(cell).filter(|_| cell.polygon().is_some_and(is_lit))
}

#[test]
fn joined_cells_are_convex_and_cover_what_the_cells_do() {
    for (by, most) in [(by_polygon as By, 0.9), (by_thirds, 0.9), (by_lamp, 0.99)] {
        let (mut cells, mut joined) = (0, 0);
        for image in images() {
            let mut joiner = Joiner::new(&image);
            let [mut before, mut after] = [BTreeMap::<u32, f64>::new(), BTreeMap::new()];
            for cell in image.cells() {
                let Some(label) = by(cell) else { continue };
                *before.entry(label).or_default() += cell.solid_angle();
                joiner.add(cell, label);
                cells += 1;
            }
            let polygons = joiner.into_polygons();
            for polygon in &polygons {
                let corners: Vec<DVec3> = polygon.boundary().collect();
                for k in 0..corners.len() {
                    let normal = corners[k].cross(corners[(k + 1) % corners.len()]);
                    // Corners are rounded by 1e-16 or so, each.
                    assert!(corners.iter().all(|c| c.dot(normal) > -4e-16), "{corners:?}");
                }
                *after.entry(polygon.label).or_default() += solid_angle(&corners);
            }
            for (label, area) in &before {
                // Of up to a thousand cells, each rounded.
                assert!((area - after[label]).abs() < 1e-13, "{label}: {area} {}", after[label]);
            }
            joined += polygons.len();
        }
        println!("{joined} of {cells} cells");
        assert!(joined as f64 <= most * cells as f64, "{joined} of {cells}");
    }
}

#[test]
fn whole_hemispheres_are_one() {
    let scene = crate::scene::Scene::builder().build().unwrap();
    let eye = Viewpoint::free(DVec3::ZERO);
    let image = SceneOrder::new(&scene).view(&eye, &Domain::Hemisphere(DVec3::new(0.1, 0.2, 0.9))).unwrap();
    let mut joiner = Joiner::new(&image);
    image.cells().for_each(|cell| joiner.add(cell, ()));
    let polygons = joiner.into_polygons();
    let area: f64 = polygons.iter().map(|polygon| solid_angle(&polygon.boundary().collect::<Vec<_>>())).sum();
    assert!(polygons.len() < image.cell_count() && (area - std::f64::consts::TAU).abs() < 1e-14);
}
