//! Measured isotropic BRDFs in the format of MERL.

#[cfg(test)]
mod tests;

use super::halfway::{halfway, peaks};
use super::{Brdf, BrdfError, Form, are_above};
use crate::integral::Smoothness;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// The numbers of bins in `theta_h`, `theta_d` and `phi_d`.
pub(crate) const BINS: [usize; 3] = [90, 90, 180];
/// How many bins there are.
pub(crate) const COUNT: usize = BINS[0] * BINS[1] * BINS[2];

/// What becomes of negative values, with which MERL's files mark bins that were not measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unmeasured {
    /// They are accepted where the middle of a bin has a direction below the horizon, and refused elsewhere.
    #[default]
    Refuse,
    /// They are accepted everywhere but at the smallest `theta_d`.
    Fill,
}

/// A table of measurements of an isotropic surface (Matusik and others, "A data-driven reflectance model", SIGGRAPH 2003), in the coordinates of
/// Rusinkiewicz ("A new change of variables for efficient BRDF representation", 1998): `theta_h` is the angle of the halfway vector to the normal, `theta_d` and `phi_d`
/// are those of the incoming direction about the halfway vector. Bin i of `theta_h` is from (i / 90)^2 to ((i + 1) / 90)^2 of 90 degrees, the others are of one degree;
/// `phi_d` and `phi_d` + 180 degrees are the same, which is reciprocity.
///
/// *Look-up.* MERL's own reader takes the bin that holds the angles. Here values count for the middles of bins, and between them are interpolated in all
/// three angles; around `theta_h` = 0 and `theta_d` = 0, where `phi_d` has no meaning, towards the mean over `phi_d`. At the middles of bins both are the same, but this is continuous:
/// reflected radiance does not jump as the viewer moves, and cubature converges. Bins that were not measured have the value of the next smaller `theta_d` that was.
///
/// Integrals are by cubature, as of something with kinks everywhere. 35 MB of memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Merl {
    /// By `theta_h`, then `theta_d`, then `phi_d`.
    values: Vec<DVec3>,
    /// The means over `phi_d` at `theta_h` = 0, by `theta_d`.
    on_axis: Vec<DVec3>,
    /// Those at `theta_d` = 0, by `theta_h`.
    retro: Vec<DVec3>,
    /// The middles of the bins of `theta_h`, in radians.
    middles: Vec<f64>,
    /// How far from the normal the halfway vector is when values have halved.
    width: f64,
}

impl Merl {
    /// Of 90 x 90 x 180 values in sr^-1, by `theta_h`, then `theta_d`, then `phi_d`. Where one colour is negative a bin counts as not measured.
    ///
    /// # Errors
    /// If there is another number of values, one is not finite or larger than 1e12, or negative where that is not accepted.
    pub fn new(mut values: Vec<DVec3>, unmeasured: Unmeasured) -> Result<Self, BrdfError> {
        if values.len() != COUNT {
            return Err(BrdfError::BadTable { count: values.len(), expected: COUNT });
        }
        if let Some((index, &value)) = values.iter().enumerate().find(|(_, v)| !super::is_usable(**v)) {
            return Err(BrdfError::BadCoefficient { index, value });
        }
        for index in 0..COUNT {
            let value = values[index];
            if value.min_element() >= 0.0 {
                continue;
            }
            let bin = bin(index);
            let is_accepted = unmeasured == Unmeasured::Fill || is_below(bin);
            if !is_accepted || bin[1] == 0 {
                return Err(BrdfError::BadMeasurement { bin, value });
            }
            // Smaller theta_d come first: that is filled by now.
            values[index] = values[index - BINS[2]];
        }
        let mean = |i: usize, j: usize| {
            let row = (i * BINS[1] + j) * BINS[2];
            values[row..row + BINS[2]].iter().sum::<DVec3>() / BINS[2] as f64
        };
        let on_axis: Vec<DVec3> = (0..BINS[1]).map(|j| mean(0, j)).collect();
        let retro = (0..BINS[0]).map(|i| mean(i, 0)).collect();
        let middles: Vec<f64> = (0..BINS[0]).map(middle).collect();
        // The narrowest of the lobes at all theta_d.
        let half = |j: usize| {
            let at_most = 0.5 * on_axis[j].max_element();
            (0..BINS[0]).find(|&i| mean(i, j).max_element() < at_most).map_or(PI, |i| middles[i])
        };
        let width = (0..BINS[1]).map(half).fold(PI, f64::min);
        Ok(Self { values, on_axis, retro, middles, width })
    }

    /// The table of another BRDF, at the middles of bins, and not measured where a direction is below the horizon. Of an anisotropic one it is what
    /// is seen with the halfway vector above the x axis.
    ///
    /// # Errors
    /// If a value is not finite or larger than 1e12.
    pub fn tabulate(brdf: &dyn Brdf) -> Result<Self, BrdfError> {
        let sampled = (0..COUNT).map(|index| {
            let bin = bin(index);
            let [incoming, outgoing] = directions(bin);
            if is_below(bin) { -DVec3::ONE } else { brdf.eval(incoming, outgoing) }
        });
        Self::new(sampled.collect(), Unmeasured::Refuse)
    }

