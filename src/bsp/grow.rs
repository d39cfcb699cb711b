//! Growing a tree, or a subtree, from fragments: without recursion, one node after the other.

use super::build::BspError;
use super::choose::{Candidate, Choice, PlaneChoice, choose};
use super::fragment::{Bounds, Fragment, FragmentSide, bounds_of};
use super::skeleton::Skeleton;
use super::split::{Placement, Splitter};
use super::{Node, UncutSliver};
use crate::exact::Sign;
use crate::scene::{PieceId, PlaneId, PolygonId, Side};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A fragment on its way down.
#[derive(Clone, Debug)]
pub(super) struct Item {
    pub(super) piece: PieceId,
    pub(super) polygon: PolygonId,
    pub(super) own: PlaneId,
    pub(super) sides: Vec<FragmentSide>,
    pub(super) bounds: Bounds,
}

/// A node to be made: its fragments, its depth and the link that is to lead to it.
#[derive(Debug)]
pub(super) struct Job {
    pub(super) items: Vec<Item>,
    pub(super) depth: usize,
    pub(super) link: Option<Link>,
}

/// The place of a node: a side of its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub(super) parent: u32,
    pub(super) side: Side,
}

/// What holds for all parts of one tree.
#[derive(Debug)]
pub(super) struct Rules {
    pub(super) epsilon: f64,
    pub(super) planes: PlaneChoice,
    /// How many fragments there may be, and how many there are by now, in all parts.
    pub(super) max_fragments: usize,
    pub(super) fragments: AtomicUsize,
}

/// A tree in the making.
#[derive(Debug)]
pub(super) struct Grower {
    pub(super) skeleton: Skeleton,
    pub(super) nodes: Vec<Node>,
    pub(super) fragments: Vec<Fragment>,
    pub(super) sides: Vec<FragmentSide>,
    pub(super) slivers: Vec<UncutSliver>,
    pub(super) axis_nodes: usize,
    pub(super) splits: usize,
    pub(super) depth: usize,
    splitter: Splitter,
}

impl Grower {
    pub(super) fn new(skeleton: Skeleton) -> Self {
        Self {
            skeleton,
            nodes: Vec::new(),
            fragments: Vec::new(),
            sides: Vec::new(),
            slivers: Vec::new(),
            axis_nodes: 0,
            splits: 0,
            depth: 0,
            splitter: Splitter::default(),
        }
    }

    /// Makes the nodes of a job and of all below it, but those with at most `grain` fragments: they are given back.
    ///
    /// # Errors
    /// If there are too many fragments.
    pub(super) fn grow(&mut self, root: Job, grain: usize, rules: &Rules) -> Result<Vec<Job>, BspError> {
        let mut small = Vec::new();
        let mut jobs = vec![root];
        while let Some(job) = jobs.pop() {
            if job.items.is_empty() {
                continue;
            }
            if job.items.len() <= grain {
                small.push(job);
                continue;
            }
            let before = self.splits;
            self.make_node(job, rules, &mut jobs);
            let splits = self.splits - before;
            if rules.fragments.fetch_add(splits, Ordering::Relaxed) + splits > rules.max_fragments {
                return Err(BspError::TooManyFragments { limit: rules.max_fragments });
            }
        }
        Ok(small)
    }

    /// Makes a node known to its parent.
    pub(super) fn link(&mut self, link: Option<Link>, node: u32) {
        if let Some(Link { parent, side }) = link {
            let parent = &mut self.nodes[parent as usize];
            *(if side == Side::Front { &mut parent.front } else { &mut parent.back }) = Some(node);
        }
    }

    fn make_node(&mut self, Job { items, depth, link }: Job, rules: &Rules, jobs: &mut Vec<Job>) {
        let plane = self.choose_plane(&items, rules.planes);
        let node = self.nodes.len() as u32;
        self.link(link, node);
        let mut coplanar = Vec::new();
        let (mut back, mut front) = (Vec::new(), Vec::new());
        for item in items {
            let placement = self.splitter.place(&mut self.skeleton, &item.sides, item.own, plane, rules.epsilon);
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
                    self.splits += 1;
                    for (sides, half) in [(b, &mut back), (f, &mut front)] {
                        let bounds = bounds_of(&self.skeleton, &sides);
                        half.push(Item { sides, bounds, ..item });
                    }
                }
            }
        }
        let (fragments, bounds) = self.keep(coplanar);
        self.depth = self.depth.max(depth);
        if fragments.is_empty() {
            self.axis_nodes += 1;
        }
        self.nodes.push(Node { plane, back: None, front: None, fragments, bounds });
        for (items, side) in [(back, Side::Back), (front, Side::Front)] {
            jobs.push(Job { items, depth: depth + 1, link: Some(Link { parent: node, side }) });
        }
    }

    /// Either some fragment lies in the plane, or both sides get fewer fragments than there are: building always makes progress.
    fn choose_plane(&mut self, items: &[Item], how: PlaneChoice) -> PlaneId {
        let candidates: Vec<Candidate<'_>> =
            items.iter().map(|item| Candidate { bounds: item.bounds, own: item.own, sides: &item.sides }).collect();
        let skeleton = &self.skeleton;
        match choose(skeleton, &candidates, how, &|x| x.is_finite() && skeleton.bits.holds(x)) {
            Choice::Polygon(plane) => plane,
            Choice::Axis(axis, value) => self.skeleton.axis_plane(axis, value),
            Choice::Vertices { vertices, or } => {
                let plane = self.skeleton.vertex_plane(vertices);
                if self.divides(items, plane) { plane } else { or }
            }
        }
    }

    /// True if both sides of a plane get fewer fragments than there are, exactly.
    fn divides(&mut self, items: &[Item], plane: PlaneId) -> bool {
        let (mut back_lacks, mut front_lacks) = (false, false);
        for item in items {
            let (mut any_back, mut any_front) = (false, false);
            for side in &item.sides {
                let sign = self.skeleton.side(plane, side.point, &mut self.splitter.arena);
                any_back |= sign == Sign::Negative;
                any_front |= sign == Sign::Positive;
            }
            back_lacks |= !any_back;
            front_lacks |= !any_front;
            if back_lacks && front_lacks {
                return true;
            }
        }
        false
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
