//! Real spherical harmonics, and series of them.
//!
//! `Y_lm` = `K_lm` `P_lm`(cos theta) times sqrt(2) cos(m phi) for m > 0, 1 for m = 0, sqrt(2) sin(|m| phi) for m < 0, orthonormal over the sphere, without the phase
//! of Condon and Shortley: `Y_00` = sqrt(1 / 4 pi), and `Y_1,-1`, `Y_10`, `Y_11` are sqrt(3 / 4 pi) times y, z, x. The index of `Y_lm` is l (l + 1) + m.

use glam::DVec3;
use std::f64::consts::{PI, SQRT_2};

/// How many harmonics there are to a band.
pub(crate) fn count(band: u16) -> usize {
    (usize::from(band) + 1) * (usize::from(band) + 1)
}

/// The index of `Y_lm`, |m| <= l.
pub(crate) fn index(l: u16, m: i32) -> usize {
    (i32::from(l) * (i32::from(l) + 1) + m) as usize
}

/// All real spherical harmonics of a unit `direction` to that band: (band + 1)^2 numbers, that of `Y_lm` at l (l + 1) + m.
///
/// Their errors are a few times l units of 1e-16. O(band^2).
///
/// ```
/// let values = nusselt::integral::harmonics(glam::DVec3::Z, 1);
/// let expected = [1.0, 0.0, 3.0, 0.0].map(|square: f64| (square / (4.0 * std::f64::consts::PI)).sqrt());
/// assert!(values.iter().zip(expected).all(|(v, e)| (v - e).abs() < 1e-15));
/// ```
pub fn harmonics(direction: DVec3, band: u16) -> Vec<f64> {
    let mut values = vec![0.0; count(band)];
    let z = direction.z;
    // K_mm P_mm over sin^m, and (x + i y)^m.
    let mut sectoral = (0.25 / PI).sqrt();
    let (mut cosine, mut sine) = (1.0, 0.0);
    for m in 0..=band {
        let order = f64::from(m);
        if m > 0 {
            sectoral *= ((2.0 * order + 1.0) / (2.0 * order)).sqrt();
            (cosine, sine) = (direction.x * cosine - direction.y * sine, direction.x * sine + direction.y * cosine);
        }
        let (mut before, mut value) = (0.0, sectoral);
        for l in m..=band {
            if l > m {
                let next = (z * value - ladder(l - 1, m) * before) / ladder(l, m);
                (before, value) = (value, next);
            }
            if m == 0 {
                values[index(l, 0)] = value;
            } else {
                values[index(l, i32::from(m))] = SQRT_2 * value * cosine;
                values[index(l, -i32::from(m))] = SQRT_2 * value * sine;
            }
        }
    }
    values
}

/// z `Y_lm` = ladder(l + 1) `Y_(l+1)m` + ladder(l) `Y_(l-1)m`, with ladder(l)^2 = (l^2 - m^2) / (4 l^2 - 1).
fn ladder(l: u16, m: u16) -> f64 {
    let (l, m) = (f64::from(l), f64::from(m));
    ((l * l - m * m) / (4.0 * l * l - 1.0)).sqrt()
}

/// A function on the sphere as a series of real spherical harmonics, in three colours.
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonics {
    band: u16,
    coefficients: Vec<DVec3>,
}

impl Harmonics {
    /// To that band, of (band + 1)^2 coefficients, that of `Y_lm` at l (l + 1) + m; of any other number it is `None`.
    pub fn new(band: u16, coefficients: Vec<DVec3>) -> Option<Self> {
        (coefficients.len() == count(band)).then_some(Self { band, coefficients })
    }

    /// The highest l.
    pub fn band(&self) -> u16 {
        self.band
    }

    /// The coefficient of `Y_lm` at l (l + 1) + m.
    pub fn coefficients(&self) -> &[DVec3] {
        &self.coefficients
    }

    /// The value in a unit direction. O(band^2).
    pub fn eval(&self, direction: DVec3) -> DVec3 {
        harmonics(direction, self.band).iter().zip(&self.coefficients).map(|(&value, &c)| c * value).sum()
    }

