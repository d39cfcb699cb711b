//! The 3D BSP: fragments tile their pieces, and come front to back.

use super::{cases, hold, mode};
use nusselt::testing::{Case, Mode, case, check_bsp, check_fragments, check_mirror, check_order, gallery};
use proptest::prelude::*;

proptest! {
    #![proptest_config(cases(600))]

    #[test]
    fn fragments_tile_their_polygon(case in mode().prop_flat_map(case), coarse in any::<bool>()) {
        // Also where epsilon leaves slivers uncut.
        let epsilon = if coarse { hold(case.scene())?.diagonal() * 1e-2 } else { 0.0 };
        hold(check_fragments(&hold(Case { epsilon, ..case }.bsp())?))?;
    }

    #[test]
    fn front_to_back_and_back_to_front_mirror_each_other(case in mode().prop_flat_map(case)) {
        hold(check_mirror(&hold(case.bsp())?, case.eye))?;
    }
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn with_epsilon_0_no_fragment_hides_an_earlier_one(case in mode().prop_flat_map(case)) {
        let bsp = hold(case.bsp())?;
        prop_assert!(bsp.uncut_slivers().is_empty());
        hold(check_order(&bsp, case.eye))?;
    }

    #[test]
    fn with_epsilon_only_recorded_slivers_break_the_order(case in case(Mode::Grid), exponent in 0i32..8) {
        // On a grid of unit 1 these leave much uncut.
        let bsp = hold(Case { epsilon: 2f64.powi(1 - exponent), ..case.clone() }.bsp())?;
        hold(check_order(&bsp, case.eye))?;
    }
}

#[test]
fn the_gallery_has_its_order() {
    for (name, case) in gallery::all() {
        let bsp = case.bsp().unwrap_or_else(|error| panic!("{name}: {error}"));
        if let Err(defect) = check_bsp(&bsp, case.eye) {
            panic!("{name}: {defect}\n{case:?}");
        }
    }
}
