//! Domains that are parts of the sphere: windows and cameras, against views of all directions, and against what is known of lamps.

mod common;

use common::{Faces, Random, cluttered_room};
use glam::{DQuat, DVec3};
use num_rational::BigRational;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{
    ContourImage, Domain, Frustum, FrustumError, Location, Pane, ViewError, ViewOptions, ViewSpace, Viewpoint,
    WindowError, Windows,
};
use nusselt::integral::{form_factor, solid_angle};
use nusselt::scene::{PolygonId, Scene, Side};
use nusselt::testing::{check_image, check_regions, check_same_regions};
use nusselt::verify::Arithmetic;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A view both ways: they must agree, and both must be proved.
fn both_ways(scene: &Scene, viewpoint: &Viewpoint, domain: &Domain) -> [ContourImage; 2] {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("epsilon is 0");
    let by_bsp = bsp.view(viewpoint, domain).expect("a view");
    let by_boxes = SceneBvh::build(scene).view(viewpoint, domain).expect("a view");
    for image in [&by_bsp, &by_boxes] {
        image.certify().unwrap_or_else(|defect| panic!("{defect}"));
    }
    check_same_regions(&by_bsp, &by_boxes).unwrap_or_else(|defect| panic!("{defect}"));
    [by_bsp, by_boxes]
}

/// Without a cell, proved by both arithmetics, with nothing to sum.
fn assert_empty(scene: &Scene, eye: DVec3, windows: &Windows) {
    for domain in [windows.clone(), windows.clone().within_hemisphere(DVec3::new(0.1, 0.2, 1.0))] {
        for image in both_ways(scene, &Viewpoint::free(eye), &Domain::Window(domain)) {
            assert_eq!(image.cell_count(), 0, "from {eye}");
            assert_eq!(image.solid_angles().total().to_bits(), 0.0f64.to_bits());
            image.evidence().check(scene, Arithmetic::Rational).expect("an empty domain is tiled by nothing");
            assert_eq!(image.locate(DVec3::Z), Location::Outside);
            assert!(image.regions().is_empty());
        }
    }
}

fn rectangle(low: [f64; 2], high: [f64; 2], z: f64) -> [DVec3; 4] {
    [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]].map(|[x, y]| DVec3::new(x, y, z))
}

/// The part of a convex spherical polygon inside of a half space, in floating point.
fn clipped(polygon: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::new();
    for (k, &a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (ha, hb) = (normal.dot(a), normal.dot(b));
        if ha >= 0.0 {
            kept.push(a);
        }
        if ha * hb < 0.0 {
            kept.push((a * hb.abs() + b * ha.abs()).normalize());
        }
    }
    kept
}

/// The normals to the inside of the cone of a convex ring, in floating point.
fn cone(ring: &[DVec3], eye: DVec3) -> Vec<DVec3> {
    let middle = ring.iter().sum::<DVec3>() / ring.len() as f64 - eye;
    let normals = (0..ring.len()).map(|k| (ring[k] - eye).cross(ring[(k + 1) % ring.len()] - eye).normalize());
    normals.map(|normal| if normal.dot(middle) < 0.0 { -normal } else { normal }).collect()
}

/// The solid angle, or with a normal the form factor, of everything in the directions inside of all half spaces, by cutting the cells of a view
/// of all directions.
fn sums_within(full: &ContourImage, normals: &[DVec3], up: Option<DVec3>) -> BTreeMap<Option<PolygonId>, f64> {
    let mut sums = BTreeMap::new();
    for cell in full.cells() {
        let mut part: Vec<DVec3> = cell.boundary().collect();
        for &normal in normals.iter().chain(&up) {
            part = clipped(&part, normal);
        }
        if part.len() > 2 {
            let value = up.map_or_else(|| solid_angle(&part), |up| form_factor(&part, up));
            *sums.entry(cell.polygon()).or_insert(0.0) += value;
        }
    }
    sums
}

/// The same of an image.
fn sums_of(image: &ContourImage) -> BTreeMap<Option<PolygonId>, f64> {
    let sums = image.form_factors().unwrap_or_else(|| image.solid_angles());
    let polygons = sums.polygons.iter().map(|sum| (Some(sum.polygon), sum.both()));
    polygons.chain([(None, sums.background)]).collect()
}