    /// The values by `theta_h`, then `theta_d`, then `phi_d`, in sr^-1, with bins filled that were not measured.
    pub fn values(&self) -> &[DVec3] {
        &self.values
    }

    /// At angles in radians.
    fn at(&self, theta_h: f64, theta_d: f64, phi_d: f64) -> DVec3 {
        let (h, share_h) = self.between_middles(theta_h);
        let position = theta_d.to_degrees() - 0.5;
        let d = (position.floor() as isize).clamp(-1, BINS[1] as isize - 1);
        // Below the first middle, over half a bin.
        let share_d = if d < 0 { 2.0 * position + 1.0 } else { position - d as f64 };
        let share_d = if d + 1 == BINS[1] as isize { 0.0 } else { share_d };
        let turn = phi_d.to_degrees() - 0.5;
        let (phi, share_phi) = ((turn.floor() as isize).rem_euclid(BINS[2] as isize) as usize, turn - turn.floor());
        let mut sum = DVec3::ZERO;
        for (i, weight_h) in [(h, 1.0 - share_h), (h + 1, share_h)] {
            for (j, weight_d) in [(d, 1.0 - share_d), (d + 1, share_d)] {
                let weight = weight_h * weight_d;
                if weight > 0.0 {
                    sum += self.row(i, j, phi, share_phi) * weight;
                }
            }
        }
        sum
    }

    /// At the middles of bins of `theta_h` and `theta_d`; -1 is where the angle is 0.
    fn row(&self, i: isize, j: isize, phi: usize, share: f64) -> DVec3 {
        match (usize::try_from(i), usize::try_from(j)) {
            (Err(_), j) => self.on_axis[j.unwrap_or(0)],
            (Ok(i), Err(_)) => self.retro[i],
            (Ok(i), Ok(j)) => {
                let row = (i * BINS[1] + j) * BINS[2];
                self.values[row + phi] * (1.0 - share) + self.values[row + (phi + 1) % BINS[2]] * share
            }
        }
    }

    /// The last middle of `theta_h` that is not above an angle, -1 for 0, and how far it is to the next.
    fn between_middles(&self, theta_h: f64) -> (isize, f64) {
        let after = self.middles.partition_point(|&middle| middle <= theta_h);
        let before = if after == 0 { 0.0 } else { self.middles[after - 1] };
        let share = self.middles.get(after).map_or(0.0, |next| ((theta_h - before) / (next - before)).clamp(0.0, 1.0));
        (after as isize - 1, share)
    }
}

impl Brdf for Merl {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        if !are_above(incoming, outgoing) {
            return DVec3::ZERO;
        }
        let h = halfway(incoming, outgoing);
        let across = h.truncate().length();
        let (cos, sin) = if across > 0.0 { (h.x / across, h.y / across) } else { (1.0, 0.0) };
        // Turned so that h is along z; the azimuth is that seen from the normal.
        let along = incoming.x * cos + incoming.y * sin;
        let x = along * h.z - incoming.z * across;
        let y = incoming.y * cos - incoming.x * sin;
        let z = along * across + incoming.z * h.z;
        self.at(across.atan2(h.z), x.hypot(y).atan2(z), y.atan2(x))
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        let is_wide = self.width >= FRAC_PI_2;
        let peaks = if is_wide { Vec::new() } else { peaks(outgoing, self.width, self.width) };
        Form::General { peaks, creases: Vec::new(), smoothness: Smoothness::Tabulated }
    }
}

/// The numbers of the bin at an index.
pub(crate) fn bin(index: usize) -> [usize; 3] {
    [index / (BINS[1] * BINS[2]), index / BINS[2] % BINS[1], index % BINS[2]]
}

/// The middle of a bin of `theta_h`, as the index goes.
fn middle(i: usize) -> f64 {
    ((i as f64 + 0.5) / BINS[0] as f64).powi(2) * FRAC_PI_2
}

/// The incoming and outgoing directions at the middle of a bin.
fn directions(bin: [usize; 3]) -> [DVec3; 2] {
    let (sin_h, cos_h) = middle(bin[0]).sin_cos();
    let (sin_d, cos_d) = (bin[1] as f64 + 0.5).to_radians().sin_cos();
    let (sin_phi, cos_phi) = (bin[2] as f64 + 0.5).to_radians().sin_cos();
    let half = DVec3::new(sin_h, 0.0, cos_h);
    let aside = DVec3::new(cos_h, 0.0, -sin_h) * (sin_d * cos_phi) + DVec3::Y * (sin_d * sin_phi);
    [half * cos_d + aside, half * cos_d - aside]
}

/// True if the middle of a bin has a direction that is not above the surface.
fn is_below(bin: [usize; 3]) -> bool {
    directions(bin).iter().any(|direction| direction.z <= 0.0)
}
