//! The report on a mesh: open edges, duplicates, T-junctions, inverted faces, overlaps.

mod common;

use common::{Faces, Random};
use glam::{DQuat, DVec3};
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use nusselt::samples::{Kind, cornell_box, generate};
use nusselt::scene::{FaceSpec, Fronts, Material, MeshReport, Orientation, PolygonId, Scene, TJunction, VertexId};
use proptest::prelude::*;
use std::time::{Duration, Instant};

fn report(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> MeshReport {
    Scene::builder().mesh(vertices, faces, Material::new("m")).build().expect("sound").report()
}

#[test]
fn generated_scenes_are_closed() {
    for kind in Kind::ALL {
        let mesh = generate(kind, 2000, 3).expect("enough polygons");
        let report = mesh.to_builder().build().expect("sound").report();
        assert_eq!((report.open_edges.len(), report.turned_edges.len()), (0, 0), "{kind}");
        assert_eq!((report.duplicates.len(), report.degenerate.len()), (0, 0), "{kind}");
    }
}

#[test]
fn the_cornell_box_is_open() {
    let report = cornell_box().to_builder().build().expect("sound").report();
    // The mouth, the lamp, the bottoms of both blocks.
    assert_eq!(report.open_edges.len(), 4 + 4 + 8);
    assert_eq!(report.non_planar.len(), 1);
}

#[test]
fn turned_duplicate_and_degenerate_faces_are_found() {
    let corners = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [2., 0., 0.]];
    let found = report(&corners, &[vec![0, 1, 2, 3], vec![2, 1, 0, 3], vec![0, 1, 4], vec![1, 2, 4]]);
    assert_eq!(found.duplicates, [[PolygonId(0), PolygonId(1)]]);
    assert_eq!(found.degenerate, [PolygonId(2)]);
    assert_eq!(found.crowded_edges.len(), 1);
    assert_eq!(found.crowded_edges[0].polygons, [0, 1, 3].map(PolygonId));
    let turned = report(&corners, &[vec![0, 1, 2, 3], vec![1, 2, 4]]);
    assert_eq!(turned.turned_edges, [[VertexId(1), VertexId(2)]]);
}

#[test]
fn t_junctions_are_told_from_cracks_and_from_corners() {
    let with = |x: f64| {
        let corners = [[0., 0., 0.], [2., 0., 0.], [0., 2., 0.], [x, 1., 0.], [2., 2., 1.], [9., 9., 9.]];
        report(&corners, &[vec![0, 1, 2], vec![3, 4, 5]]).t_junctions
    };
    let edge = [VertexId(1), VertexId(2)];
    assert_eq!(with(1.0), [TJunction { edge, vertex: VertexId(3), exact: true, gap: 0.0 }]);
    let [crack] = with(1.0 + 1e-12)[..] else { panic!("one crack") };
    assert_eq!((crack.edge, crack.vertex, crack.exact), (edge, VertexId(3), false));
    assert!((crack.gap / (1e-12 * 0.5_f64.sqrt()) - 1.0).abs() < 1e-3, "{:e}", crack.gap);
    assert_eq!(with(1.001), []);
}

#[test]
fn clumps_and_far_points_do_not_make_it_slow_or_wrong() {
    // A strip of 20,000 tiny triangles and one vertex very far away.
    let n = 20_000;
    let mut corners: Vec<[f64; 3]> = (0..n).map(|k| [f64::from(k), f64::from(k % 2), 0.0]).collect();
    corners.push([1e30, 0.0, 1e30]);
    let mut faces: Vec<Vec<usize>> = (0..n as usize - 2).map(|k| vec![k, k + 1, k + 2]).collect();
    faces.push(vec![0, 1, n as usize]);
    let found = report(&corners, &faces);
    assert!(found.open_edges.len() > n as usize / 2);
}

#[test]
fn sizes_of_all_kinds_are_taken() {
    for size in [1e-300, 1.0, 1e300] {
        let corners = [[0., 0., 0.], [2., 0., 0.], [0., 2., 0.], [1., 1., 0.], [2., 2., 1.], [9., 9., 9.]];
        let scaled = corners.map(|p| p.map(|x| x * size));
        assert_eq!(report(&scaled, &[vec![0, 1, 2], vec![3, 4, 5]]).t_junctions.len(), 1, "{size:e}");
    }
}

