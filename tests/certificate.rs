//! Certificates of contour images: they hold, in both arithmetics, and every change that matters breaks them.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{ContourImage, Domain, Viewpoint};
use nusselt::samples::{self, Kind};
use nusselt::scene::{PolygonId, Scene, Side};
use nusselt::verify::Arithmetic;

fn image(scene: &Scene, viewpoint: &Viewpoint, domain: &Domain) -> ContourImage {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("epsilon is 0");
    bsp.view(viewpoint, domain).expect("a good viewpoint")
}

fn inside(scene: &Scene, x: f64, y: f64, z: f64) -> DVec3 {
    let (low, high) = scene.bounds().expect("not empty");
    low + (high - low) * DVec3::new(x, y, z)
}

#[test]
fn generated_scenes_are_proved_in_both_arithmetics() {
    for kind in [Kind::Room, Kind::Office, Kind::City] {
        for (size, seed) in [(150, 1), (600, 2)] {
            let scene = samples::generate(kind, size, seed).unwrap().to_builder().build().unwrap();
            for (eye, domain) in [
                (inside(&scene, 0.31, 0.42, 0.5), Domain::Sphere),
                (inside(&scene, 0.5, 0.5, 0.9), Domain::Hemisphere(DVec3::new(0.2, 0.1, -1.0))),
                (inside(&scene, 0.75, 0.25, 0.0), Domain::Hemisphere(DVec3::Z)),
            ] {
                let image = image(&scene, &Viewpoint::free(eye), &domain);
                let evidence = image.evidence();
                let fast =
                    evidence.check(&scene, Arithmetic::Kernel).unwrap_or_else(|defect| panic!("{kind:?} {defect}"));
                let slow =
                    evidence.check(&scene, Arithmetic::Rational).unwrap_or_else(|defect| panic!("{kind:?} {defect}"));
                assert_eq!((fast.cells, fast.great_circles), (slow.cells, slow.great_circles));
                assert_eq!(fast.cells, image.cell_count());
            }
            let polygon = PolygonId(scene.polygon_count() as u32 / 3);
            let viewpoint = Viewpoint::on_surface(&scene, polygon, Side::Front, DVec3::ZERO).unwrap();
            image(&scene, &viewpoint, &Domain::Above).certify().unwrap();
        }
    }
}

#[test]
fn slivers_of_pieces_seen_nearly_edge_on_are_excused() {
    // The eye is at a corner of a cabinet, 1e-17 off the plane of a board of its plinth that epsilon puts into the floor.
    let scene = samples::generate(Kind::Room, 800, 4).unwrap().to_builder().build().unwrap();
    let bsp = SceneBsp::build(&scene, &BspOptions { epsilon: 0.05, ..BspOptions::default() }).unwrap();
    let near = DVec3::new(5.749_107_008_204_405, 0.258_606_870_985_603_25, 1.618_469_767_080_595_2);
    let viewpoint = Viewpoint::on_surface(&scene, PolygonId(631), Side::Front, near).unwrap();
    let evidence = bsp.view(&viewpoint, &Domain::Above).unwrap().evidence();
    evidence.check(&scene, Arithmetic::Kernel).unwrap_or_else(|defect| panic!("{defect}"));
    let unexcused = nusselt::verify::Evidence { slivers: Vec::new(), ..evidence };
    unexcused.check(&scene, Arithmetic::Kernel).expect_err("the board hides a part of the floor");
}
