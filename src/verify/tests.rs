//! The rules of the ray oracle one by one, and its two stages against plain rational arithmetic.

use super::ray::Stage;
use super::{RayAnswer, RayOracle};
use crate::scene::{PieceId, PolygonId, Side};
use glam::DVec3;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use proptest::prelude::*;

type Piece = (u32, Vec<DVec3>);

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A square of half side 1 about the z axis that shows its front to larger z.
fn square(z: f64) -> Vec<DVec3> {
    vec![v(-1.0, -1.0, z), v(1.0, -1.0, z), v(1.0, 1.0, z), v(-1.0, 1.0, z)]
}

fn reversed(mut loop_: Vec<DVec3>) -> Vec<DVec3> {
    loop_.reverse();
    loop_
}

fn hit(polygon: u32, piece: u32, side: Side) -> RayAnswer {
    RayAnswer::Hit { polygon: PolygonId(polygon), piece: PieceId(piece), side }
}

fn oracle(pieces: &[Piece]) -> RayOracle {
    RayOracle::from_pieces(pieces.iter().map(|(polygon, points)| (PolygonId(*polygon), points.iter().copied())))
}

/// The answer of both stages and of the rational reference, which must agree.
#[track_caller]
fn cast(pieces: &[Piece], eye: DVec3, direction: DVec3) -> RayAnswer {
    let oracle = oracle(pieces);
    let answer = oracle.cast(eye, direction);
    assert_eq!(oracle.cast_in(eye, direction, Stage::Exact), answer, "integers only: {pieces:?} {eye} {direction}");
    assert_eq!(reference(pieces, eye, direction), answer, "rationals: {pieces:?} {eye} {direction}");
    answer
}

mod rational {
    use super::{BigRational, DVec3};

    pub(super) type Vector = [BigRational; 3];

    pub(super) fn vector(v: DVec3) -> Vector {
        v.to_array().map(|x| BigRational::from_float(x).unwrap())
    }

    pub(super) fn minus(a: &Vector, b: &Vector) -> Vector {
        std::array::from_fn(|k| &a[k] - &b[k])
    }

    pub(super) fn dot(a: &Vector, b: &Vector) -> BigRational {
        &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
    }

    pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
        [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
    }
}

/// The same rules by another way: the point where the ray meets the plane, in rational coordinates,
/// and the side of each edge that it lies on within the plane.
fn reference(pieces: &[Piece], eye: DVec3, direction: DVec3) -> RayAnswer {
    use rational::{cross, dot, minus, vector};
    let [eye, direction] = [eye, direction].map(vector);
    let mut found = Vec::new();
    for (index, (polygon, points)) in pieces.iter().enumerate() {
        let mut points: Vec<_> = points.iter().map(|&p| vector(p)).collect();
        points.dedup();
        // Newell's normal, which needs no choice of vertices.
        let pairs = || (0..points.len()).map(|k| (&points[k], &points[(k + 1) % points.len()]));
        let normal = pairs()
            .map(|(p, q)| cross(p, q))
            .fold(vector(DVec3::ZERO), |sum, c| std::array::from_fn(|k| &sum[k] + &c[k]));
        let height = dot(&normal, &minus(&eye, &points[0]));
        let rate = dot(&normal, &direction);
        if height.is_zero() || rate.is_zero() {
            continue;
        }
        let t = -&height / &rate;
        if !t.is_positive() {
            continue;
        }
        let at: rational::Vector = std::array::from_fn(|k| &eye[k] + &direction[k] * &t);
        let sides: Vec<_> =
            pairs().filter(|(p, q)| p != q).map(|(p, q)| dot(&normal, &cross(&minus(q, p), &minus(&at, p)))).collect();
        if sides.iter().any(Signed::is_negative) {
            continue;
        }
        let side = if height.is_positive() { Side::Front } else { Side::Back };
        found.push((t, sides.iter().any(Zero::is_zero), side, *polygon, index as u32, normal));
    }
    let Some(nearest) = found.iter().map(|f| f.0.clone()).min() else { return RayAnswer::Miss };
    found.retain(|f| f.0 == nearest);
    found.sort_by_key(|f| (f.2, f.3, f.4));
    let same_plane = |f: &rational::Vector| cross(f, &found[0].5).iter().all(Zero::is_zero);
    if found.iter().any(|f| f.1 || !same_plane(&f.5)) {
        return RayAnswer::Boundary;
    }
    hit(found[0].3, found[0].4, found[0].2)
}

