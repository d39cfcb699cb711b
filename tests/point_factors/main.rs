//! Form factors from points against references that share nothing with the engine.

mod closed_forms;
mod closure;
mod rationals;
mod small;

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, SceneOrder, Viewpoint};
use nusselt::factors::{By, PointFactors, PointSolver};
use nusselt::scene::{Material, Scene};

/// Polygons by their corners; each is an object of its own.
fn scene(polygons: &[Vec<DVec3>]) -> Scene {
    let mut builder = Scene::builder();
    let material = builder.add_material(Material::new("grey"));
    for (k, polygon) in polygons.iter().enumerate() {
        let ring = polygon.iter().map(|&p| builder.add_vertex(p)).collect();
        let object = builder.add_object(&format!("polygon {k}"));
        builder.add_face(nusselt::scene::FaceSpec { rings: vec![ring], object, material });
    }
    builder.build().expect("a scene")
}

/// By both ways, which must agree as far as each is to be trusted.
fn both_ways(scene: &Scene, eye: DVec3, normal: DVec3) -> [PointFactors; 2] {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("a small scene");
    [SceneOrder::new(scene), bsp.into()].map(|order| {
        let solver = PointSolver::new(order, By::Polygon);
        let factors = solver.solve(&Viewpoint::free(eye), &Domain::Hemisphere(normal)).expect("a view");
        assert!((factors.total() - 1.0).abs() < 1e-12, "{}", factors.total());
        factors
    })
}

/// The factor of one polygon.
fn of(factors: &PointFactors, polygon: u32) -> f64 {
    factors.factors.iter().find(|(k, _)| *k == polygon).map_or(0.0, |(_, factor)| *factor)
}
