//! Scenes are built exactly: polygons are tiled by their pieces, and everything wrong is reported.

use glam::DVec3;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use nusselt::exact::{Sign, orient3d};
use nusselt::scene::{
    Axis, FaceSpec, Material, OrDrop, PolygonId, Repair, Scene, SceneError, SceneProblem, Shape, Side, SupportingPlane,
    VertexId,
};
use proptest::prelude::*;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::time::{Duration, Instant};

fn build(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> Result<Scene, SceneError> {
    Scene::builder().mesh(vertices, faces, Material::new("grey")).build()
}

/// One polygon with holes.
fn polygon(rings: &[Vec<[f64; 3]>]) -> Result<Scene, SceneError> {
    repaired(rings, Repair::default())
}

fn repaired(rings: &[Vec<[f64; 3]>], repair: Repair) -> Result<Scene, SceneError> {
    let mut builder = Scene::builder().repair(repair);
    let object = builder.add_object("default");
    let material = builder.add_material(Material::new("grey"));
    let rings = rings.iter().map(|ring| ring.iter().map(|&p| builder.add_vertex(DVec3::from(p))).collect()).collect();
    builder.add_face(FaceSpec { rings, object, material });
    builder.build()
}

/// One polygon in the plane z = 0.
fn flat(rings: &[Vec<[f64; 2]>]) -> Result<Scene, SceneError> {
    let lift = |ring: &Vec<[f64; 2]>| ring.iter().map(|p| [p[0], p[1], 0.0]).collect();
    polygon(&rings.iter().map(lift).collect::<Vec<_>>())
}

fn ring(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    points.to_vec()
}

fn rational(x: f64) -> BigRational {
    BigRational::from_float(x).expect("finite")
}

/// Twice the vector area of a ring, exactly.
fn area(scene: &Scene, ring: &[VertexId]) -> [BigRational; 3] {
    let p: Vec<[BigRational; 3]> = ring.iter().map(|&v| scene.vertex(v).to_array().map(rational)).collect();
    std::array::from_fn(|axis| {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut sum = BigRational::zero();
        for (i, a) in p.iter().enumerate() {
            let b = &p[(i + 1) % p.len()];
            sum += &a[j] * &b[k] - &a[k] * &b[j];
        }
        sum
    })
}

/// What must hold for every scene.
fn check(scene: &Scene) {
    let mut seen = HashMap::new();
    for (k, edge) in scene.edges().iter().enumerate() {
        assert!(edge[0] < edge[1]);
        assert_eq!(seen.insert(*edge, k), None, "an edge is there twice");
    }
    let mut next = 0;
    for polygon in scene.polygons() {
        assert_eq!(polygon.pieces().len() == 0, polygon.shape() == Shape::Degenerate);
        if polygon.shape() == Shape::Convex {
            let corners = polygon.rings()[0].len();
            assert_eq!(polygon.pieces().len() == 1, corners <= 64);
            assert!(polygon.pieces().all(|piece| piece.vertices().len() <= 64));
            // Each diagonal adds a piece and two corners.
            let sum: usize = polygon.pieces().map(|piece| piece.vertices().len()).sum();
            assert_eq!(sum, corners + 2 * (polygon.pieces().len() - 1));
        }
        for piece in polygon.pieces() {
            assert_eq!(piece.polygon(), polygon.id());
            assert_eq!(piece.id().0, next, "pieces are grouped by polygon");
            next += 1;
            check_piece(scene, piece);
        }
        // The boundaries of the pieces cancel, but for the rings: as chains, whatever the shape.
        // (Straight edges through vertices are compared by area below.)
        if polygon.shape() != Shape::Degenerate && polygon.rings().len() == 1 {
            let mut sum = [BigRational::zero(), BigRational::zero(), BigRational::zero()];
            for piece in polygon.pieces() {
                for (sum, part) in sum.iter_mut().zip(area(scene, piece.vertices())) {
                    *sum += part;
                }
            }
            assert_eq!(sum, area(scene, &polygon.rings()[0]), "the pieces do not tile the ring");
        }
        if matches!(polygon.shape(), Shape::Convex | Shape::Concave) {
            let planes: Vec<_> = polygon.pieces().map(|piece| (piece.plane_id(), piece.facing())).collect();
            assert!(planes.windows(2).all(|pair| pair[0] == pair[1]), "one plane, one front");
        }
    }
    assert_eq!(next as usize, scene.piece_count());
}

fn check_piece(scene: &Scene, piece: nusselt::scene::PieceRef<'_>) {
    let vertices = piece.vertices();
    let n = vertices.len();
    assert!(n >= 3);
    for (k, &edge) in piece.edges().iter().enumerate() {
        let (a, b) = (vertices[k], vertices[(k + 1) % n]);
        assert_eq!(scene.edges()[edge.index()], [a.min(b), a.max(b)]);
    }
    let points: Vec<_> = piece.points().collect();
    // Three points that run counter-clockwise seen from the front of the plane, and one above.
    match piece.plane() {
        SupportingPlane::Axis { axis, value } => {
            let k = axis as usize;
            assert!(points.iter().all(|p| p[k].to_bits() == value.to_bits()));
            let area = area(scene, vertices);
            assert_eq!(area[k].is_positive(), piece.facing() == Side::Front);
        }
        SupportingPlane::Points(corners) => {
            let [a, b, c] = corners.map(|v| scene.vertex(v));
            assert!(points.iter().all(|&p| orient3d(a, b, c, p) == Sign::Zero));
            assert_eq!(piece.facing(), Side::Front);
            let plane = area(scene, &corners);
            let own = area(scene, vertices);
            let dot: BigRational = plane.iter().zip(&own).map(|(a, b)| a * b).sum();
            assert!(dot.is_positive(), "the plane's front is the piece's front");
        }
    }
    // Weakly convex: seen along the axis of its largest area it never turns to the other side.
    let whole = area(scene, vertices);
    assert!(whole.iter().any(|x| !x.is_zero()), "a piece without area");
    for k in 0..n {
        let corner = [vertices[k], vertices[(k + 1) % n], vertices[(k + 2) % n]];
        let turn: BigRational = area(scene, &corner).iter().zip(&whole).map(|(a, b)| a * b).sum();
        assert!(!turn.is_negative(), "a piece that is not convex");
    }
}

#[test]
fn a_cube_shares_vertices_edges_and_planes() {
    let corners: Vec<[f64; 3]> =
        (0..8).map(|k| [f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1)]).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let scene = build(&corners, &faces.map(Vec::from)).unwrap();
    check(&scene);
    assert_eq!((scene.vertices().len(), scene.edges().len(), scene.planes().len()), (8, 12, 6));
    assert!(scene.polygons().all(|polygon| polygon.shape() == Shape::Convex));
    let top = scene.piece(nusselt::scene::PieceId(1));
    assert_eq!(top.plane(), SupportingPlane::Axis { axis: Axis::Z, value: 1.0 });
    assert_eq!(top.facing(), Side::Front);
    assert_eq!(scene.piece(nusselt::scene::PieceId(0)).facing(), Side::Back);
    assert!((scene.diagonal() - 3.0_f64.sqrt()).abs() < 1e-15);
}

