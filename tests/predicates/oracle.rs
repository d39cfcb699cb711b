//! The definitions of `nusselt::exact`, computed a second way: in homogeneous coordinates of the
//! scene, not relative to the eye, with numbers that are exact by themselves.
//!
//! The code is generic over the numbers. With [`BigRational`] it is the reference; with [`BigInt`] on a
//! grid that holds all coordinates it gives the same signs some twenty times faster, and is itself
//! compared with the reference.

use glam::DVec3;
use num_bigint::{BigInt, Sign as BigSign};
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use nusselt::exact::{Along, CircleRelation, Direction, Plane, Point, Sign, Splitter};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// Numbers with exact arithmetic.
pub(crate) trait Exact:
    Clone + Zero + Signed + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// A coordinate, in units of `2^unit` where the type has no fractions.
    fn coordinate(x: f64, unit: i32) -> Self;
    /// The number 1 of homogeneous coordinates.
    fn unity() -> Self;
}

impl Exact for BigRational {
    fn coordinate(x: f64, _: i32) -> Self {
        Self::from_float(x).expect("a finite coordinate")
    }

    fn unity() -> Self {
        Self::from_integer(1.into())
    }
}

impl Exact for BigInt {
    fn coordinate(x: f64, unit: i32) -> Self {
        let (mantissa, exponent) = mantissa_and_exponent(x);
        assert!(mantissa == 0 || exponent >= unit, "{x} lies on the grid of 2^{unit}");
        Self::from(mantissa) << (exponent - unit).max(0)
    }

    fn unity() -> Self {
        Self::from(1)
    }
}

/// `x = m 2^e` with `m` odd, or 0.
fn mantissa_and_exponent(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let biased = (bits >> 52 & 0x7ff) as i32;
    let (m, e) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    if m == 0 {
        return (0, 0);
    }
    let zeros = m.trailing_zeros();
    (if x < 0.0 { -(m >> zeros) } else { m >> zeros }, e + zeros as i32)
}

/// The exponent of the finest bit among the coordinates.
pub(crate) fn unit_of(coordinates: impl IntoIterator<Item = DVec3>) -> i32 {
    let exponents = coordinates.into_iter().flat_map(|p| p.to_array()).filter(|x| *x != 0.0);
    exponents.map(|x| mantissa_and_exponent(x).1).min().unwrap_or(0)
}

pub(crate) fn sign<T: Exact>(x: &T) -> Sign {
    if x.is_zero() {
        Sign::Zero
    } else if x.is_negative() {
        Sign::Negative
    } else {
        Sign::Positive
    }
}

/// `log2 |x|` to a few digits; minus infinity for 0.
pub(crate) fn log2(x: &BigInt) -> f64 {
    let (sign, digits) = x.to_u64_digits();
    if sign == BigSign::NoSign {
        return f64::NEG_INFINITY;
    }
    let top: f64 = digits.iter().rev().take(2).fold(0.0, |sum, &d| sum * 2f64.powi(64) + d as f64);
    top.log2() + 64.0 * digits.len().saturating_sub(2) as f64
}

type V3<T> = [T; 3];
type V4<T> = [T; 4];

pub(crate) fn cross<T: Exact>(a: &V3<T>, b: &V3<T>) -> V3<T> {
    let minor = |i: usize, j: usize| a[i].clone() * b[j].clone() - a[j].clone() * b[i].clone();
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

pub(crate) fn dot<T: Exact, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    (0..N).fold(T::zero(), |sum, k| sum + a[k].clone() * b[k].clone())
}

/// The 4-vector `t` with `t . x = det[a, b, c, x]`.
fn join<T: Exact>(a: &V4<T>, b: &V4<T>, c: &V4<T>) -> V4<T> {
    let minor = |i: usize, j: usize, k: usize| {
        let row = |v: &V4<T>| [v[i].clone(), v[j].clone(), v[k].clone()];
        dot(&row(a), &cross(&row(b), &row(c)))
    };
    [-minor(1, 2, 3), minor(0, 2, 3), -minor(0, 1, 3), minor(0, 1, 2)]
}

