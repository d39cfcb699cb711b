//! The sign of the volume that a closed surface encloses.

use super::super::flat::unit_scale;
use crate::exact::{Sign, U};
use glam::DVec3;
use num_bigint::{BigInt, Sign as BigSign};

/// The volume inside of a closed surface, given as triangles whose sides cancel: positive if they run counter-clockwise
/// seen from outside. The sign is exact, the number is rounded.
pub(super) fn volume(triangles: &[[DVec3; 3]]) -> (Sign, f64) {
    let Some(&[origin, ..]) = triangles.first() else { return (Sign::Zero, 0.0) };
    // Halves have finite differences.
    let offset = |p: DVec3| p * 0.5 - origin * 0.5;
    let scale = unit_scale(triangles.iter().flatten().map(|&p| offset(p)));
    let (mut sum, mut permanents) = (0.0, 0.0);
    for corners in triangles {
        let [a, b, c] = corners.map(|p| offset(p) * scale);
        sum += a.dot(b.cross(c));
        let [a, b, c] = [a, b, c].map(DVec3::abs);
        let across = DVec3::new(b.y * c.z + b.z * c.y, b.z * c.x + b.x * c.z, b.x * c.y + b.y * c.x);
        permanents += a.dot(across);
    }
    // An offset is off by u relatively, a product of three by 3 u more with its additions by 6 u, a sum of n of them by n u.
    let bound = (16 + triangles.len()) as f64 * 2.0 * U * permanents;
    // The volume in scene units: 1/6 of the determinants, of offsets that are halves.
    let length = 2.0 / scale;
    let size = (sum.abs() / 6.0 * length * length * length).min(f64::MAX);
    // Below that, what underflowed might count.
    let sign = if permanents > 1e-250 && sum.abs() > bound { Sign::of(sum) } else { exact_sign(triangles) };
    (sign, if sign.is_zero() { 0.0 } else { size.copysign(f64::from(sign as i8)) })
}

/// By integers on the grid of all coordinates.
fn exact_sign(triangles: &[[DVec3; 3]]) -> Sign {
    let coordinates = || triangles.iter().flatten().flat_map(DVec3::to_array).filter(|&x| x != 0.0);
    let Some(least) = coordinates().map(|x| parts(x).1).min() else { return Sign::Zero };
    let on_grid = |x: f64| {
        let (mantissa, exponent) = parts(x);
        if mantissa == 0 { BigInt::ZERO } else { BigInt::from(mantissa) << (exponent - least) }
    };
    let mut sum = BigInt::ZERO;
    for corners in triangles {
        let [a, b, c] = corners.map(|p| p.to_array().map(on_grid));
        sum += &a[0] * (&b[1] * &c[2] - &b[2] * &c[1]);
        sum += &a[1] * (&b[2] * &c[0] - &b[0] * &c[2]);
        sum += &a[2] * (&b[0] * &c[1] - &b[1] * &c[0]);
    }
    match sum.sign() {
        BigSign::Minus => Sign::Negative,
        BigSign::NoSign => Sign::Zero,
        BigSign::Plus => Sign::Positive,
    }
}

/// A number as an integer times a power of two.
fn parts(x: f64) -> (i64, i32) {
    let bits = x.abs().to_bits();
    let (field, fraction) = ((bits >> 52) as i32, (bits & ((1 << 52) - 1)) as i64);
    let (mantissa, exponent) = if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
    (if x < 0.0 { -mantissa } else { mantissa }, exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron(height: f64, scale: f64, offset: DVec3) -> Vec<[DVec3; 3]> {
        let [a, b, c, d] =
            [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.25, 0.25, height)].map(|p| p * scale + offset);
        vec![[a, c, b], [a, b, d], [b, c, d], [c, a, d]]
    }

    #[test]
    fn volumes_are_those_of_tetrahedra() {
        for scale in [1e-90, 1.0, 2f64.powi(300)] {
            let (sign, size) = volume(&tetrahedron(3.0, scale, DVec3::ZERO));
            assert_eq!(sign, Sign::Positive);
            assert!((size / (0.5 * scale * scale * scale) - 1.0).abs() < 1e-14, "{size:e}");
        }
        assert_eq!(volume(&tetrahedron(-1.0, 1.0, DVec3::ONE)).0, Sign::Negative);
    }

    #[test]
    fn signs_are_exact_where_hardly_any_volume_is_left() {
        for height in [5e-324, 1e-300, 1e-30, 1e-17] {
            for (height, sign) in [(height, Sign::Positive), (-height, Sign::Negative)] {
                assert_eq!(volume(&tetrahedron(height, 1.0, DVec3::ZERO)).0, sign, "{height:e}");
            }
        }
        assert_eq!(volume(&tetrahedron(0.0, 1.0, DVec3::splat(0.1))), (Sign::Zero, 0.0));
        assert_eq!(volume(&tetrahedron(1.0, 1e308, DVec3::ZERO)).0, Sign::Positive);
        assert_eq!(volume(&[]), (Sign::Zero, 0.0));
    }
}
