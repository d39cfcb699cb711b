//! The vector flux of a spherical polygon, without cancellation.
//!
//! Lambert's formula in vector form says that for a polygon K with unit vertices
//! 2 (integral over K of u) = sum of theta c / s, with c = a x b, s = |c|, theta = atan2(s, a.b) over the arcs ab.
//! For a polygon of size delta the terms are of size delta and the sum is of size delta^2: that is
//! where the digits go. Split theta / s = 1 + (theta / s - 1):
//!
//! - the sum of c alone is twice the vector area of the polygon's flat facets. Written with
//!   differences, sum of (a - o) x (b - a) for any fixed o, here the first vertex, its terms are of size delta^2;
//! - theta / s - 1 = s^2 / 6 + 3 s^4 / 40 + ... is of size delta^2, so the terms of the rest are of size
//!   delta^3 and lose nothing to the sum.
//!
//! This is an identity, not a series in delta: it holds from a hemisphere down to 1e-150 and needs no
//! switch between two formulas.

use super::unit::{UnitDirection, arcs};
use glam::DVec3;

/// A unit vector, as precise as it may be.
pub(super) trait Vertex {
    /// To `f64`.
    fn rounded(&self) -> DVec3;
    /// The difference, as precise as the vectors are.
    fn minus(&self, other: &Self) -> DVec3;
}

impl Vertex for UnitDirection {
    fn rounded(&self) -> DVec3 {
        self.rounded()
    }

    fn minus(&self, other: &Self) -> DVec3 {
        self.minus(other)
    }
}

/// Corners that are known to `f64` only.
impl Vertex for DVec3 {
    fn rounded(&self) -> DVec3 {
        *self
    }

    fn minus(&self, other: &Self) -> DVec3 {
        *self - *other
    }
}

/// Twice the integral of u over a polygon given by its outline.
pub(super) fn double_flux<V: Vertex>(outline: &[V]) -> DVec3 {
    let Some(origin) = outline.first() else {
        return DVec3::ZERO;
    };
    let mut flat = DVec3::ZERO;
    let mut curved = DVec3::ZERO;
    for [a, b] in arcs(outline) {
        let step = b.minus(a);
        flat += a.minus(origin).cross(step);
        let cross = a.rounded().cross(step);
        curved += excess(cross.length_squared(), a.rounded().dot(b.rounded())) * cross;
    }
    flat + curved
}

/// theta / sin theta - 1 for sin^2 theta = `x`, cos theta = `d` >= 0 (and 0 for antipodes, whose arc is undefined).
///
/// Below sin theta = 1/4 the series of asin(s) / s - 1, whose relative error is a few 1e-16; above it the
/// quotient, whose absolute error is 2e-16, not more than 4e-15 of this value but 2e-16 of the
/// flux of a polygon of that size. What six terms leave out for short arcs is below 1e-19 of the first.
fn excess(x: f64, d: f64) -> f64 {
    let series = |terms: &[f64]| x * terms.iter().rev().fold(0.0, |sum, &c| sum * x + c);
    if d > 0.0 && x < 1.0 / 1024.0 {
        return series(&SERIES[..6]);
    }
    if d > 0.0 && x < 1.0 / 16.0 {
        return series(&SERIES);
    }
    let s = x.sqrt();
    if s > 0.0 { s.atan2(d) / s - 1.0 } else { 0.0 }
}

/// The coefficients of asin(s) / s - 1 in s^2: binomial(2k, k) / (4^k (2k + 1)), from k = 1.
const SERIES: [f64; 14] = {
    let mut series = [0.0; 14];
    let mut central = 1.0;
    let mut k = 1;
    while k <= 14 {
        let two_k = (2 * k) as f64;
        central *= (two_k - 1.0) / two_k;
        series[k - 1] = central / (two_k + 1.0);
        k += 1;
    }
    series
};

#[cfg(test)]
mod tests {
    use super::excess;

    #[test]
    fn series_and_quotient_meet() {
        for s in [0.2, 0.23, 0.249_999, 0.25_f64.next_down()] {
            let quotient = s.asin() / s - 1.0;
            let series = excess(s * s, (1.0 - s * s).sqrt());
            assert!((series - quotient).abs() <= 3e-16, "{s}: {series:e} {quotient:e}");
        }
    }

    #[test]
    fn short_and_long_series_meet() {
        let x = 1.0 / 1024.0;
        let [short, long] = [f64::next_down(x), x].map(|x| excess(x, 1.0) / x);
        assert!((short - long).abs() <= 1e-16 * long, "{short:e} {long:e}");
    }
}
