//! Scenes with viewpoints for outside opinions: generated ones, and odd ones.

use super::{Faces, Random, cluttered_room};
use glam::{DQuat, DVec3};
use nusselt::samples::{Kind, Mesh, cornell_box, generate};
use nusselt::scene::Scene;

/// A scene and where it is looked at from.
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) scene: Scene,
    pub(crate) eyes: Vec<DVec3>,
}

fn sample(name: String, mesh: &Mesh, eyes: usize) -> Case {
    let eyes = mesh.free_points(eyes, 5).into_iter().map(DVec3::from).collect();
    Case { name, scene: mesh.to_builder().build().expect("a generated scene"), eyes }
}

/// A Cornell box, rooms, offices and cities of about `polygons` polygons.
pub(crate) fn generated(polygons: usize, seeds: u64, eyes: usize) -> Vec<Case> {
    let mut cases = vec![sample("cornell".into(), &cornell_box(), eyes)];
    for kind in Kind::ALL {
        for seed in 1..=seeds {
            let mesh = generate(kind, polygons, seed).expect("a number of polygons that is allowed");
            cases.push(sample(format!("{kind} {seed}"), &mesh, eyes));
        }
    }
    cases
}

fn case(name: &str, faces: &Faces, eyes: &[[f64; 3]]) -> Case {
    Case { name: name.into(), scene: faces.build(), eyes: eyes.iter().copied().map(DVec3::from).collect() }
}

fn of(loops: &[&[[f64; 3]]]) -> Faces {
    let mut faces = Faces::default();
    for corners in loops {
        faces.face(&corners.iter().copied().map(DVec3::from).collect::<Vec<_>>());
    }
    faces
}

/// Walls whose edges hold vertices of others.
fn t_junctions() -> Faces {
    of(&[
        &[[-4.0, 3.0, -2.0], [4.0, 3.0, -2.0], [4.0, 3.0, 1.0], [-4.0, 3.0, 1.0]],
        &[[-4.0, 3.0, 1.0], [-1.0, 3.0, 1.0], [-1.0, 3.0, 3.0]],
        &[[-1.0, 3.0, 1.0], [0.3, 3.0, 1.0], [0.1, 3.5, 2.0]],
        &[[0.3, 3.0, 1.0], [4.0, 3.0, 1.0], [2.0, 4.0, 3.0]],
        &[[1.7, 3.0, 1.0], [2.9, 3.0, 1.0], [2.0, 1.0, 1.25]],
        &[[-4.0, 3.0, -2.0], [-4.0, 3.0, 1.0], [-4.0, -3.0, 0.7]],
    ])
}

/// Overlapping polygons in one axis-aligned plane, and in one slanted plane, x + y + z = 6.
fn coplanar() -> Faces {
    of(&[
        &[[-3.0, -1.0, 3.0], [1.0, -1.0, 3.0], [1.0, 2.0, 3.0], [-3.0, 2.0, 3.0]],
        &[[-1.0, -2.0, 3.0], [0.5, 3.0, 3.0], [-2.0, 3.0, 3.0]],
        &[[-2.0, 0.0, 3.0], [2.0, 0.5, 3.0], [2.0, 1.5, 3.0], [-2.0, 1.0, 3.0]],
        &[[6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 6.0]],
        &[[3.0, 3.0, 0.0], [5.0, 5.0, -4.0], [2.0, 3.0, 1.0]],
        &[[1.0, 4.0, 1.0], [4.0, 1.0, 1.0], [4.0, 0.0, 2.0], [0.0, 4.0, 2.0]],
        &[[0.0, 4.0, 2.0], [4.0, 0.0, 2.0], [4.0, 1.0, 1.0], [1.0, 4.0, 1.0]],
    ])
}

/// Triangles through one another.
fn interpenetrating(count: usize, seed: u64) -> Faces {
    let mut random = Random(seed);
    let mut faces = Faces::default();
    for _ in 0..count {
        let middle = random.direction().normalize() * 4.0;
        faces.face(&[(); 3].map(|()| middle + random.in_cube(3.0)));
    }
    faces
}

