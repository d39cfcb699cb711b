//! What is seen in each pixel of a camera's picture, with a point of it.

mod knife;
mod overlay;
#[cfg(test)]
mod tests;

use super::{Picture, SizeError};
use crate::contour::{Cell, CellId, ContourImage, Domain, Region, ViewFrame};
use crate::parallel;
use crate::scene::{PolygonId, Side};
use glam::{DVec2, DVec3, UVec2};
use knife::Knife;
use overlay::{Squares, overlay};
use std::ops::Range;

/// A part of a pixel: what is seen there of one side of one polygon, or of the background; of a flat mirror, as far as one side of one polygon is seen in it.
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
    /// What is seen there in a mirror, if that is known.
    pub(crate) reflected: Option<ReflectedPart>,
}

/// What is seen in a mirror at the same place of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ReflectedPart {
    /// The number of the mirror.
    pub(crate) mirror: usize,
    /// A unit direction in which the eye behind the mirror sees it.
    pub(crate) direction: DVec3,
    /// A cell of that eye's image that shows it in that direction.
    pub(crate) cell: CellId,
}

/// What a camera sees in flat mirrors: for each the image of the mirrored camera, of what is before the mirror.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reflections<'a> {
    pub(crate) images: Vec<&'a ContourImage>,
    /// For each cell of the camera's own image the mirror that it shows.
    pub(crate) of_cells: &'a [Option<usize>],
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
    /// Cells, and parts of those in which mirrors show something.
    facets: Vec<Facet>,
    /// Corners of all facets in pixels with y down, and where those of each begin and the last ones end.
    corners: Vec<DVec2>,
    starts: Vec<usize>,
    /// The numbers of the facets that reach into each band of rows.
    bands: Vec<Vec<u32>>,
    /// The parts of what mirrors show.
    mirrored: Vec<Self>,
}

/// A convex part of the picture.
#[derive(Clone, Copy, Debug)]
struct Facet {
    cell: u32,
    /// The mirror that it shows, and the cell of what is seen in that.
    reflected: Option<(u32, u32)>,
}

/// Rows of a band.
const BAND: u32 = 32;

/// A side of a polygon; `None` is background.
type Face = Option<(PolygonId, Side)>;

/// What a part shows, and what is seen in that.
#[derive(Clone, Copy, PartialEq)]
struct Key {
    face: Face,
    reflected: Option<(u32, Face)>,
}

