//! Building the tree, without recursion.

use super::choose::{Candidate, Choice, choose};
use super::fragment::{Bounds, Fragment, FragmentSide, bounds_of, whole_piece};
use super::skeleton::Skeleton;
use super::split::{Placement, Splitter};
use super::{BspStats, Node, SceneBsp, Tree, UncutSliver};
use crate::scene::{PieceId, PlaneId, PolygonId, Scene, Side};
use std::sync::Arc;

/// How a [`SceneBsp`] is built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BspOptions {
    /// A fragment that pokes less than this through a splitting plane, in scene units, is not cut
    /// there. The default is 0: exact order from every viewpoint.
    pub epsilon: f64,
    /// Building ends with an error when splits have made more fragments than this: polygons that all
    /// pass through each other make about the square of their number. `None` stands for 64 times the
    /// number of pieces, or 2^20 if that is more (about 0.4 GiB).
    pub max_fragments: Option<usize>,
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
    /// The scene falls into too many fragments.
    #[error(
        "the scene's polygons cut each other into more than {limit} fragments; simplify it (BspOptions::max_fragments is the limit)"
    )]
    TooManyFragments {
        /// How many are allowed.
        limit: usize,
    },
}

/// A fragment on its way down.
#[derive(Clone, Debug)]
struct Item {
    piece: PieceId,
    polygon: PolygonId,
    own: PlaneId,
    sides: Vec<FragmentSide>,
    bounds: Bounds,
}

/// A node to be made: its fragments, its depth and the link that is to lead to it.
struct Job {
    items: Vec<Item>,
    depth: usize,
    link: Option<(u32, bool)>,
}

impl SceneBsp {
    /// Builds the tree of a scene: about `n log n` time and memory for `n` polygons.
    ///
    /// # Errors
    /// If epsilon is not a finite number of at least 0, or if there are too many fragments.
    pub fn build(scene: &Scene, options: &BspOptions) -> Result<Self, BspError> {
        let epsilon = options.epsilon;
        if !(epsilon.is_finite() && epsilon >= 0.0) {
            return Err(BspError::BadEpsilon { epsilon });
        }
        let mut builder = Builder {
            skeleton: Skeleton::new(scene),
            splitter: Splitter::default(),
            nodes: Vec::new(),
            fragments: Vec::new(),
            sides: Vec::new(),
            slivers: Vec::new(),
            stats: BspStats::default(),
            epsilon,
            max_fragments: options.max_fragments.unwrap_or((64 * scene.piece_count()).max(1 << 20)),
        };
        builder.run(scene)?;
        let Builder { skeleton, mut nodes, fragments, sides, slivers, mut stats, .. } = builder;
        // A child has a higher number than its parent.
        for k in (0..nodes.len()).rev() {
            for child in [nodes[k].back, nodes[k].front].into_iter().flatten() {
                nodes[k].bounds = nodes[k].bounds.union(nodes[child as usize].bounds);
            }
        }
        stats.nodes = nodes.len();
        stats.fragments = fragments.len();
        stats.uncut_slivers = slivers.len();
        let tree = Tree { scene: scene.clone(), skeleton, nodes, fragments, sides, slivers, stats, epsilon };
        Ok(Self { tree: Arc::new(tree) })
    }
}

struct Builder {
    skeleton: Skeleton,
    splitter: Splitter,
    nodes: Vec<Node>,
    fragments: Vec<Fragment>,
    sides: Vec<FragmentSide>,
    slivers: Vec<UncutSliver>,
    stats: BspStats,
    epsilon: f64,
    max_fragments: usize,
}

