//! Which polygons meet in which edges, and which way they run there.

use super::super::flat::newell_normal;
use super::super::{PolygonId, PolygonRef, Scene, VertexId};
use glam::DVec3;

/// One pass of a polygon's boundary along an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Use {
    /// The edge, with the smaller vertex first.
    pub(super) edge: [VertexId; 2],
    pub(super) polygon: PolygonId,
    /// True if it runs from the larger vertex to the smaller one, with the polygon on its left as seen from the front.
    pub(super) against: bool,
}

/// All passes along edges of the polygons with area, by edge; n log n.
pub(super) fn uses(scene: &Scene) -> Vec<Use> {
    let mut uses = Vec::new();
    for polygon in scene.polygons().filter(|polygon| polygon.pieces().len() > 0) {
        for (ring, reversed) in oriented_rings(polygon) {
            for (&a, &b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                uses.push(Use { edge: [a.min(b), a.max(b)], polygon: polygon.id(), against: (a > b) != reversed });
            }
        }
    }
    uses.sort_unstable();
    uses
}

/// The rings of a polygon, and whether they run the wrong way: holes may run either way in a scene, but
/// the edges of a surface must have it on their left.
pub(super) fn oriented_rings(polygon: PolygonRef<'_>) -> impl Iterator<Item = (&[VertexId], bool)> {
    let rings = polygon.rings();
    let mut sides = Vec::new();
    if rings.len() > 1 {
        for piece in polygon.pieces() {
            let ring = piece.vertices();
            sides.extend(ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b]));
        }
        sides.sort_unstable();
    }
    rings.iter().enumerate().map(move |(k, ring)| {
        let is_hole = k > 0;
        (&ring[..], is_hole && runs_backwards(polygon, ring, &sides))
    })
}

/// Whether the sides of the pieces run along a hole the other way. `sides` is sorted.
fn runs_backwards(polygon: PolygonRef<'_>, hole: &[VertexId], sides: &[[VertexId; 2]]) -> bool {
    let count = |there: bool| {
        let pairs = hole.iter().zip(hole.iter().cycle().skip(1));
        let pairs = pairs.map(|(&a, &b)| if there { [a, b] } else { [b, a] });
        pairs.filter(|side| sides.binary_search(side).is_ok()).count()
    };
    let (there, back) = (count(true), count(false));
    if there != back {
        return back > there;
    }
    // Every edge runs through a vertex, or is a slit.
    let area = |ring: &[VertexId]| {
        newell_normal(&ring.iter().map(|&v| polygon.scene.vertex(v)).collect::<Vec<DVec3>>()).normalize_or_zero()
    };
    area(&polygon.rings()[0]).dot(area(hole)) > 0.0
}
