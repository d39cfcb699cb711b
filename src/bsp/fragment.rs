//! Fragments: pieces of polygons, as the splitting planes left them.

use super::skeleton::{LineId, PointId, Skeleton};
use super::{FragmentId, Tree};
use crate::exact::{ApproxPoint, Point};
use crate::scene::{PieceId, PolygonId, Scene};
use glam::DVec3;

/// One point of a fragment's boundary and the line from it to the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FragmentSide {
    pub(crate) point: PointId,
    pub(crate) line: LineId,
    /// For an edge: the boundary runs from its first vertex to its second. For a crease: the
    /// fragment lies in front of the other one of the two planes.
    pub(crate) forward: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Fragment {
    pub(crate) piece: PieceId,
    pub(crate) polygon: PolygonId,
    pub(crate) start: u32,
    pub(crate) len: u32,
}

impl Fragment {
    pub(crate) fn range(self) -> std::ops::Range<usize> {
        self.start as usize..(self.start + self.len) as usize
    }
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

impl Bounds {
    pub(crate) const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// A box that certainly holds the points, though they are known only up to a bound.
    pub(crate) fn around(points: impl IntoIterator<Item = ApproxPoint>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, p| {
            // Outward by more than the rounding of the two operations.
            let margin = p.err * 2.0
                + p.position.abs() * f64::EPSILON * DVec3::select(p.err.cmpgt(DVec3::ZERO), DVec3::ONE, DVec3::ZERO);
            Self { low: bounds.low.min(p.position - margin), high: bounds.high.max(p.position + margin) }
        })
    }

    pub(crate) fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The length of its longest side; 0 if empty.
    pub(crate) fn extent(self) -> f64 {
        (self.high - self.low).max_element().max(0.0)
    }

    /// Half its surface area with `unit` for a unit of length; 0 if empty.
    pub(crate) fn half_area(self, unit: f64) -> f64 {
        let d = (self.high - self.low).max(DVec3::ZERO) / unit;
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

/// A fragment of a [`SceneBsp`](super::SceneBsp).
#[derive(Clone, Copy, Debug)]
pub struct FragmentRef<'a> {
    tree: &'a Tree,
    id: FragmentId,
}

impl<'a> FragmentRef<'a> {
    pub(super) fn new(tree: &'a Tree, id: FragmentId) -> Self {
        assert!(id.index() < tree.fragments.len(), "fragment {} does not exist", id.0);
        Self { tree, id }
    }

    /// Its id.
    pub fn id(self) -> FragmentId {
        self.id
    }

    /// The scene it is part of.
    pub fn scene(self) -> &'a Scene {
        &self.tree.scene
    }

    /// The polygon it is part of.
    pub fn polygon(self) -> PolygonId {
        self.fragment().polygon
    }

    /// The piece it is part of.
    pub fn piece(self) -> PieceId {
        self.fragment().piece
    }

    /// The corners of its boundary, counter-clockwise seen from the piece's front. Vertices of the
    /// scene are exact; constructed corners are rounded.
    pub fn corners(self) -> impl ExactSizeIterator<Item = DVec3> + 'a {
        let tree = self.tree;
        tree.sides[self.fragment().range()].iter().map(move |side| tree.skeleton.approx_point(side.point).position)
    }

    /// The same corners by exact definition.
    pub fn exact_corners(self) -> impl ExactSizeIterator<Item = Point> + 'a {
        let skeleton = &self.tree.skeleton;
        self.tree.sides[self.fragment().range()].iter().map(|side| skeleton.resolved_point(skeleton.point(side.point)))
    }

    fn fragment(self) -> Fragment {
        self.tree.fragments[self.id.index()]
    }
}

/// The whole piece as a fragment's boundary.
pub(crate) fn whole_piece(scene: &Scene, piece: PieceId) -> impl ExactSizeIterator<Item = FragmentSide> {
    let piece = scene.piece(piece);
    let edges = scene.edges();
    let sides = piece.vertices().iter().zip(piece.edges());
    sides.map(|(vertex, edge)| FragmentSide {
        point: PointId(vertex.0),
        line: LineId(edge.0),
        forward: edges[edge.index()][0] == *vertex,
    })
}

/// The box around a boundary.
pub(crate) fn bounds_of(skeleton: &Skeleton, sides: &[FragmentSide]) -> Bounds {
    Bounds::around(sides.iter().map(|side| skeleton.approx_point(side.point)))
}