fn corners(scene: &Scene, polygon: PolygonId) -> Vec<DVec3> {
    scene.polygon(polygon).rings()[0].iter().map(|&v| scene.vertex(v)).collect()
}

/// By inclusion and exclusion, from cells of the whole sphere that are cut in floating point. The tolerance is that of thousands of cells whose
/// corners are moved by about 1e-15 each, some of them next to sides of windows at small angles.
#[test]
fn two_windows_that_may_overlap_show_what_the_whole_sphere_shows_in_their_union() {
    let scene = cluttered_room(60, 5).build();
    let boxes = SceneBvh::build(&scene);
    let mut random = Random(11);
    let mut overlaps = 0;
    for k in 0..40 {
        let eye = random.in_cube(7.0);
        let full = boxes.view(&Viewpoint::free(eye), &Domain::Sphere).expect("a view");
        let polygon = PolygonId(6 + random.below(360) as u32);
        let first = corners(&scene, polygon);
        // One of its own that is close to the first, so that they overlap, or anywhere.
        let around = if k % 2 == 0 { first[0] * 0.5 + first[2] * 0.5 } else { random.in_cube(9.0) };
        let (u, v) = (random.in_cube(1.5), random.in_cube(1.5));
        let second = [around - u, around + v, around + u];
        let up = (k % 4 > 1).then(|| random.direction().normalize());
        let windows = Windows::polygon(polygon).and(&Windows::free(&second).expect("a triangle"));
        let windows = up.map_or(windows.clone(), |up| windows.within_hemisphere(up));
        let cones = [cone(&first, eye), cone(&second, eye)];
        let both = [cones[0].as_slice(), &cones[1]].concat();
        let [a, b, shared] = [&cones[0], &cones[1], &both].map(|normals| sums_within(&full, normals, up));
        overlaps += usize::from(shared.values().sum::<f64>() > 1e-6);
        let image = boxes.view(&Viewpoint::free(eye), &Domain::Window(windows)).expect("a view");
        check_image(&image).unwrap_or_else(|defect| panic!("view {k}: {defect}"));
        check_regions(&image).unwrap_or_else(|defect| panic!("view {k}: {defect}"));
        let seen = sums_of(&image);
        for polygon in seen.keys().chain(a.keys()).chain(b.keys()) {
            let of = |sums: &BTreeMap<_, f64>| sums.get(polygon).copied().unwrap_or(0.0);
            let (expected, seen) = (of(&a) + of(&b) - of(&shared), of(&seen));
            assert!((seen - expected).abs() < 1e-11, "view {k}, {polygon:?}: {seen} instead of {expected}");
        }
    }
    assert!(overlaps > 10, "{overlaps}");
}

/// Every direction by rational numbers: inside of a window, what the whole sphere shows; outside of all of them, nothing.
#[test]
fn directions_inside_of_windows_show_what_the_whole_sphere_shows_and_others_nothing() {
    let scene = cluttered_room(40, 3).build();
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
    let exact = |v: DVec3| v.to_array().map(|x| BigRational::from_float(x).expect("finite"));
    let minus = |a: DVec3, b: DVec3| {
        let (a, b) = (exact(a), exact(b));
        [0, 1, 2].map(|k| &a[k] - &b[k])
    };
    let determinant = |[a, b, c]: [&[BigRational; 3]; 3]| {
        let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
        &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)
    };
    let zero = BigRational::from_float(0.0).expect("finite");
    let mut random = Random(17);
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..8 {
        let eye = random.in_cube(6.0);
        let chosen: Vec<PolygonId> = (0..6).map(|_| PolygonId(random.below(scene.polygon_count()) as u32)).collect();
        let domain = Domain::Window(Windows::polygons(chosen.iter().copied()));
        let full = bsp.view(&Viewpoint::free(eye), &Domain::Sphere).expect("a view");
        let image = bsp.view(&Viewpoint::free(eye), &domain).expect("a view");
        for _ in 0..200 {
            // Towards a window, or anywhere.
            let towards = corners(&scene, chosen[random.below(6)]);
            let direction = if random.below(2) == 0 {
                random.direction()
            } else {
                towards[0] + (towards[2] - towards[0]) * random.within(-0.5, 1.5) - eye
            };
            let ray = exact(direction);
            // The sign is that of one half space or the other, all around.
            let is_inside = chosen.iter().any(|&polygon| {
                let points = corners(&scene, polygon);
                let from_eye: Vec<_> = points.iter().map(|&p| minus(p, eye)).collect();
                let len = points.len();
                let height = determinant([0, 1, 2].map(|k| &from_eye[k]));
                let side = |k: usize| determinant([&from_eye[k], &from_eye[(k + 1) % len], &ray]) * &height > zero;
                (0..len).all(side)
            });
            match (is_inside, image.locate(direction)) {
                (false, Location::Outside) => outside += 1,
                (true, Location::Cell(cell)) => {
                    if let Location::Cell(other) = full.locate(direction) {
                        assert_eq!(image.cell(cell).piece(), full.cell(other).piece());
                        inside += 1;
                    }
                }
                // On the side of a window: of no measure, and not met.
                (is_inside, location) => panic!("{direction} is inside: {is_inside}, {location:?}"),
            }
        }
    }
    assert!(inside > 200 && outside > 200, "{inside} {outside}");
}

