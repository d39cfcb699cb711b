//! The hemicube and its variants against closed forms and against the exact contour image.

mod common;

use common::{Faces, cluttered_room};
use glam::{DQuat, DVec3};
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::hemicube::{BaselineError, Face, Hemicube, Rays};
use nusselt::integral::form_factor;
use nusselt::samples::{Kind, cornell_box, generate};
use nusselt::scene::{PieceId, PolygonId, Scene, Side};

fn free(eye: [f64; 3]) -> Viewpoint {
    Viewpoint::free(DVec3::from(eye))
}

fn of(loops: &[&[[f64; 3]]]) -> Scene {
    let mut faces = Faces::default();
    for corners in loops {
        faces.face(&corners.iter().copied().map(DVec3::from).collect::<Vec<_>>());
    }
    faces.build()
}

/// How many pixels a convex polygon's border may pass through, at most: its error is at most this times the
/// largest form factor of a pixel. A straight line passes at most 2 n pixels of a face; it is seen on at most 3 faces.
fn border_pixels(edges: usize, resolution: usize) -> f64 {
    (edges * 6 * resolution) as f64
}

/// A pixel at the zenith has the largest form factor.
fn largest_pixel(resolution: usize) -> f64 {
    4.0 / (std::f64::consts::PI * (resolution * resolution) as f64)
}

fn exact(scene: &Scene, viewpoint: &Viewpoint, normal: DVec3) -> Vec<f64> {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("a small scene");
    let image = bsp.view(viewpoint, &Domain::Hemisphere(normal)).expect("a finite eye and normal");
    let sums = image.form_factors().expect("a hemisphere has a normal");
    (0..scene.polygon_count() as u32).map(|k| sums.of(PolygonId(k))).collect()
}

#[test]
fn a_rectangle_above_has_its_closed_form_to_within_its_border() {
    let (x, y) = (0.7, 0.4);
    let scene = of(&[&[[0.0, 0.0, 1.0], [x, 0.0, 1.0], [x, y, 1.0], [0.0, y, 1.0]]]);
    let [p, q] = [x.hypot(1.0), y.hypot(1.0)];
    let closed = ((y / p).atan() * x / p + (x / q).atan() * y / q) / std::f64::consts::TAU;
    let mut last = f64::INFINITY;
    for resolution in [2, 10, 64, 256, 1024] {
        let mut hemicube = Hemicube::new(&scene, resolution).unwrap();
        let view = hemicube.view(&free([0.0; 3]), DVec3::Z).unwrap();
        let error = (view.of(PolygonId(0)) - closed).abs();
        // Two sides lie on borders of pixels, and the others on one face.
        assert!(error <= (x + y) * resolution as f64 * largest_pixel(resolution), "{resolution}: {error}");
        assert!((view.total() - 1.0).abs() < 1e-13);
        assert!((view.background() - (1.0 - view.of(PolygonId(0)))).abs() < 1e-13);
        last = error;
        let analytic = hemicube.analytic(&free([0.0; 3]), DVec3::Z).unwrap();
        if resolution > 2 {
            assert!((analytic.of(PolygonId(0)) - closed).abs() < 1e-15, "{resolution}");
            assert_eq!(analytic.whole(), 1);
            let empty = analytic.background() / largest_pixel(resolution);
            assert!(analytic.evaluations() as f64 > empty, "one for each pixel of the background");
        }
    }
    assert!(last < 1e-3);
}

#[test]
fn a_rectangle_on_borders_of_pixels_is_exact() {
    let scene = of(&[&[[-0.5, -0.25, 1.0], [0.75, -0.25, 1.0], [0.75, 0.5, 1.0], [-0.5, 0.5, 1.0]]]);
    let corners: Vec<DVec3> = scene.vertices().to_vec();
    let factor = form_factor(&corners, DVec3::Z);
    for resolution in [8, 64, 512] {
        let mut hemicube = Hemicube::new(&scene, resolution).unwrap();
        let view = hemicube.view(&free([0.0; 3]), DVec3::Z).unwrap();
        assert!((view.of(PolygonId(0)) - factor).abs() < 1e-14, "{resolution}");
        assert_eq!(view.pieces(Face::Top).flatten().count() * 64, 10 * 6 * resolution * resolution / 4);
        assert!(Face::ALL[1..].iter().all(|&face| view.pieces(face).all(|piece| piece.is_none())));
    }
}

