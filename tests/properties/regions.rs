//! Visible regions are the cells merged, whatever the cells are.

use super::{cases, hold, mode};
use nusselt::contour::{ContourImage, Domain, Projection, Projector, ViewOptions};
use nusselt::testing::{Case, case, check_regions, check_same_regions, gallery};
use proptest::prelude::*;
use std::f64::consts::PI;

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

/// The areas of all regions' pictures sum to that of what is shown.
fn check_pictures(image: &ContourImage) -> Result<(), TestCaseError> {
    // Windows show a part of what a picture shows.
    if matches!(image.domain(), Domain::Window(_)) {
        return Ok(());
    }
    let is_camera = matches!(image.domain(), Domain::Frustum(_));
    let is_sphere = *image.domain() == Domain::Sphere;
    for projection in Projection::ALL {
        let Ok(projector) = Projector::of_image(image, projection) else { continue };
        let expected = match projection {
            _ if is_camera && projection != Projection::Gnomonic => continue,
            Projection::Gnomonic => projector.window().size().element_product(),
            Projection::Equirectangular if is_sphere => 2.0 * PI * PI,
            Projection::Equirectangular => PI * PI,
            Projection::Stereographic if is_sphere => continue,
            Projection::Nusselt | Projection::Stereographic => PI,
        };
        let double = |ring: &Vec<glam::DVec2>| -> f64 {
            ring.iter().zip(ring.iter().cycle().skip(1)).map(|(p, q)| p.perp_dot(*q)).sum()
        };
        let regions = projector.regions(image, 1e-4);
        let rings = regions.iter().flat_map(|region| region.holes.iter().chain([&region.exterior]));
        let area: f64 = rings.map(double).sum::<f64>() / 2.0;
        // The border of a picture is at most 20 long, but for those of cameras.
        let border = (2.0 * projector.window().size().element_sum()).max(20.0);
        prop_assert!((area - expected).abs() < border * 1e-4, "{projection:?}: {area} instead of {expected}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn pictures_of_regions_cover_what_is_shown(case in mode().prop_flat_map(case)) {
        check_pictures(&hold(case.image())?)?;
    }
}

#[test]
fn regions_of_degenerate_scenes_are_the_cells_merged() {
    for (name, case) in gallery::all() {
        check(&case, [0, 2]).unwrap_or_else(|error| panic!("{name}: {error}"));
        let image = case.image().expect("the gallery has images");
        check_pictures(&image).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