#[test]
fn both_ways_agree_through_windows_and_cameras() {
    let scene = cluttered_room(50, 9).build();
    let mut random = Random(23);
    for k in 0..12 {
        let eye = Viewpoint::free(random.in_cube(7.0));
        let polygons = (0..4).map(|_| PolygonId(random.below(scene.polygon_count()) as u32)).collect::<Vec<_>>();
        let disc: Vec<DVec3> = {
            let (center, turn) = (random.in_cube(9.0), DQuat::from_axis_angle(random.direction().normalize(), 1.0));
            let angle = |k: i32| f64::from(k) * PI / 8.0;
            (0..16).map(|k| center + turn * DVec3::new(angle(k).cos(), angle(k).sin(), 0.0)).collect()
        };
        let windows = Windows::polygons(polygons).and(&Windows::free(&disc).expect("a disc"));
        let domain = match k % 3 {
            0 => Domain::Window(windows),
            1 => Domain::Window(windows.within_hemisphere(random.direction())),
            _ => Domain::Frustum(Frustum::new(random.direction(), DVec3::Z, 50.0, 1.5).expect("a camera")),
        };
        both_ways(&scene, &eye, &domain);
    }
}

/// The board is a plane through the eye's vertical, so that it hides exactly half.
#[test]
fn a_lamp_casts_the_shadow_that_is_known() {
    let lamp = rectangle([-1.0, -0.75], [1.0, 0.75], 3.0);
    let half = rectangle([-1.0, -0.75], [0.0, 0.75], 3.0);
    // Shows its front downwards, or upwards.
    for turned in [false, true] {
        let mut faces = Faces::default();
        let mut corners = lamp;
        if turned {
            corners.reverse();
        }
        faces.face(&corners);
        // Behind the lamp, and a wall far to one side.
        faces.face(&rectangle([-9.0, -9.0], [9.0, 9.0], 5.0));
        faces.face(&[[-8.0, -9.0, 0.0], [-8.0, 9.0, 0.0], [-8.0, 9.0, 4.0], [-8.0, -9.0, 4.0]].map(DVec3::from));
        let open = faces.build();
        faces.face(&rectangle([0.0, -9.0], [9.0, 9.0], 1.0));
        let shaded = faces.build();
        let domain = Domain::Window(Windows::polygon(PolygonId(0)).within_hemisphere(DVec3::Z));
        let [all, half] = [lamp.as_slice(), &half].map(|corners| {
            // Counter-clockwise seen from outside of the sphere.
            form_factor(&corners.iter().rev().copied().collect::<Vec<_>>(), DVec3::Z) + form_factor(corners, DVec3::Z)
        });
        for (scene, expected) in [(&open, all), (&shaded, half)] {
            for image in both_ways(scene, &Viewpoint::free(DVec3::ZERO), &domain) {
                let factors = image.form_factors().expect("there is a normal");
                let lit = factors.of(PolygonId(0));
                assert!((lit - expected).abs() < 1e-15, "{lit} instead of {expected}");
                assert!((factors.total() - all).abs() < 1e-15 && factors.background == 0.0);
                // Neither what is behind the lamp nor what is beside it.
                assert!(factors.polygons.iter().all(|sum| sum.polygon.0 % 3 == 0));
            }
        }
        // However much is behind the lamp or beside it, it is not even looked at.
        let mut random = Random(2);
        for _ in 0..500 {
            let beside = DVec3::new(4.0, 0.0, 0.0);
            let half = random.in_cube(0.2).abs() + 0.01;
            faces.cuboid(DVec3::new(0.0, 0.0, 7.0) + random.in_cube(2.0), half, DQuat::IDENTITY, false);
            faces.cuboid(beside + random.in_cube(1.0), half, DQuat::IDENTITY, false);
        }
        let image = SceneBvh::build(&faces.build()).view(&Viewpoint::free(DVec3::ZERO), &domain).expect("a view");
        assert!(image.stats().inserted <= 10, "{:?}", image.stats());
    }
}

