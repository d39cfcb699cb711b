//! The contour tree: a 2D BSP on the sphere of directions.

mod claim;
pub(crate) mod divide;

use super::directions::{CircleId, DirectionId, Directions, ExactCache};
use super::polygon::{HalfSphere, Knife, PolygonArc, Sides, Span};
use crate::bsp::Skeleton;
use crate::exact::{BitRange, SeenBox, SeenPlane, Sign};
use crate::scene::PieceId;
use glam::DVec3;

/// A place in the tree: an inner node or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Link {
    Node(u32),
    Leaf(u32),
}

impl Link {
    /// In four bytes: a view has many nodes.
    #[inline]
    fn packed(self) -> u32 {
        match self {
            Self::Node(node) => node << 1,
            Self::Leaf(leaf) => leaf << 1 | 1,
        }
    }

    #[inline]
    fn unpacked(packed: u32) -> Self {
        if packed & 1 == 0 { Self::Node(packed >> 1) } else { Self::Leaf(packed >> 1) }
    }
}

/// In place of the number of a node above.
const NO_PARENT: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
pub(crate) struct TreeNode {
    pub(crate) circle: CircleId,
    /// The links to what is on its negative and on its positive side.
    children: [u32; 2],
    parent: u32,
    /// The greatest of the leaves below.
    far: f64,
}

impl TreeNode {
    #[inline]
    pub(crate) fn negative(&self) -> Link {
        Link::unpacked(self.children[0])
    }

    #[inline]
    pub(crate) fn positive(&self) -> Link {
        Link::unpacked(self.children[1])
    }
}

/// What is known of a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LeafState {
    /// Nothing seen in it yet.
    Open,
    /// Not part of the domain.
    Outside,
    /// A piece of a polygon is seen in it.
    Filled(PieceId),
}

/// A convex region of directions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub(crate) state: LeafState,
    /// Nothing that is at least this far from the eye can be seen in it: infinite if it is open.
    far: f64,
    boundary: Span,
    parent: u32,
}

/// The tree of one view, with its great circles and directions.
#[derive(Clone, Debug)]
pub(crate) struct ContourTree {
    pub(crate) directions: Directions,
    pub(crate) nodes: Vec<TreeNode>,
    pub(crate) leaves: Vec<Leaf>,
    pub(crate) root: Link,
    /// The boundaries of leaves, one after the other; those of former leaves too.
    arcs: Vec<PolygonArc>,
}

/// What a polygon is put in for. Distances are Chebyshev's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Filler {
    pub(crate) piece: PieceId,
    /// Leaves of which `far` is at most this stay as they are.
    pub(crate) near: f64,
    /// What becomes `far` of the leaves it fills: 0 if nothing can come in front of it.
    pub(crate) far: f64,
    /// Its plane, if the distance of that within a leaf may be less.
    pub(crate) plane: Option<SeenPlane>,
}

/// How a polygon that is put in lies to the piece that fills a leaf, in that leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Behind,
    InFront,
    /// In front within the half sphere, behind outside of it. The polygon's part in the leaf, which has corners on both sides, was classified last.
    InFrontWithin(HalfSphere),
}

/// A part of a polygon that is put in, and where in the tree it is to go on.
#[derive(Clone, Copy, Debug)]
struct Pending {
    to: Link,
    part: Span,
    /// How many directions there were, and how many leaves it had filled, when the part was cut off.
    directions: usize,
    filled: usize,
}

/// Buffers that insertion needs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    pub(crate) knife: Knife,
    arcs: Vec<PolygonArc>,
    pending: Vec<Pending>,
    links: Vec<Link>,
    /// The leaves that the last insertion filled.
    pub(crate) filled: Vec<u32>,
    /// How many tree nodes insertions went through.
    pub(crate) visited: u64,
}

impl Workspace {
    /// For another view. What insertions leave behind they clear themselves.
    pub(crate) fn clear(&mut self) {
        self.knife.cache.clear();
        self.visited = 0;
    }
}

