//! The second way: whole pieces, or panels of them, roughly from near to far, from a hierarchy of boxes; where one meets what
//! fills a cell already, the planes of the two decide which is nearer.

use super::super::directions::{CircleId, DirectionId, Directions, ExactCache};
use super::super::domain::Domain;
use super::super::image::ContourImage;
use super::super::polygon::{HalfSphere, Knife, PolygonArc, Sides};
use super::super::tree::{Filler, Link, Verdict};
use super::super::viewpoint::Viewpoint;
use super::super::windows::Pane;
use super::space::Buffers;
use super::{Sight, ViewError, ViewOptions, ViewSpace};
use crate::bsp::{Bounds, FragmentSide};
use crate::bvh::{Content, Hierarchy, Panel, Parts, SceneBvh, vertex};
use crate::exact::{SeenBox, SeenPlane, Sign, U};
use crate::scene::{PieceId, PieceRef, PlaneId, Side, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

impl SceneBvh {
    /// The contour image from a viewpoint: the same labelled subdivision as [`SceneBsp::view`](crate::bsp::SceneBsp::view) gives, cut into
    /// other cells.
    ///
    /// # Errors
    /// If the eye or a normal is not finite or zero, or if the domain does not suit the viewpoint.
    pub fn view(&self, viewpoint: &Viewpoint, domain: &Domain) -> Result<ContourImage, ViewError> {
        self.view_with(viewpoint, domain, &ViewOptions::default())
    }

    /// The same with options.
    ///
    /// # Errors
    /// As [`SceneBvh::view`]; also if the quadtree is to have too many levels, or if there are too many
    /// cells.
    pub fn view_with(
        &self,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
    ) -> Result<ContourImage, ViewError> {
        self.make_view(viewpoint, domain, options, &mut ViewSpace::new())
    }

    /// The same in memory that was used for views before, which saves asking for it: the image lasts until the next one.
    ///
    /// # Errors
    /// As [`SceneBvh::view_with`].
    pub fn view_in<'s>(
        &self,
        space: &'s mut ViewSpace,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
    ) -> Result<&'s ContourImage, ViewError> {
        let image = self.make_view(viewpoint, domain, options, space)?;
        Ok(space.keep(image))
    }

    fn make_view(
        &self,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
        space: &mut ViewSpace,
    ) -> Result<ContourImage, ViewError> {
        let sight = self.sight(viewpoint, domain, options, space)?;
        Ok(sight.finish(self.clone().into(), viewpoint, domain, space))
    }

    /// What an image is made of.
    pub(in crate::contour) fn sight(
        &self,
        viewpoint: &Viewpoint,
        domain: &Domain,
        options: &ViewOptions,
        space: &mut ViewSpace,
    ) -> Result<Sight<'_>, ViewError> {
        let hierarchy = &*self.hierarchy;
        let sight = Sight::new(&hierarchy.scene, &hierarchy.skeleton, viewpoint, domain, options, space)?;
        let mut walk = Walk { hierarchy, sight };
        walk.put_in_windows(domain);
        walk.run(options.max_cells)?;
        Ok(walk.sight)
    }
}

struct Walk<'a> {
    hierarchy: &'a Hierarchy,
    sight: Sight<'a>,
}

/// What it needs until it is done.
#[derive(Clone, Debug, Default)]
pub(super) struct WalkBuffers {
    queue: BinaryHeap<Reverse<Waiting>>,
    creases: FxHashMap<[PlaneId; 2], CircleId>,
    /// Leaves in which a panel is seen, its pieces not told apart yet.
    parts: Vec<(u32, Parts)>,
    /// Pieces that were put in as windows, ascending.
    windows: Vec<PieceId>,
    /// Those of a panel that are put in one by one.
    pieces: Vec<PieceId>,
    /// Parts of a panel of which the pieces are looked for.
    panels: Vec<u32>,
}

impl WalkBuffers {
    /// For another view.
    pub(super) fn clear(&mut self) {
        let Self { queue, creases, parts, windows, pieces, panels } = self;
        queue.clear();
        creases.clear();
        parts.clear();
        windows.clear();
        pieces.clear();
        panels.clear();
    }
}

/// What is yet to be looked at: what is nearest first, then in an order that is always the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Waiting {
    /// The bits of its distance from the eye, which are in the order of the numbers.
    distance: u64,
    what: Item,
    /// A place in the contour tree that all of its projection is below.
    top: Link,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Item {
    Box(u32),
    Panel(u32),
}

