//! The two ways to an image, by a 3D BSP and by a hierarchy of boxes, give the same labelled subdivision.

use super::{cases, grid_directions, hold, mode};
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, Viewpoint};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{PolygonId, Side};
use nusselt::testing::{Case, case, case_of, check_image, check_same_regions, check_same_view, gallery, tiles};
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

proptest! {
    #![proptest_config(cases(300))]

    /// Tiles of one plane go into views together.
    #[test]
    fn both_ways_give_the_same_view_of_tiles(
        case in mode().prop_flat_map(|mode| case_of(mode, tiles(mode))),
        seed in any::<u64>(),
    ) {
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

/// From inside of what encloses the scene, where solids stand around the eye, and from outside of it all.
#[test]
fn both_ways_give_the_same_view_of_solids() {
    for kind in Kind::ALL {
        let mesh = generate(kind, 600, 1).expect("a scene of that size");
        let scene = mesh.to_builder().build().expect("a generated scene is valid");
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
        let boxes = SceneBvh::build(&scene);
        assert!(boxes.solid_pieces() > 0, "{kind} has solids");
        let (low, high) = scene.bounds().expect("the scene has polygons");
        let outside = [high + (high - low) * 0.3, low - DVec3::X * 2.0];
        for eye in mesh.free_points(3, 5).into_iter().map(DVec3::from).chain(outside) {
            let viewpoint = Viewpoint::free(eye);
            let by_bsp = bsp.view(&viewpoint, &Domain::Sphere).expect("the eye is finite");
            let by_boxes = boxes.view(&viewpoint, &Domain::Sphere).expect("the eye is finite");
            if let Err(defect) = check_same_regions(&by_bsp, &by_boxes) {
                panic!("{kind} from {eye}: {defect}");
            }
        }
    }
}
