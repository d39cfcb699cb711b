//! On which side of the plane through three points a fourth lies.

use super::Sign;
use super::approx::{U, decided};
use super::arena::Arena;
use super::fixed;
use super::frame::{BitRange, Frame};
use glam::DVec3;
use robust::Coord3D;

/// The sign of `(b - a) x (c - a) . (d - a)`: positive when `d` lies on the side from which
/// `a`, `b`, `c` run counter-clockwise, zero exactly on their plane. Right for all finite points.
///
/// A filter of three products decides most calls; [`robust::orient3d`] most others; coordinates
/// outside of the exponents where that is valid, and those only, go to integers: of 128 bits where all
/// lie within 125 bits of each other.
///
/// ```
/// use nusselt::exact::{Sign, orient3d};
/// use glam::DVec3;
/// let above = orient3d(DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.2, 0.2, 1e-300));
/// assert_eq!(above, Sign::Positive);
/// ```
pub fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
    orient3d_filter(a, b, c, d).or_else(|| orient3d_expansions(a, b, c, d)).unwrap_or_else(|| {
        let frame = Frame::new(BitRange::of([a, b, c, d]), a);
        orient3d_integers(&frame, &mut Arena::default(), b, c, d)
    })
}

/// With expansions, where all coordinates have exponents at which they are exact.
pub(crate) fn orient3d_expansions(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<Sign> {
    let coord = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    // `robust` has the opposite orientation.
    let exact = || -Sign::of(robust::orient3d(coord(a), coord(b), coord(c), coord(d)));
    [a, b, c, d].into_iter().all(robust_is_valid).then(exact)
}

/// Differences are off by `u` relatively; a product of three of them by `(1 + u)^5 - 1`, the
/// difference of two products and the sum of three such terms by `3 u` more: `8.1 u` of the sum of
/// the absolute values of all six products in all.
pub(crate) fn orient3d_filter(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<Sign> {
    let (p, q, r) = (b - a, c - a, d - a);
    let (qr_x, rq_x) = (q.y * r.z, q.z * r.y);
    let (qr_y, rq_y) = (q.z * r.x, q.x * r.z);
    let (qr_z, rq_z) = (q.x * r.y, q.y * r.x);
    let det = p.x * (qr_x - rq_x) + p.y * (qr_y - rq_y) + p.z * (qr_z - rq_z);
    let permanent = p.x.abs() * (qr_x.abs() + rq_x.abs())
        + p.y.abs() * (qr_y.abs() + rq_y.abs())
        + p.z.abs() * (qr_z.abs() + rq_z.abs());
    // An underflow loses at most 2^-1074 times a difference below 2^400, so less than u times a
    // permanent above 2^-600; beyond those limits nothing is claimed.
    if !(1e-180..1e120).contains(&permanent) || p.abs().max_element() > 1e120 {
        return None;
    }
    decided(det, 10.0 * U * permanent)
}

/// `robust` works with differences and products of three of them: with coordinates that are
/// multiples of `2^-302` below `2^250` no product underflows or overflows.
fn robust_is_valid(p: DVec3) -> bool {
    const LEAST: f64 = f64::from_bits((1023 - 250) << 52);
    const MOST: f64 = f64::from_bits((1023 + 250) << 52);
    p.to_array().into_iter().all(|x| x == 0.0 || (LEAST..MOST).contains(&x.abs()))
}

/// With integers on a grid whose origin is the first point.
fn orient3d_integers(frame: &Frame, arena: &mut Arena, b: DVec3, c: DVec3, d: DVec3) -> Sign {
    if let [Some(p), Some(q), Some(r)] = [b, c, d].map(|point| frame.narrow_relative(point)) {
        let [p, q, r] = [p, q, r].map(|v| v.map(fixed::of_i128));
        return fixed::det_sign::<3, 6, 8>(&p, &q, &r);
    }
    let [p, q, r] = [b, c, d].map(|point| frame.relative(arena, point));
    arena.det_sign(p, q, r)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn by_integers(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
        orient3d_integers(&Frame::new(BitRange::of([a, b, c, d]), a), &mut Arena::default(), b, c, d)
    }

    #[test]
    fn small_and_large_tetrahedra_have_their_sign() {
        for exponent in [-1000, -400, -300, 0, 300, 400, 1000] {
            let s = 2f64.powi(exponent);
            let [a, b, c, d] = [DVec3::ZERO, DVec3::X * s, DVec3::Y * s, DVec3::Z * s];
            assert_eq!(orient3d(a, b, c, d), Sign::Positive, "2^{exponent}");
            assert_eq!(orient3d(a, c, b, d), Sign::Negative, "2^{exponent}");
            assert_eq!(orient3d(a, b, c, (b + c) / 2.0), Sign::Zero, "2^{exponent}");
        }
    }

    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![
            any::<i8>().prop_map(f64::from),
            (any::<i8>(), -1070i32..900).prop_map(|(m, e)| f64::from(m) * 2f64.powi(e)),
            -1.0..1.0f64,
        ]
    }

    fn point() -> impl Strategy<Value = DVec3> {
        (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn all_stages_agree(a in point(), b in point(), c in point(), d in point(), on in 0..4) {
            // Points on an edge of the triangle are exact zeros where halving is exact.
            let d = if on == 0 { (b - c) * 0.5 + c } else { d };
            prop_assert_eq!(orient3d(a, b, c, d), by_integers(a, b, c, d));
            prop_assert_eq!(orient3d(b, a, c, d), -by_integers(a, b, c, d));
        }

        #[test]
        fn the_filter_is_silent_or_right_where_it_is_close(
            a in prop::array::uniform3(-1.0..1.0f64), b in prop::array::uniform3(-1.0..1.0f64),
            c in prop::array::uniform3(-1.0..1.0f64), s in -2.0..2.0f64, t in -2.0..2.0f64,
            scales in prop::array::uniform3(-60i32..60), ulps in -3i32..4,
        ) {
            let scale = DVec3::from(scales.map(|e| 2f64.powi(e)));
            let [a, b, c] = [a, b, c].map(DVec3::from);
            // Next to the plane, but for rounding and a few ulps; each axis in a scale of its own.
            let mut d = a + s * (b - a) + t * (c - a);
            d.y += f64::from(ulps) * f64::EPSILON;
            let [a, b, c, d] = [a, b, c, d].map(|p| p * scale);
            let exact = by_integers(a, b, c, d);
            prop_assert!(orient3d_filter(a, b, c, d).is_none_or(|sign| sign == exact));
            prop_assert_eq!(orient3d(a, b, c, d), exact);
        }
    }

    #[test]
    fn the_filter_decides_what_is_not_close() {
        for scale in [1e-50, 1.0, 1e30] {
            let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * scale;
            for (a, b, c) in [
                (p(1.0, 0.0, 0.1), p(0.0, 1.0, 0.1), p(-1.0, -1.0, 0.1)),
                (p(0.1, 1.0, 0.0), p(0.1, 0.0, 1.0), p(0.1, -1.0, -1.0)),
                (p(0.0, 0.1, 1.0), p(1.0, 0.1, 0.0), p(-1.0, 0.1, -1.0)),
            ] {
                let above = (a + b + c) / 3.0 + p(0.01, 0.01, 0.01);
                assert_eq!(orient3d_filter(a, b, c, above), Some(Sign::Positive), "{a} {b} {c}");
                assert_eq!(orient3d_filter(b, a, c, above), Some(Sign::Negative), "{a} {b} {c}");
            }
        }
    }
}