#[test]
fn a_closed_box_covers_everything() {
    let mut faces = Faces::default();
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -0.7, 1.1);
    faces.cuboid(DVec3::new(0.3, 0.1, -0.2), DVec3::new(3.0, 2.0, 1.0), turn, true);
    let scene = faces.build();
    for resolution in [2, 6, 64, 130] {
        let mut hemicube = Hemicube::new(&scene, resolution).unwrap();
        for normal in [DVec3::X, DVec3::NEG_Z, DVec3::new(1.0, -2.0, 0.3), DVec3::splat(-1e-200)] {
            let viewpoint = free([0.1, 0.2, 0.1]);
            let view = hemicube.view(&viewpoint, normal).unwrap();
            assert!(view.background() == 0.0);
            assert!((view.total() - 1.0).abs() < 1e-13);
            for (k, exact) in exact(&scene, &viewpoint, normal).into_iter().enumerate() {
                let error = (view.factors()[k] - exact).abs();
                let most = border_pixels(4, resolution) * largest_pixel(resolution);
                assert!(error <= most, "{resolution}, {normal}, {k}: {error}");
            }
        }
    }
}

#[test]
fn a_polygon_across_the_horizon_counts_above_it() {
    // A vertical wall, from far below the eye to above it, beside and behind it.
    let wall = [[1.0, -50.0, -30.0], [1.0, 60.0, -30.0], [1.0, 60.0, 2.0], [1.0, -50.0, 2.0]];
    let slant = [[-9.0, -9.0, -3.0], [9.0, -9.0, -3.0], [0.0, 9.0, 4.0]];
    for corners in [&wall[..], &slant[..]] {
        let scene = of(&[corners]);
        let mut hemicube = Hemicube::new(&scene, 512).unwrap();
        let view = hemicube.view(&free([0.0; 3]), DVec3::Z).unwrap();
        let found = view.of(PolygonId(0));
        let analytic = hemicube.analytic(&free([0.0; 3]), DVec3::Z).unwrap().of(PolygonId(0));
        let exact = exact(&scene, &free([0.0; 3]), DVec3::Z)[0];
        assert!(exact > 0.05);
        assert!((found - exact).abs() < 2e-3, "{found} {exact}");
        assert!((analytic - exact).abs() < 1e-14, "{analytic} {exact}");
    }
}

#[test]
fn below_behind_edge_on_or_around_the_eye_there_is_nothing() {
    let below = [[-5.0, -5.0, -0.1], [5.0, -5.0, -0.1], [5.0, 5.0, -0.1], [-5.0, 5.0, -0.1]];
    let edge_on = [[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [2.0, 0.0, 2.0]];
    let through = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 0.0, 3.0]];
    let at_vertex = [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0, 2.0]];
    for corners in [&below[..], &edge_on[..], &through[..], &at_vertex[..]] {
        let mut hemicube = Hemicube::new(&of(&[corners]), 64).unwrap();
        let view = hemicube.view(&free([0.0; 3]), DVec3::Z).unwrap();
        assert!(view.of(PolygonId(0)) == 0.0, "{corners:?}");
        assert!((view.background() - 1.0).abs() < 1e-13);
    }
}

#[test]
fn both_sides_hide_and_the_nearest_is_seen() {
    let square = |z: f64, half: f64| [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]];
    let near = square(1.0, 0.5);
    let mut far = square(2.0, 1.0);
    far.reverse();
    for (loops, nearest) in [([&near[..], &far[..]], 0), ([&far[..], &near[..]], 1)] {
        let mut hemicube = Hemicube::new(&of(&loops), 64).unwrap();
        let view = hemicube.view(&free([0.0; 3]), DVec3::Z).unwrap();
        let seen: Vec<_> = view.visible().map(|(polygon, _)| polygon).collect();
        assert_eq!(seen, [PolygonId(nearest)]);
    }
}