impl ContourTree {
    /// The whole sphere seen from `eye`, cut into octants by the coordinate planes; points of the scene and of windows are in
    /// `range`. The memory of another tree is used again.
    pub(crate) fn octants(
        skeleton: &Skeleton,
        range: BitRange,
        eye: DVec3,
        former: Option<Self>,
        knife: &mut Knife,
    ) -> Self {
        let mut tree = match former {
            None => Self {
                directions: Directions::new(range, eye, None),
                nodes: Vec::new(),
                leaves: Vec::new(),
                root: Link::Node(0),
                arcs: Vec::new(),
            },
            Some(Self { directions, mut nodes, mut leaves, mut arcs, .. }) => {
                nodes.clear();
                leaves.clear();
                arcs.clear();
                let directions = Directions::new(range, eye, Some(directions));
                Self { directions, nodes, leaves, root: Link::Node(0), arcs }
            }
        };
        let directions = &mut tree.directions;
        let planes = DVec3::AXES.map(|n| directions.push_given(skeleton, n, &mut knife.cache));
        let mut poles = [[DirectionId(0); 2]; 3];
        for (axis, pole) in poles.iter_mut().enumerate() {
            let circles = [planes[(axis + 1) % 3], planes[(axis + 2) % 3]];
            *pole = [false, true].map(|r| directions.push_crossing(skeleton, circles, r, &mut knife.cache));
        }
        tree.octant_node(planes, poles, &mut Vec::new(), NO_PARENT);
        tree
    }

    fn octant_node(
        &mut self,
        planes: [CircleId; 3],
        poles: [[DirectionId; 2]; 3],
        signs: &mut Vec<Sign>,
        parent: u32,
    ) -> Link {
        if let &[x, y, z] = signs.as_slice() {
            let corner = |axis: usize| poles[axis][usize::from(signs[axis].is_negative())];
            // From pole to pole along the plane of the third axis, counter-clockwise.
            let order = if (x * y * z).is_positive() { [0, 1, 2] } else { [0, 2, 1] };
            let arcs = [0, 1, 2].map(|k| {
                let (a, b) = (order[k], order[(k + 1) % 3]);
                let third = 3 - a - b;
                PolygonArc { from: corner(a), along: HalfSphere::new(planes[third], signs[third]) }
            });
            return self.push_leaf(&arcs, parent);
        }
        let node = self.nodes.len() as u32;
        let circle = planes[signs.len()];
        self.nodes.push(TreeNode { circle, children: [0; 2], parent, far: f64::INFINITY });
        let children = [Sign::Negative, Sign::Positive].map(|sign| {
            signs.push(sign);
            let child = self.octant_node(planes, poles, signs, node);
            signs.pop();
            child
        });
        self.nodes[node as usize].children = children.map(Link::packed);
        Link::Node(node)
    }

    fn push_leaf(&mut self, boundary: &[PolygonArc], parent: u32) -> Link {
        let boundary = Span::keep(boundary, &mut self.arcs);
        self.leaves.push(Leaf { state: LeafState::Open, far: f64::INFINITY, boundary, parent });
        Link::Leaf(self.leaves.len() as u32 - 1)
    }

    /// The boundary of a leaf.
    pub(crate) fn boundary(&self, leaf: u32) -> &[PolygonArc] {
        &self.arcs[self.leaves[leaf as usize].boundary.range()]
    }

    /// Nothing that is at least this far from the eye can be seen.
    pub(crate) fn far(&self) -> f64 {
        self.link_far(self.root)
    }

    fn link_far(&self, link: Link) -> f64 {
        match link {
            Link::Node(node) => self.nodes[node as usize].far,
            Link::Leaf(leaf) => self.leaves[leaf as usize].far,
        }
    }

    fn replace(&mut self, parent: u32, old: Link, new: Link) {
        if parent == NO_PARENT {
            self.root = new;
            return;
        }
        let [negative, positive] = &mut self.nodes[parent as usize].children;
        *(if *negative == old.packed() { negative } else { positive }) = new.packed();
    }

    /// Gives a leaf its state and tells the nodes above.
    fn close(&mut self, leaf: u32, state: LeafState, far: f64) {
        let Leaf { parent: mut above, .. } = self.leaves[leaf as usize];
        (self.leaves[leaf as usize].state, self.leaves[leaf as usize].far) = (state, far);
        while above != NO_PARENT {
            let node = self.nodes[above as usize];
            let most = self.link_far(node.negative()).max(self.link_far(node.positive()));
            if most.total_cmp(&node.far).is_eq() {
                return;
            }
            self.nodes[above as usize].far = most;
            above = node.parent;
        }
    }