#[test]
fn a_window_edge_on_or_around_the_eye_is_empty() {
    let mut faces = Faces::default();
    faces.face(&rectangle([-1.0, -1.0], [1.0, 1.0], 0.0));
    faces.face(&rectangle([-3.0, -3.0], [3.0, 3.0], 2.0));
    faces.face(&[[0.1, 0.2, 0.3], [1.7, 0.4, 0.9], [0.3, 1.1, 0.7]].map(DVec3::from));
    let scene = faces.build();
    let ring = corners(&scene, PolygonId(2));
    let own = |corners: &[DVec3]| Windows::free(corners).expect("a polygon");
    // Beside it in its plane, in line with an edge, on an edge, at a corner, inside.
    for (x, y) in [(4.0, 0.5), (5.0, 1.0), (0.25, 1.0), (1.0, -1.0), (0.0, 0.0)] {
        let eye = DVec3::new(x, y, 0.0);
        assert_empty(&scene, eye, &Windows::polygon(PolygonId(0)));
        assert_empty(&scene, eye, &own(&rectangle([-1.0, -1.0], [1.0, 1.0], 0.0)));
    }
    for eye in &ring {
        assert_empty(&scene, *eye, &Windows::polygon(PolygonId(2)));
        assert_empty(&scene, *eye, &own(&ring));
    }
    // None at all are empty too.
    assert_empty(&scene, DVec3::ZERO, &Windows::polygons([]));
    // Beside one that is edge-on another one counts.
    let both = Domain::Window(Windows::polygons([PolygonId(0), PolygonId(1)]));
    let [image, _] = both_ways(&scene, &Viewpoint::free(DVec3::ZERO), &both);
    let seen = image.solid_angles();
    assert!(seen.of(PolygonId(1)) > 1.0 && seen.of(PolygonId(0)) == 0.0 && seen.background == 0.0);
}

#[test]
fn windows_end_at_the_horizon() {
    let mut faces = Faces::default();
    // From below the floor to above it, one in the floor, one behind.
    faces.face(&[[3.0, -1.0, -1.0], [3.0, 1.0, -1.0], [3.0, 1.0, 1.0], [3.0, -1.0, 1.0]].map(DVec3::from));
    faces.face(&rectangle([-2.0, -2.0], [2.0, 2.0], 0.0));
    faces.face(&rectangle([-1.0, -1.0], [1.0, 1.0], -2.0));
    let scene = faces.build();
    let on_floor = Viewpoint::on_surface(&scene, PolygonId(1), Side::Front, DVec3::ZERO).expect("a floor");
    let upper = [[3.0, -1.0, 0.0], [3.0, 1.0, 0.0], [3.0, 1.0, 1.0], [3.0, -1.0, 1.0]].map(DVec3::from);
    let expected = solid_angle(&upper);
    let windows = Windows::polygons((0..3).map(PolygonId));
    for (viewpoint, windows) in [
        (on_floor, windows.clone().above_surface()),
        (Viewpoint::free(DVec3::ZERO), windows.clone().within_hemisphere(DVec3::Z * 7.0)),
    ] {
        for image in both_ways(&scene, &viewpoint, &Domain::Window(windows)) {
            let (seen, factors) = (image.solid_angles(), image.form_factors().expect("there is a normal"));
            assert!((seen.total() - expected).abs() < 1e-14 && (seen.of(PolygonId(0)) - expected).abs() < 1e-14);
            let factor = form_factor(&upper, DVec3::Z);
            assert!((factors.of(PolygonId(0)) - factor).abs() < 1e-15, "{factor}");
        }
    }
    // One behind the eye, or below the horizon, is a window all the same where there is no horizon.
    let behind = Windows::polygon(PolygonId(2));
    let from_above = Viewpoint::free(DVec3::new(0.0, 0.0, 1.0));
    let [image, _] = both_ways(&scene, &from_above, &Domain::Window(behind.clone()));
    let whole = solid_angle(&rectangle([-1.0, 1.0], [1.0, -1.0], -3.0));
    // The floor hides it.
    assert!((image.solid_angles().of(PolygonId(1)) - whole).abs() < 1e-14);
    assert_eq!(image.form_factors(), None);
    let above = Domain::Window(behind.within_hemisphere(DVec3::Z));
    assert_eq!(both_ways(&scene, &from_above, &above)[0].cell_count(), 0);
}

