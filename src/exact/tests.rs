//! Bounds against rational numbers, with what is bounded as far off as it may be.

use super::approx::{Approx3, U};
use super::approximate::{ApproxPlane, ApproxPoint};
use super::arena::{Num, Num3};
use super::ball::Ball;
use super::boxes::SeenBox;
use super::definition::Plane;
use super::frame::{BitRange, Frame};
use super::orient::orient3d_filter;
use super::{Arena, Sign, fixed};
use glam::DVec3;
use num_rational::BigRational;
use num_traits::{FromPrimitive, Signed, Zero};
use proptest::prelude::*;

type Rational = BigRational;
type Rational3 = [Rational; 3];

fn exact(x: f64) -> Rational {
    Rational::from_float(x).unwrap()
}

fn exact3(v: DVec3) -> Rational3 {
    v.to_array().map(exact)
}

fn sub([a, b, c]: &Rational3, [x, y, z]: &Rational3) -> Rational3 {
    [a - x, b - y, c - z]
}

fn cross([a, b, c]: &Rational3, [x, y, z]: &Rational3) -> Rational3 {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

fn dot([a, b, c]: &Rational3, [x, y, z]: &Rational3) -> Rational {
    a * x + b * y + c * z
}

fn sign(x: &Rational) -> Sign {
    Sign::from(x.cmp(&Rational::zero()))
}

/// The corner of the box `v ± err` with those signs, some of which may be 0.
fn corner(v: DVec3, err: DVec3, signs: [i8; 3]) -> Rational3 {
    [0, 1, 2].map(|k| exact(v[k]) + exact(err[k]) * exact(f64::from(signs[k])))
}

/// The power of two by which `approx` is scaled, from the largest component of what it stands for.
fn scale(approx: &Approx3, of: &Rational3) -> Rational {
    let k = (0..3).max_by(|&i, &j| approx.v[i].abs().total_cmp(&approx.v[j].abs())).unwrap();
    let ratio = exact(approx.v[k]) / &of[k];
    let two = Rational::from_u8(2).unwrap();
    let mut power = Rational::from_u8(1).unwrap();
    // The nearest power: a vector is off by at most an eighth.
    while &power * exact(1.4) < ratio {
        power *= &two;
    }
    while &power * exact(0.7) > ratio {
        power /= &two;
    }
    power
}

/// What the slack of an approximation promises: `8 err + 32 u`, with `err` for the largest component's error.
/// Components much smaller than the largest one may underflow.
fn holds(approx: &Approx3, of: &Rational3) -> bool {
    if approx.slack.is_infinite() {
        return true;
    }
    let scale = scale(approx, of);
    let room = exact(approx.slack) - exact(32.0 * U) + exact(f64::MIN_POSITIVE);
    (0..3).all(|k| (exact(approx.v[k]) - &scale * &of[k]).abs() * exact(8.0) <= room)
}

/// In `[-2, 2]`, often at the ends of a range of exponents, where roundings are largest.
fn component() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => -2.0..2.0f64,
        1 => prop::sample::select(vec![1.0, -1.0, 0.0, 2.0 - f64::EPSILON, f64::EPSILON - 2.0]),
        1 => (any::<bool>(), 0..200u8).prop_map(|(negative, k)| (1.0 + f64::from(k) * f64::EPSILON) * if negative { -1.0 } else { 1.0 }),
    ]
}

fn vector() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(component()).prop_map(DVec3::from).prop_filter("not 0", |v| v.abs().max_element() >= 1.0)
}

fn signs() -> impl Strategy<Value = [i8; 3]> {
    prop::array::uniform3(prop::sample::select(vec![-1, 1, 1, -1, 0]))
}

/// An error of a component: none, some units in the last place, or more.
fn error() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), (3..56i32).prop_map(|k| 2f64.powi(-k)), 0.0..0.12f64]
}

