//! What the sample scenes promise: exact counts, closed surfaces, free points, the same bits everywhere.

use glam::DVec3;
use nusselt::exact::{Sign, orient3d};
use nusselt::samples::{GenerateError, Kind, MAX_POLYGONS, MIN_POLYGONS, Mesh, MeshFace, cornell_box, generate};
use nusselt::scene::Axis;
use std::collections::{HashMap, HashSet};
use std::path::Path;

fn scene(kind: Kind, polygons: usize, seed: u64) -> Mesh {
    generate(kind, polygons, seed).unwrap_or_else(|error| panic!("{error}"))
}

/// Some of every kind, small and middling, of odd and even size.
fn scenes() -> impl Iterator<Item = (String, Mesh)> {
    let sizes = [(64, 0), (65, 1), (100, 1), (333, 2), (1000, 1), (1001, 5), (4096, 3), (10_007, 4)];
    Kind::ALL.into_iter().flat_map(move |kind| {
        sizes.map(|(polygons, seed)| (format!("{kind} {polygons} {seed}"), scene(kind, polygons, seed)))
    })
}

fn at(mesh: &Mesh, vertex: u32) -> DVec3 {
    DVec3::from(mesh.vertices()[vertex as usize])
}

/// The faces of every surface: faces that hang together by vertices.
fn surfaces(mesh: &Mesh) -> Vec<Vec<usize>> {
    fn root(parents: &mut [u32], mut of: u32) -> u32 {
        while parents[of as usize] != of {
            parents[of as usize] = parents[parents[of as usize] as usize];
            of = parents[of as usize];
        }
        of
    }
    let mut parents: Vec<u32> = (0..mesh.vertices().len() as u32).collect();
    for face in mesh.faces() {
        for pair in face.vertices().windows(2) {
            let (a, b) = (root(&mut parents, pair[0]), root(&mut parents, pair[1]));
            parents[a.max(b) as usize] = a.min(b);
        }
    }
    let mut surfaces: Vec<Vec<usize>> = Vec::new();
    let mut numbers: HashMap<u32, usize> = HashMap::new();
    for (k, face) in mesh.faces().iter().enumerate() {
        let number = *numbers.entry(root(&mut parents, face.vertices()[0])).or_insert_with(|| {
            surfaces.push(Vec::new());
            surfaces.len() - 1
        });
        surfaces[number].push(k);
    }
    surfaces
}

/// The edges of some faces, in the faces' direction.
fn edges(mesh: &Mesh, faces: &[usize]) -> Vec<[u32; 2]> {
    let of_face = |&k: &usize| {
        let corners = mesh.faces()[k].vertices();
        (0..corners.len()).map(move |i| [corners[i], corners[(i + 1) % corners.len()]])
    };
    faces.iter().flat_map(of_face).collect()
}

/// The triangles of some faces, quads cut along a diagonal.
fn triangles(mesh: &Mesh, faces: &[usize]) -> Vec<[DVec3; 3]> {
    let of_face = |&k: &usize| {
        let corners: Vec<DVec3> = mesh.faces()[k].vertices().iter().map(|&v| at(mesh, v)).collect();
        (2..corners.len()).map(move |i| [corners[0], corners[i - 1], corners[i]])
    };
    faces.iter().flat_map(of_face).collect()
}

