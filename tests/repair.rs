//! Repair changes what was asked for, says what it changed, and nothing else.

mod common;

use common::{Random, cluttered_room};
use glam::DVec3;
use num_rational::BigRational;
use nusselt::io::{ReadOptions, cityjson, obj, ply, stl};
use nusselt::scene::{
    DropCause, DuplicatePolicy, FaceSpec, Material, NonPlanarPolicy, OrDrop, PolygonId, Repair, Scene, SceneBuilder,
    SceneError, SceneProblem, Shape, ZeroAreaPolicy,
};
use proptest::prelude::*;
use std::time::{Duration, Instant};

fn built(repair: Repair, vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> Result<Scene, SceneError> {
    Scene::builder().repair(repair).mesh(vertices, faces, Material::new("m")).build()
}

fn weld(tolerance: f64) -> Repair {
    Repair { weld: Some(tolerance), ..Repair::default() }
}

fn drop_all() -> Repair {
    Repair {
        non_planar: NonPlanarPolicy::Drop,
        self_crossing: OrDrop::Drop,
        malformed: OrDrop::Drop,
        duplicates: DuplicatePolicy::Drop,
        ..Repair::default()
    }
}

/// One of each kind: sound, bow tie, bent quad, duplicate of the first, no area, bad indices, not finite, two corners.
fn one_of_each() -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let vertices = vec![
        [0., 0., 0.],
        [1., 0., 0.],
        [1., 1., 0.],
        [0., 1., 0.],
        [5., 5., 0.],
        [7., 7., 0.],
        [7., 5., 0.],
        [5., 7., 0.],
        [9., 9., 9.],
        [10., 9., 9.],
        [10., 10., 9.],
        [9., 10., 9.5],
        [f64::INFINITY, 0., 0.],
    ];
    let faces = vec![
        vec![0, 1, 2, 3],
        vec![4, 5, 6, 7],
        vec![8, 9, 10, 11],
        vec![1, 0, 3, 2],
        vec![0, 0, 1],
        vec![0, 1, 99],
        vec![0, 1, 12],
        vec![0, 1],
    ];
    (vertices, faces)
}

#[test]
fn what_is_dropped_keeps_its_number_and_is_listed_with_its_cause_and_size() {
    let (vertices, faces) = one_of_each();
    let scene = built(drop_all(), &vertices, &faces).expect("all is dropped that is broken");
    assert_eq!(scene.polygon_count(), faces.len());
    let shapes: Vec<_> = scene.polygons().map(nusselt::scene::PolygonRef::shape).collect();
    let gone = Shape::Dropped;
    assert_eq!(shapes, [Shape::Convex, gone, gone, gone, Shape::Degenerate, gone, gone, gone]);
    for polygon in scene.polygons().filter(|polygon| polygon.shape() == gone) {
        assert!(polygon.rings().is_empty() && polygon.pieces().len() == 0);
    }
    let [one, two, three, five, six, seven] = [1, 2, 3, 5, 6, 7].map(PolygonId);
    let dropped: Vec<_> = scene.repairs().dropped.iter().map(|d| (d.polygon, d.cause, d.problem.clone())).collect();
    assert_eq!(
        dropped,
        [
            (one, DropCause::SelfCrossing, SceneProblem::SelfCrossing { polygon: one }),
            (two, DropCause::NonPlanar, SceneProblem::NonPlanar { polygon: two }),
            (three, DropCause::Duplicate, SceneProblem::Duplicate { polygon: three, first: PolygonId(0) }),
            (five, DropCause::Malformed, SceneProblem::UnknownVertex { polygon: five, vertex: 99, count: 13 }),
            (six, DropCause::Malformed, SceneProblem::NotFinite { vertex: 12 }),
            (seven, DropCause::Malformed, SceneProblem::TooFewVertices { polygon: seven, count: 2 }),
        ]
    );
    let sizes: Vec<_> = scene.repairs().dropped.iter().map(|d| d.size).collect();
    assert_eq!(sizes, [8f64.sqrt(), 1.5, 2f64.sqrt(), 1.0, 1.0, 1.0]);
    // Nothing is left of what only dropped faces name.
    assert_eq!(scene.vertices().len(), 4);
    assert_eq!(scene.bounds(), Some((DVec3::ZERO, DVec3::new(1., 1., 0.))));
}