/// A power of two.
fn power(exponents: std::ops::Range<i32>) -> impl Strategy<Value = f64> {
    exponents.prop_map(|k| 2f64.powi(k))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]
    #[test]
    fn dot_products_have_the_sign_told_wherever_the_vectors_are(
        v in vector(), w in vector(), [e, f] in prop::array::uniform2(error()), [s, t] in prop::array::uniform2(signs()),
        off in power(-56..0),
    ) {
        // Nearly perpendicular.
        let w = w - v * (v.dot(w) / v.dot(v)) + v * off;
        let sides = (Approx3::known(v, e), Approx3::known(w, f));
        let product = dot(&corner(v, DVec3::splat(e), s), &corner(w, DVec3::splat(f), t));
        prop_assert!(sides.0.dot_sign(&sides.1).is_none_or(|told| told == sign(&product)), "{product}");
    }

    #[test]
    fn determinants_have_the_sign_told_wherever_the_vectors_are(
        v in vector(), w in vector(), [s, t] in prop::array::uniform2(component()), errors in prop::array::uniform3(error()),
        at in prop::array::uniform3(signs()), off in power(-56..0), noise in vector(), turn in 0..3usize,
    ) {
        let mut vectors = [v, w, v * s + w * t + noise * off];
        vectors.rotate_left(turn);
        prop_assume!(vectors.iter().all(|v| v.abs().max_element() > 0.01));
        let [a, b, c] = [0, 1, 2].map(|k| Approx3::known(vectors[k], errors[k]));
        let [x, y, z] = [0, 1, 2].map(|k| corner(vectors[k], DVec3::splat(errors[k]), at[k]));
        let told = a.det_sign(&b, &c);
        prop_assert!(told.is_none_or(|told| told == sign(&dot(&x, &cross(&y, &z)))));
    }

    #[test]
    fn vectors_that_may_be_parallel_are_not_told_apart(
        v in vector(), e in error(), f in error(), [s, t] in prop::array::uniform2(signs()), factor in component(),
    ) {
        // The true vectors are both multiples of v, exactly.
        prop_assume!(factor.abs() > 0.25);
        let factor = f64::from(factor as f32);
        let v = DVec3::from(v.to_array().map(|x| f64::from(x as f32 / 1.01)));
        let (p, q) = (v - DVec3::from(s.map(f64::from)) * e, v * factor - DVec3::from(t.map(f64::from)) * f);
        prop_assert!(!Approx3::known(p, e * (1.0 + 8.0 * U) + 2.0 * U).not_parallel(&Approx3::known(q, f * (1.0 + 8.0 * U) + 4.0 * U)));
    }

    #[test]
    fn what_slack_promises_holds(
        [eye, a, b] in prop::array::uniform3(vector()), scales in prop::array::uniform3(power(-60..1)), all in power(-505..450),
        err in error(), at in signs(), small in prop_oneof![3 => Just(1.0), 1 => power(-520..-500)],
    ) {
        let [eye, a, b] = [eye * scales[0], a * scales[1], a * scales[1] + b * scales[2]].map(|p| p * (all * small));
        let [x, y, z] = [eye, a, b].map(exact3);
        let direction = Approx3::direction(eye, a, 0.0);
        prop_assert!(eye == a || holds(&direction, &sub(&y, &x)), "{:?}", direction);
        let err = err * all * small;
        let direction = Approx3::direction(eye, a, err);
        let true_point = corner(a, DVec3::splat(err), at);
        prop_assert!(true_point == x || holds(&direction, &sub(&true_point, &x)), "{direction:?}");
        let given = Approx3::known(a, err);
        prop_assert!(holds(&given, &true_point), "{given:?}");
        let normal = Approx3::edge_normal(eye, a, b);
        let exact = cross(&sub(&y, &x), &sub(&z, &x));
        prop_assert!(exact.iter().all(Zero::is_zero) || holds(&normal, &exact), "{normal:?} {eye} {a} {b}");
    }

    #[test]
    fn cross_products_are_as_close_as_their_slack_wherever_the_vectors_are(
        v in vector(), w in vector(), e in error(), f in error(), [s, t] in prop::array::uniform2(signs()),
    ) {
        let product = Approx3::known(v, e).cross(Approx3::known(w, f));
        let exact = cross(&corner(v, DVec3::splat(e), s), &corner(w, DVec3::splat(f), t));
        prop_assert!(exact.iter().all(Zero::is_zero) || holds(&product, &exact), "{product:?}");
    }

    #[test]
    fn balls_hold_all_that_their_operands_hold(
        [a, b] in prop::array::uniform2((component(), error(), power(-40..40))), small in power(-600..0),
        [s, t] in prop::array::uniform2(prop::sample::select(vec![-1, 0, 1])), alike in 0..4,
    ) {
        let [x, y] = [a, b].map(|(m, r, size)| Ball::new(m * size * small, r * size * small));
        // Sums of middles that cancel, so that the radii are all there is.
        let y = if alike == 0 { Ball::new(-x.mid, y.rad) } else { y };
        let at = |ball: Ball, side: i32| exact(ball.mid) + exact(ball.rad) * exact(f64::from(side));
        let (p, q) = (at(x, s), at(y, t));
        let inside = |ball: Ball, value: &Rational| {
            !ball.rad.is_finite() || (ball.rad >= 0.0 && (exact(ball.mid) - value).abs() <= exact(ball.rad))
        };
        prop_assert!(inside(x + y, &(&p + &q)), "{x:?} {y:?} {:?}", x + y);
        prop_assert!(inside(x - y, &(&p - &q)), "{x:?} {y:?} {:?}", x - y);
        prop_assert!(inside(x * y, &(&p * &q)), "{x:?} {y:?} {:?}", x * y);
        prop_assert!(q.is_zero() || inside(x.div(y), &(&p / &q)), "{x:?} {y:?} {:?}", x.div(y));
    }

    #[test]
    fn balls_are_hardly_larger_than_they_must_be(
        [a, b] in prop::array::uniform2((0.5..2.0f64, 0.0..0.2f64)), size in power(-100..100), certain: bool,
    ) {
        let [x, y] = [a, b].map(|(m, r)| Ball::new(m * size, if certain { 0.0 } else { r * size }));
        // Ends of the true range, and a rounding or two.
        let (most, least) = ((x.mid + x.rad, y.mid + y.rad), (x.mid - x.rad, y.mid - y.rad));
        let hair = 8.0 * U;
        prop_assert!((x + y).rad <= (x.rad + y.rad) * (1.0 + 40.0 * U) + hair * (x.mid + y.mid));
        prop_assert!((x * y).rad <= (most.0 * most.1 - x.mid * y.mid) * (1.0 + 1e-9) + hair * x.mid * y.mid);
        let quotient = x.div(y);
        prop_assert!(quotient.rad <= (most.0 / least.1 - x.mid / y.mid) * (1.0 + 1e-9) + hair * (x.mid / y.mid));
    }

    #[test]
    fn heights_and_points_between_are_as_close_as_their_radii(
        [a, b, c, p, q] in prop::array::uniform5(vector()), scales in prop::array::uniform3(power(-30..1)), far in power(0..40),
        err in prop::array::uniform3(error()), at in signs(), level in prop::option::of(0..3usize), same in 0..3usize,
    ) {
        let (b, c) = (a + b * scales[0], a + c * scales[1]);
        let (p, mut q) = (p * far, q * far);
        q[same] = p[same];
        let plane = match level {
            Some(axis) => Plane::Axis { axis, value: a[axis] },
            None => Plane::Points([a, b, c]),
        };
        let normal = match level {
            Some(axis) => exact3(DVec3::AXES[axis]),
            None => cross(&sub(&exact3(b), &exact3(a)), &sub(&exact3(c), &exact3(a))),
        };
        prop_assume!(!normal.iter().all(Zero::is_zero));
        let approx = ApproxPlane::new(&plane);
        prop_assume!(approx.normal.slack.is_finite());
        let unit = scale(&approx.normal, &normal);
        let height = |point: &Rational3| dot(&normal, &sub(point, &exact3(a))) * &unit;
        let inside = |ball: Ball, value: &Rational| {
            !ball.rad.is_finite() || (exact(ball.mid) - value).abs() <= exact(ball.rad)
        };
        let err = DVec3::from(err);
        let above = height(&corner(p, err, at));
        let told = approx.height(&ApproxPoint { position: p, err });
        prop_assert!(inside(told, &above), "{told:?}");

        let ends = [p, q].map(ApproxPoint::exact);
        let heights = [p, q].map(|end| height(&exact3(end)));
        if sign(&heights[0]) * sign(&heights[1]) == Sign::Negative {
            let point = ApproxPoint::between(ends[0], ends[1], approx.height(&ends[0]), approx.height(&ends[1]));
            let t = &heights[0] / (&heights[0] - &heights[1]);
            prop_assert!(point.err[same] == 0.0 && point.position[same].total_cmp(&p[same]).is_eq(), "{point:?}");
            for k in 0..3 {
                let x = exact(p[k]) + &t * (exact(q[k]) - exact(p[k]));
                prop_assert!(inside(Ball::new(point.position[k], point.err[k]), &x), "{k}: {point:?}");
            }
        }
    }

    #[test]
    fn positions_are_as_close_as_their_bounds(
        [origin, p] in prop::array::uniform2(vector()), size in power(-300..300), near in power(-60..1), w in 1..1i128 << 40, at in signs(),
    ) {
        let p = (origin + p * near) * size;
        let origin = origin * size;
        let frame = Frame::new(BitRange::of([origin, p]), origin);
        let mut arena = Arena::default();
        let (x, weight) = (frame.relative(&mut arena, p), arena.integer(w));
        // Towards p, divided by w, and on either side of the origin.
        let x = [0, 1, 2].map(|k| if at[k] < 0 { x[k].negated() } else { x[k] });
        let mark = arena.mark();
        let (position, err) = frame.position(&mut arena, x, weight);
        prop_assert_eq!(arena.mark(), mark);
        for k in 0..3 {
            let offset = (exact(p[k]) - exact(origin[k])) / Rational::from_i128(w).unwrap();
            let exactly = if at[k] < 0 { exact(origin[k]) - offset } else { exact(origin[k]) + offset };
            let off = (exact(position[k]) - &exactly).abs();
            prop_assert!(off <= exact(err[k]), "{k}: {position} {err}");
            prop_assert!(off <= exactly.abs() * exact(4.0 * U) + exact(f64::MIN_POSITIVE));
        }
    }

    #[test]
    fn the_filter_of_orient3d_is_right_at_all_scales(
        [a, b, c] in prop::array::uniform3(vector()), [s, t] in prop::array::uniform2(component()), off in power(-56..0), noise in vector(),
        scales in prop::array::uniform3(power(-40..5)), all in prop_oneof![3 => Just(1.0), 1 => power(-350..-320), 1 => power(-400..400)],
        turn in 0..4usize,
    ) {
        let scales = DVec3::from(scales) * all;
        let mut points = [a, b, c, a + (b - a) * s + (c - a) * t + noise * off].map(|p| p * scales);
        points.rotate_left(turn);
        let [p, q, r] = [1, 2, 3].map(|k| sub(&exact3(points[k]), &exact3(points[0])));
        let told = orient3d_filter(points[0], points[1], points[2], points[3]);
        prop_assert!(told.is_none_or(|told| told == sign(&dot(&p, &cross(&q, &r)))));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8000))]
    #[test]
    fn boxes_lie_where_they_are_told_to(
        [normal, from, across, size] in prop::array::uniform4(vector()), far in power(-20..40),
        scales in (power(-50..1), power(-50..20)),
        err in error(), at in signs(), gap in prop_oneof![Just(0.0), power(-60..5)],
    ) {
        let approx = Approx3::known(normal, err);
        let normal_at = corner(normal, DVec3::splat(err), at);
        // A corner of the box close to the plane: `across` is nearly in it.
        let across = across - normal * (normal.dot(across) / normal.dot(normal));
        let size = size.abs() * scales.0;
        // The corner that is lowest along the normal.
        let lowest = DVec3::from([0, 1, 2].map(|k| if normal[k] < 0.0 { -size[k] } else { 0.0 }));
        let from = from * far;
        let low = from + across * scales.1 + lowest + normal * gap;
        let high = low + size;
        if let Some(told) = SeenBox::new(from, low, high).side(&approx) {
            for k in 0..8 {
                let p = DVec3::from([0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] }));
                let height = dot(&normal_at, &sub(&exact3(p), &exact3(from)));
                prop_assert_eq!(sign(&height), told, "{}", k);
            }
        }
    }

    #[test]
    fn the_filter_of_orient3d_is_silent_or_right_if_one_edge_is_much_longer(
        c in vector(), [s, t] in prop::array::uniform2(0.5..2.0f64), steep in prop::array::uniform2(power(-12..1)),
        (long, short) in prop_oneof![(Just(1.0), power(-40..-5)), (Just(2f64.powi(660)), power(-540..-525))],
        off in prop_oneof![3 => power(-60..-49), 1 => power(-49..-5)], noise in vector(), turn in 0..3usize, swap: bool,
    ) {
        let mut along = [1.0, steep[0], -steep[1]];
        along.rotate_left(turn);
        let along = DVec3::from(along);
        // Nearly in one plane with the long edge; products of short ones may underflow.
        let d = (c * s + along * t + noise * off) * short;
        let (c, d) = if swap { (d, c * short) } else { (c * short, d) };
        let far = along * long;
        let told = orient3d_filter(DVec3::ZERO, far, c, d);
        let exactly = sign(&dot(&exact3(far), &cross(&exact3(c), &exact3(d))));
        prop_assert!(told.is_none_or(|told| told == exactly));
    }
}

