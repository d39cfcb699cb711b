//! One image: its cells tile, and show what is nearest.

use super::{cases, hold, mode};
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::scene::{PolygonId, Side};
use nusselt::testing::{
    Case, Defect, Mode, RayOracle, case, check_closed, check_image, check_labels, check_same_bits, check_same_view,
    check_sums, check_tiling, closed_scene, direction, gallery, point_inside,
};
use proptest::collection::vec;
use proptest::prelude::*;

proptest! {
    #![proptest_config(cases(600))]

    #[test]
    fn cells_tile_and_solid_angles_sum_to_the_domain(
        (case, directions) in mode().prop_flat_map(|mode| (case(mode), vec(direction(mode), 20))),
    ) {
        let image = hold(case.image())?;
        hold(check_sums(&image))?;
        hold(check_tiling(&image, &directions))?;
    }

    #[test]
    fn cells_show_the_nearest_polygon(case in mode().prop_flat_map(case)) {
        let image = hold(case.image())?;
        hold(check_labels(&image, &RayOracle::new(image.scene())))?;
    }
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn form_factors_sum_to_1_in_closed_scenes(
        (faces, eye, normal) in mode().prop_flat_map(|m| (closed_scene(m), point_inside(m), direction(m))),
    ) {
        let bsp = SceneBsp::build(&hold(faces.scene())?, &BspOptions::default()).expect("epsilon is 0");
        for domain in [Domain::Hemisphere(normal), Domain::Sphere] {
            let image = hold(bsp.view(&Viewpoint::free(eye), &domain))?;
            hold(check_closed(&image))?;
            // Here also to the promise of the project, whatever the images' own bound is.
            if let Some(factors) = image.form_factors() {
                prop_assert!((factors.total() - 1.0).abs() <= 1e-12, "{}", factors.total());
            }
            hold(check_sums(&image))?;
        }
    }

    #[test]
    fn form_factors_sum_to_1_on_the_walls_of_closed_scenes(
        faces in closed_scene(Mode::Grid), eye in point_inside(Mode::Grid), wall in 0u32..6,
    ) {
        let scene = hold(faces.scene())?;
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
        let viewpoint = hold(Viewpoint::on_surface(&scene, PolygonId(wall), Side::Front, eye))?;
        let image = hold(bsp.view(&viewpoint, &Domain::Above))?;
        hold(check_sums(&image))?;
        // Subdivision may have left a part of the wall whose nearest point is on the room's own edge.
        let on_edge = scene.bounds().is_some_and(|(low, high)| {
            let eye = viewpoint.eye();
            (eye.cmpeq(low) | eye.cmpeq(high)).bitmask().count_ones() > 1
        });
        if !on_edge {
            hold(check_closed(&image))?;
        }
    }

    #[test]
    fn with_any_epsilon_the_cells_tile(case in mode().prop_flat_map(case), exponent in 1i32..16) {
        // Up to 1e-3 of the scene's size.
        let epsilon = hold(case.scene())?.diagonal() * 1e-3 * 2f64.powi(1 - exponent);
        let image = hold(Case { epsilon, ..case }.image())?;
        hold(check_image(&image))?;
    }
}

#[test]
fn the_gallery_holds() {
    for (name, case) in gallery::all() {
        let image = case.image().unwrap_or_else(|error| panic!("{name}: {error}"));
        if let Err(defect) = check_image(&image) {
            panic!("{name}: {defect}\n{case:?}");
        }
    }
}

/// The checks themselves can fail.
#[test]
fn the_checks_tell_what_is_wrong() {
    let [open, closed] = [gallery::three_edges_through_one_direction(), gallery::box_on_floor()];
    let image = |case: &Case| case.image().expect("the gallery has images");
    assert!(matches!(check_closed(&image(&open)), Err(Defect::Background { .. })));
    assert_eq!(check_closed(&image(&closed)), Ok(()));
    // Another eye: other corners. The same, and of another scene: other labels.
    let moved = Case { eye: closed.eye + 0.25, ..closed.clone() };
    assert!(matches!(check_same_bits(&image(&closed), &image(&moved)), Err(Defect::Bits { .. })));
    let same = |polygon, side| (polygon, side);
    let directions = [DVec3::new(0.1, 0.2, 1.0), DVec3::new(0.3, 0.4, -1.0)];
    let differ = |a, b, directions| check_same_view([&image(a), &image(b)], [&same, &same], |d| d, directions);
    assert!(matches!(differ(&closed, &open, &directions), Err(Defect::Disagreement { .. })));
    assert!(matches!(differ(&closed, &moved, &[]), Err(Defect::Angles { .. })));
    assert_eq!(differ(&closed, &closed, &directions), Ok(2));
    // An oracle for another scene.
    let other = RayOracle::new(&moved.faces.mapped(|p| p * 3.0).reversed().scene().expect("a scene"));
    assert!(matches!(check_labels(&image(&closed), &other), Err(Defect::Label { .. })));
}