#[test]
fn factors_converge_to_those_of_the_contour_image() {
    let cornell = cornell_box();
    let room = generate(Kind::Room, 1000, 1).unwrap();
    for mesh in [&cornell, &room] {
        let scene = mesh.to_builder().build().unwrap();
        let points = mesh.free_points(3, 4);
        for (point, normal) in points.into_iter().zip([DVec3::Z, DVec3::new(-1.0, 0.3, 0.2), DVec3::NEG_Y]) {
            let viewpoint = free(point);
            let exact = exact(&scene, &viewpoint, normal);
            let mut worst = Vec::new();
            for resolution in [32, 128, 512] {
                let mut hemicube = Hemicube::new(&scene, resolution).unwrap();
                let view = hemicube.view(&viewpoint, normal).unwrap();
                assert!((view.total() - 1.0).abs() < 1e-12);
                let errors = view.factors().iter().zip(&exact).map(|(a, b)| (a - b).abs());
                let error = errors.fold(0.0, f64::max);
                // What is wrong is in pixels at the border of what is seen of a polygon: here, not more than 16 edges.
                assert!(error < border_pixels(16, resolution) * largest_pixel(resolution), "{resolution}: {error}");
                worst.push(error);
                let analytic = hemicube.analytic(&viewpoint, normal).unwrap();
                let errors = analytic.factors().iter().zip(&exact).map(|(a, b)| (a - b).abs());
                assert!(errors.fold(0.0, f64::max) < border_pixels(16, resolution) * largest_pixel(resolution));
                assert!((analytic.total() - 1.0).abs() < 0.2);
                assert!(analytic.evaluations() < 3 * resolution * resolution);
            }
            assert!(worst[2] < worst[0] / 3.0 && worst[2] < 1e-3, "{worst:?}");
        }
    }
}

#[test]
fn on_a_polygon_it_is_the_floor() {
    let scene = cluttered_room(20, 3).build();
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    for polygon in [0, 2, 5] {
        let near = DVec3::new(0.3, 0.4, 0.5);
        let viewpoint = Viewpoint::on_surface(&scene, PolygonId(polygon), Side::Front, near).unwrap();
        let image = bsp.view(&viewpoint, &Domain::Above).unwrap();
        let sums = image.form_factors().unwrap();
        let mut hemicube = Hemicube::new(&scene, 256).unwrap();
        let view = hemicube.view(&viewpoint, image.normal().unwrap()).unwrap();
        assert!(view.of(PolygonId(polygon)) == 0.0 && view.background() == 0.0);
        for (k, &factor) in view.factors().iter().enumerate() {
            assert!((factor - sums.of(PolygonId(k as u32))).abs() < 4e-3, "{polygon}: {k}");
        }
    }
}

#[test]
fn the_same_view_gives_the_same_bits_in_a_used_hemicube() {
    let mesh = generate(Kind::Office, 1000, 2).unwrap();
    let scene = mesh.to_builder().build().unwrap();
    let mut used = Hemicube::new(&scene, 128).unwrap();
    for point in mesh.free_points(6, 1) {
        let normal = DVec3::new(0.2, -0.1, 1.0);
        let mut fresh = Hemicube::new(&scene, 128).unwrap();
        let expected = fresh.view(&free(point), normal).unwrap();
        let view = used.view(&free(point), normal).unwrap();
        assert_eq!(view.factors(), expected.factors());
        assert_eq!(view.stats(), expected.stats());
        for face in Face::ALL {
            assert!(view.pieces(face).eq(expected.pieces(face)), "{face:?}");
        }
        let expected = fresh.analytic(&free(point), normal).unwrap();
        let analytic = used.analytic(&free(point), normal).unwrap();
        assert_eq!(analytic.factors(), expected.factors());
    }
}

#[test]
fn scaling_by_a_power_of_two_changes_nothing() {
    let mesh = cornell_box();
    let base = mesh.to_builder().build().unwrap();
    let point = DVec3::from(mesh.free_points(1, 9)[0]);
    let mut hemicube = Hemicube::new(&base, 64).unwrap();
    let expected = hemicube.view(&Viewpoint::free(point), DVec3::Y).unwrap().factors().to_vec();
    for exponent in [-900, -20, 3, 900] {
        let scale = 2.0_f64.powi(exponent);
        let mut faces = Faces::default();
        for polygon in base.polygons() {
            faces.face(&polygon.rings()[0].iter().map(|&v| base.vertex(v) * scale).collect::<Vec<_>>());
        }
        let mut hemicube = Hemicube::new(&faces.build(), 64).unwrap();
        let view = hemicube.view(&Viewpoint::free(point * scale), DVec3::Y).unwrap();
        assert_eq!(view.factors(), expected, "2^{exponent}");
    }
}