proptest! {
    /// The first edge runs along an axis, so that one row of the determinant counts; the others are nearly parallel seen along it, and as
    /// short as one likes. Which way they turn depends on what rounding does to the differences from the first point.
    #[test]
    fn the_filter_of_orient3d_is_silent_or_right_if_differences_are_rounded(
        a in vector(), axis in 0..3usize, ahead in vector(), scale in power(-60..60), long in power(-30..30),
        [s, t] in prop::array::uniform2(3.0..40.0f64),
    ) {
        let mut b = a;
        b[axis] += long;
        let [c, d] = [s, t].map(|times| a + ahead * times);
        let [a, b, c, d] = [a, b, c, d].map(|p| p * scale);
        let told = orient3d_filter(a, b, c, d);
        let [p, q, r] = [b, c, d].map(|p| sub(&exact3(p), &exact3(a)));
        let exactly = sign(&dot(&p, &cross(&q, &r)));
        prop_assert!(told.is_none_or(|told| told == exactly));
    }
}

#[test]
fn a_box_far_off_is_on_a_side_only_if_the_error_of_the_normal_leaves_it_there() {
    for err in [1e-12, 1e-6, 1e-3] {
        for far in [1e-3, 1.0, 1e2, 1e6] {
            // A point about half as high as the error of the normal reaches there.
            let p = DVec3::new(0.5 * err * far, far, 0.0);
            let told = SeenBox::new(DVec3::ZERO, p, p).side(&Approx3::known(DVec3::X, err));
            assert_eq!(told, None, "{err} {far}");
            let p = DVec3::new(100.0 * err * far, far, 0.0);
            let told = SeenBox::new(DVec3::ZERO, p, p).side(&Approx3::known(DVec3::X, err));
            assert_eq!(told, Some(Sign::Positive), "{err} {far}");
        }
    }
}

