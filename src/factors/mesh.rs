//! Meshing convex pieces into elements whose edges have at most a given length.
//!
//! An edge of the scene is divided in the same places whichever piece it is seen from, so that meshes of neighbours fit: there are no
//! T-junctions along shared edges. Quadrilaterals whose opposite sides are divided alike become grids; all else is triangulated (Delaunay, by
//! `spade`) with points of a hexagonal grid inside.

use super::shape::{Frame, sides};
use crate::scene::VertexId;
use glam::{DVec2, DVec3};
use spade::handles::{FixedVertexHandle, UndirectedEdgeHandle};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

/// More elements than this are not made of one piece.
const MOST: f64 = 4e6;
/// A length that is this much longer than a whole number of steps, relatively, is not divided once more: rounding must not tell opposite sides of a
/// rectangle apart.
const SLACK: f64 = 1e-9;

/// Why there is no mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TooFine;

/// The elements of a convex piece, given by its corners with their numbers, counter-clockwise seen from its front; with edges not longer than
/// `longest`, which is positive.
pub(super) fn elements(corners: &[(VertexId, DVec3)], frame: &Frame, longest: f64) -> Result<Vec<Vec<DVec3>>, TooFine> {
    let outline: Vec<Vec<DVec3>> = sides(corners)
        .map(|[(a, p), (b, q)]| {
            // From the vertex with the smaller number, whichever way the piece runs along it.
            let (low, high) = if a < b { (p, q) } else { (q, p) };
            let count = parts(low.distance(high), longest)?;
            let point = |k: usize| if k == 0 { low } else { low.lerp(high, k as f64 / count as f64) };
            let points = 0..count;
            Ok(if a < b {
                points.map(point).collect()
            } else {
                points.map(|k| if k == 0 { high } else { point(count - k) }).collect()
            })
        })
        .collect::<Result<_, TooFine>>()?;
    let size = corners.iter().fold(0.0_f64, |size, (_, p)| size.max(p.distance(corners[0].1)));
    if (size / longest) * (size / longest) > MOST {
        return Err(TooFine);
    }
    match &outline[..] {
        [a, b, c, d] if a.len() == c.len() && b.len() == d.len() => Ok(grid(a, b, c, d)),
        _ => Ok(triangles(&outline.concat(), frame, longest)),
    }
}

/// How many parts an edge has.
fn parts(length: f64, longest: f64) -> Result<usize, TooFine> {
    let count = (length / longest * (1.0 - SLACK)).ceil();
    if count <= MOST { Ok((count as usize).max(1)) } else { Err(TooFine) }
}

/// A grid between four sides, each given without its end (Coons).
fn grid(a: &[DVec3], b: &[DVec3], c: &[DVec3], d: &[DVec3]) -> Vec<Vec<DVec3>> {
    let (columns, rows) = (a.len(), b.len());
    let end = |side: &[DVec3], next: &[DVec3], k: usize| if k == side.len() { next[0] } else { side[k] };
    let point = |i: usize, j: usize| {
        let (low, high) = (end(a, b, i), end(c, d, columns - i));
        let (left, right) = (end(d, a, rows - j), end(b, c, j));
        match (i, j) {
            (_, 0) => low,
            (_, j) if j == rows => high,
            (0, _) => left,
            (i, _) if i == columns => right,
            _ => {
                let (s, t) = (i as f64 / columns as f64, j as f64 / rows as f64);
                let bilinear = a[0].lerp(b[0], s).lerp(d[0].lerp(c[0], s), t);
                low.lerp(high, t) + left.lerp(right, s) - bilinear
            }
        }
    };
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    cells.map(|(i, j)| vec![point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]).collect()
}

