//! How far from planar a polygon is.

use super::super::PolygonRef;
use super::super::flat::{newell_normal, spread, triangle_normal, unit_scale, unscaled};
use glam::DVec3;

/// Half of the polygon's extent along its area normal (Newell's), in scene units, rounded: the largest distance of a
/// vertex from the plane across that normal that runs midway between the outermost ones.
pub(super) fn deviation(polygon: PolygonRef<'_>) -> f64 {
    let points =
        |ring: &[super::super::VertexId]| -> Vec<DVec3> { ring.iter().map(|&v| polygon.scene.vertex(v)).collect() };
    let Some(outer) = polygon.rings().first().map(|ring| points(ring)) else { return 0.0 };
    let all: Vec<DVec3> = polygon.rings().iter().flat_map(|ring| points(ring)).collect();
    // Of a ring that folds back on itself only rounding errors may be left.
    let part = spread(&outer).map_or(DVec3::ZERO, |corners| triangle_normal(corners.map(|k| outer[k])));
    let whole = newell_normal(&outer);
    let normal = if whole.length_squared() > 1e-20 * part.length_squared() { whole } else { part };
    let normal = normal.normalize_or_zero();
    let scale = unit_scale(all.iter().copied());
    let first = all[0] * scale;
    let heights = || all.iter().map(|&p| (p * scale - first).dot(normal));
    let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
    unscaled((high - low) * 0.5, scale)
}
