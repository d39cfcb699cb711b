//! Projections of BRDFs onto spherical harmonics.
//!
//! A BRDF is given above the horizon only. It is taken to be mirrored at it: then harmonics with odd l + m do not occur, and those with even l + m, times sqrt(2),
//! are orthonormal over the hemisphere. So of all series in them the projection is the nearest in the mean square over both hemispheres.

use super::{ShBrdf, ShSymmetry};
use crate::brdf::{Brdf, BrdfError, Form};
use crate::integral::{harmonic_count, harmonic_index, harmonics};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// A BRDF as a series, and how far it is from what it was made of.
#[derive(Clone, Debug)]
pub struct ShProjection {
    /// The series.
    pub brdf: ShBrdf,
    /// The root mean square of the difference over pairs of directions above the surface, in sr^-1, sampled at 4,096 of them.
    pub rms_error: DVec3,
    /// The largest difference there, in sr^-1.
    pub largest_error: DVec3,
    /// The root mean square of the BRDF there, in sr^-1.
    pub rms: DVec3,
}

impl ShBrdf {
    /// The nearest series, in the mean square, of a BRDF (Westin, Arvo and Torrance 1992).
    ///
    /// With [`ShSymmetry::Isotropic`] the outgoing direction's azimuth is 0 for all samples, so of an anisotropic model only that is seen; the stated
    /// errors tell. They are of samples that have nothing to do with those the coefficients are made from. A table of a reciprocal BRDF is exactly reciprocal.
    ///
    /// The coefficients are sums over product rules of 4 (band + 1) + 16 heights (general: 2 (band + 1) + 8) by as many azimuths over half a turn. Evaluations: isotropic
    /// 5e5 at band 16 and 2e7 at 64; general 1e6 at band 8 and 1e7 at 16.
    ///
    /// # Errors
    /// If the band is higher than [`ShSymmetry::highest_band`], or the BRDF has a mirror in it, which is no function, or is not finite somewhere.
    pub fn project(brdf: &dyn Brdf, symmetry: ShSymmetry, band: u16) -> Result<ShProjection, BrdfError> {
        if band > symmetry.highest_band() {
            return Err(BrdfError::HighBand { band, highest: symmetry.highest_band() });
        }
        let mut coefficients = match symmetry {
            ShSymmetry::Isotropic => isotropic(brdf, band)?,
            ShSymmetry::General => general(brdf, band)?,
        };
        let mut table = Self { band, symmetry, coefficients: Vec::new(), is_reciprocal: false };
        if brdf.is_reciprocal() {
            table.coefficients.clone_from(&coefficients);
            for (k, value) in coefficients.iter_mut().enumerate() {
                *value = 0.5 * (table.coefficients[k] + table.coefficients[table.exchanged(k)]);
            }
        }
        let table = Self::new(symmetry, band, coefficients)?;
        Ok(compared(brdf, table))
    }
}

fn compared(brdf: &dyn Brdf, table: ShBrdf) -> ShProjection {
    const SAMPLES: u32 = 4096;
    let [mut squares, mut off_squares, mut largest] = [DVec3::ZERO; 3];
    // A rank-1 lattice in four dimensions, of powers of the root of x^5 = x + 1 (Roberts).
    let step = [1.0, 2.0, 3.0, 4.0].map(|power| 1.167_303_978_261_418_7_f64.powf(-power));
    for k in 0..SAMPLES {
        let s = step.map(|step| (0.5 + f64::from(k) * step).fract());
        let direction = |z: f64, turn: f64| {
            let (sin, cos) = (TAU * turn).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            DVec3::new(radius * cos, radius * sin, z)
        };
        let [incoming, outgoing] = [direction(1.0 - s[0], s[1]), direction(1.0 - s[2], s[3])];
        let exact = brdf.eval(incoming, outgoing);
        let off = exact - table.eval(incoming, outgoing);
        squares += exact * exact;
        off_squares += off * off;
        largest = largest.max(off.abs());
    }
    let rms = |squares: DVec3| DVec3::from((squares / f64::from(SAMPLES)).to_array().map(f64::sqrt));
    ShProjection { brdf: table, rms_error: rms(off_squares), largest_error: largest, rms: rms(squares) }
}

/// True if a form has a part that is no function.
fn has_mirror(form: &Form<'_>, outgoing: DVec3) -> bool {
    match form {
        Form::Dirac { .. } => true,
        Form::Sum(parts) => parts.iter().any(|part| has_mirror(&part.form(outgoing), outgoing)),
        _ => false,
    }
}

/// A product rule over the hemisphere.
struct Grid {
    band: u16,
    /// Heights z in 0..1 with weights that sum to 1, and the harmonics of azimuth 0 there.
    heights: Vec<(f64, f64, Vec<f64>)>,
    /// Cosines and sines of azimuths.
    azimuths: Vec<(f64, f64)>,
}