#[test]
fn every_problem_is_reported_in_order() {
    let mut builder = Scene::builder();
    let object = builder.add_object("default");
    let mut bad = Material::new("bad");
    bad.emission[1] = f64::NAN;
    let material = builder.add_material(bad);
    let points = [[0., 0.], [1., 1.], [1., 0.], [0., 1.]];
    for p in points {
        builder.add_vertex(DVec3::new(p[0], p[1], 0.0));
    }
    builder.add_vertex(DVec3::splat(f64::INFINITY));
    let foreign = {
        let mut other = Scene::builder();
        other.add_object("a");
        other.add_object("b")
    };
    for (ring, object) in
        [(vec![0, 1, 2, 3], object), (vec![0, 9, 1], object), (vec![0, 1], foreign), (vec![0, 1, 4], object)]
    {
        builder.add_face(FaceSpec { rings: vec![ring], object, material });
    }
    let problems = builder.build().unwrap_err().problems;
    assert!(
        matches!(
            &problems[..],
            [
                SceneProblem::NotFinite { vertex: 4 },
                SceneProblem::SelfCrossing { polygon: PolygonId(0) },
                SceneProblem::UnknownVertex { polygon: PolygonId(1), vertex: 9, count: 5 },
                SceneProblem::TooFewVertices { polygon: PolygonId(2), count: 2 },
                SceneProblem::UnknownObject { polygon: PolygonId(2), object: 1, count: 1 },
                SceneProblem::BadMaterial { material: 0, what: "emission", .. },
            ]
        ),
        "{problems:?}"
    );
}

