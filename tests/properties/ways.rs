//! The two ways to an image, by a 3D BSP and by a hierarchy of boxes, give the same labelled subdivision.

use super::{cases, grid_directions, hold, mode};
use nusselt::bvh::SceneBvh;
use nusselt::scene::{PolygonId, Side};
use nusselt::testing::{Case, case, check_image, check_same_regions, check_same_view, gallery};
use proptest::prelude::*;

fn same(polygon: PolygonId, side: Side) -> (PolygonId, Side) {
    (polygon, side)
}

/// What must hold of a case seen both ways.
fn check(case: &Case, seed: u64) -> Result<(), TestCaseError> {
    let by_bsp = hold(case.image())?;
    let scene = by_bsp.scene();
    let (viewpoint, domain) = case.viewpoint(scene);
    let by_boxes = hold(SceneBvh::build(scene).view(&viewpoint, &domain))?;
    hold(check_image(&by_boxes))?;
    hold(by_boxes.certify())?;
    hold(check_same_view([&by_bsp, &by_boxes], [&same, &same], |d| d, &grid_directions(seed)))?;
    hold(check_same_regions(&by_bsp, &by_boxes))
}

proptest! {
    #![proptest_config(cases(600))]

    #[test]
    fn both_ways_give_the_same_view(case in mode().prop_flat_map(case), seed in any::<u64>()) {
        check(&case, seed)?;
    }
}

#[test]
fn both_ways_give_the_same_view_of_the_gallery() {
    for (name, case) in gallery::all() {
        if let Err(error) = check(&case, 1) {
            panic!("{name}: {error}");
        }
    }
}
