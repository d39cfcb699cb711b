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

    /// What is left of a polygon that is dropped.
    pub(super) fn dropped() -> Self {
        Self { shape: Shape::Dropped, ..Self::none() }
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
        let outlines = cut_convex(outer, |corner| !orientation(corner.map(|v| vertices[v.index()]), axis).is_zero());
        return Ok(Facets { shape: Shape::Convex, outlines, plane: Some(corners) });
    }
    let facets = Local::new(&solid).triangulate(|v| project(vertices[v.index()], axis))?;
    let Some(&[u, v, w]) = facets.first() else { return Ok(Facets::none()) };
    let front = orientation([u, v, w].map(|v| vertices[v.index()]), axis);
    let [a, b, c] = corners;
    let plane = if orientation(triangle, axis) == front { [a, b, c] } else { [a, c, b] };
    Ok(Facets { shape: Shape::Concave, outlines: facets.into_iter().map(Vec::from).collect(), plane: Some(plane) })
}

/// A convex polygon with more vertices than this is cut: a view would take time in the square of their
/// number, for a convex piece is put into the contour tree side by side.
const MOST_CORNERS: usize = 64;

/// Cuts a weakly convex ring by diagonals into weakly convex rings with area of at most [`MOST_CORNERS`]
/// vertices, by halving it as often as it takes: n log n. `turns` tells three consecutive vertices that make
/// a turn from three on a line.
fn cut_convex(ring: &[VertexId], turns: impl Fn([VertexId; 3]) -> bool) -> Vec<Vec<VertexId>> {
    let n = ring.len();
    if n <= MOST_CORNERS {
        return vec![ring.to_vec()];
    }
    let turns = |k: usize| turns([ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]]);
    let mut whole = vec![(0..n).map(|k| (ring[k], turns(k))).collect::<Vec<_>>()];
    let mut parts = Vec::new();
    while let Some(mut ring) = whole.pop() {
        if ring.len() <= MOST_CORNERS {
            parts.push(ring.into_iter().map(|(v, _)| v).collect());
            continue;
        }
        let start = middle_of_longest_run(&ring);
        ring.rotate_left(start);
        let half = ring.len() / 2;
        let mut rest = ring[half..].to_vec();
        rest.push(ring[0]);
        ring.truncate(half + 1);
        for part in [&mut rest, &mut ring] {
            debug_assert!(part[1..part.len() - 1].iter().any(|corner| corner.1), "a part without area");
            // Between a diagonal and a side there is always a turn.
            part[0].1 = true;
            if let Some(last) = part.last_mut() {
                last.1 = true;
            }
        }
        whole.extend([rest, ring]);
    }
    parts
}

/// Where to halve a ring with at least three turns so that no half is a line: there is a turn strictly
/// between the ends of both halves.
///
/// In the middle of the longest straight run: at least one more turn is on the other side, so the
/// run is shorter than the ring, and from its middle both its ends are nearer than half the way around. Without such a run every vertex is
/// a turn, and any will do.
fn middle_of_longest_run(ring: &[(VertexId, bool)]) -> usize {
    let n = ring.len();
    let corners: Vec<usize> = (0..n).filter(|&k| ring[k].1).collect();
    let steps = |k: usize| (corners[(k + 1) % corners.len()] + n - corners[k]) % n;
    match (0..corners.len()).max_by_key(|&k| (steps(k), std::cmp::Reverse(k))) {
        Some(k) if steps(k) > 1 => (corners[k] + steps(k).div_ceil(2)) % n,
        _ => 0,
    }
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