/// Beams each over the next.
fn cycle() -> Faces {
    let mut faces = Faces::default();
    for k in 0..3 {
        let turn = DQuat::from_rotation_z(f64::from(k) * std::f64::consts::TAU / 3.0);
        let corners = [[-3.0, 0.6, 0.5], [-3.0, 1.2, 0.5], [3.0, 1.2, -0.5], [3.0, 0.6, -0.5]];
        faces.face(&corners.map(|p| turn * DVec3::from(p)));
    }
    faces
}

/// Triangles stacked so that level k lies below all later ones, seen from the origin.
fn stacked(count: u32) -> Faces {
    let mut random = Random(31);
    let mut faces = Faces::default();
    for k in 0..count {
        let height = 1.0 + f64::from(k);
        let middle = random.in_cube(1.0);
        faces.face(&[(); 3].map(|()| {
            let p = (middle + random.in_cube(1.0)) * height;
            DVec3::new(p.x, p.y, height)
        }));
    }
    faces
}

/// Triangles and parallelograms on a small grid, full of coincidences, from points of the grid.
pub(crate) fn soups(count: u64) -> Vec<Case> {
    let soup = |seed| {
        let mut random = Random(seed * 7_919 + 1);
        let mut faces = Faces::default();
        let mut point = || DVec3::from([(); 3].map(|()| random.below(7) as f64 - 3.0));
        for k in 0..4 + seed % 20 {
            let [a, b, c] = [point(), point(), point()];
            if (b - a).cross(c - a) == DVec3::ZERO {
                continue;
            }
            if k % 3 == 0 {
                faces.face(&[a, b, c, a + c - b])
            } else {
                faces.face(&[a, b, c])
            };
        }
        case(&format!("soup {seed}"), &faces, &[point().to_array(), (point() * 0.5).to_array()])
    };
    (0..count).map(soup).collect()
}

/// Degenerate scenes, some from viewpoints in planes of polygons, on edges and on vertices.
pub(crate) fn odd() -> Vec<Case> {
    let mut duplicated = t_junctions();
    for k in 0..duplicated.faces.len() {
        let mut turned = duplicated.faces[k].clone();
        turned.reverse();
        duplicated.faces.push(turned);
    }
    vec![
        case("t-junctions", &t_junctions(), &[[0.0, 0.0, 0.0], [0.1, -0.7, 0.3], [0.5, 6.0, 1.5], [-3.0, 2.0, 2.0]]),
        case("back to back", &duplicated, &[[0.0, 0.0, 0.0], [0.1, -0.7, 0.3], [0.5, 6.0, 1.5]]),
        case("coplanar", &coplanar(), &[[0.0, 0.0, 0.0], [-0.3, 0.2, 0.1], [7.0, 5.0, 6.0], [1.0, 1.0, 9.0]]),
        case("crossing", &interpenetrating(24, 3), &[[0.0, 0.0, 0.0], [0.3, -0.2, 0.5], [5.0, 6.0, -2.0]]),
        case("overlapping boxes", &cluttered_room(30, 9), &[[0.3, -7.0, 2.0], [1.0, 2.0, 0.5], [12.0, 3.0, 14.0]]),
        case("stacked", &stacked(40), &[[0.0, 0.0, 0.0], [0.5, -9.0, 20.5]]),
        case("cycle", &cycle(), &[[0.0, 0.0, 6.0], [0.4, 0.3, -5.0], [3.0, -2.0, 1.0]]),
        // In planes of walls, on an edge, on vertices, on the surface.
        case(
            "in planes",
            &t_junctions(),
            &[[0.0, 3.0, 2.0], [6.0, 3.0, 1.0], [0.0, 3.0, 1.0], [-1.0, 3.0, 1.0], [-4.0, 3.0, -2.0], [0.0, 3.0, 0.0]],
        ),
        case("in coplanar planes", &coplanar(), &[[8.0, 1.0, 3.0], [2.0, 2.0, 2.0], [6.0, 0.0, 0.0], [0.0, 0.0, 3.0]]),
    ]
}
