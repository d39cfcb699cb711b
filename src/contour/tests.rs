//! The structure of contour images, from ordinary and from odd viewpoints.
//!
//! Every cell is checked with exact signs: it is convex, its corners lie where their definitions say,
//! and every stretch of its boundary has a neighbour that has it for a neighbour. The sum of solid
//! angles then excludes gaps and overlaps larger than rounding.

use super::directions::ExactCache;
use super::{ContourImage, Domain, Quadtree, Spacing, Viewpoint};
use crate::bsp::{BspOptions, SceneBsp};
use crate::bvh::SceneBvh;
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
    let skeleton = image.skeleton();
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

#[test]
fn every_level_of_the_quadtree_quarters_all_squares() {
    let scene = Scene::builder().build().unwrap();
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    for (depth, cells) in [(0, 8), (1, 32), (2, 112), (3, 416)] {
        let options = super::ViewOptions { quadtree_depth: Some(depth), ..Default::default() };
        let image = bsp.view_with(&Viewpoint::free(DVec3::ONE), &Domain::Sphere, &options).unwrap();
        check(&image);
        assert_eq!(image.cells().len(), cells, "level {depth}");
        if depth == 0 {
            continue;
        }
        // Eight octants of three quarter faces; one of these is in two leaves, so squares on its diagonal are halves.
        // A square of size h takes h^2 / 3^(3/2) at a corner of the cube to h^2 in the middle of a face.
        let square = 0.25f64.powi(depth as i32 - 1);
        for cell in image.cells() {
            let solid_angle = cell.solid_angle();
            assert!(solid_angle > square * 0.09 && solid_angle < square, "level {depth}: {solid_angle}");
        }
    }
}

#[test]
fn a_quadtree_on_an_image_plane_has_even_squares_or_even_angles() {
    let scene = Scene::builder().build().unwrap();
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    let viewpoint = Viewpoint::free(DVec3::ONE);
    for normal in [DVec3::Z, DVec3::NEG_X, DVec3::new(1.0, -2.0, 3.0) * 1e-300] {
        let domain = Domain::Hemisphere(normal);
        let towards = (normal / normal.abs().max_element()).normalize();
        for (degrees, spacing) in [(90.0, Spacing::Even), (170.0, Spacing::TowardsCentre), (1e-3, Spacing::Even)] {
            let quadtree = Quadtree::Plane { degrees, spacing };
            let options = super::ViewOptions { quadtree_depth: Some(3), quadtree, ..Default::default() };
            let image = bsp.view_with(&viewpoint, &domain, &options).unwrap();
            check(&image);
            // The corners of cells in the plane: the coordinates of eight squares a side, at most one of which octants cut.
            let (u, v) = towards.any_orthonormal_pair();
            let steps = |d: DVec3, across: DVec3| {
                let x = d.dot(across) / d.dot(towards);
                let half = f64::to_radians(degrees / 2.0);
                let x = if spacing == Spacing::Even { x / half.tan() } else { x.atan() / half };
                x * 4.0
            };
            let inside = |x: f64| x.abs() < 4.0 + 1e-9;
            let corners = image.cells().flat_map(|cell| cell.boundary().collect::<Vec<_>>());
            let grid: BTreeSet<_> = corners
                .filter(|d| d.dot(towards) > 1e-9)
                .map(|d| [steps(d, u), steps(d, v)])
                .filter(|x| x.iter().all(|&x| inside(x) && (x - x.round()).abs() < 1e-6))
                .map(|x| x.map(|x| x.round() as i32))
                .collect();
            assert_eq!(grid.len(), 81, "{normal} {quadtree:?}");
        }
    }
    for (degrees, domain) in [
        (90.0, Domain::Sphere),
        (0.0, Domain::Hemisphere(DVec3::Z)),
        (180.0, Domain::Hemisphere(DVec3::Z)),
        (f64::NAN, Domain::Hemisphere(DVec3::Z)),
    ] {
        let quadtree = Quadtree::Plane { degrees, spacing: Spacing::Even };
        let options = super::ViewOptions { quadtree, ..Default::default() };
        assert_eq!(bsp.view_with(&viewpoint, &domain, &options).unwrap_err(), super::ViewError::NoImagePlane);
    }
}

