//! Vectors, planes and normals in rational numbers, as their definitions say.

use crate::exact::{Plane, Sign, Splitter};
use glam::DVec3;
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::Zero;

pub(super) type Vector<T> = [T; 3];

/// `N . p >= c` in front.
pub(super) struct RationalPlane {
    pub(super) normal: Vector<BigRational>,
    pub(super) offset: BigRational,
}

impl RationalPlane {
    pub(super) fn new(plane: &Plane) -> Self {
        match plane {
            Plane::Axis { axis, value } => {
                let mut normal = [(); 3].map(|()| BigRational::zero());
                normal[*axis] = BigRational::from_integer(1.into());
                Self { normal, offset: rational(*value) }
            }
            Plane::Points(points) => {
                let [a, b, c] = points.map(exact);
                let normal = cross(&minus(&b, &a), &minus(&c, &a));
                let offset = dot(&normal, &a);
                Self { normal, offset }
            }
        }
    }

    pub(super) fn height(&self, point: &Vector<BigRational>) -> BigRational {
        dot(&self.normal, point) - &self.offset
    }
}

/// The normal of a splitter.
pub(super) fn normal(eye: &Vector<BigRational>, splitter: &Splitter) -> Vector<BigRational> {
    match splitter {
        Splitter::Edge(ends) => {
            let [a, b] = ends.map(|p| minus(&exact(p), eye));
            cross(&a, &b)
        }
        Splitter::Crease(planes) => {
            let [p, q] = planes.map(|plane| RationalPlane::new(&plane));
            let (h, g) = (p.height(eye), q.height(eye));
            [0, 1, 2].map(|k| &g * &p.normal[k] - &h * &q.normal[k])
        }
        Splitter::Given(normal) => exact(*normal),
        Splitter::Parallel(plane) => RationalPlane::new(plane).normal,
    }
}

pub(super) fn rational(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap_or_else(BigRational::zero)
}

pub(super) fn exact(v: DVec3) -> Vector<BigRational> {
    v.to_array().map(rational)
}

/// The multiple of a vector, by a positive factor, that is whole and has no common divisor.
pub(super) fn whole<const N: usize>(v: &[BigRational; N]) -> [BigInt; N] {
    let denominator = v.iter().fold(BigInt::from(1), |all, x| all.lcm(x.denom()));
    let whole = v.each_ref().map(|x| x.numer() * (&denominator / x.denom()));
    let divisor = whole.iter().fold(BigInt::zero(), |all, x| all.gcd(x));
    if divisor.is_zero() { whole } else { whole.map(|x| x / &divisor) }
}

pub(super) fn minus(a: &Vector<BigRational>, b: &Vector<BigRational>) -> Vector<BigRational> {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

pub(super) fn cross<T>(a: &Vector<T>, b: &Vector<T>) -> Vector<T>
where
    T: std::ops::Sub<Output = T>,
    for<'a> &'a T: std::ops::Mul<Output = T>,
{
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

pub(super) fn dot<T>(a: &Vector<T>, b: &Vector<T>) -> T
where
    T: std::ops::Add<Output = T>,
    for<'a> &'a T: std::ops::Mul<Output = T>,
{
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(super) fn sign_of<T: Zero + PartialOrd>(x: &T) -> Sign {
    x.partial_cmp(&T::zero()).map_or(Sign::Zero, Sign::from)
}
