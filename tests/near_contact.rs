//! Furniture a millimetre from walls and floors: what is seen past it changes from one point to the next, all at once. Against brute force: 1e8 and more pairs of points, in strata between the lines where that happens, by a program of
//! its own that shares nothing with this crate; its digits are those that two finer divisions have in common.

mod common;

use common::Faces;
use glam::{DQuat, DVec3};
use nusselt::factors::{Exchange, ExchangeOptions, PatchPlan, Row};
use nusselt::scene::Scene;

/// Tiles of a rectangle that begins at `from` and goes on along two sides, its front where they turn counter-clockwise; so many along each.
fn tiled(faces: &mut Faces, from: DVec3, [along, across]: [DVec3; 2], [columns, rows]: [usize; 2]) {
    let corner = |i: usize, j: usize| from + along * (i as f64 / columns as f64) + across * (j as f64 / rows as f64);
    for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
        faces.face(&[corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
    }
}

/// A room of that size with a box in it: the floor in tiles, then the wall at y = 0, that at x = 0, the ceiling, and the others, each by places along its first side, then along its second, and the box.
fn room(size: DVec3, floor: [usize; 2], walls: [usize; 2], [low, high]: [[f64; 3]; 2]) -> Scene {
    let [x, y, z] = [DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z];
    let mut faces = Faces::default();
    tiled(&mut faces, DVec3::ZERO, [x, y], floor);
    tiled(&mut faces, DVec3::ZERO, [z, x], walls);
    tiled(&mut faces, DVec3::ZERO, [y, z], walls);
    tiled(&mut faces, z, [y, x], walls);
    tiled(&mut faces, y, [x, z], walls);
    tiled(&mut faces, x, [z, y], walls);
    let [low, high] = [low, high].map(DVec3::from);
    faces.cuboid((low + high) * 0.5, (high - low) * 0.5, DQuat::IDENTITY, false);
    faces.build()
}

fn exchange(scene: &Scene, tolerance: f64) -> Exchange {
    let options = ExchangeOptions { tolerance, ..ExchangeOptions::default() };
    Exchange::new(scene, PatchPlan::Polygons, options).expect("patches")
}

fn factor(row: &Row, column: u32) -> f64 {
    row.entries.iter().find(|entry| entry.column == column).map_or(0.0, |entry| entry.share.factor)
}

#[test]
fn what_is_seen_past_a_box_near_a_wall_is_right() {
    let (large, cube) = (DVec3::new(4.0, 3.0, 2.5), DVec3::splat(3.0));
    let cases = [
        // The lower tile of a wall, to the floor through a slot of 1 mm: the box stands on that.
        (large, [1; 2], [2; 2], [[0.002, 0.001, 0.0], [3.129, 1.209, 0.953]], 1, 0, 4.0155e-4),
        // All in tiles; one at the height of the box's top, to the floor's in the corner.
        (cube, [3; 2], [3; 2], [[0.02, 0.129, 0.0], [0.69, 1.521, 1.394]], 19, 0, 7.0395e-4),
        // Lifted by 1 mm: the other lower tile of the wall at x = 0.
        (large, [1; 2], [2; 2], [[0.002, 0.005, 0.001], [3.017, 1.692, 0.679]], 7, 0, 0.221_068_1),
        // An upper tile, to that of the ceiling above it.
        (large, [1; 2], [2; 2], [[0.002, 0.633, 0.0], [0.478, 2.782, 1.411]], 8, 11, 0.227_302_5),
    ];
    for (size, floor, walls, block, from, to, expected) in cases {
        let scene = room(size, floor, walls, block);
        let tolerance = 1e-4;
        let exchange = exchange(&scene, tolerance);
        let areas = [from, to].map(|patch| exchange.patches()[patch].area);
        let there = factor(&exchange.row(from).expect("a row that closes"), to as u32);
        let back = factor(&exchange.row(to).expect("a row that closes"), from as u32);
        for found in [there, back * areas[1] / areas[0]] {
            assert!((found - expected).abs() <= tolerance, "{block:?}: {from} to {to}: {found} {expected}");
        }
    }
}

#[test]
fn rows_close_where_a_box_is_a_millimetre_from_floor_and_walls() {
    let size = DVec3::new(4.0, 3.0, 2.5);
    for low in [[1.5, 1.0, 0.001], [0.001, 1.0, 0.001], [0.001, 0.001, 0.001], [0.01, 0.01, 0.01], [0.001, 1.0, 0.0]] {
        let high = low.map(|x| x + 1.0);
        let scene = room(size, [1; 2], [1; 2], [low, high]);
        for tolerance in [1e-4, 1e-5, 1e-6] {
            let exchange = exchange(&scene, tolerance);
            let rows: Vec<Row> =
                (0..exchange.patches().len()).map(|patch| exchange.row(patch).expect("a row that closes")).collect();
            for (patch, row) in rows.iter().enumerate() {
                assert!((row.sum() - 1.0).abs() < 1e-12 && row.background.factor < 1e-12, "{low:?} {tolerance:e}");
                for entry in &row.entries {
                    let other = entry.column as usize;
                    let areas = [patch, other].map(|patch| exchange.patches()[patch].area);
                    let back = factor(&rows[other], patch as u32) * areas[1] / areas[0];
                    // Each to the tolerance, and the other one as seen from the smaller of the two.
                    let allowed = tolerance * (1.0 + areas[1] / areas[0]);
                    assert!((entry.share.factor - back).abs() <= allowed, "{low:?} {tolerance:e}: {patch} {other}");
                }
            }
        }
    }
}