#[test]
fn splitters_are_drawn_once_along_their_whole_length() {
    let scene = Scene::builder().build().unwrap();
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    let options = super::ViewOptions { quadtree_depth: Some(0), ..Default::default() };
    // Three great circles; above the horizon that itself and halves of two others, or of three others.
    let tilted = Domain::Hemisphere(DVec3::new(1.0, 2.0, 3.0));
    let [above, below] = [DVec3::Z, DVec3::NEG_Z].map(Domain::Hemisphere);
    for (domain, turns) in [(Domain::Sphere, 3.0), (above, 2.0), (below, 2.0), (tilted, 2.5)] {
        let image = bsp.view_with(&Viewpoint::free(DVec3::ONE), &domain, &options).unwrap();
        let arcs = image.tree_arcs();
        let length: f64 = arcs.iter().map(|arc| arc.ends[0].angle_between(arc.ends[1])).sum();
        assert!((length - turns * 2.0 * PI).abs() < 1e-12, "{domain:?}: {length}");
        let middles = arcs.iter().map(|arc| (arc.ends[0] + arc.ends[1]).normalize());
        let middles: BTreeSet<_> = middles.map(|m| (m * 1e9).round().as_i64vec3().to_array()).collect();
        assert_eq!(middles.len(), arcs.len(), "{domain:?}: an arc twice");
    }
}

#[test]
fn rays_meet_the_plane_of_what_is_seen() {
    let (scene, _) = room(1.0, DVec3::new(5.0, -7.0, 11.0));
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    let eye = DVec3::new(5.1, -6.8, 11.3);
    let image = bsp.view(&Viewpoint::free(eye), &Domain::Sphere).unwrap();
    for cell in image.cells() {
        let inside: DVec3 = cell.arcs().iter().map(|arc| image.tree.directions.unit(arc.from)).sum();
        let point = cell.point_at(inside.normalize()).expect("a closed room");
        let corners: Vec<DVec3> = scene.piece(cell.piece().unwrap()).points().collect();
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        assert!(normal.dot(point - corners[0]).abs() < 1e-12, "{point}");
        assert!((point - eye).normalize().distance(inside.normalize()) < 1e-12, "{point}");
    }
}

#[test]
fn what_a_view_takes_is_counted() {
    let stats = |scale: f64, eye: DVec3| {
        let (scene, _) = room(scale, DVec3::ZERO);
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
        let image = bsp.view(&Viewpoint::free(eye * scale), &Domain::Sphere).unwrap();
        let seen: BTreeSet<_> = image.cells().filter_map(super::Cell::piece).collect();
        assert!(image.stats().inserted >= seen.len() && image.stats().visited_nodes as usize >= seen.len());
        image.stats().predicates
    };
    let generic = stats(1.0, DVec3::new(0.123, 0.234, 0.345));
    let special = stats(1.0, DVec3::new(0.0, 0.5, -1.0));
    assert_eq!(generic.arbitrary, 0);
    assert_eq!(special.arbitrary, 0);
    assert!(special.identity > 0 && special.fixed > 0, "{special:?}");
    // Of the calls the filter decides most, and it decides no more than there are.
    assert!(special.filter > special.undecided() && special.filter < 100_000, "{special:?}");
    // The same on a grid of which all coordinates take a thousand bits.
    let (scene, _) = room(1.0, DVec3::ZERO);
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    let eye = DVec3::new(f64::from_bits(1), 0.5, -1.0);
    let wide = *bsp.view(&Viewpoint::free(eye), &Domain::Sphere).unwrap().stats();
    assert!(wide.predicates.arbitrary > 0, "{wide:?}");
}

#[test]
fn every_side_asked_for_is_counted_once() {
    // Three corners of each of eight octants are held against the horizon, and it passes through two of them:
    // the filter is sure of one corner of each.
    let scene = Scene::builder().build().unwrap();
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    let options = super::ViewOptions { quadtree_depth: Some(0), ..Default::default() };
    let domain = Domain::Hemisphere(DVec3::Z);
    let image = bsp.view_with(&Viewpoint::free(DVec3::ONE), &domain, &options).unwrap();
    let predicates = image.stats().predicates;
    assert_eq!((predicates.calls(), predicates.filter), (24, 8), "{predicates:?}");
}

