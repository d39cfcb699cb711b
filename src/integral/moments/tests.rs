//! Moments against closed forms and brute force; what error they state against the true one.

use super::{Estimate, axial_moment, double_axis_moment};
use crate::integral::brute::brute;
use crate::integral::{form_factor, solid_angle};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const HEMISPHERE: [DVec3; 4] = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];

fn at(zenith: f64, azimuth: f64) -> DVec3 {
    DVec3::new(zenith.sin() * azimuth.cos(), zenith.sin() * azimuth.sin(), zenith.cos())
}

/// A convex polygon of that radius about a direction.
fn polygon(centre: DVec3, radius: f64, corners: u32) -> Vec<DVec3> {
    let (x, y) = centre.any_orthonormal_pair();
    let corner = |k: u32| {
        let (sin, cos) = (0.4 + f64::from(k) * TAU / f64::from(corners)).sin_cos();
        centre * radius.cos() + (x * cos + y * sin) * radius.sin()
    };
    (0..corners).map(corner).collect()
}

fn within(moment: Estimate, expected: f64, slack: f64) {
    let off = (moment.value - expected).abs();
    assert!(off <= moment.error + slack, "{moment:?} instead of {expected:e}: off by {off:e}");
}

#[test]
fn hemispheres_have_closed_forms() {
    for n in [0_u16, 1, 2, 3, 4, 7, 16, 101, 512, 2048, 65535] {
        let [n_plus_1, n_plus_2] = [f64::from(n) + 1.0, f64::from(n) + 2.0];
        within(axial_moment(&HEMISPHERE, DVec3::Z, n), TAU / n_plus_1, 0.0);
        within(double_axis_moment(&HEMISPHERE, DVec3::Z, n, DVec3::Z), TAU / n_plus_2, 0.0);
        for tilt in [0.1, 1.0, FRAC_PI_2 - 0.1] {
            // Tilted wholly out of the hemisphere about the axis: the lune is symmetric, so M_1 is half the flux.
            let lune = axial_moment(&HEMISPHERE, at(tilt, 0.3), 1).value;
            assert!((lune - FRAC_PI_2 * (1.0 + tilt.cos())).abs() < 1e-14);
        }
        // An axis on the horizon: half of its lobe is above it.
        within(axial_moment(&HEMISPHERE, DVec3::X, n), PI / n_plus_1, 0.0);
    }
}

#[test]
fn the_zeroth_and_first_moments_are_solid_angle_and_flux() {
    for radius in [1e-3, 0.1, 0.7] {
        let shape = polygon(at(0.6, 1.0), radius, 5);
        let [w, v] = [at(0.3, 2.0), at(0.1, -1.0)];
        within(axial_moment(&shape, w, 0), solid_angle(&shape), 0.0);
        within(axial_moment(&shape, w, 1), PI * form_factor(&shape, w), 0.0);
        within(double_axis_moment(&shape, w, 0, v), PI * form_factor(&shape, v), 0.0);
    }
}

#[test]
fn moments_are_what_cubature_gives() {
    let mut worst = 0.0_f64;
    let mut largest_error = 0.0_f64;
    for n in [0_u16, 1, 2, 5, 32, 200, 512, 2048] {
        for radius in [5e-4, 0.02, 0.3, 0.8, 1.3] {
            for (k, off) in [0.0_f64, 0.3, 0.9, 1.4].into_iter().enumerate() {
                let azimuth = k as f64 + f64::from(n);
                let w = at(0.2 + 0.3 * k as f64, azimuth);
                let v = at(0.2, azimuth + 1.0);
                let shape =
                    polygon((w + at(FRAC_PI_2, azimuth) * off.tan().min(4.0)).normalize(), radius, 3 + k as u32);
                let clipped = super::clip(&super::clip(&super::unit_outline(&shape), w), v);
                let power = i32::from(n);
                let lobe = |u: DVec3| DVec3::new(w.dot(u).powi(power), w.dot(u).powi(power) * v.dot(u), 0.0);
                let expected = brute(&clipped, w, 3.0 / f64::from(n).sqrt().max(1.0), &lobe);
                let double = double_axis_moment(&shape, w, n, v);
                // Brute force sums millions of terms: a relative 1e-13.
                within(double, expected.y, 1e-13 * expected.y);
                worst = worst.max((double.value - expected.y).abs());
                largest_error = largest_error.max(double.error);
                let whole = super::clip(&super::unit_outline(&shape), w);
                let expected = brute(&whole, w, 3.0 / f64::from(n).sqrt().max(1.0), &lobe).x;
                within(axial_moment(&shape, w, n), expected, 1e-13 * expected);
            }
        }
    }
    println!("worst {worst:e}, largest stated error {largest_error:e}");
    assert!(worst < 2e-14 && largest_error < 1e-13, "worst {worst:e}, largest stated error {largest_error:e}");
}

#[test]
fn parts_add_up_to_the_whole() {
    for n in [3_u16, 40, 1000] {
        let w = at(0.5, 0.2);
        let whole = double_axis_moment(&HEMISPHERE, w, n, DVec3::Z);
        let mut sum = 0.0;
        for k in 0..8 {
            let [a, b] = [k, k + 1].map(|k| at(FRAC_PI_2, f64::from(k) * TAU / 8.0));
            let [c, d] = [a, b].map(|p| (p + DVec3::Z * 0.7).normalize());
            sum += double_axis_moment(&[a, b, d, c], w, n, DVec3::Z).value;
            sum += double_axis_moment(&[c, d, DVec3::Z], w, n, DVec3::Z).value;
        }
        assert!((sum - whole.value).abs() < 16.0 * 1e-14, "{sum} instead of {whole:?}");
    }
}

#[test]
fn the_back_of_a_lobe_is_cut_off() {
    let below = polygon(at(2.5, 0.0), 0.2, 4);
    for n in [0_u16, 1, 2, 3] {
        assert_eq!(axial_moment(&below, DVec3::Z, n), Estimate::default());
        assert_eq!(double_axis_moment(&below, -DVec3::Z, n, DVec3::Z), Estimate::default());
    }
}

#[test]
fn nonsense_has_no_moment() {
    for bad in [DVec3::ZERO, DVec3::NAN, DVec3::splat(f64::INFINITY)] {
        assert_eq!(axial_moment(&HEMISPHERE, bad, 3), Estimate::default());
        assert_eq!(double_axis_moment(&HEMISPHERE, DVec3::Z, 3, bad), Estimate::default());
        let _ = double_axis_moment(&[DVec3::X, bad, DVec3::Z], DVec3::Z, 3, DVec3::Z);
    }
    assert_eq!(double_axis_moment(&[], DVec3::Z, 3, DVec3::Z), Estimate::default());
    assert!(axial_moment(&[DVec3::X, DVec3::X], DVec3::Z, 2).value.abs() < f64::MIN_POSITIVE);
}