/// A linear combination `s a - t b`.
fn combine<T: Exact, const N: usize>(s: &T, a: &[T; N], t: &T, b: &[T; N]) -> [T; N] {
    std::array::from_fn(|k| s.clone() * a[k].clone() - t.clone() * b[k].clone())
}

fn normal_part<T: Exact>(plane: V4<T>) -> V3<T> {
    let [x, y, z, _] = plane;
    [x, y, z]
}

/// The definitions seen from one eye. Functions give `None` where a precondition of the definition does
/// not hold.
pub(crate) struct Oracle<T> {
    eye: V4<T>,
    unit: i32,
}

impl<T: Exact> Oracle<T> {
    /// All coordinates it is asked about must be multiples of `2^unit`.
    pub(crate) fn new(eye: DVec3, unit: i32) -> Self {
        let mut oracle = Self { eye: [T::zero(), T::zero(), T::zero(), T::unity()], unit };
        oracle.eye = oracle.given(eye);
        oracle
    }

    fn given(&self, p: DVec3) -> V4<T> {
        let [x, y, z] = p.to_array().map(|x| T::coordinate(x, self.unit));
        [x, y, z, T::unity()]
    }

    fn vector(v: DVec3) -> Option<V3<T>> {
        let unit = unit_of([v]);
        Some(v.to_array().map(|x| T::coordinate(x, unit))).filter(|v| v.iter().any(|x| !x.is_zero()))
    }

    /// The plane as a 4-vector: positive on points in front.
    pub(crate) fn plane(&self, plane: &Plane) -> Option<V4<T>> {
        let made = match *plane {
            Plane::Axis { axis, value } => {
                let mut made = [T::zero(), T::zero(), T::zero(), -T::coordinate(value, self.unit)];
                made[axis] = T::unity();
                made
            }
            Plane::Points(points) => {
                let [a, b, c] = points.map(|p| self.given(p));
                // det[a, b, c, x] in homogeneous coordinates is -(b - a) x (c - a) . (x - a).
                join(&a, &b, &c).map(|x| -x)
            }
        };
        made[..3].iter().any(|x| !x.is_zero()).then_some(made)
    }

    /// The point with a positive weight.
    pub(crate) fn point(&self, point: &Point) -> Option<V4<T>> {
        match point {
            Point::Given(p) => Some(self.given(*p)),
            Point::EdgePlane(ends, plane) => {
                let plane = self.plane(plane)?;
                let [a, b] = ends.map(|p| self.given(p));
                let (at_a, at_b) = (dot(&plane, &a), dot(&plane, &b));
                let crossing = combine(&at_b, &a, &at_a, &b);
                match (sign(&at_a), sign(&at_b)) {
                    (Sign::Negative, Sign::Positive) => Some(crossing),
                    (Sign::Positive, Sign::Negative) => Some(crossing.map(|x| -x)),
                    _ => None,
                }
            }
            Point::Planes([p, q, r]) => {
                let meet = join(&self.plane(p)?, &self.plane(q)?, &self.plane(r)?);
                match sign(&meet[3]) {
                    Sign::Zero => None,
                    Sign::Positive => Some(meet),
                    Sign::Negative => Some(meet.map(|x| -x)),
                }
            }
        }
    }

    /// The normal of a splitter.
    pub(crate) fn splitter(&self, splitter: &Splitter) -> Option<V3<T>> {
        let normal = match splitter {
            Splitter::Edge(ends) => {
                let [a, b] = ends.map(|p| self.given(p));
                normal_part(join(&self.eye, &a, &b).map(|x| -x))
            }
            Splitter::Crease([p, q]) => {
                // Of the planes through the line where the two meet, the one that holds the eye.
                let (p, q) = (self.plane(p)?, self.plane(q)?);
                let (at_p, at_q) = (dot(&p, &self.eye), dot(&q, &self.eye));
                normal_part(combine(&at_q, &p, &at_p, &q))
            }
            Splitter::Given(normal) => Self::vector(*normal)?,
            Splitter::Parallel(plane) => normal_part(self.plane(plane)?),
        };
        normal.iter().any(|x| !x.is_zero()).then_some(normal)
    }

