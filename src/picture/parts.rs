//! What is seen in each pixel of a camera's picture, with a point of it.

use super::{Picture, SizeError};
use crate::contour::{CellId, ContourImage, Domain, Region, ViewFrame};
use crate::scene::{PolygonId, Side};
use glam::{DVec2, DVec3, UVec2};

#[cfg(test)]
mod tests;

/// A part of a pixel: what is seen there of one side of one polygon, or of the background.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelPart {
    /// The polygon; `None` for background.
    pub polygon: Option<PolygonId>,
    /// The side of it.
    pub side: Option<Side>,
    /// Its area, where the pixel has 1.
    pub area: f64,
    /// A unit direction in which it is seen: to its centroid if that is in it, else to the centroid of the largest cell of the image that it consists of.
    pub direction: DVec3,
    /// A cell that shows it in that direction.
    pub cell: CellId,
}

/// Cuts a camera's contour image along the borders of pixels.
///
/// Cells are convex, and so is what a pixel has of each: its area and centroid are those of a polygon cut off at four lines, exact but for rounding. There are no
/// samples, and nothing is lost that is thinner than a pixel. Memory is that of the corners of all cells, and of one tile at a time for each thread.
///
/// ```
/// use glam::{DVec3, UVec2};
/// use nusselt::contour::{Domain, Frustum, SceneOrder, Viewpoint};
/// use nusselt::picture::PixelParts;
///
/// let scene = nusselt::samples::cornell_box().to_builder().build()?;
/// let camera = Frustum::new(DVec3::Z, DVec3::Y, 40.0, 1.0)?;
/// let eye = Viewpoint::free(DVec3::new(278.0, 273.0, -800.0));
/// let image = SceneOrder::new(&scene).view(&eye, &Domain::Frustum(camera))?;
/// let parts = PixelParts::new(&image, UVec2::new(64, 64))?.expect("a camera's image");
/// parts.tile(UVec2::ZERO, UVec2::splat(64), |_, _, parts| {
///     assert!((parts.iter().map(|part| part.area).sum::<f64>() - 1.0).abs() < 1e-12);
/// });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PixelParts<'a> {
    image: &'a ContourImage,
    size: UVec2,
    frame: ViewFrame,
    /// Of the image plane at distance 1: its upper left corner with y up, and the width of a pixel and its height.
    corner: DVec2,
    pixel: DVec2,
    /// Corners of all cells in pixels with y down, and where those of each cell begin and the last ones end.
    corners: Vec<DVec2>,
    starts: Vec<usize>,
    /// The numbers of the cells that reach into each band of rows.
    bands: Vec<Vec<u32>>,
}

/// Rows of a band.
const BAND: u32 = 32;

/// What a pixel has of one polygon, as it is summed up.
#[derive(Clone, Copy)]
struct Sum {
    key: Option<(PolygonId, Side)>,
    area: f64,
    moment: DVec2,
    /// Of how many cells it is, and the largest of these with its area and centroid.
    cells: u32,
    largest: (f64, u32, DVec2),
    /// The next of the same pixel.
    next: u32,
}

const NONE: u32 = u32::MAX;

impl<'a> PixelParts<'a> {
    /// For a picture of so many pixels; `None` if the image is not that of a camera. Pixels are square if the camera's aspect is that of the picture.
    ///
    /// # Errors
    /// If a picture of that size cannot be made.
    pub fn new(image: &'a ContourImage, size: UVec2) -> Result<Option<Self>, SizeError> {
        Picture::check_size(size)?;
        let Domain::Frustum(frustum) = image.domain() else { return Ok(None) };
        let half = (frustum.degrees() / 2.0).to_radians().tan();
        let reach = DVec2::new(half * frustum.aspect(), half);
        let frame = frustum.frame();
        let corner = DVec2::new(-reach.x, reach.y);
        let pixel = 2.0 * reach / size.as_dvec2();
        let mut parts = Self {
            image,
            size,
            frame,
            corner,
            pixel,
            corners: Vec::new(),
            starts: vec![0],
            bands: vec![Vec::new(); size.y.div_ceil(BAND) as usize],
        };
        for cell in image.cells() {
            parts.add(cell.boundary());
        }
        Ok(Some(parts))
    }

