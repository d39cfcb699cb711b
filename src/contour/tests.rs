//! The structure of contour images, from ordinary and from odd viewpoints.
//!
//! Every cell is checked with exact signs: it is convex, its corners lie where their definitions say,
//! and every stretch of its boundary has a neighbour that has it for a neighbour. The sum of solid
//! angles then excludes gaps and overlaps larger than rounding.

use super::directions::ExactCache;
use super::{ContourImage, Domain, Viewpoint};
use crate::bsp::{BspOptions, SceneBsp};
use crate::exact::Sign;
use crate::scene::{Material, PolygonId, Scene, Side};
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::PI;

fn solid_angle_of(image: &ContourImage) -> f64 {
    image.cells().map(super::Cell::solid_angle).sum()
}

fn check(image: &ContourImage) {
    let skeleton = &image.bsp().tree.skeleton;
    let mut cache = ExactCache::default();
    let mut across = BTreeSet::new();
    for cell in image.cells() {
        let arcs = cell.arcs();
        assert!(arcs.len() >= 3);
        for (k, arc) in arcs.iter().enumerate() {
            let next = arcs[(k + 1) % arcs.len()].from;
            let mut strictly_inside = 0;
            for other in arcs {
                let side = image.tree.directions.side(skeleton, other.from, arc.along.circle(), &mut cache);
                let inside = side * arc.along.inside();
                assert_ne!(inside, Sign::Negative, "a corner of {:?} is outside of its own side", cell.id());
                strictly_inside += usize::from(inside.is_positive());
                if other.from == arc.from || other.from == next {
                    assert_eq!(inside, Sign::Zero, "a side of {:?} does not pass through its corner", cell.id());
                }
            }
            assert!(strictly_inside > 0, "{:?} has no interior", cell.id());
        }
        for neighbour in cell.neighbours() {
            assert_ne!(neighbour.cell, Some(cell.id()));
            across.extend(neighbour.cell.map(|other| (cell.id(), other)));
        }
        let sides: BTreeSet<usize> = cell.neighbours().iter().map(|n| n.side).collect();
        assert_eq!(sides.len(), arcs.len(), "every side of {:?} has a neighbour", cell.id());
    }
    for &(a, b) in &across {
        assert!(across.contains(&(b, a)), "{a:?} is next to {b:?} but not the reverse");
    }
    let expected = if *image.domain() == Domain::Sphere { 4.0 * PI } else { 2.0 * PI };
    let total = solid_angle_of(image);
    assert!((total - expected).abs() < 1e-11, "the cells' solid angles sum to {total}");
}

/// A closed room with a table, a turned box, a pyramid, a wall without thickness and a T-junction.
fn room(scale: f64, offset: DVec3) -> (Scene, Vec<DVec3>) {
    let mut vertices = Vec::new();
    let mut faces: Vec<Vec<usize>> = Vec::new();
    let mut cuboid = |center: DVec3, half: DVec3, turn: f64| {
        let first = vertices.len();
        let turn = DQuat::from_rotation_z(turn);
        for k in 0..8 {
            let sign = |bit: usize| if k & bit == 0 { -1.0 } else { 1.0 };
            vertices.push(center + turn * (DVec3::new(sign(1), sign(2), sign(4)) * half));
        }
        for quad in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            faces.push(quad.iter().map(|k| k + first).collect());
        }
    };
    cuboid(DVec3::ZERO, DVec3::new(4.0, 3.0, 1.5), 0.0);
    cuboid(DVec3::new(1.0, 0.5, -1.25), DVec3::new(0.5, 0.75, 0.25), 0.0);
    cuboid(DVec3::new(-1.5, -1.0, -1.0), DVec3::new(0.5, 0.25, 0.5), 0.4);
    for face in &mut faces[..6] {
        face.reverse();
    }
    let first = vertices.len();
    vertices.extend(
        [[2.0, -2.0, -1.5], [3.0, -2.0, -1.5], [3.0, -1.0, -1.5], [2.0, -1.0, -1.5], [2.5, -1.5, 0.1]].map(DVec3::from),
    );
    for k in 0..4 {
        faces.push(vec![first + k, first + (k + 1) % 4, first + 4]);
    }
    // A wall without thickness, two coincident faces; then a face whose corner lies on its edge.
    let first = vertices.len();
    vertices.extend([[-3.0, 1.0, -1.5], [0.0, 1.0, -1.5], [0.0, 1.0, 0.5], [-3.0, 1.0, 0.5]].map(DVec3::from));
    faces.push((first..first + 4).collect());
    faces.push((first..first + 4).rev().collect());
    let corner = vertices.len();
    vertices.extend([[-1.5, 1.0, 0.5], [-2.0, 0.0, 0.5], [-1.0, 0.0, 0.5]].map(DVec3::from));
    faces.push(vec![corner, corner + 1, corner + 2]);
    let placed: Vec<DVec3> = vertices.iter().map(|&v| (v + offset) * scale).collect();
    let points: Vec<[f64; 3]> = placed.iter().map(DVec3::to_array).collect();
    (Scene::builder().mesh(&points, &faces, Material::new("m")).build().unwrap(), placed)
}

fn views(scene: &Scene, eyes: &[DVec3]) {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).unwrap();
    for &eye in eyes {
        for domain in [Domain::Sphere, Domain::Hemisphere(DVec3::Z), Domain::Hemisphere(DVec3::new(0.3, -0.2, 1e-9))] {
            check(&bsp.view(&Viewpoint::free(eye), &domain).unwrap());
        }
    }
}