    /// The same function times the direction's z: a series of one band more, exact but for rounding.
    #[must_use]
    pub fn times_z(&self) -> Self {
        let mut coefficients = vec![DVec3::ZERO; count(self.band + 1)];
        for l in 0..=self.band {
            for m in -i32::from(l)..=i32::from(l) {
                let coefficient = self.coefficients[index(l, m)];
                let order = m.unsigned_abs() as u16;
                coefficients[index(l + 1, m)] += coefficient * ladder(l + 1, order);
                if order < l {
                    coefficients[index(l - 1, m)] += coefficient * ladder(l, order);
                }
            }
        }
        Self { band: self.band + 1, coefficients }
    }

    /// The coefficients of band l.
    pub(super) fn band_of(&self, l: u16) -> &[DVec3] {
        &self.coefficients[usize::from(l) * usize::from(l)..count(l)]
    }
}

#[cfg(test)]
mod tests {
    use super::{Harmonics, count, harmonics, index};
    use crate::integral::brute::brute;
    use glam::DVec3;

    fn directions() -> Vec<DVec3> {
        let mut all = vec![DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        all.extend((0..50).map(|k| {
            let t = f64::from(k);
            DVec3::new((t * 1.3).sin(), (t * 0.7).cos(), (t * 2.1).sin()).normalize()
        }));
        all
    }

    #[test]
    fn the_first_bands_are_as_written_out() {
        for u in directions() {
            let [a, b] = [(3.0 / (4.0 * std::f64::consts::PI)).sqrt(), (15.0 / (4.0 * std::f64::consts::PI)).sqrt()];
            let c = b / 3.0_f64.sqrt() / 2.0;
            let band2 = [b * u.x * u.y, b * u.y * u.z, c * (3.0 * u.z * u.z - 1.0), b * u.x * u.z];
            let last = 0.5 * b * (u.x * u.x - u.y * u.y);
            let expected = [a * u.y, a * u.z, a * u.x].into_iter().chain(band2).chain([last]);
            for (value, expected) in harmonics(u, 2).into_iter().skip(1).zip(expected) {
                assert!((value - expected).abs() < 1e-15, "{u}: {value} {expected}");
            }
        }
    }

    #[test]
    fn the_sum_of_squares_of_a_band_is_constant() {
        // Unsoeld's theorem.
        for u in directions() {
            let values = harmonics(u, 66);
            for l in 0..=66_u16 {
                let band = &values[usize::from(l * l)..count(l)];
                let sum: f64 = band.iter().map(|y| y * y).sum();
                let expected = f64::from(2 * l + 1) / (4.0 * std::f64::consts::PI);
                assert!((sum - expected).abs() < 1e-13 * expected * f64::from(l + 1), "{l}: {sum} {expected}");
            }
        }
    }

    #[test]
    fn they_are_orthonormal() {
        let octants: Vec<[DVec3; 3]> = (0..8)
            .map(|k| {
                let sign = |bit: i32| if k >> bit & 1 == 0 { 1.0 } else { -1.0 };
                let [x, y, z] = [DVec3::X * sign(0), DVec3::Y * sign(1), DVec3::Z * sign(2)];
                if x.cross(y).dot(z) > 0.0 { [x, y, z] } else { [y, x, z] }
            })
            .collect();
        for i in 0..count(4) {
            for j in (0..=i).step_by(3) {
                let product = |u| {
                    let values = harmonics(u, 4);
                    DVec3::splat(values[i] * values[j])
                };
                let sum: f64 = octants.iter().map(|octant| brute(octant, DVec3::X, 1.0, &product).x).sum();
                let expected = f64::from(u8::from(i == j));
                assert!((sum - expected).abs() < 1e-12, "{i} {j}: {sum}");
            }
        }
    }

    #[test]
    fn times_z_is_that() {
        let coefficients = (0..count(9)).map(|k| DVec3::new((k as f64).sin(), (k as f64 * 2.3).cos(), 1.0)).collect();
        let series = Harmonics::new(9, coefficients).unwrap();
        let product = series.times_z();
        for u in directions() {
            let off = product.eval(u) - series.eval(u) * u.z;
            assert!(off.abs().max_element() < 1e-13, "{off}");
        }
        assert!(Harmonics::new(2, vec![DVec3::ZERO; 8]).is_none());
        assert_eq!(index(3, -3), 9);
    }
}