/// The exact area that two triangles in the plane z = 0 share, doubled: clipping with rational numbers.
fn shared(a: &[[i64; 2]; 3], b: &[[i64; 2]; 3]) -> BigRational {
    let exact = |p: [i64; 2]| p.map(|x| BigRational::from_integer(x.into()));
    let ccw = |t: &[[i64; 2]; 3]| {
        let mut t = t.map(exact).to_vec();
        if twice(&t).is_negative() {
            t.reverse();
        }
        t
    };
    let (mut ring, window) = (ccw(a), ccw(b));
    for (k, from) in window.iter().enumerate() {
        let to = &window[(k + 1) % 3];
        let height =
            |p: &[BigRational; 2]| (&to[0] - &from[0]) * (&p[1] - &from[1]) - (&to[1] - &from[1]) * (&p[0] - &from[0]);
        let mut kept = Vec::new();
        for (j, p) in ring.iter().enumerate() {
            let q = &ring[(j + 1) % ring.len()];
            let (here, there) = (height(p), height(q));
            if !here.is_negative() {
                kept.push(p.clone());
            }
            if here.is_negative() != there.is_negative() {
                let t = &here / (&here - &there);
                kept.push([0, 1].map(|i| &p[i] + (&q[i] - &p[i]) * &t));
            }
        }
        ring = kept;
    }
    twice(&ring)
}

fn twice(ring: &[[BigRational; 2]]) -> BigRational {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(p, q)| &p[0] * &q[1] - &p[1] * &q[0]).sum()
}

/// The corners of a triangle in one of three planes: z = 0, a slanted one, and one across x.
fn lifted(triangle: &[[i64; 2]; 3], plane: usize) -> [[f64; 3]; 3] {
    triangle.map(|[x, y]| {
        let lifted = [[x, y, 0], [x, y, 2 * x - 3 * y + 1], [3, x, y]][plane];
        lifted.map(|x| x as f64)
    })
}

/// Compares the overlaps of triangles in planes with those by rational arithmetic, pair by pair.
fn check_overlaps(triangles: &[([[i64; 2]; 3], usize)]) -> Result<usize, TestCaseError> {
    let exact = |t: &[[i64; 2]; 3]| t.map(|p| p.map(|x| BigRational::from_integer(x.into())));
    let mut vertices = Vec::new();
    let mut faces = Vec::new();
    for (triangle, plane) in triangles {
        faces.push((vertices.len()..vertices.len() + 3).collect::<Vec<_>>());
        vertices.extend(lifted(triangle, *plane));
    }
    let found = report(&vertices, &faces);
    prop_assert!(found.all_overlaps);
    let mut expected = Vec::new();
    for (b, (second, plane)) in triangles.iter().enumerate() {
        for (a, (first, _)) in triangles[..b].iter().enumerate().filter(|(_, (_, other))| other == plane) {
            let both = [first, second].map(|t| twice(&exact(t)));
            let area = shared(first, second);
            if area.is_positive() && both.iter().all(|twice| !twice.is_zero()) {
                let opposed = both[0].is_negative() != both[1].is_negative();
                let stretch = if *plane == 1 { 14f64.sqrt() } else { 1.0 };
                let area = area.to_f64().expect("small") * 0.5 * stretch;
                expected.push(([a, b].map(|k| PolygonId(k as u32)), opposed, area));
            }
        }
    }
    expected.sort_by_key(|overlap| overlap.0);
    prop_assert_eq!(found.overlaps.len(), expected.len());
    for (overlap, (polygons, opposed, area)) in found.overlaps.iter().zip(&expected) {
        prop_assert_eq!((&overlap.polygons, &overlap.opposed), (polygons, opposed));
        prop_assert!((overlap.area - area).abs() <= 1e-12 * (1.0 + area), "{} {area}", overlap.area);
    }
    Ok(expected.len())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn overlaps_of_many_are_those_of_rational_arithmetic(seed: u64, count in 20usize..120, planes in 1usize..4) {
        let mut random = Random(seed);
        let mut triangles = Vec::new();
        let mut next = |low: i64, high: i64| low + random.below((high - low + 1) as usize) as i64;
        while triangles.len() < count {
            // Scattered; or long around a hub; or a square of two, beside others.
            let (x, y, plane) = (next(-12, 12), next(-12, 12), next(0, planes as i64 - 1) as usize);
            match next(0, 2) {
                0 => triangles.push(([0; 3].map(|_| [x + next(-2, 2), y + next(-2, 2)]), plane)),
                1 => triangles.push(([[0, 0], [x, y], [x + next(-1, 1), y + next(-1, 1)]], plane)),
                _ => triangles.extend([[[x, y], [x + 1, y], [x + 1, y + 1]], [[x, y], [x + 1, y + 1], [x, y + 1]]].map(|t| (t, plane))),
            }
        }
        check_overlaps(&triangles)?;
    }
}