#[test]
fn polygons_without_area_keep_their_number() {
    let vertices = [[0., 0., 0.], [1., 1., 1.], [2., 2., 2.], [-0., 0., -0.], [1., 0., 0.]];
    let faces = [vec![0, 1, 2], vec![0, 3, 0], vec![0, 1, 4], vec![0, 0, 0, 1], vec![0, 1, 4, 1]];
    let scene = build(&vertices, &faces).unwrap();
    check(&scene);
    let shapes: Vec<_> = scene.polygons().map(nusselt::scene::PolygonRef::shape).collect();
    let empty = Shape::Degenerate;
    assert_eq!(shapes, [empty, empty, Shape::Convex, empty, empty]);
    assert_eq!(scene.vertices().len(), 4, "-0 and 0 are one vertex");
}

#[test]
fn straight_corners_stay_whole_and_spikes_do_not() {
    let scene = flat(&[ring(&[[0., 0.], [1., 0.], [2., 0.], [2., 2.], [0., 2.], [0., 1.]])]).unwrap();
    check(&scene);
    assert_eq!(scene.polygon(PolygonId(0)).shape(), Shape::Convex);

    let spike = flat(&[ring(&[[0., 0.], [3., 0.], [2., 0.], [2., 2.], [0., 2.]])]).unwrap();
    check(&spike);
    assert_eq!(spike.polygon(PolygonId(0)).shape(), Shape::Concave);
}

#[test]
fn holes_run_either_way() {
    let outer = ring(&[[0., 0.], [4., 0.], [4., 4.], [0., 4.]]);
    let hole = ring(&[[1., 1.], [2., 1.], [2., 2.], [1., 2.]]);
    let reversed = hole.iter().rev().copied().collect();
    for rings in [vec![outer.clone(), hole], vec![outer, reversed]] {
        let scene = flat(&rings).unwrap();
        check(&scene);
        let sum: BigRational = scene.pieces().map(|piece| area(&scene, piece.vertices())[2].clone()).sum();
        assert_eq!(sum, rational(2.0 * 15.0));
        assert!(scene.pieces().all(|piece| piece.facing() == Side::Front));
    }
}

#[test]
fn holes_that_touch_are_fine_and_holes_that_cross_are_not() {
    let outer = ring(&[[0., 0.], [4., 0.], [4., 4.], [0., 4.]]);
    let touching = ring(&[[0., 2.], [2., 1.], [2., 3.]]);
    let scene = flat(&[outer.clone(), touching]).unwrap();
    check(&scene);
    assert_eq!(scene.piece_count(), 4 + 3 - 1);

    let crossing = ring(&[[-1., 2.], [2., 1.], [2., 3.]]);
    let outside = ring(&[[5., 5.], [6., 5.], [6., 6.]]);
    let problem = |rings: &[Vec<[f64; 2]>]| flat(rings).unwrap_err().problems.remove(0);
    let polygon = PolygonId(0);
    assert_eq!(problem(&[outer.clone(), crossing]), SceneProblem::SelfCrossing { polygon });
    assert_eq!(problem(&[outer, outside]), SceneProblem::HoleOutside { polygon });
}

