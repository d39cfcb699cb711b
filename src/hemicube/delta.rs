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

    /// The rows of the top face, in order.
    pub(super) fn top_rows(&self) -> impl Iterator<Item = &[f64]> {
        let rows = self.top.chunks_exact(self.resolution + 1);
        rows.clone().chain(rows.rev())
    }

    /// The rows of a side face, from the horizon upwards.
    pub(super) fn side_rows(&self) -> impl Iterator<Item = &[f64]> {
        self.side.chunks_exact(self.resolution + 1)
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
            for (j, row) in table.top_rows().enumerate() {
                for k in 0..resolution {
                    let corners = [[k, j], [k, j + 1], [k + 1, j + 1], [k + 1, j]];
                    let corners = corners.map(|[u, v]| DVec3::new(at(u) - 1.0, 1.0 - at(v), 1.0));
                    let factor = row[k + 1] - row[k];
                    assert!((factor - form_factor(&corners, DVec3::Z)).abs() < 2e-16, "top {j} {k}");
                    total += factor;
                }
            }
            for (j, row) in table.side_rows().enumerate() {
                for k in 0..resolution {
                    let corners = [[k, j], [k + 1, j], [k + 1, j + 1], [k, j + 1]];
                    let corners = corners.map(|[u, v]| DVec3::new(1.0, at(u) - 1.0, at(v)));
                    let factor = row[k + 1] - row[k];
                    assert!((factor - form_factor(&corners, DVec3::Z)).abs() < 2e-16, "side {j} {k}");
                    total += 4.0 * factor;
                }
            }
            assert!((total - 1.0).abs() < 1e-14, "{resolution}: {total}");
        }
    }
}
