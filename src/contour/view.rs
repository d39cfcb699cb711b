//! Making a contour image: the two ways to it, and what they share.

mod by_boxes;
mod by_bsp;
mod many;
mod outlook;
mod space;

pub use many::{ViewSpaces, ViewsError};
pub(super) use space::CellBuffers;
pub use space::ViewSpace;

use super::directions::{CircleId, DirectionId};
use super::domain::Domain;
use super::image::ContourImage;
use super::order::SceneOrder;
use super::polygon::{HalfSphere, PolygonArc};
use super::subdivision::{Quadtree, subdivide};
use super::tree::ContourTree;
use super::viewpoint::Viewpoint;
use crate::bsp::{FragmentSide, LineDef, LineId, PointId, Skeleton};
use crate::exact::{PredicateStats, Sign};
use crate::scene::{PieceRef, PolygonId, Scene, Side};
use glam::DVec3;
use space::Buffers;

/// How a view is made. None of it changes what is seen, only the cost and how cells are cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewOptions {
    /// Levels of the quadtree at the top of the contour tree: 0 for octants only, 1 for quarter faces
    /// of a cube or quarters of an image plane, each further one quarters those. `None` chooses by the size of the scene, 0 for windows. At most 8.
    pub quadtree_depth: Option<u32>,
    /// Where the quadtree lies.
    pub quadtree: Quadtree,
    /// The view ends with an error when it has more cells than this: edges that all cross each other, as
    /// seen from the eye, make about the square of their number. The default, 2^25, takes about 5 GiB.
    pub max_cells: usize,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self { quadtree_depth: None, quadtree: Quadtree::Cube, max_cells: 1 << 25 }
    }
}

/// Why there is no view.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The eye has a coordinate that is infinite or not a number.
    #[error("the eye has a coordinate that is not finite")]
    EyeNotFinite,
    /// The hemisphere's normal is zero, or not finite.
    #[error("the hemisphere's normal is zero or not finite")]
    BadNormal,
    /// `Domain::Above` asked for by a viewpoint that is not on a surface.
    #[error("the domain above a surface takes a viewpoint on a surface; give a normal instead")]
    NotOnSurface,
    /// A window that is no polygon of the scene.
    #[error("there is no polygon {polygon} to be a window: the scene has {count}, numbered from 0")]
    UnknownWindow {
        /// The number asked for.
        polygon: PolygonId,
        /// How many polygons there are.
        count: usize,
    },
    /// More levels than 8.
    #[error("the quadtree takes at most 8 levels, not {depth}")]
    TooDeep {
        /// The levels asked for.
        depth: u32,
    },
    /// A quadtree on an image plane, for another domain than a hemisphere, or with an angle across it that is not between 0 and 180 degrees.
    #[error("a quadtree on an image plane takes a hemisphere, and an angle above 0 and below 180 degrees")]
    NoImagePlane,
    /// The view falls into too many cells.
    #[error(
        "what is seen falls into more than {limit} cells; simplify the scene (ViewOptions::max_cells is the limit)"
    )]
    TooManyCells {
        /// How many are allowed.
        limit: usize,
    },
}

/// What a view took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ViewStats {
    /// Fragments, or whole pieces and panels of pieces, put into the contour tree.
    pub inserted: usize,
    /// Subtrees of the 3D BSP, or of the hierarchy of boxes, that were left out because nothing in them can be seen.
    pub skipped_subtrees: usize,
    /// Nodes of the contour tree that they went through.
    pub visited_nodes: u64,
    /// Sides of great circles that were asked for, and what decided them.
    pub predicates: PredicateStats,
}

/// Levels of the quadtree for a scene of that size: three classes, read off the table of quadtrees in docs/performance.md.
fn default_depth(polygons: usize, domain: &Domain) -> u32 {
    match polygons {
        _ if matches!(domain, Domain::Window(_)) => 0,
        0..30_000 => 1,
        30_000..100_000 => 2,
        _ => 3,
    }
}

/// A view that is being made.
pub(super) struct Sight<'a> {
    pub(super) skeleton: &'a Skeleton,
    pub(super) eye: DVec3,
    pub(super) contour: ContourTree,
    pub(super) buffers: Buffers,
    stats: ViewStats,
}