#[test]
fn windows_of_any_shape_are_taken_and_what_is_none_is_refused() {
    let mut faces = Faces::default();
    faces.face(&rectangle([-9.0, -9.0], [9.0, 9.0], 5.0));
    let scene = faces.build();
    let viewpoint = Viewpoint::free(DVec3::new(0.25, 0.5, 0.0));
    let l_shape = [[0., 0., 3.], [2., 0., 3.], [2., 1., 3.], [1., 1., 3.], [1., 2., 3.], [0., 2., 3.]].map(DVec3::from);
    let two = Windows::free(&rectangle([0.0, 0.0], [2.0, 1.0], 3.0)).expect("a rectangle");
    let two = two.and(&Windows::free(&rectangle([0.0, 1.0], [1.0, 2.0], 3.0)).expect("a rectangle"));
    let angles = [Windows::free(&l_shape).expect("an L"), two].map(|windows| {
        let [image, _] = both_ways(&scene, &viewpoint, &Domain::Window(windows));
        image.evidence().check(&scene, Arithmetic::Rational).expect("rational numbers agree");
        image.solid_angles().total()
    });
    assert!((angles[0] - angles[1]).abs() < 1e-14 && angles[0] > 0.1);
    // Corners in line are left out.
    let with_middles = [[0., 0., 3.], [0.5, 0., 3.], [1., 0., 3.], [1., 1., 3.], [0.5, 1., 3.], [0., 1., 3.]];
    let windows = Windows::free(&with_middles.map(DVec3::from)).expect("a square");
    assert!(matches!(windows.panes(), [Pane::Ring(ring)] if ring.len() == 4));
    both_ways(&scene, &viewpoint, &Domain::Window(windows));
    let refused = |corners: &[[f64; 3]]| Windows::free(&corners.iter().map(|&p| p.into()).collect::<Vec<_>>());
    assert_eq!(refused(&[[0.0; 3], [1.0; 3], [2.0; 3]]), Err(WindowError::NoArea));
    for corners in [
        vec![],
        vec![[0.0; 3], [1.0; 3]],
        vec![[0.0; 3], [1.0, 0.0, f64::NAN], [0.0, 1.0, 0.0]],
        vec![[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    ] {
        assert!(matches!(refused(&corners), Err(WindowError::NotAPolygon(_))), "{corners:?}");
    }
    let boxes = SceneBvh::build(&scene);
    let error = |windows: Windows| boxes.view(&viewpoint, &Domain::Window(windows)).expect_err("no such view");
    let unknown = ViewError::UnknownWindow { polygon: PolygonId(1), count: 1 };
    assert_eq!(error(Windows::polygons([PolygonId(0), PolygonId(1)])), unknown);
    let many =
        (0..40).map(|k| Windows::free(&rectangle([0.0, 0.1 * f64::from(k)], [0.1 * f64::from(k + 1), 5.0], 3.0)));
    let many = many.fold(Windows::polygons([]), |all, next| all.and(&next.expect("a rectangle")));
    let options = ViewOptions { max_cells: 50, ..ViewOptions::default() };
    let limited = boxes.view_with(&viewpoint, &Domain::Window(many.clone()), &options);
    assert_eq!(limited.expect_err("more cells than that"), ViewError::TooManyCells { limit: 50 });
    both_ways(&scene, &viewpoint, &Domain::Window(many));
    assert_eq!(error(Windows::polygon(PolygonId(0)).above_surface()), ViewError::NotOnSurface);
    assert_eq!(error(Windows::polygon(PolygonId(0)).within_hemisphere(DVec3::ZERO)), ViewError::BadNormal);
}

/// The formula is that of a rectangular pyramid; corners are rounded, which moves the sides of wide views by about 1e-15 of their length of pi.
#[test]
fn cameras_see_what_they_are_said_to_see() {
    let scene = cluttered_room(20, 4).build();
    let mut random = Random(31);
    for degrees in [1.0, 20.0, 90.0, 178.0, 179.0] {
        for aspect in [0.1, 1.0, 16.0 / 9.0] {
            let (towards, up) = (random.direction() * 3.0, random.direction());
            let frustum = Frustum::new(towards, up, degrees, aspect).expect("a camera");
            let eye = random.in_cube(6.0);
            let [image, _] = both_ways(&scene, &Viewpoint::free(eye), &Domain::Frustum(frustum));
            check_image(&image).unwrap_or_else(|defect| panic!("{defect}"));
            image.evidence().check(&scene, Arithmetic::Rational).expect("rational numbers agree");
            let frame = frustum.frame();
            let height = (degrees / 2.0f64).to_radians().tan();
            let at =
                |x: f64, y: f64| frame.towards() + frame.right() * (x * aspect * height) + frame.up() * (y * height);
            // The middle and just inside of the corners, but not just outside.
            assert!(frame.up().dot(up) > 0.0 && frame.towards().dot(towards.normalize()) > 1.0 - 1e-15);
            assert_ne!(image.locate(at(0.0, 0.0)), Location::Outside);
            for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                assert_ne!(image.locate(at(x * 0.999, y * 0.999)), Location::Outside);
                assert_eq!(image.locate(at(x * 1.001, y * 0.999)), Location::Outside);
                assert_eq!(image.locate(at(x * 0.999, y * 1.001)), Location::Outside);
                assert_eq!(image.locate(-at(x * 0.999, y * 0.999)), Location::Outside);
            }
        }
    }
    let error = |towards, up, degrees, aspect| Frustum::new(towards, up, degrees, aspect).expect_err("no camera");
    let [x, z, zero] = [DVec3::X, DVec3::Z, DVec3::ZERO];
    assert_eq!(error(zero, z, 60.0, 1.0), FrustumError::BadDirection);
    assert_eq!(error(DVec3::NAN, z, 60.0, 1.0), FrustumError::BadDirection);
    assert_eq!(error(x, zero, 60.0, 1.0), FrustumError::BadUp);
    assert_eq!(error(z * 2.0, -z, 60.0, 1.0), FrustumError::UpAlong);
    for degrees in [0.0, -1.0, 180.0, 500.0, f64::NAN, f64::INFINITY] {
        assert_eq!(error(x, z, degrees, 1.0), FrustumError::BadAngle);
    }
    for aspect in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(error(x, z, 60.0, aspect), FrustumError::BadAspect);
    }
    // Too thin for numbers that are not near 0.
    for (degrees, aspect) in [(1e-300, 1.0), (60.0, 1e-300), (60.0, 1e300)] {
        let (towards, up) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.3, -0.5, 0.7));
        assert_eq!(error(towards, up, degrees, aspect), FrustumError::Degenerate);
    }
}

/// With the memory of other views, of other domains, nothing changes.
#[test]
fn memory_of_other_views_changes_nothing() {
    let scene = cluttered_room(30, 6).build();
    let boxes = SceneBvh::build(&scene);
    let mut space = ViewSpace::new();
    let options = ViewOptions::default();
    let frustum = Frustum::new(DVec3::new(1.0, 2.0, -0.5), DVec3::Z, 60.0, 1.0).expect("a camera");
    let own = Windows::free(&rectangle([-1.0, -1.5], [1.25, 1.0], 6.5)).expect("a rectangle");
    let eye = Viewpoint::free(DVec3::new(0.3, 0.2, 0.1));
    for domain in [
        Domain::Window(Windows::polygons([PolygonId(0), PolygonId(40)])),
        Domain::Sphere,
        Domain::Frustum(frustum),
        Domain::Window(own.within_hemisphere(DVec3::Z)),
        Domain::Hemisphere(DVec3::Z),
    ] {
        let fresh = boxes.view(&eye, &domain).expect("a view");
        let again = boxes.view_in(&mut space, &eye, &domain, &options).expect("a view");
        nusselt::testing::check_same_bits(&fresh, again).unwrap_or_else(|defect| panic!("{domain:?}: {defect}"));
    }
}