/// Triangles between the points of a convex outline.
fn triangles(outline: &[DVec3], frame: &Frame, longest: f64) -> Vec<Vec<DVec3>> {
    let flat: Vec<DVec2> = outline.iter().map(|&p| frame.flat(p)).collect();
    if flat.len() == 3 {
        return vec![outline.to_vec()];
    }
    let mut mesh = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut places = Vec::new();
    let insert =
        |mesh: &mut ConstrainedDelaunayTriangulation<Point2<f64>>, p: DVec2| mesh.insert(Point2::new(p.x, p.y)).ok();
    let ring: Option<Vec<FixedVertexHandle>> = flat.iter().map(|&p| insert(&mut mesh, p)).collect();
    // Coordinates that spade does not take, or corners that fall together: the outline is fanned.
    let Some(ring) = ring.filter(|ring| mesh.num_vertices() == ring.len()) else { return fan(outline) };
    for [a, b] in sides(&ring) {
        if !mesh.try_add_constraint(a, b).is_empty() || mesh.exists_constraint(a, b) {
            continue;
        }
        return fan(outline);
    }
    places.extend_from_slice(outline);
    for p in inner_points(&flat, longest) {
        if insert(&mut mesh, p).is_some() && mesh.num_vertices() > places.len() {
            places.push(frame.lift(p));
        }
    }
    halve_long_edges(&mut mesh, &mut places, frame, longest);
    let inside = |p: Point2<f64>| sides(&flat).all(|[a, b]| super::shape::turn(a, b, DVec2::new(p.x, p.y)) > 0.0);
    // Neither what rounding left between points of one side.
    let faces = mesh.inner_faces().filter(|face| {
        let longest = face.adjacent_edges().map(|edge| edge.length_2()).into_iter().fold(0.0, f64::max);
        face.area() > 1e-9 * longest && inside(face.center())
    });
    faces.map(|face| face.vertices().iter().map(|vertex| places[vertex.index()]).collect()).collect()
}

fn fan(outline: &[DVec3]) -> Vec<Vec<DVec3>> {
    (1..outline.len() - 1).map(|k| vec![outline[0], outline[k], outline[k + 1]]).collect()
}

/// Points of a hexagonal grid inside of a convex outline, at some distance from it.
fn inner_points(flat: &[DVec2], longest: f64) -> Vec<DVec2> {
    let step = 0.9 * longest;
    let (low, high) = flat.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
    let rows = ((high.y - low.y) / (step * 0.866)).floor() as usize;
    let columns = ((high.x - low.x) / step).floor() as usize + 1;
    let all = (1..=rows).flat_map(|row| {
        let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
        (0..=columns).map(move |column| low + DVec2::new((column as f64 + shift) * step, row as f64 * step * 0.866))
    });
    let far = |p: &DVec2| sides(flat).all(|[a, b]| super::shape::turn(a, b, *p) > 0.5 * step * a.distance(b));
    all.filter(far).collect()
}

/// Puts points on the middles of edges that are too long until none is.
fn halve_long_edges(
    mesh: &mut ConstrainedDelaunayTriangulation<Point2<f64>>,
    places: &mut Vec<DVec3>,
    frame: &Frame,
    longest: f64,
) {
    let limit = longest * (1.0 + SLACK);
    // Every round halves the longest edges; a few are enough, and the number is bounded whatever happens.
    for _ in 0..40 {
        // What is on the convex hull and no constraint cuts off points of one side that rounding put inside of it.
        let is_inside =
            |edge: &UndirectedEdgeHandle<'_, _, _, _, _>| !edge.is_constraint_edge() && !edge.is_part_of_convex_hull();
        let long = mesh.undirected_edges().filter(|edge| is_inside(edge) && edge.length_2() > limit * limit);
        let middles: Vec<Point2<f64>> = long.map(|edge| edge.center()).collect();
        if middles.is_empty() || places.len() as f64 > MOST {
            return;
        }
        for middle in middles {
            if mesh.insert(middle).is_ok() && mesh.num_vertices() > places.len() {
                places.push(frame.lift(DVec2::new(middle.x, middle.y)));
            }
        }
    }
}
