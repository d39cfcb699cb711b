//! Fits linearly transformed cosines to GGX: `cargo run --release --example fit_ltc -- src/brdf/ltc/table.bin`.
//!
//! For 32 roughnesses and 32 angles of the viewer, the transformation for which the integral of the size of the difference to BRDF times
//! cosine is smallest, found by Nelder and Mead's method from a guess and from the fit of the angle before; then weights for which a white sky gives what it should;
//! then the largest distance within one entry of each, between entries too. A minute on two cores; the same bits each time.

mod simplex;

use glam::{DMat3, DVec3};
use nusselt::brdf::{Brdf, Fresnel, Ggx, LtcFit, LtcTable};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::io::Write;
use std::path::PathBuf;

/// A viewer nearer to the horizon counts as at this cosine.
const GRAZING: f64 = 1e-3;

/// Directions spread as GGX spreads them, with BRDF times cosine for two reflectances.
struct Samples {
    /// Direction, the two values, and the solid angle it stands for.
    all: Vec<(DVec3, [f64; 2], f64)>,
    outgoing: DVec3,
    albedos: [f64; 2],
}

impl Samples {
    fn new(roughness: f64, cosine: f64, fineness: u32) -> Self {
        let cosine = cosine.max(GRAZING);
        let outgoing = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
        let good = "parameters in range";
        let edge = Fresnel::schlick(DVec3::ZERO).expect(good);
        let models = [Fresnel::ALL, edge].map(|fresnel| Ggx::new(fresnel, roughness, roughness).expect(good));
        let n = f64::from(fineness);
        let mut all = Vec::new();
        for k in 0..fineness * fineness {
            let [s, t] = [f64::from(k % fineness), f64::from(k / fineness)].map(|k| (k + 0.5) / n);
            // The half of the sphere with y > 0 stands for both.
            let (sin, cos) = (PI * t).sin_cos();
            let tangent = roughness * (s / (1.0 - s)).sqrt();
            let half = DVec3::new(tangent * cos, tangent * sin, 1.0).normalize();
            let incoming = half * (2.0 * half.dot(outgoing)) - outgoing;
            if incoming.z <= 0.0 || half.dot(outgoing) <= 0.0 {
                continue;
            }
            let slopes = tangent * tangent / (roughness * roughness) + 1.0;
            // 1 over the density: that of halfway vectors is 1 / (pi a^2 slopes^2 hz^3).
            let solid_angle = 4.0 * half.dot(outgoing) * PI * (roughness * slopes).powi(2) * half.z.powi(3) / (n * n);
            let values = models.each_ref().map(|model| model.eval(incoming, outgoing).x * incoming.z);
            all.push((incoming, values, solid_angle));
        }
        let albedo = |k: usize| all.iter().map(|(_, values, weight)| values[k] * weight).sum();
        Self { albedos: [albedo(0), albedo(1)], all, outgoing }
    }

    fn distances(&self, fit: &LtcFit) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (incoming, values, weight) in &self.all {
            // Both halves, of y > 0 and of y < 0, are the same.
            let fitted = fit.eval(*incoming, self.outgoing);
            (0..2).for_each(|k| sums[k] += (values[k] - fitted[k]).abs() * weight);
        }
        sums
    }

    /// Of logarithms of widths in the plane of incidence and across, a shear, and the turn of the lobe from the mirror direction.
    fn fit(&self, [wide, high, shear, angle]: [f64; 4]) -> LtcFit {
        let turn = DMat3::from_rotation_y(angle);
        let shape = DMat3::from_cols(
            DVec3::new(wide.exp(), 0.0, 0.0),
            DVec3::new(0.0, high.exp(), 0.0),
            DVec3::new(shear, 0.0, 1.0),
        );
        let shape = (turn * shape).inverse();
        let mut fit = LtcFit { shape: shape * (1.0 / shape.y_axis.y), weights: [1.0; 2], distances: [0.0; 2] };
        fit.weights = self.albedos.map(|albedo| albedo / fit.above_horizon(self.outgoing));
        fit
    }
}

fn main() -> std::io::Result<()> {
    let path = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("ltc.bin"), PathBuf::from);
    let size = LtcTable::SIZE;
    let rows: Vec<Vec<LtcFit>> = (0..size)
        .into_par_iter()
        .map(|row| {
            let mut found: Option<[f64; 4]> = None;
            (0..size)
                .map(|column| {
                    let (roughness, cosine) = LtcTable::place(row as f64, column as f64);
                    let samples = Samples::new(roughness, cosine, 48);
                    // A turn of the halfway vector by d turns the direction by 2 d in the plane, and by 2 d times the cosine across.
                    let guess = [(2.0 * roughness).ln(), (2.0 * roughness * cosine.max(roughness)).ln(), 0.0, 0.0];
                    let steps = [0.3, 0.3, 0.3 * roughness, 0.3 * roughness];
                    let distance = |parameters: [f64; 4]| {
                        let distance = samples.distances(&samples.fit(parameters))[0];
                        if distance.is_finite() { distance } else { f64::INFINITY }
                    };
                    let best = [Some(guess), found]
                        .into_iter()
                        .flatten()
                        .map(|from| {
                            let first = simplex::minimum(distance, from, steps, 200);
                            let best = simplex::minimum(distance, first, steps, 200);
                            (distance(best), best)
                        })
                        .min_by(|a, b| a.0.total_cmp(&b.0))
                        .map_or(guess, |(_, best)| best);
                    found = Some(best);
                    samples.fit(best)
                })
                .collect()
        })
        .collect();
    let mut fits: Vec<LtcFit> = rows.into_iter().flatten().collect();
    let table = LtcTable::new(&fits).expect("an entry for each place");
    // As it will be read.
    let table = LtcTable::from_bytes(&table.to_bytes()).expect("as many numbers");
    let distances: Vec<[f64; 2]> = (0..size * size)
        .into_par_iter()
        .map(|k| {
            let mut largest = [0.0_f64; 2];
            for step in 0..25 {
                let aside =
                    |at: usize, step: i32| (at as f64 + 0.5 * f64::from(step) - 1.0).clamp(0.0, (size - 1) as f64);
                let (roughness, cosine) = LtcTable::place(aside(k / size, step / 5), aside(k % size, step % 5));
                let cosine = cosine.max(GRAZING);
                let found = Samples::new(roughness, cosine, 64).distances(&table.at(roughness, cosine));
                (0..2).for_each(|n| largest[n] = largest[n].max(found[n]));
            }
            // For what the sums leave, and for places between those.
            largest.map(|distance| 1.03 * distance)
        })
        .collect();
    fits.iter_mut().zip(&distances).for_each(|(fit, &distances)| fit.distances = distances);
    println!("distance to GGX, by roughness and angle, and as a part of the albedo:");
    for row in [0, 4, 8, 12, 16, 20, 25, 31] {
        for column in [0, 8, 16, 24, 28, 30] {
            let (roughness, cosine) = LtcTable::place(row as f64, f64::from(column));
            let at = row * size + column as usize;
            let samples = Samples::new(roughness, cosine, 64);
            let [here, _] = samples.distances(&table.at(roughness, cosine));
            println!(
                "{roughness:7.4} {:5.1} degrees: {here:.4} here, {:.4} stated; {:.1}% of the albedo",
                cosine.acos().to_degrees(),
                fits[at].distances[0],
                100.0 * here / samples.albedos[0]
            );
        }
    }
    let bytes = LtcTable::new(&fits).expect("an entry for each place").to_bytes();
    nusselt::io::atomic_write(&path, |file| file.write_all(&bytes))
}
