//! Against Stokes' theorem, cubature, and what is known.

use super::{Axes, ZonalSum};
use crate::integral::brute::{brute, gauss};
use crate::integral::clip::unit_outline;
use crate::integral::harmonics::{Harmonics, count, harmonics, index};
use crate::integral::{clip, solid_angle};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Numbers that look random and are always the same.
fn series(band: u16, seed: f64) -> Harmonics {
    let noise = |k: f64| (k * 12.9898 + seed * 78.233).sin() * 43_758.545_3;
    let coefficient = |k: usize| {
        let t = k as f64 * 3.0;
        DVec3::new(noise(t).fract(), noise(t + 1.0).fract(), noise(t + 2.0).fract())
    };
    Harmonics::new(band, (0..count(band)).map(coefficient).collect()).unwrap()
}

fn regular(centre: DVec3, radius: f64, corners: u32) -> Vec<DVec3> {
    let (x, y) = centre.any_orthonormal_pair();
    let corner = |j: u32| {
        let (sin, cos) = (f64::from(j) * TAU / f64::from(corners)).sin_cos();
        centre * radius.cos() + (x * cos + y * sin) * radius.sin()
    };
    (0..corners).map(corner).collect()
}

/// The integral by Stokes' theorem: a harmonic of band l is -1 / (l (l + 1)) times its Laplacian, so its integral is that
/// times the flux of its gradient through the rim, here by Gauss' rule on short pieces and by differences across the rim. It shares nothing with zonal integrals.
fn by_stokes(series: &Harmonics, polygon: &[DVec3]) -> DVec3 {
    let band = series.band();
    let potential: Vec<DVec3> = (0..=band)
        .flat_map(|l| {
            let scale = if l == 0 { 0.0 } else { -1.0 / (f64::from(l) * f64::from(l + 1)) };
            let series = &series;
            (-i32::from(l)..=i32::from(l)).map(move |m| series.coefficients()[index(l, m)] * scale)
        })
        .collect();
    let potential = Harmonics::new(band, potential).unwrap();
    let outline = unit_outline(polygon);
    let mut sum = series.coefficients()[0] * ((0.25 / PI).sqrt() * solid_angle(&outline));
    for k in 0..outline.len() {
        let [a, b] = [outline[k], outline[(k + 1) % outline.len()]];
        let normal = a.cross(b).normalize();
        let along = normal.cross(a);
        let theta = a.cross(b).length().atan2(a.dot(b));
        let pieces = (theta * f64::from(band) / 2.0).ceil().max(1.0);
        for piece in 0..pieces as u32 {
            for (s, weight) in gauss() {
                let (sin, cos) = (theta * (f64::from(piece) + s) / pieces).sin_cos();
                let point = a * cos + along * sin;
                // The derivative inwards by differences of order 8.
                let step = 0.02 / f64::from(band.max(4));
                let ends = |j: f64| {
                    let (sin, cos) = (step * j).sin_cos();
                    potential.eval(point * cos + normal * sin) - potential.eval(point * cos - normal * sin)
                };
                let slope =
                    (ends(1.0) * (4.0 / 5.0) - ends(2.0) / 5.0 + ends(3.0) * (4.0 / 105.0) - ends(4.0) / 280.0) / step;
                sum -= slope * (weight * theta / pieces);
            }
        }
    }
    sum
}

#[test]
fn integrals_are_what_stokes_theorem_gives() {
    let mut over = f64::INFINITY;
    for band in [0, 1, 2, 5, 9, 17, 33, 65] {
        let mut worst = 0.0_f64;
        let mut largest_bound = 0.0_f64;
        for (k, radius) in [1e-3_f64, 0.05, 0.4, 1.1, 1.5].into_iter().enumerate() {
            let t = k as f64;
            let centre = DVec3::new((t * 1.3).sin(), (t * 0.7).cos(), 0.4 - 0.1 * t).normalize();
            let polygon = regular(centre, radius, 3 + k as u32);
            let series = series(band, t);
            let sum = ZonalSum::new(&series).unwrap();
            let integral = sum.integral(&polygon);
            let expected = by_stokes(&series, &polygon);
            let off = (integral.value - expected).abs().max_element();
            // Differences of values with an error of 1e-16 times their size, over a step.
            let slack = 4e-13 * f64::from(band + 1).powi(2) * radius;
            assert!(off <= integral.error.min_element() + slack, "{band} {radius}: {off:e} for {integral:?}");
            worst = worst.max(off / sum.largest.max_element());
            largest_bound = largest_bound.max(integral.error.max_element() / sum.largest.max_element());
            over = over.min(integral.error.max_element() / sum.largest.max_element());
        }
        println!("band {band}: off by {worst:.1e}, bounds to {largest_bound:.1e} of the largest value");
        // As documented.
        assert!(largest_bound < if band < 10 { 1e-12 } else { 1e-10 }, "{band}: {largest_bound:e}");
    }
    assert!(over > 0.0);
}

