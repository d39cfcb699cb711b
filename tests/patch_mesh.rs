//! Meshes of patches: what stands on a polygon covers each of its patches as a whole or not at all, and there are no T-junctions.

use glam::{DVec2, DVec3};
use nusselt::factors::PatchMesh;
use nusselt::samples::{Kind, cornell_box, generate};
use nusselt::scene::{Material, PolygonId, Scene};
use std::collections::{HashMap, HashSet};

type Key = [u64; 3];
/// Vertices and faces.
type Part = (Vec<[f64; 3]>, Vec<Vec<usize>>);

fn key(p: DVec3) -> Key {
    p.to_array().map(|x| (x + 0.0).to_bits())
}

fn sides(ring: &[DVec3]) -> impl Iterator<Item = [DVec3; 2]> + '_ {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
}

fn rings(patches: &Scene) -> Vec<Vec<DVec3>> {
    patches.polygons().map(|patch| patch.rings()[0].iter().map(|&v| patches.vertex(v)).collect()).collect()
}

fn area(ring: &[DVec3]) -> f64 {
    let doubled: DVec3 = sides(ring).map(|[a, b]| (a - ring[0]).cross(b - ring[0])).sum();
    doubled.length() / 2.0
}

/// A floor of some quadrilaterals, wider than 4 x 3, from z = 0 where x is below 2 and sloping up by `slope` beyond it.
fn floor(slope: f64, columns: &[f64]) -> Part {
    let at = |x: f64, y: f64| [x, y, slope * (x - 2.0).max(0.0)];
    let vertices = columns.iter().flat_map(|&x| [at(x, 0.0), at(x, 3.0)]).collect();
    let faces = (0..columns.len() - 1).map(|k| vec![2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1]).collect();
    (vertices, faces)
}

/// A block without a bottom over a square of half diagonals `half` about a middle, turned, which reaches below the floor if that is not flat.
fn block(middle: DVec2, half: f64, angle: f64, bottom: f64) -> (Vec<[f64; 3]>, Vec<Vec<usize>>, [DVec2; 4]) {
    let corner = |k: usize| middle + half * DVec2::from_angle(angle + std::f64::consts::FRAC_PI_2 * k as f64);
    let corners = [0, 1, 2, 3].map(corner);
    let vertices = [bottom, 1.5].into_iter().flat_map(|z| corners.map(|p| [p.x, p.y, z])).collect();
    let mut faces: Vec<Vec<usize>> = (0..4).map(|k| vec![k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k]).collect();
    faces.push(vec![4, 5, 6, 7]);
    (vertices, faces, corners)
}

fn scene(parts: &[Part]) -> Scene {
    let add = |builder: nusselt::scene::SceneBuilder, (vertices, faces): &Part| {
        builder.mesh(vertices, faces, Material::new("grey"))
    };
    parts.iter().fold(Scene::builder(), add).build().expect("a scene")
}

/// Every side of a patch is one of another patch of its polygon, or is on that polygon's outline; there, where two polygons share an edge, both have it.
fn check_sides(scene: &Scene, mesh: &PatchMesh) {
    let rings = rings(&mesh.patches().expect("a scene"));
    let mut known: HashMap<[Key; 2], Vec<PolygonId>> = HashMap::new();
    for (patch, ring) in rings.iter().enumerate() {
        for [a, b] in sides(ring) {
            known.entry([key(a), key(b)]).or_default().push(mesh.polygon(patch));
        }
    }
    let mut edges: HashMap<[Key; 2], usize> = HashMap::new();
    for polygon in scene.polygons() {
        for ring in polygon.rings() {
            let ring: Vec<DVec3> = ring.iter().map(|&v| scene.vertex(v)).collect();
            for [a, b] in sides(&ring) {
                *edges.entry([key(a).min(key(b)), key(a).max(key(b))]).or_default() += 1;
            }
        }
    }
    for (patch, ring) in rings.iter().enumerate() {
        let polygon = mesh.polygon(patch);
        for [a, b] in sides(ring) {
            let opposite = known.get(&[key(b), key(a)]).map_or(&[][..], Vec::as_slice);
            if opposite.contains(&polygon) {
                continue;
            }
            let outline: Vec<DVec3> = scene.polygon(polygon).rings()[0].iter().map(|&v| scene.vertex(v)).collect();
            let size = area(&outline).sqrt();
            let on = sides(&outline)
                .find(|&[p, q]| [a, b].iter().all(|r| (r - p).cross(q - p).length() <= 1e-12 * size * p.distance(q)));
            let [p, q] = on.unwrap_or_else(|| panic!("{a} {b} of {polygon} is no side of another patch"));
            let is_shared = edges[&[key(p).min(key(q)), key(p).max(key(q))]] == 2;
            assert!(!is_shared || opposite.len() == 1, "{a} {b} of {polygon}: its neighbour has another side");
        }
    }
}

