//! Pictures as EXR.

use crate::io::number::single;
use crate::picture::Picture;
use exr::prelude::{Encoding, Image, SpecificChannels, Vec2, WritableImage};
use std::io::{self, Seek, Write};

/// Writes a picture of linear colours as `OpenEXR`, with 32 bits a channel, losslessly compressed: red, green and blue as they are, up to the largest such number (3e38).
///
/// # Errors
/// Those of `out`.
pub fn write_exr(picture: &Picture, out: impl Write + Seek) -> io::Result<()> {
    let size = picture.size();
    let pixel = |at: Vec2<usize>| {
        let [red, green, blue] = picture.pixel(at.x() as u32, at.y() as u32).to_array().map(single);
        (red, green, blue)
    };
    let channels = SpecificChannels::rgb(pixel);
    let mut image = Image::from_channels((size.x as usize, size.y as usize), channels);
    image.layer_data.encoding = Encoding::SMALL_LOSSLESS;
    image.write().non_parallel().to_buffered(out).map_err(|error| match error {
        exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::image::RgbChannels;
    use exr::prelude::{ReadChannels, ReadLayers};
    use glam::{DVec3, UVec2, Vec3};
    use std::io::Cursor;

    #[test]
    fn colours_come_back_as_they_are() {
        let size = UVec2::new(5, 3);
        let mut pixels = vec![DVec3::ZERO; 15];
        pixels[9] = DVec3::new(17.0, 0.25, 1e-3);
        pixels[10] = DVec3::splat(1e300);
        let picture = Picture::of_pixels(size, pixels).unwrap();
        let mut bytes = Vec::new();
        write_exr(&picture, Cursor::new(&mut bytes)).unwrap();
        let reader = exr::prelude::read().no_deep_data().largest_resolution_level();
        let channels = reader.rgb_channels(
            |size: Vec2<usize>, _: &RgbChannels| vec![[0.0_f32; 3]; size.area()],
            |pixels: &mut Vec<[f32; 3]>, at: Vec2<usize>, (red, green, blue): (f32, f32, f32)| {
                pixels[at.y() * 5 + at.x()] = [red, green, blue];
            },
        );
        let image = channels.first_valid_layer().all_attributes().from_buffered(Cursor::new(&bytes)).unwrap();
        let pixels = &image.layer_data.channel_data.pixels;
        assert_eq!(pixels.len(), 15);
        for (found, expected) in pixels.iter().zip(picture.pixels()) {
            assert_eq!(Vec3::from(*found), expected.as_vec3().min(Vec3::MAX));
        }
    }
}
