//! Random cases for tests of estimates, and how the estimates did.

use super::clip::{clip, unit_outline};
use glam::DVec3;
use std::f64::consts::TAU;

/// Random numbers that are always the same (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A direction above the horizon, one in three close to it.
    pub(crate) fn direction(&mut self) -> DVec3 {
        let z: f64 = if self.unit() < 0.33 { self.between(1e-3, 0.05) } else { self.between(0.05, 1.0) };
        let (sin, cos) = self.between(0.0, TAU).sin_cos();
        DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z)
    }

    /// A convex polygon above the horizon, from the hemisphere to 1e-6 steradians, on the lobe or off it.
    pub(crate) fn polygon(&mut self, axis: DVec3, width: f64) -> Vec<DVec3> {
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
        clip(&unit_outline(&shape), DVec3::Z)
    }
}

/// How many estimates were too small, and what is printed for whoever tunes them.
pub(crate) struct Tally {
    name: String,
    pub(crate) cases: usize,
    too_small: usize,
    evaluations: usize,
    over: Vec<f64>,
}

impl Tally {
    pub(crate) fn new(name: &str) -> Self {
        Self { name: name.to_owned(), cases: 0, too_small: 0, evaluations: 0, over: Vec::new() }
    }

    pub(crate) fn add(&mut self, off: f64, estimate: f64, evaluations: usize) {
        self.cases += 1;
        self.too_small += usize::from(off > estimate);
        self.evaluations += evaluations;
        if off > 0.0 {
            self.over.push(estimate / off);
        }
    }

    pub(crate) fn check(mut self) {
        self.over.sort_by(f64::total_cmp);
        let median = self.over.get(self.over.len() / 2);
        let Self { name, cases, too_small, evaluations, .. } = self;
        println!(
            "{name}: {too_small} of {cases} too small; median over {median:?}; {} evaluations",
            evaluations / cases
        );
        assert!(too_small * 100 <= cases, "{name}: {too_small} of {cases} estimates are too small");
    }
}
