//! What a user should know about a mesh: where it is open, doubled or badly joined.

use super::flat::{collinear, unit_scale};
use super::{PolygonId, Scene, Shape, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;

/// The state of a scene's surfaces. None of it is an error; each may explain a surprising view.
///
/// Edges are those of the polygons' rings, without the diagonals of triangulations; polygons without area
/// do not count as surfaces.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshReport {
    /// Edges along which a polygon has no neighbour, ascending. T-junctions leave such edges too.
    pub open_edges: Vec<[VertexId; 2]>,
    /// Edges in which more than two polygons meet, ascending.
    pub crowded_edges: Vec<[VertexId; 2]>,
    /// Edges of exactly two polygons whose fronts are on different sides, ascending.
    pub turned_edges: Vec<[VertexId; 2]>,
    /// Polygons that are not exactly planar, ascending.
    pub non_planar: Vec<PolygonId>,
    /// Polygons without area, ascending.
    pub degenerate: Vec<PolygonId>,
    /// Polygons with the same corners as one before: that one and the later one, by the later one.
    pub duplicates: Vec<[PolygonId; 2]>,
    /// Vertices inside edges that they are no end of, by edge and vertex.
    pub t_junctions: Vec<TJunction>,
    /// False if the search for T-junctions was given up, with a hundred thousand found or after looking
    /// at a hundred million pairs: in a mesh, there are nearly none.
    pub all_t_junctions: bool,
}

const MAX_T_JUNCTIONS: usize = 100_000;
const MAX_PAIRS: usize = 100_000_000;

/// A vertex in the inside of an edge: two polygons meet there without sharing the edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TJunction {
    /// The edge.
    pub edge: [VertexId; 2],
    /// The vertex.
    pub vertex: VertexId,
    /// True if it lies on the edge exactly, false if within 1e-9 of the scene's diagonal: there is a crack.
    pub exact: bool,
}

impl Scene {
    /// Looks over the mesh. Expected time n log n in the number of vertices.
    ///
    /// ```
    /// use nusselt::scene::{Material, Scene};
    /// // A square with a vertex of a second one in the middle of its right edge.
    /// let vertices = [[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.], [2., 1., 0.], [3., 1., 0.], [3., 2., 0.]];
    /// let faces = [vec![0, 1, 2, 3], vec![4, 5, 6, 2]];
    /// let report = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build()?.report();
    /// assert_eq!(report.t_junctions.len(), 1);
    /// assert_eq!(report.open_edges.len(), 8);
    /// # Ok::<(), nusselt::scene::SceneError>(())
    /// ```
    pub fn report(&self) -> MeshReport {
        let mut report = MeshReport::default();
        let mut uses: FxHashMap<[VertexId; 2], [u32; 2]> = FxHashMap::default();
        let mut known: FxHashMap<Vec<Vec<VertexId>>, PolygonId> = FxHashMap::default();
        for polygon in self.polygons() {
            match polygon.shape() {
                Shape::NonPlanar => report.non_planar.push(polygon.id()),
                Shape::Degenerate => {
                    report.degenerate.push(polygon.id());
                    continue;
                }
                Shape::Convex | Shape::Concave => {}
            }
            for ring in polygon.rings() {
                for (&a, &b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                    uses.entry([a.min(b), a.max(b)]).or_default()[usize::from(a > b)] += 1;
                }
            }
            let mut rings: Vec<_> = polygon.rings().iter().map(|ring| canonical(ring)).collect();
            rings[1..].sort_unstable();
            match known.entry(rings) {
                Entry::Occupied(first) => report.duplicates.push([*first.get(), polygon.id()]),
                Entry::Vacant(entry) => {
                    entry.insert(polygon.id());
                }
            }
        }
        let mut uses: Vec<_> = uses.into_iter().collect();
        uses.sort_unstable();
        for &(edge, [along, against]) in &uses {
            match (along + against, along == against) {
                (1, _) => report.open_edges.push(edge),
                (2, true) => {}
                (2, false) => report.turned_edges.push(edge),
                _ => report.crowded_edges.push(edge),
            }
        }
        (report.t_junctions, report.all_t_junctions) = self.t_junctions(uses.iter().map(|&(edge, _)| edge));
        report
    }

