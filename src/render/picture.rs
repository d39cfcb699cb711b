//! From a camera to a picture.

use super::mirrors::Mirrors;
use super::mixed::Mixed;
use super::{RenderError, Shader, Spot};
use crate::contour::{Domain, Frustum, Viewpoint};
use crate::parallel;
use crate::picture::{Picture, PixelPart, PixelParts};
use glam::{DVec3, UVec2};
use std::ops::Range;

/// A picture of a scene, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// Radiances.
    pub picture: Picture,
    /// How many points were shaded: one for each polygon in each pixel where it is seen; for a mirror, one for each that is seen in it.
    pub points: usize,
    /// The largest of red, green and blue of what each pixel's surfaces reflect, without what they emit; NaN where none is seen.
    reflected: Vec<f64>,
    mixed: Mixed,
}

impl Rendered {
    /// The picture as a screen shows it whose white is 1: radiances times `exposure`, cut off at 1 in each part of a pixel before these are averaged. So the outline of a lamp is as smooth as others
    /// are: a mean of its radiance, far above white, and of what is beside it would be white wherever the lamp has but a small part of a pixel.
    pub fn displayed(&self, exposure: f64) -> Picture {
        let mut picture = self.picture.clone();
        self.mixed.display(picture.pixels_mut(), exposure);
        picture
    }

    /// A factor for radiances that brings what is reflected to at most 0.8 in 95% of the pixels that show a surface; 1 if nothing is reflected.
    pub fn auto_exposure(&self) -> f64 {
        let mut found: Vec<f64> = self.reflected.iter().copied().filter(|radiance| !radiance.is_nan()).collect();
        if found.is_empty() {
            return 1.0;
        }
        let at = (found.len() - 1) * 95 / 100;
        let (_, &mut radiance, _) = found.select_nth_unstable_by(at, f64::total_cmp);
        if radiance > 0.0 { (0.8 / radiance).min(f64::MAX) } else { 1.0 }
    }
}

/// Rows of a picture, from left to right and from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Band {
    /// Radiances.
    pub radiances: Vec<DVec3>,
    /// As [`Rendered`] has them.
    reflected: Vec<f64>,
    mixed: Mixed,
}

impl Band {
    /// What a screen shows, as [`Rendered::displayed`].
    pub fn displayed(&self, exposure: f64) -> Vec<DVec3> {
        let mut pixels = self.radiances.clone();
        self.mixed.display(&mut pixels, exposure);
        pixels
    }
}

/// The sides of the squares of pixels that threads share.
const TILE: u32 = 16;
/// Rows of tiles are worked on together until they are so many, or all.
const BATCH: u32 = 1024;

/// Renders what a camera at `eye` sees. `done` is told from any thread how many more pixels are.
///
/// Which polygon is seen in what part of a pixel is exact, and so is which one is seen in a flat mirror, in the planes of mirrors that take most of the picture (16, fewer in scenes of more than 125,000 pieces; each takes a copy of the scene, some 700 bytes a piece); each is shaded at one point of that part ([`PixelPart::direction`]), and the pixel is the sum of areas times radiances. The result does not depend
/// on the number of threads. Memory: 32 bytes for each pixel, as many for each part of those that show more than one polygon, and what [`render_bands`] takes.
///
/// # Errors
/// If the picture would have no pixels or too many, if there is no view of the camera, if a point cannot be shaded, or if a radiance is not finite.
pub fn render(
    shader: &Shader,
    eye: DVec3,
    camera: &Frustum,
    size: UVec2,
    done: &(dyn Fn(usize) + Sync),
) -> Result<Rendered, RenderError> {
    Picture::check_size(size)?;
    let mut whole = Band::default();
    let points = render_bands(shader, eye, camera, size, done, |band| {
        whole.mixed.append(&band.mixed, whole.radiances.len());
        whole.radiances.extend(band.radiances);
        whole.reflected.extend(band.reflected);
        Ok::<(), RenderError>(())
    })?;
    let Band { radiances, reflected, mixed } = whole;
    Ok(Rendered { picture: Picture::of_pixels(size, radiances)?, points, reflected, mixed })
}

