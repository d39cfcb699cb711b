//! Panels: convex polygons that neighbouring pieces of one plane make up together, such as the tiles of a wall.
//!
//! A view puts in a panel as if it were one polygon, and cuts what is seen of it along the edges between its pieces: most of the cost
//! of a piece, which is to find its place in the image, is then that of its panel. Panels are halved by one edge, or edges that
//! continue each other, from side to side, and so are their halves, down to the pieces.

use crate::bsp::{Bounds, FragmentSide, LineId, PointId, Skeleton, bounds_of, whole_piece};
use crate::exact::{Sign, orient3d};
use crate::scene::{PieceId, PlaneId, Scene, VertexId};
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

/// A panel has at most so many pieces (docs/performance.md): what fills much of the image comes in parts with depths of their own.
const MOST_PIECES: u32 = 64;
/// Pieces with more sides are panels by themselves.
const MOST_SIDES: usize = 16;

/// A piece, or two panels side by side.
#[derive(Clone, Debug)]
pub(crate) struct Panel {
    /// The piece; of more than one the first, which stands for the plane and the side of all.
    pub(crate) piece: PieceId,
    pub(crate) halves: Option<Halves>,
    pub(crate) bounds: Bounds,
    sides: Range<u32>,
    pieces: u32,
}

impl Panel {
    pub(super) fn piece_count(&self) -> u32 {
        self.pieces
    }
}

/// How a panel is halved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Halves {
    /// The panels.
    pub(crate) panels: [u32; 2],
    /// What is between them, as a side of the first one.
    pub(crate) seam: FragmentSide,
    /// The ends of the seam.
    pub(crate) ends: [SeamEnd; 2],
}

/// An end of what is between two halves of a panel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeamEnd {
    pub(crate) point: PointId,
    /// The lines of the sides of the panel that meet there.
    pub(crate) lines: [LineId; 2],
}

impl Halves {
    /// Of panels with these boundaries, of which these sides are between them.
    fn new(panels: [u32; 2], [a, b]: [&[FragmentSide]; 2], [i, j]: [u32; 2]) -> Self {
        let [i, j] = [i as usize, j as usize];
        let before = |sides: &[FragmentSide], k: usize| sides[(k + sides.len() - 1) % sides.len()].line;
        let after = |sides: &[FragmentSide], k: usize| sides[next(k, sides)].line;
        let first = SeamEnd { point: a[i].point, lines: [before(a, i), after(b, j)] };
        let second = SeamEnd { point: b[j].point, lines: [after(a, i), before(b, j)] };
        Self { panels, seam: a[i], ends: [first, second] }
    }
}

/// All panels: those of one piece first, under the numbers of their pieces.
#[derive(Debug)]
pub(crate) struct Panels {
    panels: Vec<Panel>,
    /// Of the lines that are known to be the same it is always the one that stands for them.
    sides: Vec<FragmentSide>,
}

impl Panels {
    /// The panels of groups of pieces, and those that are no half of another one, by groups. `may_join` tells whether pieces may be in one panel.
    pub(super) fn of(
        scene: &Scene,
        skeleton: &Skeleton,
        groups: &[&[PieceId]],
        may_join: impl Fn(PieceId, PieceId) -> bool,
    ) -> (Self, Vec<Vec<u32>>) {
        let mut panels = Self { panels: Vec::with_capacity(scene.piece_count()), sides: Vec::new() };
        for piece in scene.pieces() {
            let sides = whole_piece(scene, piece.id()).into_iter().map(|side| {
                let (line, same_way) = skeleton.representative(side.line);
                FragmentSide { line, forward: side.forward == same_way, ..side }
            });
            panels.push(skeleton, piece.id(), None, sides.collect());
        }
        let mut joiner = Joiner {
            scene,
            skeleton,
            panels,
            along: FxHashMap::default(),
            queue: BinaryHeap::new(),
            whole: FxHashSet::default(),
            may_join,
        };
        let roots = groups.iter().map(|pieces| joiner.join(pieces)).collect();
        (joiner.panels, roots)
    }

    fn push(&mut self, skeleton: &Skeleton, piece: PieceId, halves: Option<Halves>, sides: Vec<FragmentSide>) -> u32 {
        let start = self.sides.len() as u32;
        let bounds = bounds_of(skeleton, &sides);
        self.sides.extend(sides);
        let pieces = halves.map_or(1, |halves| halves.panels.map(|half| self.panel(half).pieces).iter().sum());
        self.panels.push(Panel { piece, halves, bounds, sides: start..self.sides.len() as u32, pieces });
        self.panels.len() as u32 - 1
    }

    pub(crate) fn panel(&self, panel: u32) -> &Panel {
        &self.panels[panel as usize]
    }

    /// The boundary of a panel.
    pub(crate) fn sides(&self, panel: u32) -> &[FragmentSide] {
        let Range { start, end } = self.panel(panel).sides;
        &self.sides[start as usize..end as usize]
    }

    /// The pieces of a panel.
    pub(crate) fn pieces(&self, panel: u32, found: &mut Vec<PieceId>) {
        match self.panel(panel).halves {
            None => found.push(self.panel(panel).piece),
            // No deeper than a panel has pieces.
            Some(halves) => halves.panels.into_iter().for_each(|half| self.pieces(half, found)),
        }
    }
}

/// Two panels that have a side in common. Those that make few pieces come first, then those with long sides, so that panels become compact; then
/// any order that is always the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Pair {
    pieces: Reverse<u32>,
    /// The bits of the square of its length, which are in the order of the numbers.
    length: u64,
    panels: Reverse<[u32; 2]>,
    between: [u32; 2],
}

