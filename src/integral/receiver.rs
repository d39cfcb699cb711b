//! Form factors to cells of a contour image, of which there are many with corners in common.
//!
//! Only the component of the flux (`flux.rs`) along the receiver's normal is wanted. Corners are turned once so that this is z: then a
//! cross product is two products, and all that the arc from a to b takes besides is h = |b - a|^2 / 4, the square of the sine of half of
//! its angle theta: theta / sin theta - 1 is a power series in h.

use super::form_factor::form_factor;
use glam::DVec3;
use std::f64::consts::TAU;

/// Directions as an element of a surface sees them: its normal is z.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Receiver {
    axes: [DVec3; 3],
}

impl Receiver {
    /// By its unit normal. If that is an axis nothing is rounded when directions are turned.
    pub(crate) fn new(normal: DVec3) -> Self {
        let (u, v) = normal.any_orthonormal_pair();
        Self { axes: [u, v, normal] }
    }

    /// The unit direction of a vector of moderate length, turned. Turning moves it by some 1e-16, as does rounding it to `f64`. Not a number for the null vector.
    pub(crate) fn turned(&self, vector: DVec3) -> DVec3 {
        let [u, v, normal] = &self.axes;
        DVec3::new(u.dot(vector), v.dot(vector), normal.dot(vector)) / vector.length()
    }

    /// The form factor to a convex polygon with those turned unit corners, counter-clockwise seen from outside of the sphere. Never negative.
    ///
    /// The corners count as exact: the error is below 2e-16 times (the value + the polygon's perimeter times its diameter).
    pub(crate) fn factor(corners: impl Iterator<Item = DVec3> + Clone) -> f64 {
        let mut rest = corners.clone();
        let first = rest.next().zip(rest.next()).map_or(0.0, |(a, b)| sine_squared(b - a));
        // Most cells are small. In others the first arc often shows that already.
        let (mut double, mut all) = (0.0, first);
        if all < SHORT {
            (double, all) = double_flux(corners.clone(), series::<6>);
        }
        if (SHORT..LONG).contains(&all) {
            (double, all) = double_flux(corners.clone(), series::<12>);
        }
        // Beyond that an arc may be longer.
        if all < LONG { share(double) } else { factor_of_large(&corners.collect::<Vec<_>>()) }
    }

    /// The same to a polygon with those corners, of moderate lengths, in memory that is used again.
    pub(crate) fn factor_of(&self, corners: impl Iterator<Item = DVec3>, ring: &mut Vec<DVec3>) -> f64 {
        ring.clear();
        ring.extend(corners.map(|corner| self.turned(corner)));
        Self::factor(ring.iter().copied())
    }
}

/// [`Receiver::factor`] to a polygon of any size.
#[cold]
fn factor_of_large(corners: &[DVec3]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    if corners.iter().zip(next).all(|(a, b)| sine_squared(*b - *a) < 0.49) {
        share(double_flux(corners.iter().copied(), |h| if h < LONG { series::<12>(h) } else { quotient(h) }).0)
    } else {
        // Arcs of 90 degrees and more are halved there, and what is no direction is left out.
        form_factor(corners, DVec3::Z)
    }
}

/// The form factor, from twice the flux.
fn share(double_flux: f64) -> f64 {
    let factor = double_flux / TAU;
    if factor > 0.0 { factor } else { 0.0 }
}

/// The square of the sine of half the angle between unit vectors, from their difference.
fn sine_squared(step: DVec3) -> f64 {
    step.length_squared() * 0.25
}

/// The z component of twice the flux, see `flux.rs`; and the sum of the squared sines of half the arcs: not a number if a corner is not.
#[inline]
fn double_flux(mut corners: impl Iterator<Item = DVec3>, excess: impl Fn(f64) -> f64) -> (f64, f64) {
    let (mut flat, mut curved, mut all) = (0.0, 0.0, 0.0);
    let Some(origin) = corners.next() else { return (0.0, 0.0) };
    let mut add = |a: DVec3, b: DVec3| {
        let (step, off) = (b - a, a - origin);
        let h = sine_squared(step);
        flat += off.x * step.y - off.y * step.x;
        curved += excess(h) * (a.x * step.y - a.y * step.x);
        all += h;
    };
    let mut last = origin;
    for corner in corners {
        add(last, corner);
        last = corner;
    }
    add(last, origin);
    (flat + curved, all)
}

/// Arcs below 3.6 degrees: what the series leaves out is below 1e-18 of it.
const SHORT: f64 = 1.0 / 1024.0;
/// Arcs below 20 degrees: likewise 2e-18.
const LONG: f64 = 1.0 / 32.0;

