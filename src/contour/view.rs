//! Making a contour image: the walk through the 3D BSP and what it puts into the contour tree.

use super::directions::{CircleId, DirectionId, Directions, ExactCache};
use super::domain::Domain;
use super::image::ContourImage;
use super::polygon::{HalfSphere, PolygonArc};
use super::subdivision::subdivide;
use super::tree::{ContourTree, Workspace};
use super::viewpoint::Viewpoint;
use crate::bsp::{FragmentId, LineDef, LineId, PointId, SceneBsp, Step, Tree};
use crate::exact::{PredicateStats, Sign};
use crate::scene::Side;
use glam::DVec3;

/// How a view is made. None of it changes what is seen, only the cost and how cells are cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ViewOptions {
    /// Levels of the quadtree at the top of the contour tree: 0 for octants only, 1 for quarter faces
    /// of a cube, each further one quarters those. `None` chooses by the size of the scene. At most 8.
    pub quadtree_depth: Option<u32>,
    /// The view ends with an error when it has more cells than this: edges that all cross each other, as
    /// seen from the eye, make about the square of their number. The default, 2^25, takes about 5 GiB.
    pub max_cells: usize,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self { quadtree_depth: None, max_cells: 1 << 25 }
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
    /// More levels than 8.
    #[error("the quadtree takes at most 8 levels, not {depth}")]
    TooDeep {
        /// The levels asked for.
        depth: u32,
    },
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
    /// Fragments put into the contour tree.
    pub inserted: usize,
    /// Subtrees of the 3D BSP that were left out because nothing in them can be seen.
    pub skipped_subtrees: usize,
    /// Nodes of the contour tree that fragments went through.
    pub visited_nodes: u64,
    /// Sides of great circles that were asked for, and what decided them.
    pub predicates: PredicateStats,
}

impl SceneBsp {
    /// The contour image from a viewpoint.
    ///
    /// # Errors
    /// If the eye or a normal is not finite or zero, or if the domain does not suit the viewpoint.
    pub fn view(&self, viewpoint: &Viewpoint, domain: &Domain) -> Result<ContourImage, ViewError> {
        self.view_with(viewpoint, domain, &ViewOptions::default())
    }

    /// The same with options.
    ///
    /// # Errors
    /// As [`SceneBsp::view`]; also if the quadtree is to have too many levels, or if there are too many
    /// cells.
    pub fn view_with(
        &self,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
    ) -> Result<ContourImage, ViewError> {
        let eye = viewpoint.eye();
        if !eye.is_finite() {
            return Err(ViewError::EyeNotFinite);
        }
        let depth = options.quadtree_depth.unwrap_or_else(|| default_depth(self.scene().polygon_count()));
        if depth > 8 {
            return Err(ViewError::TooDeep { depth });
        }
        let tree = &self.tree;
        let mut work = Workspace::default();
        let directions = Directions::new(&tree.skeleton, eye);
        let mut contour = ContourTree::octants(&tree.skeleton, directions, &mut work.knife);
        if let Some(horizon) = horizon(tree, viewpoint, domain, &mut contour.directions, &mut work.knife.cache)? {
            contour.clip(&tree.skeleton, horizon, &mut work);
        }
        subdivide(&mut contour, &tree.skeleton, depth, &mut work);
        let mut builder = ViewBuilder {
            tree,
            eye,
            contour,
            work,
            line_circles: vec![NONE; tree.skeleton.line_count()],
            point_directions: vec![NONE; tree.skeleton.point_count()],
            polygon: Vec::new(),
            stats: ViewStats::default(),
        };
        builder.walk(options.max_cells)?;
        let ViewBuilder { contour, work, mut stats, .. } = builder;
        stats.visited_nodes = work.visited;
        stats.predicates = work.knife.cache.predicates();
        Ok(ContourImage::new(self.clone(), *viewpoint, *domain, contour, stats))
    }
}

/// The horizon of a domain, if it has one.
fn horizon(
    tree: &Tree,
    viewpoint: &Viewpoint,
    domain: &Domain,
    directions: &mut Directions,
    cache: &mut ExactCache,
) -> Result<Option<HalfSphere>, ViewError> {
    match *domain {
        Domain::Sphere => Ok(None),
        Domain::Hemisphere(normal) => {
            if !normal.is_finite() || normal == DVec3::ZERO {
                return Err(ViewError::BadNormal);
            }
            Ok(Some(HalfSphere::new(directions.push_given(&tree.skeleton, normal, cache), Sign::Positive)))
        }
        Domain::Above => {
            let (piece, side) = viewpoint.surface_piece().ok_or(ViewError::NotOnSurface)?;
            let piece = tree.scene.piece(piece);
            let circle = directions.push_parallel(&tree.skeleton, piece.plane_id(), cache);
            let up = if piece.facing() == side { Sign::Positive } else { Sign::Negative };
            Ok(Some(HalfSphere::new(circle, up)))
        }
    }
}