#[test]
fn the_nearest_interior_is_seen_with_the_side_that_faces_the_eye() {
    let pieces = [(7, square(1.0)), (3, square(2.0)), (5, reversed(square(-1.0)))];
    assert_eq!(cast(&pieces, DVec3::ZERO, DVec3::Z), hit(7, 0, Side::Back));
    assert_eq!(cast(&pieces, DVec3::ZERO, -DVec3::Z), hit(5, 2, Side::Back));
    assert_eq!(cast(&pieces, v(0.0, 0.0, 9.0), -DVec3::Z), hit(3, 1, Side::Front));
    assert_eq!(cast(&pieces, v(0.0, 0.0, 9.0), DVec3::Z), RayAnswer::Miss);
    assert_eq!(cast(&pieces, v(0.0, 0.0, 1.5), v(1e-9, 0.0, -1.0)), hit(7, 0, Side::Front));
    assert_eq!(cast(&pieces, DVec3::ZERO, DVec3::X), RayAnswer::Miss);
    assert_eq!(cast(&[], DVec3::ZERO, DVec3::X), RayAnswer::Miss);
}

#[test]
fn a_piece_whose_plane_holds_the_eye_hides_nothing() {
    let pieces = [(0, square(0.0)), (1, square(-1.0))];
    for eye in [DVec3::ZERO, v(1.0, 0.5, 0.0), v(1.0, 1.0, 0.0), v(5.0, 0.0, 0.0)] {
        let down = cast(&pieces, eye, v(-eye.x, -eye.y, -1.0));
        assert_eq!(down, hit(1, 1, Side::Front), "{eye}");
        assert_eq!(cast(&pieces, eye, v(-1.0, -0.5, 0.0)), RayAnswer::Miss);
    }
}

#[test]
fn a_piece_edge_on_or_parallel_to_the_ray_is_not_met() {
    let pieces = [(0, square(0.0)), (1, square(1.0))];
    assert_eq!(cast(&pieces, v(-5.0, 0.0, 0.0), DVec3::X), RayAnswer::Miss);
    assert_eq!(cast(&pieces, v(-5.0, 0.0, 0.5), DVec3::X), RayAnswer::Miss);
}

#[test]
fn edges_and_vertices_are_boundary_if_nothing_is_before_them() {
    let eye = v(0.0, 0.0, 5.0);
    for direction in [v(1.0, 0.0, -5.0), v(1.0, 1.0, -5.0), v(-1.0, 0.25, -5.0)] {
        let target = [(0, square(0.0))];
        assert_eq!(cast(&target, eye, direction), RayAnswer::Boundary);
        assert_eq!(cast(&target, eye, -direction), RayAnswer::Miss, "behind the eye");
        let near = square(4.0);
        let covered = [(0, square(0.0)), (1, near)];
        assert_eq!(cast(&covered, eye, direction), hit(1, 1, Side::Front));
        let backed = [(0, square(0.0)), (1, square(-3.0).into_iter().map(|p| p * v(9.0, 9.0, 1.0)).collect())];
        assert_eq!(cast(&backed, eye, direction), RayAnswer::Boundary, "the edge before the interior");
    }
    // One step of f64 beside the edge.
    let target = [(0, square(0.0))];
    assert_eq!(cast(&target, eye, v(1.0_f64.next_down(), 0.0, -5.0)), hit(0, 0, Side::Front));
    assert_eq!(cast(&target, eye, v(1.0_f64.next_up(), 0.0, -5.0)), RayAnswer::Miss);
    // On the line of an edge, but beyond its end.
    assert_eq!(cast(&target, eye, v(1.0, 2.0, -5.0)), RayAnswer::Miss);
}