    /// Names the piece that is seen in a leaf that one as far away fills.
    pub(crate) fn rename(&mut self, leaf: u32, piece: PieceId) {
        self.leaves[leaf as usize].state = LeafState::Filled(piece);
    }

    /// Leaves everything on the other side of `domain` outside.
    pub(crate) fn clip(&mut self, skeleton: &Skeleton, domain: HalfSphere, work: &mut Workspace) {
        for leaf in self.open_leaves() {
            let [inside, outside] = self.cut_leaf(skeleton, leaf, domain, |_, _, _| None, work);
            debug_assert!(inside.is_some() || outside.is_some());
            if let Some(outside) = outside {
                self.close(outside, LeafState::Outside, 0.0);
            }
        }
    }

    /// The leaves that are open now.
    pub(crate) fn open_leaves(&self) -> Vec<u32> {
        (0..self.leaves.len() as u32).filter(|&leaf| self.leaves[leaf as usize].state == LeafState::Open).collect()
    }

    /// Cuts a leaf in two of the same state; gives the leaves inside and outside of the half sphere. One of them
    /// is missing if the circle does not meet the leaf's interior. `known` is as for [`Knife::cut`].
    #[inline]
    pub(crate) fn cut_leaf(
        &mut self,
        skeleton: &Skeleton,
        leaf: u32,
        half: HalfSphere,
        known: impl FnMut(&mut Directions, &mut ExactCache, PolygonArc) -> Option<DirectionId>,
        work: &mut Workspace,
    ) -> [Option<u32>; 2] {
        let Leaf { state, far, boundary, parent } = self.leaves[leaf as usize];
        let sides = work.knife.classify(skeleton, &self.directions, &self.arcs[boundary.range()], half.circle());
        if let Some(only) = one_side(sides, half.inside()) {
            return if only == half.inside() { [Some(leaf), None] } else { [None, Some(leaf)] };
        }
        let [negative, positive] =
            work.knife.cut(skeleton, &mut self.directions, &mut self.arcs, boundary, half.circle(), known);
        let negative = boundary.replace_by_last(negative, &mut self.arcs);
        let node = self.nodes.len() as u32;
        self.replace(parent, Link::Leaf(leaf), Link::Node(node));
        // The leaf itself becomes the negative child, so that no leaf is ever out of the tree.
        let other = self.leaves.len() as u32;
        self.leaves[leaf as usize] = Leaf { state, far, boundary: negative, parent: node };
        self.leaves.push(Leaf { state, far, boundary: positive, parent: node });
        let children = [leaf, other].map(|leaf| Link::Leaf(leaf).packed());
        self.nodes.push(TreeNode { circle: half.circle(), children, parent, far });
        if half.inside().is_positive() { [Some(other), Some(leaf)] } else { [Some(leaf), Some(other)] }
    }

    /// Puts in a convex spherical polygon, which is all on the side of `top` where that is and within the projection of `seen`: it
    /// fills what is open of its inside, and what `judge` takes for it from the pieces that are there.
    #[allow(clippy::too_many_arguments, reason = "the parts of a view are borrowed apart")]
    pub(crate) fn insert(
        &mut self,
        skeleton: &Skeleton,
        top: Link,
        polygon: &[PolygonArc],
        seen: &SeenBox,
        filler: &Filler,
        mut judge: impl FnMut(&mut Directions, &mut Knife, PieceId, &[PolygonArc]) -> Verdict,
        work: &mut Workspace,
    ) {
        work.arcs.clear();
        let whole = Span::keep(polygon, &mut work.arcs);
        work.filled.clear();
        work.pending.clear();
        let known = self.directions.count();
        work.pending.push(Pending { to: top, part: whole, directions: known, filled: 0 });
        while let Some(Pending { to: mut link, mut part, directions, filled }) = work.pending.pop() {
            if work.filled.len() == filled {
                // Nothing was seen of what was cut since then: no cell has corners of it.
                self.directions.truncate(directions);
            }
            while let Some(place) = self.descend(link, seen, filler.near, &mut work.visited) {
                let node = match place {
                    Link::Leaf(leaf) => {
                        self.reach(skeleton, leaf, part, filler, &mut judge, work);
                        break;
                    }
                    Link::Node(node) => self.nodes[node as usize],
                };
                let (circle, negative, positive) = (node.circle, node.negative(), node.positive());
                let sides = &work.arcs[part.range()];
                if let Some(side) = sides.iter().find(|arc| arc.along.circle() == circle) {
                    link = if side.along.inside().is_positive() { positive } else { negative };
                    continue;
                }
                link = match work.knife.classify(skeleton, &self.directions, sides, circle) {
                    Sides { negative: false, .. } => positive,
                    Sides { positive: false, .. } => negative,
                    _ => {
                        let [below, above] = [negative, positive].map(|child| self.link_far(child) > filler.near);
                        if below && above {
                            let [other, rest] = self.cut_part(skeleton, part, circle, work);
                            let (directions, filled) = (self.directions.count(), work.filled.len());
                            work.pending.push(Pending { to: negative, part: other, directions, filled });
                            part = rest;
                        } else {
                            let side = if above { Sign::Positive } else { Sign::Negative };
                            part = self.cut_off(skeleton, part, HalfSphere::new(circle, side), work);
                        }
                        if above { positive } else { negative }
                    }
                };
            }
        }
        if work.filled.is_empty() {
            self.directions.truncate(known);
        }
    }