proptest! {
    #[test]
    fn overlaps_are_those_of_rational_arithmetic(
        triangles in prop::collection::vec([[-4i64..5, -4i64..5], [-4..5, -4..5], [-4..5, -4..5]], 2..8),
        plane in 0usize..3,
    ) {
        check_overlaps(&triangles.into_iter().map(|triangle| (triangle, plane)).collect::<Vec<_>>())?;
    }

    #[test]
    fn the_order_of_the_faces_does_not_matter(seed: u64) {
        let mut random = Random(seed);
        // Few positions, so that there is much of everything; quads, so that some are bent.
        let vertices: Vec<_> = (0..12).map(|_| random.in_cube(1.4).round().to_array()).collect();
        let mut faces = Vec::new();
        for _ in 0..14 {
            let face: Vec<_> = (0..3 + random.below(2)).map(|_| random.below(12)).collect();
            if Scene::builder().mesh(&vertices, std::slice::from_ref(&face), Material::new("m")).build().is_ok() {
                faces.push(face);
            }
        }
        let mut order: Vec<usize> = (0..faces.len()).collect();
        for k in (1..order.len()).rev() {
            order.swap(k, random.below(k + 1));
        }
        let shuffled: Vec<_> = order.iter().map(|&k| faces[k].clone()).collect();
        let back = |id: PolygonId| PolygonId(order[id.index()] as u32);
        let (plain, other) = (report(&vertices, &faces), report(&vertices, &shuffled));

        let edges = |report: &MeshReport| report.open_edges.iter().map(|open| (open.edge, open.length)).collect::<Vec<_>>();
        prop_assert_eq!(edges(&plain), edges(&other));
        prop_assert_eq!(&plain.turned_edges, &other.turned_edges);
        prop_assert_eq!(&plain.t_junctions, &other.t_junctions);
        prop_assert_eq!(plain.duplicates.len(), other.duplicates.len());
        let sorted = |ids: &mut dyn Iterator<Item = PolygonId>| { let mut ids: Vec<_> = ids.collect(); ids.sort(); ids };
        prop_assert_eq!(&plain.degenerate, &sorted(&mut other.degenerate.iter().map(|&id| back(id))));
        prop_assert_eq!(&plain.inverted, &sorted(&mut other.inverted.iter().map(|&id| back(id))));
        let mut bent: Vec<_> = other.non_planar.iter().map(|face| (back(face.polygon), face.deviation)).collect();
        bent.sort_by_key(|face| face.0);
        let plain_bent: Vec<_> = plain.non_planar.iter().map(|face| (face.polygon, face.deviation)).collect();
        prop_assert_eq!(plain_bent, bent);
        let crowded = |report: &MeshReport, back: &dyn Fn(PolygonId) -> PolygonId| -> Vec<_> {
            report.crowded_edges.iter().map(|e| (e.edge, sorted(&mut e.polygons.iter().map(|&id| back(id))))).collect()
        };
        prop_assert_eq!(crowded(&plain, &|id| id), crowded(&other, &back));
        let overlaps = |report: &MeshReport, back: &dyn Fn(PolygonId) -> PolygonId| -> Vec<_> {
            let mut pairs: Vec<_> = report.overlaps.iter().map(|overlap| {
                let mut polygons = overlap.polygons.map(back);
                polygons.sort();
                (polygons, (overlap.area * 1e9).round())
            }).collect();
            pairs.sort_by_key(|pair| pair.0);
            pairs
        };
        prop_assert_eq!(overlaps(&plain, &|id| id), overlaps(&other, &back));
        let components = |report: &MeshReport| -> Vec<_> {
            let mut all: Vec<_> = report.components.iter().map(|c| {
                (c.polygons, c.closed, format!("{:?} {:?}", c.orientation, c.fronts))
            }).collect();
            all.sort();
            all
        };
        prop_assert_eq!(components(&plain), components(&other));
    }
}

