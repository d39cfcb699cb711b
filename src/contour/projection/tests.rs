//! Pictures cover their window once, whichever way they are projected, and are not mirrored.

use super::*;
use crate::bsp::{BspOptions, SceneBsp};
use crate::contour::Viewpoint;
use crate::samples::{Kind, cornell_box, generate};

fn area(path: &[DVec2]) -> f64 {
    path.iter().zip(path.iter().cycle().skip(1)).map(|(p, q)| q.perp_dot(*p) / 2.0).sum()
}

/// The sum of all cells' areas in a picture; each path runs clockwise.
fn covered(image: &ContourImage, projector: &Projector) -> f64 {
    let window = projector.window();
    let mut corners = Vec::new();
    let mut total = 0.0;
    for cell in image.cells() {
        corners.clear();
        corners.extend(cell.boundary());
        for path in projector.cell(&corners, 1e-5) {
            assert!(area(&path) > -1e-4, "{:?}: {path:?}", projector.projection());
            let inside = |p: &DVec2| p.cmpge(window.low - 1e-9).all() && p.cmple(window.high + 1e-9).all();
            assert!(path.iter().all(inside), "{:?}: {path:?}", projector.projection());
            total += area(&path);
        }
    }
    total
}

#[test]
fn pictures_of_hemispheres_are_covered_once() {
    let mesh = cornell_box();
    let bsp = SceneBsp::build(&mesh.to_builder().build().expect("sound"), &BspOptions::default()).expect("sound");
    let eye = Viewpoint::free(DVec3::new(278.0, 273.0, 100.0));
    for normal in [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::new(0.3, 1.0, -2.0), DVec3::new(-1.0, 2.0, 0.0)] {
        let image = bsp.view(&eye, &Domain::Hemisphere(normal)).expect("a view");
        for projection in Projection::ALL {
            let projector = Projector::of_image(&image, projection).expect("a hemisphere");
            let expected = match projection {
                Projection::Nusselt | Projection::Stereographic => PI,
                Projection::Gnomonic => projector.window().size().element_product(),
                // The mean of the horizon's latitude is 0.
                Projection::Equirectangular => PI * PI,
            };
            let found = covered(&image, &projector);
            assert!((found / expected - 1.0).abs() < 1e-3, "{projection:?} {normal}: {found} {expected}");
        }
    }
}

#[test]
fn pictures_of_the_sphere_are_covered_once() {
    let mesh = generate(Kind::Room, 300, 4).expect("a room");
    let bsp = SceneBsp::build(&mesh.to_builder().build().expect("sound"), &BspOptions::default()).expect("sound");
    for eye in mesh.free_points(4, 2) {
        let image = bsp.view(&Viewpoint::free(DVec3::from(eye)), &Domain::Sphere).expect("a view");
        assert_eq!(Projector::of_image(&image, Projection::Nusselt).map(|_| ()), Err(ProjectionError::NotAHemisphere));
        for projection in [Projection::Gnomonic, Projection::Stereographic, Projection::Equirectangular] {
            let projector = Projector::of_image(&image, projection).expect("any but nusselt");
            let expected = projector.window().size().element_product();
            let found = covered(&image, &projector);
            assert!((found / expected - 1.0).abs() < 1e-3, "{projection:?}: {found} {expected}");
        }
    }
}

#[test]
fn pictures_are_not_mirrored() {
    for (towards, up) in [(DVec3::Y, DVec3::Z), (DVec3::Z, DVec3::Y), (DVec3::new(1.0, 2.0, -3.0), DVec3::Z)] {
        let frame = ViewFrame::upright(towards);
        assert!(frame.right().cross(frame.up()).dot(frame.towards()) < -0.999, "towards is away from the eye");
        assert!(frame.up().dot(up) > 0.0);
        for projection in Projection::ALL {
            let projector = Projector::new(projection, frame, Some(towards)).expect("a hemisphere");
            let right = projector.point(frame.towards() + frame.right() * 0.1);
            let above = projector.point(frame.towards() + frame.up() * 0.1);
            assert!(right.x > 0.04 && right.y.abs() < 1e-9, "{projection:?}");
            assert!(above.y > 0.04 && above.x.abs() < 1e-9, "{projection:?}");
        }
    }
    // Looking north, east is to the right; looking up with north on top, to the left.
    assert_eq!(ViewFrame::upright(DVec3::Y).right(), DVec3::X);
    assert_eq!(ViewFrame::upright(DVec3::Z).right(), DVec3::NEG_X);
    assert_eq!(ViewFrame::panorama(DVec3::Z), ViewFrame::new(DVec3::Y, DVec3::Z));
}

#[test]
fn frames_are_orthonormal_whatever_they_are_made_of() {
    let vectors = [DVec3::ZERO, DVec3::Z, DVec3::NAN, DVec3::splat(1e308), DVec3::new(1e-320, 0.0, 1e-310)];
    for towards in vectors {
        for up in vectors {
            let frame = ViewFrame::new(towards, up);
            let axes = [frame.right(), frame.up(), frame.towards()];
            assert!(axes.iter().all(|a| (a.length() - 1.0).abs() < 1e-9), "{towards} {up}: {frame:?}");
            assert!(axes[0].dot(axes[1]).abs() < 1e-9 && axes[1].dot(axes[2]).abs() < 1e-9);
        }
    }
}

#[test]
fn arcs_over_a_pole_of_a_panorama_run_along_its_edge() {
    let projector =
        Projector::new(Projection::Equirectangular, ViewFrame::upright(DVec3::Y), None).expect("a panorama");
    let ends = [DVec3::new(0.3, 0.1, 1.0), DVec3::new(-0.3, -0.1, 1.0)].map(DVec3::normalize);
    let lines = projector.arc(ends, 1e-4);
    assert!(lines.len() >= 2 && lines.iter().flatten().all(|p| p.is_finite()));
    let around = [DVec3::new(1.0, 0.0, 3.0), DVec3::new(-1.0, 1.0, 3.0), DVec3::new(-1.0, -1.0, 3.0)];
    let paths = projector.cell(&around.map(DVec3::normalize), 1e-4);
    let total: f64 = paths.iter().map(|path| area(path)).sum();
    assert_eq!(paths.len(), 4);
    assert!(total > 0.15 * 2.0 * PI && total < 0.5 * 2.0 * PI, "the pole is a whole edge: {total}");
}
