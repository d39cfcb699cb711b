//! Vertices inside edges.

use super::super::flat::{collinear, unit_scale, unscaled};
use super::super::{Scene, VertexId};
use super::TJunction;
use super::tree::{Aabb, BoxTree};
use glam::DVec3;

const MAX_T_JUNCTIONS: usize = 100_000;
const MAX_PAIRS: usize = 100_000_000;

/// The T-junctions on some edges, by edge and vertex; false if the search was given up.
pub(super) fn t_junctions(scene: &Scene, edges: impl Iterator<Item = [VertexId; 2]>) -> (Vec<TJunction>, bool) {
    // So that lengths neither overflow nor vanish.
    let scale = unit_scale(scene.vertices().iter().copied());
    let points: Vec<DVec3> = scene.vertices().iter().map(|&p| p * scale).collect();
    let reach = scene.bounds().map_or(0.0, |(low, high)| 1e-9 * (high * scale - low * scale).length());
    let tree = BoxTree::new(&points.iter().map(|&p| (p, p)).collect::<Vec<_>>());
    let mut found = Vec::new();
    let mut near = Vec::new();
    let mut pairs = 0;
    for edge in edges {
        near.clear();
        let [a, b] = edge.map(|v| points[v.index()]);
        let ab = b - a;
        // Not the whole neighbourhood of an edge that is short beside the scene; and at least rounding.
        let reach = reach.min(1e-3 * a.distance(b)).max(1e-14 * a.abs().max(b.abs()).max_element());
        tree.visit(
            |(low, high)| meets((low - reach, high + reach), a, ab),
            |vertex| {
                let p = points[vertex as usize];
                let gap = p.distance(a + ab * ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0));
                // Not `<=`: a length of nothing has no direction.
                let is_far = gap > reach;
                if !is_far {
                    near.push((VertexId(vertex), gap));
                }
            },
        );
        pairs += near.len();
        if pairs > MAX_PAIRS {
            return (found, false);
        }
        near.sort_unstable_by_key(|&(vertex, _)| vertex);
        for &(vertex, gap) in near.iter().filter(|(v, _)| !edge.contains(v)) {
            let p = points[vertex.index()];
            // Strictly between the ends, or at least clear of them.
            let exact = collinear([edge[0], edge[1], vertex].map(|v| scene.vertex(v))) && between(a, b, p);
            if exact || (between(a, b, p) && p.distance(a) > reach && p.distance(b) > reach) {
                let gap = if exact { 0.0 } else { unscaled(gap, scale) };
                found.push(TJunction { edge, vertex, exact, gap });
                if found.len() == MAX_T_JUNCTIONS {
                    return (found, false);
                }
            }
        }
    }
    (found, true)
}

fn between(a: DVec3, b: DVec3, p: DVec3) -> bool {
    (p - a).dot(b - a) > 0.0 && (p - b).dot(a - b) > 0.0
}

/// Whether the segment from `a` to `a + ab` meets a box (Kay and Kajiya's slabs).
fn meets((low, high): Aabb, a: DVec3, ab: DVec3) -> bool {
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
