//! Integrals of series of spherical harmonics over spherical polygons, in closed form.
//!
//! By the addition theorem any function of band l is a sum of Legendre polynomials about 2 l + 1 axes `w_k` in general position:
//! with sum over k of `alpha_k` `Y_lm(w_k)` = (2 l + 1) / (4 pi) `a_lm` it is sum over k of `alpha_k` `P_l(w_k.u)`, and its integral the same
//! sum of zonal integrals `Z_l(w_k)` (Wang and Ramamoorthi, "Analytic spherical harmonic coefficients for polygonal area lights", 2018).
//!
//! One set of 2 n + 1 axes serves all bands to n: the zonal integrals of all degrees about an axis come with one recurrence. Of the solutions alpha of lower bands,
//! of which there are many, the smallest is taken. The axes are chosen once per n among many well-spread ones, each to be as independent as can be of
//! those before it (the pivots of a QR decomposition, approximate Fekete points: Sommariva and Vianello 2009), as
//! are the pseudo-inverse matrices.

use super::clip::{perimeter, unit_outline};
use super::harmonics::{Harmonics, harmonics};
use super::zonal::{Rounding, long_arcs};
use super::{Integral, solid_angle};
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

/// A series of spherical harmonics as a sum of Legendre polynomials about fixed axes, ready to be integrated over many polygons.
pub struct ZonalSum {
    axes: Arc<Axes>,
    band: u16,
    /// The factors of `P_l` about axis k: at k (band + 1) + l.
    factors: Vec<DVec3>,
    /// No value of the series is larger.
    largest: DVec3,
    /// What it may differ from the series in any direction.
    residue: DVec3,
}

impl ZonalSum {
    /// Series to that band can be integrated.
    pub const BANDS: u16 = Rounding::DEGREES;

    /// Of a series; `None` if its band is higher than [`ZonalSum::BANDS`] or a coefficient is not finite. O(band^3), but the first of a band takes
    /// O(band^4) to find its axes: a millisecond at band 17, half a second at 65.
    pub fn new(series: &Harmonics) -> Option<Self> {
        let band = series.band();
        if band > Self::BANDS || !series.coefficients().iter().all(|c| c.is_finite()) {
            return None;
        }
        let axes = Axes::of(band);
        let stride = usize::from(band) + 1;
        let mut factors = vec![DVec3::ZERO; axes.directions.len() * stride];
        let (mut largest, mut residue) = (DVec3::ZERO, DVec3::ZERO);
        for l in 0..=band {
            let coefficients = series.band_of(l);
            let width = coefficients.len();
            let scale = width as f64 / (4.0 * PI);
            let (values, inverse) = (&axes.values[usize::from(l)], &axes.inverses[usize::from(l)]);
            let mut rest: Vec<DVec3> = coefficients.iter().map(|&c| c * scale).collect();
            // The second round is for the digits that the first has lost.
            for _ in 0..2 {
                for (k, row) in inverse.chunks(width).enumerate() {
                    let step: DVec3 = row.iter().zip(&rest).map(|(&entry, &c)| c * entry).sum();
                    factors[k * stride + usize::from(l)] += step;
                }
                rest = coefficients.iter().map(|&c| c * scale).collect();
                for (k, value) in values.chunks(width).enumerate() {
                    let factor = factors[k * stride + usize::from(l)];
                    rest.iter_mut().zip(value).for_each(|(rest, &y)| *rest -= factor * y);
                }
            }
            let norm = |all: &[DVec3]| {
                let squares: DVec3 = all.iter().map(|&c| c * c).sum();
                DVec3::from(squares.to_array().map(f64::sqrt))
            };
            // |Y_l| = sqrt((2 l + 1) / 4 pi), and |P_l| <= 1.
            largest += norm(coefficients) * scale.sqrt();
            let sizes: DVec3 = (0..axes.directions.len()).map(|k| factors[k * stride + usize::from(l)].abs()).sum();
            residue += norm(&rest) / scale.sqrt() + sizes * (f64::EPSILON * f64::from(8 + 4 * l));
        }
        Some(Self { axes, band, factors, largest, residue })
    }

    /// The integral over a convex polygon with a bound on its error, which is absolute: below 1e-12 times the largest value of the
    /// series to band 9, below 1e-10 to 65. Errors seen are a few 1e-15.
    ///
    /// `boundary` as for [`solid_angle`](super::solid_angle()); it is not cut off anywhere. O(vertices times band^2).
    pub fn integral(&self, boundary: &[DVec3]) -> Integral {
        let outline = unit_outline(boundary);
        let arcs = long_arcs(&outline);
        let (omega, rim) = (solid_angle(&outline), perimeter(&outline));
        let stride = usize::from(self.band) + 1;
        let mut value = DVec3::ZERO;
        // Rounding of the corners moves the rim.
        let mut error = self.residue * omega + self.largest * (2.0 * f64::EPSILON * rim);
        let mut zonal = vec![0.0; stride];
        let bounds: Vec<Rounding> = (0..=self.band).map(Rounding::of).collect();
        for (&axis, factors) in self.axes.directions.iter().zip(self.factors.chunks(stride)) {
            zonal.fill(0.0);
            zonal[0] = omega;
            let (mut heights, mut by_length) = (0.0, 0.0);
            for arc in &arcs {
                arc.add(axis, &mut zonal);
                let height = axis.dot(arc.normal).abs();
                heights += height;
                by_length += height * arc.theta;
            }
            for (l, (&factor, &integral)) in factors.iter().zip(&zonal).enumerate() {
                value += factor * integral;
                let rounding = if l == 0 {
                    2.0 * (omega + rim * rim.min(PI))
                } else {
                    bounds[l].fixed * heights + bounds[l].by_length * by_length
                };
                // The terms' own rounding, and that of their sum.
                let sum = integral.abs() * (3.0 + 0.5 * f64::from(self.band));
                error += factor.abs() * (f64::EPSILON * (rounding + sum));
            }
        }
        Integral { value, error, evaluations: 0 }
    }
}