impl Grid {
    fn new(band: u16, heights: usize, azimuths: usize) -> Self {
        let heights = gauss_legendre(heights)
            .into_iter()
            .map(|(z, weight)| (z, weight, harmonics(DVec3::new((1.0 - z * z).sqrt(), 0.0, z), band)))
            .collect();
        let azimuths = (0..azimuths).map(|k| {
            let (sin, cos) = (TAU * (k as f64 + 0.5) / azimuths as f64).sin_cos();
            (cos, sin)
        });
        Self { band, heights, azimuths: azimuths.collect() }
    }

    /// The coefficients of the mirrored function of the incoming direction for one outgoing direction.
    fn project(&self, brdf: &dyn Brdf, outgoing: DVec3) -> Result<Vec<DVec3>, BrdfError> {
        if has_mirror(&brdf.form(outgoing), outgoing) {
            return Err(BrdfError::NoFunction);
        }
        let mut coefficients = vec![DVec3::ZERO; harmonic_count(self.band)];
        // Those of cos(m phi) and of sin(m phi) at one height.
        let mut waves = vec![[DVec3::ZERO; 2]; usize::from(self.band) + 1];
        for (z, weight, values) in &self.heights {
            waves.fill([DVec3::ZERO; 2]);
            let radius = (1.0 - z * z).sqrt();
            for &(cos, sin) in &self.azimuths {
                let value = brdf.eval(DVec3::new(radius * cos, radius * sin, *z), outgoing);
                if !value.is_finite() {
                    return Err(BrdfError::NotFinite { outgoing });
                }
                let (mut real, mut imaginary) = (1.0, 0.0);
                for wave in &mut waves {
                    wave[0] += value * real;
                    wave[1] += value * imaginary;
                    (real, imaginary) = (real * cos - imaginary * sin, real * sin + imaginary * cos);
                }
            }
            // Twice, for the other half of the sphere.
            let scale = 2.0 * weight * TAU / self.azimuths.len() as f64;
            for (m, wave) in (0_u16..).zip(&waves) {
                let order = i32::from(m);
                for l in (m..=self.band).step_by(2) {
                    let value = scale * values[harmonic_index(l, order)];
                    coefficients[harmonic_index(l, order)] += wave[0] * value;
                    if m > 0 {
                        coefficients[harmonic_index(l, -order)] += wave[1] * value;
                    }
                }
            }
        }
        Ok(coefficients)
    }
}

fn isotropic(brdf: &dyn Brdf, band: u16) -> Result<Vec<DVec3>, BrdfError> {
    let count = 4 * (usize::from(band) + 1) + 16;
    let grid = Grid::new(band, count, 2 * count);
    let mut table = vec![DVec3::ZERO; ShSymmetry::Isotropic.count(band)];
    for (z, weight, values) in &grid.heights {
        let series = grid.project(brdf, DVec3::new((1.0 - z * z).sqrt(), 0.0, *z))?;
        for m in 0..=band {
            // Twice, for the other half of the sphere, times the integral of cos^2 over the azimuth.
            let scale = 2.0 * weight * if m == 0 { TAU } else { PI };
            for l in (m..=band).step_by(2) {
                let incoming = series[harmonic_index(l, i32::from(m))] * scale;
                for k in (m..=band).step_by(2) {
                    table[ShBrdf::index_isotropic(band, m, l, k)] += incoming * values[harmonic_index(k, i32::from(m))];
                }
            }
        }
    }
    Ok(table)
}

fn general(brdf: &dyn Brdf, band: u16) -> Result<Vec<DVec3>, BrdfError> {
    let count = 2 * (usize::from(band) + 1) + 8;
    let grid = Grid::new(band, count, 2 * count);
    let all = harmonic_count(band);
    let mut table = vec![DVec3::ZERO; all * all];
    for (z, weight, _) in &grid.heights {
        let radius = (1.0 - z * z).sqrt();
        for &(cos, sin) in &grid.azimuths {
            let outgoing = DVec3::new(radius * cos, radius * sin, *z);
            let series = grid.project(brdf, outgoing)?;
            let scale = 2.0 * weight * TAU / grid.azimuths.len() as f64;
            let mut values = harmonics(outgoing, band);
            for l in 0..=band {
                for m in -i32::from(l)..=i32::from(l) {
                    let is_even = (i32::from(l) + m) % 2 == 0;
                    values[harmonic_index(l, m)] *= if is_even { scale } else { 0.0 };
                }
            }
            for (row, &coefficient) in table.chunks_mut(all).zip(&series) {
                if coefficient != DVec3::ZERO {
                    row.iter_mut().zip(&values).for_each(|(sum, &value)| *sum += coefficient * value);
                }
            }
        }
    }
    Ok(table)
}

/// Points and weights of Gauss and Legendre on 0..1, by Newton's method.
pub(in crate::brdf) fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let rule = (0..count).map(|k| {
        let mut x = (PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for l in 2..=count {
                let l = l as f64;
                (before, value) = (value, ((2.0 * l - 1.0) * x * value - (l - 1.0) * before) / l);
            }
            slope = n * (before - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        (0.5 + 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    });
    rule.collect()
}