fn check_areas(scene: &Scene, mesh: &PatchMesh) {
    let mut sums = vec![0.0; scene.polygon_count()];
    for (patch, ring) in rings(&mesh.patches().expect("a scene")).iter().enumerate() {
        sums[mesh.polygon(patch).index()] += area(ring);
    }
    for polygon in scene.polygons() {
        let pieces = polygon.pieces().map(|piece| area(&piece.points().collect::<Vec<_>>())).sum::<f64>();
        assert!((sums[polygon.id().index()] - pieces).abs() < 1e-9 * pieces, "{}", polygon.id());
    }
}

#[test]
fn patches_are_covered_as_a_whole_or_not_at_all() {
    let mut counted = [0; 2];
    for (k, columns) in [&[0.0, 4.0][..], &[0.0, 2.0, 4.0], &[0.0, 1.3, 2.0, 4.0]].into_iter().enumerate() {
        for step in 0..12 {
            let slope = if columns.len() == 2 { 0.0 } else { 0.3 * f64::from(step % 2) };
            let bottom = if step % 4 == 0 && slope == 0.0 { 0.0 } else { -0.2 };
            let middle = DVec2::new(1.9, 1.4 + 0.01 * f64::from(step));
            let angle = [0.0, 0.1, std::f64::consts::FRAC_PI_4][step as usize % 3] + 0.3 * k as f64;
            let (vertices, faces, corners) = block(middle, 0.83, angle, bottom);
            let scene = scene(&[floor(slope, columns), (vertices, faces)]);
            let longest = [0.5, 0.31, 1.0, 10.0][step as usize % 4];
            let mut mesh = PatchMesh::new(&scene, longest).expect("a mesh");
            for round in 0..2 {
                check_sides(&scene, &mesh);
                check_areas(&scene, &mesh);
                let mut regions: [HashSet<PolygonId>; 2] = Default::default();
                let rings = rings(&mesh.patches().expect("a scene"));
                for (patch, ring) in rings.iter().enumerate() {
                    if mesh.polygon(patch).index() >= columns.len() - 1 {
                        continue;
                    }
                    // How far corners are inside of the block's outline. Cuts are moved by a ten-thousandth of a side or so at most.
                    let depth = |p: DVec2| {
                        let side = |j: usize| (corners[(j + 1) % 4] - corners[j]).normalize().perp_dot(p - corners[j]);
                        (0..4).map(side).fold(f64::INFINITY, f64::min)
                    };
                    let depths: Vec<f64> = ring.iter().map(|p| depth(p.truncate())).collect();
                    let slack = 1e-3 * longest.min(4.0);
                    let is_covered = depths.iter().all(|&depth| depth >= -slack);
                    // Convex: no corner is inside, and the middle is not.
                    let middle = ring.iter().sum::<DVec3>() / ring.len() as f64;
                    let is_free = depths.iter().all(|&depth| depth <= slack) && depth(middle.truncate()) <= 0.0;
                    assert!(is_covered || is_free, "{ring:?} under {corners:?}");
                    regions[usize::from(is_covered)].insert(mesh.regions()[patch]);
                    counted[usize::from(is_covered)] += 1;
                }
                assert!(
                    regions[0].is_disjoint(&regions[1]),
                    "what is below the block is connected with what is beside it"
                );
                if round == 0 {
                    let (finer, parents) = mesh.halved(|patch| patch % 5 == 0);
                    assert!(finer.len() > mesh.len() && parents.is_sorted());
                    mesh = finer;
                }
            }
        }
    }
    assert!(counted.iter().all(|&count| count > 500), "{counted:?}");
}