#[test]
fn what_is_kept_is_as_if_the_dropped_had_never_been_there() {
    let mut random = Random(5);
    for round in 0..20 {
        let room = cluttered_room(5, round);
        let (mut vertices, mut faces) = (Vec::new(), Vec::new());
        let mut kept = Vec::new();
        for face in &room.faces {
            // A bow tie with a slant, or nothing, before every face.
            if random.below(3) == 0 {
                let first = vertices.len();
                let p = random.in_cube(20.0);
                let (u, v) = (DVec3::new(1., 2., 0.), DVec3::new(0., 1., 4.));
                vertices.extend([p, p + u + v, p + u, p + v].map(|p| p.round().to_array()));
                faces.push((first..first + 4).collect());
            }
            kept.push(faces.len());
            let first = vertices.len();
            vertices.extend(face.iter().map(|&v| room.vertices[v]));
            faces.push((first..first + face.len()).collect());
        }
        let repair = Repair { self_crossing: OrDrop::Drop, ..Repair::default() };
        let scene = built(repair, &vertices, &faces).expect("bow ties are dropped");
        let clean = room.build();
        assert_eq!(scene.repairs().dropped.len(), faces.len() - kept.len());
        assert_eq!(scene.vertices(), clean.vertices());
        assert_eq!(scene.edges(), clean.edges());
        assert_eq!(scene.planes(), clean.planes());
        for (polygon, number) in clean.polygons().zip(kept) {
            let same = scene.polygon(PolygonId(number as u32));
            assert_eq!((same.rings(), same.shape()), (polygon.rings(), polygon.shape()));
            for (a, b) in same.pieces().zip(polygon.pieces()) {
                assert_eq!((a.vertices(), a.edges(), a.plane_id()), (b.vertices(), b.edges(), b.plane_id()));
            }
        }
    }
}

#[test]
fn what_is_to_be_rejected_is_a_problem() {
    let (vertices, faces) = one_of_each();
    let repair = Repair {
        non_planar: NonPlanarPolicy::Reject,
        zero_area: ZeroAreaPolicy::Reject,
        duplicates: DuplicatePolicy::Reject,
        ..Repair::default()
    };
    let problems = built(repair, &vertices, &faces).expect_err("broken").problems;
    let [one, two, three, four, five, seven] = [1, 2, 3, 4, 5, 7].map(PolygonId);
    assert_eq!(
        problems,
        [
            SceneProblem::NotFinite { vertex: 12 },
            SceneProblem::SelfCrossing { polygon: one },
            SceneProblem::NonPlanar { polygon: two },
            SceneProblem::Duplicate { polygon: three, first: PolygonId(0) },
            SceneProblem::ZeroArea { polygon: four },
            SceneProblem::UnknownVertex { polygon: five, vertex: 99, count: 13 },
            SceneProblem::TooFewVertices { polygon: seven, count: 2 },
        ]
    );
}

#[test]
fn bent_faces_that_cross_themselves_are_first_of_all_bent() {
    // Seen from above and along its normal, a bow tie; its last corner is off its plane.
    let vertices = [[0., 0., 0.], [2., 2., 0.], [2., 0., 0.], [0., 2., 0.25]];
    let faces = [vec![0, 1, 2, 3]];
    let crossing = built(Repair::default(), &vertices, &faces).expect_err("a bow tie").problems;
    assert_eq!(crossing, [SceneProblem::SelfCrossing { polygon: PolygonId(0) }]);
    let scene = built(Repair { non_planar: NonPlanarPolicy::Drop, ..Repair::default() }, &vertices, &faces);
    assert_eq!(scene.expect("dropped").repairs().dropped[0].cause, DropCause::NonPlanar);
}

#[test]
fn unknown_objects_and_materials_are_problems_whatever_is_dropped() {
    let mut builder = Scene::builder().repair(drop_all());
    let object = builder.add_object("o");
    let material = builder.add_material(Material::new("m"));
    let mut unknown = Scene::builder();
    unknown.add_object("a");
    let unknown = unknown.add_object("b");
    builder.add_face(FaceSpec { rings: Vec::new(), object: unknown, material });
    builder.add_face(FaceSpec { rings: Vec::new(), object, material });
    let problems = builder.build().expect_err("an unknown object").problems;
    assert!(matches!(problems[..], [SceneProblem::UnknownObject { polygon: PolygonId(0), .. }]));
}

#[test]
fn tolerances_that_are_none_are_refused() {
    for tolerance in [-1.0, -5e-324, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let problems = built(weld(tolerance), &[[0.; 3]], &[]).expect_err("no tolerance").problems;
        assert!(matches!(problems[..], [SceneProblem::BadTolerance { .. }]), "{tolerance}");
    }
    assert!(built(weld(0.0), &[[0.; 3]], &[]).is_ok());
}

