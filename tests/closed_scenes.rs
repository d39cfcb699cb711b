//! In a closed scene every direction ends on a polygon and the form factors sum to 1.
//!
//! The tolerances are those the project promises: 1e-12 for a sum of form factors, 1e-11 for a sum of
//! solid angles; a sum of 50,000 cells, each rounded to about 1e-16, stays well below both.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{ContourImage, Domain, Viewpoint};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{PieceRef, PolygonId, PolygonRef, Side};
use std::f64::consts::PI;

fn check_sums(image: &ContourImage, what: &str) {
    let angles = image.solid_angles();
    let domain = if *image.domain() == Domain::Sphere { 4.0 * PI } else { 2.0 * PI };
    assert!((angles.total() - domain).abs() <= 1e-11, "{what}: solid angles sum to {}", angles.total());
    if let Some(factors) = image.form_factors() {
        assert!((factors.total() - 1.0).abs() <= 1e-12, "{what}: form factors sum to {}", factors.total());
    }
}

/// A hundred views from inside and some from the floor.
fn closed(kind: Kind, polygons: usize) {
    let mesh = generate(kind, polygons, 1).expect("a size the generator takes");
    let scene = mesh.to_builder().build().expect("a generated scene is valid");
    assert_eq!(scene.polygon_count(), polygons);
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
    assert!(bsp.fragment_count() <= 3 * polygons, "{kind} {polygons}: {} fragments", bsp.fragment_count());
    let normals = [DVec3::Z, DVec3::NEG_X, DVec3::new(0.3, -0.5, -0.2), DVec3::new(-1.0, 1.0, 1e-7)];
    for (k, point) in mesh.free_points(100, 3).into_iter().enumerate() {
        let what = format!("{kind} {polygons}, point {k}");
        let domain = if k % 10 == 9 { Domain::Sphere } else { Domain::Hemisphere(normals[k % 4]) };
        let image = bsp.view(&Viewpoint::free(DVec3::from(point)), &domain).expect("a finite eye");
        assert!(image.cells().all(|cell| cell.polygon().is_some()), "{what}: a background cell");
        check_sums(&image, &what);
    }
    let floor: Vec<PolygonId> = scene
        .polygons()
        .filter(|polygon| polygon.pieces().flat_map(PieceRef::points).all(|p| p.z == 0.0))
        .map(PolygonRef::id)
        .collect();
    for (k, point) in mesh.floor_points(10, 4).into_iter().enumerate() {
        let what = format!("{kind} {polygons}, floor point {k}");
        let point = DVec3::from(point);
        let (piece, side) = Viewpoint::surface_at(&scene, point, DVec3::Z).expect("a floor point lies on the floor");
        assert_eq!(side, Side::Front, "{what}");
        assert!(floor.contains(&scene.piece(piece).polygon()), "{what}");
        let viewpoint = Viewpoint::on_piece(&scene, piece, side, point).expect("a finite point");
        let image = bsp.view(&viewpoint, &Domain::Above).expect("a viewpoint on a surface");
        check_sums(&image, &what);
        assert!(image.form_factors().is_some_and(|factors| factors.background < 1e-12), "{what}: background is seen");
    }
}

#[test]
fn rooms_of_1_000_polygons_are_closed() {
    closed(Kind::Room, 1_000);
}

#[test]
fn rooms_of_10_000_polygons_are_closed() {
    closed(Kind::Room, 10_000);
}

#[test]
fn rooms_of_50_000_polygons_are_closed() {
    closed(Kind::Room, 50_000);
}

#[test]
fn offices_of_1_000_polygons_are_closed() {
    closed(Kind::Office, 1_000);
}

#[test]
fn offices_of_10_000_polygons_are_closed() {
    closed(Kind::Office, 10_000);
}

#[test]
fn offices_of_50_000_polygons_are_closed() {
    closed(Kind::Office, 50_000);
}

#[test]
fn cities_of_1_000_polygons_are_closed() {
    closed(Kind::City, 1_000);
}

#[test]
fn cities_of_10_000_polygons_are_closed() {
    closed(Kind::City, 10_000);
}

#[test]
fn cities_of_50_000_polygons_are_closed() {
    closed(Kind::City, 50_000);
}