impl Walk<'_> {
    fn run(&mut self, max_cells: usize) -> Result<(), ViewError> {
        let hierarchy = self.hierarchy;
        let eye = self.sight.eye;
        let mut queue = std::mem::take(&mut self.sight.buffers.walk.queue);
        let within = |bounds: &Bounds, what: Item, top: Link| {
            Reverse(Waiting { distance: gap(eye, bounds).length().to_bits(), what, top })
        };
        if let Some(whole) = hierarchy.nodes.first() {
            queue.push(within(&whole.bounds, Item::Box(0), self.sight.contour.root));
        }
        while let Some(Reverse(Waiting { what, top, .. })) = queue.pop() {
            self.sight.check_size(max_cells)?;
            let number = match what {
                Item::Panel(panel) => {
                    self.put_in(panel, top);
                    continue;
                }
                Item::Box(number) => number,
            };
            let node = &hierarchy.nodes[number as usize];
            let near = distance_to_box(eye, &node.bounds);
            let seen = SeenBox::new(eye, node.bounds.low, node.bounds.high);
            let top = self.sight.contour.around(top, &seen);
            if self.sight.contour.hides(top, &seen, near, &mut self.sight.buffers.work) {
                self.sight.stats.skipped_subtrees += 1;
                continue;
            }
            match &node.content {
                Content::Boxes(boxes) => {
                    for &number in boxes {
                        queue.push(within(&hierarchy.nodes[number as usize].bounds, Item::Box(number), top));
                    }
                }
                Content::Panels(range) => {
                    for &panel in &hierarchy.order[range.start as usize..range.end as usize] {
                        queue.push(within(&hierarchy.panels.panel(panel).bounds, Item::Panel(panel), top));
                    }
                }
            }
        }
        self.sight.buffers.walk.queue = queue;
        self.sight.check_size(max_cells)
    }

    /// Puts in the polygons of the scene that are windows. Each fills its part of the domain, so that what lies behind it is left out from
    /// the start.
    fn put_in_windows(&mut self, domain: &Domain) {
        let Domain::Window(windows) = domain else { return };
        for pane in windows.panes() {
            let Pane::Polygon(polygon) = *pane else { continue };
            for piece in self.hierarchy.scene.polygon(polygon).pieces() {
                // Pieces have the same numbers as panels.
                self.insert(piece.id().0, self.sight.contour.root);
                self.sight.buffers.walk.windows.push(piece.id());
            }
        }
        self.sight.buffers.walk.windows.sort_unstable();
    }

    /// Puts in a panel; piece by piece if others lie in its plane, where the numbers of polygons tell which is seen.
    fn put_in(&mut self, panel: u32, top: Link) {
        if self.insert(panel, top) == Outcome::OneByOne {
            let WalkBuffers { pieces, panels, .. } = &mut self.sight.buffers.walk;
            let mut pieces = std::mem::take(pieces);
            self.hierarchy.panels.pieces(panel, panels, |piece| pieces.push(piece));
            for piece in pieces.drain(..) {
                self.insert(piece.0, top);
            }
            self.sight.buffers.walk.pieces = pieces;
        }
    }

    fn insert(&mut self, panel: u32, top: Link) -> Outcome {
        let Self { hierarchy, sight } = self;
        let eye = sight.eye;
        let sides = hierarchy.panels.sides(panel);
        let Panel { piece: id, parts, bounds, .. } = hierarchy.panels.panel(panel);
        let piece = hierarchy.scene.piece(*id);
        let Some(shown) = hierarchy.skeleton.shown_side(piece, eye) else { return Outcome::Done };
        if hierarchy.is_inside(*id, shown, eye) {
            return Outcome::Done;
        }
        sight.look_at(piece, sides, shown);
        sight.stats.inserted += 1;
        let seen = SeenBox::new(eye, bounds.low, bounds.high);
        let near = distance_to_box(eye, bounds);
        let corners = sides.iter().map(|side| hierarchy.scene.vertex(vertex(side.point)));
        let far = corners.fold(0.0, |far, p| f64::max(far, distance_bound(eye, p)));
        let (skeleton, plane) = (&hierarchy.skeleton, piece.plane_id());
        let plane = SeenPlane::new(skeleton.approx_normal(plane), skeleton.anchor(plane), eye);
        let filler = Filler { piece: *id, near, far, plane: Some(plane) };
        let is_one = matches!(parts, Parts::One(_));
        let Sight { contour, buffers: Buffers { work, polygon, walk, .. }, .. } = sight;
        let WalkBuffers { creases, windows, panels, .. } = walk;
        let mut rivals = Rivals {
            hierarchy,
            eye,
            piece,
            sides,
            panel: (!is_one).then_some(panel),
            windows,
            panels,
            shown,
            last: None,
            creases,
            outcome: Outcome::Done,
        };
        let judge = |directions: &mut Directions, knife: &mut Knife, old: PieceId, part: &[PolygonArc]| {
            rivals.judge(directions, knife, old, part)
        };
        contour.insert(&hierarchy.skeleton, top, polygon, &seen, &filler, judge, work);
        let outcome = rivals.outcome;
        if !is_one {
            walk.parts.extend(work.filled.iter().map(|&leaf| (leaf, *parts)));
            self.tell_apart(shown);
        }
        outcome
    }

    /// Cuts the leaves in which panels are seen along the edges between their pieces.
    fn tell_apart(&mut self, shown: Side) {
        let panels = &self.hierarchy.panels;
        while let Some((mut leaf, mut parts)) = self.sight.buffers.walk.parts.pop() {
            while let Parts::Two(seam) = parts {
                let seam = panels.seam(seam);
                let half = self.sight.along_edge(seam.side, shown);
                let Sight { contour, buffers: Buffers { work, directions: numbers, walk, .. }, skeleton, .. } =
                    &mut self.sight;
                // Where the leaf reaches the panel's own boundary, the seam ends in a vertex of the scene.
                let known = |directions: &mut Directions, cache: &mut ExactCache, arc: PolygonArc| {
                    let line = directions.line(arc.along.circle())?;
                    let end = seam.ends.iter().find(|end| end.lines.contains(&line))?;
                    let make = || directions.push_point(skeleton, end.point, cache).0;
                    Some(DirectionId(numbers.of(end.point.0, make)))
                };
                let [one, other] = seam.halves;
                (leaf, parts) = match contour.cut_leaf(skeleton, leaf, half, known, work) {
                    [Some(first), Some(second)] => {
                        walk.parts.push((first, one));
                        (second, other)
                    }
                    [Some(first), None] => (first, one),
                    [None, second] => (second.unwrap_or(leaf), other),
                };
            }
            if let Parts::One(piece) = parts {
                self.sight.contour.rename(leaf, piece);
            }
        }
    }
}