/// A box without shared planes, with the faces named turned over; fronts outside.
fn cuboid(half: DVec3, turned: &[usize]) -> MeshReport {
    let mut faces = Faces::default();
    faces.cuboid(DVec3::new(3.0, 1.0, -2.0), half, DQuat::from_rotation_x(0.3), false);
    for &face in turned {
        faces.faces[face].reverse();
    }
    faces.build().report()
}

#[test]
fn inverted_faces_are_the_lesser_part_by_area() {
    let found = cuboid(DVec3::ONE, &[4]);
    assert_eq!(found.inverted, [PolygonId(4)]);
    assert_eq!(found.turned_edges.len(), 4);
    assert_eq!(found.components.len(), 1);
    assert_eq!(found.components[0].orientation, Orientation::SomeInverted);
    assert_eq!((found.components[0].fronts, found.components[0].volume), (None, None));
    // Of a flat box the two large faces outweigh the four others, which are turned.
    let flat = DVec3::new(1.0, 1.0, 0.01);
    assert_eq!(cuboid(flat, &[2, 3, 4, 5]).inverted, [2, 3, 4, 5].map(PolygonId));
    assert_eq!(cuboid(flat, &[0, 1]).inverted, [2, 3, 4, 5].map(PolygonId));
    // Half and half.
    let half = cuboid(DVec3::ONE, &[0, 2, 4]);
    assert_eq!((half.inverted.len(), half.components[0].orientation), (0, Orientation::Undecided));
}

#[test]
fn solids_have_their_fronts_outside_and_rooms_inside() {
    for (turned, fronts, volume) in
        [(vec![], Fronts::Outwards, 8.0 * 0.5 * 3.0 * 2.0), ((0..6).collect(), Fronts::Inwards, -8.0 * 0.5 * 3.0 * 2.0)]
    {
        let found = cuboid(DVec3::new(0.5, 3.0, 2.0), &turned);
        let [only] = found.components[..] else { panic!("one component") };
        assert_eq!((only.first, only.polygons, only.closed), (PolygonId(0), 6, true));
        assert_eq!((only.orientation, only.fronts), (Orientation::Consistent, Some(fronts)));
        assert!((only.volume.expect("closed") - volume).abs() < 1e-12);
    }
    // A sheet with two sides: closed, and nothing inside.
    let corners = [[0., 0., 0.], [1., 0., 0.], [1., 1., 7.], [0., 1., 7.]];
    let sheet = report(&corners, &[vec![0, 1, 2, 3], vec![3, 2, 1, 0]]);
    let [only] = sheet.components[..] else { panic!("one component") };
    assert_eq!((only.closed, only.fronts, only.volume), (true, None, Some(0.0)));
}

#[test]
fn a_moebius_strip_has_no_two_sides() {
    let n = 12;
    let corner = |k: usize, top: bool| {
        let (a, b) = (std::f64::consts::TAU * k as f64 / n as f64, std::f64::consts::PI * k as f64 / n as f64);
        let r = 2.0 + b.cos() * if top { 0.5 } else { -0.5 };
        [r * a.cos(), r * a.sin(), b.sin() * if top { 0.5 } else { -0.5 }]
    };
    let vertices: Vec<_> = (0..n).flat_map(|k| [corner(k, false), corner(k, true)]).collect();
    let faces: Vec<Vec<usize>> = (0..n)
        .flat_map(|k| {
            let [a, b] = [2 * k, 2 * k + 1];
            // The last ones join the other way around.
            let [c, d] = if k + 1 < n { [a + 2, b + 2] } else { [1, 0] };
            [vec![a, c, b], vec![b, c, d]]
        })
        .collect();
    let found = report(&vertices, &faces);
    let [only] = found.components[..] else { panic!("one component: {:?}", found.components) };
    assert_eq!((only.polygons, only.closed, only.orientation), (2 * n, false, Orientation::NonOrientable));
    assert!(found.inverted.is_empty());
}

