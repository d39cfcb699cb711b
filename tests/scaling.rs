//! Scaling a scene by a power of two changes nothing but lengths: the same tree, the same cells, the same
//! factors, at any magnitude that f64 has.

mod common;

use common::{Faces, cluttered_room};
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Cell, Domain, ViewOptions, Viewpoint};
use nusselt::scene::{Material, Scene, Side};

fn scaled(faces: &Faces, scale: f64) -> Scene {
    let mut faces = faces.clone();
    for vertex in &mut faces.vertices {
        *vertex = vertex.map(|x| x * scale);
    }
    faces.build()
}

#[test]
fn powers_of_two_change_no_count_and_no_factor() {
    let faces = cluttered_room(20, 12);
    let results: Vec<_> = [0, 100, -100, 480, -480, 600, -600, 900, -850]
        .into_iter()
        .map(|exponent| {
            let scale = 2f64.powi(exponent);
            let scene = scaled(&faces, scale);
            for epsilon in [0.0, 0.01 * scale] {
                let bsp = SceneBsp::build(&scene, &BspOptions { epsilon, ..BspOptions::default() }).unwrap();
                assert!(bsp.stats().nodes > 100, "2^{exponent}, epsilon {epsilon}: {:?}", bsp.stats());
            }
            let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
            let eye = Viewpoint::free(DVec3::new(9.0, -9.5, 9.25) * scale);
            let image = bsp.view(&eye, &Domain::Hemisphere(DVec3::new(-1.0, 1.0, -0.5) * scale)).unwrap();
            for cell in image.cells() {
                let middle = cell.boundary().sum::<DVec3>();
                assert!(cell.point_at(middle.normalize()).is_some(), "2^{exponent}: a part has no place in space");
            }
            (*bsp.stats(), image.cell_count(), image.form_factors().unwrap())
        })
        .collect();
    for (stats, cells, factors) in &results[1..] {
        assert_eq!((stats, cells), (&results[0].0, &results[0].1));
        for (a, b) in factors.polygons.iter().zip(&results[0].2.polygons) {
            assert_eq!(a.polygon, b.polygon);
            assert!((a.both() - b.both()).abs() < 1e-14);
        }
    }
}

#[test]
fn standing_on_surfaces_works_at_any_scale() {
    let quad = [[0.0, 0.0, 0.0], [4.0, 0.0, 1.0], [4.0, 3.0, 1.0], [0.0, 3.0, 0.0]].map(DVec3::from);
    for exponent in [0, 300, -300, 660, -660, 900, -900] {
        let scale = 2f64.powi(exponent);
        let mut faces = Faces::default();
        faces.face(&quad.map(|p| p * scale));
        let scene = faces.build();
        let polygon = scene.polygon(nusselt::scene::PolygonId(0)).id();
        let corner = Viewpoint::on_surface(&scene, polygon, Side::Front, DVec3::new(9.0, -3.0, 1.0) * scale).unwrap();
        assert!(corner.eye().distance(DVec3::new(4.0, 0.0, 1.0) * scale) <= 1e-15 * scale, "2^{exponent}: {corner:?}");
        for normal in [1.0, 1e-200, 1e200].map(|length| DVec3::new(-0.25, 0.0, 1.0) * length) {
            let on = Viewpoint::surface_at(&scene, DVec3::new(2.0, 1.0, 0.5) * scale, normal);
            assert_eq!(on.map(|(_, side)| side), Some(Side::Front), "2^{exponent}");
            assert_eq!(Viewpoint::surface_at(&scene, DVec3::new(2.0, 1.0, 0.6) * scale, normal), None, "2^{exponent}");
        }
    }
}

#[test]
fn what_is_seen_in_steps_of_the_least_number_is_what_is_seen_in_whole_numbers() {
    // A triangle and one that it hides in part, with boxes whose middles are no multiples of the least number.
    let near = [[-2.0, -3.0, 2.0], [-1.0, 0.0, 0.0], [-2.0, -2.0, 3.0]];
    let far = [[1.0, -3.0, 5.0], [3.0, -3.0, 5.0], [2.0, -4.0, 4.0]];
    let eye = DVec3::new(-3.0, 1.0, -1.0);
    let seen = [1.0, f64::from_bits(1)].map(|scale| {
        let vertices: Vec<_> = near.iter().chain(&far).map(|p| p.map(|x| x * scale)).collect();
        let faces = [vec![0, 1, 2], vec![3, 4, 5]];
        let scene = Scene::builder().mesh(&vertices, &faces, Material::new("m")).build().unwrap();
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
        let options = ViewOptions { quadtree_depth: Some(0), ..ViewOptions::default() };
        let image = bsp.view_with(&Viewpoint::free(eye * scale), &Domain::Sphere, &options).unwrap();
        let mut seen: Vec<_> = image.cells().filter_map(Cell::polygon).collect();
        seen.sort_unstable();
        seen.dedup();
        seen
    });
    assert_eq!(seen[0], seen[1]);
    assert_eq!(seen[0].len(), 2);
}