#[test]
fn cutting_a_polygon_changes_nothing() {
    // The two halves' errors have nothing to do with that of the whole: a test of the bounds at rounding level.
    for band in [3, 9, 17, 33, 65] {
        let series = series(band, 7.0);
        let sum = ZonalSum::new(&series).unwrap();
        let mut nearest = 0.0_f64;
        for k in 0..20 {
            let t = f64::from(k);
            let centre = DVec3::new((t * 1.3).sin(), (t * 0.7).cos(), (t * 2.9).sin()).normalize();
            let polygon = unit_outline(&regular(centre, 0.05 + 0.07 * t, 3 + k % 4));
            let cut = DVec3::new((t * 0.9).cos(), (t * 1.9).sin(), (t * 0.4).cos()).cross(centre).normalize();
            let whole = sum.integral(&polygon);
            let [one, other] = [clip(&polygon, cut), clip(&polygon, -cut)].map(|half| sum.integral(&half));
            let off = (whole.value - one.value - other.value).abs();
            let allowed = whole.error + one.error + other.error;
            assert!(off.cmple(allowed).all(), "{band}: {off} for {allowed}");
            nearest = nearest.max((off / allowed).max_element());
        }
        println!("band {band}: {nearest:.1e} of the bounds");
    }
}

#[test]
fn integrals_are_what_cubature_gives() {
    let series = series(8, 3.0);
    let polygon = regular(DVec3::new(0.3, -0.2, 0.8).normalize(), 0.7, 5);
    let expected = brute(&polygon, DVec3::Z, 0.3, &|u| series.eval(u));
    let integral = ZonalSum::new(&series).unwrap().integral(&polygon);
    // Of the brute force, with its very many terms.
    assert!((integral.value - expected).abs().cmple(integral.error + 1e-13).all(), "{integral:?} {expected}");
}

#[test]
fn axes_are_independent() {
    for band in [0, 1, 4, 9, 17, 33, 65] {
        let axes = Axes::of(band);
        assert_eq!(axes.directions.len(), 2 * usize::from(band) + 1);
        for (l, (values, inverse)) in axes.values.iter().zip(&axes.inverses).enumerate() {
            let width = 2 * l + 1;
            for i in 0..width {
                for j in 0..width {
                    let product: f64 = values.chunks(width).zip(inverse.chunks(width)).map(|(a, b)| a[i] * b[j]).sum();
                    assert!((product - f64::from(u8::from(i == j))).abs() < 1e-11, "{band} {l} {i} {j}: {product}");
                }
            }
        }
        let norm = |rows: &[f64]| rows.iter().map(|v| v * v).sum::<f64>().sqrt();
        let last = usize::from(band);
        let condition = norm(&axes.values[last]) * norm(&axes.inverses[last]) / f64::from(2 * band + 1);
        println!("band {band}: condition {condition:.1}");
        assert!(condition < 20.0, "{condition}");
    }
    assert_eq!(harmonics(DVec3::Z, 3).len(), count(3));
}

#[test]
fn what_cannot_be_integrated_is_none() {
    assert!(ZonalSum::new(&series(66, 0.0)).is_none());
    let bad = Harmonics::new(0, vec![DVec3::new(0.0, f64::NAN, 0.0)]).unwrap();
    assert!(ZonalSum::new(&bad).is_none());
    let sum = ZonalSum::new(&series(3, 0.0)).unwrap();
    assert_eq!(sum.integral(&[]).value, DVec3::ZERO);
    assert_eq!(sum.integral(&[DVec3::X, DVec3::NAN, DVec3::X]).value, DVec3::ZERO);
}