#[test]
fn what_a_wall_hides_is_left_out() {
    let square = |x: f64, middle: [f64; 2], half: f64| {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        corners.map(|[y, z]| [x, middle[0] + half * y, middle[1] + half * z])
    };
    let mut vertices = square(1.0, [0.0, 0.0], 10.0).to_vec();
    for k in 0..64u8 {
        let middle = [f64::from(k % 8) - 3.5, f64::from(k / 8) - 3.5];
        // Farther than all of the wall.
        vertices.extend(square(20.0 + f64::from(k % 4), middle, 0.3));
    }
    let faces: Vec<Vec<usize>> = (0..65).map(|k| (4 * k..4 * k + 4).collect()).collect();
    let scene = Scene::builder().mesh(&vertices, &faces, Material::new("m")).build().unwrap();
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    let image = bsp.view(&Viewpoint::free(DVec3::new(0.0, 0.1, 0.2)), &Domain::Sphere).unwrap();
    assert!(image.stats().skipped_subtrees > 0 && image.stats().inserted < 65, "{:?}", image.stats());
    let boxes = SceneBvh::build(&scene);
    let image = boxes.view(&Viewpoint::free(DVec3::new(0.0, 0.1, 0.2)), &Domain::Sphere).unwrap();
    assert!(image.stats().skipped_subtrees > 0, "{:?}", image.stats());
    assert!((1..65).contains(&image.stats().inserted), "{:?}", image.stats());
}

#[test]
fn no_view_has_more_cells_than_allowed_and_none_fails_for_less() {
    let (scene, eyes) = room(1.0, DVec3::ZERO);
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    let boxes = SceneBvh::build(&scene);
    for eye in eyes {
        let eye = Viewpoint::free(eye);
        let views = |max_cells: usize| {
            let options = super::ViewOptions { max_cells, ..Default::default() };
            [bsp.view_with(&eye, &Domain::Sphere, &options), boxes.view_with(&eye, &Domain::Sphere, &options)]
        };
        let counts = views(usize::MAX).map(|view| view.unwrap().cell_count());
        for (k, count) in counts.into_iter().enumerate() {
            for limit in [0, 9, count / 2, count - 1] {
                let error = views(limit)[k].as_ref().err().cloned();
                assert_eq!(error, Some(super::ViewError::TooManyCells { limit }), "of {count} cells");
            }
            assert_eq!(views(count)[k].as_ref().map(ContourImage::cell_count), Ok(count));
        }
    }
}

#[test]
fn memory_of_other_views_changes_nothing() {
    use super::{ViewOptions, ViewSpace};
    use crate::samples::{Kind, generate};
    let bits = |image: &ContourImage| {
        let cells = image.cells().map(|cell| {
            let corners = cell.boundary().flat_map(|d| d.to_array().map(f64::to_bits));
            (cell.polygon(), cell.side(), corners.collect::<Vec<_>>())
        });
        (cells.collect::<Vec<_>>(), *image.stats(), image.form_factors())
    };
    let options = ViewOptions::default();
    let mut space = ViewSpace::new();
    // Larger and smaller scenes in turn, by both ways, with views that fail between them.
    for (kind, polygons) in [(Kind::City, 300), (Kind::Room, 800), (Kind::Office, 200), (Kind::Room, 100)] {
        let mesh = generate(kind, polygons, 1).expect("a scene");
        let scene = mesh.to_builder().build().expect("a valid scene");
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("a tree");
        let boxes = SceneBvh::build(&scene);
        for point in mesh.free_points(3, 5) {
            let eye = Viewpoint::free(DVec3::from(point));
            for domain in [Domain::Sphere, Domain::Hemisphere(DVec3::new(1.0, 2.0, 3.0))] {
                let by_bsp = bits(bsp.view_in(&mut space, &eye, &domain, &options).expect("a view"));
                assert_eq!(by_bsp, bits(&bsp.view(&eye, &domain).expect("a view")));
                assert!(boxes.view_in(&mut space, &eye, &Domain::Above, &options).is_err());
                let by_boxes = bits(boxes.view_in(&mut space, &eye, &domain, &options).expect("a view"));
                assert_eq!(by_boxes, bits(&boxes.view(&eye, &domain).expect("a view")));
                assert!(!by_boxes.0.is_empty());
            }
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
