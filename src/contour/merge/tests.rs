//! Merged cells are convex, and cover what their cells do.

use super::*;
use crate::contour::{Domain, SceneOrder, Viewpoint};
use crate::integral::solid_angle;
use crate::samples::{Kind, generate};
use std::convert::Infallible;
use std::f64::consts::TAU;

fn merged<L: PartialEq>(image: &ContourImage, label: impl Fn(Cell<'_>) -> Option<L>) -> Vec<Merged<L>> {
    let of = |cell: Cell<'_>| Ok::<_, Infallible>(label(cell));
    image.merged(of).unwrap_or_else(|never| match never {})
}

#[test]
fn merged_cells_are_convex_and_cover_what_their_cells_do() {
    let scene = generate(Kind::Room, 1_000, 5).unwrap().to_builder().build().unwrap();
    let order = SceneOrder::new(&scene);
    for domain in [Domain::Sphere, Domain::Hemisphere(DVec3::new(0.3, -0.2, 1.0))] {
        let image = order.view(&Viewpoint::free(DVec3::new(1.9, 1.7, 1.1)), &domain).unwrap();
        let counts = [1, 7, 1_000_000].map(|modulus| {
            let label = |cell: Cell<'_>| cell.polygon().map(|polygon| polygon.0 % modulus);
            let parts = merged(&image, label);
            for part in &parts {
                let corners = &part.boundary;
                assert!(corners.len() > 2);
                for (k, p) in corners.iter().enumerate() {
                    let [q, r] = [1, 2].map(|i| corners[(k + i) % corners.len()]);
                    assert!(p.cross(q).dot(r) > -1e-14, "not convex: {corners:?}");
                    assert!(p.dot(q) > -0.999_999, "an arc of half a circle: {corners:?}");
                }
                assert_eq!(label(image.cell(part.cell)), Some(part.label));
            }
            for wanted in 0..modulus.min(7) {
                let of_parts: f64 =
                    parts.iter().filter(|part| part.label == wanted).map(|part| solid_angle(&part.boundary)).sum();
                let cells = image.cells().filter(|&cell| label(cell) == Some(wanted));
                let of_cells: f64 = cells.map(Cell::solid_angle).sum();
                assert!((of_parts - of_cells).abs() < 1e-12, "{wanted}: {of_parts} {of_cells}");
            }
            parts.len()
        });
        // In a closed room with one label all becomes one, or halves of the sphere.
        assert!(counts[0] <= 8, "{counts:?}");
        assert!(counts[2] < image.cell_count(), "{counts:?} of {}", image.cell_count());
    }
    // What has no label is left out.
    let image = order.view(&Viewpoint::free(DVec3::new(1.9, 1.7, 1.1)), &Domain::Sphere).unwrap();
    assert!(merged(&image, |_| None::<u32>).is_empty());
    let whole: f64 = merged(&image, |_| Some(())).iter().map(|part| solid_angle(&part.boundary)).sum();
    assert!((whole - 2.0 * TAU).abs() < 1e-12);
}
