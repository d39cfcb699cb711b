//! Scenes far from the origin, where numbers are far apart.

use super::cases::{cuboid, rectangle, scene_of};
use super::references::opposed;
use super::{all_rows, exchange, factor};
use glam::DVec3;
use nusselt::factors::PatchPlan;

/// Moved by whole numbers: all coordinates stay exact.
fn moved(polygons: &[Vec<[f64; 3]>], by: [f64; 3]) -> Vec<Vec<[f64; 3]>> {
    let moved = |p: &[f64; 3]| [0, 1, 2].map(|k| p[k] + by[k]);
    polygons.iter().map(|polygon| polygon.iter().map(moved).collect()).collect()
}

#[test]
fn where_a_scene_is_changes_nothing() {
    let plates = [rectangle([0.; 3], [1., 0., 0.], [0., 1., 0.]), rectangle([0., 0., 1.], [0., 1., 0.], [1., 0., 0.])];
    let mut hidden = cuboid([0.; 3], [4., 3., 2.], true);
    hidden.extend(cuboid([1., 1., 0.], [2., 2., 1.], false));
    for (polygons, tolerance) in [(&plates[..], 1e-8), (&hidden, 1e-4)] {
        // Moved so that no coordinate is 0, all are exact, and the scene is not as far away as it is large.
        let near = all_rows(&exchange(&scene_of(&moved(polygons, [5.0, 4.0, 3.0])), PatchPlan::Polygons, tolerance));
        for by in [[1e13; 3], [-1e14, 1e14, 4.0], [1e15, -1e15, 1e15]] {
            let far = exchange(&scene_of(&moved(polygons, by)), PatchPlan::Polygons, tolerance);
            assert_eq!(all_rows(&far), near, "{by:?}: to the last bit");
        }
    }
    for by in [1e13, 1e14, 1e15] {
        let far = exchange(&scene_of(&moved(&plates, [by; 3])), PatchPlan::Polygons, 1e-8);
        for (row, other) in [(0, 1), (1, 0)] {
            let off = (factor(&far.row(row).expect("a row"), other) - opposed(1.0, 1.0, 1.0)).abs();
            assert!(off < 1e-8, "{by:e}: {off:e}");
        }
        let shape = far.patches()[1].shape.as_ref().expect("it has area");
        assert_eq!(shape.center, DVec3::new(by + 0.5, by + 0.5, by + 1.0), "halves are exact there");
        assert_eq!(shape.boundary().expect("one piece")[0], DVec3::new(by, by, by + 1.0));
    }
}

#[test]
fn estimates_tell_what_rounding_does_where_a_scene_is_as_large_as_it_is_far() {
    // The plates cannot be moved to the origin without moving a third, which is there and sees nothing.
    let plates = [rectangle([0.; 3], [1., 0., 0.], [0., 1., 0.]), rectangle([0., 0., 1.], [0., 1., 0.], [1., 0., 0.])];
    let mut worst = 0.0_f64;
    for by in [1e6, 1e10, 1e13, 1e14, 1e15] {
        let mut polygons = moved(&plates, [by; 3]);
        polygons.push(rectangle([-1., -1., -1.], [1., 0., 0.], [0., -1., 0.]));
        let far = exchange(&scene_of(&polygons), PatchPlan::Polygons, 1e-8);
        for (row, other) in [(0, 1), (1, 0)] {
            let row = far.row(row).expect("a row");
            let entry = row.entries.iter().find(|entry| entry.column == other).expect("they see each other");
            let off = (entry.share.factor - opposed(1.0, 1.0, 1.0)).abs();
            assert!(off <= entry.share.error, "{by:e}: {off:e}, estimated {:e}", entry.share.error);
            worst = worst.max(off);
            // Where numbers are close enough the estimates are no reason for a warning.
            assert!(by > 1e6 || entry.share.error < 1e-8);
        }
    }
    assert!(worst > 1e-6, "rounding does matter here: {worst:e}");
}