    /// A direction.
    pub(crate) fn direction(&self, direction: &Direction) -> Option<V3<T>> {
        let made = match direction {
            Direction::Given(d) => Self::vector(*d)?,
            Direction::Point(point) => {
                let x = self.point(point)?;
                normal_part(combine(&T::unity(), &x, &x[3], &self.eye))
            }
            Direction::Crossing([m, n]) => cross(&self.splitter(m)?, &self.splitter(n)?),
        };
        made.iter().any(|x| !x.is_zero()).then_some(made)
    }

    pub(crate) fn side(&self, direction: &Direction, splitter: &Splitter) -> Option<Sign> {
        Some(sign(&self.side_value(direction, splitter)?))
    }

    pub(crate) fn side_value(&self, direction: &Direction, splitter: &Splitter) -> Option<T> {
        Some(dot(&self.direction(direction)?, &self.splitter(splitter)?))
    }

    pub(crate) fn orientation_value(&self, splitters: [&Splitter; 3]) -> Option<T> {
        let [a, b, c] = splitters;
        Some(dot(&cross(&self.splitter(a)?, &self.splitter(b)?), &self.splitter(c)?))
    }

    pub(crate) fn compare_circles(&self, a: &Splitter, b: &Splitter) -> Option<CircleRelation> {
        let (m, n) = (self.splitter(a)?, self.splitter(b)?);
        if cross(&m, &n).iter().any(|x| !x.is_zero()) {
            return Some(CircleRelation::Different);
        }
        Some(if dot(&m, &n).is_positive() { CircleRelation::Same } else { CircleRelation::Opposite })
    }

    /// `None` also if a direction is not on the circle.
    pub(crate) fn order_along(&self, circle: &Splitter, from: &Direction, other: &Direction) -> Option<Along> {
        let (n, p, q) = (self.splitter(circle)?, self.direction(from)?, self.direction(other)?);
        if !dot(&n, &p).is_zero() || !dot(&n, &q).is_zero() {
            return None;
        }
        Some(match sign(&dot(&n, &cross(&p, &q))) {
            Sign::Positive => Along::Ahead,
            Sign::Negative => Along::Behind,
            Sign::Zero if dot(&p, &q).is_positive() => Along::Same,
            Sign::Zero => Along::Opposite,
        })
    }

    pub(crate) fn plane_side(&self, point: &Point, plane: &Plane) -> Option<Sign> {
        Some(sign(&dot(&self.plane(plane)?, &self.point(point)?)))
    }

    /// The order of the two depths along the ray, `None` if the eye is in a plane or the ray misses one.
    pub(crate) fn depth_order(&self, planes: [&Plane; 2], direction: &Direction) -> Option<Ordering> {
        let d = self.direction(direction)?;
        let depth = |plane: &Plane| {
            let plane = self.plane(plane)?;
            let (height, rate) = (dot(&plane, &self.eye), -dot(&normal_part(plane), &d));
            // height / rate > 0, as a fraction of positive numbers.
            (sign(&height) * sign(&rate) == Sign::Positive).then(|| (height.abs(), rate.abs()))
        };
        let ((h1, r1), (h2, r2)) = (depth(planes[0])?, depth(planes[1])?);
        let difference = h1 * r2 - h2 * r1;
        Some(match sign(&difference) {
            Sign::Negative => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Positive => Ordering::Greater,
        })
    }

    pub(crate) fn orient3d_value(&self, [a, b, c, d]: [DVec3; 4]) -> T {
        let [a, b, c, d] = [a, b, c, d].map(|p| self.given(p));
        -dot(&join(&a, &b, &c), &d)
    }
}