#[test]
fn no_hole_is_filled_in_by_another() {
    let outer = ring(&[[0., 0.], [8., 0.], [8., 8.], [0., 8.]]);
    let hole = ring(&[[1., 1.], [5., 1.], [5., 5.], [1., 5.]]);
    let reversed = |ring: &[[f64; 2]]| ring.iter().rev().copied().collect::<Vec<_>>();
    let inner = ring(&[[2., 2.], [3., 2.], [3., 3.], [2., 3.]]);
    // With a corner, a side, or its boundary over all of a half in common.
    let inner_at_corner = ring(&[[1., 1.], [3., 2.], [3., 3.]]);
    let inner_at_side = ring(&[[1., 1.], [5., 1.], [3., 3.]]);
    let half = ring(&[[1., 1.], [5., 1.], [5., 5.]]);
    let polygon = PolygonId(0);
    for other in [&hole, &inner, &inner_at_corner, &inner_at_side, &half] {
        for (a, b) in [(&hole, other), (other, &hole)] {
            for (a, b) in [(a.clone(), b.clone()), (a.clone(), reversed(b))] {
                let error = flat(&[outer.clone(), a.clone(), b.clone()]).unwrap_err();
                assert_eq!(error.problems, [SceneProblem::HolesOverlap { polygon }], "{a:?} {b:?}");
            }
        }
    }
    // Three times is twice too often, whatever the directions.
    let thrice = [outer.clone(), hole.clone(), reversed(&hole), hole.clone()];
    assert_eq!(flat(&thrice).unwrap_err().problems, [SceneProblem::HolesOverlap { polygon }]);
    // One that goes around twice, and one whose halves run around in different directions.
    let bow_tie = ring(&[[1., 1.], [3., 3.], [5., 5.], [5., 1.], [3., 3.], [1., 5.]]);
    for bad in [hole.repeat(2), bow_tie] {
        let error = flat(&[outer.clone(), bad]).unwrap_err();
        assert_eq!(error.problems, [SceneProblem::SelfCrossing { polygon }]);
    }
    // Through the same point without crossing there: an hourglass of two triangles, one after the other.
    let hourglass = ring(&[[1., 1.], [3., 3.], [1., 5.], [5., 5.], [3., 3.], [5., 1.]]);
    assert!(flat(&[outer.clone(), hourglass]).is_ok());
    let dropping = Repair { self_crossing: OrDrop::Drop, ..Repair::default() };
    let lift = |ring: Vec<[f64; 2]>| ring.iter().map(|p| [p[0], p[1], 0.0]).collect();
    let scene = repaired(&[outer, hole.clone(), hole].map(lift), dropping).unwrap();
    assert_eq!(scene.polygon(polygon).shape(), Shape::Dropped);
}

/// Holes side by side with common sides and corners, some around the outer ring's.
#[test]
fn holes_that_only_touch_leave_the_rest() {
    let outer = ring(&[[0., 0.], [8., 0.], [8., 8.], [0., 8.]]);
    let square = |x: f64, y: f64| ring(&[[x, y], [x + 2., y], [x + 2., y + 2.], [x, y + 2.]]);
    let mut rings = vec![outer, square(0., 0.), square(2., 2.), square(4., 2.), square(4., 4.), square(2., 4.)];
    rings[3].reverse();
    let scene = flat(&rings).unwrap();
    check(&scene);
    let sum: BigRational = scene.pieces().map(|piece| area(&scene, piece.vertices())[2].clone()).sum();
    assert_eq!(sum, rational(2.0 * (64.0 - 5.0 * 4.0)));
}

#[test]
fn a_keyhole_is_a_hole() {
    let keyhole =
        ring(&[[0., 0.], [4., 0.], [4., 4.], [0., 4.], [0., 0.], [1., 1.], [1., 2.], [2., 2.], [2., 1.], [1., 1.]]);
    let scene = flat(&[keyhole]).unwrap();
    check(&scene);
    assert_eq!(scene.piece_count(), 8);
}

#[test]
fn crossings_are_refused_wherever_they_are() {
    let crossing = |points: &[[f64; 2]]| {
        let error = flat(&[points.to_vec()]).unwrap_err();
        assert_eq!(error.problems, [SceneProblem::SelfCrossing { polygon: PolygonId(0) }], "{points:?}");
    };
    crossing(&[[0., 0.], [1., 1.], [1., 0.], [0., 1.]]);
    // In a vertex, of different windings.
    crossing(&[[0., 0.], [1., 1.], [2., 2.], [2., 0.], [1., 1.], [0., 2.]]);
    // Around twice.
    let square = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]];
    crossing(&[square, square].concat());
    let star: Vec<_> = (0..5).map(|k| f64::from(k) * 0.4 * TAU).map(|a| [a.cos(), a.sin()]).collect();
    crossing(&star);
}