#[test]
fn hostile_coordinates_give_numbers_or_errors() {
    let values =
        [0.0, 1.0, -1.0, 1e300, -1e300, f64::MAX, f64::MIN, 1e-300, -1e-300, 5e-324, f64::MIN_POSITIVE, 1e-160];
    let mut state = 1_u64;
    let mut pick = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        values[(state >> 33) as usize % values.len()]
    };
    let mut scenes = 0;
    for _ in 0..300 {
        let mut point = || DVec3::new(pick(), pick(), pick());
        let vertices: Vec<[f64; 3]> = (0..9).map(|_| point().to_array()).collect();
        let faces = [vec![0, 1, 2], vec![3, 4, 5], vec![6, 7, 8]];
        let material = nusselt::scene::Material::new("grey");
        let Ok(scene) = Scene::builder().mesh(&vertices, &faces, material).build() else { continue };
        scenes += 1;
        let mut hemicube = Hemicube::new(&scene, 32).unwrap();
        for _ in 0..5 {
            let (eye, normal) = (point(), point());
            match hemicube.view(&Viewpoint::free(eye), normal) {
                Ok(view) => {
                    assert!(view.factors().iter().all(|&factor| (0.0..=1.0 + 1e-12).contains(&factor)));
                    assert!((view.total() - 1.0).abs() < 1e-12, "{vertices:?} {eye} {normal}");
                }
                Err(error) => assert!(error == BaselineError::BadNormal && normal == DVec3::ZERO),
            }
            if normal != DVec3::ZERO {
                let view = hemicube.analytic(&Viewpoint::free(eye), normal).unwrap();
                assert!(view.factors().iter().all(|&factor| (0.0..=3.0).contains(&factor)));
            }
        }
    }
    assert!(scenes > 100, "only {scenes} scenes were accepted");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let scene = of(&[&[[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]]]);
    for resolution in [0, 1, 3, 65, 4098, usize::MAX] {
        assert_eq!(Hemicube::new(&scene, resolution).err(), Some(BaselineError::BadResolution { resolution }));
    }
    let mut hemicube = Hemicube::new(&scene, 8).unwrap();
    assert_eq!(hemicube.view(&free([f64::NAN, 0.0, 0.0]), DVec3::Z).err(), Some(BaselineError::EyeNotFinite));
    for normal in [DVec3::ZERO, DVec3::splat(f64::NAN), DVec3::X * f64::INFINITY] {
        assert_eq!(hemicube.view(&free([0.0; 3]), normal).err(), Some(BaselineError::BadNormal));
    }
    let other = cluttered_room(3, 1).build();
    let elsewhere = Viewpoint::on_surface(&other, PolygonId(9), Side::Front, DVec3::ZERO).unwrap();
    let piece = elsewhere.surface_piece().unwrap().0;
    assert!(piece > PieceId(0));
    assert_eq!(hemicube.view(&elsewhere, DVec3::Z).err(), Some(BaselineError::NotInScene { piece }));
    let mut nothing = Hemicube::new(&Scene::builder().build().unwrap(), 8).unwrap();
    assert!((nothing.view(&free([0.0; 3]), DVec3::Z).unwrap().background() - 1.0).abs() < 1e-14);
}

#[test]
fn rays_are_within_five_standard_errors_of_the_contour_image() {
    let cornell = cornell_box();
    let room = generate(Kind::Room, 1000, 1).unwrap();
    for mesh in [&cornell, &room] {
        let scene = mesh.to_builder().build().unwrap();
        let mut rays = Rays::new(&scene);
        for (point, normal) in mesh.free_points(2, 4).into_iter().zip([DVec3::Z, DVec3::new(-1.0, 0.3, 0.2)]) {
            let exact = exact(&scene, &free(point), normal);
            for count in [1_000, 30_000, 200_000] {
                let view = rays.view(&free(point), normal, count, 5).unwrap();
                let n = f64::from(count);
                // A hit more or less for those of which there are too few for a standard error to mean anything.
                for (k, (found, exact)) in view.factors().zip(&exact).enumerate() {
                    let deviation = (exact * (1.0 - exact) / n).sqrt();
                    assert!((found - exact).abs() <= 5.0 * (deviation + 1.0 / n), "{k} of {count}: {found} {exact}");
                    let stated = view.standard_error(PolygonId(k as u32));
                    assert!((stated - (found * (1.0 - found) / n).sqrt()).abs() < 1e-15);
                }
                assert!((view.factors().sum::<f64>() + view.background() - 1.0).abs() < 1e-12);
                let open = 1.0 - exact.iter().sum::<f64>();
                let deviation = (open.max(0.0) * (1.0 - open) / n).sqrt();
                assert!((view.background() - open).abs() <= 5.0 * (deviation + 1.0 / n), "{}", view.background());
            }
        }
    }
}

