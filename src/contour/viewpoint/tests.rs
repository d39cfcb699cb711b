//! The eye is put at the nearest number that is not behind its surface.

use super::*;
use crate::scene::Material;

#[test]
fn steps_lead_from_each_number_to_the_next() {
    for x in [0.0, -0.0, 5e-324, -5e-324, 1.0, -1.0, 4.0f64.next_down(), -f64::MIN_POSITIVE, f64::MAX.next_down()] {
        // Both zeros are one place, and it is called +0.
        assert_eq!(step(x, 0).to_bits(), (x + 0.0).to_bits());
        assert_eq!(step(x, 1).to_bits(), (x.next_up() + 0.0).to_bits());
        assert_eq!(step(x, -2).to_bits(), (x.next_down().next_down() + 0.0).to_bits());
    }
    assert_eq!(step(-5e-324, 2).to_bits(), 1);
}

/// `x` moved by that many places.
fn moved(x: f64, steps: i32) -> f64 {
    let towards = if steps < 0 { f64::next_down } else { f64::next_up };
    (0..steps.abs()).fold(x, |x, _| towards(x))
}

#[test]
fn the_eye_leaves_its_place_no_further_than_it_must() {
    let mut state = 3u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 2f64.powi(52) - 1.0
    };
    let [mut left, mut far] = [0; 2];
    for round in 0..60 {
        let mut point = || DVec3::new(next(), next(), next());
        let mut corners = [point(), point(), point()];
        // Nearly across each axis in turn, on either side of the origin, and turned either way; every other
        // time where places along that axis lie much closer than those across.
        let side_of_origin = if round % 2 == 0 { 1.0 } else { -1.0 };
        let is_fine = round % 4 < 2;
        for corner in &mut corners {
            *corner += if is_fine { 16.0 } else { 0.0 };
            let along = &mut corner[round % 3];
            *along = if is_fine { (*along - 16.0) * 0.6 + side_of_origin } else { *along * 0.5 + 3.0 * side_of_origin };
        }
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let axis = normal.abs().max_position();
        if normal.length() < 0.2 || axis != round % 3 {
            continue;
        }
        let vertices = corners.map(|p| p.to_array());
        let scene = Scene::builder().mesh(&vertices, &[vec![0, 1, 2]], Material::new("m")).build();
        let scene = scene.expect("a triangle");
        let piece = scene.pieces().next().expect("a triangle");
        for weight in [0.1, 0.3, 0.5, 0.7] {
            let near = a * weight + b * (0.9 - weight) + c * 0.1;
            let foot = near - normal * (normal.dot(near - a) / normal.length_squared());
            for side in [Side::Front, Side::Back] {
                let behind = if side == Side::Front { Sign::Negative } else { Sign::Positive };
                let allowed = |p: DVec3| orient3d(a, b, c, p) != behind;
                let eye = not_behind(&scene, piece, side, foot);
                assert!(allowed(eye), "{eye}");
                // All neighbours: to 2 places across, and to 60 along the axis nearest to the normal.
                let (mut least, mut steps) = (f64::INFINITY, 0i32);
                for (i, j, k) in (-2..=2).flat_map(|i| (-2..=2).flat_map(move |j| (-60..=60).map(move |k| (i, j, k)))) {
                    let mut p = foot;
                    p[axis] = moved(p[axis], k);
                    p[(axis + 1) % 3] = moved(p[(axis + 1) % 3], i);
                    p[(axis + 2) % 3] = moved(p[(axis + 2) % 3], j);
                    if allowed(p) && p.distance_squared(foot) < least {
                        (least, steps) = (p.distance_squared(foot), k);
                    }
                }
                assert_eq!(eye.distance_squared(foot).to_bits(), least.to_bits(), "{foot} to {eye}");
                left += usize::from(least > 0.0);
                far += usize::from(steps.abs() > 2);
            }
        }
    }
    assert!(left > 60 && far > 10, "few places are exactly in a plane: {left}, {far}");
}

#[test]
fn a_normal_tells_the_side_of_the_nearest_piece() {
    // A square folded along its diagonal into a tent: its pieces face up and to the left, and up and to the right.
    let vertices = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.0, 2.0, 0.0], [-1.0, 1.0, 1.0]];
    let scene =
        Scene::builder().mesh(&vertices, &[vec![0, 1, 2, 3]], Material::new("m")).build().expect("two triangles");
    assert_eq!(scene.piece_count(), 2);
    let polygon = PolygonId(0);
    let side = |normal: DVec3, near: DVec3| {
        let viewpoint = Viewpoint::on_surface_towards(&scene, polygon, normal, near).expect("a polygon with area");
        let (piece, side) = viewpoint.surface_piece().expect("on a surface");
        assert_eq!(Ok(viewpoint), Viewpoint::on_surface(&scene, polygon, side, near));
        let facing = unit_normal(&scene, scene.piece(piece));
        assert!(facing.dot(normal) * if side == Side::Front { 1.0 } else { -1.0 } >= 0.0, "{normal} {facing}");
        side
    };
    let [near_low, near_high] = [DVec3::new(0.9, 1.0, 1.0), DVec3::new(-0.9, 1.0, 1.0)];
    let front = side(DVec3::Z, near_low);
    for near in [near_low, near_high] {
        for scale in [1.0, 1e300, 5e-324] {
            assert_eq!(side(DVec3::Z * scale, near), front);
            assert_ne!(side(DVec3::NEG_Z * scale, near), front);
        }
    }
    // The same normal is in front of one piece and behind the other.
    assert_ne!(side(DVec3::X, near_low), side(DVec3::X, near_high));
    // One that lies in the plane does not tell.
    for normal in [DVec3::Y, DVec3::new(1e-7, -1.0, 0.0), DVec3::ZERO, DVec3::NAN] {
        let found = Viewpoint::on_surface_towards(&scene, polygon, normal, near_low);
        assert!(matches!(found, Err(SurfaceError::NoSide { polygon: PolygonId(0), .. })), "{normal}: {found:?}");
    }
    assert_ne!(side(DVec3::new(1e-5, 1.0, 0.0), near_low), side(DVec3::new(-1e-5, 1.0, 0.0), near_low));
    let missing = Viewpoint::on_surface_towards(&scene, PolygonId(1), DVec3::Z, near_low);
    assert!(matches!(missing, Err(SurfaceError::UnknownPolygon { .. })));
}
