//! The hemicube: what it keeps between views, and a view.

use super::delta::DeltaFactors;
use super::error::BaselineError;
use super::face::{Face, frame};
use super::geometry::{Geometry, Seen};
use super::raster::{Band, Draw, Rasteriser, band_rows, distribute};
use super::runs::for_runs;
use crate::contour::Viewpoint;
use crate::scene::{PieceId, PolygonId, Scene};
use glam::DVec3;

/// A hemicube for the views of one scene.
///
/// The top face has `resolution` x `resolution` pixels, each of the four side faces half as many. A pixel shows the
/// polygon that is nearest at its centre, whichever side it shows, and counts with its exact form factor: the factors of all
/// pixels add up to 1, which the classic delta form factors, taken at the centres, do not.
///
/// Every view transforms every vertex and looks at every piece; there is no culling structure. Depths are f32, so surfaces closer
/// to each other than about 1e-7 of their distance may show through each other; of equally near pieces the first is
/// taken. Coordinates are scaled by a power of two in each view, so that they may be of any size; what is smaller than about 1e-150 of the
/// farthest vertex is not drawn. Buffers are kept: a view allocates nothing once lists have grown. The same input gives the same bits.
///
/// ```
/// use nusselt::contour::Viewpoint;
/// use nusselt::hemicube::Hemicube;
///
/// let scene = nusselt::samples::cornell_box().to_builder().build()?;
/// let mut hemicube = Hemicube::new(&scene, 256)?;
/// let view = hemicube.view(&Viewpoint::free(glam::DVec3::new(278.0, 273.0, 1.0)), glam::DVec3::Z)?;
/// assert!((view.total() - 1.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Hemicube {
    pub(super) scene: Scene,
    resolution: usize,
    pub(super) geometry: Geometry,
    delta: DeltaFactors,
    rasteriser: Rasteriser,
    pub(super) seen: Seen,
    lists: [Vec<Draw>; 5],
    /// The pieces seen, row by row and face by face; the number of pieces is background.
    items: Vec<u32>,
    /// The polygon of each piece; for background the number of polygons.
    pub(super) polygons: Vec<u32>,
    /// By polygon, with background at the end.
    pub(super) factors: Vec<f64>,
    /// The pixels that each piece would cover alone.
    pub(super) covered: Vec<u32>,
    /// The sums over the pixels in which each piece is seen, and their number; for [`Hemicube::analytic`].
    pub(super) pixels: Vec<(f64, u32)>,
}

/// What a view took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HemicubeStats {
    /// Pieces drawn, on how many faces: those that may cover the centre of a pixel.
    pub drawn: usize,
    /// Pixels that they covered, hidden or not.
    pub covered: u64,
    /// Pixels of the hemicube: each is one evaluation of a form factor.
    pub pixels: usize,
}

impl Hemicube {
    /// The largest resolution.
    pub const MAX_RESOLUTION: usize = 4096;

    /// A hemicube of that resolution, an even number. It takes about 36 bytes for each pixel of the top face.
    ///
    /// # Errors
    /// If the resolution is odd, 0 or larger than [`Self::MAX_RESOLUTION`].
    pub fn new(scene: &Scene, resolution: usize) -> Result<Self, BaselineError> {
        Self::check(resolution)?;
        let geometry = Geometry::new(scene);
        let background = scene.polygon_count() as u32;
        let pieces = geometry.piece_count();
        Ok(Self {
            scene: scene.clone(),
            resolution,
            delta: DeltaFactors::new(resolution),
            rasteriser: Rasteriser::new(resolution),
            seen: Seen::default(),
            lists: Default::default(),
            items: vec![0; 3 * resolution * resolution],
            polygons: scene.pieces().map(|piece| piece.polygon().0).chain([background]).collect(),
            factors: vec![0.0; scene.polygon_count() + 1],
            covered: vec![0; pieces],
            pixels: Vec::new(),
            geometry,
        })
    }

