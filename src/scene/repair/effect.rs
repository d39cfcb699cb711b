//! What welding did to a polygon.

use super::super::flat::{is_planar, spread};
use super::super::{FaceSpec, PolygonId, Shape};
use super::Repairs;
use glam::DVec3;

/// Notes what moving vertices did to a face, which has the shape given after it. `before` and `after` are the
/// positions of all vertices; those of the face are finite.
pub(in super::super) fn note_welding(
    polygon: PolygonId,
    face: &FaceSpec,
    shape: Shape,
    [before, after]: [&[DVec3]; 2],
    repairs: &mut Repairs,
) {
    if face.rings.iter().flatten().all(|&vertex| before[vertex] == after[vertex]) {
        return;
    }
    if face.rings.iter().any(|ring| steps(ring, after) < steps(ring, before)) {
        repairs.shortened.push(polygon);
    }
    let points = |rings: &[Vec<usize>]| -> Vec<DVec3> { rings.iter().flatten().map(|&v| before[v]).collect() };
    if shape == Shape::Degenerate && spread(&points(&face.rings[..1])).is_some() {
        repairs.collapsed.push(polygon);
    }
    if shape == Shape::NonPlanar && is_planar(&points(&face.rings)) {
        repairs.bent.push(polygon);
    }
}

/// How many sides of a ring have two different ends.
fn steps(ring: &[usize], positions: &[DVec3]) -> usize {
    (0..ring.len()).filter(|&k| positions[ring[k]] != positions[ring[(k + 1) % ring.len()]]).count()
}