/// Vertices in a row, all of them in use.
fn row(positions: &[f64], repair: Repair) -> Scene {
    let mut vertices: Vec<_> = positions.iter().map(|&x| [x, 0., 0.]).collect();
    let n = vertices.len();
    vertices.extend([[0., 1e6, 0.], [0., 0., 1e6]]);
    let faces: Vec<_> = (0..n).map(|k| vec![k, n, n + 1]).collect();
    built(repair, &vertices, &faces).expect("sound")
}

#[test]
fn vertices_move_to_the_nearest_that_stayed_and_never_in_chains() {
    // 1 stays; 1.8 and 2.6 are in a chain: 1.8 moves to 1, 2.6 is too far from 1 and stays, 1.9 is nearer to 2.6.
    let scene = row(&[1.0, 1.8, 2.6, 1.9, 1.0 - 0.9], weld(1.0));
    let moved: Vec<_> = scene.repairs().moved.iter().map(|m| (m.vertex, m.from.x, m.to.x)).collect();
    assert_eq!(moved, [(1, 1.8, 1.0), (3, 1.9, 2.6), (4, 1.0 - 0.9, 1.0)]);
    assert!((scene.repairs().farthest_move() - 0.9).abs() < 1e-15);
    // Equally near: the first; exactly as far as the tolerance: not nearer than that.
    let scene = row(&[3.0, 1.0, 2.0], weld(1.5));
    assert_eq!(scene.repairs().moved.iter().map(|m| m.to.x).collect::<Vec<_>>(), [3.0]);
    let apart = row(&[3.0, 4.0, 2.0], weld(1.0));
    assert!(apart.repairs().is_empty());
}

#[test]
fn what_welding_does_to_faces_is_listed() {
    let vertices = [
        [0., 0., 0.],
        [4., 0., 0.],
        [4., 4., 0.],
        [0., 4., 0.],
        // Beside the first: a corner less.
        [0., 0.001, 0.],
        // A sliver all within the tolerance of a line, which folds up.
        [4., 0.001, 0.],
        // Off the plane.
        [4., 4., 0.001],
        [8., 4., 0.001],
        [8., 8., 0.001],
        [4., 8., 0.001],
    ];
    let faces = [vec![0, 1, 2, 3, 4], vec![0, 1, 5], vec![6, 7, 8, 9]];
    let scene = built(weld(0.01), &vertices, &faces).expect("sound");
    let repairs = scene.repairs();
    assert_eq!(repairs.moved.iter().map(|m| m.vertex).collect::<Vec<_>>(), [4, 5, 6]);
    assert_eq!(repairs.shortened, [PolygonId(0), PolygonId(1)]);
    assert_eq!(repairs.collapsed, [PolygonId(1)]);
    assert_eq!(repairs.bent, [PolygonId(2)]);
    assert_eq!(scene.polygon(PolygonId(0)).rings()[0].len(), 4);
    assert_eq!(scene.polygon(PolygonId(1)).shape(), Shape::Degenerate);
}

fn exact_distance_squared(a: DVec3, b: DVec3) -> BigRational {
    let exact = |x: f64| BigRational::from_float(x).expect("finite");
    let parts = a.to_array().into_iter().zip(b.to_array()).map(|(x, y)| exact(x) - exact(y));
    parts.map(|d| &d * &d).sum()
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        (-20i32..20).prop_map(|x| f64::from(x) * 0.25),
        -4.0..4.0f64,
        (-8i32..8, -1074i32..1020).prop_map(|(m, e)| f64::from(m) * 2f64.powi(e)),
        Just(f64::MAX),
        Just(-0.0),
    ]
}

