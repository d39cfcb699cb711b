//! Estimates against the truth.

use super::{Cubature, CubatureOptions, Peak, Smoothness, integrate};
use crate::integral::brute::brute;
use crate::integral::clip::clip;
use crate::integral::random::{Random, Tally};
use crate::integral::{double_axis_moment, solid_angle};
use glam::DVec3;
use std::f64::consts::TAU;

#[test]
fn estimates_are_honest_for_powers_of_cosines() {
    let mut random = Random(1);
    let mut tally = Tally::new("powers of cosines");
    while tally.cases < 10_000 {
        let n = 2_f64.powf(random.between(0.0, 11.0)).round();
        let axis = random.direction();
        let width = 1.0 / n.sqrt();
        let polygon = clip(&random.polygon(axis, width), axis);
        // Cases without a value have nothing to tell.
        let truth = double_axis_moment(&polygon, axis, n as u16, DVec3::Z);
        if truth.value < 1e3 * truth.error {
            continue;
        }
        let options =
            CubatureOptions { relative: 10_f64.powf(random.between(-8.0, -2.0)), ..CubatureOptions::default() };
        let f = |u: DVec3| DVec3::splat(axis.dot(u).max(0.0).powi(n as i32) * u.z.max(0.0));
        let integral = integrate(f, &polygon, &[Peak { axis, width }], options);
        assert!(integral.error.x <= options.relative * integral.value.x, "{integral:?} for {options:?}");
        let off = (integral.value.x - truth.value).abs() - truth.error;
        tally.add(off.max(0.0), integral.error.x, integral.evaluations);
    }
    tally.check();
}

#[test]
fn estimates_are_honest_for_stretched_lobes() {
    // As of rough surfaces seen at grazing angles, with long tails; and with a kink across the lobe.
    let mut random = Random(2);
    let [mut smooth, mut kinked] = ["stretched lobes", "kinked lobes"].map(Tally::new);
    while smooth.cases < 500 {
        let axis = random.direction();
        let width = 10_f64.powf(random.between(-1.6, 0.0));
        let polygon = clip(&random.polygon(axis, width), axis);
        if solid_angle(&polygon) < 1e-7 {
            continue;
        }
        let (x, y) = axis.any_orthonormal_pair();
        let stretch = random.between(1.0, 4.0);
        let lobe = |u: DVec3| {
            let square =
                ((u.dot(x) / width).powi(2) + (u.dot(y) * stretch / width).powi(2)) / u.dot(axis).max(0.1).powi(2);
            u.z / (1.0 + square).powi(2)
        };
        let both = |u: DVec3| DVec3::new(lobe(u), lobe(u) * u.dot(x).abs() / width, 0.0);
        let options =
            CubatureOptions { relative: 10_f64.powf(random.between(-5.0, -2.0)), ..CubatureOptions::default() };
        let peak = [Peak { axis, width: width / stretch }];
        let one = integrate(|u| DVec3::splat(lobe(u)), &polygon, &peak, options);
        let mut kinks = Cubature::new(both, &peak, Smoothness::Kinked);
        kinks.add(&polygon, DVec3::ONE);
        let two = kinks.run(options);
        // A kink through the axis runs along the sides of halves: brute force takes both of them apart.
        let halves = [x, -x].map(|side| brute(&clip(&polygon, side), axis, width / stretch, &both));
        let truth = halves[0] + halves[1];
        // Of the brute force, with its very many terms.
        let rounding = 1e-13;
        smooth.add(((one.value.x - truth.x).abs() - rounding * truth.x).max(0.0), one.error.x, one.evaluations);
        kinked.add(((two.value.y - truth.y).abs() - rounding * truth.y).max(0.0), two.error.y, two.evaluations);
    }
    smooth.check();
    kinked.check();
}

#[test]
fn a_needle_in_a_hemisphere_is_found() {
    let hemisphere = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
    let axis = DVec3::new(0.3, 0.5, 0.7).normalize();
    for width in [1e-1, 1e-2, 1e-3, 1e-4] {
        let needle = |u: DVec3| DVec3::splat((-(u - axis).length_squared() / (2.0 * width * width)).exp());
        let integral = integrate(needle, &hemisphere, &[Peak { axis, width }], CubatureOptions::default());
        // In the variable t = |u - axis|^2 the element of solid angle is pi dt, to 4 at most.
        let exact = TAU * width * width * (1.0 - (-2.0 / (width * width)).exp());
        if width < 0.05 {
            assert!((integral.value.x - exact).abs() <= integral.error.x, "{integral:?} for {exact:e}");
        }
        assert!(integral.error.x <= 1e-6 * integral.value.x && integral.evaluations < 40_000, "{integral:?}");
    }
}

#[test]
fn what_is_out_of_reach_is_told() {
    let octant = [DVec3::X, DVec3::Y, DVec3::Z];
    let options = CubatureOptions { relative: 1e-12, absolute: 0.0, evaluations: 1000 };
    let step = |u: DVec3| DVec3::splat(if u.x > 0.61 * u.y + 0.1 { 1.0 } else { 0.0 });
    let integral = integrate(step, &octant, &[], options);
    assert!(integral.evaluations <= 1000 && integral.error.x > 1e-4, "{integral:?}");
    let exact = solid_angle(&octant);
    let one = integrate(|_| DVec3::ONE, &octant, &[], CubatureOptions { relative: 1e-13, ..options });
    assert!((one.value.x - exact).abs() < 1e-9, "{one:?}");
    assert!(integrate(|_| DVec3::NAN, &octant, &[], options).error.x.is_nan());
    assert_eq!(integrate(|_| DVec3::ONE, &[], &[], options).value, DVec3::ZERO);
    // Nothing is gained beyond the precision of f64: it ends all the same.
    let never = CubatureOptions { relative: 0.0, absolute: 0.0, evaluations: 200_000 };
    assert!((integrate(|_| DVec3::ONE, &octant, &[], never).value.x - exact).abs() < 1e-13);
}