#[test]
fn a_difference_rounded_by_half_a_unit_is_within_its_bound() {
    // 1 + u, exactly in the middle between two numbers.
    let direction = Approx3::direction(DVec3::new(-U, 0.0, 0.0), DVec3::X, 0.0);
    assert!(exact(direction.slack) >= exact(8.0 * U) + exact(32.0 * U), "{direction:?}");
    // The error given and that of the difference are both at their most, and their sum is rounded down.
    let err = U * (1.0 + 3.0 * U);
    let direction = Approx3::direction(DVec3::new(-U, 0.0, 0.0), DVec3::X, err);
    assert!(exact(direction.slack) >= (exact(err) + exact(U)) * exact(8.0) + exact(32.0 * U), "{direction:?}");
}

#[test]
fn products_that_underflow_have_an_error() {
    let size = 2f64.powi(-510);
    let (a, b) = (DVec3::new(1.3, 0.7, -0.2) * size, DVec3::new(-0.6, 1.1, 0.9) * size);
    let normal = Approx3::edge_normal(DVec3::ZERO, a, b);
    assert!(normal.slack.is_finite() && holds(&normal, &cross(&exact3(a), &exact3(b))), "{normal:?}");
    assert!(normal.error_bound() >= 9.0 * U && normal.error_bound() < 1e-12, "{normal:?}");
}