/// What a pixel has of one polygon, as it is summed up.
#[derive(Clone, Copy)]
struct Sum {
    key: Key,
    area: f64,
    moment: DVec2,
    /// Of how many facets it is, and the largest of these with its area and centroid.
    facets: u32,
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
        Self::with_reflections(image, size, Reflections::default())
    }

    /// The same, with what is seen in mirrors apart.
    pub(crate) fn with_reflections(
        image: &'a ContourImage,
        size: UVec2,
        Reflections { images, of_cells }: Reflections<'a>,
    ) -> Result<Option<Self>, SizeError> {
        let Some(mut parts) = Self::empty(image, size)? else { return Ok(None) };
        for image in images {
            let Some(mut mirrored) = Self::empty(image, size)? else { return Ok(None) };
            for cell in image.cells() {
                let ring = cell.boundary().map(|direction| mirrored.flipped(mirrored.place(direction))).collect();
                mirrored.add(Facet { cell: cell.id().0, reflected: None }, ring);
            }
            parts.mirrored.push(mirrored);
        }
        let ring = |parts: &Self, cell: Cell<'_>| -> Vec<DVec2> {
            cell.boundary().map(|direction| parts.place(direction)).collect()
        };
        let mirror_of = |cell: CellId| of_cells.get(cell.index()).copied().flatten();
        let squares: Vec<Squares> = parts.mirrored.iter().map(Squares::of).collect();
        let mirrors = image.cells().filter_map(|cell| Some((cell, mirror_of(cell.id())?))).collect();
        let mut overlaid = parallel::map(mirrors, |(cell, mirror)| {
            overlay(&ring(&parts, cell), &parts.mirrored[mirror], &squares[mirror])
        })
        .into_iter();
        for cell in image.cells() {
            let number = cell.id().0;
            match mirror_of(cell.id()) {
                None => {
                    let ring = ring(&parts, cell);
                    parts.add(Facet { cell: number, reflected: None }, ring);
                }
                Some(mirror) => {
                    for (other, ring) in overlaid.next().into_iter().flatten() {
                        parts.add(Facet { cell: number, reflected: Some((mirror as u32, other)) }, ring);
                    }
                }
            }
        }
        Ok(Some(parts))
    }

    /// For the camera of an image, without any facet yet.
    fn empty(image: &'a ContourImage, size: UVec2) -> Result<Option<Self>, SizeError> {
        Picture::check_size(size)?;
        let Domain::Frustum(frustum) = image.domain() else { return Ok(None) };
        let half = (frustum.degrees() / 2.0).to_radians().tan();
        let reach = DVec2::new(half * frustum.aspect(), half);
        Ok(Some(Self {
            image,
            size,
            frame: frustum.frame(),
            corner: DVec2::new(-reach.x, reach.y),
            pixel: 2.0 * reach / size.as_dvec2(),
            facets: Vec::new(),
            corners: Vec::new(),
            starts: vec![0],
            bands: vec![Vec::new(); size.y.div_ceil(BAND) as usize],
            mirrored: Vec::new(),
        }))
    }

    /// Where a direction is in the picture.
    fn place(&self, direction: DVec3) -> DVec2 {
        let d = self.frame.components(direction);
        let p = d.truncate() / d.z;
        DVec2::new(p.x - self.corner.x, self.corner.y - p.y) / self.pixel
    }

    /// A place of a mirrored camera's picture in that of the camera: what is to the right for one is to the left for the other.
    fn flipped(&self, at: DVec2) -> DVec2 {
        DVec2::new(f64::from(self.size.x) - at.x, at.y)
    }

    /// Adds a convex part of the picture.
    fn add(&mut self, facet: Facet, ring: Vec<DVec2>) {
        let number = self.facets.len() as u32;
        for band in self.bands_of(&ring) {
            self.bands[band].push(number);
        }
        self.facets.push(facet);
        self.corners.extend(ring);
        self.starts.push(self.corners.len());
    }

    /// The bands of rows that a ring reaches into.
    fn bands_of(&self, ring: &[DVec2]) -> Range<usize> {
        let (low, high) =
            ring.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.y), high.max(p.y)));
        if ring.iter().all(|p| p.is_finite()) && high > 0.0 && low < f64::from(self.size.y) {
            let last = (high.min(f64::from(self.size.y) - 0.5) as u32) / BAND;
            ((low.max(0.0) as u32) / BAND) as usize..last as usize + 1
        } else {
            0..0
        }
    }

    /// The corners of a facet.
    fn ring(&self, facet: u32) -> &[DVec2] {
        &self.corners[self.starts[facet as usize]..self.starts[facet as usize + 1]]
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
            for &facet in &self.bands[band as usize] {
                let key = self.key(self.facets[facet as usize]);
                knife.cut(self.ring(facet), [low.x, high.x], [first, end], |x, y, area, moment| {
                    let head = &mut heads[(y - low.y) as usize * width + (x - low.x) as usize];
                    add_to(head, &mut sums, key, facet, area, moment);
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

    fn key(&self, Facet { cell, reflected }: Facet) -> Key {
        let reflected = reflected.map(|(mirror, cell)| {
            let image = self.mirrored[mirror as usize].image;
            (mirror, face(image.cell(CellId(cell))))
        });
        Key { face: face(self.image.cell(CellId(cell))), reflected }
    }

    /// What a sum says, with a direction in which it is seen.
    fn part(&self, sum: &Sum) -> Option<PixelPart> {
        let (_, largest, its_centroid) = sum.largest;
        let facet = self.facets[largest as usize];
        let centroid = sum.moment / sum.area;
        let at = if centroid.is_finite() { centroid } else { its_centroid };
        // What one facet has in a pixel is convex.
        let found = if sum.facets == 1 { Some(facet) } else { self.facet_at(at, sum.key) };
        let (facet, at) = found.map_or((facet, its_centroid), |facet| (facet, at));
        let reflected = facet.reflected.map(|(mirror, cell)| {
            let mirrored = &self.mirrored[mirror as usize];
            let direction = mirrored.direction(mirrored.flipped(at));
            ReflectedPart { mirror: mirror as usize, direction, cell: CellId(cell) }
        });
        let (polygon, side) = sum.key.face.unzip();
        let direction = self.direction(at);
        let part = PixelPart { polygon, side, area: sum.area, direction, cell: CellId(facet.cell), reflected };
        let is_finite = direction.is_finite() && reflected.is_none_or(|reflected| reflected.direction.is_finite());
        is_finite.then_some(part)
    }

    /// The cells of what is seen at a place of the picture, if that is what a key says.
    fn facet_at(&self, at: DVec2, key: Key) -> Option<Facet> {
        let cell = cell_at(self.image, self.direction(at), key.face)?;
        let reflected = match key.reflected {
            None => None,
            Some((mirror, face)) => {
                let mirrored = &self.mirrored[mirror as usize];
                Some((mirror, cell_at(mirrored.image, mirrored.direction(mirrored.flipped(at)), face)?))
            }
        };
        Some(Facet { cell, reflected })
    }
}

fn face(cell: Cell<'_>) -> Face {
    cell.polygon().zip(cell.side())
}

/// The cell of a direction that shows a face.
fn cell_at(image: &ContourImage, direction: DVec3, shown: Face) -> Option<u32> {
    image.locate(direction).regions().into_iter().find_map(|region| match region {
        Region::Cell(id) => (face(image.cell(id)) == shown).then_some(id.0),
        Region::Outside => None,
    })
}

/// Adds what a facet has in a pixel to the chain of its sums.
fn add_to(head: &mut u32, sums: &mut Vec<Sum>, key: Key, facet: u32, area: f64, moment: DVec2) {
    let mut next = *head;
    while next != NONE {
        let sum = &mut sums[next as usize];
        if sum.key == key {
            sum.area += area;
            sum.moment += moment;
            sum.facets += 1;
            if area > sum.largest.0 {
                sum.largest = (area, facet, moment / area);
            }
            return;
        }
        next = sum.next;
    }
    sums.push(Sum { key, area, moment, facets: 1, largest: (area, facet, moment / area), next: *head });
    *head = sums.len() as u32 - 1;
}