    /// Refuses what is no resolution.
    pub(crate) fn check(resolution: usize) -> Result<(), BaselineError> {
        let is_one = resolution != 0 && resolution.is_multiple_of(2) && resolution <= Self::MAX_RESOLUTION;
        if is_one { Ok(()) } else { Err(BaselineError::BadResolution { resolution }) }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The number of rows and columns of the top face.
    pub fn resolution(&self) -> usize {
        self.resolution
    }

    /// What is seen above the tangent plane at a viewpoint, for a normal of any length. If the viewpoint is on a piece, that piece and
    /// what shares its plane are not drawn.
    ///
    /// # Errors
    /// If the eye is not finite, the normal has no direction, or the viewpoint is on a piece of another scene.
    pub fn view(&mut self, viewpoint: &Viewpoint, normal: DVec3) -> Result<HemicubeView<'_>, BaselineError> {
        let stats = self.draw(viewpoint, normal)?;
        let Self { factors, polygons, .. } = self;
        factors.fill(0.0);
        let width = self.resolution;
        for (row, antiderivative) in rows(&self.items, &self.delta, width) {
            for_runs(row, antiderivative, |piece, factor, _| factors[polygons[piece as usize] as usize] += factor);
        }
        let frame = frame(normal).ok_or(BaselineError::BadNormal)?;
        Ok(HemicubeView { hemicube: self, stats, frame })
    }

    /// Fills the item buffer.
    pub(super) fn draw(&mut self, viewpoint: &Viewpoint, normal: DVec3) -> Result<HemicubeStats, BaselineError> {
        let floor = BaselineError::check_viewpoint(viewpoint, &self.scene)?;
        let frame = frame(normal).ok_or(BaselineError::BadNormal)?;
        let scene = &self.scene;
        let on_floor = |piece: usize| floor.is_some_and(|plane| scene.piece(PieceId(piece as u32)).plane_id() == plane);
        let width = self.resolution;
        self.geometry.transform(viewpoint.eye(), frame, width, &mut self.seen);
        distribute(&self.geometry, &self.seen, width, on_floor, &mut self.lists);
        self.covered.fill(0);
        let background = self.covered.len() as u32;
        let mut items = self.items.as_mut_slice();
        for (face, list) in Face::ALL.into_iter().zip(&self.lists) {
            let (own, rest) = items.split_at_mut(face.rows(width) * width);
            items = rest;
            let step = band_rows(width);
            for (k, items) in own.chunks_mut(step * width).enumerate() {
                items.fill(background);
                self.rasteriser.clear();
                let rows = k * step..k * step + items.len() / width;
                let mut band = Band { rows: rows.clone(), items };
                for draw in list.iter().filter(|draw| draw.meets(&rows)) {
                    let normal = self.geometry.normal(draw.piece());
                    let normal = DVec3::from(frame.map(|axis| axis.dot(normal)));
                    let covered = self.rasteriser.draw(face, &self.geometry, &self.seen, normal, draw, &mut band);
                    self.covered[draw.piece()] += covered;
                }
            }
        }
        Ok(HemicubeStats {
            drawn: self.lists.iter().map(Vec::len).sum(),
            covered: self.covered.iter().map(|&pixels| u64::from(pixels)).sum(),
            pixels: self.items.len(),
        })
    }

    /// Sums by piece over the item buffer, into `pixels`; the last is background.
    pub(super) fn sum_by_piece(&mut self) {
        let Self { pixels, .. } = self;
        pixels.clear();
        pixels.resize(self.covered.len() + 1, (0.0, 0));
        for (row, antiderivative) in rows(&self.items, &self.delta, self.resolution) {
            for_runs(row, antiderivative, |piece, factor, length| {
                let (sum, count) = &mut pixels[piece as usize];
                *sum += factor;
                *count += length as u32;
            });
        }
    }
}

