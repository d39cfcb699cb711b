//! Zonal integrals of spherical polygons: of Legendre polynomials of the cosine to an axis.
//!
//! The spherical harmonic coefficients of a polygon, band by band, are linear in those about 2 l + 1 axes (Wang and Ramamoorthi,
//! "Analytic spherical harmonic coefficients for polygonal area lights", 2018). With an arc from a to b of angle theta, its unit normal e along a x b, g(x) the cosine of its
//! points to the axis w, and `C` the square of the length of w in the arc's plane:
//!
//! ```text
//! Z_0 = Omega, Z_l = sum over arcs of (w.e) D_l / (l (l + 1));
//! C_l is the integral of P_l(g) and D_l that of P_l'(g) from 0 to theta: C_0 = theta, C_1 = g'(0) - g'(theta), D_0 = 0, D_1 = theta,
//! D_l = D_(l-2) + (2 l - 1) C_(l-1);
//! l G = (l - 1) C_(l-2) + (C - 1) D_(l-1) - [P_(l-1)(g) g'];
//! l C_l = (2 l - 1) G - (l - 1) C_(l-2).
//! ```

use super::clip::unit_outline;
use super::solid_angle;
use super::unit::arcs;
use glam::DVec3;

/// The integrals of the Legendre polynomials of w.u, of degrees 0 to n, over the directions u of a convex polygon, in steradians, n the `degree`: n + 1 numbers, each
/// at most the polygon's solid angle in size.
///
/// `boundary` as for [`solid_angle`](super::solid_angle()); it is not cut off anywhere. `axis` is w, of any length; without
/// a direction (zero or not finite) all are 0. The error is absolute: against cubature it was below 2e-15 up to degree 12 for radii of
/// 1e-4 to 1.4, and up to degree 64 for small polygons; below 1e-13 up to degree 64 for the hemisphere about the axis. O(vertices times n).
///
/// ```
/// use glam::DVec3;
/// // Over a half sphere even polynomials have no integral but the first.
/// let hemisphere = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
/// let zonal = nusselt::integral::zonal_integrals(&hemisphere, DVec3::Z, 2);
/// let expected = [2.0, 1.0, 0.0].map(|part| part * std::f64::consts::PI);
/// assert!(zonal.iter().zip(expected).all(|(z, e)| (z - e).abs() < 1e-14));
/// ```
pub fn zonal_integrals(boundary: &[DVec3], axis: DVec3, degree: u16) -> Vec<f64> {
    let mut zonal = vec![0.0; usize::from(degree) + 1];
    let Some(axis) = (axis / axis.abs().max_element()).try_normalize() else { return zonal };
    let outline = unit_outline(boundary);
    zonal[0] = solid_angle(&outline);
    for arc in &long_arcs(&outline) {
        arc.add(axis, &mut zonal);
    }
    zonal
}

/// The arcs of an outline that have a length.
pub(super) fn long_arcs(outline: &[DVec3]) -> Vec<LongArc> {
    arcs(outline).filter_map(|[&a, &b]| LongArc::new(a, b)).collect()
}

/// An arc of at most 90 degrees between two unit vectors.
pub(super) struct LongArc {
    /// Its ends a and b.
    ends: [DVec3; 2],
    /// e x a and e x b.
    along: [DVec3; 2],
    /// e.
    pub(super) normal: DVec3,
    /// Its length.
    pub(super) theta: f64,
}

impl LongArc {
    fn new(a: DVec3, b: DVec3) -> Option<Self> {
        let cross = a.cross(b - a);
        let sine = cross.length();
        if sine == 0.0 {
            return None;
        }
        let normal = cross / sine;
        Some(Self { ends: [a, b], along: [normal.cross(a), normal.cross(b)], normal, theta: sine.atan2(a.dot(b)) })
    }

