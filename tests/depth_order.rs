//! What is in front of what: the hard cases, and random ones against rays.

mod common;

use common::{Faces, Random, cluttered_room};
use glam::{DQuat, DVec3};
use nusselt::bsp::{BspError, BspOptions, SceneBsp};
use nusselt::contour::{ContourImage, Domain, Location, ViewError, ViewOptions, Viewpoint};
use nusselt::scene::{PolygonId, Scene, Side};
use nusselt::verify::{RayAnswer, RayOracle};

fn view(scene: &Scene, eye: DVec3) -> ContourImage {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("epsilon is 0");
    bsp.view(&Viewpoint::free(eye), &Domain::Sphere).expect("the eye is finite")
}

fn seen(image: &ContourImage, direction: DVec3) -> Option<(PolygonId, Side)> {
    match image.locate(direction) {
        Location::Cell(cell) => {
            let cell = image.cell(cell);
            cell.polygon().zip(cell.side())
        }
        other => panic!("{direction} is {other:?}"),
    }
}

/// Compares with the oracle; gives the number of directions that had an answer.
fn compare(image: &ContourImage, oracle: &RayOracle, directions: impl Iterator<Item = DVec3>) -> usize {
    let mut compared = 0;
    for direction in directions {
        let expected = match oracle.cast(image.viewpoint().eye(), direction) {
            RayAnswer::Hit { polygon, side, .. } => Some((polygon, side)),
            RayAnswer::Miss => None,
            RayAnswer::Boundary => continue,
        };
        if matches!(image.locate(direction), Location::Arc { .. } | Location::Vertex { .. }) {
            continue;
        }
        assert_eq!(seen(image, direction), expected, "from {} towards {direction}", image.viewpoint().eye());
        compared += 1;
    }
    compared
}

#[test]
fn a_hundred_thousand_rays_agree() {
    let mut random = Random(11);
    let mut compared = 0;
    for (boxes, rays) in [(0, 5_000), (3, 5_000), (30, 30_000), (160, 60_000)] {
        let scene = cluttered_room(boxes, 3 + boxes as u64).build();
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
        let oracle = RayOracle::new(&scene);
        for _ in 0..10 {
            let eye = random.in_cube(11.0);
            let image = bsp.view(&Viewpoint::free(eye), &Domain::Sphere).unwrap();
            compared += compare(&image, &oracle, (0..rays / 10).map(|_| random.direction()));
        }
    }
    assert!(compared > 99_990, "{compared} directions had an answer");
}

#[test]
fn the_middle_of_every_cell_shows_what_a_ray_meets() {
    let scene = cluttered_room(60, 77).build();
    let oracle = RayOracle::new(&scene);
    let image = view(&scene, DVec3::new(0.3, -7.0, 2.0));
    let middles: Vec<DVec3> = image.cells().map(|cell| cell.boundary().sum::<DVec3>()).collect();
    let compared = compare(&image, &oracle, middles.iter().copied());
    assert!(compared * 100 > middles.len() * 99, "{compared} of {}", middles.len());
}

/// Three beams, each over the next.
fn beams() -> Faces {
    let mut faces = Faces::default();
    for k in 0..3 {
        let turn = DQuat::from_rotation_z(f64::from(k) * std::f64::consts::TAU / 3.0);
        let corners = [[-3.0, 0.6, 0.5], [-3.0, 1.2, 0.5], [3.0, 1.2, -0.5], [3.0, 0.6, -0.5]];
        faces.face(&corners.map(|p| turn * DVec3::from(p)));
    }
    faces
}

#[test]
fn beams_that_overlap_in_a_cycle_are_cut() {
    let scene = beams().build();
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    assert!(bsp.stats().splits > 0);
    let oracle = RayOracle::new(&scene);
    let mut random = Random(5);
    for eye in [DVec3::new(0.0, 0.0, 9.0), DVec3::new(0.1, 0.2, -8.0), DVec3::new(3.0, -2.0, 1.0)] {
        let image = bsp.view(&Viewpoint::free(eye), &Domain::Sphere).unwrap();
        let towards = (0..3_000).map(|_| random.in_cube(2.5) * DVec3::new(1.0, 1.0, 0.1) - eye);
        assert!(compare(&image, &oracle, towards) > 2_900);
    }
    let image = bsp.view(&Viewpoint::free(DVec3::new(0.0, 0.0, 9.0)), &Domain::Sphere).unwrap();
    assert_eq!(image.solid_angles().polygons.len(), 3);
}

#[test]
fn polygons_that_pass_through_each_other_are_cut_where_they_meet() {
    let mut faces = Faces::default();
    let square = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let level = faces.face(&square.map(|[x, y]| DVec3::new(x, y, 0.0)));
    let tilted = faces.face(&square.map(|[x, y]| DVec3::new(x, y, 0.5 * x)));
    let image = view(&faces.build(), DVec3::new(0.1, 0.2, 5.0));
    let [level, tilted] = [level, tilted].map(|k| PolygonId(k as u32));
    let towards = |x, y| DVec3::new(x, y, 0.0) - DVec3::new(0.1, 0.2, 5.0);
    assert_eq!(seen(&image, towards(0.15, 0.7)), Some((tilted, Side::Front)));
    assert_eq!(seen(&image, towards(-0.15, 0.7)), Some((level, Side::Front)));
    let angles = image.solid_angles();
    assert!((angles.total() - 4.0 * std::f64::consts::PI).abs() < 1e-14);
}