    /// Fills the part of a leaf that a polygon within it covers, as far as `judge` takes it for that.
    fn reach(
        &mut self,
        skeleton: &Skeleton,
        leaf: u32,
        part: Span,
        filler: &Filler,
        judge: &mut impl FnMut(&mut Directions, &mut Knife, PieceId, &[PolygonArc]) -> Verdict,
        work: &mut Workspace,
    ) {
        let Leaf { state, far, .. } = self.leaves[leaf as usize];
        let verdict = match state {
            LeafState::Filled(piece) if far > filler.near => {
                judge(&mut self.directions, &mut work.knife, piece, &work.arcs[part.range()])
            }
            LeafState::Open => Verdict::InFront,
            LeafState::Filled(_) | LeafState::Outside => Verdict::Behind,
        };
        let part = match verdict {
            Verdict::Behind => return,
            Verdict::InFront => part,
            Verdict::InFrontWithin(half) => self.cut_off(skeleton, part, half, work),
        };
        self.fill(skeleton, leaf, part, filler, work);
    }

    /// Goes down from a link as long as the box is certainly on one side: to a leaf, or to a node whose great circle may meet the box;
    /// `None` if nothing from `near` on can be seen there.
    #[inline]
    fn descend(&self, mut link: Link, seen: &SeenBox, near: f64, visited: &mut u64) -> Option<Link> {
        while let Link::Node(number) = link {
            let node = &self.nodes[number as usize];
            if node.far <= near {
                return None;
            }
            *visited += 1;
            match self.child_around(node, seen) {
                Some(child) => link = child,
                None => break,
            }
        }
        Some(link)
    }

    /// What is on the side of a node that all of the box is certainly on, if it is.
    #[inline]
    fn child_around(&self, node: &TreeNode, seen: &SeenBox) -> Option<Link> {
        let [is_negative, is_positive] = seen.sides(self.directions.normal(node.circle));
        (is_negative | is_positive).then(|| Link::unpacked(node.children[usize::from(is_positive)]))
    }

    /// The two parts of a polygon that is put in and was classified last.
    fn cut_part(&mut self, skeleton: &Skeleton, part: Span, circle: CircleId, work: &mut Workspace) -> [Span; 2] {
        work.knife.cut(skeleton, &mut self.directions, &mut work.arcs, part, circle, |_, _, _| None)
    }

    /// The same, but only the part on one side.
    fn cut_off(&mut self, skeleton: &Skeleton, part: Span, half: HalfSphere, work: &mut Workspace) -> Span {
        work.knife.cut_off(skeleton, &mut self.directions, &mut work.arcs, part, half)
    }