#[test]
fn holes_may_run_either_way_without_being_turned() {
    // A wall with a window, and a box in it whose open side is the window's rim.
    let ring = |size: f64| [[-size, -size], [size, -size], [size, size], [-size, size]];
    for reversed in [false, true] {
        let mut builder = Scene::builder();
        let (object, material) = (builder.add_object("o"), builder.add_material(Material::new("m")));
        let add = |builder: &mut nusselt::scene::SceneBuilder, size: f64, z: f64| -> Vec<usize> {
            ring(size).into_iter().map(|[x, y]| builder.add_vertex(DVec3::new(x, y, z))).collect()
        };
        let [outer, mut hole, back] = [(3.0, 0.0), (1.0, 0.0), (1.0, -1.0)].map(|(size, z)| add(&mut builder, size, z));
        for k in 0..4 {
            let next = (k + 1) % 4;
            let side = vec![hole[k], hole[next], back[next], back[k]];
            builder.add_face(FaceSpec { rings: vec![side], object, material });
        }
        if reversed {
            hole.reverse();
        }
        builder.add_face(FaceSpec { rings: vec![outer, hole], object, material });
        builder.add_face(FaceSpec { rings: vec![back], object, material });
        let found = builder.build().expect("sound").report();
        assert!(found.turned_edges.is_empty(), "reversed: {reversed}");
        assert_eq!((found.open_edges.len(), found.components.len()), (4, 1));
    }
}

#[test]
fn sizes_are_in_scene_units_at_every_scale() {
    for exponent in [-1000, -300, 0, 300, 1000] {
        let s = 2f64.powi(exponent);
        let corners = [[0., 0., 0.], [4., 0., 0.], [4., 4., 0.], [0., 4., 1.], [9., 9., 9.]].map(|p| p.map(|x| x * s));
        let found = report(&corners, &[vec![0, 1, 2, 3]]);
        let [bent] = found.non_planar[..] else { panic!("one") };
        // The area normal is (2, -2, 16) up to scale: heights 0, 8, 0, 8 over its length.
        let expected = 4.0 / 264f64.sqrt();
        assert!((bent.deviation / s - expected).abs() < 1e-14, "2^{exponent}: {}", bent.deviation / s);
        let lengths: Vec<_> = found.open_edges.iter().map(|open| open.length / s).collect();
        for (length, expected) in lengths.iter().zip([4.0, 17f64.sqrt(), 4.0, 17f64.sqrt()]) {
            assert!((length - expected).abs() < 1e-14, "2^{exponent}: {lengths:?}");
        }
    }
}

#[test]
fn overlaps_have_areas_and_facings_and_touching_is_none() {
    let corners = [
        [0., 0., 1.],
        [4., 0., 1.],
        [4., 4., 1.],
        [0., 4., 1.],
        [3., 3., 1.],
        [6., 3., 1.],
        [6., 6., 1.],
        [3., 6., 1.],
        [4., -4., 1.],
        [8., 0., 1.],
    ];
    // An L whose inner corner holds the square, a square across its corner from below, and one that touches.
    let found = report(&corners, &[vec![0, 1, 2, 3], vec![7, 6, 5, 4], vec![1, 9, 8]]);
    let [overlap] = found.overlaps[..] else { panic!("{:?}", found.overlaps) };
    assert_eq!((overlap.polygons, overlap.opposed), ([0, 1].map(PolygonId), true));
    assert!((overlap.area - 1.0).abs() < 1e-15);
}

#[test]
fn concave_and_bent_polygons_overlap_once_each() {
    // Two combs pushed into each other from opposite sides: many pieces, one pair.
    let comb = |flip: bool| -> Vec<[f64; 3]> {
        let mut ring = vec![[0., 0.], [9., 0.]];
        for k in (0..5).rev() {
            ring.extend([[2.0 * k as f64 + 1.0, 5.0], [2.0 * k as f64, 5.0], [2.0 * k as f64, 2.0]]);
            if k > 0 {
                ring.push([2.0 * k as f64 - 1.0, 2.0]);
            } else {
                ring.pop();
            }
        }
        ring.into_iter().map(|[x, y]: [f64; 2]| if flip { [x, 6.5 - y, 0.0] } else { [x, y, 0.0] }).collect()
    };
    let (first, second) = (comb(false), comb(true));
    let n = first.len();
    let vertices: Vec<_> = first.into_iter().chain(second).collect();
    let found = report(&vertices, &[(0..n).collect(), (n..2 * n).collect()]);
    let [overlap] = found.overlaps[..] else { panic!("{:?}", found.overlaps) };
    // The teeth lie on each other for 3.5 of their length, five of width 1; between them the backs do not reach.
    assert!(overlap.opposed);
    assert!((overlap.area - 5.0 * 3.5).abs() < 1e-12, "{}", overlap.area);
}