/// What became of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Done,
    /// Each of its pieces is to be put in by itself too.
    OneByOne,
}

/// From a point to the nearest point of a box, by the size of each component.
fn gap(eye: DVec3, bounds: &Bounds) -> DVec3 {
    (bounds.low - eye).max(eye - bounds.high).max(DVec3::ZERO)
}

/// A lower bound on the distance to a box.
///
/// What is nearer is told by Chebyshev's distance, the largest component: along each ray it grows like the usual one, it is as convex, and
/// on a plane that an axis is normal to, like most of what is built, it is the same wherever that component is the largest.
fn distance_to_box(eye: DVec3, bounds: &Bounds) -> f64 {
    // Two steps are off by u relatively.
    let length = gap(eye, bounds).max_element() * (1.0 - 2.0 * U);
    if length.is_finite() { length } else { 0.0 }
}

/// An upper bound on Chebyshev's distance to a point.
fn distance_bound(eye: DVec3, p: DVec3) -> f64 {
    (p - eye).abs().max_element() * (1.0 + 4.0 * U)
}

/// How the whole of a piece lies to another one, seen from the eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    InFront,
    Behind,
    /// Each has parts before the other's plane and behind it.
    Mixed,
    /// A panel in the plane of the other one: that differs from piece to piece.
    InOnePlane,
}

/// A piece or panel that is put in, against the pieces that are there.
struct Rivals<'a> {
    hierarchy: &'a Hierarchy,
    eye: DVec3,
    /// It, or the first one of a panel.
    piece: PieceRef<'a>,
    /// The boundary of all that is put in.
    sides: &'a [FragmentSide],
    /// If it is a panel of several pieces.
    panel: Option<u32>,
    windows: &'a [PieceId],
    /// Room to look for pieces of a panel.
    panels: &'a mut Vec<u32>,
    shown: Side,
    last: Option<(PieceId, Order)>,
    creases: &'a mut FxHashMap<[PlaneId; 2], CircleId>,
    outcome: Outcome,
}

