//! From a camera to a picture.

use super::{RenderError, Shader, Spot};
use crate::contour::{Domain, Frustum, Viewpoint};
use crate::parallel;
use crate::picture::{Picture, PixelPart, PixelParts};
use glam::{DVec3, UVec2};

/// A picture of a scene, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// Radiances.
    pub picture: Picture,
    /// How many points were shaded: one for each polygon in each pixel where it is seen.
    pub points: usize,
    /// The largest of red, green and blue of what each pixel's surfaces reflect, without what they emit; NaN where none is seen.
    reflected: Vec<f64>,
}

impl Rendered {
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

/// The sides of the squares of pixels that threads share.
const TILE: u32 = 16;
/// So many of them are worked on before their pixels are put into the picture.
const BATCH: usize = 1024;

/// Renders what a camera at `eye` sees. `done` is told from any thread how many more pixels are.
///
/// Which polygon is seen in what part of a pixel is exact; each is shaded at one point of that part ([`PixelPart::direction`]), and the pixel is the sum of areas times radiances. The result does not depend
/// on the number of threads. Memory: the picture, the contour image, and what a thousand tiles of 16 x 16 pixels show.
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
    let mut picture = Picture::new(size, DVec3::ZERO)?;
    let mut reflected = vec![f64::NAN; picture.pixels().len()];
    let image = shader.order().view(&Viewpoint::free(eye), &Domain::Frustum(*camera));
    let image = image.map_err(|source| RenderError::View { from: "the camera", source })?;
    let Some(parts) = PixelParts::new(&image, size)? else { unreachable!("it is the image of a camera") };
    let tiles: Vec<UVec2> = (0..size.y.div_ceil(TILE))
        .flat_map(|y| (0..size.x.div_ceil(TILE)).map(move |x| UVec2::new(x, y) * TILE))
        .collect();
    let mut points = 0;
    for batch in tiles.chunks(BATCH) {
        let found = parallel::map(batch.to_vec(), |low| {
            let tile = Tile::new(shader, &parts, low);
            if let Ok(tile) = &tile {
                done(tile.pixels.len());
            }
            tile
        });
        for tile in found {
            let tile = tile?;
            points += tile.points;
            for (x, y, colour, largest) in tile.pixels {
                reflected[y as usize * size.x as usize + x as usize] = largest;
                picture.set(x, y, colour);
            }
        }
    }
    Ok(Rendered { picture, points, reflected })
}

/// The pixels of a tile: column, row, radiance, and the largest of what is reflected.
struct Tile {
    pixels: Vec<(u32, u32, DVec3, f64)>,
    points: usize,
}

impl Tile {
    fn new(shader: &Shader, parts: &PixelParts<'_>, low: UVec2) -> Result<Self, RenderError> {
        let mut tile = Self { pixels: Vec::new(), points: 0 };
        let mut failure = None;
        parts.tile(low, low + TILE, |x, y, of_pixel| {
            if failure.is_none() {
                let number = u64::from(y) << 32 | u64::from(x);
                match shade(shader, parts, number, of_pixel) {
                    Ok((colour, _)) if !colour.is_finite() => failure = Some(RenderError::TooBright { x, y }),
                    Ok((colour, reflected)) => tile.pixels.push((x, y, colour, reflected)),
                    Err(error) => failure = Some(error),
                }
                tile.points += of_pixel.iter().filter(|part| part.polygon.is_some()).count();
            }
        });
        failure.map_or(Ok(tile), Err)
    }
}

/// The radiance of a pixel, and the largest of what its surfaces reflect.
fn shade(
    shader: &Shader,
    parts: &PixelParts<'_>,
    number: u64,
    of_pixel: &[PixelPart],
) -> Result<(DVec3, f64), RenderError> {
    let (mut sum, mut reflected, mut area) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for (k, part) in of_pixel.iter().enumerate() {
        let cell = parts.image().cell(part.cell);
        let Some((piece, side)) = cell.piece().zip(part.side) else {
            sum += shader.background(part.direction) * part.area;
            continue;
        };
        // Of a plane that is seen edge-on: the nearest point of the piece will do.
        let near = cell.point_at(part.direction).unwrap_or(cell.image().viewpoint().eye());
        let spot = Spot { piece, side, near };
        let seed = number.wrapping_mul(64).wrapping_add(k as u64);
        let from_light = shader.reflected_where_seen(&spot, -part.direction, seed)?;
        sum += (shader.emitted(&spot) + from_light) * part.area;
        reflected += from_light * part.area;
        area += part.area;
    }
    Ok((sum, if area > 0.0 { (reflected / area).max_element() } else { f64::NAN }))
}
