//! Pictures as PNG.

use super::srgb::encoded;
use super::svg::paint::Paint;
use crate::contour::{ContourImage, Projector};
use crate::picture::{Picture, SizeError, flat_picture};
use glam::DVec3;
use std::io::{self, Write};

/// Writes a picture of linear colours as PNG with 8 bits a channel, as sRGB encodes them; what is above 1 is white.
///
/// # Errors
/// Those of `out`.
pub fn write_png(picture: &Picture, out: impl Write) -> io::Result<()> {
    let size = picture.size();
    let mut encoder = png::Encoder::new(out, size.x, size.y);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let bytes: Vec<u8> = picture.pixels().iter().flat_map(|colour| colour.to_array().map(encoded)).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&bytes)?;
    Ok(writer.finish()?)
}

/// A contour image as a picture, `width` pixels wide, in the colours of [`write_svg`](super::write_svg) and without lines: each pixel has the mean of what is seen in it.
///
/// # Errors
/// If the picture would have no pixels, or too many.
pub fn contour_picture(image: &ContourImage, projector: &Projector, width: u32) -> Result<Picture, SizeError> {
    let paint = Paint::new(image, projector.frame());
    flat_picture(image, projector, width, DVec3::ONE, |polygon| paint.linear(polygon))
}
