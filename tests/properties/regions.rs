//! Visible regions are the cells merged, whatever the cells are.

use super::{cases, hold, mode};
use nusselt::contour::ViewOptions;
use nusselt::testing::{Case, case, check_regions, check_same_regions, gallery};
use proptest::prelude::*;

/// What must hold of the regions of a case, seen with quadtrees of two depths.
fn check(case: &Case, depths: [u32; 2]) -> Result<(), TestCaseError> {
    let bsp = hold(case.bsp())?;
    let (viewpoint, domain) = case.viewpoint(bsp.scene());
    let view = |depth| {
        let options = ViewOptions { quadtree_depth: Some(depth), ..ViewOptions::default() };
        hold(bsp.view_with(&viewpoint, &domain, &options))
    };
    let [first, second] = [view(depths[0])?, view(depths[1])?];
    hold(check_regions(&first))?;
    hold(check_same_regions(&first, &second))
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn regions_are_the_cells_merged_whatever_the_quadtree(
        case in mode().prop_flat_map(case), first in 0u32..3, second in 0u32..4,
    ) {
        check(&case, [first, second])?;
    }
}

#[test]
fn regions_of_degenerate_scenes_are_the_cells_merged() {
    for (name, case) in gallery::all() {
        check(&case, [0, 2]).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