#[test]
fn from_inside_and_outside_the_cells_tile() {
    let (scene, _) = room(1.0, DVec3::ZERO);
    views(&scene, &[DVec3::new(0.1, 0.2, 0.3), DVec3::new(7.0, 1.0, 2.0), DVec3::new(-1.4, -1.1, -1.0)]);
}

#[test]
fn on_vertices_edges_planes_and_corners_the_cells_tile() {
    let (scene, vertices) = room(1.0, DVec3::ZERO);
    let mut eyes: Vec<DVec3> = vertices.iter().copied().step_by(3).collect();
    for edge in scene.edges().iter().step_by(5) {
        eyes.push((scene.vertex(edge[0]) + scene.vertex(edge[1])) * 0.5);
    }
    eyes.extend([
        DVec3::new(0.3, 1.0, 1.0),
        DVec3::new(0.0, 0.5, -1.0),
        DVec3::new(-1.5, 1.0, 0.5),
        DVec3::new(-1.5, 0.5, 0.5),
        DVec3::new(1.5, 1.25, -1.0),
        DVec3::new(0.0, 3.0, 0.0),
    ]);
    views(&scene, &eyes);
}

#[test]
fn huge_tiny_and_far_scenes_tile() {
    for scale in [1e-150, 1e-30, 1e30, 1e140, f64::MIN_POSITIVE * 1e3] {
        let (scene, vertices) = room(scale, DVec3::ZERO);
        views(&scene, &[DVec3::new(0.1, 0.2, 0.3) * scale, vertices[3]]);
    }
    let (scene, _) = room(1.0, DVec3::splat(1_048_576.3));
    views(&scene, &[DVec3::splat(1_048_576.3) + DVec3::new(0.1, 0.2, 0.3)]);
    let (scene, _) = room(1.0, DVec3::ZERO);
    views(&scene, &[DVec3::new(1e-300, 0.1, 0.2), DVec3::new(0.1, 1e30, 3.0), DVec3::splat(f64::MAX / 4.0)]);
}

#[test]
fn on_a_surface_its_own_plane_is_the_horizon() {
    let (scene, _) = room(1.0, DVec3::ZERO);
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    for polygon in 0..scene.polygon_count() as u32 {
        for side in [Side::Front, Side::Back] {
            for near in [DVec3::new(0.1, 0.2, 0.3), DVec3::new(2.4, -1.4, 0.0), DVec3::new(9.0, 9.0, 9.0)] {
                let viewpoint = Viewpoint::on_surface(&scene, PolygonId(polygon), side, near).unwrap();
                let image = bsp.view(&viewpoint, &Domain::Above).unwrap();
                check(&image);
                assert!(image.form_factors().unwrap().polygons.iter().all(|sum| sum.polygon != PolygonId(polygon)));
                let factors = image.form_factors().unwrap();
                assert!((factors.total() - 1.0).abs() < 1e-12);
                if polygon < 6 && side == Side::Front && near.x < 4.0 {
                    assert!(factors.background < 1e-12, "inside of a closed room");
                }
            }
        }
    }
    let free = Viewpoint::free(DVec3::ZERO);
    assert!(bsp.view(&free, &Domain::Above).is_err());
    assert!(bsp.view(&free, &Domain::Hemisphere(DVec3::ZERO)).is_err());
    assert!(bsp.view(&Viewpoint::free(DVec3::NAN), &Domain::Sphere).is_err());
}

#[test]
fn a_scene_without_polygons_is_all_background() {
    let scene = Scene::builder().build().unwrap();
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    let image = bsp.view(&Viewpoint::free(DVec3::ONE), &Domain::Sphere).unwrap();
    check(&image);
    assert!((image.solid_angles().background - 4.0 * PI).abs() < 1e-14);
}

#[test]
fn the_quadtree_changes_no_sum() {
    let (scene, _) = room(1.0, DVec3::ZERO);
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    let viewpoint = Viewpoint::free(DVec3::new(0.1, 0.2, 0.3));
    let sums: Vec<_> = (0..5)
        .map(|depth| {
            let options = super::ViewOptions { quadtree_depth: Some(depth), ..Default::default() };
            let image = bsp.view_with(&viewpoint, &Domain::Hemisphere(DVec3::new(1.0, 2.0, 3.0)), &options).unwrap();
            check(&image);
            image.form_factors().unwrap()
        })
        .collect();
    for other in &sums[1..] {
        assert_eq!(other.polygons.len(), sums[0].polygons.len());
        for (a, b) in sums[0].polygons.iter().zip(&other.polygons) {
            assert_eq!(a.polygon, b.polygon);
            assert!((a.both() - b.both()).abs() < 1e-14);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn from_anywhere_on_a_coarse_grid_the_cells_tile(
        x in -10i8..10, y in -8i8..8, z in -4i8..4, nx in -2i8..3, ny in -2i8..3, nz in -2i8..3,
    ) {
        let (scene, _) = room(1.0, DVec3::ZERO);
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
        let eye = DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * 0.5;
        let normal = DVec3::new(f64::from(nx), f64::from(ny), f64::from(nz));
        let domain = if normal == DVec3::ZERO { Domain::Sphere } else { Domain::Hemisphere(normal) };
        check(&bsp.view(&Viewpoint::free(eye), &domain).unwrap());
    }
}