    fn t_junctions(&self, edges: impl Iterator<Item = [VertexId; 2]>) -> (Vec<TJunction>, bool) {
        // So that lengths neither overflow nor vanish.
        let scale = unit_scale(self.vertices().iter().copied());
        let points: Vec<DVec3> = self.vertices().iter().map(|&p| p * scale).collect();
        let reach = self.bounds().map_or(0.0, |(low, high)| 1e-9 * (high * scale - low * scale).length());
        let tree = PointTree::new(&points);
        let mut found = Vec::new();
        let mut near = Vec::new();
        let mut pairs = 0;
        for edge in edges {
            near.clear();
            let [a, b] = edge.map(|v| points[v.index()]);
            // Not the whole neighbourhood of an edge that is short beside the scene; and at least rounding.
            let reach = reach.min(1e-3 * a.distance(b)).max(1e-14 * a.abs().max(b.abs()).max_element());
            tree.near_segment(&points, [a, b], reach, &mut near);
            pairs += near.len();
            if pairs > MAX_PAIRS {
                return (found, false);
            }
            near.sort_unstable();
            for &vertex in near.iter().filter(|v| !edge.contains(v)) {
                let p = points[vertex.index()];
                // Strictly between the ends, or at least clear of them.
                let exact = collinear([edge[0], edge[1], vertex].map(|v| self.vertex(v))) && between(a, b, p);
                if exact || (between(a, b, p) && p.distance(a) > reach && p.distance(b) > reach) {
                    found.push(TJunction { edge, vertex, exact });
                    if found.len() == MAX_T_JUNCTIONS {
                        return (found, false);
                    }
                }
            }
        }
        (found, true)
    }
}

fn between(a: DVec3, b: DVec3, p: DVec3) -> bool {
    (p - a).dot(b - a) > 0.0 && (p - b).dot(a - b) > 0.0
}

/// A ring from its least vertex on, in the direction of the lesser neighbour.
fn canonical(ring: &[VertexId]) -> Vec<VertexId> {
    let n = ring.len();
    let Some(least) = (0..n).min_by_key(|&k| ring[k]) else { return Vec::new() };
    let forward: Vec<_> = (0..n).map(|k| ring[(least + k) % n]).collect();
    let backward: Vec<_> = (0..n).map(|k| ring[(least + n - k) % n]).collect();
    forward.min(backward)
}

/// A balanced tree of points by nested boxes, in an array: the children of node k are 2 k + 1 and 2 k + 2.
struct PointTree {
    order: Vec<VertexId>,
    boxes: Vec<(DVec3, DVec3)>,
}

const LEAF: usize = 8;

impl PointTree {
    fn new(points: &[DVec3]) -> Self {
        let mut tree = Self { order: (0..points.len() as u32).map(VertexId).collect(), boxes: Vec::new() };
        let mut jobs = vec![(0, 0..points.len())];
        while let Some((node, range)) = jobs.pop() {
            let order = &mut tree.order[range.clone()];
            let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            let (low, high) = order.iter().fold(empty, |(low, high), v| {
                let p = points[v.index()];
                (low.min(p), high.max(p))
            });
            if tree.boxes.len() <= node {
                tree.boxes.resize(node + 1, empty);
            }
            tree.boxes[node] = (low, high);
            if range.len() > LEAF {
                let axis = (high - low).max_position();
                let half = range.len() / 2;
                order.select_nth_unstable_by(half, |a, b| points[a.index()][axis].total_cmp(&points[b.index()][axis]));
                jobs.push((2 * node + 1, range.start..range.start + half));
                jobs.push((2 * node + 2, range.start + half..range.end));
            }
        }
        tree
    }

    /// The points within `reach` of a segment.
    fn near_segment(&self, points: &[DVec3], [a, b]: [DVec3; 2], reach: f64, near: &mut Vec<VertexId>) {
        let ab = b - a;
        let mut jobs = vec![(0, 0..self.order.len())];
        while let Some((node, range)) = jobs.pop() {
            if range.is_empty() {
                continue;
            }
            let (low, high) = self.boxes[node];
            if !meets((low - reach, high + reach), a, ab) {
                continue;
            }
            if range.len() > LEAF {
                let middle = range.start + range.len() / 2;
                jobs.push((2 * node + 1, range.start..middle));
                jobs.push((2 * node + 2, middle..range.end));
                continue;
            }
            let close = self.order[range].iter().copied().filter(|v| {
                let p = points[v.index()];
                let along = ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
                // Not `<=`: a length of nothing has no direction.
                let is_far = p.distance(a + ab * along) > reach;
                !is_far
            });
            near.extend(close);
        }
    }
}

/// Whether the segment from `a` to `a + ab` meets a box (Kay and Kajiya's slabs).
fn meets((low, high): (DVec3, DVec3), a: DVec3, ab: DVec3) -> bool {
    let (mut from, mut to) = (0.0, 1.0);
    for axis in 0..3 {
        if ab[axis] == 0.0 {
            if a[axis] < low[axis] || a[axis] > high[axis] {
                return false;
            }
        } else {
            let (enter, leave) = ((low[axis] - a[axis]) / ab[axis], (high[axis] - a[axis]) / ab[axis]);
            from = f64::max(from, enter.min(leave));
            to = f64::min(to, enter.max(leave));
        }
    }
    from <= to
}
