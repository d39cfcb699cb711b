//! Patches whose factors are known.

use super::cases::{all, cuboid, ring, scene_of};
use super::references::{graded, lambert, mean, opposed, perpendicular};
use super::{TOLERANCES, all_rows, exchange, factor};
use glam::DVec3;
use nusselt::factors::PatchPlan;
use std::f64::consts::PI;

#[test]
fn known_factors_are_met_to_every_tolerance_both_ways() {
    for case in all() {
        for tolerance in TOLERANCES {
            let exchange = exchange(&case.scene, PatchPlan::Polygons, tolerance);
            let rows = all_rows(&exchange);
            let area = |patch: usize| exchange.patches()[patch].area;
            let there = case.of(&rows[case.row]);
            let name = &case.name;
            let off = (there - case.reference).abs();
            assert!(off <= case.allowed(tolerance), "{name}, {tolerance:e}: {there} not {}", case.reference);
            // What comes back from each, and how much of it may be wrong.
            let columns = || case.columns.clone().map(|column| column as usize);
            let back: f64 = columns().map(|column| area(column) * factor(&rows[column], case.row as u32)).sum();
            let allowed: f64 = columns().map(|column| area(column) * tolerance).sum();
            let off = (back - area(case.row) * case.reference).abs();
            assert!(off <= allowed, "{name}, {tolerance:e}: {off:e} of {allowed:e} back");
            for row in &rows {
                assert!((row.sum() - 1.0).abs() <= 1e-12, "{name}: {row:?}");
                assert!(row.entries.iter().all(|entry| entry.share.error <= tolerance), "{name}: {row:?}");
            }
        }
    }
}

#[test]
fn graded_cubature_meets_the_closed_form() {
    let target = [[0., 0., 0.], [0., 0., 0.8], [0., 1.5, 0.8], [0., 1.5, 0.]].map(DVec3::from);
    let places = graded();
    let found = mean(&places, &places, |u, v| lambert(DVec3::new(u, 1.5 * v, 0.0), DVec3::Z, &target).abs());
    assert!((found - perpendicular(1.0, 0.8, 1.5)).abs() < 1e-13);
}

#[test]
fn a_tetrahedron_shares_alike_and_a_cube_as_the_catalogue_says() {
    let corners = [[1., 1., 1.], [1., -1., -1.], [-1., 1., -1.], [-1., -1., 1.]];
    let face = |a: usize, b: usize, c: usize| vec![corners[a], corners[b], corners[c]];
    // Fronts inside.
    let tetrahedron = [face(0, 2, 1), face(0, 1, 3), face(0, 3, 2), face(1, 2, 3)];
    let cube = cuboid([0.; 3], [2.; 3], true);
    for tolerance in TOLERANCES {
        for (i, row) in all_rows(&exchange(&scene_of(&tetrahedron), PatchPlan::Polygons, tolerance)).iter().enumerate()
        {
            for j in 0..4 {
                let expected = if i == j { 0.0 } else { 1.0 / 3.0 };
                assert!((factor(row, j as u32) - expected).abs() <= tolerance, "{i} {j} {row:?}");
            }
        }
        for (i, row) in all_rows(&exchange(&scene_of(&cube), PatchPlan::Polygons, tolerance)).iter().enumerate() {
            for j in 0..6 {
                let expected = match (i == j, i / 2 == j / 2) {
                    (true, _) => 0.0,
                    (false, true) => opposed(1.0, 1.0, 1.0),
                    (false, false) => perpendicular(1.0, 1.0, 1.0),
                };
                assert!((factor(row, j as u32) - expected).abs() <= tolerance, "{i} {j} {row:?}");
            }
        }
    }
}

/// Coaxial discs of these radii at distance c (C-41).
fn discs(r1: f64, r2: f64, c: f64) -> f64 {
    let (a, b) = (r1 / c, r2 / c);
    let x = 1.0 + (1.0 + b * b) / (a * a);
    0.5 * (x - (x * x - 4.0 * (b / a) * (b / a)).sqrt())
}

#[test]
fn polygons_with_many_corners_approach_discs() {
    // Regular polygons of the discs' areas: what is left is of the fourth order in the angle between corners, at most its square.
    for (r1, r2, c) in [(1.0, 1.0, 1.0), (0.5, 2.0, 1.0), (1.0, 0.3, 0.4)] {
        let expected = discs(r1, r2, c);
        let off = |n: usize| {
            let polygons = [ring(n, r1, 0.0, true), ring(n, r2, c, false)];
            let rows = all_rows(&exchange(&scene_of(&polygons), PatchPlan::Polygons, 1e-10));
            (factor(&rows[0], 1) - expected).abs()
        };
        let (coarse, fine) = (off(16), off(48));
        assert!(fine < coarse / 8.0 && fine < (PI / 48.0).powi(2) * expected, "{coarse:e} {fine:e}");
    }
}

#[test]
fn a_cube_in_a_cube_gets_its_share_of_the_area() {
    let mut polygons = cuboid([0.; 3], [3.; 3], true);
    polygons.extend(cuboid([1.; 3], [2.; 3], false));
    let scene = scene_of(&polygons);
    for tolerance in TOLERANCES {
        let rows = all_rows(&exchange(&scene, PatchPlan::Polygons, tolerance));
        let sum =
            |row: usize, columns: std::ops::Range<u32>| columns.map(|column| factor(&rows[row], column)).sum::<f64>();
        // All that leaves the inner one arrives at the outer one; and by symmetry each outer face sees a sixth of what that exchanges.
        for inner in 6..12 {
            assert!((sum(inner, 0..6) - 1.0).abs() <= 1e-12);
        }
        for outer in 0..6 {
            assert!((sum(outer, 6..12) - 1.0 / 9.0).abs() <= 6.0 * tolerance, "{tolerance:e}: {}", sum(outer, 6..12));
        }
    }
}
