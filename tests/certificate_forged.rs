//! Evidence that no engine made: it is refused, and nothing in it makes the check take long.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::exact::Sign;
use nusselt::scene::{Axis, Material, PieceId, Scene, Splitter, SupportingPlane, VertexId};
use nusselt::verify::{
    Arithmetic, Defect, Evidence, EvidenceCell, EvidenceDomain, EvidenceSliver, Extent, HalfSphere, Rule,
};
use proptest::prelude::*;
use std::time::{Duration, Instant};

fn half(splitter: usize) -> HalfSphere {
    HalfSphere { splitter: splitter as u32, inside: Sign::Positive }
}

/// All directions, split into cells with these inward normals.
fn sphere(cells: &[Vec<DVec3>]) -> Evidence {
    let mut evidence = Evidence {
        eye: DVec3::ZERO,
        domain: EvidenceDomain::Sphere,
        epsilon: 0.0,
        slivers: Vec::new(),
        splitters: Vec::new(),
        cells: Vec::new(),
    };
    for normals in cells {
        let first = evidence.splitters.len();
        evidence.splitters.extend(normals.iter().map(|&normal| Splitter::Given(normal)));
        let sides = (first..evidence.splitters.len()).map(half).collect();
        evidence.cells.push(EvidenceCell { piece: None, sides });
    }
    evidence
}

fn empty() -> Scene {
    Scene::builder().build().expect("an empty scene")
}

/// Rule A in its own words: every side has all corners but its own strictly inside.
fn is_convex(normals: &[[i64; 3]]) -> bool {
    let det = |a: [i64; 3], b: [i64; 3], c: [i64; 3]| {
        let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
        a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)
    };
    let len = normals.len();
    let corners = (0..len).map(|k| (k, (k + 1) % len));
    corners
        .into_iter()
        .all(|(k, next)| (0..len).all(|j| j == k || j == next || det(normals[j], normals[k], normals[next]) > 0))
}

fn is_taken_for_convex(normals: &[[i64; 3]], arithmetic: Arithmetic) -> bool {
    let normals = normals.iter().map(|n| DVec3::from(n.map(|x| x as f64))).collect();
    match sphere(&[normals]).check_to(&empty(), arithmetic, Extent::Tiling) {
        Ok(_) => panic!("one convex cell is no sphere"),
        Err(defect) => defect.rule() != Rule::Convex,
    }
}