    /// Adds what the arc has of all degrees but 0 about a unit axis.
    pub(super) fn add(&self, axis: DVec3, zonal: &mut [f64]) {
        let cosines = self.ends.map(|end| axis.dot(end));
        let slopes = self.along.map(|along| axis.dot(along));
        let height = axis.dot(self.normal);
        // C - 1, without the cancellation.
        let less = -height * height;
        // C, D and P at both ends, of the degree before and of the one before that.
        let mut values = [0.0, self.theta];
        let mut slopes_of = [0.0, 0.0];
        let mut ends = [[0.0; 2], [1.0; 2]];
        for (l, sum) in zonal.iter_mut().enumerate().skip(1) {
            let degree = l as f64;
            let slope = if l == 1 { self.theta } else { slopes_of[0] + (2.0 * degree - 1.0) * values[1] };
            let bracket = ends[1][1] * slopes[1] - ends[1][0] * slopes[0];
            let value = if l == 1 {
                -bracket
            } else {
                let product = ((degree - 1.0) * values[0] + less * slopes_of[1] - bracket) / degree;
                ((2.0 * degree - 1.0) * product - (degree - 1.0) * values[0]) / degree
            };
            *sum += height * slope / (degree * (degree + 1.0));
            let next = [0, 1].map(|end| {
                ((2.0 * degree - 1.0) * cosines[end] * ends[1][end] - (degree - 1.0) * ends[0][end]) / degree
            });
            values = [values[1], value];
            slopes_of = [slopes_of[1], slope];
            ends = [ends[1], next];
        }
    }
}

/// What rounding may leave of a zonal integral of degree l >= 1 over an outline in units of `f64::EPSILON`, by an arc: for arcs whose normals have the cosines h
/// to the axis it is the sum of |h| (`fixed` + `by_length` theta).
///
/// *What goes in.* `P_l` of an end is off by 3 (l + l^2 / 4): each step of its recurrence adds at most 3, and one of step k has grown by no more than
/// 1 + k log(l / k) (the solution is bounded by its value at 1). An end itself is off by 4, which changes `P_l` g' by at most 4 l (Bernstein). So the bracket, times
/// 2 / l, brings 48 + 3 l into `C_l`, and its other terms, of size theta, bring 8 theta; `D_l` gets twice its own rounding.
///
/// *What comes out.* The response of `Z_l` to an error of 1 in each `C_k` depends on nothing but h. Its sum over k, the largest for 2,001 values of h from 0 to 1, is
/// computed by a test for all l to 65, and is at most 0.35 + 0.084 l; to a relative error of 1 in each `D_k` it is 1.5 theta + l^2 theta / 43.
pub(super) struct Rounding {
    pub(super) fixed: f64,
    pub(super) by_length: f64,
}

impl Rounding {
    /// The highest degree of which the responses are known.
    pub(super) const DEGREES: u16 = 65;

