//! Estimates against the truth.

use super::{Cubature, CubatureOptions, Peak, Smoothness, integrate};
use crate::integral::brute::brute;
use crate::integral::clip::{clip, unit_outline};
use crate::integral::{double_axis_moment, solid_angle};
use glam::DVec3;
use std::f64::consts::TAU;

/// Random numbers that are always the same (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A direction above the horizon, one in three close to it.
    fn direction(&mut self) -> DVec3 {
        let z: f64 = if self.unit() < 0.33 { self.between(1e-3, 0.05) } else { self.between(0.05, 1.0) };
        let (sin, cos) = self.between(0.0, TAU).sin_cos();
        DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z)
    }

    /// A convex polygon above the horizon and on a lobe's side of its own, from the hemisphere to 1e-6 steradians, on the lobe or off it.
    fn polygon(&mut self, axis: DVec3, width: f64) -> Vec<DVec3> {
        let radius = if self.unit() < 0.1 { 1.57 } else { 10_f64.powf(self.between(-3.2, 0.15)) };
        let spread = if self.unit() < 0.5 { radius + width } else { 1.0 };
        let off = DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0));
        let centre = if self.unit() < 0.3 { self.direction() } else { (axis + off * spread).normalize() };
        let (x, y) = centre.any_orthonormal_pair();
        let (corners, aspect, turn) = (3 + (self.unit() * 6.0) as u32, self.between(0.05, 1.0), self.between(0.0, TAU));
        let corner = |k: u32| {
            let (sin, cos) = (f64::from(k) * TAU / f64::from(corners)).sin_cos();
            let (flat_x, flat_y) = (x * turn.cos() + y * turn.sin(), y * turn.cos() - x * turn.sin());
            centre * radius.cos() + (flat_x * cos + flat_y * (sin * aspect)) * radius.sin()
        };
        let shape: Vec<DVec3> = (0..corners).map(corner).collect();
        clip(&clip(&unit_outline(&shape), DVec3::Z), axis)
    }
}

/// How many of 10,000 estimates were too small, and what is printed for whoever tunes them.
struct Tally {
    cases: usize,
    too_small: usize,
    evaluations: usize,
    over: Vec<f64>,
}

impl Tally {
    fn new() -> Self {
        Self { cases: 0, too_small: 0, evaluations: 0, over: Vec::new() }
    }

    fn add(&mut self, off: f64, estimate: f64, evaluations: usize) {
        self.cases += 1;
        self.too_small += usize::from(off > estimate);
        self.evaluations += evaluations;
        if off > 0.0 {
            self.over.push(estimate / off);
        }
    }

    fn check(mut self, name: &str) {
        self.over.sort_by(f64::total_cmp);
        let median = self.over.get(self.over.len() / 2);
        let Self { cases, too_small, evaluations, .. } = self;
        println!(
            "{name}: {too_small} of {cases} too small; median over {median:?}; {} evaluations",
            evaluations / cases
        );
        assert!(too_small * 100 <= cases, "{name}: {too_small} of {cases} estimates are too small");
    }
}

#[test]
fn estimates_are_honest_for_powers_of_cosines() {
    let mut random = Random(1);
    let mut tally = Tally::new();
    while tally.cases < 10_000 {
        let n = 2_f64.powf(random.between(0.0, 11.0)).round();
        let axis = random.direction();
        let width = 1.0 / n.sqrt();
        let polygon = random.polygon(axis, width);
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
    tally.check("powers of cosines");
}

#[test]
fn estimates_are_honest_for_stretched_lobes() {
    // As of rough surfaces seen at grazing angles, with long tails; and with a kink across the lobe.
    let mut random = Random(2);
    let [mut smooth, mut kinked] = [Tally::new(), Tally::new()];
    while smooth.cases < 500 {
        let axis = random.direction();
        let width = 10_f64.powf(random.between(-1.6, 0.0));
        let polygon = random.polygon(axis, width);
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
    smooth.check("stretched lobes");
    kinked.check("kinked lobes");
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