#[test]
fn warped_quadrangles_become_two_triangles() {
    let scene = polygon(&[vec![[0., 0., 0.], [1., 0., 0.], [1., 1., 1e-16], [0., 1., 0.]]]).unwrap();
    check(&scene);
    assert_eq!(scene.polygon(PolygonId(0)).shape(), Shape::NonPlanar);
    assert_eq!(scene.piece_count(), 2);
}

#[test]
fn a_face_folded_at_a_right_angle_is_triangulated_all_over() {
    // A floor and a wall in one: seen along z or x it overlaps its own outline.
    let fold = [[0., 0., 0.], [1., 0., 0.], [1., 0., 1.], [1., 1., 1.], [1., 1., 0.], [0., 1., 0.]];
    for size in [1e-200, 1.0, 1e200] {
        let scene = polygon(&[fold.map(|p| p.map(|x: f64| x * size)).to_vec()]).unwrap();
        check(&scene);
        assert_eq!(scene.polygon(PolygonId(0)).shape(), Shape::NonPlanar);
        assert_eq!(scene.piece_count(), 4);
    }
}

#[test]
fn huge_and_tiny_polygons_are_exact_too() {
    let l = [[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]];
    for size in [2.0_f64.powi(-400), 1.0, 2.0_f64.powi(400)] {
        let scene = flat(&[l.map(|p| p.map(|x| x * size)).to_vec()]).unwrap();
        check(&scene);
        assert_eq!(scene.piece_count(), 4, "{size:e}");
    }
    let mixed = ring(&[[0., 0.], [2e200, 0.], [2e200, 1e-200], [1e200, 1e-200], [1e200, 2e200], [0., 2e200]]);
    assert!(matches!(flat(&[mixed]).unwrap_err().problems[..], [SceneProblem::OutOfRange { .. }]));
}

fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    let elapsed = start.elapsed();
    assert!(elapsed < Duration::from_secs(20), "{what} takes {elapsed:?}");
    eprintln!("{what}: {elapsed:?}");
    result
}

#[test]
fn rings_of_a_hundred_thousand_vertices_take_no_time() {
    const N: i32 = 50_000;
    let n = f64::from(N);
    let comb: Vec<_> = (0..N)
        .flat_map(|k| [[f64::from(2 * k), 0.0], [f64::from(2 * k + 1), -1000.0]])
        .chain([[2.0 * n, 1.0], [0.0, 1.0]])
        .collect();
    let scene = timed("comb", || flat(&[comb]).unwrap());
    assert_eq!(scene.piece_count(), scene.vertices().len() - 2);

    let star: Vec<_> = (0..2 * N)
        .map(|k| (f64::from(k) / n * TAU / 2.0, f64::from(1 + k % 2)))
        .map(|(a, r)| [r * a.cos(), r * a.sin()])
        .collect();
    let scene = timed("star", || flat(&[star]).unwrap());
    assert_eq!(scene.piece_count(), scene.vertices().len() - 2);

    let spiral: Vec<_> = (0..N)
        .map(|k| (f64::from(k) * 0.1, 1.0 + f64::from(k)))
        .chain((0..N).rev().map(|k| (f64::from(k) * 0.1, 1.5 + f64::from(k))))
        .map(|(a, r)| [r * a.cos(), r * a.sin()])
        .collect();
    timed("spiral", || flat(&[spiral]).ok());

    let nested: Vec<_> = (0..N / 2)
        .flat_map(|k| (0..2).map(move |j| [if (k + j) % 2 == 0 { 0.0 } else { n }, f64::from(k)]))
        .chain((0..N).map(|k| [n / 2.0 + f64::from(N / 2 - k), n / 2.0 + f64::from(k % 2)]))
        .collect();
    timed("shelves", || flat(&[nested]).ok());

    let noise: Vec<_> = (0..2 * N).map(|k| [f64::from(k) * 0.618 % 1.0, f64::from(k) * 0.414 % 1.0]).collect();
    assert!(timed("noise", || flat(&[noise])).is_err());

    let through: Vec<_> = (0..2 * N)
        .map(|k| (f64::from(k / 2) / n * TAU / 2.0, if (k + k / 2) % 2 == 0 { 1.0 } else { -1.0 }))
        .map(|(a, s)| [s * a.cos(), s * a.sin()])
        .chain([[0.0, 0.0]])
        .collect();
    assert!(timed("spokes", || flat(&[through])).is_err());

    let back_and_forth: Vec<_> =
        (0..N).flat_map(|k| [[f64::from(k), 0.0], [f64::from(2 * N - k), 0.0]]).chain([[0.0, 1.0]]).collect();
    assert!(timed("back and forth", || flat(&[back_and_forth])).is_err());

    let circle: Vec<_> =
        (0..2 * N).map(|k| f64::from(k) / n * TAU / 2.0).map(|a| [a.cos(), a.sin(), a.cos() * 1e-9]).collect();
    let scene = timed("circle", || polygon(&[circle]).unwrap());
    assert_eq!(scene.piece_count(), scene.vertices().len() - 2);

    let parabola: Vec<_> = (0..2 * N).map(|k| [f64::from(k), f64::from(k) * f64::from(k), f64::from(k % 7)]).collect();
    timed("parabola", || polygon(&[parabola]).ok());

    let hub: Vec<_> = (0..N)
        .flat_map(|k| [0.0, 1.0].map(|step| (f64::from(2 * k) + step) / n * TAU / 2.0))
        .enumerate()
        .flat_map(|(k, a)| {
            let tip = [a.cos(), a.sin()];
            if k % 2 == 0 { vec![[0.0, 0.0], tip] } else { vec![tip] }
        })
        .collect();
    let scene = timed("hub", || flat(&[hub]).unwrap());
    assert_eq!(scene.piece_count(), N as usize);
}