/// A soup of triangles of which each vertex is its own.
fn soup(points: &[[f64; 3]], repair: Repair) -> SceneBuilder {
    let faces: Vec<Vec<usize>> = (0..points.len() / 3).map(|k| vec![3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Scene::builder().repair(repair).mesh(points, &faces, Material::new("m"))
}

proptest! {
    #[test]
    fn welding_moves_no_vertex_too_far_leaves_none_near_and_is_idempotent(
        points in prop::collection::vec([coordinate(), coordinate(), coordinate()], 3..16),
        tolerance in prop_oneof![
            Just(0.25), 0.0..3.0f64, Just(f64::MAX), Just(1e308), Just(5e-324), Just(1e-300),
            (-1074i32..1023).prop_map(|e| 2f64.powi(e)),
        ],
    ) {
        let scene = soup(&points, weld(tolerance)).build().expect("triangles are never refused");
        let exact = BigRational::from_float(tolerance).expect("finite");
        let reach = &exact * &exact;
        for moved in &scene.repairs().moved {
            prop_assert!(moved.from != moved.to);
            prop_assert_eq!(moved.from, DVec3::from(points[moved.vertex]));
            prop_assert!(exact_distance_squared(moved.from, moved.to) <= reach);
            prop_assert!(moved.distance() <= tolerance * (1.0 + 1e-15) && moved.distance() >= 0.0);
        }
        // What stayed is apart, but for the rounding that is documented.
        let close = &reach * BigRational::from_float(1.0 - 1e-14).expect("finite");
        for (k, &p) in scene.vertices().iter().enumerate() {
            for &q in &scene.vertices()[..k] {
                prop_assert!(exact_distance_squared(p, q) >= close, "{p} and {q} within {tolerance:e}");
            }
        }
        let mut welded = points.clone();
        for moved in &scene.repairs().moved {
            welded[moved.vertex] = moved.to.to_array();
        }
        let again = soup(&welded, weld(tolerance)).build().expect("triangles");
        prop_assert!(again.repairs().is_empty());
        prop_assert_eq!(again.vertices(), scene.vertices());
    }

    #[test]
    fn the_order_of_faces_does_not_matter_to_welding(seed: u64) {
        let mut random = Random(seed);
        let vertices: Vec<_> = (0..30).map(|_| (random.in_cube(2.0) * 4.0).round().to_array()).collect();
        let mut faces: Vec<_> = (0..15).map(|_| (0..3).map(|_| random.below(30)).collect::<Vec<_>>()).collect();
        let scene = built(weld(1.5), &vertices, &faces).expect("triangles");
        for k in (1..faces.len()).rev() {
            faces.swap(k, random.below(k + 1));
        }
        let other = built(weld(1.5), &vertices, &faces).expect("triangles");
        prop_assert_eq!(&scene.repairs().moved, &other.repairs().moved);
        prop_assert_eq!(scene.vertices(), other.vertices());
    }

    #[test]
    fn the_default_changes_nothing(seed: u64) {
        let mut random = Random(seed);
        let points: Vec<_> = (0..60).map(|_| random.in_cube(3.0).round().to_array()).collect();
        let plain = soup(&points, Repair::default()).build().expect("triangles");
        prop_assert!(plain.repairs().is_empty());
        prop_assert!(plain.polygons().all(|polygon| polygon.shape() != Shape::Dropped));
        for vertex in plain.vertices() {
            prop_assert!(points.iter().any(|&p| DVec3::from(p) == *vertex));
        }
    }

    #[test]
    fn a_shattered_room_is_closed_again_by_welding(seed: u64) {
        let whole = cluttered_room(8, seed);
        let mut random = Random(seed);
        let (mut vertices, mut faces) = (Vec::new(), Vec::new());
        for face in &whole.faces {
            let first = vertices.len();
            vertices.extend(face.iter().map(|&v| (DVec3::from(whole.vertices[v]) + random.in_cube(1e-7)).to_array()));
            faces.push((first..first + face.len()).collect::<Vec<_>>());
        }
        let shattered = built(Repair::default(), &vertices, &faces).expect("quads").report();
        let welded = built(weld(1e-6), &vertices, &faces).expect("quads");
        let report = welded.report();
        prop_assert_eq!(shattered.open_edges.len(), 4 * faces.len());
        prop_assert!(report.open_edges.is_empty());
        prop_assert!(report.components.iter().all(|component| component.closed));
        prop_assert!(welded.repairs().farthest_move() < 1e-6);
    }
}

#[test]
fn very_many_vertices_in_one_place_or_far_apart_take_little_longer_than_without_welding() {
    let n = 99_999;
    let mut random = Random(1);
    let one_cell: Vec<[f64; 3]> = (0..n).map(|_| random.in_cube(0.1).to_array()).collect();
    // As densely as those that stay can lie.
    let grid: Vec<_> = (0..n).map(|k| [k % 47, k / 47 % 47, k / 47 / 47].map(|x| x as f64)).collect();
    let equal = vec![[0.3; 3]; n];
    let huge: Vec<_> = one_cell.iter().map(|p| p.map(|x| x * 1e301)).collect();
    for (name, points, tolerance, left) in [
        ("one cell", &one_cell, 1.0, 1),
        ("all within the largest tolerance", &one_cell, 1e308, 1),
        ("grid", &grid, 1.0, n),
        ("equal", &equal, 1e-3, 1),
        ("huge, tiny tolerance", &huge, 5e-324, n),
        ("huge, huge tolerance", &huge, 1e308, 1),
    ] {
        let start = Instant::now();
        let _ = soup(points, Repair::default()).build().expect("triangles");
        let plain = start.elapsed();
        let start = Instant::now();
        let scene = soup(points, weld(tolerance)).build().expect("triangles");
        assert_eq!(scene.vertices().len(), left, "{name}");
        let welded = start.elapsed();
        assert!(welded < 4 * plain + Duration::from_secs(10), "{name}: {welded:?}, without welding {plain:?}");
    }
}

#[test]
fn obj_files_with_malformed_faces_can_be_read() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 nan\nf 1 2 3\nf 1 2 4\nf 1 2 9\nf 1 2\nf a b c\nf 3 2 1\n";
    let no_files = |_: &str| Ok(Vec::new());
    let error = obj::parse(text.as_bytes(), "bad.obj", &ReadOptions::default(), no_files).unwrap_err().to_string();
    assert!(error.starts_with("bad.obj:4: "), "{error}");
    let repair = Repair { malformed: OrDrop::Drop, ..Repair::default() };
    let options = ReadOptions { repair, ..ReadOptions::default() };
    let loaded = obj::parse(text.as_bytes(), "bad.obj", &options, no_files).expect("the rest is sound");
    let dropped: Vec<_> = loaded.scene.repairs().dropped.iter().map(|d| d.polygon.0).collect();
    assert_eq!(dropped, [1, 2, 3, 4]);
    assert_eq!(loaded.scene.polygon_count(), 6);
    assert_eq!(loaded.scene.polygon(PolygonId(5)).shape(), Shape::Convex);
    let [warning] = &loaded.warnings[..] else { panic!("{:?}", loaded.warnings) };
    assert!(
        warning.starts_with("bad.obj:4: ") && warning.ends_with(" (faults of vertices and faces: 4 in all)"),
        "{warning}"
    );
    // Without any vertex, too.
    let loaded = obj::parse(b"f 1 2 3\nf 4 5 6\n", "bad.obj", &options, no_files).expect("all is dropped");
    assert_eq!((loaded.scene.polygon_count(), loaded.scene.vertices().len()), (2, 0));
}

#[test]
fn other_files_with_malformed_faces_can_be_read() {
    let repair = Repair { malformed: OrDrop::Drop, ..Repair::default() };
    let options = ReadOptions { repair, ..ReadOptions::default() };
    let dropped = |loaded: &nusselt::io::Loaded| -> Vec<u32> {
        loaded.scene.repairs().dropped.iter().map(|d| d.polygon.0).collect()
    };
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    let text = format!("{header}0 0 0\n1 0 0\n0 1 0\nnan 0 1\n3 0 1 2\n3 0 1 3\n3 0 1 9\n2 0 1\n");
    assert!(ply::parse(text.as_bytes(), "bad.ply", &ReadOptions::default()).is_err());
    let loaded = ply::parse(text.as_bytes(), "bad.ply", &options).expect("the rest is sound");
    assert_eq!((dropped(&loaded), loaded.scene.polygon_count()), (vec![1, 2, 3], 4));

    let facet = |corners: &str| format!("facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n");
    let sound = facet("vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n");
    let short = facet("vertex 0 0 0\nvertex 1 0 0\n");
    let broken = facet("vertex 0 0 0\nvertex inf 0 0\nvertex 0 1 0\n");
    let text = format!("solid a\n{short}{sound}{broken}endsolid a\n");
    assert!(stl::parse(text.as_bytes(), "bad.stl", &ReadOptions::default()).is_err());
    let loaded = stl::parse(text.as_bytes(), "bad.stl", &options).expect("the rest is sound");
    assert_eq!((dropped(&loaded), loaded.scene.polygon_count()), (vec![0, 2], 3));

    let city = r#"{"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},
        "CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"1","boundaries":[[[0,1,2]],[[0,1,7]]]}]}},
        "vertices":[[0,0,0],[1,0,0],[0,1,0]]}"#;
    assert!(cityjson::parse(city.as_bytes(), "bad.json", &ReadOptions::default()).is_err());
    let loaded = cityjson::parse(city.as_bytes(), "bad.json", &options).expect("the rest is sound");
    assert_eq!((dropped(&loaded), loaded.scene.polygon_count()), (vec![1], 2));
}