#[test]
fn of_two_coincident_faces_back_to_back_each_side_sees_its_own_front() {
    let quad = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.3 * x));
    let mut back = quad;
    back.reverse();
    let mut faces = Faces::default();
    let up = PolygonId(faces.face(&quad) as u32);
    let down = PolygonId(faces.face(&back) as u32);
    let target = DVec3::new(0.4, 0.6, 0.12);
    for (eye, polygon) in [(DVec3::new(0.3, 0.2, 2.0), up), (DVec3::new(0.3, 0.2, -2.0), down)] {
        let image = view(&faces.build(), eye);
        assert_eq!(seen(&image, target - eye), Some((polygon, Side::Front)));
        assert_eq!(image.solid_angles().polygons.len(), 1);
    }
}

#[test]
fn of_coplanar_fronts_that_overlap_the_lowest_number_is_seen() {
    let quad = |x: f64| [[x, 0.0], [x + 2.0, 0.0], [x + 2.0, 2.0], [x, 2.0]].map(|[x, y]| DVec3::new(x, y, y));
    let mut faces = Faces::default();
    for x in [0.0, 1.0, 0.0] {
        faces.face(&quad(x));
    }
    let scene = faces.build();
    let eye = DVec3::new(0.7, -1.0, 4.0);
    let image = view(&scene, eye);
    let towards = |x: f64| DVec3::new(x, 1.0, 1.0) - eye;
    assert_eq!(seen(&image, towards(0.5)), Some((PolygonId(0), Side::Front)));
    assert_eq!(seen(&image, towards(1.5)), Some((PolygonId(0), Side::Front)));
    assert_eq!(seen(&image, towards(2.5)), Some((PolygonId(1), Side::Front)));
    let oracle = RayOracle::new(&scene);
    let mut random = Random(9);
    let towards = (0..2_000).map(|_| DVec3::new(random.within(-0.5, 3.5), random.within(-0.5, 2.5), 1.0) - eye);
    assert!(compare(&image, &oracle, towards) > 1_990);
}

#[test]
fn with_epsilon_the_cells_still_tile() {
    let scene = cluttered_room(80, 5).build();
    for epsilon in [1e-9, 1e-3, 0.3] {
        let bsp = SceneBsp::build(&scene, &BspOptions { epsilon, ..BspOptions::default() }).unwrap();
        assert_eq!(bsp.uncut_slivers().len(), bsp.stats().uncut_slivers);
        let image = bsp.view(&Viewpoint::free(DVec3::new(9.0, 0.1, 0.2)), &Domain::Sphere).unwrap();
        assert!((image.solid_angles().total() - 4.0 * std::f64::consts::PI).abs() < 1e-11);
    }
    let bsp = SceneBsp::build(&scene, &BspOptions { epsilon: 0.3, ..BspOptions::default() }).unwrap();
    assert!(bsp.stats().uncut_slivers > 0);
    assert!(SceneBsp::build(&scene, &BspOptions { epsilon: f64::NAN, ..BspOptions::default() }).is_err());
    assert!(SceneBsp::build(&scene, &BspOptions { epsilon: -1.0, ..BspOptions::default() }).is_err());
}

/// `n` long triangles that all pass through each other.
fn crossing_slivers(n: usize) -> Faces {
    let mut faces = Faces::default();
    let mut random = Random(8);
    for _ in 0..n {
        let along = random.direction().normalize();
        let across = along.cross(random.direction()).normalize();
        let offset = random.in_cube(0.3);
        let corners = [[-10.0, -0.5], [10.0, -0.5], [10.0, 0.5]];
        faces.face(&corners.map(|[x, y]| offset + along * x + across * y));
    }
    faces
}

#[test]
fn limits_end_with_an_error() {
    let scene = crossing_slivers(60).build();
    let limited = BspOptions { max_fragments: Some(100), ..BspOptions::default() };
    let error = SceneBsp::build(&scene, &limited).unwrap_err();
    assert_eq!(error, BspError::TooManyFragments { limit: 100 });
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
    let limited = ViewOptions { max_cells: 100, ..ViewOptions::default() };
    let eye = Viewpoint::free(DVec3::new(3.0, 2.0, 20.0));
    let error = bsp.view_with(&eye, &Domain::Sphere, &limited).unwrap_err();
    assert_eq!(error, ViewError::TooManyCells { limit: 100 });
    let deep = |depth| ViewOptions { quadtree_depth: Some(depth), max_cells: usize::MAX, ..ViewOptions::default() };
    let error = bsp.view_with(&eye, &Domain::Sphere, &deep(9)).unwrap_err();
    assert_eq!(error, ViewError::TooDeep { depth: 9 });
    assert!(bsp.view_with(&eye, &Domain::Sphere, &deep(2)).is_ok());
    let image = bsp.view(&eye, &Domain::Sphere).unwrap();
    let oracle = RayOracle::new(&scene);
    let mut random = Random(3);
    assert!(compare(&image, &oracle, (0..2_000).map(|_| random.in_cube(5.0) - eye.eye())) > 1_990);
}