#[test]
fn what_lies_on_a_polygon_cuts_it_and_walls_beside_it_do_not() {
    let square = |low: f64, high: f64, z: f64| vec![[low, low, z], [high, low, z], [high, high, z], [low, high, z]];
    let face = || vec![vec![0, 1, 2, 3]];
    // A rug in the plane of the floor, one that hangs just above it, and one that hangs too high.
    for (z, is_cut) in [(0.0, true), (1e-4, true), (0.1, false), (-1e-4, false)] {
        let scene = scene(&[(square(0.0, 4.0, 0.0), face()), (square(1.1, 2.3, z), face())]);
        let mesh = PatchMesh::new(&scene, 1.0).expect("a mesh");
        let on_floor = mesh.polygons().iter().filter(|polygon| polygon.0 == 0).count();
        assert_eq!(on_floor > 16, is_cut, "{z}: {on_floor}");
        check_sides(&scene, &mesh);
        check_areas(&scene, &mesh);
    }
    // In rooms walls meet along edges, and nothing is cut.
    let room = generate(Kind::Room, 120, 3).expect("a scene").to_builder().build().expect("a scene");
    let mesh = PatchMesh::new(&room, f64::INFINITY).expect("a mesh");
    assert!(mesh.len() >= room.polygon_count());
    for (kind, longest) in [(Kind::Room, 0.6), (Kind::Office, 1.0), (Kind::City, 10.0)] {
        let scene = generate(kind, 300, 2).expect("a scene").to_builder().build().expect("a scene");
        check_areas(&scene, &PatchMesh::new(&scene, longest).expect("a mesh"));
    }
    let cornell = cornell_box().to_builder().build().expect("a scene");
    for longest in [40.0, 100.0, 300.0] {
        let mesh = PatchMesh::new(&cornell, longest).expect("a mesh");
        check_areas(&cornell, &mesh);
        let floor = (0..mesh.len()).filter(|&patch| mesh.polygon(patch).0 == 0);
        let regions: HashSet<PolygonId> = floor.map(|patch| mesh.regions()[patch]).collect();
        assert_eq!(regions.len(), 3, "the floor, and what is below two blocks");
    }
}

/// Of three polygons of one plane that are meshed together.
#[test]
fn joined_patches_are_covered_as_a_whole_too() {
    let (vertices, faces, corners) = block(DVec2::new(1.9, 1.4), 0.83, 0.1, 0.0);
    let scene = scene(&[floor(0.0, &[0.0, 1.3, 2.0, 4.0]), (vertices, faces)]);
    let (mesh, hosts) = PatchMesh::joined(&scene, 0.5).expect("a mesh");
    assert_eq!(&hosts[..4], [0, 0, 0, 3].map(PolygonId));
    let depth = |p: DVec2| {
        let side = |j: usize| (corners[(j + 1) % 4] - corners[j]).normalize().perp_dot(p - corners[j]);
        (0..4).map(side).fold(f64::INFINITY, f64::min)
    };
    let mut counted = [0; 2];
    for (patch, ring) in rings(&mesh.patches().expect("a scene")).iter().enumerate() {
        if mesh.polygon(patch).0 == 0 {
            // Cuts are moved by a ten-thousandth of a side or so at most.
            let depths: Vec<f64> = ring.iter().map(|p| depth(p.truncate())).collect();
            let is_covered = depths.iter().all(|&depth| depth >= -5e-4);
            assert!(is_covered || depths.iter().all(|&depth| depth <= 5e-4), "{ring:?} under {corners:?}");
            counted[usize::from(is_covered)] += 1;
        }
    }
    assert!(counted[0] > 40 && counted[1] > 5, "{counted:?}");
}