impl Rivals<'_> {
    fn judge(&mut self, directions: &mut Directions, knife: &mut Knife, old: PieceId, part: &[PolygonArc]) -> Verdict {
        let order = match self.last {
            Some((last, order)) if last == old => order,
            _ => self.order(old),
        };
        self.last = Some((old, order));
        match order {
            Order::InFront => Verdict::InFront,
            Order::Behind => Verdict::Behind,
            Order::Mixed => self.judge_by_crease(directions, knife, old, part),
            Order::InOnePlane => {
                self.outcome = Outcome::OneByOne;
                Verdict::Behind
            }
        }
    }

    /// By the planes of the two: what has no part before the other's plane is behind it wherever both are seen.
    fn order(&mut self, old: PieceId) -> Order {
        let skeleton = &self.hierarchy.skeleton;
        let old = self.hierarchy.scene.piece(old);
        let new = self.piece;
        // Whether a piece has corners before the plane of another one, and beyond it.
        let about = |corners: &mut dyn Iterator<Item = VertexId>, other: PieceRef<'_>| {
            let eye = self.height(other);
            let (mut before, mut beyond) = (false, false);
            for vertex in corners {
                let side = skeleton.vertex_side(other.plane_id(), vertex) * eye;
                before |= side.is_positive();
                beyond |= side.is_negative();
            }
            (before, beyond)
        };
        if new.plane_id() != old.plane_id() {
            match about(&mut self.sides.iter().map(|side| vertex(side.point)), old) {
                (true, false) => return Order::InFront,
                (false, true) => return Order::Behind,
                (true, true) => match about(&mut old.vertices().iter().copied(), new) {
                    (true, false) => return Order::Behind,
                    (false, true) => return Order::InFront,
                    // The old one in the plane of the new one puts that in its own.
                    _ => return Order::Mixed,
                },
                (false, false) => {}
            }
        }
        if let Some(panel) = self.panel {
            return if self.is_own_window(panel, old.id()) { Order::Behind } else { Order::InOnePlane };
        }
        // In one plane: fronts hide backs, then the lower number hides the higher.
        let shown = if self.height(old) == Sign::Positive { old.facing() } else { old.facing().opposite() };
        let rank = |shown: Side, piece: PieceRef<'_>| (shown == Side::Back, piece.polygon(), piece.id());
        if rank(self.shown, new) < rank(shown, old) { Order::InFront } else { Order::Behind }
    }

    /// True if a piece is one of the panel's own, that was put in before as a window: nothing else of the panel is where it is.
    fn is_own_window(&mut self, panel: u32, piece: PieceId) -> bool {
        self.windows.binary_search(&piece).is_ok() && {
            let mut is_own = false;
            self.hierarchy.panels.pieces(panel, self.panels, |own| is_own |= own == piece);
            is_own
        }
    }

    /// On which side of the plane of a piece the eye is.
    fn height(&self, piece: PieceRef<'_>) -> Sign {
        self.hierarchy.skeleton.position_side(piece.plane_id(), self.eye)
    }

    /// By the great circle through the line where the planes meet.
    ///
    /// With both planes turned so that the eye's height is above 0, the new piece is nearer where
    /// `h_old N_new - h_new N_old` is negative: depth along `d` is `-h / (N . d)`.
    fn judge_by_crease(
        &mut self,
        directions: &mut Directions,
        knife: &mut Knife,
        old: PieceId,
        part: &[PolygonArc],
    ) -> Verdict {
        let skeleton = &self.hierarchy.skeleton;
        let old = self.hierarchy.scene.piece(old);
        let planes = [self.piece.plane_id(), old.plane_id()];
        let planes = [planes[0].min(planes[1]), planes[0].max(planes[1])];
        let circle =
            *self.creases.entry(planes).or_insert_with(|| directions.push_crease(skeleton, planes, &mut knife.cache));
        // The splitter is `h_2 N_1 - h_1 N_2`.
        let turned = self.height(self.piece) * self.height(old);
        let nearer = if planes[0] == self.piece.plane_id() { -turned } else { turned };
        match knife.classify(skeleton, directions, part, circle) {
            Sides { negative: true, positive: true } => Verdict::InFrontWithin(HalfSphere::new(circle, nearer)),
            Sides { positive, .. } if positive == nearer.is_positive() => Verdict::InFront,
            _ => Verdict::Behind,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use num_traits::Signed;

    #[test]
    fn distances_are_bounded_from_both_sides_and_closely() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / 2f64.powi(52) - 1.0
        };
        let exact = |x: f64| BigRational::from_float(x).expect("finite");
        for k in 0..400 {
            let mut point = |scale: i32| DVec3::new(random(), random(), random()) * 2f64.powi(scale);
            let (eye, p) = (point(k - 200), point(k / 2 - 100));
            let components = (0..3).map(|axis| (exact(eye[axis]) - exact(p[axis])).abs());
            let distance = components.max().expect("three");
            let (near, far) = (distance_to_box(eye, &Bounds { low: p, high: p }), distance_bound(eye, p));
            assert!(exact(near) <= distance, "{eye} {p}: {near}");
            assert!(exact(far) >= distance, "{eye} {p}: {far}");
            // Ten roundings: four and six.
            assert!(far - near <= 2e-15 * far, "{eye} {p}: {near} {far}");
        }
    }
}
