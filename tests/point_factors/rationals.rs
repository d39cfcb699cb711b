//! What is seen of a polygon, in rational numbers, and its form factor from differences that are rounded once.

use glam::DVec3;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

/// A direction from the eye.
pub(crate) type Vector = [BigRational; 3];

pub(crate) fn exact(v: DVec3) -> Vector {
    v.to_array().map(|x| BigRational::from_float(x).expect("finite"))
}

pub(crate) fn minus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

pub(crate) fn dot(a: &Vector, b: &Vector) -> BigRational {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(crate) fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

/// The part of a convex polygon with n.v >= 0.
pub(crate) fn clipped(polygon: &[Vector], n: &Vector) -> Vec<Vector> {
    let mut kept = Vec::new();
    for (k, a) in polygon.iter().enumerate() {
        let b = &polygon[(k + 1) % polygon.len()];
        let (ha, hb) = (dot(a, n), dot(b, n));
        if !ha.is_negative() {
            kept.push(a.clone());
        }
        if (ha.is_negative() && hb.is_positive()) || (ha.is_positive() && hb.is_negative()) {
            let t = &ha / (&ha - &hb);
            kept.push([0, 1, 2].map(|c| &a[c] + (&b[c] - &a[c]) * &t));
        }
    }
    kept
}

/// Gauss points and weights on 0 to 1, exact to degree 9.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668_0, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_2),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_2),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

/// The form factor of a small planar polygon seen from the origin: the integral of (n.v) (m.v) / (pi |v|^4) over its area, for unit
/// normals n of the receiver and m of the plane. What cancels is taken from rationals: areas, and heights over the horizon, which are linear.
pub(crate) fn form_factor(polygon: &[Vector], normal: &Vector) -> f64 {
    let number = |x: &BigRational| x.to_f64().expect("a number");
    let length = number(&dot(normal, normal)).sqrt();
    let mut sum = 0.0;
    for k in 1..polygon.len().max(2) - 1 {
        let triangle = [&polygon[0], &polygon[k], &polygon[k + 1]];
        // Twice the vector area, and its height times that: det[a, b, c].
        let area = cross(&minus(triangle[1], triangle[0]), &minus(triangle[2], triangle[0]));
        let determinant = number(&dot(triangle[0], &area)).abs();
        let heights = triangle.map(|v| number(&dot(v, normal)) / length);
        let corners = triangle.map(|v| DVec3::from([0, 1, 2].map(|c| number(&v[c]))));
        let mut mean = 0.0;
        for (s, ws) in GAUSS {
            for (t, wt) in GAUSS {
                let weights = [1.0 - s, s * (1.0 - t), s * t];
                let height: f64 = (0..3).map(|c| weights[c] * heights[c]).sum();
                let at: DVec3 = (0..3).map(|c| corners[c] * weights[c]).sum();
                mean += ws * wt * s * height / at.length_squared().powi(2);
            }
        }
        sum += determinant * mean;
    }
    assert!(!sum.is_zero(), "nothing is seen");
    sum / std::f64::consts::PI
}
