//! The table of fits.

use super::transformed_cosine;
use crate::brdf::mirrored;
use glam::{DMat3, DVec3};
use std::sync::LazyLock;

/// A transformed cosine for one roughness and one angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LtcFit {
    /// From directions in the frame of the mirror direction (its z; x in the plane of incidence) to those in which it is a cosine. Zero but for
    /// [a 0 b; 0 1 0; d 0 e].
    pub shape: DMat3,
    /// Its integral over all directions: with a reflectance of 1, and with Schlick's of 0 at normal incidence.
    pub weights: [f64; 2],
    /// The integrals over all directions above the surface of the sizes of the differences to BRDF times cosine, with the same two.
    pub distances: [f64; 2],
}

impl LtcFit {
    /// From the surface's directions to those in which it is a cosine, for a viewer.
    pub fn inverse(&self, outgoing: DVec3) -> DMat3 {
        let along = DVec3::new(outgoing.x, outgoing.y, 0.0).try_normalize().unwrap_or(DVec3::X);
        let (y, z) = (DVec3::Z.cross(along), mirrored(outgoing));
        self.shape * DMat3::from_cols(y.cross(z), y, z).transpose()
    }

    /// In place of BRDF times cosine, with those two reflectances, for a viewer.
    pub fn eval(&self, incoming: DVec3, outgoing: DVec3) -> [f64; 2] {
        let cosine = transformed_cosine(self.inverse(outgoing), incoming);
        self.weights.map(|weight| weight * cosine)
    }

    /// The part of the cosine that is above the horizon, for a viewer.
    pub fn above_horizon(&self, outgoing: DVec3) -> f64 {
        // The upper half space is moved to another; the two cut a lune out of the sphere, whose form factor is this.
        let up = self.inverse(outgoing).inverse().transpose() * DVec3::Z;
        0.5 * (1.0 + up.z / up.length())
    }
}

/// Fits for roughnesses and angles, interpolated linearly.
///
/// 32 x 32 entries of 8 numbers f32: a, b, d, e, two weights and two distances; by the square root of the roughness, from 0.05 to 1, then by
/// sqrt(1 - cos) of the viewer's angle to the normal, from 0 to 1. `cargo run --release --example fit_ltc` makes it.
#[derive(Clone, Debug, PartialEq)]
pub struct LtcTable {
    numbers: Vec<[f64; NUMBERS]>,
}

const NUMBERS: usize = 8;

impl LtcTable {
    /// Entries along each of the two ways.
    pub const SIZE: usize = 32;
    /// The smallest roughness that there are fits for.
    pub const SMOOTHEST: f64 = 0.0025;

    /// The one that comes with this crate.
    pub fn built_in() -> &'static Self {
        static TABLE: LazyLock<LtcTable> = LazyLock::new(|| {
            LtcTable::from_bytes(include_bytes!("table.bin")).unwrap_or_else(|| unreachable!("the table has its size"))
        });
        &TABLE
    }

    /// Of fits by roughness, then angle; `None` if there are not as many.
    pub fn new(fits: &[LtcFit]) -> Option<Self> {
        let numbers = |fit: &LtcFit| {
            let m = fit.shape;
            let [[one, two], [far, further]] = [fit.weights, fit.distances];
            [m.x_axis.x, m.z_axis.x, m.x_axis.z, m.z_axis.z, one, two, far, further]
        };
        (fits.len() == Self::SIZE * Self::SIZE).then(|| Self { numbers: fits.iter().map(numbers).collect() })
    }

    /// From numbers as [`LtcTable::to_bytes`] writes them; `None` if there are more or fewer of them.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        if bytes.len() != 4 * NUMBERS * Self::SIZE * Self::SIZE {
            return None;
        }
        let number =
            |at: usize| f64::from(f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]));
        let numbers = (0..Self::SIZE * Self::SIZE).map(|k| std::array::from_fn(|n| number(4 * (NUMBERS * k + n))));
        Some(Self { numbers: numbers.collect() })
    }

    /// As little-endian f32.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.numbers.iter().flatten().flat_map(|&number| (number as f32).to_le_bytes()).collect()
    }

    /// The roughness and the viewer's cosine of an entry, which need not be whole numbers.
    pub fn place(row: f64, column: f64) -> (f64, f64) {
        let last = (Self::SIZE - 1) as f64;
        let smallest = Self::SMOOTHEST.sqrt();
        let (root, angle) = (smallest + (1.0 - smallest) * row / last, column / last);
        (root * root, 1.0 - angle * angle)
    }

    /// Interpolated; outside of the table its nearest entries count.
    pub fn at(&self, roughness: f64, cosine: f64) -> LtcFit {
        let last = (Self::SIZE - 1) as f64;
        let smallest = Self::SMOOTHEST.sqrt();
        let row = ((roughness.sqrt() - smallest) / (1.0 - smallest)).clamp(0.0, 1.0) * last;
        let column = (1.0 - cosine).clamp(0.0, 1.0).sqrt() * last;
        let whole = |position: f64| (position as usize).min(Self::SIZE - 2);
        let (i, j) = (whole(row), whole(column));
        let (s, t) = (row - i as f64, column - j as f64);
        let corner = |i: usize, j: usize| &self.numbers[i * Self::SIZE + j];
        let [a, b, d, e, one, two, far, further] = std::array::from_fn(|n| {
            let along = |i: usize| corner(i, j)[n] * (1.0 - t) + corner(i, j + 1)[n] * t;
            along(i) * (1.0 - s) + along(i + 1) * s
        });
        LtcFit {
            shape: DMat3::from_cols(DVec3::new(a, 0.0, d), DVec3::Y, DVec3::new(b, 0.0, e)),
            weights: [one, two],
            distances: [far, further],
        }
    }
}