#[test]
fn large_scenes_are_looked_over_in_a_few_seconds() {
    for kind in Kind::ALL {
        let scene = generate(kind, 50_000, 3).expect("enough polygons").to_builder().build().expect("sound");
        let start = Instant::now();
        let found = scene.report();
        assert!(start.elapsed() < Duration::from_secs(60), "{kind}: {:?}", start.elapsed());
        assert!(found.all_overlaps && found.all_t_junctions);
        // Boxes side by side share edges in the office.
        assert!(found.components.iter().all(|c| c.closed) || !found.crowded_edges.is_empty(), "{kind}");
        assert!(found.components.iter().all(|c| c.closed == c.fronts.is_some()), "{kind}");
        let inwards = found.components.iter().filter(|c| c.fronts == Some(Fronts::Inwards)).count();
        assert_eq!(inwards, 1, "{kind}: the shell");
    }
}

#[test]
fn heaps_on_one_spot_are_given_up_and_said_to_be() {
    // Squares all on each other.
    let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    let found = report(&square, &vec![vec![0, 1, 2, 3]; 1000]);
    assert!(!found.all_overlaps);
    assert_eq!(found.overlaps.len(), 100_000);
    assert_eq!(found.duplicates.len(), 999);
}

/// Triangles from a hub to neighbouring points of a circle, whose coordinates are multiples of 2^-20.
fn fan(count: usize, lift: impl Fn(f64, f64) -> f64, hub: f64) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let round = |x: f64| (x * f64::from(1 << 20)).round() / f64::from(1 << 20);
    let mut vertices = vec![[0.0, 0.0, hub]];
    vertices.extend((0..count).map(|k| {
        let (y, x) = (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
        [round(x), round(y), lift(round(x), round(y))]
    }));
    (vertices, (0..count).map(|k| vec![0, k + 1, (k + 1) % count + 1]).collect())
}

#[test]
fn fans_and_cones_of_very_many_are_searched_to_the_end() {
    let slanted = |x: f64, y: f64| 0.5 * x + 0.25 * y;
    for (lift, hub, count) in
        [(&(|_, _| 0.0) as &dyn Fn(f64, f64) -> f64, 0.0, 12_000), (&slanted, 0.0, 12_000), (&|_, _| 0.0, 1.0, 20_000)]
    {
        let (mut vertices, mut faces) = fan(count, lift, hub);
        let found = report(&vertices, &faces);
        assert!(found.all_overlaps);
        assert_eq!(found.overlaps, []);
        // One more, over the first two and no other.
        if hub == 0.0 {
            let third = vertices[3];
            vertices.push(third.map(|x| 0.5 * x));
            faces.push(vec![0, 1, vertices.len() - 1]);
            let found = report(&vertices, &faces);
            assert!(found.all_overlaps);
            let on: Vec<_> = found.overlaps.iter().map(|overlap| overlap.polygons).collect();
            assert_eq!(on, [[0, count], [1, count]].map(|pair| pair.map(|k| PolygonId(k as u32))));
        }
    }
}

#[test]
fn rings_and_floors_of_very_many_are_searched_to_the_end() {
    // Quads around a small hole: they share no vertex with most others, but their boxes meet.
    let n = 5_000_usize;
    let (inner, _) = fan(n, |x, y| x + y, 0.0);
    let vertices: Vec<_> = inner[1..]
        .iter()
        .chain(&inner[1..])
        .enumerate()
        .map(|(k, p)| p.map(|x| if k < n { x / 1024.0 } else { x }))
        .collect();
    let faces: Vec<_> = (0..n).map(|k| vec![k, n + k, n + (k + 1) % n, (k + 1) % n]).collect();
    let found = report(&vertices, &faces);
    assert!(found.all_overlaps && found.overlaps.is_empty());
    // A floor of tiles, turned, and one sheet over all of them.
    let n = 100_usize;
    let corner = |i: usize, j: usize| [3.0 * i as f64 - 4.0 * j as f64, 4.0 * i as f64 + 3.0 * j as f64, i as f64];
    let vertices: Vec<_> = (0..=n).flat_map(|i| (0..=n).map(move |j| corner(i, j))).collect();
    let at = |i: usize, j: usize| i * (n + 1) + j;
    let mut faces: Vec<_> = (0..n)
        .flat_map(|i| (0..n).map(move |j| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]))
        .collect();
    faces.push(vec![at(0, 0), at(n, 0), at(n, n), at(0, n)]);
    let found = report(&vertices, &faces);
    assert!(found.all_overlaps);
    assert_eq!(found.overlaps.len(), n * n);
    assert!(found.overlaps.iter().all(|overlap| overlap.polygons[1] == PolygonId((n * n) as u32)));
}