    /// Adds a cell.
    fn add(&mut self, boundary: impl Iterator<Item = DVec3>) {
        let start = self.corners.len();
        for direction in boundary {
            let d = self.frame.components(direction);
            let p = d.truncate() / d.z;
            self.corners.push(DVec2::new(p.x - self.corner.x, self.corner.y - p.y) / self.pixel);
        }
        let ring = &self.corners[start..];
        let (low, high) =
            ring.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.y), high.max(p.y)));
        if ring.iter().all(|p| p.is_finite()) && high > 0.0 && low < f64::from(self.size.y) {
            let cell = self.starts.len() as u32 - 1;
            let last = (high.min(f64::from(self.size.y) - 0.5) as u32) / BAND;
            for band in (low.max(0.0) as u32) / BAND..=last {
                self.bands[band as usize].push(cell);
            }
        }
        self.starts.push(self.corners.len());
    }

    /// The image that is cut.
    pub fn image(&self) -> &'a ContourImage {
        self.image
    }

    /// The size of the picture.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The unit direction to a point of the picture, in pixels from its upper left corner.
    pub fn direction(&self, at: DVec2) -> DVec3 {
        let at = at * self.pixel;
        let (x, y) = (self.corner.x + at.x, self.corner.y - at.y);
        (self.frame.right() * x + self.frame.up() * y + self.frame.towards()).normalize()
    }

    /// Calls with column, row and parts of every pixel from `low` up to but without `high`, row by row. Of the same image it is always the same parts in the same order.
    /// O(cells in the rows + what pixels and cells have in common).
    pub fn tile(&self, low: UVec2, high: UVec2, mut f: impl FnMut(u32, u32, &[PixelPart])) {
        let high = high.min(self.size);
        if low.x >= high.x || low.y >= high.y {
            return;
        }
        let width = (high.x - low.x) as usize;
        let mut heads = vec![NONE; width * (high.y - low.y) as usize];
        let mut sums = Vec::new();
        let mut knife = Knife::default();
        for band in low.y / BAND..high.y.div_ceil(BAND) {
            let first = low.y.max(band * BAND);
            let end = high.y.min((band + 1) * BAND);
            for &cell in &self.bands[band as usize] {
                let range = self.starts[cell as usize]..self.starts[cell as usize + 1];
                let key = {
                    let cell = self.image.cell(CellId(cell));
                    cell.polygon().zip(cell.side())
                };
                knife.cut(&self.corners[range], [low.x, high.x], [first, end], |x, y, area, moment| {
                    let head = &mut heads[(y - low.y) as usize * width + (x - low.x) as usize];
                    add_to(head, &mut sums, key, cell, area, moment);
                });
            }
        }
        let mut parts = Vec::new();
        for y in low.y..high.y {
            for x in low.x..high.x {
                parts.clear();
                let mut next = heads[(y - low.y) as usize * width + (x - low.x) as usize];
                while next != NONE {
                    let sum = sums[next as usize];
                    parts.extend(self.part(&sum));
                    next = sum.next;
                }
                // The last one added comes first in the chain.
                parts.reverse();
                f(x, y, &parts);
            }
        }
    }

    /// What a sum says, with a direction in which it is seen.
    fn part(&self, sum: &Sum) -> Option<PixelPart> {
        let (_, largest, its_centroid) = sum.largest;
        let (polygon, side) = sum.key.unzip();
        let centroid = sum.moment / sum.area;
        let direction = self.direction(if centroid.is_finite() { centroid } else { its_centroid });
        let part = PixelPart { polygon, side, area: sum.area, direction, cell: CellId(largest) };
        // What one cell has in a pixel is convex.
        if sum.cells == 1 {
            return direction.is_finite().then_some(part);
        }
        let found = self.image.locate(direction).regions().into_iter().find_map(|region| match region {
            Region::Cell(id) => {
                let cell = self.image.cell(id);
                (cell.polygon().zip(cell.side()) == sum.key).then_some(id)
            }
            Region::Outside => None,
        });
        let part = match found {
            Some(cell) => PixelPart { cell, ..part },
            None => PixelPart { direction: self.direction(its_centroid), ..part },
        };
        part.direction.is_finite().then_some(part)
    }
}

