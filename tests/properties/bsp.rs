//! The 3D BSP: fragments tile their pieces, and come front to back.

use super::{cases, hold, mode};
use glam::DVec3;
use nusselt::bsp::{BspOptions, FragmentRef, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::samples::{Kind, generate};
use nusselt::testing::{
    Case, Faces, Mode, case, check_bsp, check_fragments, check_mirror, check_order, check_same_bits, gallery,
};
use proptest::prelude::*;
use std::collections::BTreeSet;

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

/// Where slivers are few enough that most pairs of fragments are compared.
#[test]
fn with_epsilon_the_order_of_a_room_is_right_but_for_slivers() {
    let mesh = generate(Kind::Room, 150, 4).unwrap();
    let scene = mesh.to_builder().build().unwrap();
    let bsp = SceneBsp::build(&scene, &BspOptions { epsilon: 0.05, ..BspOptions::default() }).unwrap();
    let slivers: BTreeSet<_> = bsp.uncut_slivers().iter().map(|sliver| sliver.piece).collect();
    assert!(!slivers.is_empty() && slivers.len() * 4 < scene.piece_count(), "{} slivers", slivers.len());
    for eye in mesh.free_points(3, 1) {
        check_order(&bsp, eye.into()).unwrap();
    }
}

/// A tree by all that can be asked of it: its figures, and its fragments front to back by exact corners.
fn described(bsp: &SceneBsp, eye: DVec3) -> String {
    let fragment = |f: FragmentRef<'_>| format!("{} {:?}", f.piece(), f.exact_corners().collect::<Vec<_>>());
    let order: Vec<_> = bsp.front_to_back(eye).map(fragment).collect();
    format!("{:?}\n{:?}\n{}", bsp.stats(), bsp.uncut_slivers().len(), order.join("\n"))
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn subtrees_that_grow_apart_make_the_same_tree(
        case in mode().prop_flat_map(case), grain in 1usize..6, coarse in any::<bool>(),
    ) {
        let scene = hold(case.scene())?;
        let epsilon = if coarse { scene.diagonal() * 1e-2 } else { 0.0 };
        let build = |grain| SceneBsp::build(&scene, &BspOptions { epsilon, grain: Some(grain), ..BspOptions::default() });
        let (whole, apart) = (hold(build(0))?, hold(build(grain))?);
        prop_assert_eq!(described(&whole, case.eye), described(&apart, case.eye));
        hold(check_fragments(&apart))?;
        hold(check_order(&apart, case.eye))?;
        if hold(Case { epsilon, ..case.clone() }.view(&apart))?.certify().is_err() {
            prop_assert!(false, "a view of the tree is not proved");
        }
    }
}

/// Where three planes meet was rounded from whatever fragment came there first, and planes were chosen by that.
#[test]
#[allow(clippy::unreadable_literal, reason = "as proptest printed them")]
fn points_of_three_planes_are_rounded_the_same_in_subtrees_that_grow_apart() {
    let faces = Faces::from(vec![
        vec![[0.0, 0.0, 0.0], [0.0, 0.0, -2.4612132887019227], [4.3205762522355595, 0.0, 0.0]],
        vec![[-4.264085402519384, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 5.0765970258483595, 1.5629161495397632e23]],
        vec![[0.0, 1999999997.011849, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 3.5922411693420952e22]],
        vec![[0.0, -13736931860.948635, 0.0], [-7.0, 0.0, 0.0], [0.0, 1.0, 5e-324]],
        vec![
            [-3.5, -6868465930.474318, 0.0],
            [0.0, 0.0, 6.470477967537394],
            [0.0, -5.151212007527674, 4.060560237726005],
        ],
        vec![
            [0.0, -6868465929.974318, 0.0],
            [4.985421669945926, 0.0, -2.8164163075503152],
            [-4.0, 7.186363232908502, 3.8597386191715115],
        ],
    ]);
    let scene = faces.scene().unwrap();
    let build = |grain| SceneBsp::build(&scene, &BspOptions { grain: Some(grain), ..BspOptions::default() }).unwrap();
    assert_eq!(described(&build(0), DVec3::ZERO), described(&build(2), DVec3::ZERO));
}

#[test]
fn the_tree_is_the_same_for_any_number_of_threads() {
    let scene = generate(Kind::Room, 3_000, 1).unwrap().to_builder().build().unwrap();
    let options = BspOptions { grain: Some(100), ..BspOptions::default() };
    let eye = DVec3::new(1.0, 1.5, 1.2);
    let view = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let bsp = pool.install(|| SceneBsp::build(&scene, &options)).unwrap();
        let corners: Vec<_> = bsp.fragments().flat_map(|f| f.corners().collect::<Vec<_>>()).collect();
        (described(&bsp, eye), corners, bsp.view(&Viewpoint::free(eye), &Domain::Sphere).unwrap())
    };
    let (order, corners, image) = view(1);
    for threads in [2, 3, 8] {
        let (other_order, other_corners, other) = view(threads);
        assert!(order == other_order && corners == other_corners, "{threads} threads make another tree");
        check_same_bits(&image, &other).unwrap();
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
