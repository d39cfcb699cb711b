//! Properties of `sky_view_factor`, on the strategies, cases and checks of `nusselt::testing`.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::scene::Scene;
use nusselt::testing::{
    Case, Faces, Mode, axis_map, case, check_image, closed_scene, gallery, near_coplanar_pair, point, point_inside,
    scene, viewpoint_on_edge,
};
use outside_suite::sky_view_factor;
use proptest::prelude::*;

fn sky(scene: &Scene, point: DVec3) -> f64 {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("epsilon is 0");
    sky_view_factor(&bsp, point).expect("a finite point")
}

/// Sums of some hundred cells, each rounded to about 1e-16.
const ROUNDING: f64 = 1e-13;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn indoors_there_is_no_sky(faces in closed_scene(Mode::Chaos), point in point_inside(Mode::Chaos)) {
        prop_assert_eq!(sky(&faces.scene()?, point), 0.0);
    }

    #[test]
    fn more_faces_never_show_more_sky(
        faces in scene(Mode::Grid), more in near_coplanar_pair(Mode::Grid), point in point(Mode::Grid),
    ) {
        let before = sky(&faces.scene()?, point);
        let mut all = faces;
        all.append(&more);
        prop_assert!(sky(&all.scene()?, point) <= before + ROUNDING);
    }

    #[test]
    fn turning_about_the_vertical_changes_nothing(faces in scene(Mode::Grid), point in point(Mode::Grid), map in axis_map()) {
        prop_assume!(map.order[2] == 2 && !map.mirrored[2]);
        let turned = sky(&faces.turned(map).scene()?, map.apply(point));
        prop_assert!((turned - sky(&faces.scene()?, point)).abs() < ROUNDING);
    }

    /// Eyes where they are hard to place: on the edges of the scene itself.
    #[test]
    fn on_edges_it_is_still_a_share(
        (faces, point) in scene(Mode::Chaos).prop_flat_map(|faces| { let eyes = viewpoint_on_edge(&faces); (Just(faces), eyes) }),
    ) {
        let share = sky(&faces.scene()?, point);
        prop_assert!((0.0..=1.0 + ROUNDING).contains(&share), "{}", share);
    }

    /// The engine's own checks, run by somebody else.
    #[test]
    fn images_hold(case in case(Mode::Chaos)) {
        check_image(&case.image()?)?;
    }
}

#[test]
fn the_gallery_of_degenerate_scenes_has_a_sky() {
    for (name, case) in gallery::all() {
        let share = sky(&case.scene().expect("the gallery is sound"), case.eye);
        assert!((0.0..=1.0 + ROUNDING).contains(&share), "{name}: {share}");
    }
}

/// The same decoder as in a `fuzz_target!(|case: Case| ...)`.
#[test]
fn a_fuzzers_input_is_a_case() {
    let case = Case::decode(&[Case::VERSION, 0, 8, 8, 8]).expect("this version is read");
    assert_eq!(case.faces, Faces::default());
    assert!((sky(&case.scene().expect("an empty scene"), case.eye) - 1.0).abs() < ROUNDING);
}
