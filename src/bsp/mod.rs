//! The 3D BSP of a scene (Fuchs, Kedem and Naylor 1980): exact front-to-back order from any point.
//!
//! Built once a scene and shared by any number of threads. Near the root the splitting planes are
//! axis-aligned and chosen by a surface-area cost; below that they are planes of polygons, chosen
//! by a cost that weighs splits against balance. Pieces that a plane cuts become *fragments*: the
//! piece and the planes that cut it, so that the fragments of a piece tile it exactly.

mod build;
mod choose;
mod collinear;
mod fragment;
mod grow;
mod part;
mod skeleton;
mod split;
mod stats;
mod traverse;

pub use build::{BspError, BspOptions};
pub use choose::PlaneChoice;
pub use fragment::FragmentRef;
pub use stats::BspStats;
pub use traverse::{BackToFront, FrontToBack};

pub(crate) use fragment::{Bounds, FragmentSide, bounds_of, whole_piece};
pub(crate) use skeleton::{LineDef, LineId, PointId, Skeleton};
pub(crate) use traverse::Step;

use crate::scene::{PieceId, PlaneId, PolygonId, Scene, Side};
use std::ops::Range;
use std::sync::Arc;

/// A fragment: a piece of a polygon, or what the splitting planes left of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FragmentId(pub u32);

impl FragmentId {
    /// The number as an index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A fragment that pokes less than epsilon through a splitting plane and was not cut by it.
///
/// Only directions through such a polygon can see a wrong order, and only with an epsilon above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UncutSliver {
    /// The polygon that was not cut.
    pub polygon: PolygonId,
    /// The piece of it.
    pub piece: PieceId,
    /// The plane that would have cut it: one of [`Scene::planes`], an axis-aligned one, or one through three vertices.
    pub plane: crate::scene::SupportingPlane,
    /// The side of that plane on which its sliver is; `None` if it was taken to lie in the plane.
    pub beyond: Option<Side>,
}

#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) plane: PlaneId,
    pub(crate) back: Option<u32>,
    pub(crate) front: Option<u32>,
    /// The fragments in the node's plane, by ascending polygon number.
    pub(crate) fragments: Range<u32>,
    /// A box around all fragments in this node and below.
    pub(crate) bounds: Bounds,
}

#[derive(Debug)]
pub(crate) struct Tree {
    pub(crate) scene: Scene,
    pub(crate) skeleton: Skeleton,
    pub(crate) nodes: Vec<Node>,
    pub(crate) fragments: Vec<fragment::Fragment>,
    pub(crate) sides: Vec<FragmentSide>,
    slivers: Vec<UncutSliver>,
    stats: BspStats,
    epsilon: f64,
}

/// The 3D BSP of a scene. Cloning it is cheap: clones share their data.
#[derive(Clone, Debug)]
pub struct SceneBsp {
    pub(crate) tree: Arc<Tree>,
}

impl SceneBsp {
    /// The scene it was built for.
    pub fn scene(&self) -> &Scene {
        &self.tree.scene
    }

    /// Size, depth and splits.
    pub fn stats(&self) -> &BspStats {
        &self.tree.stats
    }

    /// The epsilon it was built with, in scene units.
    pub fn epsilon(&self) -> f64 {
        self.tree.epsilon
    }

    /// What was left uncut because of epsilon; empty if it is 0.
    pub fn uncut_slivers(&self) -> &[UncutSliver] {
        &self.tree.slivers
    }

    /// The number of fragments.
    pub fn fragment_count(&self) -> usize {
        self.tree.fragments.len()
    }

    /// A fragment by its id.
    ///
    /// # Panics
    /// If there is no such fragment.
    pub fn fragment(&self, id: FragmentId) -> FragmentRef<'_> {
        FragmentRef::new(&self.tree, id)
    }

    /// All fragments, in the order in which the tree keeps them.
    pub fn fragments(&self) -> impl ExactSizeIterator<Item = FragmentRef<'_>> {
        (0..self.tree.fragments.len() as u32).map(|k| self.fragment(FragmentId(k)))
    }
}