/// A simple polygon on integers: a star around a point, or a comb.
fn simple_ring() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let star = prop::collection::vec(1.0..1000.0_f64, 3..60).prop_map(|radii| {
        let n = radii.len() as f64;
        let mut ring: Vec<_> = radii
            .iter()
            .enumerate()
            .map(|(k, &r)| [r, k as f64 / n * TAU])
            .map(|[r, a]| [(r * a.cos()).round(), (r * a.sin()).round()])
            .collect();
        ring.dedup();
        ring
    });
    let comb = prop::collection::vec(-20..20_i32, 2..60).prop_map(|heights| {
        let n = f64::from(heights.len() as i32);
        let teeth = heights.iter().enumerate().map(|(k, &y)| [k as f64, f64::from(y)]);
        teeth.rev().chain([[0.0, -21.0], [n, -21.0]]).collect()
    });
    prop_oneof![star, comb]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn simple_polygons_are_tiled_exactly(ring in simple_ring(), flip: bool, axis in 0..3_usize) {
        let mut ring: Vec<[f64; 3]> = ring.iter().map(|p| {
            let mut q = [p[0], p[1], 7.0];
            q.rotate_right(axis);
            q
        }).collect();
        if flip {
            ring.reverse();
        }
        // Rounding may make a star cross itself or a ring without area: then it is refused or empty.
        if let Ok(scene) = polygon(&[ring]) {
            check(&scene);
        }
    }

    #[test]
    fn sheared_polygons_stay_planar_and_are_tiled_exactly(ring in simple_ring(), m in prop::array::uniform6(-9..9_i32)) {
        let m = m.map(f64::from);
        let ring: Vec<_> = ring.iter().map(|p| [0, 1, 2].map(|k| m[2 * k] * p[0] + m[2 * k + 1] * p[1])).collect();
        if let Ok(scene) = polygon(&[ring]) {
            check(&scene);
            prop_assert!(scene.polygon(PolygonId(0)).shape() != Shape::NonPlanar);
        }
    }

    #[test]
    fn warped_polygons_are_tiled_as_chains(ring in simple_ring(), heights in prop::collection::vec(-1.0..1.0_f64, 62)) {
        let ring: Vec<_> = ring.iter().zip(heights).map(|(p, z)| [p[0], p[1], z]).collect();
        if let Ok(scene) = polygon(&[ring]) {
            check(&scene);
        }
    }

    #[test]
    fn anything_builds_or_is_refused(
        points in prop::collection::vec(prop::array::uniform3(prop_oneof![
            (-2..3_i32).prop_map(f64::from),
            any::<f64>(),
            prop::num::f64::POSITIVE | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO,
        ]), 1..12),
        faces in prop::collection::vec(prop::collection::vec(prop::collection::vec(0..13_usize, 0..12), 0..4), 0..6),
    ) {
        let mut builder = Scene::builder();
        let object = builder.add_object("default");
        let material = builder.add_material(Material::new("grey"));
        for p in points {
            builder.add_vertex(DVec3::from(p));
        }
        for rings in faces {
            builder.add_face(FaceSpec { rings, object, material });
        }
        if let Err(error) = builder.build() {
            prop_assert!(!error.problems.is_empty());
        }
    }

    #[test]
    fn small_grids_are_tiled_exactly(rings in prop::collection::vec(prop::collection::vec((0..4_i32, 0..4_i32), 3..10), 1..3)) {
        let rings: Vec<Vec<[f64; 2]>> =
            rings.iter().map(|ring| ring.iter().map(|&(x, y)| [f64::from(x), f64::from(y)]).collect()).collect();
        if let Ok(scene) = flat(&rings) {
            check(&scene);
        }
    }
}