/// Axes for all bands to one.
struct Axes {
    directions: Vec<DVec3>,
    /// Of band l, the harmonics of axis k: at k (2 l + 1).
    values: Vec<Vec<f64>>,
    /// The transposed pseudo-inverses of those, in the same order.
    inverses: Vec<Vec<f64>>,
}

impl Axes {
    /// The same ones whenever asked for.
    fn of(band: u16) -> Arc<Self> {
        static KNOWN: [OnceLock<Arc<Axes>>; Rounding::DEGREES as usize + 1] =
            [const { OnceLock::new() }; Rounding::DEGREES as usize + 1];
        KNOWN[usize::from(band)].get_or_init(|| Arc::new(Self::new(band))).clone()
    }

    fn new(band: u16) -> Self {
        let directions = spread(band);
        let all: Vec<Vec<f64>> = directions.iter().map(|&axis| harmonics(axis, band)).collect();
        let values: Vec<Vec<f64>> = (0..=band)
            .map(|l| {
                let from = usize::from(l) * usize::from(l);
                all.iter().flat_map(|row| row[from..=from + 2 * usize::from(l)].iter().copied()).collect()
            })
            .collect();
        let inverses =
            values.iter().enumerate().map(|(l, values)| transposed_pseudo_inverse(values, 2 * l + 1)).collect();
        Self { directions, values, inverses }
    }
}

/// 2 n + 1 axes of which the harmonics of band n are as independent as can be.
fn spread(band: u16) -> Vec<DVec3> {
    let width = 2 * usize::from(band) + 1;
    let candidates = 6 * width;
    // Spirals of the golden angle over half of the sphere: the other half has the same axes.
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let direction = |k: usize| {
        let z = (k as f64 + 0.5) / candidates as f64;
        let (sin, cos) = (k as f64 * golden).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cos, radius * sin, z).normalize()
    };
    let from = usize::from(band) * usize::from(band);
    let mut rows: Vec<Vec<f64>> = (0..candidates).map(|k| harmonics(direction(k), band)[from..].to_vec()).collect();
    let mut chosen = Vec::with_capacity(width);
    for _ in 0..width {
        let norms = rows.iter().map(|row| dot(row, row));
        let Some((best, _)) = norms.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        chosen.push(direction(best));
        let pivot = rows[best].clone();
        let square = dot(&pivot, &pivot);
        for row in &mut rows {
            let part = dot(row, &pivot) / square;
            row.iter_mut().zip(&pivot).for_each(|(value, &p)| *value -= part * p);
        }
        rows[best].fill(0.0);
    }
    chosen
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A (A^T A)^-1 of a matrix A with at least as many rows as columns, row by row: Q R^-T of A = Q R.
fn transposed_pseudo_inverse(matrix: &[f64], width: usize) -> Vec<f64> {
    let height = matrix.len() / width;
    let mut columns: Vec<Vec<f64>> = (0..width).map(|j| (0..height).map(|k| matrix[k * width + j]).collect()).collect();
    // By columns.
    let mut upper = vec![vec![0.0; width]; width];
    for (j, entries) in upper.iter_mut().enumerate() {
        let (done, rest) = columns.split_at_mut(j);
        let column = &mut rest[0];
        // Gram and Schmidt, twice for the digits.
        for _ in 0..2 {
            for (i, other) in done.iter().enumerate() {
                let product = dot(column, other);
                entries[i] += product;
                column.iter_mut().zip(other).for_each(|(value, &o)| *value -= product * o);
            }
        }
        let norm = dot(column, column).sqrt();
        entries[j] = norm;
        for value in column.iter_mut() {
            *value /= norm;
        }
    }
    // X R^T = Q: the last column first.
    for j in (0..width).rev() {
        let (before, after) = columns.split_at_mut(j + 1);
        let column = &mut before[j];
        for (i, other) in after.iter().enumerate() {
            let factor = upper[j + 1 + i][j];
            column.iter_mut().zip(other).for_each(|(value, &o)| *value -= factor * o);
        }
        for value in column.iter_mut() {
            *value /= upper[j][j];
        }
    }
    let mut inverse = vec![0.0; matrix.len()];
    for (j, column) in columns.iter().enumerate() {
        for (k, &value) in column.iter().enumerate() {
            inverse[k * width + j] = value;
        }
    }
    inverse
}

#[cfg(test)]
mod tests;