#[test]
fn nothing_divided_by_what_is_hardly_known_is_nothing() {
    for dividend in [0.0, f64::from_bits(1), f64::MIN_POSITIVE] {
        let quotient = Ball::exact(dividend).div(Ball::new(1.0, 0.9));
        assert!(quotient.rad >= 0.0 && quotient.mid + quotient.rad >= dividend * 9.9, "{quotient:?}");
    }
}

#[test]
fn ends_that_are_not_exact_give_points_that_are_not() {
    let end = |x: f64, err: f64| ApproxPoint { position: DVec3::new(1.0, x, 0.0), err: DVec3::X * err };
    for errors in [[0.25, 0.0], [0.0, 0.25]] {
        let [from, to] = [end(-1.0, errors[0]), end(1.0, errors[1])];
        let point = ApproxPoint::between(from, to, Ball::exact(-1.0), Ball::exact(1.0));
        // Half way: half of the error, at least.
        assert!(point.err.x >= 0.125 && point.err.z == 0.0, "{point:?}");
    }
}

#[test]
fn rounded_heights_are_in_scene_units() {
    let p = DVec3::new(3.0, 4.0, 5.0);
    let level = ApproxPlane::new(&Plane::Axis { axis: 1, value: 1.5 });
    assert!((level.rounded_height(p) - 2.5).abs() < 1e-15);
    // Of x + y + z = 30, over a triangle of any size.
    let tilted = Plane::Points([DVec3::X * 30.0, DVec3::Y * 30.0, DVec3::Z * 30.0]);
    let height = ApproxPlane::new(&tilted).rounded_height(p);
    assert!((height + 18.0 / 3f64.sqrt()).abs() < 1e-14, "{height}");
    // A normal that overflows is unknown.
    let far = 2f64.powi(1000);
    let unknown = Plane::Points([DVec3::X * far, DVec3::Y * far, DVec3::Z * far]);
    assert!(ApproxPlane::new(&unknown).rounded_height(p) == 0.0);
}