/// Adds what a cell has in a pixel to the chain of its sums.
fn add_to(head: &mut u32, sums: &mut Vec<Sum>, key: Option<(PolygonId, Side)>, cell: u32, area: f64, moment: DVec2) {
    let mut next = *head;
    while next != NONE {
        let sum = &mut sums[next as usize];
        if sum.key == key {
            sum.area += area;
            sum.moment += moment;
            sum.cells += 1;
            if area > sum.largest.0 {
                sum.largest = (area, cell, moment / area);
            }
            return;
        }
        next = sum.next;
    }
    sums.push(Sum { key, area, moment, cells: 1, largest: (area, cell, moment / area), next: *head });
    *head = sums.len() as u32 - 1;
}

/// Cuts convex polygons along pixels.
#[derive(Default)]
struct Knife {
    strip: Vec<DVec2>,
    rest: Vec<DVec2>,
    part: Vec<DVec2>,
    other: Vec<DVec2>,
}

impl Knife {
    /// Calls with column, row, area and first moment (area times centroid) of what a convex polygon has in each pixel within columns and rows.
    fn cut(&mut self, ring: &[DVec2], columns: [u32; 2], rows: [u32; 2], mut f: impl FnMut(u32, u32, f64, DVec2)) {
        let (low, high) =
            ring.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
        let [left, right] = columns.map(f64::from);
        if high.x <= left || low.x >= right {
            return;
        }
        let first = (low.y.max(0.0) as u32).max(rows[0]);
        let end = (high.y.max(0.0).ceil() as u32).min(rows[1]);
        for y in first..end {
            halve(ring, 1, f64::from(y), &mut self.rest, None);
            halve(&self.rest, 1, f64::from(y + 1), &mut self.other, Some(&mut self.strip));
            let (from, to) = extent(&self.strip);
            if self.strip.len() < 3 || to <= left || from >= right {
                continue;
            }
            let first = from.max(left) as u32;
            // What is to the left of the columns is cut off.
            halve(&self.strip, 0, f64::from(first), &mut self.rest, None);
            for x in first..(to.min(right).ceil() as u32) {
                halve(&self.rest, 0, f64::from(x + 1), &mut self.other, Some(&mut self.part));
                std::mem::swap(&mut self.rest, &mut self.other);
                let (area, moment) = area_and_moment(&self.part, DVec2::new(f64::from(x), f64::from(y)));
                if area > 0.0 {
                    f(x, y, area, moment);
                }
            }
        }
    }
}

/// The least and the largest x.
fn extent(ring: &[DVec2]) -> (f64, f64) {
    ring.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.x), high.max(p.x)))
}

/// Cuts a convex polygon at a line across an axis: what is beyond, and what is before.
fn halve(ring: &[DVec2], axis: usize, at: f64, beyond: &mut Vec<DVec2>, mut before: Option<&mut Vec<DVec2>>) {
    beyond.clear();
    if let Some(before) = &mut before {
        before.clear();
    }
    for (k, &p) in ring.iter().enumerate() {
        let q = ring[if k + 1 == ring.len() { 0 } else { k + 1 }];
        let (a, b) = (p[axis] - at, q[axis] - at);
        if a >= 0.0 {
            beyond.push(p);
        }
        if let Some(before) = &mut before
            && a <= 0.0
        {
            before.push(p);
        }
        if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
            let mut crossing = p + (q - p) * (a / (a - b));
            crossing[axis] = at;
            beyond.push(crossing);
            if let Some(before) = &mut before {
                before.push(crossing);
            }
        }
    }
}

/// The area of a polygon that runs either way, and its first moment, summed about a corner near it.
fn area_and_moment(ring: &[DVec2], near: DVec2) -> (f64, DVec2) {
    let (mut double, mut moment) = (0.0, DVec2::ZERO);
    for (k, &p) in ring.iter().enumerate() {
        let (p, q) = (p - near, ring[if k + 1 == ring.len() { 0 } else { k + 1 }] - near);
        let cross = p.perp_dot(q);
        double += cross;
        moment += (p + q) * cross;
    }
    let sign = if double < 0.0 { -1.0 } else { 1.0 };
    let area = 0.5 * sign * double;
    // Within the pixel, whatever rounding does to slivers.
    let centroid = (moment * (sign / 6.0) / area).clamp(DVec2::ZERO, DVec2::ONE);
    (area, (centroid + near) * area)
}