    pub(super) fn of(degree: u16) -> Self {
        let l = f64::from(degree);
        let response = 0.35 + 0.084 * l;
        Self { fixed: response * (48.0 + 3.0 * l), by_length: 8.0 * response + 2.0 * (1.5 + l * l / 43.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Rounding, zonal_integrals};
    use crate::integral::brute::brute;
    use crate::integral::{axial_moment, solid_angle};
    use glam::DVec3;
    use std::f64::consts::TAU;

    /// The Legendre polynomials of degrees 0 to n at x.
    fn legendre(x: f64, n: usize) -> Vec<f64> {
        let mut p = vec![1.0, x];
        for l in 2..=n {
            let degree = l as f64;
            p.push(((2.0 * degree - 1.0) * x * p[l - 1] - (degree - 1.0) * p[l - 2]) / degree);
        }
        p
    }

    #[test]
    fn hemispheres_have_closed_forms() {
        let hemisphere = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
        let zonal = zonal_integrals(&hemisphere, DVec3::Z * 1e200, 64);
        let at_zero = legendre(0.0, 65);
        assert!((zonal[0] - TAU).abs() < 1e-14);
        for l in 1..=64 {
            let expected = TAU * (at_zero[l - 1] - at_zero[l + 1]) / (2.0 * l as f64 + 1.0);
            assert!((zonal[l] - expected).abs() < 1e-13, "{l}: {} instead of {expected}", zonal[l]);
        }
    }

    #[test]
    fn zonal_integrals_are_what_cubature_gives() {
        let mut worst = 0.0_f64;
        for (k, radius) in [1e-4_f64, 0.03, 0.4, 1.0, 1.4].into_iter().enumerate() {
            for turn in 0..6 {
                let t = f64::from(turn);
                let centre = DVec3::new((t * 1.3).sin(), (t * 0.7).cos(), 0.4 - 0.1 * t).normalize();
                let axis = DVec3::new(0.3 * t - 0.5, 0.2, 0.9).normalize();
                let (x, y) = centre.any_orthonormal_pair();
                let count = 3 + k as u32;
                let corner = |j: u32| {
                    let (sin, cos) = (f64::from(j) * TAU / f64::from(count)).sin_cos();
                    centre * radius.cos() + (x * cos + y * sin) * radius.sin()
                };
                let polygon: Vec<DVec3> = (0..count).map(corner).collect();
                let zonal = zonal_integrals(&polygon, axis, 64);
                // Brute force on triangles of 0.3 follows no faster waves.
                for l in [0, 1, 2, 3, 8, 12, 40, 64].into_iter().filter(|&l| l < 20 || radius < 0.1) {
                    let p = |u: DVec3| DVec3::splat(legendre(axis.dot(u), 64)[l]);
                    let expected = brute(&polygon, axis, 0.5, &p).x;
                    worst = worst.max((zonal[l] - expected).abs());
                }
            }
        }
        println!("worst {worst:e}");
        assert!(worst < 1e-12, "{worst:e}");
    }

    #[test]
    fn low_degrees_are_moments() {
        let polygon = [DVec3::X, DVec3::new(0.2, 1.0, 0.1), DVec3::new(0.3, 0.2, 1.0)];
        let axis = DVec3::ONE;
        let [zero, one, two] = [0, 1, 2].map(|n| axial_moment(&polygon, axis, n).value);
        let zonal = zonal_integrals(&polygon, axis, 2);
        for (z, expected) in zonal.iter().zip([zero, one, 1.5 * two - 0.5 * zero]) {
            assert!((z - expected).abs() < 1e-14, "{z} {expected}");
        }
    }

    #[test]
    fn nonsense_has_none() {
        let octant = [DVec3::X, DVec3::Y, DVec3::Z];
        for bad in [DVec3::ZERO, DVec3::NAN] {
            assert_eq!(zonal_integrals(&octant, bad, 3), [0.0; 4]);
        }
        assert_eq!(zonal_integrals(&[], DVec3::Z, 3), [0.0; 4]);
        assert_eq!(zonal_integrals(&octant, DVec3::Z, 0), [solid_angle(&octant)]);
    }

    /// How `Z_l` over h responds to an error in `C_k` (`by_slope` false) or `D_k`, by l: the recurrence of `LongArc::add` without its ends.
    fn response(h: f64, k: usize, by_slope: bool, highest: usize) -> Vec<f64> {
        let [mut values, mut slopes, mut zonal] = [(); 3].map(|()| vec![0.0; highest + 1]);
        for l in k..=highest {
            let degree = l as f64;
            let at = |list: &[f64], back: usize| if l >= back { list[l - back] } else { 0.0 };
            slopes[l] = at(&slopes, 2) + (2.0 * degree - 1.0) * at(&values, 1);
            if l == 1 {
                slopes[l] = 0.0;
            }
            if l == k && by_slope {
                slopes[l] += 1.0;
            }
            if l > 1 {
                let product = ((degree - 1.0) * at(&values, 2) - h * h * at(&slopes, 1)) / degree;
                values[l] = ((2.0 * degree - 1.0) * product - (degree - 1.0) * at(&values, 2)) / degree;
            }
            if l == k && !by_slope {
                values[l] += 1.0;
            }
            zonal[l] = if l > 0 { slopes[l] / (degree * (degree + 1.0)) } else { 0.0 };
        }
        zonal
    }

    #[test]
    fn the_recurrence_responds_to_rounding_as_bounded() {
        let highest = usize::from(Rounding::DEGREES);
        let mut nearest = [0.0_f64; 2];
        for step in 0..=2_000 {
            let h = f64::from(step) / 2_000.0;
            let [mut by_value, mut by_slope] = [(); 2].map(|()| vec![0.0; highest + 1]);
            for k in 0..=highest {
                let sums = [(&mut by_value, false, 1.0), (&mut by_slope, true, (k * (k + 1)) as f64 / 2.0)];
                for (sum, is_slope, size) in sums {
                    // An arc of length 1: D_k is an integral of P_k', which is k (k + 1) / 2 at most.
                    let zonal = response(h, k, is_slope, highest);
                    sum.iter_mut().zip(zonal).for_each(|(sum, z)| *sum += (z * size).abs());
                }
            }
            for l in 1..=highest {
                let degree = l as f64;
                nearest[0] = nearest[0].max(by_value[l] / (0.35 + 0.084 * degree));
                nearest[1] = nearest[1].max(by_slope[l] / (1.5 + degree * degree / 43.0));
            }
        }
        println!("{nearest:?} of the bounds");
        assert!(nearest.iter().all(|part| (0.5..=1.0).contains(part)), "{nearest:?}");
    }
}
