//! From the rings of a polygon to convex, exactly planar facets.

use super::flat::{
    axes_by_size, collinear, is_convex, newell_normal, orientation, project, spread, triangle_normal, unit_scale,
};
use super::triangulate::{Fault, triangulate};
use super::{Axis, Shape, VertexId};
use crate::exact::orient3d;
use glam::{DVec2, DVec3};

/// What a polygon consists of.
#[derive(Debug)]
pub(super) struct Facets {
    pub(super) shape: Shape,
    /// The boundaries of the facets, each counter-clockwise seen from the polygon's front.
    pub(super) outlines: Vec<Vec<VertexId>>,
    /// Three vertices of the plane of all facets, counter-clockwise seen from the front; `None` if
    /// every facet has its own plane.
    pub(super) plane: Option<[VertexId; 3]>,
}

impl Facets {
    fn none() -> Self {
        Self { shape: Shape::Degenerate, outlines: Vec::new(), plane: None }
    }
}

/// Cuts a polygon into facets. No ring may name one vertex twice in a row.
///
/// Holes without area are left out. A polygon that is not exactly planar is triangulated as it is
/// seen along the axis nearest to its normal; if it overlaps itself there, along its normal.
pub(super) fn facets(rings: &[Vec<VertexId>], vertices: &[DVec3]) -> Result<Facets, Fault> {
    let positions = |ring: &[VertexId]| -> Vec<DVec3> { ring.iter().map(|v| vertices[v.index()]).collect() };
    let Some((outer, holes)) = rings.split_first() else { return Ok(Facets::none()) };
    let outline = positions(outer);
    let Some(corners) = spread(&outline) else { return Ok(Facets::none()) };
    let corners = corners.map(|k| outer[k]);
    let triangle = corners.map(|v| vertices[v.index()]);

    let mut solid = vec![outer.clone()];
    solid.extend(holes.iter().filter(|hole| spread(&positions(hole)).is_some()).cloned());
    let [a, b, c] = triangle;
    let on_plane = |v: &VertexId| corners.contains(v) || orient3d(a, b, c, vertices[v.index()]).is_zero();
    if !solid.iter().flatten().all(on_plane) {
        return warped(&solid, &outline, triangle, vertices);
    }

    // Seen along an axis that is not in the plane, different points stay different.
    let axes = axes_by_size(triangle_normal(triangle));
    let axis = axes.into_iter().find(|&axis| !orientation(triangle, axis).is_zero()).unwrap_or(axes[0]);
    if solid.len() == 1 && is_convex(&outline, axis) {
        return Ok(Facets { shape: Shape::Convex, outlines: vec![outer.clone()], plane: Some(corners) });
    }
    let facets = Local::new(&solid).triangulate(|v| project(vertices[v.index()], axis))?;
    let Some(&[u, v, w]) = facets.first() else { return Ok(Facets::none()) };
    let front = orientation([u, v, w].map(|v| vertices[v.index()]), axis);
    let [a, b, c] = corners;
    let plane = if orientation(triangle, axis) == front { [a, b, c] } else { [a, c, b] };
    Ok(Facets { shape: Shape::Concave, outlines: facets.into_iter().map(Vec::from).collect(), plane: Some(plane) })
}

/// Triangulates a polygon that is not exactly planar.
fn warped(
    rings: &[Vec<VertexId>],
    outline: &[DVec3],
    triangle: [DVec3; 3],
    vertices: &[DVec3],
) -> Result<Facets, Fault> {
    let position = |v: VertexId| vertices[v.index()];
    let (whole, part) = (newell_normal(outline), triangle_normal(triangle));
    // Of a ring that folds back on itself only rounding errors may be left.
    let normal = if whole.length_squared() > 1e-20 * part.length_squared() { whole } else { part };
    let [axis, ..] = axes_by_size(normal);
    let local = Local::new(rings);
    let triangles = match local.triangulate(|v| project(position(v), axis)) {
        Ok(triangles) if !triangles.is_empty() => triangles,
        // The facets of a warped polygon are a matter of choice, so here coordinates may be rounded.
        other => match local.triangulate(oblique(normal, axis, unit_scale(outline.iter().copied()), vertices)) {
            Ok(triangles) if !triangles.is_empty() => triangles,
            _ => other?,
        },
    };
    let outlines: Vec<_> = triangles.into_iter().filter(|t| !collinear(t.map(position))).map(Vec::from).collect();
    if outlines.is_empty() {
        return Ok(Facets::none());
    }
    Ok(Facets { shape: Shape::NonPlanar, outlines, plane: None })
}

/// The (rounded) projection along a normal, for triangulation; `scale` brings the coordinates near 1.
fn oblique(normal: DVec3, axis: Axis, scale: f64, vertices: &[DVec3]) -> impl Fn(VertexId) -> DVec2 {
    let aside = if axis == Axis::X { DVec3::Y } else { DVec3::X };
    let normal = normal.try_normalize().unwrap_or(DVec3::Z);
    let right = normal.cross(aside).try_normalize().unwrap_or(DVec3::X);
    let up = normal.cross(right);
    move |v| {
        let p = vertices[v.index()] * scale;
        // What is next to nothing becomes nothing.
        let clean = |x: f64| if x.abs() < 1e-30 { 0.0 } else { x };
        DVec2::new(clean(p.dot(right)), clean(p.dot(up)))
    }
}

/// The rings of one polygon, on numbers of its own.
struct Local {
    vertices: Vec<VertexId>,
    rings: Vec<Vec<u32>>,
}

impl Local {
    fn new(rings: &[Vec<VertexId>]) -> Self {
        let mut vertices: Vec<VertexId> = rings.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let place = |v: &VertexId| vertices.partition_point(|known| known < v) as u32;
        let rings = rings.iter().map(|ring| ring.iter().map(place).collect()).collect();
        Self { vertices, rings }
    }

    fn triangulate(&self, flatten: impl Fn(VertexId) -> DVec2) -> Result<Vec<[VertexId; 3]>, Fault> {
        let points: Vec<_> = self.vertices.iter().map(|&v| flatten(v)).collect();
        let triangles = triangulate(&points, &self.rings)?;
        Ok(triangles.into_iter().map(|t| t.map(|k| self.vertices[k as usize])).collect())
    }
}
