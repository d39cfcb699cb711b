//! BRDFs as series of spherical harmonics.

mod project;
#[cfg(test)]
mod tests;

pub use project::ShProjection;

use super::{Brdf, BrdfError, Form};
use crate::integral::{Harmonics, harmonic_count, harmonic_index, harmonics};
use glam::DVec3;

/// What a table of coefficients holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShSymmetry {
    /// The BRDF depends on the difference of the azimuths only, and not on its sign: a coefficient `c_mlk` for every order m and bands l and k of the
    /// incoming and the outgoing direction, from m to the table's band.
    Isotropic,
    /// Anything: a coefficient for every pair of harmonics.
    General,
}

impl ShSymmetry {
    /// The highest band of a table.
    pub fn highest_band(self) -> u16 {
        match self {
            Self::Isotropic => 64,
            Self::General => 16,
        }
    }

    /// How many coefficients a table to that band has.
    pub fn count(self, band: u16) -> usize {
        let n = usize::from(band) + 1;
        match self {
            Self::Isotropic => n * (n + 1) * (2 * n + 1) / 6,
            Self::General => n * n * n * n,
        }
    }
}

/// A BRDF as a series of real spherical harmonics of both directions (Westin, Arvo and Torrance, "Predicting reflectance functions from complex surfaces",
/// SIGGRAPH 1992), without the cosine: sum of `c_ij` `Y_i(u)` `Y_j(v)`, with the harmonics of [`harmonics`](crate::integral::harmonics()).
///
/// Integrals over polygons are in closed form with a bound on their error, the cosine included exactly. *A truncated series may be negative* here and there, and
/// so may its integral over a small polygon: clamping would make it something else that has no closed form. That it reflects no more than it gets is up to whoever made it.
///
/// [`ShBrdf::project`] makes one of another BRDF; `io::read_sh` reads one from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ShBrdf {
    band: u16,
    symmetry: ShSymmetry,
    coefficients: Vec<DVec3>,
    is_reciprocal: bool,
}

/// Coefficients are not larger than that.
const LARGEST: f64 = 1e12;

impl ShBrdf {
    /// Of a table of [`ShSymmetry::count`] coefficients in sr^-1, to a band of at most [`ShSymmetry::highest_band`]. See [`ShBrdf::index_isotropic`] and
    /// [`ShBrdf::index_general`] for their order.
    ///
    /// # Errors
    /// If the band is too high, the number of coefficients is another one, or one is not finite or larger than 1e12.
    pub fn new(symmetry: ShSymmetry, band: u16, coefficients: Vec<DVec3>) -> Result<Self, BrdfError> {
        if band > symmetry.highest_band() {
            return Err(BrdfError::HighBand { band, highest: symmetry.highest_band() });
        }
        let expected = symmetry.count(band);
        if coefficients.len() != expected {
            return Err(BrdfError::BadTable { count: coefficients.len(), expected });
        }
        if let Some((index, &value)) = coefficients.iter().enumerate().find(|(_, c)| !is_usable(**c)) {
            return Err(BrdfError::BadCoefficient { index, value });
        }
        let mut table = Self { band, symmetry, coefficients, is_reciprocal: false };
        table.is_reciprocal = (0..expected).all(|k| table.coefficients[k] == table.coefficients[table.exchanged(k)]);
        Ok(table)
    }

    /// The highest l.
    pub fn band(&self) -> u16 {
        self.band
    }

    /// What the table holds.
    pub fn symmetry(&self) -> ShSymmetry {
        self.symmetry
    }

    /// The table.
    pub fn coefficients(&self) -> &[DVec3] {
        &self.coefficients
    }

    /// Where `c_mlk` is in an isotropic table to that band, m <= l, k <= band: by ascending m, then l, then k. It is the factor of
    /// `Y_lm(u)` `Y_km(v)` + `Y_l,-m(u)` `Y_k,-m(v)`, or of `Y_l0(u)` `Y_k0(v)`.
    pub fn index_isotropic(band: u16, m: u16, l: u16, k: u16) -> usize {
        let n = usize::from(band) + 1;
        // The squares of n, n - 1, ... for the orders before.
        let before: usize = ShSymmetry::Isotropic.count(band) - sum_of_squares(n - usize::from(m));
        let width = n - usize::from(m);
        before + usize::from(l - m) * width + usize::from(k - m)
    }

    /// Where the factor of `Y_lm(u)` `Y_kn(v)` is in a general table to that band, |m| <= l and |n| <= k.
    pub fn index_general(band: u16, (l, m): (u16, i32), (k, n): (u16, i32)) -> usize {
        harmonic_index(l, m) * harmonic_count(band) + harmonic_index(k, n)
    }

    /// The function of the incoming direction that is left for an outgoing one, both over the whole sphere. O(number of coefficients).
    pub fn series(&self, outgoing: DVec3) -> Harmonics {
        let values = harmonics(outgoing, self.band);
        let mut series = vec![DVec3::ZERO; values.len()];
        match self.symmetry {
            ShSymmetry::General => {
                for (sum, row) in series.iter_mut().zip(self.coefficients.chunks(values.len())) {
                    *sum = row.iter().zip(&values).map(|(&c, &y)| c * y).sum();
                }
            }
            ShSymmetry::Isotropic => {
                let mut rest = &self.coefficients[..];
                for m in 0..=self.band {
                    for l in m..=self.band {
                        let (row, after) = rest.split_at(usize::from(self.band - m) + 1);
                        rest = after;
                        let order = i32::from(m);
                        for order in if m == 0 { vec![0] } else { vec![order, -order] } {
                            let of = |k: u16| values[harmonic_index(k, order)];
                            series[harmonic_index(l, order)] = (m..).zip(row).map(|(k, &c)| c * of(k)).sum();
                        }
                    }
                }
            }
        }
        Harmonics::new(self.band, series).unwrap_or_else(|| unreachable!("one coefficient a harmonic"))
    }

    /// Where the coefficient is whose directions are exchanged.
    fn exchanged(&self, at: usize) -> usize {
        match self.symmetry {
            ShSymmetry::General => {
                let count = harmonic_count(self.band);
                at % count * count + at / count
            }
            ShSymmetry::Isotropic => {
                let n = usize::from(self.band) + 1;
                let all = self.coefficients.len();
                let width = (1..=n).rev().find(|&width| all - sum_of_squares(width - 1) > at).unwrap_or(1);
                let first = all - sum_of_squares(width);
                first + (at - first) % width * width + (at - first) / width
            }
        }
    }
}

/// 1 + 4 + 9 + ... + n^2.
fn sum_of_squares(n: usize) -> usize {
    n * (n + 1) * (2 * n + 1) / 6
}

/// True if a coefficient is a number of a size with which sums stay finite.
pub(crate) fn is_usable(coefficient: DVec3) -> bool {
    coefficient.abs().cmple(DVec3::splat(LARGEST)).all()
}

impl Brdf for ShBrdf {
    /// The series as it is, which may be negative. O(number of coefficients).
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        if super::are_above(incoming, outgoing) { self.series(outgoing).eval(incoming) } else { DVec3::ZERO }
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        Form::Harmonics(self.series(outgoing))
    }

    /// True if the table is its own transpose.
    fn is_reciprocal(&self) -> bool {
        self.is_reciprocal
    }
}