#[test]
fn a_diagonal_within_a_polygon_is_boundary() {
    let q = square(0.0);
    let halves = [(0, vec![q[0], q[1], q[2]]), (0, vec![q[0], q[2], q[3]])];
    let eye = v(0.125, 0.375, 2.0);
    assert_eq!(cast(&halves, eye, v(0.5, 0.5, 0.0) - eye), RayAnswer::Boundary);
    assert_eq!(cast(&halves, eye, v(0.5, 0.25, 0.0) - eye), hit(0, 0, Side::Front));
    assert_eq!(cast(&halves, eye, v(0.25, 0.5, 0.0) - eye), hit(0, 1, Side::Front));
}

#[test]
fn in_one_plane_fronts_win_then_low_ids() {
    let eye = v(0.0, 0.0, 3.0);
    let stack = [(4, square(0.0)), (2, reversed(square(0.0))), (3, square(0.0)), (3, square(0.0))];
    assert_eq!(cast(&stack, eye, -DVec3::Z), hit(3, 2, Side::Front));
    assert_eq!(cast(&stack, -eye, DVec3::Z), hit(2, 1, Side::Front));
    // An edge in the same plane makes it a boundary.
    let small: Vec<DVec3> = square(0.0).into_iter().map(|p| p * 0.5).collect();
    let inlaid = [(0, square(0.0)), (1, small)];
    assert_eq!(cast(&inlaid, eye, v(0.5, 0.0, -3.0)), RayAnswer::Boundary);
    assert_eq!(cast(&inlaid, eye, v(0.25, 0.0, -3.0)), hit(0, 0, Side::Front));
}

#[test]
fn thin_walls_show_the_face_on_this_side() {
    let wall = [(0, reversed(square(0.0))), (1, square(0.0))];
    assert_eq!(cast(&wall, v(0.2, 0.1, 1.0), -DVec3::Z), hit(1, 1, Side::Front));
    assert_eq!(cast(&wall, v(0.2, 0.1, -1.0), DVec3::Z), hit(0, 0, Side::Front));
    // As thin as f64 allows.
    let thin = [(0, reversed(square(1.0))), (1, square(1.0_f64.next_up()))];
    for direction in [v(0.0, 0.0, 1.0), v(1e-3, 2e-3, 1e-2)] {
        assert_eq!(cast(&thin, DVec3::ZERO, direction), hit(0, 0, Side::Front));
        assert_eq!(cast(&thin, v(0.0, 0.0, 2.0), -direction), hit(1, 1, Side::Front));
    }
}

#[test]
fn interpenetrating_pieces_cross_in_a_boundary() {
    let slanted = vec![v(-1.0, -1.0, -1.0), v(1.0, -1.0, 1.0), v(1.0, 1.0, 1.0), v(-1.0, 1.0, -1.0)];
    let pieces = [(0, square(0.0)), (1, slanted)];
    let eye = v(0.25, 0.0, 3.0);
    assert_eq!(cast(&pieces, eye, v(0.0, 0.5, 0.0) - eye), RayAnswer::Boundary);
    assert_eq!(cast(&pieces, eye, v(1e-300, 0.5, 0.0) - v(0.0, 0.0, 3.0)), hit(1, 1, Side::Front));
    assert_eq!(cast(&pieces, v(0.0, 0.0, 3.0), v(1e-300, 0.0, -3.0)), hit(1, 1, Side::Front));
    assert_eq!(cast(&pieces, v(0.0, 0.0, 3.0), v(-1e-300, 0.0, -3.0)), hit(0, 0, Side::Front));
    // A nearer piece hides the crossing.
    let hidden = [pieces[0].clone(), pieces[1].clone(), (2, square(2.0))];
    assert_eq!(cast(&hidden, eye, v(0.0, 0.5, 0.0) - eye), hit(2, 2, Side::Front));
}