/// The largest number of so many digits, or one less than it by `less`.
fn full(arena: &mut Arena, digits: u32, less: i128) -> Num {
    let (power, less) = (arena.shifted(1, digits * fixed::DIGIT, false), arena.integer(1 + less));
    arena.sub(power, less)
}

fn equal(arena: &mut Arena, v: Num3, w: Num3) -> bool {
    arena.sub3(v, w).into_iter().all(|x| x.sign().is_zero())
}

#[test]
fn vectors_of_all_widths_are_kept_as_they_are_and_decided_in_fixed_widths() {
    for width in 1..=fixed::MOST_DIGITS as u32 + 2 {
        let mut arena = Arena::default();
        let (large, less, small) = (full(&mut arena, width, 0), full(&mut arena, width, 7), arena.integer(-3));
        let (v, w) = ([large, small, less.negated()], [less, large, small]);
        let kept: [_; 2] = [v, w].map(|vector| {
            let mark = arena.mark();
            let one = arena.integer(1);
            let copy = arena.scale3(one, vector);
            arena.keep3(mark, copy)
        });
        for (kept, vector) in kept.iter().zip([v, w]) {
            let back = arena.numbers(kept);
            assert!(equal(&mut arena, back, vector), "{width} digits");
            let rounded = arena.kept_rounded(kept);
            assert!(rounded.error_bound() <= 10.0 * U && rounded.v.abs().max_element() >= 1.0, "{width} digits");
        }
        let before = arena.arbitrary_signs();
        // v . w = x (x - 7) - 3 x + 3 (x - 7) > 0 for x = 2^(60 width) - 1.
        assert_eq!(arena.kept_dot_sign(&kept[0], &kept[1]), Sign::Positive, "{width} digits");
        assert_eq!(arena.kept_parallel(&kept[0], &kept[1]), Sign::Zero, "{width} digits");
        assert_eq!(arena.kept_parallel(&kept[0], &kept[0]), Sign::Positive, "{width} digits");
        assert_eq!(arena.kept_det_sign(&kept[0], &kept[1], &kept[0]), Sign::Zero, "{width} digits");
        let decisions = if width > fixed::MOST_DIGITS as u32 { 4 } else { 0 };
        assert_eq!(arena.arbitrary_signs() - before, decisions, "{width} digits");

        let approx = arena.kept_cross(&kept[0], &kept[1]);
        assert!(approx.error_bound() <= 10.0 * U, "{width} digits: {approx:?}");
        let exactly = arena.cross(v, w);
        let exactly = Approx3::rounded(&arena, exactly);
        let off = (approx.v - exactly.v).abs().max_element();
        assert!(off <= approx.error_bound() + exactly.error_bound(), "{width} digits: {approx:?}");
    }
}

