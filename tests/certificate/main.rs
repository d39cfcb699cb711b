//! Certificates of contour images: they hold, in both arithmetics, and every change that matters breaks them.

#[path = "../common/mod.rs"]
mod common;
mod mutants;
#[cfg(feature = "json")]
mod windows;

use common::scenes::{Case, generated, odd, soups};
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{ContourImage, Domain, ViewOptions, Viewpoint};
use nusselt::samples::{self, Kind};
use nusselt::scene::{Axis, Material, PieceId, PolygonId, Scene, Side, SupportingPlane};
use nusselt::verify::{Arithmetic, Evidence, EvidenceSliver, Extent, Rule};

fn image(scene: &Scene, viewpoint: &Viewpoint, domain: &Domain) -> ContourImage {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("epsilon is 0");
    bsp.view(viewpoint, domain).expect("a good viewpoint")
}

fn proved(scene: &Scene, evidence: &Evidence, arithmetic: Arithmetic, name: &str) -> [usize; 2] {
    match evidence.check(scene, arithmetic) {
        Ok(certificate) => [certificate.cells, certificate.great_circles],
        Err(defect) => panic!("{name}, {arithmetic:?}: {}", defect.to_rust(evidence, scene)),
    }
}

#[test]
fn views_of_generated_and_odd_scenes_are_proved_in_both_arithmetics() {
    let cases = generated(300, 1, 2).into_iter().chain(odd()).chain(soups(40));
    let mut views = 0;
    for Case { name, scene, eyes } in cases {
        for eye in eyes {
            let up = DVec3::new(0.25, -0.5, 1.0);
            for domain in [Domain::Sphere, Domain::Hemisphere(up), Domain::Hemisphere(DVec3::Z)] {
                let image = image(&scene, &Viewpoint::free(eye), &domain);
                let evidence = image.evidence();
                let fast = proved(&scene, &evidence, Arithmetic::Kernel, &name);
                assert_eq!(fast[0], image.cell_count());
                if domain != Domain::Sphere {
                    assert_eq!(proved(&scene, &evidence, Arithmetic::Rational, &name), fast, "{name}");
                }
                views += 1;
            }
        }
    }
    assert!(views > 200, "{views}");
}

#[test]
fn views_from_surfaces_are_proved() {
    let mut views = 0;
    for Case { name, scene, .. } in generated(300, 1, 1).into_iter().chain(odd()).chain(soups(10)) {
        for polygon in scene.polygons().step_by(scene.polygon_count().div_ceil(12)) {
            for side in [Side::Front, Side::Back] {
                let near = scene.bounds().map_or(DVec3::ZERO, |(low, high)| (low + high) * 0.5);
                let Ok(viewpoint) = Viewpoint::on_surface(&scene, polygon.id(), side, near) else { continue };
                let evidence = image(&scene, &viewpoint, &Domain::Above).evidence();
                proved(&scene, &evidence, Arithmetic::Kernel, &name);
                views += 1;
            }
        }
    }
    assert!(views > 100, "{views} surfaces to stand on");
}

#[test]
fn quadtrees_of_any_depth_are_proved() {
    let Case { scene, eyes, .. } = &generated(300, 1, 1)[1];
    let bsp = SceneBsp::build(scene, &BspOptions::default()).unwrap();
    for depth in 0..=4 {
        let options = ViewOptions { quadtree_depth: Some(depth), ..ViewOptions::default() };
        let image = bsp.view_with(&Viewpoint::free(eyes[0]), &Domain::Sphere, &options).unwrap();
        image.certify().unwrap();
    }
}

#[test]
fn coordinates_of_any_size_are_proved() {
    for Case { name, scene, eyes } in soups(12) {
        for exponent in [-1070, -500, 400, 1000] {
            let scale = 2f64.powi(exponent);
            let vertices: Vec<[f64; 3]> = scene.vertices().iter().map(|v| (*v * scale).to_array()).collect();
            let faces: Vec<Vec<usize>> = scene
                .polygons()
                .filter(|polygon| polygon.rings().len() == 1)
                .map(|polygon| polygon.rings()[0].iter().map(|v| v.index()).collect())
                .collect();
            let material = Material::new("grey");
            let scaled = Scene::builder().mesh(&vertices, &faces, material).build().unwrap();
            let evidence = image(&scaled, &Viewpoint::free(eyes[0] * scale), &Domain::Sphere).evidence();
            for arithmetic in [Arithmetic::Kernel, Arithmetic::Rational] {
                proved(&scaled, &evidence, arithmetic, &name);
            }
        }
    }
}

/// Boxes that pass through each other a little, seen with every epsilon.
fn with_epsilon(epsilon: f64, seed: u64) -> (Scene, ContourImage) {
    let scene = common::cluttered_room(25, seed).build();
    let bsp = SceneBsp::build(&scene, &BspOptions { epsilon, ..BspOptions::default() }).expect("a good epsilon");
    let image = bsp.view(&Viewpoint::free(DVec3::new(0.3, 0.2, 0.1)), &Domain::Sphere).expect("a finite eye");
    (scene, image)
}