#[test]
fn odd_loops_are_taken() {
    let q = square(0.0);
    // Repeated and collinear vertices; pieces without area.
    let weak = vec![q[0], q[0], v(0.0, -1.0, 0.0), q[1], q[2], q[2], v(0.5, 1.0, 0.0), q[3], q[0]];
    let flat = vec![v(-1.0, 0.0, 1.0), v(0.0, 0.0, 1.0), v(1.0, 0.0, 1.0)];
    let pieces = [(0, flat), (1, vec![q[0], q[0], q[0]]), (2, weak)];
    let oracle = oracle(&pieces);
    let eye = v(0.0, 0.0, 2.0);
    for stage in [Stage::Filtered, Stage::Exact] {
        assert_eq!(oracle.cast_in(eye, v(0.0, 0.0, -1.0), stage), hit(2, 2, Side::Front));
        assert_eq!(oracle.cast_in(eye, v(0.5, 1.0, -2.0), stage), RayAnswer::Boundary);
        assert_eq!(oracle.cast_in(eye, v(2.0, 1.0, -2.0), stage), RayAnswer::Miss, "along a weak edge");
    }
}

#[test]
fn what_is_no_direction_is_boundary() {
    let oracle = oracle(&[(0, square(0.0))]);
    for direction in [DVec3::ZERO, v(f64::NAN, 0.0, 0.0), v(0.0, f64::INFINITY, 0.0)] {
        assert_eq!(oracle.cast(DVec3::Z, direction), RayAnswer::Boundary);
    }
}

#[test]
fn extreme_exponents_change_nothing() {
    let slanted = vec![v(-1.0, -1.0, -1.0), v(1.0, -1.0, 1.0), v(1.0, 1.0, 1.0), v(-1.0, 1.0, -1.0)];
    let pieces = [(0, square(0.0)), (1, slanted), (2, square(-4.0))];
    for exponent in [-1020, -500, -200, -130, 130, 200, 500, 1000] {
        let scale = 2_f64.powi(exponent);
        let scaled: Vec<Piece> =
            pieces.iter().map(|(id, points)| (*id, points.iter().map(|&p| p * scale).collect())).collect();
        for direction in
            [v(0.1, 0.2, -3.0), v(-0.2, 0.1, -3.0), v(0.0, 0.1, -3.0), v(1.0, 0.1, -3.0), v(2.0, 0.1, -3.0)]
        {
            let expected = cast(&pieces, v(0.0, 0.0, 3.0), direction);
            let eye = v(0.0, 0.0, 3.0) * scale;
            assert_eq!(cast(&scaled, eye, direction), expected, "{exponent}");
            assert_eq!(cast(&scaled, eye, direction * 1e-150), cast(&pieces, v(0.0, 0.0, 3.0), direction * 1e-150));
            assert_eq!(cast(&scaled, eye, direction * 1e150), cast(&pieces, v(0.0, 0.0, 3.0), direction * 1e150));
        }
    }
    // Both ends of the range in one scene.
    let far = (0, square(1.0).into_iter().map(|p| p * 1e300).collect());
    let near = (1, square(1.0).into_iter().map(|p| p * 1e-300).collect());
    let pieces = [far, near];
    assert_eq!(cast(&pieces, DVec3::ZERO, v(0.3, 0.2, 1.0)), hit(1, 1, Side::Back));
    assert_eq!(cast(&pieces, v(0.0, 0.0, 1.0), v(0.3, 0.2, 1.0)), hit(0, 0, Side::Back));
    assert_eq!(cast(&pieces, v(0.0, 0.0, 1.0), v(0.0, 0.0, -1.0)), hit(1, 1, Side::Front));
}

#[test]
fn only_rays_that_need_it_are_exact() {
    let oracle = oracle(&[(0, square(0.0)), (1, square(1.0))]);
    for k in 0..100 {
        oracle.cast(v(0.1, 0.2, 5.0), v(f64::from(k) * 0.003, 0.1, -4.0));
    }
    assert_eq!((oracle.stats().rays, oracle.stats().exact), (100, 0));
    oracle.cast(v(0.0, 0.0, 5.0), v(1.0, 0.5, -5.0));
    assert_eq!((oracle.stats().rays, oracle.stats().exact), (101, 1));
}

