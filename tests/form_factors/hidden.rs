//! Patches with something between.

use super::cases::{cuboid, rectangle, scene_of};
use super::{all_rows, exchange, factor};
use nusselt::factors::PatchPlan;

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
fn exchange_is_the_same_both_ways_where_it_is_integrated() {
    let mut quads = cuboid([0.; 3], [4., 3., 2.5], true);
    quads.extend(cuboid([1.0, 1.2, 0.3], [2.0, 1.9, 1.4], false));
    let scene = scene_of(&quads);
    for tolerance in [1e-4, 1e-6] {
        let exchange = exchange(&scene, PatchPlan::Mesh { longest_edge: 1.1 }, tolerance);
        let rows = all_rows(&exchange);
        let area = |k: usize| exchange.patches()[k].area;
        for (i, row) in rows.iter().enumerate() {
            for entry in &row.entries {
                let j = entry.column as usize;
                let back = factor(&rows[j], i as u32);
                // Each is within the tolerance, twice: what is computed, and what is placed.
                let allowed = 2.0 * tolerance * (area(i) + area(j));
                let off = area(i) * entry.share.factor - area(j) * back;
                assert!(off.abs() <= allowed, "{i} {j}: off by {off:e}, {allowed:e} allowed");
            }
        }
    }
}