/// How often the mesh's fronts surround a point: the solid angle of its triangles (van Oosterom and
/// Strackee 1983) over 4 pi. It is 0 in furniture and outside, -1 in the air.
fn winding_number(triangles: &[[DVec3; 3]], point: DVec3) -> f64 {
    let solid_angle = |triangle: &[DVec3; 3]| {
        let [a, b, c] = triangle.map(|corner| corner - point);
        let (p, q, r) = (a.length(), b.length(), c.length());
        2.0 * a.dot(b.cross(c)).atan2(p * q * r + a.dot(b) * r + b.dot(c) * p + c.dot(a) * q)
    };
    triangles.iter().map(solid_angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

#[test]
fn polygon_counts_are_exact() {
    for kind in Kind::ALL {
        for polygons in (MIN_POLYGONS..400).chain([999, 1000, 1001, 2345, 10_000, 31_337, 50_000]) {
            assert_eq!(scene(kind, polygons, polygons as u64).faces().len(), polygons, "{kind} {polygons}");
        }
        for seed in 0..20 {
            assert_eq!(scene(kind, 777, seed).faces().len(), 777, "{kind} seed {seed}");
        }
    }
}

#[test]
fn counts_out_of_range_are_refused() {
    for kind in Kind::ALL {
        let polygons = MIN_POLYGONS - 1;
        assert_eq!(generate(kind, polygons, 0).err(), Some(GenerateError::TooFew { kind, polygons }));
        let polygons = MAX_POLYGONS + 1;
        assert_eq!(generate(kind, polygons, 0).err(), Some(GenerateError::TooMany { kind, polygons }));
    }
}

#[test]
fn surfaces_are_closed_manifolds() {
    for (name, mesh) in scenes() {
        for surface in surfaces(&mesh) {
            let edges = edges(&mesh, &surface);
            let distinct: HashSet<[u32; 2]> = edges.iter().copied().collect();
            assert_eq!(distinct.len(), edges.len(), "{name}: an edge is used twice in one direction");
            assert!(edges.iter().all(|&[a, b]| distinct.contains(&[b, a])), "{name}: an edge is open");
        }
    }
}

#[test]
fn vertices_of_a_surface_are_distinct_places_and_all_used() {
    for (name, mesh) in scenes() {
        let mut used = HashSet::new();
        for surface in surfaces(&mesh) {
            let vertices: HashSet<u32> = edges(&mesh, &surface).iter().map(|edge| edge[0]).collect();
            let places: HashSet<[u64; 3]> =
                vertices.iter().map(|&v| mesh.vertices()[v as usize].map(|x| (x + 0.0).to_bits())).collect();
            assert_eq!(places.len(), vertices.len(), "{name}");
            used.extend(vertices);
        }
        assert_eq!(used.len(), mesh.vertices().len(), "{name}");
    }
}

#[test]
fn no_vertex_lies_inside_an_edge_of_its_surface() {
    for kind in Kind::ALL {
        let mesh = scene(kind, 2001, 8);
        for surface in surfaces(&mesh) {
            let edges = edges(&mesh, &surface);
            let vertices: HashSet<u32> = edges.iter().map(|edge| edge[0]).collect();
            for &[a, b] in &edges {
                let (start, along) = (at(&mesh, a), at(&mesh, b) - at(&mesh, a));
                for &v in vertices.iter().filter(|&&v| v != a && v != b) {
                    let from_start = at(&mesh, v) - start;
                    let t = from_start.dot(along) / along.length_squared();
                    let off = (from_start - t * along).length();
                    assert!(!(0.0..=1.0).contains(&t) || off > 1e-9, "{kind}: vertex {v} in edge {a} {b}");
                }
            }
        }
    }
}

#[test]
fn fronts_face_the_air() {
    for (name, mesh) in scenes() {
        for (number, surface) in surfaces(&mesh).iter().enumerate() {
            let volume: f64 = triangles(&mesh, surface).iter().map(|[a, b, c]| a.dot(b.cross(*c))).sum();
            // The first surface is the shell or the city; it surrounds the air.
            assert_eq!(volume < 0.0, number == 0, "{name}: surface {number} has volume {volume}");
        }
    }
}

#[test]
fn faces_are_exactly_planar_and_convex() {
    for (name, mesh) in scenes() {
        for (k, face) in mesh.faces().iter().enumerate() {
            let corners: Vec<DVec3> = face.vertices().iter().map(|&v| at(&mesh, v)).collect();
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            for i in 0..corners.len() {
                let [a, b, c] = [0, 1, 2].map(|step| corners[(i + step) % corners.len()]);
                assert!((b - a).cross(c - b).dot(normal) > 0.0, "{name}: face {k} is flat or concave");
            }
            if let [a, b, c, d] = corners[..] {
                assert_eq!(orient3d(a, b, c, d), Sign::Zero, "{name}: face {k} is not planar");
            }
        }
    }
}

#[test]
fn free_points_are_in_the_air_and_off_every_surface() {
    for (name, mesh) in scenes().filter(|(_, mesh)| mesh.faces().len() <= 1001) {
        let all: Vec<usize> = (0..mesh.faces().len()).collect();
        let triangles = triangles(&mesh, &all);
        for point in mesh.free_points(100, 11) {
            assert!(mesh.clearance(point) >= mesh.margin() * (1.0 - 1e-9), "{name}: {point:?}");
            let point = DVec3::from(point);
            assert!((winding_number(&triangles, point) + 1.0).abs() < 1e-9, "{name}: {point}");
            let nearest = triangles.iter().flatten().map(|corner| corner.distance(point)).fold(f64::INFINITY, f64::min);
            assert!(mesh.clearance(point.to_array()) <= nearest * (1.0 + 1e-9), "{name}: {point}");
        }
    }
}

#[test]
fn floor_points_are_on_the_floor_and_in_sight_of_the_air() {
    for (name, mesh) in scenes().filter(|(_, mesh)| mesh.faces().len() <= 1001) {
        assert_eq!(mesh.up(), Axis::Z);
        let all: Vec<usize> = (0..mesh.faces().len()).collect();
        let triangles = triangles(&mesh, &all);
        for point in mesh.floor_points(100, 12) {
            assert_eq!(point[2].to_bits(), 0.0_f64.to_bits(), "{name}");
            let above = DVec3::from(point) + DVec3::new(0.0, 0.0, 0.5 * mesh.margin());
            assert!((winding_number(&triangles, above) + 1.0).abs() < 1e-9, "{name}: {point:?}");
        }
    }
}

#[test]
fn points_depend_on_the_seed_alone() {
    let mesh = scene(Kind::Room, 200, 1);
    assert_eq!(mesh.free_points(10, 3), mesh.free_points(10, 3));
    assert_ne!(mesh.free_points(10, 3), mesh.free_points(10, 4));
    assert_eq!(mesh.free_points(10, 3), mesh.free_points(20, 3)[..10]);
}

/// FNV-1a over everything a mesh consists of.
fn fingerprint(mesh: &Mesh) -> u64 {
    let mut text = Vec::new();
    mesh.write_obj("x.mtl", &mut text).expect("memory takes it");
    mesh.write_mtl(&mut text).expect("memory takes it");
    text.iter().fold(0xCBF2_9CE4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01B3))
}

/// Also across platforms: these numbers are part of what the generator promises.
#[test]
fn scenes_are_the_same_bits_for_the_same_seed() {
    let known = [(Kind::Room, ROOM), (Kind::Office, OFFICE), (Kind::City, CITY)];
    let found = known.map(|(kind, _)| (kind, fingerprint(&scene(kind, 5000, 42))));
    assert_eq!(found, known);
    for kind in Kind::ALL {
        assert_ne!(fingerprint(&scene(kind, 500, 1)), fingerprint(&scene(kind, 500, 2)), "{kind}");
    }
}

const ROOM: u64 = 0xD615_3257_DDCB_ECDE;
const OFFICE: u64 = 0x939B_B701_894D_5C18;
const CITY: u64 = 0xB84E_6CD4_7711_A7BB;

#[test]
fn objects_are_named_once_and_have_faces() {
    for (name, mesh) in scenes() {
        let names: HashSet<&String> = mesh.objects().iter().collect();
        assert_eq!(names.len(), mesh.objects().len(), "{name}");
        let used: HashSet<usize> = mesh.faces().iter().map(MeshFace::object).collect();
        assert_eq!(used.len(), mesh.objects().len(), "{name}");
        let used: HashSet<usize> = mesh.faces().iter().map(MeshFace::material).collect();
        assert!(used.iter().any(|&k| mesh.materials()[k].is_emitter()), "{name} is dark");
    }
}

#[test]
fn shells_take_their_share_and_more_polygons_mean_more_objects() {
    for (kind, share) in [(Kind::Room, 0.4), (Kind::Office, 0.3)] {
        let mut objects = 0;
        for polygons in [1000, 10_000, 50_000] {
            let mesh = scene(kind, polygons, 1);
            let shell = surfaces(&mesh)[0].len() as f64 / polygons as f64;
            assert!((shell - share).abs() < 0.1, "{kind} {polygons}: {shell}");
            assert!(mesh.objects().len() > objects, "{kind} {polygons}");
            objects = mesh.objects().len();
        }
    }
}

#[test]
fn obj_files_read_back_as_the_same_mesh() {
    for (name, mesh) in scenes().filter(|(_, mesh)| mesh.faces().len() <= 1000) {
        let mut text = Vec::new();
        mesh.write_obj("scene.mtl", &mut text).expect("memory takes it");
        let text = String::from_utf8(text).expect("OBJ is text");
        let (mut vertices, mut faces, mut object, mut material) = (Vec::new(), Vec::new(), "", "");
        for line in text.lines() {
            let (key, rest) = line.split_once(' ').expect("a key and its values");
            match key {
                "mtllib" => assert_eq!(rest, "scene.mtl"),
                "v" => vertices.push(rest.split(' ').map(|x| x.parse().expect("a number")).collect::<Vec<f64>>()),
                "o" => object = rest,
                "usemtl" => material = rest,
                "f" => {
                    let corners: Vec<u32> = rest.split(' ').map(|k| k.parse::<u32>().expect("an index") - 1).collect();
                    faces.push((corners, object, material));
                }
                other => panic!("{name}: {other}"),
            }
        }
        assert_eq!(vertices, mesh.vertices(), "{name}");
        assert_eq!(faces.len(), mesh.faces().len(), "{name}");
        for (read, face) in faces.iter().zip(mesh.faces()) {
            let written = (face.vertices(), &*mesh.objects()[face.object()], &*mesh.materials()[face.material()].name);
            assert_eq!((&*read.0, read.1, read.2), written, "{name}");
        }
    }
}

#[test]
fn the_cornell_box_faces_its_air_and_is_open_in_front_only() {
    let mesh = cornell_box();
    assert_eq!((mesh.faces().len(), mesh.objects().len(), mesh.up()), (16, 8, Axis::Y));
    let all: Vec<usize> = (0..16).collect();
    let edges = edges(&mesh, &all);
    let distinct: HashSet<[u32; 2]> = edges.iter().copied().collect();
    assert_eq!(distinct.len(), edges.len());
    let open = edges.iter().filter(|&&[a, b]| !distinct.contains(&[b, a]));
    for &[a, b] in open {
        let ends = [at(&mesh, a), at(&mesh, b)];
        let in_front = ends.iter().all(|p| p.z == 0.0);
        let foot = ends.iter().all(|p| p.y == 0.0);
        let lamp = ends.iter().all(|p| (p.y - 548.7).abs() < 1e-9);
        assert!(in_front || foot || lamp, "{ends:?}");
    }
    // The room and the lamp show their fronts to the middle; the blocks show theirs outward.
    let middle = DVec3::new(278.0, 400.0, 100.0);
    for face in &mesh.faces()[..6] {
        let [a, b, c] = [0, 1, 2].map(|k| at(&mesh, face.vertices()[k]));
        assert!((b - a).cross(c - a).dot(middle - a) > 0.0);
    }
    for block in [6..11, 11..16] {
        let triangles = triangles(&mesh, &block.collect::<Vec<_>>());
        let volume: f64 = triangles.iter().map(|[a, b, c]| a.dot(b.cross(*c))).sum();
        assert!(volume > 0.0);
    }
}

#[test]
fn free_points_of_the_cornell_box_are_outside_its_blocks() {
    let mesh = cornell_box();
    for point in mesh.free_points(200, 5).into_iter().chain(mesh.floor_points(200, 5)) {
        let point = DVec3::from(point);
        for block in [6..11, 11..16] {
            let outside = mesh.faces()[block].iter().any(|face| {
                let [a, b, c] = [0, 1, 2].map(|k| at(&mesh, face.vertices()[k]));
                (b - a).cross(c - a).normalize().dot(point - a) >= mesh.margin() - 1e-9
            });
            assert!(outside, "{point}");
        }
    }
    assert!(mesh.floor_points(50, 5).iter().all(|point| point[1].to_bits() == 0));
}

/// To write them anew: `NUSSELT_WRITE_SCENES=1 cargo test --test samples`.
#[test]
fn kept_scene_files_are_what_the_functions_write() {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scenes");
    for (name, mesh) in [("cornell", cornell_box()), ("room", scene(Kind::Room, 1000, 1))] {
        let (mut obj, mut mtl) = (Vec::new(), Vec::new());
        mesh.write_obj(&format!("{name}.mtl"), &mut obj).expect("memory takes it");
        mesh.write_mtl(&mut mtl).expect("memory takes it");
        for (ending, text) in [("obj", obj), ("mtl", mtl)] {
            let path = directory.join(name).with_extension(ending);
            if std::env::var_os("NUSSELT_WRITE_SCENES").is_some() {
                std::fs::write(&path, &text).expect("the directory is there");
            }
            let kept = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            assert!(kept == text, "{} is out of date", path.display());
        }
    }
}