/// The same, but rows are given away as soon as they are made, some at a time, from the top; for pictures that are too large to keep. Gives the number of points that were shaded. Memory: the contour image, some
/// 16 x 16 x 1024 pixels, or 16 rows if those are more, and what is seen in them.
///
/// # Errors
/// As [`render`], and those of `take`.
pub fn render_bands<E: From<RenderError>>(
    shader: &Shader,
    eye: DVec3,
    camera: &Frustum,
    size: UVec2,
    done: &(dyn Fn(usize) + Sync),
    mut take: impl FnMut(Band) -> Result<(), E>,
) -> Result<usize, E> {
    let image = shader.order().view(&Viewpoint::free(eye), &Domain::Frustum(*camera));
    let image = image.map_err(|source| RenderError::View { from: "the camera", source })?;
    let mirrors = Mirrors::new(shader, &image, camera)?;
    let parts = PixelParts::with_reflections(&image, size, mirrors.reflections()).map_err(RenderError::from)?;
    let Some(parts) = parts else { unreachable!("it is the image of a camera") };
    let columns = size.x.div_ceil(TILE);
    let rows = (BATCH / columns).max(1) * TILE;
    let mut points = 0;
    for top in (0..size.y).step_by(rows as usize) {
        let bottom = top.saturating_add(rows).min(size.y);
        let lows = (top..bottom).step_by(TILE as usize);
        let lows = lows.flat_map(|y| (0..columns).map(move |x| UVec2::new(x * TILE, y)));
        let tiles = parallel::map(lows.collect(), |low| {
            let tile = Tile::new(shader, &parts, &mirrors, low);
            if let Ok(tile) = &tile {
                done(tile.pixels.len());
            }
            tile
        });
        let count = size.x as usize * (bottom - top) as usize;
        let mixed = Mixed::default();
        let mut band = Band { radiances: vec![DVec3::ZERO; count], reflected: vec![f64::NAN; count], mixed };
        for tile in tiles {
            let tile = tile?;
            points += tile.points;
            for pixel in tile.pixels {
                let at = (pixel.y - top) as usize * size.x as usize + pixel.x as usize;
                (band.radiances[at], band.reflected[at]) = (pixel.radiance, pixel.reflected);
                band.mixed.push(at, &tile.parts[pixel.parts]);
            }
        }
        take(band)?;
    }
    Ok(points)
}

/// The pixels of a tile, and what their parts send: areas and radiances.
#[derive(Default)]
struct Tile {
    pixels: Vec<Pixel>,
    parts: Vec<(f64, DVec3)>,
    points: usize,
}

struct Pixel {
    x: u32,
    y: u32,
    radiance: DVec3,
    /// The largest of what its surfaces reflect.
    reflected: f64,
    /// Its parts among those of the tile.
    parts: Range<usize>,
}

impl Tile {
    fn new(shader: &Shader, parts: &PixelParts<'_>, mirrors: &Mirrors, low: UVec2) -> Result<Self, RenderError> {
        let mut tile = Self::default();
        let mut failure = None;
        parts.tile(low, low + TILE, |x, y, of_pixel| {
            if failure.is_none() {
                failure = tile.shade(shader, parts, mirrors, UVec2::new(x, y), of_pixel).err();
            }
        });
        failure.map_or(Ok(tile), Err)
    }

    /// Adds a pixel.
    fn shade(
        &mut self,
        shader: &Shader,
        parts: &PixelParts<'_>,
        mirrors: &Mirrors,
        at: UVec2,
        of_pixel: &[PixelPart],
    ) -> Result<(), RenderError> {
        let number = u64::from(at.y) << 32 | u64::from(at.x);
        let start = self.parts.len();
        let (mut sum, mut reflected, mut area) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for (k, part) in of_pixel.iter().enumerate() {
            let cell = parts.image().cell(part.cell);
            let radiance = if let Some((piece, side)) = cell.piece().zip(part.side) {
                // Of a plane that is seen edge-on: the nearest point of the piece will do.
                let near = cell.point_at(part.direction).unwrap_or(cell.image().viewpoint().eye());
                let spot = Spot { piece, side, near };
                let seed = number.wrapping_mul(64).wrapping_add(k as u64);
                let mirrored = part.reflected.map(|reflected| mirrors.meets(reflected));
                let from_light = shader.reflected_where_seen(&spot, -part.direction, seed, mirrored)?;
                reflected += from_light * part.area;
                area += part.area;
                self.points += 1;
                shader.emitted(&spot) + from_light
            } else {
                shader.background(part.direction)
            };
            self.parts.push((part.area, radiance));
            sum += radiance * part.area;
        }
        if !sum.is_finite() {
            return Err(RenderError::TooBright { x: at.x, y: at.y });
        }
        let reflected = if area > 0.0 { (reflected / area).max_element() } else { f64::NAN };
        self.pixels.push(Pixel { x: at.x, y: at.y, radiance: sum, reflected, parts: start..self.parts.len() });
        Ok(())
    }
}
