//! The contour image and its cells.

use super::domain::Domain;
use super::order::SceneOrder;
use super::polygon::PolygonArc;
use super::tree::{ContourTree, LeafState, Link};
use super::view::{CellBuffers, ViewStats};
use super::viewpoint::Viewpoint;
use super::windows::Horizon;
use crate::bsp::{Skeleton, UncutSliver};
use crate::exact::Sign;
use crate::scene::{PieceId, PolygonId, Scene, Side, Splitter};
use glam::DVec3;

/// A cell of a [`ContourImage`], numbered from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CellId(pub u32);

impl CellId {
    /// The number as an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The exact subdivision of a domain of directions into convex cells, each with the polygon seen in
/// all of it, or with nothing.
#[derive(Clone, Debug)]
pub struct ContourImage {
    order: SceneOrder,
    viewpoint: Viewpoint,
    domain: Domain,
    pub(super) tree: ContourTree,
    /// The leaves of the tree that are cells, in the order of their making, and the reverse.
    leaves: Vec<u32>,
    pub(super) cell_of_leaf: Vec<Option<CellId>>,
    stats: ViewStats,
}

impl ContourImage {
    pub(super) fn new(
        order: SceneOrder,
        viewpoint: Viewpoint,
        domain: Domain,
        tree: ContourTree,
        stats: ViewStats,
        CellBuffers { mut leaves, mut cell_of_leaf }: CellBuffers,
    ) -> Self {
        leaves.clear();
        cell_of_leaf.clear();
        cell_of_leaf.reserve(tree.leaves.len());
        for (k, leaf) in tree.leaves.iter().enumerate() {
            let is_cell = leaf.state != LeafState::Outside;
            cell_of_leaf.push(is_cell.then_some(CellId(leaves.len() as u32)));
            if is_cell {
                leaves.push(k as u32);
            }
        }
        Self { order, viewpoint, domain, tree, leaves, cell_of_leaf, stats }
    }

    /// What another image can use again.
    pub(super) fn into_memory(self) -> (ContourTree, CellBuffers) {
        (self.tree, CellBuffers { leaves: self.leaves, cell_of_leaf: self.cell_of_leaf })
    }

    /// The scene that is seen.
    pub fn scene(&self) -> &Scene {
        self.order.scene()
    }

    pub(crate) fn skeleton(&self) -> &Skeleton {
        self.order.skeleton()
    }

    /// What a 3D BSP left uncut because of its epsilon; empty if that is 0, and without a BSP.
    pub fn uncut_slivers(&self) -> &[UncutSliver] {
        self.order.uncut_slivers()
    }

    /// The epsilon of the 3D BSP, in scene units; 0 without one.
    pub fn epsilon(&self) -> f64 {
        self.order.epsilon()
    }

    /// Where it was seen from.
    pub fn viewpoint(&self) -> &Viewpoint {
        &self.viewpoint
    }

    /// The directions it covers.
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// The unit normal of the receiver, for hemispheres and windows that end at a horizon.
    pub fn normal(&self) -> Option<DVec3> {
        match self.domain.horizon()? {
            Horizon::Normal(normal) => Some((normal / normal.abs().max_element()).normalize()),
            Horizon::Surface => self.viewpoint.surface_normal(self.scene(), self.skeleton()),
        }
    }

    /// What it took to make it.
    pub fn stats(&self) -> &ViewStats {
        &self.stats
    }

    /// The number of cells.
    pub fn cell_count(&self) -> usize {
        self.leaves.len()
    }

    /// A cell by its number.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn cell(&self, id: CellId) -> Cell<'_> {
        Cell { image: self, id, leaf: self.leaves[id.index()] }
    }

