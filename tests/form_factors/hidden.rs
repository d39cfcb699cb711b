//! Patches with something between.

use super::cases::{cuboid, rectangle, scene_of};
use super::{all_rows, city, exchange, factor};
use glam::DVec3;
use nusselt::factors::PatchPlan;
use std::f64::consts::PI;

#[test]
fn a_plate_as_large_as_the_shaft_hides_all() {
    let below = rectangle([0.; 3], [1., 0., 0.], [0., 1., 0.]);
    let above = rectangle([0., 0., 2.], [0., 1., 0.], [1., 0., 0.]);
    let between = rectangle([0., 0., 1.], [0., 1., 0.], [1., 0., 0.]);
    let rows = all_rows(&exchange(&scene_of(&[below, above, between]), PatchPlan::Polygons, 1e-6));
    assert!(factor(&rows[0], 1) <= 0.0);
    assert!(factor(&rows[1], 0) <= 0.0);
    // The receiver's light from below is on the back of the plate.
    assert!((rows[1].backs.factor - super::references::opposed(1.0, 1.0, 1.0)).abs() < 1e-6);
}

#[test]
fn exchange_is_the_same_by_points_on_either_patch() {
    let mut quads = cuboid([0.; 3], [4., 3., 2.5], true);
    quads.extend(cuboid([1.0, 1.2, 0.3], [2.0, 1.9, 1.4], false));
    let scene = scene_of(&quads);
    for tolerance in [1e-4, 1e-6] {
        let exchange = exchange(&scene, PatchPlan::Mesh { longest_edge: 1.1 }, tolerance);
        let area = |k: usize| exchange.patches()[k].area;
        let mut checked = 0;
        for (i, row) in all_rows(&exchange).iter().enumerate() {
            for entry in &row.entries {
                let j = entry.column as usize;
                let [there, back] =
                    [(i, j), (j, i)].map(|(from, to)| exchange.by_points(from, to).expect("patches").map(|s| s.factor));
                let (Some(there), Some(back)) = (there, back) else { continue };
                checked += 1;
                // By points on either each is within half the tolerance.
                let allowed = 0.5 * tolerance * (area(i) + area(j));
                let off = area(i) * there - area(j) * back;
                assert!(off.abs() <= allowed, "{i} {j}: off by {off:e}, {allowed:e} allowed");
                // What is in the row is, too, and half of it may have been placed.
                let off = entry.share.factor - there;
                assert!(off.abs() <= 1.5 * tolerance, "{i} {j}: off by {off:e}");
            }
        }
        assert!(checked > 1000, "{checked}");
    }
}

/// The factor from the unit square below to the one above it at height 1, by rays from 40^2 places to 43^2, those through a plate left out.
fn by_rays(plates: &[Vec<[f64; 3]>]) -> f64 {
    // Not the same number, or rays would pass planes between in a grid.
    const COUNTS: [usize; 2] = [40, 43];
    let places = |count: usize| (0..count).map(move |k| (k as f64 + 0.5) / count as f64);
    let squared = |count: usize| places(count).flat_map(move |u| places(count).map(move |v| (u, v)));
    let plates: Vec<Vec<DVec3>> = plates.iter().map(|plate| plate.iter().map(|&p| p.into()).collect()).collect();
    let is_hit = |x: DVec3, y: DVec3, plate: &[DVec3]| {
        let normal = (plate[1] - plate[0]).cross(plate[2] - plate[1]);
        let (from, to) = (normal.dot(x - plate[0]), normal.dot(y - plate[0]));
        let p = x + (y - x) * (from / (from - to));
        let side = |k: usize| normal.dot((plate[(k + 1) % plate.len()] - plate[k]).cross(p - plate[k]));
        from * to < 0.0 && (0..plate.len()).all(|k| side(k) >= 0.0)
    };
    let mut sum = 0.0;
    for (x, y) in squared(COUNTS[0]).flat_map(|x| squared(COUNTS[1]).map(move |y| (x, y))) {
        let (x, y) = (DVec3::new(x.0, x.1, 0.0), DVec3::new(y.0, y.1, 1.0));
        if !plates.iter().any(|plate| is_hit(x, y, plate)) {
            sum += 1.0 / (PI * x.distance_squared(y).powi(2));
        }
    }
    sum / COUNTS.map(|count| (count * count) as f64).iter().product::<f64>()
}

#[test]
fn what_several_plates_leave_is_what_rays_find() {
    let level = |[x, y]: [f64; 2], [a, b]: [f64; 2], z: f64| rectangle([x, y, z], [a, 0., 0.], [0., b, 0.]);
    let cases = [
        // At two heights, overlapping in some views.
        vec![level([0.0, 0.0], [0.513, 0.487], 0.47), level([0.4, 0.2], [0.6, 0.5], 0.3)],
        // On the floor, touching the ceiling with a corner, and each other along an edge.
        vec![
            rectangle([0.53, 0.2, 0.0], [0., 0.6, 0.], [0., 0., 0.6]),
            rectangle([0.53, 0.2, 0.6], [0., 0.6, 0.], [0.3, 0., 0.]),
            vec![[0.2, 0.1, 0.5], [0.3, 0.9, 0.6], [0.1, 0.5, 1.0]],
        ],
        // Next to each other in one plane, and one along a side of the floor.
        vec![
            level([0.1, 0.1], [0.4, 0.3], 0.4),
            level([0.5, 0.1], [0.2, 0.3], 0.4),
            rectangle([0.0, 0.0, 0.0], [1.0, 0., 0.], [0., 0., 0.7]),
        ],
        // In a corner: from most points all is seen.
        vec![level([0.0, 0.0], [0.15, 0.1], 0.05), level([0.85, 0.9], [0.15, 0.1], 0.9)],
    ];
    for (number, plates) in cases.into_iter().enumerate() {
        let expected = by_rays(&plates);
        let mut polygons = vec![level([0.0; 2], [1.0; 2], 0.0), rectangle([0., 0., 1.], [0., 1., 0.], [1., 0., 0.])];
        polygons.extend(plates);
        let tolerance = 1e-5;
        let exchange = exchange(&scene_of(&polygons), PatchPlan::Polygons, tolerance);
        let there = factor(&exchange.row(0).expect("a row"), 1);
        let back = exchange.by_points(1, 0).expect("patches").expect("no views are needed").factor;
        // Rays are told by chance in a layer as thick as a step of the grids along every edge of a shadow: the worst is 2.7e-4 off.
        assert!((there - expected).abs() <= 5e-4, "{number}: {there} instead of {expected}");
        // The entry is within the tolerance, and what points on the other square give within half of it.
        assert!((there - back).abs() <= 1.5 * tolerance, "{number}: {there} {back}");
    }
}

#[test]
fn shadows_between_the_points_of_a_rule_are_not_missed() {
    let scene = city::city(4).expect("a city");
    let [coarse, fine] = [1e-4, 1e-6].map(|tolerance| exchange(&scene, PatchPlan::Polygons, tolerance));
    // Much of what row 59 sees is small, and seen from a small part of it.
    for patch in [33, 59, 141, 162, 165] {
        let [row, reference] = [&coarse, &fine].map(|exchange| exchange.row(patch).expect("a row"));
        for column in 0..coarse.patches().len() as u32 {
            let (found, expected) = (factor(&row, column), factor(&reference, column));
            assert!((found - expected).abs() <= 1e-4, "{patch} {column}: {found} instead of {expected}");
        }
    }
}
