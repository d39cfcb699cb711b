//! The factors of a point sum to 1, and do not depend on how they are computed.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, SceneOrder, SurfaceIndex, Viewpoint};
use nusselt::factors::{By, PointError, PointSolver};
use nusselt::samples::{Kind, generate};
use nusselt::scene::Scene;

fn sample(kind: Kind, polygons: usize) -> (Scene, Vec<DVec3>) {
    let sample = generate(kind, polygons, 5).expect("a sample");
    let scene = sample.to_builder().build().expect("a scene");
    let points = sample.free_points(40, 7).into_iter().map(DVec3::from).collect();
    (scene, points)
}

const NORMALS: [DVec3; 4] = [DVec3::Z, DVec3::NEG_X, DVec3::new(0.1, -3.0, 1.0), DVec3::new(1e-9, 2e-9, -1e-9)];

#[test]
fn factors_of_a_point_sum_to_one() {
    for kind in [Kind::Room, Kind::Office, Kind::City] {
        let (scene, points) = sample(kind, 2_000);
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("a BSP");
        for order in [SceneOrder::new(&scene), bsp.into()] {
            for by in [By::Object, By::Polygon] {
                let solver = PointSolver::new(order.clone(), by);
                for (k, &eye) in points.iter().enumerate() {
                    let domain = Domain::Hemisphere(NORMALS[k % NORMALS.len()]);
                    let factors = solver.solve(&Viewpoint::free(eye), &domain).expect("a view");
                    assert!((factors.total() - 1.0).abs() < 1e-12, "{kind:?} {eye}: {}", factors.total());
                    assert!(factors.factors.iter().all(|(_, f)| *f > 0.0), "only what is not 0 is told");
                    assert!(factors.factors.is_sorted_by(|a, b| a.0 < b.0));
                }
            }
        }
    }
}

#[test]
fn precise_factors_are_the_plain_ones_to_within_the_errors_of_those() {
    let (scene, points) = sample(Kind::Office, 4_000);
    let order = SceneOrder::new(&scene);
    let mut differ = 0;
    for (k, &eye) in points.iter().enumerate() {
        let image = order.view(&Viewpoint::free(eye), &Domain::Hemisphere(NORMALS[k % 4])).expect("a view");
        let (plain, precise) = (image.form_factors().expect("above"), image.precise_form_factors().expect("above"));
        assert_eq!(plain.polygons.len(), precise.polygons.len());
        for (plain, precise) in plain.polygons.iter().zip(&precise.polygons) {
            assert_eq!(plain.polygon, precise.polygon);
            for (a, b) in [(plain.front, precise.front), (plain.back, precise.back)] {
                assert!((a - b).abs() < 1e-13, "{eye} {}: {a:e} {b:e}", plain.polygon);
                differ += usize::from(a.to_bits() != b.to_bits());
            }
        }
    }
    assert!(differ > 0, "nothing was refined");
}

#[test]
fn results_are_the_same_bits_for_any_number_of_threads() {
    let (scene, points) = sample(Kind::City, 1_000);
    let points: Vec<_> = points.iter().map(|&eye| (Viewpoint::free(eye), Domain::Hemisphere(DVec3::Z))).collect();
    let solver = PointSolver::new(SceneOrder::new(&scene), By::Polygon);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| solver.solve_all(&points)).expect("views")
    };
    let [one, four] = [with(1), with(4)];
    for (a, b) in one.iter().zip(&four) {
        let bits = |p: &nusselt::factors::PointFactors| {
            (p.background.to_bits(), p.factors.iter().map(|(k, f)| (*k, f.to_bits())).collect::<Vec<_>>())
        };
        assert_eq!(bits(a), bits(b));
    }
    assert_eq!(one.len(), points.len());
}

#[test]
fn a_sphere_has_no_form_factors() {
    let (scene, points) = sample(Kind::Room, 100);
    let solver = PointSolver::new(SceneOrder::new(&scene), By::Object);
    let good = (Viewpoint::free(points[0]), Domain::Hemisphere(DVec3::Z));
    let error = solver.solve_all(&[good, (Viewpoint::free(points[1]), Domain::Sphere)]).expect_err("a sphere");
    assert_eq!((error.index, error.source), (1, PointError::NoNormal));
}

#[test]
fn an_index_finds_the_surfaces_that_looking_at_all_of_them_finds() {
    let (scene, points) = sample(Kind::Office, 1_000);
    let index = SurfaceIndex::new(&scene);
    let mut found = 0;
    for polygon in scene.polygons() {
        for piece in polygon.pieces() {
            let corners: Vec<DVec3> = piece.points().collect();
            let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            for eye in [middle, corners[0], (corners[0] + corners[1]) / 2.0, middle + normal.normalize() * 1e-5] {
                for normal in [normal, -normal, DVec3::Z] {
                    let expected = Viewpoint::surface_at(&scene, eye, normal);
                    found += usize::from(expected.is_some());
                    assert_eq!(index.surface_at(eye, normal), expected, "{eye} {normal}");
                }
            }
        }
    }
    assert!(found > 1_000, "{found}");
    assert!(points.iter().all(|&eye| index.surface_at(eye, DVec3::Z).is_none()));
    let empty = Scene::builder().build().expect("nothing");
    assert_eq!(SurfaceIndex::new(&empty).surface_at(DVec3::ZERO, DVec3::Z), None);
}