    /// Fills the part of a leaf that a polygon within it covers.
    ///
    /// Every side of the polygon that is not on the leaf's boundary becomes a node; what lies outside
    /// of it stays as it is.
    fn fill(&mut self, skeleton: &Skeleton, leaf: u32, polygon: Span, filler: &Filler, work: &mut Workspace) {
        let Leaf { state, far, boundary: place, mut parent } = self.leaves[leaf as usize];
        // What is left of the leaf.
        let mut region = place;
        let polygon = &work.arcs[polygon.range()];
        for (k, &side) in polygon.iter().enumerate() {
            let (circle, inside) = (side.along.circle(), side.along.inside());
            let sides = &self.arcs[region.range()];
            if sides.iter().any(|arc| arc.along.circle() == circle) {
                continue;
            }
            let sides = work.knife.classify(skeleton, &self.directions, sides, circle);
            if let Some(only) = one_side(sides, inside) {
                debug_assert_eq!(only, inside, "the polygon lies in the leaf");
                continue;
            }
            // Where the region's boundary already follows the polygon's neighbouring side, it is
            // crossed at the polygon's own corner.
            let previous = polygon[if k == 0 { polygon.len() - 1 } else { k - 1 }];
            let next = polygon[if k + 1 == polygon.len() { 0 } else { k + 1 }];
            let known = |_: &mut Directions, _: &mut ExactCache, arc: PolygonArc| {
                let circle = arc.along.circle();
                if circle == previous.along.circle() {
                    Some(side.from)
                } else if circle == next.along.circle() {
                    Some(next.from)
                } else {
                    None
                }
            };
            let [below, above] = work.knife.cut(skeleton, &mut self.directions, &mut self.arcs, region, circle, known);
            let (outside, kept) = if inside.is_positive() { (below, above) } else { (above, below) };
            region = kept;
            let node = self.nodes.len() as u32;
            self.replace(parent, Link::Leaf(leaf), Link::Node(node));
            let other = self.leaves.len() as u32;
            self.leaves.push(Leaf { state, far, boundary: outside, parent: node });
            let children = if inside.is_positive() { [other, leaf] } else { [leaf, other] };
            let children = children.map(|leaf| Link::Leaf(leaf).packed());
            self.nodes.push(TreeNode { circle, children, parent, far });
            parent = node;
        }
        let filled = &mut self.leaves[leaf as usize];
        filled.boundary = place.replace(polygon, &mut self.arcs);
        filled.parent = parent;
        // A convex part of a plane is farthest at one of its corners.
        let far = filler.plane.map_or(filler.far, |plane| {
            let corners = polygon.iter().map(|arc| plane.distance(self.directions.approximation(arc.from)));
            corners.fold(0.0, f64::max).min(filler.far)
        });
        self.close(leaf, LeafState::Filled(filler.piece), far);
        work.filled.push(leaf);
    }

    /// True if nothing in the box, which is at least `near` from the eye, can be seen: every leaf that its projection
    /// may meet is filled by what is nearer. Errs only towards false. The projection is all on the side of `top` where that is.
    pub(crate) fn hides(&self, top: Link, seen: &SeenBox, near: f64, work: &mut Workspace) -> bool {
        work.links.clear();
        let mut link = top;
        loop {
            if self.link_far(link) <= near {
                let Some(next) = work.links.pop() else { return true };
                link = next;
                continue;
            }
            let Link::Node(node) = link else { return false };
            let node = &self.nodes[node as usize];
            link = self.child_around(node, seen).unwrap_or_else(|| {
                // Where it is farther, something is more likely to be seen: that ends it.
                let [negative, positive] = [node.negative(), node.positive()];
                let [nearer, farther] = if self.link_far(negative) > self.link_far(positive) {
                    [positive, negative]
                } else {
                    [negative, positive]
                };
                work.links.push(nearer);
                farther
            });
        }
    }
}

impl ContourTree {
    /// The lowest node below `top` that all of the box's projection is on the side of.
    pub(crate) fn around(&self, top: Link, seen: &SeenBox) -> Link {
        let mut link = top;
        while let Link::Node(number) = link {
            let node = &self.nodes[number as usize];
            let Some(child) = self.child_around(node, seen) else { break };
            // A leaf may become a node later, and then it is only a part of it.
            if let Link::Leaf(_) = child {
                break;
            }
            link = child;
        }
        link
    }
}

/// The side that all corners are on or touch, if there is only one; `inside` if they are all on the
/// circle, which no polygon with an interior is.
fn one_side(sides: Sides, inside: Sign) -> Option<Sign> {
    match sides {
        Sides { negative: true, positive: true } => None,
        Sides { negative: true, positive: false } => Some(Sign::Negative),
        Sides { negative: false, positive: true } => Some(Sign::Positive),
        Sides { negative: false, positive: false } => Some(inside),
    }
}
