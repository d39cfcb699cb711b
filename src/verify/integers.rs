//! The last stage of the ray oracle: arbitrary precision.
//!
//! Every finite `f64` is an integer times a power of two. The points of one question are put on
//! the finest grid that any of their coordinates needs; a common scale changes neither the sign of
//! a determinant nor the order of two depths, so the rest is arithmetic of integers.

use crate::exact::Sign;
use glam::DVec3;
use num_bigint::BigInt;
use std::cmp::Ordering;

type Vector = [BigInt; 3];

/// The sign of det[p - e, q - e, d].
pub(super) fn edge_sign(p: DVec3, q: DVec3, eye: DVec3, direction: DVec3) -> Sign {
    let [p, q, eye] = on_grid([p, q, eye]);
    let [direction] = on_grid([direction]);
    sign(&determinant(&minus(&p, &eye), &minus(&q, &eye), &direction))
}

/// The sign of (b - a) x (c - a) . (p - a).
pub(super) fn height_sign(plane: [DVec3; 3], point: DVec3) -> Sign {
    let [a, b, c, point] = on_grid([plane[0], plane[1], plane[2], point]);
    sign(&determinant(&minus(&b, &a), &minus(&c, &a), &minus(&point, &a)))
}

/// True if three points lie on one line.
pub(super) fn are_collinear([a, b, c]: [DVec3; 3]) -> bool {
    let [a, b, c] = on_grid([a, b, c]);
    let normal = cross(&minus(&b, &a), &minus(&c, &a));
    normal.iter().all(|x| sign(x).is_zero())
}

/// True if the planes through two triples of points, neither collinear, are one.
pub(super) fn is_same_plane(plane: [DVec3; 3], other: [DVec3; 3]) -> bool {
    other.iter().all(|&point| height_sign(plane, point).is_zero())
}

/// Which of two planes a ray meets first. It meets both, in front of the eye.
pub(super) fn compare_depth(planes: [[DVec3; 3]; 2], eye: DVec3, direction: DVec3) -> Ordering {
    let [[a, b, c], [f, g, h]] = planes;
    let [a, b, c, f, g, h, eye] = on_grid([a, b, c, f, g, h, eye]);
    let [direction] = on_grid([direction]);
    let fraction = |[a, b, c]: [&Vector; 3]| {
        let normal = cross(&minus(b, a), &minus(c, a));
        [dot(&normal, &minus(&eye, a)), dot(&normal, &direction)].map(|x| BigInt::from(x.magnitude().clone()))
    };
    // t = -h / (N . d) is positive for both, so it is the quotient of the magnitudes.
    let ([height, rate], [other_height, other_rate]) = (fraction([&a, &b, &c]), fraction([&f, &g, &h]));
    (height * other_rate).cmp(&(other_height * rate))
}

/// The vectors times the power of two that just makes all components integers.
fn on_grid<const N: usize>(vectors: [DVec3; N]) -> [Vector; N] {
    let parts = vectors.map(|v| v.to_array().map(integer_and_exponent));
    let finest = parts.iter().flatten().filter(|part| part.0 != 0).map(|part| part.1).min().unwrap_or(0);
    parts.map(|part| {
        part.map(
            |(integer, exponent)| {
                if integer == 0 { BigInt::ZERO } else { BigInt::from(integer) << (exponent - finest) }
            },
        )
    })
}

/// An odd integer and the exponent of two that make a finite number; integer 0 for zero.
fn integer_and_exponent(value: f64) -> (i64, i64) {
    let bits = value.to_bits();
    let biased = (bits >> 52 & 0x7ff) as i64;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    let odd = mantissa >> zeros;
    (if value < 0.0 { -odd } else { odd }, exponent + i64::from(zeros))
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| &a[k] - &b[k])
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

fn dot(a: &Vector, b: &Vector) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn determinant(a: &Vector, b: &Vector, c: &Vector) -> BigInt {
    dot(&cross(a, b), c)
}

fn sign(x: &BigInt) -> Sign {
    Sign::from(x.cmp(&BigInt::ZERO))
}