/// One convex polygon; its pieces are checked one by one.
fn convex(points: &[[f64; 2]]) -> Scene {
    let scene = flat(&[points.to_vec()]).expect("one sound polygon");
    assert_eq!(scene.polygon(PolygonId(0)).shape(), Shape::Convex);
    check(&scene);
    let pieces = scene.piece_count();
    // The sides, and a diagonal for every further piece.
    assert_eq!(scene.edges().len(), points.len() + pieces - 1);
    scene
}

#[test]
fn convex_polygons_with_many_corners_are_cut() {
    let parabola = |n: u32| -> Vec<[f64; 2]> { (0..n).map(f64::from).map(|x| [x, x * x]).collect() };
    let pieces = |n: u32| convex(&parabola(n)).piece_count();
    assert_eq!([3, 64, 65, 126, 127].map(pieces), [1, 1, 2, 2, 3]);
    assert!(pieces(10_000) <= 2 * 10_000 / 62);
    // Clockwise and in a slanted plane.
    let slanted: Vec<_> = parabola(300).into_iter().rev().map(|[x, y]| [x, y, x + 2.0 * y]).collect();
    let scene = polygon(&[slanted]).unwrap();
    assert_eq!(scene.piece_count(), 8);
    check(&scene);
}

#[test]
fn cutting_leaves_no_piece_on_a_straight_side() {
    // So many points on each side, the first corner included.
    let square = |counts: [u32; 4]| -> Vec<[f64; 2]> {
        let corners = [[0., 0.], [4096., 0.], [4096., 4096.], [0., 4096.]];
        let side = |k: usize| {
            let (a, b): ([f64; 2], [f64; 2]) = (corners[k], corners[(k + 1) % 4]);
            let n = counts[k];
            (0..n).map(move |i| {
                let t = f64::from(i) / 4096.0;
                [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t]
            })
        };
        (0..4).flat_map(side).collect()
    };
    for counts in [[1001, 1, 1, 1], [1, 1, 1, 63], [500, 1, 500, 1], [500, 500, 1, 1], [70, 90, 800, 3]] {
        for shift in [0, 1, 7, 31] {
            let mut ring = square(counts);
            let n = ring.len();
            ring.rotate_left(shift % n);
            convex(&ring);
        }
    }
    // Triangles: two long sides of equal length, then all three, and one only.
    for [a, b, c] in [[200, 200, 1], [100, 100, 100], [65, 1, 1], [62, 1, 2], [1, 400, 399]] {
        let corners = [[0., 0.], [1024., 0.], [0., 1024.]];
        let mut ring = Vec::new();
        for (k, n) in [a, b, c].into_iter().enumerate() {
            let (p, q): ([f64; 2], [f64; 2]) = (corners[k], corners[(k + 1) % 3]);
            ring.extend(
                (0..n).map(|i| f64::from(i) / 1024.0).map(|t| [p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t]),
            );
        }
        convex(&ring);
    }
}

#[test]
fn a_hundred_thousand_corners_take_no_time_to_speak_of() {
    let points: Vec<_> = (0..100_000).map(f64::from).map(|x| [x, x * x]).collect();
    let start = Instant::now();
    let scene = flat(&[points]).unwrap();
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    assert!(scene.pieces().all(|piece| piece.vertices().len() <= 64));
}