#[test]
fn vectors_alike_in_one_or_two_components_of_their_cross_product_are_not_parallel() {
    for digits in [1, 3, 4, 7, 10, 13] {
        for (one, other) in [([1, 2, 3], [2, 4, 5]), ([1, 2, 0], [3, 1, 0]), ([1, 2, 0], [2, 4, 1])] {
            for turn in 0..3 {
                let mut arena = Arena::default();
                let unit = arena.shifted(1, (digits - 1) * fixed::DIGIT, false);
                let [mut v, mut w] = [one, other].map(|v| v.map(|x: i128| arena.integer(x)));
                v = arena.scale3(unit, v);
                v.rotate_left(turn);
                w.rotate_left(turn);
                assert_eq!(arena.parallel(v, w), Sign::Zero, "{digits} digits");
                let [kept_v, kept_w] = [v, w].map(|vector| {
                    let (mark, one) = (arena.mark(), arena.integer(1));
                    let copy = arena.scale3(one, vector);
                    arena.keep3(mark, copy)
                });
                assert_eq!(arena.kept_parallel(&kept_v, &kept_w), Sign::Zero, "{digits} digits");
            }
        }
    }
}

#[test]
fn a_position_at_0_has_an_error_that_is_not_negative() {
    let frame = Frame::new(BitRange::of([DVec3::ONE]), DVec3::ONE);
    let mut arena = Arena::default();
    let (x, w) = (frame.relative(&mut arena, DVec3::ZERO), arena.integer(1));
    let (position, err) = frame.position(&mut arena, x, w);
    assert!(position == DVec3::ZERO && err.cmpge(DVec3::ZERO).all(), "{position} {err}");
}

#[test]
fn digits_are_kept_as_they_are() {
    fn check<const W: usize>() {
        let top = (1i64 << fixed::DIGIT) - 1;
        let mut arena = Arena::default();
        let kept = arena.keep_digits(&[[top; W], [-top; W], [1; W]]);
        let large = full(&mut arena, W as u32, 0);
        let back = arena.numbers(&kept);
        assert!(
            equal(&mut arena, [back[0], back[1], back[1]], [large, large.negated(), large.negated()]),
            "{W} digits"
        );
        let last = arena.shifted(1, (W as u32 - 1) * fixed::DIGIT, false);
        let rest = arena.sub(back[2], last);
        assert!(W == 1 && rest.sign().is_zero() || rest.sign().is_positive(), "{W} digits");
    }
    check::<1>();
    check::<3>();
    check::<6>();
}