/// Levels of the quadtree for a scene of that size, by measurement (docs/performance.md).
fn default_depth(polygons: usize) -> u32 {
    match polygons {
        0..5_000 => 1,
        5_000..30_000 => 2,
        _ => 3,
    }
}

const NONE: u32 = u32::MAX;

struct ViewBuilder<'a> {
    tree: &'a Tree,
    eye: DVec3,
    contour: ContourTree,
    work: Workspace,
    /// The great circle of a line of the scene, the direction of a point, once they are needed.
    line_circles: Vec<u32>,
    point_directions: Vec<u32>,
    polygon: Vec<PolygonArc>,
    stats: ViewStats,
}

impl ViewBuilder<'_> {
    fn walk(&mut self, max_cells: usize) -> Result<(), ViewError> {
        let tree = self.tree;
        let mut stack = if tree.nodes.is_empty() { Vec::new() } else { vec![Step::Subtree(0)] };
        let mut fragments = Vec::new();
        while let Some(step) = stack.pop() {
            if self.contour.leaves.len() > max_cells {
                return Err(ViewError::TooManyCells { limit: max_cells });
            }
            if !self.contour.is_open() {
                break;
            }
            match step {
                Step::Subtree(node) => {
                    if self.contour.hides(self.eye, &tree.nodes[node as usize].bounds, &mut self.work) {
                        self.stats.skipped_subtrees += 1;
                    } else {
                        stack.extend(tree.steps(node, self.eye).into_iter().rev().flatten());
                    }
                }
                Step::Fragments(node) => {
                    fragments.clear();
                    tree.nearest_first(&tree.nodes[node as usize], self.eye, &mut fragments);
                    for &id in &fragments {
                        self.insert(id);
                    }
                }
            }
        }
        Ok(())
    }

    fn insert(&mut self, id: FragmentId) {
        let tree = self.tree;
        let fragment = tree.fragments[id.index()];
        let Some(shown) = tree.shown_side(fragment.piece, self.eye) else { return };
        let own = tree.scene.piece(fragment.piece);
        // On which side of the plane, as the plane is defined, the eye is.
        let height = if shown == own.facing() { Sign::Positive } else { Sign::Negative };
        let own = own.plane_id();
        let sides = &tree.sides[fragment.range()];
        self.polygon.clear();
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
            let (line, same_way) = tree.skeleton.representative(side.line);
            let forward = if side.forward == same_way { Sign::Positive } else { Sign::Negative };
            let inside = match tree.skeleton.line(line) {
                // (a - e) x (b - e) points inwards where the boundary runs from a to b.
                LineDef::Edge(_) => match shown {
                    Side::Back => forward,
                    Side::Front => -forward,
                },
                // On a plane at height h_1 under the eye, what is in front of the other plane has the
                // sign of -h_1 for the crease h_2 N_1 - h_1 N_2.
                LineDef::Crease([first, _]) => {
                    if first == own {
                        -(height * forward)
                    } else {
                        height * forward
                    }
                }
            };
            let from = self.direction(from);
            let along = HalfSphere::new(self.circle(line), inside);
            self.polygon.push(PolygonArc { from, along });
        }
        self.stats.inserted += 1;
        self.contour.insert(&tree.skeleton, &self.polygon, id, &mut self.work);
    }

    fn circle(&mut self, line: LineId) -> CircleId {
        let known = &mut self.line_circles[line.0 as usize];
        if *known == NONE {
            *known = self.contour.directions.push_line(&self.tree.skeleton, line, &mut self.work.knife.cache).0;
        }
        CircleId(*known)
    }

    fn direction(&mut self, point: PointId) -> DirectionId {
        let known = &mut self.point_directions[point.0 as usize];
        if *known == NONE {
            *known = self.contour.directions.push_point(&self.tree.skeleton, point, &mut self.work.knife.cache).0;
        }
        DirectionId(*known)
    }
}