/// theta / sin theta - 1 for sin^2 (theta / 2) = `h`, with `N` terms.
#[inline]
fn series<const N: usize>(h: f64) -> f64 {
    h * SERIES[..N].iter().rev().fold(0.0, |sum, &c| sum * h + c)
}

/// The same for `h` up to 1/2; its absolute error of 3e-16 is as much of the flux of a polygon of that size.
fn quotient(h: f64) -> f64 {
    h.sqrt().asin() / (h * (1.0 - h)).sqrt() - 1.0
}

/// The coefficients of asin(s) / (s sqrt(1 - s^2)) - 1 in s^2: 2/3, and each 2k / (2k + 1) of the one before, from k = 1.
const SERIES: [f64; 12] = {
    let mut series = [0.0; 12];
    let mut product = 1.0;
    let mut k = 1;
    while k <= 12 {
        let two_k = (2 * k) as f64;
        product *= two_k / (two_k + 1.0);
        series[k - 1] = product;
        k += 1;
    }
    series
};

#[cfg(test)]
mod tests {
    use super::super::form_factor;
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn series_and_quotient_meet() {
        let x = LONG;
        for h in [x / 2.0, x * 0.9, x.next_down()] {
            let (series, quotient) = (series::<12>(h), quotient(h));
            assert!((series - quotient).abs() <= 3e-16, "{h}: {series:e} {quotient:e}");
        }
        let [short, long] = [series::<6>(SHORT) / SHORT, series::<12>(SHORT) / SHORT];
        assert!((short - long).abs() <= 1e-16 * long, "{short:e} {long:e}");
        // A right angle: pi / 2 over 1.
        assert!((quotient(0.5) - (PI / 2.0 - 1.0)).abs() <= 3e-16);
    }

    #[test]
    fn axes_are_turned_exactly() {
        let v = DVec3::new(1.0 / 3.0, 0.7, -1.1);
        for normal in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
            let receiver = Receiver::new(normal);
            let [x, y, z] = receiver.axes.map(|axis| axis.dot(v));
            let mut parts = [x.abs(), y.abs(), z.abs()];
            parts.sort_unstable_by(f64::total_cmp);
            assert_eq!((parts, z.to_bits()), ([1.0 / 3.0, 0.7, 1.1], normal.dot(v).to_bits()));
            assert_eq!(receiver.axes[0].cross(receiver.axes[1]), normal);
        }
    }

    #[test]
    fn null_vectors_are_left_out() {
        let receiver = Receiver::new(DVec3::Z);
        let ring = [DVec3::X, DVec3::ZERO, DVec3::Y, DVec3::Z].map(|v| receiver.turned(v));
        assert!((Receiver::factor(ring.into_iter()) - 0.25).abs() < 1e-15);
        assert!(Receiver::factor(std::iter::empty()) == 0.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2_000))]

        /// As `form_factor`, which takes the same corners as exact, from 1e-9 to arcs of more than 90 degrees.
        #[test]
        fn agrees_with_the_form_factor_of_any_polygon(
            size in -9.0..0.3f64, aspect in 0.01..1.0f64, tilt in 0.0..1.2f64, spin in 0.0..6.2f64, count in 3usize..9,
            normal in prop::array::uniform3(-1.0..1.0f64), length in 0.5..2.0f64,
        ) {
            let normal = DVec3::from(normal);
            prop_assume!(normal.length() > 0.1);
            let normal = normal.normalize();
            let receiver = Receiver::new(normal);
            let size = 10f64.powf(size);
            let (u, v) = normal.any_orthonormal_pair();
            let middle = normal * tilt.cos() + (u * spin.cos() + v * spin.sin()) * tilt.sin();
            let (p, q) = middle.any_orthonormal_pair();
            let mut ring: Vec<DVec3> = (0..count)
                .map(|k| TAU * k as f64 / count as f64)
                .map(|angle| (middle + (p * angle.cos() + q * (angle.sin() * aspect)) * size) * length)
                .map(|corner| receiver.turned(corner))
                .collect();
            let expected = form_factor(&ring, DVec3::Z);
            let factor = Receiver::factor(ring.iter().copied());
            ring.push(ring[0]);
            let steps: Vec<f64> = ring.windows(2).map(|arc| arc[1].distance(arc[0])).collect();
            let perimeter: f64 = steps.iter().sum();
            // Both are off by so much at most. Corners count as unit vectors in one and as directions in the other, and are 2e-16 apart:
            // that moves as much of the chords beside them.
            let bound = 4e-16 * (expected + perimeter * (perimeter / 2.0).min(2.0)) + 2e-16 * perimeter / TAU;
            prop_assert!((factor - expected).abs() <= bound, "{factor} {expected} {bound:e}");
        }
    }
}