#[test]
fn with_an_epsilon_only_recorded_slivers_are_excused() {
    let (mut excuses_needed, mut too_thick) = (0, 0);
    for seed in 1..=6 {
        for epsilon in [1e-6, 1e-3, 0.02, 0.3] {
            let (scene, image) = with_epsilon(epsilon, seed);
            let evidence = image.evidence();
            proved(&scene, &evidence, Arithmetic::Kernel, "with an epsilon");
            if seed == 1 {
                proved(&scene, &evidence, Arithmetic::Rational, "with an epsilon");
            }
            // Without them the order is wrong where it is wrong, and nothing else is.
            let strict = Evidence { slivers: Vec::new(), ..evidence.clone() };
            if let Err(defect) = strict.check(&scene, Arithmetic::Kernel) {
                assert_eq!(defect.rule(), Rule::Depth);
                strict.check_to(&scene, Arithmetic::Kernel, Extent::Cones).unwrap();
                excuses_needed += 1;
                // Nor is a sliver excused that is thicker than epsilon, as some are.
                let smaller = Evidence { epsilon: epsilon * 1e-3, ..evidence };
                if let Err(defect) = smaller.check(&scene, Arithmetic::Kernel) {
                    assert_eq!(defect.rule(), Rule::Depth);
                    too_thick += 1;
                }
            }
        }
    }
    assert!(
        excuses_needed > 3 && too_thick > 3,
        "{excuses_needed} wrong orders, {too_thick} of thick slivers: too few"
    );
}

#[test]
fn made_up_slivers_far_from_their_plane_excuse_nothing() {
    let (scene, image) = with_epsilon(0.0, 1);
    let mut evidence = image.evidence();
    let cell = evidence.cells.iter().position(|cell| cell.piece.is_some_and(|piece| piece.index() > 5)).unwrap();
    // What is behind: a wall of the room, which a ray through the cell meets.
    let behind = (0..6).map(PieceId).find(|&wall| {
        let mut changed = evidence.clone();
        changed.cells[cell].piece = Some(wall);
        changed.check_to(&scene, Arithmetic::Kernel, Extent::Cones).is_ok()
    });
    let (hidden, hiding) = (behind.unwrap(), evidence.cells[cell].piece.unwrap());
    evidence.cells[cell].piece = Some(hidden);
    evidence.epsilon = 1e-3;
    for piece in [hidden, hiding] {
        for of_plane in [hidden, hiding] {
            for beyond in [None, Some(Side::Front), Some(Side::Back)] {
                evidence.slivers.push(EvidenceSliver { piece, plane: scene.piece(of_plane).plane(), beyond });
            }
        }
    }
    assert_eq!(evidence.check(&scene, Arithmetic::Kernel).unwrap_err().rule(), Rule::Depth);
}

/// What docs/verification.md says a sliver can hide: a stick that is thinner than epsilon, seen along the plane, far before a wall.
#[test]
fn a_sliver_excuses_what_lies_along_its_plane_however_deep() {
    let wall = [[-5.0, -5.0, 2.0], [5.0, -5.0, 2.0], [5.0, 5.0, 2.0], [-5.0, 5.0, 2.0]];
    let stick = |half: f64| [[-half, -0.5, 1.0], [half, -0.5, 1.0], [half, 0.5, 1.0], [-half, 0.5, 1.0]];
    for (half, is_excused) in [(0.0004, true), (0.0016, false)] {
        let faces = [vec![0, 1, 2, 3], vec![4, 5, 6, 7]];
        let vertices = [wall, stick(half)].concat();
        let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().unwrap();
        let mut evidence = image(&scene, &Viewpoint::free(DVec3::ZERO), &Domain::Sphere).evidence();
        for cell in &mut evidence.cells {
            cell.piece = cell.piece.map(|_| PieceId(0));
        }
        assert_eq!(evidence.check(&scene, Arithmetic::Kernel).unwrap_err().rule(), Rule::Depth);
        let plane = SupportingPlane::Axis { axis: Axis::X, value: 0.0 };
        evidence.epsilon = 1e-3;
        evidence.slivers.push(EvidenceSliver { piece: PieceId(0), plane, beyond: None });
        for arithmetic in [Arithmetic::Kernel, Arithmetic::Rational] {
            assert_eq!(evidence.check(&scene, arithmetic).is_ok(), is_excused, "{half}");
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
    let unexcused = Evidence { slivers: Vec::new(), ..evidence };
    unexcused.check(&scene, Arithmetic::Kernel).expect_err("the board hides a part of the floor");
}

#[test]
fn slivers_of_the_largest_epsilon_are_excused() {
    let (scene, image) = with_epsilon(f64::MAX, 1);
    let evidence = image.evidence();
    proved(&scene, &evidence, Arithmetic::Kernel, "the largest epsilon");
    let unexcused = Evidence { slivers: Vec::new(), ..evidence };
    assert_eq!(unexcused.check(&scene, Arithmetic::Kernel).unwrap_err().rule(), Rule::Depth);
}