/// Normals about an axis, so many times around, and then a few of them moved.
fn around() -> impl Strategy<Value = Vec<[i64; 3]>> {
    let about_z = (3..12_usize, 1..4_usize, 1..40_i64, 0.0..1.0_f64).prop_map(|(len, turns, height, from)| {
        let angle = |k: usize| (from + (k * turns) as f64 / len as f64) * std::f64::consts::TAU;
        let normal = |k: usize| [(angle(k).cos() * 30.0) as i64, (angle(k).sin() * 30.0) as i64, height];
        (0..len).map(normal).collect::<Vec<_>>()
    });
    let moved = prop::collection::vec((any::<prop::sample::Index>(), 0..3_usize, -9..10_i64), 0..3);
    (about_z, moved, 0..3_usize).prop_map(|(mut normals, moved, turn)| {
        for (k, axis, by) in moved {
            let k = k.index(normals.len());
            normals[k][axis] += by;
        }
        for normal in &mut normals {
            normal.rotate_left(turn);
        }
        normals
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn convex_cells_are_exactly_those_with_all_corners_inside_of_all_sides(
        normals in prop_oneof![around(), prop::collection::vec(prop::array::uniform3(-3..4_i64), 3..7)]
    ) {
        // Sides that go on along one great circle are one.
        let parallel = |a: [i64; 3], b: [i64; 3]| (0..3).all(|i| a[i] * b[(i + 1) % 3] == a[(i + 1) % 3] * b[i]);
        prop_assume!((0..normals.len()).all(|k| !parallel(normals[k], normals[(k + 1) % normals.len()])));
        for arithmetic in [Arithmetic::Kernel, Arithmetic::Rational] {
            prop_assert_eq!(is_taken_for_convex(&normals, arithmetic), is_convex(&normals), "{:?}", arithmetic);
        }
    }
}

#[test]
fn a_boundary_that_winds_twice_is_not_convex() {
    // A star: it turns left at every corner, and each is inside of its neighbours' sides.
    let star: Vec<[i64; 3]> = [[100, 0, 9], [-81, 59, 9], [31, -95, 9], [31, 95, 9], [-81, -59, 9]].into();
    assert!(!is_convex(&star) && !is_taken_for_convex(&star, Arithmetic::Kernel));
    let twice: Vec<[i64; 3]> = [[3, 0, 1], [0, 3, 1], [-3, -3, 1], [4, 0, 1], [0, 4, 1], [-4, -4, 1]].into();
    assert!(!is_convex(&twice) && !is_taken_for_convex(&twice, Arithmetic::Kernel));
}

/// The defect, found in reasonable time.
fn soon(evidence: &Evidence, scene: &Scene) -> Defect {
    let start = Instant::now();
    let defect = evidence.check(scene, Arithmetic::Kernel).expect_err("it does not hold");
    assert!(start.elapsed() < Duration::from_secs(300), "{:?} for {defect}", start.elapsed());
    assert!(defect.to_string().len() < 1000);
    defect
}

#[test]
fn a_cell_of_a_hundred_thousand_sides_takes_no_time() {
    let angle = |k: usize| k as f64 / 100_000.0 * std::f64::consts::TAU;
    let normals = (0..100_000).map(|k| DVec3::new(angle(k).cos(), angle(k).sin(), 1.0)).collect();
    let defect = soon(&sphere(&[normals]), &empty());
    // Convex it is.
    assert_eq!(defect.rule(), Rule::Balance, "{defect}");
}

#[test]
fn great_circles_that_nearly_coincide_are_refused_before_they_take_long() {
    let ulps = |k: usize| (k as f64) * f64::EPSILON;
    let normals = (0..40_000).map(|k| DVec3::new(1.0, ulps(k % 200), ulps(k / 200))).collect();
    let defect = soon(&sphere(&[normals]), &empty());
    assert!(defect.to_string().contains("nearly coincide"), "{defect}");
}

#[test]
fn a_million_equal_cells_are_refused_in_a_short_message() {
    let octant = vec![DVec3::X, DVec3::Y, DVec3::Z];
    let mut evidence = sphere(&[octant]);
    evidence.cells = vec![evidence.cells[0].clone(); 1_000_000];
    let defect = soon(&evidence, &empty());
    assert_eq!(defect.rule(), Rule::Balance);
    assert!(defect.to_string().contains("more"), "{defect}");
    assert_eq!(defect.polygons(&evidence, &empty()), []);
}

#[test]
fn forged_slivers_far_from_their_plane_excuse_nothing() {
    // A square and another one behind it that fills the same directions; the second is shown.
    let square = |s: f64| [[-s, -s, s], [s, -s, s], [s, s, s], [-s, s, s]];
    let vertices = [square(1.0), square(2.0)].concat();
    let faces = [vec![0, 1, 2, 3], vec![4, 5, 6, 7]];
    let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("two squares");
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
    let image = bsp.view(&Viewpoint::free(DVec3::ZERO), &Domain::Sphere).expect("a good viewpoint");
    let mut evidence = image.evidence();
    for cell in &mut evidence.cells {
        cell.piece = cell.piece.map(|_| PieceId(1));
    }
    assert_eq!(soon(&evidence, &scene).rule(), Rule::Depth);
    evidence.epsilon = 1e-300;
    let flat = |a: u32, b: u32, c: u32| SupportingPlane::Points([a, b, c].map(VertexId));
    let level = |value| SupportingPlane::Axis { axis: Axis::Z, value };
    for (plane, rule) in [
        // No plane at all, and one that cuts both squares.
        (flat(4, 4, 4), Rule::Depth),
        (flat(0, 1, 7), Rule::Depth),
        (level(2.5), Rule::Depth),
        // The second square is in that plane, but what hides it is far from it.
        (level(2.0), Rule::Depth),
    ] {
        evidence.slivers = vec![EvidenceSliver { piece: PieceId(1), plane, beyond: None }];
        assert_eq!(soon(&evidence, &scene).rule(), rule, "{plane:?}");
    }
}

#[test]
fn great_circles_without_a_normal_and_numbers_of_any_size_are_taken() {
    let scene = nusselt::samples::cornell_box().to_builder().build().expect("the box");
    let wild = [5e-324, -0.0, 1.7e308, -1e-300, 1.0];
    let numbers = (0..125).map(|k| DVec3::new(wild[k % 5], wild[k / 5 % 5], wild[k / 25]));
    let mut splitters: Vec<Splitter> = numbers.map(Splitter::Given).collect();
    let axis = |value| SupportingPlane::Axis { axis: Axis::Y, value };
    let line = SupportingPlane::Points([VertexId(0), VertexId(0), VertexId(1)]);
    let planes = [axis(1.7e308), axis(5e-324), axis(-0.0), line, scene.planes()[3]];
    splitters.extend(planes.iter().map(|&plane| Splitter::Parallel(plane)));
    splitters.extend((0..25).map(|k| Splitter::Crease([planes[k / 5], planes[k % 5]])));
    splitters.extend((0..9).map(|k| Splitter::Edge([VertexId(k / 3), VertexId(k % 3)])));
    for eye in [DVec3::ZERO, scene.vertices()[1], DVec3::splat(1e300), DVec3::splat(-5e-324)] {
        for k in 0..splitters.len() {
            let picked = [k, (k * 7 + 3) % splitters.len(), (k * 31 + 11) % splitters.len(), k * 3 % splitters.len()];
            let evidence = Evidence {
                eye,
                domain: EvidenceDomain::Hemisphere(DVec3::new(5e-324, 1e308, -1.0)),
                epsilon: 1e308,
                slivers: Vec::new(),
                splitters: splitters.clone(),
                cells: vec![EvidenceCell { piece: Some(PieceId(0)), sides: picked.map(half).into() }],
            };
            let arithmetic = if k % 16 == 0 { Arithmetic::Rational } else { Arithmetic::Kernel };
            evidence.check(&scene, arithmetic).expect_err("one cell is no hemisphere");
        }
    }
}
