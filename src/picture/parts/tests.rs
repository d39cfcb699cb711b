//! What pixels have in them, by another formula.

use super::*;
use crate::contour::{Frustum, SceneOrder, Viewpoint};
use crate::picture::Coverage;
use crate::samples::{Kind, generate};
use crate::scene::Scene;

fn image(scene: &Scene, eye: DVec3, towards: DVec3, degrees: f64, aspect: f64) -> ContourImage {
    let camera = Frustum::new(towards, DVec3::Z, degrees, aspect).unwrap();
    SceneOrder::new(scene).view(&Viewpoint::free(eye), &Domain::Frustum(camera)).unwrap()
}

#[test]
fn areas_are_those_of_coverage_and_sum_to_one_whatever_the_tiles() {
    let scene = generate(Kind::Room, 500, 3).unwrap().to_builder().build().unwrap();
    let image = image(&scene, DVec3::new(0.3, 0.4, 1.6), DVec3::new(1.0, 0.6, -0.3), 70.0, 1.5);
    let size = UVec2::new(45, 30);
    let parts = PixelParts::new(&image, size).unwrap().unwrap();
    let mut whole = Vec::new();
    parts.tile(UVec2::ZERO, size, |x, y, parts| whole.push((x, y, parts.to_vec())));
    assert_eq!(whole.len(), 45 * 30);
    for (x, y, parts) in &whole {
        let sum: f64 = parts.iter().map(|part| part.area).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{x} {y}: {sum}");
    }
    // The same in other tiles, to the last bit.
    for (low, high) in [([7, 3], [20, 30]), ([0, 13], [45, 14]), ([44, 29], [45, 30]), ([40, 25], [900, 900])] {
        parts.tile(low.into(), high.into(), |x, y, parts| assert_eq!(whole[(y * 45 + x) as usize].2, parts));
    }
    // By another formula: with the edges of each cell instead of cutting them.
    let mut coverage = Coverage::new(size);
    for polygon in (0..scene.polygon_count() as u32).map(PolygonId) {
        coverage.clear();
        for (k, cell) in image.cells().enumerate() {
            if cell.polygon() == Some(polygon) {
                let mut ring = parts.corners[parts.starts[k]..parts.starts[k + 1]].to_vec();
                let doubled: f64 = (0..ring.len()).map(|k| ring[k].perp_dot(ring[(k + 1) % ring.len()])).sum();
                if doubled < 0.0 {
                    ring.reverse();
                }
                coverage.add_ring(&ring);
            }
        }
        coverage.for_each(|x, y, area| {
            let parts = &whole[(y * 45 + x) as usize].2;
            let found: f64 = parts.iter().filter(|part| part.polygon == Some(polygon)).map(|part| part.area).sum();
            assert!((found - area).abs() < 1e-12, "{polygon} {x} {y}: {found} {area}");
        });
    }
}

#[test]
fn directions_show_the_polygon_whose_part_they_stand_for() {
    let scene = generate(Kind::Room, 800, 5).unwrap().to_builder().build().unwrap();
    let image = image(&scene, DVec3::new(0.3, 0.4, 1.6), DVec3::new(1.0, 0.7, -0.2), 60.0, 1.0);
    // Large pixels, so that many parts are not convex.
    let size = UVec2::new(9, 9);
    let parts = PixelParts::new(&image, size).unwrap().unwrap();
    let mut seen = 0;
    parts.tile(UVec2::ZERO, size, |x, y, parts| {
        for part in parts.iter().filter(|part| part.area > 1e-9) {
            let regions = image.locate(part.direction).regions();
            let shows = |region: &Region| match *region {
                Region::Cell(cell) => image.cell(cell).polygon() == part.polygon,
                Region::Outside => false,
            };
            assert!(regions.iter().any(shows), "{x} {y} {part:?}");
            assert_eq!(image.cell(part.cell).polygon(), part.polygon);
            seen += 1;
        }
    });
    assert!(seen > 300, "{seen}");
}
