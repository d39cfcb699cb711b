//! Factors made reciprocal.

use super::cases::{cuboid, rectangle, scene_of};
use super::{all_rows, city, exchange, factor};
use nusselt::factors::{PatchPlan, ReciprocityError, make_reciprocal};

#[test]
fn rows_are_reciprocal_and_sum_to_one_within_their_estimates() {
    // A city under a sky, which is closed, and plates in the open.
    let open = [
        rectangle([0.; 3], [1., 0., 0.], [0., 1., 0.]),
        rectangle([0., 0., 1.], [0., 1., 0.], [1., 0., 0.]),
        rectangle([0.2, 0.2, 0.5], [0., 0.4, 0.], [0.3, 0., 0.]),
        rectangle([1.0, 0., 0.], [0., 0., 1.], [0., 1., 0.]),
    ];
    for (scene, tolerance) in [(city::city(2).expect("a city"), 1e-3), (scene_of(&open), 1e-4)] {
        let exchange = exchange(&scene, PatchPlan::Polygons, tolerance);
        let (patches, rows) = (exchange.patches(), all_rows(&exchange));
        let before = rows.clone();
        let reciprocal = make_reciprocal(patches, rows).expect("a solution");
        let mut largest = 0.0_f64;
        for (i, row) in reciprocal.rows.iter().enumerate() {
            assert!((row.sum() - 1.0).abs() <= 1e-12, "{i}: {}", row.sum());
            for entry in &row.entries {
                let j = entry.column as usize;
                let back = patches[j].area * factor(&reciprocal.rows[j], i as u32);
                assert!((patches[i].area * entry.share.factor - back).abs() <= 1e-15 * patches[i].area, "{i} {j}");
                largest = largest.max((entry.share.factor - factor(&before[i], entry.column)).abs());
            }
        }
        // As told, and no more than two errors within the tolerance explain, over smaller areas for the larger ones.
        assert!(largest <= reciprocal.largest_change && reciprocal.largest_change <= 4.0 * tolerance, "{largest:e}");
    }
}

#[test]
fn what_is_reciprocal_stays() {
    let exchange = exchange(&scene_of(&cuboid([0.; 3], [1., 2., 3.], true)), PatchPlan::Polygons, 1e-6);
    let rows = all_rows(&exchange);
    let reciprocal = make_reciprocal(exchange.patches(), rows).expect("a solution");
    assert!(reciprocal.largest_change <= 1e-6, "{:e}", reciprocal.largest_change);
    assert_eq!(reciprocal.beyond_estimates, 0);
}

#[test]
fn all_rows_are_needed() {
    let exchange = exchange(&scene_of(&cuboid([0.; 3], [1.; 3], true)), PatchPlan::Polygons, 1e-4);
    let mut rows = all_rows(&exchange);
    rows.swap(2, 3);
    assert_eq!(make_reciprocal(exchange.patches(), rows), Err(ReciprocityError::MissingRow { row: 2 }));
    assert!(make_reciprocal(exchange.patches(), Vec::new()).is_err());
}
