//! Patches with something between.

use super::references::{lambert, mean};
use super::{TOLERANCES, all_rows, exchange, factor, rectangle, scene_of};
use glam::DVec3;
use nusselt::factors::PatchPlan;

/// A rectangle in a plane of constant z: x from, x to, y from, y to.
type Extent = [f64; 4];

fn corners([x0, x1, y0, y1]: Extent, z: f64) -> Vec<[f64; 3]> {
    rectangle([x0, y0, z], [x1 - x0, 0., 0.], [0., y1 - y0, 0.])
}

fn points(extent: Extent, z: f64) -> Vec<DVec3> {
    corners(extent, z).into_iter().map(DVec3::from).collect()
}

/// From a rectangle at height 0 to one at height `top`, with one at height `middle` between, all parallel to the axes: the shadow from each point
/// is a rectangle again, and it comes over the edges of the receiver where the emitter's points are on known lines.
fn behind_a_plate(from: Extent, blocker: Extent, middle: f64, to: Extent, top: f64) -> f64 {
    let ratio = top / middle;
    let places = |k: usize| {
        let (low, high) = (from[2 * k], from[2 * k + 1]);
        // x + (b - x) ratio = t.
        let crossing = |b: f64, t: f64| (b * ratio - t) / (ratio - 1.0);
        let mut places = vec![low, high];
        for b in &blocker[2 * k..2 * k + 2] {
            places.extend(to[2 * k..2 * k + 2].iter().map(|&t| crossing(*b, t)).filter(|p| (low..high).contains(p)));
        }
        places.sort_by(f64::total_cmp);
        // In four parts each, so that the rule of 10 points has all its digits.
        let quarters = |pair: &[f64]| [0.0, 0.25, 0.5, 0.75].map(|t| pair[0] + (pair[1] - pair[0]) * t);
        let mut fine: Vec<f64> = places.windows(2).flat_map(quarters).collect();
        fine.push(high);
        fine.iter().map(|p| (p - low) / (high - low)).collect::<Vec<f64>>()
    };
    let whole = points(to, top);
    mean(&places(0), &places(1), |u, v| {
        let x = DVec3::new(from[0] + u * (from[1] - from[0]), from[2] + v * (from[3] - from[2]), 0.0);
        let shadow: Extent = std::array::from_fn(|k| {
            let (x, b) = (x[k / 2], blocker[k]);
            (x + (b - x) * ratio).clamp(to[k / 2 * 2], to[k / 2 * 2 + 1])
        });
        let visible = lambert(x, DVec3::Z, &whole) - lambert(x, DVec3::Z, &points(shadow, top));
        visible.abs()
    })
}

#[test]
fn plates_between_parallel_plates_hide_what_their_shadows_cover() {
    let cases: [(Extent, Extent, f64, Extent, f64); 5] = [
        ([0., 1., 0., 1.], [0.2, 0.6, 0.3, 0.9], 0.5, [0., 1., 0., 1.], 1.0),
        ([0., 1., 0., 1.], [0.0, 0.5, 0.0, 1.0], 0.5, [0., 1., 0., 1.], 1.0),
        ([0., 2., 0., 1.], [-1.0, 0.7, 0.4, 3.0], 0.1, [-1., 1., 0.5, 2.], 1.5),
        ([0., 1., 0., 1.], [0.4, 0.6, 0.4, 0.6], 0.9, [0., 1., 0., 1.], 1.0),
        ([0., 1., 0., 1.], [0.49, 0.51, 0.0, 1.0], 0.3, [0., 1., 0., 1.], 0.5),
    ];
    for (from, blocker, middle, to, top) in cases {
        let expected = behind_a_plate(from, blocker, middle, to, top);
        let mut ceiling = corners(to, top);
        ceiling.reverse();
        let mut plate = corners(blocker, middle);
        plate.reverse();
        let scene = scene_of(&[corners(from, 0.0), ceiling, plate]);
        for tolerance in TOLERANCES {
            let row = exchange(&scene, PatchPlan::Polygons, tolerance).row(0).expect("a row");
            let found = factor(&row, 1);
            assert!((found - expected).abs() <= tolerance, "{tolerance:e}: {found} instead of {expected}, {row:?}");
            assert!((row.sum() - 1.0).abs() <= 1e-12);
        }
    }
}

#[test]
fn a_plate_as_large_as_the_shaft_hides_all() {
    let below = rectangle([0.; 3], [1., 0., 0.], [0., 1., 0.]);
    let above = rectangle([0., 0., 2.], [0., 1., 0.], [1., 0., 0.]);
    let between = rectangle([0., 0., 1.], [0., 1., 0.], [1., 0., 0.]);
    let rows = all_rows(&exchange(&scene_of(&[below, above, between]), PatchPlan::Polygons, 1e-6));
    assert_eq!(factor(&rows[0], 1), 0.0);
    assert_eq!(factor(&rows[1], 0), 0.0);
    // The receiver's light from below is on the back of the plate.
    assert!((rows[1].backs.factor - super::references::opposed(1.0, 1.0, 1.0)).abs() < 1e-6);
}

#[test]
fn exchange_is_the_same_both_ways_where_it_is_integrated() {
    let mut quads = super::cuboid([0.; 3], [4., 3., 2.5], true);
    quads.extend(super::cuboid([1.0, 1.2, 0.3], [2.0, 1.9, 1.4], false));
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