fn point(coordinate: impl Strategy<Value = f64> + Clone) -> impl Strategy<Value = DVec3> + Clone {
    prop::array::uniform3(coordinate).prop_map(DVec3::from)
}

/// A triangle, or a parallelogram where its fourth corner is exact.
fn loops(corner: impl Strategy<Value = DVec3> + Clone) -> impl Strategy<Value = Vec<DVec3>> {
    (corner.clone(), corner.clone(), corner, any::<bool>()).prop_map(|(a, b, c, four)| {
        let d = a + (c - b);
        let is_exact = a.to_array().into_iter().chain(b.to_array()).chain(c.to_array()).all(|x| x.fract() == 0.0);
        let is_flat = (b - a).cross(c - a) == DVec3::ZERO;
        match (four && is_exact, is_flat) {
            (_, true) => vec![a, a + DVec3::X, a + DVec3::Y],
            (true, false) => vec![a, b, c, d],
            (false, false) => vec![a, b, c],
        }
    })
}

fn scenes(corner: impl Strategy<Value = DVec3> + Clone, most: usize) -> impl Strategy<Value = Vec<Piece>> {
    prop::collection::vec((0..4_u32, loops(corner)), 1..most)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn stages_agree_on_small_integers(
        pieces in scenes(point((-2..=2_i32).prop_map(f64::from)), 9),
        eye in point((-3..=3_i32).prop_map(f64::from)),
        direction in point((-3..=3_i32).prop_map(f64::from)),
    ) {
        prop_assume!(direction != DVec3::ZERO);
        cast(&pieces, eye, direction);
    }

    #[test]
    fn stages_agree_on_any_numbers(
        pieces in scenes(point(-1.0..1.0_f64), 9),
        eye in point(-1.0..1.0_f64),
        direction in point(-1.0..1.0_f64),
        // Aim at a vertex or a point of an edge, as nearly as f64 can.
        aim in 0..3_u8,
    ) {
        let [p, q] = [pieces[0].1[0], pieces[0].1[1]];
        let direction = match aim {
            0 => direction,
            1 => p - eye,
            _ => p + 0.375 * (q - p) - eye,
        };
        prop_assume!(direction != DVec3::ZERO);
        cast(&pieces, eye, direction);
    }

    #[test]
    fn stages_agree_at_any_scale(
        pieces in scenes(point((-1.0..1.0_f64, -400..400_i32).prop_map(|(x, e)| x * 2_f64.powi(e))), 4),
        eye in point((-1.0..1.0_f64, -400..400_i32).prop_map(|(x, e)| x * 2_f64.powi(e))),
        direction in point((-1.0..1.0_f64, -400..400_i32).prop_map(|(x, e)| x * 2_f64.powi(e))),
    ) {
        prop_assume!(direction != DVec3::ZERO);
        let oracle = oracle(&pieces);
        prop_assert_eq!(oracle.cast(eye, direction), oracle.cast_in(eye, direction, Stage::Exact));
    }

    #[test]
    fn scaling_by_a_power_of_two_changes_nothing(
        pieces in scenes(point((-2..=2_i32).prop_map(f64::from)), 6),
        eye in point((-3..=3_i32).prop_map(f64::from)),
        direction in point((-3..=3_i32).prop_map(f64::from)),
        exponents in prop::array::uniform2(-1000..1000_i32),
    ) {
        let [scale, length] = exponents.map(|e| 2_f64.powi(e));
        let scaled: Vec<Piece> =
            pieces.iter().map(|(id, points)| (*id, points.iter().map(|&p| p * scale).collect())).collect();
        prop_assert_eq!(
            oracle(&scaled).cast(eye * scale, direction * length),
            oracle(&pieces).cast(eye, direction)
        );
    }
}