#[test]
fn a_cleared_arena_holds_nothing() {
    let mut arena = Arena::default();
    let three = arena.integer(3);
    let square = arena.mul(three, three);
    let nine = arena.integer(9);
    assert!(arena.sub(square, nine).sign().is_zero());
    let first = arena.keep_digits(&[[1i64], [2], [3]]);
    arena.keep_digits(&[[4i64], [5], [6]]);
    arena.clear();
    assert_eq!(arena.mark(), 0);
    let again = arena.keep_digits(&[[7i64], [8], [9]]);
    assert_eq!(format!("{first:?}"), format!("{again:?}"), "the place of the first one");
}

#[test]
fn directions_are_scaled_and_quotients_reach_all_exponents() {
    let mut arena = Arena::default();
    for shift in [0, 1, 63, 64, 700, 1023, 1100, 2000, 3000] {
        let (long, one) = (arena.shifted(5 << 50, shift, true), arena.integer(1));
        let direction = arena.direction([one, long, Num::ZERO]);
        // 5/8 is 0.5 to 1; the other one is 2^-(shift + 52) times 1/2 of its power, or too small.
        assert_eq!(direction.with_x(0.0), DVec3::new(0.0, -0.625, 0.0), "{shift}: {direction}");
        assert!((0.0..=2f64.powi(-(shift as i32).min(1000) - 52)).contains(&direction.x), "{shift}: {direction}");
    }
    let (five, four) = (arena.integer(5), arena.integer(-4));
    for exponent in [-1074, -1073, -1000, -513, -512, -1, 0, 1, 511, 600, 1022, 1023] {
        let quotient = arena.quotient(five, four, exponent);
        // In two exact steps; denormal results are rounded once.
        let half = exponent / 2;
        let expected = -1.25 * 2f64.powi(half) * 2f64.powi(exponent - half);
        assert!(quotient.total_cmp(&expected).is_eq(), "{exponent}: {quotient}");
    }
}

/// Inequalities of the proofs in docs/numerics.md, with what rounding takes.
mod proofs {
    use super::*;

    fn error_of(approx: &Approx3) -> Rational {
        (exact(approx.slack) - exact(32.0 * U)) / exact(8.0)
    }

    proptest! {
        #[test]
        fn the_bound_on_an_edge_normal_is_what_its_proof_asks_for(
            [eye, a, b] in prop::array::uniform3(vector()), near in power(-20..1), size in power(-400..400),
        ) {
            let [eye, a, b] = [eye, a, a + b * near].map(|p| p * size);
            let normal = Approx3::edge_normal(eye, a, b);
            prop_assume!(normal.slack.is_finite());
            let scale = scale(&normal, &cross(&sub(&exact3(a), &exact3(eye)), &sub(&exact3(b), &exact3(eye))));
            let largest = |p: DVec3, q: DVec3| sub(&exact3(q), &exact3(p)).map(|x| x.abs()).into_iter().max().unwrap();
            let unit = largest(eye, a) * largest(a, b) * exact(U) * scale;
            prop_assert!(error_of(&normal) >= &unit * exact(8.03), "{normal:?}");
            prop_assert!(error_of(&normal) <= &unit * exact(9.1) + exact(1e-30), "{normal:?}");
        }

        #[test]
        fn the_bound_on_a_cross_product_is_what_its_proof_asks_for(
            v in vector(), w in vector(), e in error(), f in error(),
        ) {
            let (p, q) = (Approx3::known(v, e), Approx3::known(w, f));
            let product = p.cross(q);
            prop_assume!(product.slack.is_finite());
            let scale = scale(&product, &cross(&exact3(v), &exact3(w)));
            let errors = exact(e) + exact(f);
            let needed = &errors * exact(4.13) + exact(16.01 * U);
            prop_assert!(error_of(&product) >= &needed * &scale, "{product:?}");
            prop_assert!(error_of(&product) <= (&errors * exact(4.51) + exact(60.0 * U)) * &scale, "{product:?}");
            // The same for vectors not known to be parallel.
            let largest = v.cross(w).abs().max_element();
            if p.not_parallel(&q) {
                prop_assert!(exact(largest) >= needed);
            } else {
                prop_assert!(exact(largest) <= &errors * exact(4.51) + exact(60.0 * U));
            }
        }
    }
}
