//! What is seen through slits that are narrower than any distance between the first points.

use super::cases::{rectangle, scene_of};
use super::references::{lambert, over_shadows};
use super::{exchange, factor};
use glam::DVec3;
use nusselt::factors::{PatchPlan, Row};

/// Plates reach so far beyond what they are between.
const FAR: f64 = 10.0;
/// Rounding of references.
const ROUNDING: f64 = 1e-12;

/// From a rectangle (x from, x to, y from, y to) at height 0 to one at height `top`, with nothing but a hole in what is between, at height `middle`: the hole's shadow is lit, and
/// the rest is not.
fn through_a_hole(from: [f64; 4], hole: [f64; 4], middle: f64, to: [f64; 4], top: f64) -> f64 {
    over_shadows(from, hole, middle, to, top, |x, lit| lambert(x, DVec3::Z, lit).abs())
}

/// A rectangle in a plane of constant z: x from, x to, y from, y to.
fn level([x0, x1, y0, y1]: [f64; 4], z: f64, is_up: bool) -> Vec<[f64; 3]> {
    let (u, v) = ([x1 - x0, 0., 0.], [0., y1 - y0, 0.]);
    if is_up { rectangle([x0, y0, z], u, v) } else { rectangle([x0, y0, z], v, u) }
}

/// Two plates with a slit between.
fn plates([from, to]: [f64; 2], end: f64, height: f64) -> [Vec<[f64; 3]>; 2] {
    [level([-FAR, from, -FAR, FAR], height, true), level([to, end, -FAR, FAR], height, true)]
}

/// The entry of a row is within the tolerance and its own estimate of what is true.
fn check(row: &Row, column: u32, expected: f64, tolerance: f64, what: &str) {
    let found = factor(row, column);
    let off = (found - expected).abs();
    assert!(off <= tolerance + ROUNDING, "{what}, {tolerance:e}: {found:e} instead of {expected:e}");
    let entry = row.entries.iter().find(|entry| entry.column == column).expect("something is seen");
    assert!(off <= entry.share.error + ROUNDING, "{what}, {tolerance:e}: off by {off:e}, told {:e}", entry.share.error);
    assert!((row.sum() - 1.0).abs() <= 1e-12, "{what}, {tolerance:e}: {:e}", row.sum() - 1.0);
}

#[test]
fn a_slit_is_seen_however_narrow_and_near() {
    let unit = [0., 1., 0., 1.];
    for (height, width) in [(0.003, 0.001), (0.01, 0.001), (0.01, 0.01), (0.3, 0.003), (1.99, 0.01)] {
        let slit = [0.4, 0.4 + width];
        let expected = through_a_hole(unit, [slit[0], slit[1], -FAR, FAR], height, unit, 2.0);
        let mut polygons = vec![level(unit, 0.0, true), level(unit, 2.0, false)];
        polygons.extend(plates(slit, FAR, height));
        let scene = scene_of(&polygons);
        for tolerance in [1e-4, 1e-6] {
            let exchange = exchange(&scene, PatchPlan::Polygons, tolerance);
            for (row, column) in [(0, 1), (1, 0)] {
                let what = format!("height {height}, width {width}, row {row}");
                check(&exchange.row(row).expect("a row"), column, expected, tolerance, &what);
            }
        }
    }
}

#[test]
fn a_slit_is_seen_however_much_else_may_be_off() {
    // A wall parts the floor: on the other side of it are many triangles, whose estimates would explain any residue.
    let (ceiling, slit, height) = ([-1.0, 0.99, -0.6, 1.6], [0.4, 0.41], 0.01);
    let hole = [slit[0], slit[1], -FAR, FAR];
    let expected = 0.5 * through_a_hole([0., 1., 0., 1.], hole, height, ceiling, 2.0);
    let mut polygons = vec![level([0., 2., 0., 1.], 0.0, true), level(ceiling, 2.0, false)];
    polygons.extend(plates(slit, 1.0, height));
    polygons.push(rectangle([1.0, -FAR, height], [0., 2.0 * FAR, 0.], [0., 0., 4.0 - height]));
    // Numbers from 0 to 1 without a pattern: multiples of the golden ratio.
    let mut seed = 0.0;
    let mut next = || {
        seed += 1.0;
        (seed * 0.618_033_988_749_894_9_f64).fract()
    };
    for _ in 0..100 {
        let corner = [1.7 + 1.8 * next(), 3.0 * next() - 1.0, 0.3 + 1.7 * next()];
        let mut at = |p: [f64; 3]| p.map(|x| x + 0.4 * next() - 0.2);
        let [b, c] = [at(corner), at(corner)];
        polygons.push(vec![corner, c, b]);
    }
    let scene = scene_of(&polygons);
    for tolerance in [2e-4, 1e-4] {
        let row = exchange(&scene, PatchPlan::Polygons, tolerance).row(0).expect("a row");
        check(&row, 1, expected, tolerance, "beside triangles");
    }
}