impl Builder {
    fn run(&mut self, scene: &Scene) -> Result<(), BspError> {
        let items: Vec<Item> = scene
            .pieces()
            .map(|piece| {
                let sides = whole_piece(scene, piece.id());
                let bounds = bounds_of(&self.skeleton, &sides);
                Item { piece: piece.id(), polygon: piece.polygon(), own: piece.plane_id(), sides, bounds }
            })
            .collect();
        let mut jobs = vec![Job { items, depth: 1, link: None }];
        while let Some(job) = jobs.pop() {
            if !job.items.is_empty() {
                self.make_node(job, &mut jobs);
            }
            if scene.piece_count() + self.stats.splits > self.max_fragments {
                return Err(BspError::TooManyFragments { limit: self.max_fragments });
            }
        }
        Ok(())
    }

    fn make_node(&mut self, Job { items, depth, link }: Job, jobs: &mut Vec<Job>) {
        let plane = self.choose_plane(&items);
        let node = self.nodes.len() as u32;
        if let Some((parent, is_front)) = link {
            let parent = &mut self.nodes[parent as usize];
            *(if is_front { &mut parent.front } else { &mut parent.back }) = Some(node);
        }
        let mut coplanar = Vec::new();
        let (mut back, mut front) = (Vec::new(), Vec::new());
        for item in items {
            let placement = self.splitter.place(&mut self.skeleton, &item.sides, item.own, plane, self.epsilon);
            match placement {
                Placement::Coplanar { exactly } => {
                    self.note_sliver(&item, plane, exactly, None);
                    coplanar.push(item);
                }
                Placement::Front { exactly } => {
                    self.note_sliver(&item, plane, exactly, Some(Side::Back));
                    front.push(item);
                }
                Placement::Back { exactly } => {
                    self.note_sliver(&item, plane, exactly, Some(Side::Front));
                    back.push(item);
                }
                Placement::Spanning { back: b, front: f } => {
                    self.stats.splits += 1;
                    for (sides, half) in [(b, &mut back), (f, &mut front)] {
                        let bounds = bounds_of(&self.skeleton, &sides);
                        half.push(Item { sides, bounds, ..item });
                    }
                }
            }
        }
        let (fragments, bounds) = self.keep(coplanar);
        self.stats.depth = self.stats.depth.max(depth);
        if fragments.is_empty() {
            self.stats.axis_nodes += 1;
        }
        self.nodes.push(Node { plane, back: None, front: None, fragments, bounds });
        for (items, is_front) in [(back, false), (front, true)] {
            jobs.push(Job { items, depth: depth + 1, link: Some((node, is_front)) });
        }
    }

    fn choose_plane(&mut self, items: &[Item]) -> PlaneId {
        if let [only] = items {
            return only.own;
        }
        let candidates: Vec<Candidate<'_>> =
            items.iter().map(|item| Candidate { bounds: item.bounds, own: item.own, sides: &item.sides }).collect();
        let skeleton = &self.skeleton;
        match choose(skeleton, &candidates, &|x| x.is_finite() && skeleton.bits.holds(x)) {
            Choice::Polygon(plane) => plane,
            Choice::Axis(axis, value) => self.skeleton.axis_plane(axis, value),
        }
    }

    fn note_sliver(&mut self, item: &Item, plane: PlaneId, exactly: bool, beyond: Option<Side>) {
        if !exactly {
            let plane = self.skeleton.plane(plane);
            self.slivers.push(UncutSliver { polygon: item.polygon, piece: item.piece, plane, beyond });
        }
    }

    /// Keeps fragments for good, in ascending order of polygons and pieces.
    fn keep(&mut self, mut items: Vec<Item>) -> (std::ops::Range<u32>, Bounds) {
        items.sort_by_key(|item| item.piece);
        let first = self.fragments.len() as u32;
        let mut bounds = Bounds::EMPTY;
        for item in items {
            bounds = bounds.union(item.bounds);
            let (start, len) = (self.sides.len() as u32, item.sides.len() as u32);
            self.fragments.push(Fragment { piece: item.piece, polygon: item.polygon, start, len });
            self.sides.extend(item.sides);
        }
        (first..self.fragments.len() as u32, bounds)
    }
}
