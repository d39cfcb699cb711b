//! Pictures in pixels, of exact areas: each pixel has the mean of what is seen in it.
//!
//! A pixel's colour is the sum over all regions of the area that a region has in it times the region's colour: antialiasing without samples. Colours are
//! linear RGB.

mod coverage;
mod flat;
mod parts;

pub use coverage::Coverage;
pub use flat::flat_picture;
pub use parts::{PixelPart, PixelParts};
pub(crate) use parts::{ReflectedPart, Reflections};

use glam::{DVec3, UVec2};

/// A picture, row by row from the top, of linear colours.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    size: UVec2,
    pixels: Vec<DVec3>,
}

/// The most pixels of a picture.
pub const MOST_PIXELS: u64 = 1 << 28;

/// A picture has too many pixels, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a picture of {} x {} pixels cannot be made: each side has at least 1, and there are at most 2^28", size.x, size.y)]
pub struct SizeError {
    /// What was asked for.
    pub size: UVec2,
}

impl Picture {
    /// All of one colour.
    ///
    /// # Errors
    /// If a side is 0, or there are more than 2^28 pixels.
    pub fn new(size: UVec2, colour: DVec3) -> Result<Self, SizeError> {
        let count = Self::check_size(size)?;
        Ok(Self { size, pixels: vec![colour; count] })
    }

    /// Of those pixels, row by row from the top, as many as there are.
    pub(crate) fn of_pixels(size: UVec2, pixels: Vec<DVec3>) -> Result<Self, SizeError> {
        let count = Self::check_size(size)?;
        assert_eq!(pixels.len(), count, "as many pixels as the picture has");
        Ok(Self { size, pixels })
    }

    /// How many pixels a picture of that size has.
    pub(crate) fn check_size(size: UVec2) -> Result<usize, SizeError> {
        let count = u64::from(size.x) * u64::from(size.y);
        if count == 0 || count > MOST_PIXELS { Err(SizeError { size }) } else { Ok(count as usize) }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// All pixels, row by row from the top.
    pub fn pixels(&self) -> &[DVec3] {
        &self.pixels
    }

    /// The same, to be changed.
    pub(crate) fn pixels_mut(&mut self) -> &mut [DVec3] {
        &mut self.pixels
    }

    /// One pixel, counted from the upper left.
    ///
    /// # Panics
    /// If it is outside.
    pub fn pixel(&self, x: u32, y: u32) -> DVec3 {
        assert!(x < self.size.x && y < self.size.y, "pixel {x}, {y} of {}", self.size);
        self.pixels[y as usize * self.size.x as usize + x as usize]
    }

    /// Adds a colour times the area that each pixel has in a region.
    pub(crate) fn add(&mut self, coverage: &Coverage, colour: DVec3) {
        let width = self.size.x as usize;
        coverage.for_each(|x, y, area| self.pixels[y as usize * width + x as usize] += colour * area);
    }
}
