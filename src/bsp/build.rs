//! Building the tree: its top first, then the subtrees below, each for itself.

use super::choose::PlaneChoice;
use super::fragment::{bounds_of, whole_piece};
use super::grow::{Grower, Item, Job, Rules};
use super::part::Subtree;
use super::skeleton::Skeleton;
use super::{BspStats, SceneBsp, Tree};
use crate::parallel;
use crate::scene::Scene;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;

/// How a [`SceneBsp`] is built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BspOptions {
    /// A fragment that pokes less than this through a splitting plane, in scene units, is not cut
    /// there. The default is 0: exact order from every viewpoint.
    pub epsilon: f64,
    /// How splitting planes are chosen.
    pub planes: PlaneChoice,
    /// Building ends with an error when splits have made more fragments than this: polygons that all
    /// pass through each other make about the square of their number. `None` stands for 16 times the
    /// number of pieces (about 5 KiB for each), or 2^20 if that is more (about 0.3 GiB).
    pub max_fragments: Option<usize>,
    /// Subtrees of at most this many fragments are grown apart from one another, so that threads can share the work; 0 for none. `None` stands
    /// for 1024, or a 64th of the scene's pieces if that is more. The tree divides space in the same way for any value.
    pub grain: Option<usize>,
}

/// Why a [`SceneBsp`] was not built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BspError {
    /// Epsilon is negative, infinite or not a number.
    #[error("epsilon is {epsilon}; it takes a finite distance of at least 0, in scene units")]
    BadEpsilon {
        /// The value given.
        epsilon: f64,
    },
    /// The scene falls into more fragments than [`BspOptions::max_fragments`].
    #[error(
        "the scene's polygons cut each other into more than {limit} fragments; simplify it, or leave out what is not needed"
    )]
    TooManyFragments {
        /// How many are allowed.
        limit: usize,
    },
}

/// The least number of fragments of subtrees that are grown apart, by default.
const GRAIN: usize = 1024;

impl SceneBsp {
    /// Builds the tree of a scene: about `n log n` time and memory for `n` polygons.
    ///
    /// With the feature `parallel` the subtrees below the top of the tree grow in the threads of the current `rayon` pool. The tree is the
    /// same for any number of threads, and without the feature.
    ///
    /// # Errors
    /// If epsilon is not a finite number of at least 0, or if there are too many fragments.
    pub fn build(scene: &Scene, options: &BspOptions) -> Result<Self, BspError> {
        let epsilon = options.epsilon;
        if !(epsilon.is_finite() && epsilon >= 0.0) {
            return Err(BspError::BadEpsilon { epsilon });
        }
        let rules = Rules {
            epsilon,
            planes: options.planes,
            max_fragments: options.max_fragments.unwrap_or((16 * scene.piece_count()).max(1 << 20)),
            fragments: AtomicUsize::new(scene.piece_count()),
        };
        if scene.piece_count() > rules.max_fragments {
            return Err(BspError::TooManyFragments { limit: rules.max_fragments });
        }
        let mut whole = Grower::new(Skeleton::new(scene));
        let root = Job { items: whole_pieces(scene, &whole.skeleton), depth: 1, link: None };
        let grain = options.grain.unwrap_or(GRAIN.max(scene.piece_count() / 64));
        // A scene that is one grain needs no parts.
        let grain = if root.items.len() <= grain { 0 } else { grain };
        let jobs = whole.grow(root, grain, &rules)?;
        let skeleton = &whole.skeleton;
        let subtrees = parallel::map(jobs, |job| Subtree::grow(skeleton, job, &rules));
        for subtree in subtrees {
            subtree?.graft(&mut whole);
        }
        Ok(Self { tree: Arc::new(finished(scene, whole, epsilon)) })
    }
}

fn whole_pieces(scene: &Scene, skeleton: &Skeleton) -> Vec<Item> {
    let items = scene.pieces().map(|piece| {
        let sides: Vec<_> = whole_piece(scene, piece.id()).collect();
        let bounds = bounds_of(skeleton, &sides);
        Item { piece: piece.id(), polygon: piece.polygon(), own: piece.plane_id(), sides, bounds }
    });
    items.collect()
}

fn finished(scene: &Scene, grower: Grower, epsilon: f64) -> Tree {
    let Grower { skeleton, mut nodes, fragments, sides, slivers, axis_nodes, splits, depth, .. } = grower;
    // A child has a higher number than its parent.
    for k in (0..nodes.len()).rev() {
        for child in [nodes[k].back, nodes[k].front].into_iter().flatten() {
            nodes[k].bounds = nodes[k].bounds.union(nodes[child as usize].bounds);
        }
    }
    let stats = BspStats {
        nodes: nodes.len(),
        axis_nodes,
        depth,
        splits,
        fragments: fragments.len(),
        uncut_slivers: slivers.len(),
    };
    Tree { scene: scene.clone(), skeleton, nodes, fragments, sides, slivers, stats, epsilon }
}