/// The rows of the item buffer, each with its antiderivative of the form factor.
fn rows<'a>(items: &'a [u32], delta: &'a DeltaFactors, width: usize) -> impl Iterator<Item = (&'a [u32], &'a [f64])> {
    delta.rows().map(move |(row, antiderivative)| (&items[row * width..][..width], antiderivative))
}

/// What a hemicube shows.
#[derive(Clone, Copy, Debug)]
pub struct HemicubeView<'a> {
    hemicube: &'a Hemicube,
    stats: HemicubeStats,
    frame: [DVec3; 3],
}

/// A pixel of a hemicube.
#[derive(Clone, Copy, Debug)]
pub struct HemicubePixel {
    /// The piece that is nearest at its centre; `None` for background.
    pub piece: Option<PieceId>,
    /// Its form factor.
    pub factor: f64,
    /// Its centre in the frame of the hemicube.
    centre: [f64; 3],
    frame: [DVec3; 3],
}

impl HemicubePixel {
    /// The unit direction to its centre.
    pub fn direction(&self) -> DVec3 {
        let [x, y, z] = self.centre;
        (self.frame[0] * x + self.frame[1] * y + self.frame[2] * z).normalize()
    }
}

impl<'a> HemicubeView<'a> {
    /// The form factor of every polygon by its number, 0 for those that are not seen.
    pub fn factors(&self) -> &'a [f64] {
        let factors = &self.hemicube.factors;
        &factors[..factors.len() - 1]
    }

    /// The form factor of a polygon.
    ///
    /// # Panics
    /// If there is no polygon of that number.
    pub fn of(&self, polygon: PolygonId) -> f64 {
        self.factors()[polygon.index()]
    }

    /// The polygons that are seen, by ascending number, with their form factors.
    pub fn visible(&self) -> impl Iterator<Item = (PolygonId, f64)> + use<'a> {
        let factors = self.factors().iter().enumerate().filter(|&(_, &factor)| factor > 0.0);
        factors.map(|(k, &factor)| (PolygonId(k as u32), factor))
    }

    /// Where nothing is seen.
    pub fn background(&self) -> f64 {
        self.hemicube.factors[self.hemicube.factors.len() - 1]
    }

    /// Over all polygons and the background: 1 up to rounding.
    pub fn total(&self) -> f64 {
        self.hemicube.factors.iter().sum()
    }

    /// The piece seen in each pixel of a face, row by row; `None` for background.
    pub fn pieces(&self, face: Face) -> impl ExactSizeIterator<Item = Option<PieceId>> + use<'a> {
        let width = self.hemicube.resolution;
        let first = face.first_row(width) * width;
        let background = self.hemicube.covered.len() as u32;
        let items = &self.hemicube.items[first..first + face.rows(width) * width];
        items.iter().map(move |&item| (item != background).then_some(PieceId(item)))
    }

    /// Calls with every pixel, always in the same order; their form factors sum to 1.
    pub fn for_each_pixel(&self, mut f: impl FnMut(HemicubePixel)) {
        let Hemicube { items, delta, resolution, covered, .. } = self.hemicube;
        let width = *resolution;
        let at = |k: usize| (2 * k + 1) as f64 / width as f64;
        for (row, antiderivative) in delta.rows() {
            let (face, v) = if row < width {
                (Face::Top, at(row) - 1.0)
            } else {
                let side = row - width;
                (Face::ALL[1 + side / (width / 2)], at(side % (width / 2)))
            };
            for (column, &item) in items[row * width..][..width].iter().enumerate() {
                f(HemicubePixel {
                    piece: (item as usize != covered.len()).then_some(PieceId(item)),
                    factor: antiderivative[column + 1] - antiderivative[column],
                    centre: face.to_frame([at(column) - 1.0, v, 1.0]),
                    frame: self.frame,
                });
            }
        }
    }

    /// What it took.
    pub fn stats(&self) -> HemicubeStats {
        self.stats
    }
}