    /// All cells; together they cover the domain, and no two overlap.
    pub fn cells(&self) -> impl ExactSizeIterator<Item = Cell<'_>> {
        (0..self.leaves.len() as u32).map(|k| self.cell(CellId(k)))
    }

    /// The stretches of splitters that separate the cells from each other and from what is outside of
    /// the domain, by cell: what `--show-tree` draws.
    pub fn tree_arcs(&self) -> Vec<TreeArc> {
        let mut arcs = Vec::new();
        for cell in self.cells() {
            let sides = cell.arcs();
            let mut ends_domain = vec![false; sides.len()];
            for neighbour in cell.neighbours() {
                ends_domain[neighbour.side] |= neighbour.cell.is_none();
            }
            for (k, side) in sides.iter().enumerate() {
                // Both neighbours have the stretch: it is taken from the positive side.
                if side.along.inside().is_positive() || ends_domain[k] {
                    let next = sides[(k + 1) % sides.len()];
                    let ends = [side.from, next.from].map(|d| self.tree.directions.unit(d));
                    let splitter = self.tree.directions.splitter(self.skeleton(), side.along.circle());
                    arcs.push(TreeArc { ends, splitter });
                }
            }
        }
        arcs
    }

    /// All directions of the image in floating point, of any lengths; some may be corners of no cell.
    pub(crate) fn directions(&self) -> impl ExactSizeIterator<Item = DVec3> {
        self.tree.directions.approximations().iter().map(|direction| direction.v)
    }

    /// True if the plane of a piece separates a point from the eye: if both are strictly on different sides of it.
    pub(crate) fn is_behind(&self, piece: PieceId, point: DVec3) -> bool {
        let plane = self.scene().piece(piece).plane_id();
        let [eye, other] = [self.viewpoint.eye(), point].map(|p| self.skeleton().position_side(plane, p));
        eye * other == Sign::Negative
    }

    pub(super) fn root(&self) -> Link {
        self.tree.root
    }
}

/// A stretch of a splitter of the contour tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeArc {
    /// Its ends, as unit directions less than pi apart.
    pub ends: [DVec3; 2],
    /// The splitter it is part of.
    pub splitter: Splitter,
}

/// A convex cell of a [`ContourImage`].
#[derive(Clone, Copy, Debug)]
pub struct Cell<'a> {
    image: &'a ContourImage,
    id: CellId,
    leaf: u32,
}

impl<'a> Cell<'a> {
    /// Its number.
    pub fn id(self) -> CellId {
        self.id
    }

    /// The image it is part of.
    pub fn image(self) -> &'a ContourImage {
        self.image
    }

    /// The polygon seen in it; `None` for background.
    pub fn polygon(self) -> Option<PolygonId> {
        self.piece().map(|id| self.image.scene().piece(id).polygon())
    }

    /// The piece of the polygon seen in it.
    pub fn piece(self) -> Option<PieceId> {
        match self.image.tree.leaves[self.leaf as usize].state {
            LeafState::Filled(piece) => Some(piece),
            LeafState::Open | LeafState::Outside => None,
        }
    }

    /// The side of the polygon seen in it.
    pub fn side(self) -> Option<Side> {
        self.image.skeleton().shown_side(self.image.scene().piece(self.piece()?), self.image.viewpoint.eye())
    }

    /// Its corners as unit directions, counter-clockwise seen from outside of the sphere. Rounded:
    /// slivers may repeat a direction.
    pub fn boundary(self) -> impl ExactSizeIterator<Item = DVec3> + Clone + 'a {
        self.arcs().iter().map(move |arc| self.image.tree.directions.unit(arc.from))
    }

    /// The numbers of its corners among the directions of the image.
    pub(crate) fn corners(self) -> impl ExactSizeIterator<Item = usize> + Clone + 'a {
        self.arcs().iter().map(|arc| arc.from.0 as usize)
    }

    /// The great circles it is bounded by, each with the sign that directions inside have: number `k`
    /// leads from corner `k` to corner `k + 1`.
    pub fn splitters(self) -> impl ExactSizeIterator<Item = (Splitter, Sign)> + 'a {
        let skeleton = self.image.skeleton();
        let directions = &self.image.tree.directions;
        self.arcs().iter().map(move |arc| (directions.splitter(skeleton, arc.along.circle()), arc.along.inside()))
    }

    /// Where the ray in a unit direction meets the plane of the polygon seen; `None` for background.
    pub fn point_at(self, direction: DVec3) -> Option<DVec3> {
        let skeleton = self.image.skeleton();
        let plane = self.image.scene().piece(self.piece()?).plane_id();
        let normal = skeleton.approx_normal(plane).v;
        let eye = self.image.viewpoint.eye();
        let point = eye + direction * (normal.dot(skeleton.anchor(plane) - eye) / normal.dot(direction));
        point.is_finite().then_some(point)
    }

    pub(super) fn arcs(self) -> &'a [PolygonArc] {
        self.image.tree.boundary(self.leaf)
    }
}
