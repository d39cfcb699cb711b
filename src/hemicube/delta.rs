//! Form factors of pixels, in closed form.
//!
//! The classic delta form factor is the integrand at the pixel's centre times its area, which does not add up to 1 unless it is
//! normalised. Instead each pixel has the exact form factor of its rectangle. It comes at no cost, since runs of pixels are
//! summed by differences of a table anyway.

use std::f64::consts::TAU;

/// For each row of a face, an antiderivative of the form factor along the row, at the borders of pixels. The form factor of
/// a run of pixels is the difference of two of them.
#[derive(Clone, Debug)]
pub(super) struct DeltaFactors {
    resolution: usize,
    /// Half of the top face's rows, from its edge to its middle; the others mirror them.
    top: Vec<f64>,
    side: Vec<f64>,
}

impl DeltaFactors {
    /// For a top face of `resolution` x `resolution` pixels; an even number.
    pub(super) fn new(resolution: usize) -> Self {
        let border = |k: usize| 2.0 * k as f64 / resolution as f64;
        let columns = || (0..=resolution).map(|k| border(k) - 1.0);
        let rows = 0..resolution / 2;
        let top = rows.clone().flat_map(|j| {
            let [low, high] = [border(j) - 1.0, border(j + 1) - 1.0];
            columns().map(move |u| facing(u, high) - facing(u, low))
        });
        let side = rows.flat_map(|j| {
            let [low, high] = [border(j), border(j + 1)];
            columns().map(move |u| beside(u, low) - beside(u, high))
        });
        Self { resolution, top: top.collect(), side: side.collect() }
    }

    /// All rows of the hemicube, face by face in their order there, each with its antiderivative; rows that share one come together, while
    /// it is in the cache.
    pub(super) fn rows(&self) -> impl Iterator<Item = (usize, &[f64])> {
        let width = self.resolution;
        let tables = self.top.chunks_exact(width + 1).zip(self.side.chunks_exact(width + 1));
        tables.enumerate().flat_map(move |(j, (top, side))| {
            let across = [(j, top), (width - 1 - j, top)];
            let beside = [0, 1, 2, 3].map(|k| (width + k * (width / 2) + j, side));
            across.into_iter().chain(beside)
        })
    }
}

/// The form factor to the rectangle from (0, 0, 1) to (x, y, 1), for the normal z; odd in x and in y.
fn facing(x: f64, y: f64) -> f64 {
    let [p, q] = [x.hypot(1.0), y.hypot(1.0)];
    (x / p * (y / p).atan() + y / q * (x / q).atan()) / TAU
}

/// The form factor to the rectangle from (1, 0, z) to (1, y, infinity), for the normal z; odd in y.
fn beside(y: f64, z: f64) -> f64 {
    let s = z.hypot(1.0);
    (y / s).atan() / s / TAU
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integral::form_factor;
    use glam::DVec3;

    #[test]
    fn pixels_have_the_form_factor_of_their_rectangle() {
        for resolution in [2, 6, 64] {
            let table = DeltaFactors::new(resolution);
            let at = |k: usize| 2.0 * k as f64 / resolution as f64;
            let mut total = 0.0;
            let mut rows = 0;
            for (j, row) in table.rows() {
                for k in 0..resolution {
                    let [left, right] = [at(k) - 1.0, at(k + 1) - 1.0];
                    let corners = if j < resolution {
                        let [low, high] = [at(j) - 1.0, at(j + 1) - 1.0];
                        [[left, low, 1.0], [right, low, 1.0], [right, high, 1.0], [left, high, 1.0]]
                    } else {
                        let j = (j - resolution) % (resolution / 2);
                        let [low, high] = [at(j), at(j + 1)];
                        [[1.0, left, low], [1.0, right, low], [1.0, right, high], [1.0, left, high]]
                    };
                    let factor = row[k + 1] - row[k];
                    let exact = form_factor(&corners.map(DVec3::from), DVec3::Z);
                    assert!((factor - exact).abs() < 2e-16, "row {j}, column {k}: {factor} {exact}");
                    total += factor;
                }
                rows += 1;
            }
            assert_eq!(rows, 3 * resolution);
            assert!((total - 1.0).abs() < 1e-14, "{resolution}: {total}");
        }
    }
}
