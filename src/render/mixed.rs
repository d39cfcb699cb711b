//! Pixels that show more than one polygon, as a screen shows them.

use glam::DVec3;

/// The areas and radiances of the parts of pixels that have more than one.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Mixed {
    /// The number of each pixel, and where its parts end; those of the next one begin there.
    pixels: Vec<(usize, usize)>,
    parts: Vec<(f64, DVec3)>,
}

impl Mixed {
    /// Adds a pixel, if it has more than one part.
    pub(super) fn push(&mut self, pixel: usize, parts: &[(f64, DVec3)]) {
        if parts.len() > 1 {
            self.parts.extend(parts);
            self.pixels.push((pixel, self.parts.len()));
        }
    }

    /// Adds those of another picture, whose pixels come after so many.
    pub(super) fn append(&mut self, other: &Self, after: usize) {
        let start = self.parts.len();
        self.pixels.extend(other.pixels.iter().map(|&(pixel, end)| (after + pixel, start + end)));
        self.parts.extend(&other.parts);
    }

    /// Takes radiances times an exposure, in each part at most white.
    pub(super) fn display(&self, pixels: &mut [DVec3], exposure: f64) {
        let shown = |radiance: DVec3| (radiance * exposure).min(DVec3::ONE);
        for pixel in pixels.iter_mut() {
            *pixel = shown(*pixel);
        }
        let mut start = 0;
        for &(pixel, end) in &self.pixels {
            // Areas sum to 1 but for rounding.
            let sum: DVec3 = self.parts[start..end].iter().map(|&(area, radiance)| shown(radiance) * area).sum();
            pixels[pixel] = sum.min(DVec3::ONE);
            start = end;
        }
    }
}
