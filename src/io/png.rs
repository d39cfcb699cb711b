//! Pictures as PNG.

use super::srgb::encoded;
use super::svg::paint::Paint;
use crate::contour::{ContourImage, Projector};
use crate::picture::{Picture, SizeError, flat_picture};
use glam::{DVec3, UVec2};
use std::io::{self, Write};

/// Writes a picture of linear colours as PNG with 8 bits a channel, as sRGB encodes them; what is above 1 is white.
///
/// # Errors
/// Those of `out`.
pub fn write_png(picture: &Picture, out: impl Write) -> io::Result<()> {
    write_png_rows(picture.size(), out, |rows| rows.write(picture.pixels()))
}

/// Writes a PNG file row by row, for pictures that are too large to keep: `fill` writes all pixels. Colours are taken as by [`write_png`].
///
/// # Errors
/// Those of `out` and `fill`, or if `fill` wrote too few pixels.
pub fn write_png_rows<W: Write, E: From<io::Error>>(
    size: UVec2,
    out: W,
    fill: impl FnOnce(&mut PngRows<'_, W>) -> Result<(), E>,
) -> Result<(), E> {
    let failed = |error: png::EncodingError| io::Error::from(error);
    let mut encoder = png::Encoder::new(out, size.x, size.y);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let mut writer = encoder.write_header().map_err(failed)?;
    {
        let mut rows = PngRows { writer: writer.stream_writer().map_err(failed)? };
        fill(&mut rows)?;
        rows.writer.finish().map_err(failed)?;
    }
    Ok(writer.finish().map_err(failed)?)
}

/// The pixels of a PNG file, as they are written: see [`write_png_rows`].
pub struct PngRows<'a, W: Write> {
    writer: png::StreamWriter<'a, W>,
}

impl<W: Write> PngRows<'_, W> {
    /// Writes the next pixels, of linear colours, from left to right and from the top: whole rows, or parts of them.
    ///
    /// # Errors
    /// Those of the file, or if there are more than the size says.
    pub fn write(&mut self, pixels: &[DVec3]) -> io::Result<()> {
        let mut bytes = Vec::new();
        for some in pixels.chunks(1 << 14) {
            bytes.clear();
            bytes.extend(some.iter().flat_map(|&colour| colour.to_array().map(encoded)));
            self.writer.write_all(&bytes)?;
        }
        Ok(())
    }
}

/// A contour image as a picture, `width` pixels wide, in the colours of [`write_svg`](super::write_svg) and without lines: each pixel has the mean of what is seen in it. `done` is told
/// of each region that is painted, how many there are.
///
/// # Errors
/// If the picture would have no pixels, or too many.
pub fn contour_picture(
    image: &ContourImage,
    projector: &Projector,
    width: u32,
    done: impl FnMut(usize),
) -> Result<Picture, SizeError> {
    let paint = Paint::new(image, projector.frame());
    flat_picture(image, projector, width, DVec3::ONE, |polygon| paint.linear(polygon), done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_written_in_parts_are_the_same_file() {
        let size = UVec2::new(7, 5);
        let pixels: Vec<DVec3> = (0..35).map(|k| DVec3::new(0.03 * f64::from(k), 1e300, f64::NAN)).collect();
        let mut whole = Vec::new();
        write_png(&Picture::of_pixels(size, pixels.clone()).unwrap(), &mut whole).unwrap();
        let mut parts = Vec::new();
        let fill = |rows: &mut PngRows<'_, _>| pixels.chunks(4).try_for_each(|some| rows.write(some));
        write_png_rows(size, &mut parts, fill).unwrap();
        assert_eq!(whole, parts);
        // Too few, or too many.
        for pixels in [&pixels[1..], &[&pixels[..], &pixels[..1]].concat()] {
            assert!(write_png_rows(size, Vec::new(), |rows| rows.write(pixels)).is_err());
        }
    }

    #[test]
    fn regions_are_told_as_they_are_painted() {
        use crate::contour::{Domain, Projection, Projector, SceneOrder, Viewpoint};
        let scene = crate::samples::cornell_box().to_builder().build().unwrap();
        let eye = Viewpoint::free(DVec3::new(278.0, 273.0, 279.0));
        let image = SceneOrder::new(&scene).view(&eye, &Domain::Sphere).unwrap();
        let projector = Projector::of_image(&image, Projection::Equirectangular).unwrap();
        let mut told = Vec::new();
        contour_picture(&image, &projector, 64, |count| told.push(count)).unwrap();
        assert!(told.len() > 8 && told.iter().all(|&count| count == told.len()), "{told:?}");
    }
}