impl<'a> Sight<'a> {
    /// The domain, cut as the options say, with nothing seen in it yet. Takes the memory of `space`, which has it back in the end.
    fn new(
        scene: &Scene,
        skeleton: &'a Skeleton,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
        space: &mut ViewSpace,
    ) -> Result<Self, ViewError> {
        let eye = viewpoint.eye();
        if !eye.is_finite() {
            return Err(ViewError::EyeNotFinite);
        }
        let depth = options.quadtree_depth.unwrap_or_else(|| default_depth(scene.polygon_count(), domain));
        if depth > 8 {
            return Err(ViewError::TooDeep { depth });
        }
        if let Quadtree::Plane { degrees, .. } = options.quadtree
            && !(degrees > 0.0 && degrees < 180.0 && matches!(domain, Domain::Hemisphere(_) | Domain::Above))
        {
            return Err(ViewError::NoImagePlane);
        }
        let (former, mut buffers) = space.take(skeleton);
        let range = outlook::range(skeleton, domain);
        let contour = ContourTree::octants(skeleton, range, eye, former, &mut buffers.work.knife);
        let mut sight = Self { skeleton, eye, contour, buffers, stats: ViewStats::default() };
        let normal = sight.cut_out(scene, viewpoint, domain, options.max_cells)?;
        let Self { contour, buffers: Buffers { work, .. }, .. } = &mut sight;
        subdivide(contour, skeleton, options.quadtree, normal, depth, work);
        Ok(sight)
    }

    /// The error of a view that has too many cells by now.
    fn check_size(&self, max_cells: usize) -> Result<(), ViewError> {
        if self.contour.leaves.len() > max_cells {
            return Err(ViewError::TooManyCells { limit: max_cells });
        }
        Ok(())
    }

    /// The image; what it does not need goes back to `space`.
    fn finish(self, order: SceneOrder, viewpoint: &Viewpoint, domain: &Domain, space: &mut ViewSpace) -> ContourImage {
        let work = &self.buffers.work;
        let stats = ViewStats { visited_nodes: work.visited, predicates: work.knife.cache.predicates(), ..self.stats };
        let cells = space.give_back(self.buffers);
        ContourImage::new(order, *viewpoint, domain.clone(), self.contour, stats, cells)
    }

    /// Makes `polygon` the cone of a boundary on the plane of a piece, of which the eye is shown that side.
    pub(super) fn look_at(&mut self, piece: PieceRef<'_>, sides: &[FragmentSide], shown: Side) {
        self.buffers.polygon.clear();
        for k in 0..sides.len() {
            // Counter-clockwise around the front is clockwise on the sphere, seen from outside of it,
            // when the front is what is shown.
            let (side, from) = match shown {
                Side::Back => (sides[k], sides[k].point),
                Side::Front => {
                    let k = sides.len() - 1 - k;
                    (sides[k], sides[if k + 1 == sides.len() { 0 } else { k + 1 }].point)
                }
            };
            let from = self.direction(from);
            let along = self.half_sphere(piece, side, shown);
            self.buffers.polygon.push(PolygonArc { from, along });
        }
    }

    /// The half sphere of a side of a boundary on the plane of a piece, of which the eye is shown that side: the boundary's inside is in it.
    fn half_sphere(&mut self, piece: PieceRef<'_>, side: FragmentSide, shown: Side) -> HalfSphere {
        let (line, same_way) = self.skeleton.representative(side.line);
        let forward = if side.forward == same_way { Sign::Positive } else { Sign::Negative };
        let inside = match self.skeleton.line(line) {
            // (a - e) x (b - e) points inwards where the boundary runs from a to b.
            LineDef::Edge(_) => match shown {
                Side::Back => forward,
                Side::Front => -forward,
            },
            // On a plane at height h_1 under the eye, what is in front of the other plane has the
            // sign of -h_1 for the crease h_2 N_1 - h_1 N_2.
            LineDef::Crease([first, _]) => {
                // On which side of the plane, as the plane is defined, the eye is.
                let height = if shown == piece.facing() { Sign::Positive } else { Sign::Negative };
                if first == piece.plane_id() { -(height * forward) } else { height * forward }
            }
        };
        HalfSphere::new(self.circle(line), inside)
    }

    /// The half sphere of an edge between pieces of which the eye is shown that side, by the line that stands for all that are the same: the
    /// inside of what has the edge as a side is in it.
    fn along_edge(&mut self, side: FragmentSide, shown: Side) -> HalfSphere {
        debug_assert!(matches!(self.skeleton.line(side.line), LineDef::Edge(_)));
        let inside = if side.forward == (shown == Side::Back) { Sign::Positive } else { Sign::Negative };
        HalfSphere::new(self.circle(side.line), inside)
    }

    #[inline]
    fn circle(&mut self, line: LineId) -> CircleId {
        let Self { skeleton, contour, buffers, .. } = self;
        let make = || contour.directions.push_line(skeleton, line, &mut buffers.work.knife.cache).0;
        CircleId(buffers.circles.of(line.0, make))
    }

    #[inline]
    fn direction(&mut self, point: PointId) -> DirectionId {
        let Self { skeleton, contour, buffers, .. } = self;
        let make = || contour.directions.push_point(skeleton, point, &mut buffers.work.knife.cache).0;
        DirectionId(buffers.directions.of(point.0, make))
    }
}