#[test]
fn rays_give_the_same_for_the_same_seed_and_refuse_what_makes_no_sense() {
    let scene = cluttered_room(20, 3).build();
    let mut rays = Rays::new(&scene);
    let viewpoint = Viewpoint::on_surface(&scene, PolygonId(2), Side::Front, DVec3::ONE).unwrap();
    let normal = DVec3::Y;
    let first: Vec<f64> = rays.view(&viewpoint, normal, 5000, 1).unwrap().factors().collect();
    let other: Vec<f64> = rays.view(&viewpoint, normal, 5000, 2).unwrap().factors().collect();
    let again: Vec<f64> = rays.view(&viewpoint, normal, 5000, 1).unwrap().factors().collect();
    assert!(first == again && first != other && first[2] == 0.0);
    assert_eq!(rays.view(&viewpoint, normal, 0, 1).err(), Some(BaselineError::NoRays));
    assert_eq!(rays.view(&viewpoint, DVec3::ZERO, 9, 1).err(), Some(BaselineError::BadNormal));
    assert_eq!(rays.view(&free([f64::INFINITY, 0.0, 0.0]), normal, 9, 1).err(), Some(BaselineError::EyeNotFinite));
    let mut nothing = Rays::new(&Scene::builder().build().unwrap());
    assert!((nothing.view(&free([0.0; 3]), normal, 9, 1).unwrap().background() - 1.0).abs() < 1e-15);
}

#[test]
fn rays_come_from_any_distance() {
    // A square of 2 x 2 that faces the eye, in the middle of what it sees: 4 / (pi d^2) from afar.
    let square = |z: f64| [[-1.0, -1.0, z], [1.0, -1.0, z], [1.0, 1.0, z], [-1.0, 1.0, z]];
    let scene = of(&[&square(0.0), &square(1e-3)]);
    let mut rays = Rays::new(&scene);
    for distance in [3.0, 3.9, 4.1, 8.1, 20.0] {
        let n = 1_000_000;
        let view = rays.view(&free([0.0, 0.0, -distance]), DVec3::Z, n, 1).unwrap();
        let side = 1.0 / f64::hypot(1.0, distance);
        let exact = 4.0 / std::f64::consts::PI * side * side.atan();
        let found = view.of(PolygonId(0));
        // Never more than that of independent rays.
        let deviation = (exact * (1.0 - exact) / f64::from(n)).sqrt();
        assert!((found - exact).abs() < 5.0 * deviation, "{distance}: {found} instead of {exact}");
        assert_eq!(view.of(PolygonId(1)).to_bits(), 0, "it is behind the other one, by a thousandth");
    }
    // Past everything, away from it, and from where nothing is seen any more.
    for (eye, normal) in [([9.0, 0.0, 0.0], DVec3::X), ([1e300, 0.0, 0.0], -DVec3::X), ([0.0, -1e308, 1e308], DVec3::Y)]
    {
        let background = rays.view(&free(eye), normal, 1000, 1).unwrap().background();
        assert_eq!(background.to_bits(), 1.0f64.to_bits(), "{eye:?}");
    }
}

#[test]
fn rays_take_scenes_of_any_size() {
    for size in [1e300, 1e150, 1.0, 1e-150, 1e-300, 1e-310] {
        let corners = [[-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0]];
        let scene = of(&[&corners.map(|corner| corner.map(|x| x * size))]);
        let view = |rays: &mut Rays| rays.view(&free([0.0; 3]), DVec3::Z, 10_000, 1).unwrap().of(PolygonId(0));
        // 4 / pi * atan(1 / sqrt 2) / sqrt 2
        assert!((view(&mut Rays::new(&scene)) - 0.554_1).abs() < 0.01, "{size}");
    }
}