struct Joiner<'a, F> {
    scene: &'a Scene,
    skeleton: &'a Skeleton,
    panels: Panels,
    /// The side of a panel that runs from one point to another. Where there is more than one the others are not joined along it.
    along: FxHashMap<[PointId; 2], (u32, u32)>,
    queue: BinaryHeap<Pair>,
    /// Panels of the group that are no half of another one.
    whole: FxHashSet<u32>,
    may_join: F,
}

impl<F: Fn(PieceId, PieceId) -> bool> Joiner<'_, F> {
    /// Joins pieces as far as that goes; what is left.
    fn join(&mut self, pieces: &[PieceId]) -> Vec<u32> {
        self.along.clear();
        self.whole.clear();
        for piece in pieces {
            self.offer(piece.0);
        }
        while let Some(Pair { panels: Reverse(panels), between, .. }) = self.queue.pop() {
            if panels.iter().all(|panel| self.whole.contains(panel))
                && let Some(sides) = self.joined(panels, between)
            {
                for panel in panels {
                    self.whole.remove(&panel);
                }
                let piece = self.panels.panel(panels[0]).piece;
                let halves = Halves::new(panels, panels.map(|panel| self.panels.sides(panel)), between);
                let panel = self.panels.push(self.skeleton, piece, Some(halves), sides);
                self.offer(panel);
            }
        }
        let mut whole: Vec<u32> = self.whole.drain().collect();
        whole.sort_unstable();
        whole
    }

    /// Takes a panel and pairs it with its neighbours.
    fn offer(&mut self, panel: u32) {
        self.whole.insert(panel);
        let sides = self.panels.sides(panel);
        if sides.len() > MOST_SIDES {
            return;
        }
        for (k, side) in sides.iter().enumerate() {
            let ends = [side.point, sides[next(k, sides)].point];
            self.along.insert(ends, (panel, k as u32));
            let Some(&(other, at)) = self.along.get(&[ends[1], ends[0]]) else { continue };
            let pieces = [panel, other].map(|k| self.panels.panel(k).pieces).iter().sum();
            if pieces > MOST_PIECES || other == panel || !self.whole.contains(&other) {
                continue;
            }
            let [p, q] = ends.map(|end| self.position(end));
            let (panels, between) =
                if panel < other { ([panel, other], [k as u32, at]) } else { ([other, panel], [at, k as u32]) };
            let length = p.distance_squared(q).to_bits();
            self.queue.push(Pair { pieces: Reverse(pieces), length, panels: Reverse(panels), between });
        }
    }

    /// The boundary of two panels together, if they lie in one plane, turned the same way, and are convex together.
    fn joined(&self, panels: [u32; 2], between: [u32; 2]) -> Option<Vec<FragmentSide>> {
        let [a, b] = panels.map(|panel| self.panels.sides(panel));
        let [i, j] = between.map(|side| side as usize);
        let pieces = panels.map(|panel| self.panels.panel(panel).piece);
        if a[i].line != b[j].line || !(self.may_join)(pieces[0], pieces[1]) {
            return None;
        }
        let [plane, other] = pieces.map(|piece| self.scene.piece(piece).plane_id());
        let is_on = |side: &FragmentSide| self.skeleton.vertex_side(plane, vertex(side.point)).is_zero();
        if plane != other && !b.iter().all(is_on) {
            return None;
        }
        let turn = self.turns(plane, a[i].point);
        let [u, v] = [a[i].point, b[j].point];
        // Corners next to the side between them may be in line with it.
        let beside = |sides: &[FragmentSide], from: usize| {
            let corners = (0..sides.len()).filter(|&k| k != from && k != next(from, sides));
            corners.map(|k| turn([u, v, sides[k].point])).find(|sign| !sign.is_zero())
        };
        let inside = beside(a, i)?;
        if beside(b, j) != Some(-inside) {
            return None;
        }
        // From the side after the one between them, around to the one before it.
        let rest = |sides: &[FragmentSide], from: usize| -> Vec<FragmentSide> {
            (1..sides.len()).map(|k| sides[(from + k) % sides.len()]).collect()
        };
        let (mut sides, second) = (rest(a, i), rest(b, j));
        let seam = sides.len();
        sides.extend(second);
        // The corners where they meet; the later one first, so that the other keeps its place.
        for corner in [seam, 0] {
            let before = sides[if corner == 0 { sides.len() - 1 } else { corner - 1 }];
            let after = sides[corner];
            let end = sides[next(corner, &sides)].point;
            if before.line == after.line && before.forward == after.forward {
                sides.remove(corner);
            } else if turn([before.point, after.point, end]) != inside {
                return None;
            }
        }
        Some(sides)
    }

    /// Tells which way three points in a plane turn.
    fn turns(&self, plane: PlaneId, on: PointId) -> impl Fn([PointId; 3]) -> Sign {
        let (normal, on) = (self.skeleton.approx_normal(plane).v, self.position(on));
        // Any point off the plane will do: if this one were on it, all would be in line.
        let off = on + normal / normal.abs().max_element() * on.abs().max_element().max(1e-100);
        move |points| {
            let [p, q, r] = points.map(|point| self.position(point));
            orient3d(p, q, off, r)
        }
    }

    fn position(&self, point: PointId) -> DVec3 {
        self.scene.vertex(vertex(point))
    }
}

/// The vertex that a corner of a piece is.
pub(crate) fn vertex(point: PointId) -> VertexId {
    VertexId(point.0)
}

fn next(k: usize, sides: &[FragmentSide]) -> usize {
    if k + 1 == sides.len() { 0 } else { k + 1 }
}
