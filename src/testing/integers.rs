//! Exact vectors for the checks: plain integers of any length, with nothing of the engine's kernel.

use crate::contour::Splitter;
use crate::contour::{ContourImage, Domain, Pane};
use crate::exact::{Plane, Point};
use crate::scene::{Scene, SupportingPlane};
use glam::DVec3;
use num_bigint::{BigInt, Sign as BigSign};
use num_traits::{One, Signed, Zero};

/// A vector of integers.
pub(super) type Vector = [BigInt; 3];

pub(super) fn minus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

pub(super) fn dot(a: &Vector, b: &Vector) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

pub(super) fn times(a: &Vector, x: &BigInt) -> Vector {
    [0, 1, 2].map(|k| &a[k] * x)
}

pub(super) fn plus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[k] + &b[k])
}

pub(super) fn is_zero(a: &Vector) -> bool {
    a.iter().all(Zero::is_zero)
}

/// -1, 0 or 1.
pub(super) fn sign(x: &BigInt) -> i32 {
    match x.sign() {
        BigSign::Minus => -1,
        BigSign::NoSign => 0,
        BigSign::Plus => 1,
    }
}

/// A whole multiple of a power of two: an odd number, or 0, and the exponent.
fn parts(x: f64) -> (i64, i32) {
    let bits = x.abs().to_bits();
    let (field, fraction) = ((bits >> 52) as i32, (bits & ((1 << 52) - 1)) as i64);
    let (mantissa, exponent) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    let odd = mantissa >> zeros;
    (if x < 0.0 { -odd } else { odd }, exponent + zeros as i32)
}

/// A power of two of which all coordinates at hand are whole multiples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit(i32);

impl Unit {
    pub(super) fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        let numbers = points.into_iter().flat_map(|p| p.to_array()).map(parts).filter(|&(odd, _)| odd != 0);
        Self(numbers.map(|(_, exponent)| exponent).min().unwrap_or(0))
    }

    /// For all coordinates that an image is made of.
    pub(super) fn of_image(image: &ContourImage) -> Self {
        let windows = if let Domain::Window(windows) = image.domain() { windows.panes() } else { &[] };
        let rings = windows.iter().filter_map(|pane| if let Pane::Ring(ring) = pane { Some(ring) } else { None });
        let eye = image.viewpoint().eye();
        Self::of(image.scene().vertices().iter().chain(rings.flatten()).copied().chain([eye]))
    }

    pub(super) fn vector(self, p: DVec3) -> Vector {
        p.to_array().map(|x| self.integer(x))
    }

    fn integer(self, x: f64) -> BigInt {
        let (odd, exponent) = parts(x);
        if odd == 0 { BigInt::zero() } else { BigInt::from(odd) << (exponent - self.0) as u32 }
    }

    /// A plane's normal and its product with the plane's points.
    pub(super) fn plane(self, plane: &Plane) -> (Vector, BigInt) {
        match *plane {
            Plane::Axis { axis, value } => {
                let mut normal = [BigInt::zero(), BigInt::zero(), BigInt::zero()];
                normal[axis] = BigInt::one();
                (normal, self.integer(value))
            }
            Plane::Points(points) => {
                let [a, b, c] = points.map(|p| self.vector(p));
                let normal = cross(&minus(&b, &a), &minus(&c, &a));
                let offset = dot(&normal, &a);
                (normal, offset)
            }
        }
    }

    /// A point by exact definition.
    pub(super) fn spot(self, point: &Point) -> Spot {
        let (x, w) = match point {
            Point::Given(p) => (self.vector(*p), BigInt::one()),
            Point::EdgePlane(ends, plane) => {
                let [a, b] = ends.map(|p| self.vector(p));
                let (normal, offset) = self.plane(plane);
                let [ha, hb] = [&a, &b].map(|p| dot(&normal, p) - &offset);
                (minus(&times(&a, &hb), &times(&b, &ha)), hb - ha)
            }
            Point::Planes(planes) => {
                let [(n, c), (m, d), (k, e)] = planes.each_ref().map(|plane| self.plane(plane));
                let [mk, kn, nm] = [cross(&m, &k), cross(&k, &n), cross(&n, &m)];
                (plus(&plus(&times(&mk, &c), &times(&kn, &d)), &times(&nm, &e)), dot(&n, &mk))
            }
        };
        if w.is_negative() { Spot { x: x.map(|x| -x), w: -w } } else { Spot { x, w } }
    }

    /// The normal of a splitter of a view from `eye`.
    pub(super) fn splitter(self, scene: &Scene, eye: DVec3, splitter: &Splitter) -> Vector {
        let eye = self.vector(eye);
        match splitter {
            Splitter::Edge(ends) => {
                let [a, b] = ends.map(|v| minus(&self.vector(scene.vertex(v)), &eye));
                cross(&a, &b)
            }
            Splitter::Points(ends) => {
                let [a, b] = ends.map(|p| minus(&self.vector(p), &eye));
                cross(&a, &b)
            }
            Splitter::Crease(planes) => {
                let [(n1, c1), (n2, c2)] = planes.map(|plane| self.plane(&resolved(scene, plane)));
                let (h1, h2) = (dot(&n1, &eye) - c1, dot(&n2, &eye) - c2);
                minus(&times(&n1, &h2), &times(&n2, &h1))
            }
            Splitter::Given(normal) => free_vector(*normal),
            Splitter::Parallel(plane) => self.plane(&resolved(scene, *plane)).0,
        }
    }
}

/// A supporting plane by its coordinates.
pub(super) fn resolved(scene: &Scene, plane: SupportingPlane) -> Plane {
    match plane {
        SupportingPlane::Axis { axis, value } => Plane::Axis { axis: axis as usize, value },
        SupportingPlane::Points(points) => Plane::Points(points.map(|v| scene.vertex(v))),
    }
}

/// A vector whose length does not matter.
pub(super) fn free_vector(v: DVec3) -> Vector {
    Unit::of([v]).vector(v)
}

/// The point `x / w`, `w > 0`.
#[derive(Clone, Debug)]
pub(super) struct Spot {
    pub(super) x: Vector,
    pub(super) w: BigInt,
}

impl Spot {
    /// A multiple, by a positive number, of its height over a plane.
    pub(super) fn height(&self, (normal, offset): &(Vector, BigInt)) -> BigInt {
        dot(normal, &self.x) - offset * &self.w
    }

    /// A multiple, by a positive number, of the vector to it from a point.
    pub(super) fn seen_from(&self, eye: &Vector) -> Vector {
        minus(&self.x, &times(eye, &self.w))
    }
}
