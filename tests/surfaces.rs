//! Standing on polygons: folded ones, slivers, thin walls, from near and from far.

mod common;

use common::Faces;
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, SurfaceError, Viewpoint};
use nusselt::exact::{Sign, orient3d};
use nusselt::scene::{PieceId, PolygonId, Side};

#[test]
fn a_sensor_on_a_folded_polygon_stands_on_the_piece_with_its_normal() {
    let mut faces = Faces::default();
    faces.face(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 0.0]].map(DVec3::from));
    let scene = faces.build();
    assert_eq!(scene.piece_count(), 2);
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    for piece in scene.pieces() {
        let corners: Vec<DVec3> = piece.points().collect();
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        for eye in [DVec3::ZERO, DVec3::ONE, DVec3::splat(0.5)] {
            if !corners.contains(&eye) && eye != DVec3::splat(0.5) {
                continue;
            }
            let (found, side) = Viewpoint::surface_at(&scene, eye, normal).unwrap();
            assert_eq!((found, side), (piece.id(), Side::Front));
            let viewpoint = Viewpoint::on_piece(&scene, found, side, eye).unwrap();
            let image = bsp.view(&viewpoint, &Domain::Above).unwrap();
            assert!(image.normal().unwrap().distance(normal.normalize()) < 1e-15);
        }
    }
}

#[test]
fn on_a_sliver_the_factors_still_sum_to_1() {
    let mut faces = Faces::default();
    faces.face(&[[0.0, 0.0, 0.0], [10.0, 1.0, 3.0], [20.0, 2.0, 6.000_000_000_000_001]].map(DVec3::from));
    faces.face(&[[0.0, 0.0, 5.0], [5.0, 0.0, 5.0], [0.0, 5.0, 6.0]].map(DVec3::from));
    let scene = faces.build();
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    for side in [Side::Front, Side::Back] {
        let viewpoint = Viewpoint::on_surface(&scene, PolygonId(0), side, DVec3::new(5.0, 0.5, 1.5)).unwrap();
        let image = bsp.view(&viewpoint, &Domain::Above).unwrap();
        let total = image.form_factors().unwrap().total();
        assert!((total - 1.0).abs() < 1e-12, "{total}");
    }
}

#[test]
fn on_a_thin_wall_the_face_that_shows_its_front_is_taken() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from);
    let mut faces = Faces::default();
    let mut reversed = square;
    reversed.reverse();
    faces.face(&reversed);
    faces.face(&square);
    let scene = faces.build();
    for (normal, polygon) in [(DVec3::Z, PolygonId(1)), (DVec3::NEG_Z, PolygonId(0))] {
        let (piece, side) = Viewpoint::surface_at(&scene, DVec3::new(0.5, 0.5, 0.0), normal).unwrap();
        assert_eq!((scene.piece(piece).polygon(), side), (polygon, Side::Front));
    }
}

#[test]
fn from_far_above_one_lands_on_the_plane() {
    let corners = [[0.0, 0.0, 0.0], [10.0, 1.0, 3.0], [12.0, 9.0, 4.5]].map(DVec3::from);
    let mut faces = Faces::default();
    faces.face(&corners);
    let scene = faces.build();
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    for distance in [1.0, 1e3, 1e9, 1e12] {
        let viewpoint = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, middle + normal * distance).unwrap();
        // The far point itself is rounded: by 1e-16 of the distance along the plane, which moves the foot;
        // off the plane only the last places of the coordinates remain.
        assert!(normal.dot(viewpoint.eye() - corners[0]).abs() < 1e-14, "from {distance}: {viewpoint:?}");
    }
}

#[test]
fn nowhere_is_on_no_surface() {
    let mut faces = Faces::default();
    faces.face(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from));
    let scene = faces.build();
    for near in [DVec3::NAN, DVec3::new(0.0, f64::INFINITY, 0.0)] {
        let on_surface = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, near);
        assert_eq!(on_surface.unwrap_err(), SurfaceError::NotFinite);
        assert_eq!(Viewpoint::on_piece(&scene, PieceId(0), Side::Front, near).unwrap_err(), SurfaceError::NotFinite);
    }
    let unknown = Viewpoint::on_surface(&scene, PolygonId(1), Side::Front, DVec3::ZERO).unwrap_err();
    assert_eq!(unknown, SurfaceError::UnknownPolygon { polygon: PolygonId(1), count: 1 });
}

/// The point of a convex polygon nearest to another one, by trying all sides.
fn nearest(corners: &[DVec3], p: DVec3) -> DVec3 {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
    let foot = p - normal * normal.dot(p - corners[0]);
    let sides: Vec<[DVec3; 2]> = (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]).collect();
    if sides.iter().all(|[a, b]| normal.cross(b - a).dot(foot - a) >= 0.0) {
        return foot;
    }
    let ends = sides.iter().map(|[a, b]| a + (b - a) * ((p - a).dot(b - a) / a.distance_squared(*b)).clamp(0.0, 1.0));
    ends.min_by(|a, b| a.distance(p).total_cmp(&b.distance(p))).expect("a polygon has sides")
}

#[test]
fn the_eye_is_at_the_nearest_point_and_not_behind_it() {
    let mut random = 1u64;
    let mut next = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / 2f64.powi(52) - 1.0
    };
    let mut moved = 0;
    for (exponent, offset) in (0..40).flat_map(|_| [(0, 0.0), (0, 7.0), (600, 3.0), (-600, 3.0)]) {
        let scale = 2f64.powi(exponent);
        let offset = DVec3::new(offset, -offset, offset * 0.5);
        let mut point = |size: f64| DVec3::new(next(), next(), next()) * size;
        let (a, u, v) = (point(1.0) + offset, point(2.0), point(2.0));
        if u.cross(v).length() < 0.2 {
            continue;
        }
        // A parallelogram: cut in two if rounding folds it, so a triangle.
        let corners = [a, a + u, a + v];
        let near = a + point(4.0);
        let mut faces = Faces::default();
        faces.face(&corners.map(|p| p * scale));
        let scene = faces.build();
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        for side in [Side::Front, Side::Back] {
            let eye = Viewpoint::on_surface(&scene, PolygonId(0), side, near * scale).unwrap().eye();
            let expected = nearest(&corners, near);
            assert!((eye / scale).distance(expected) < 1e-14, "{eye} {expected} {scale}");
            let [a, b, c] = corners.map(|p| p * scale);
            // Scaled back, so that exact signs and not only expansions of what underflows are asked.
            let above = orient3d(a / scale, b / scale, c / scale, eye / scale);
            let behind = if side == Side::Front { Sign::Negative } else { Sign::Positive };
            assert_ne!(above, behind, "{eye}");
            moved += usize::from(above != Sign::Zero);
            // A sensor there is on that polygon, whatever the length of its normal.
            for length in [1.0, 1e-200, 1e200] {
                let found = Viewpoint::surface_at(&scene, eye, normal * length);
                assert_eq!(found, Some((PieceId(0), Side::Front)), "{eye} {length}");
            }
            let off = eye + normal.normalize() * (1e-6 * scene.diagonal());
            assert_eq!(Viewpoint::surface_at(&scene, off, normal), None);
        }
    }
    assert!(moved > 100, "most planes hold few points");
}
