//! The lines of a face of the cube along which what is seen may change: edges of pieces, and where pieces
//! pass through each other.

use super::NoVerdict;
use super::cube::{CubeFace, clip_polygon, clip_segment, project};
use super::snap::{LARGEST, Point};
use crate::scene::{PieceId, PieceRef, Scene, SupportingPlane};
use crate::verify::integers;
use glam::{DVec2, DVec3};

/// The side of a square of the grid on a face.
pub(super) const PITCH: f64 = 1.0 / LARGEST as f64;

/// How far a rounded coordinate may be off before it is put on the grid.
const PROJECTED: f64 = PITCH / 8.0;

/// The part of a crease's normal that its error may be. Where the crease meets the face, the normal's components
/// along the face are at least sqrt(1/2) of it, so the line is off by less than four times this: an eighth of the pitch.
const GOOD_CREASE: f64 = PITCH / 32.0;

/// A piece as seen from the eye, whose plane does not hold the eye.
struct Facet {
    id: PieceId,
    /// Relative to the eye.
    corners: Vec<DVec3>,
    /// Three points of the plane.
    plane: [DVec3; 3],
    normal: DVec3,
    height: f64,
    /// How far each component of the normal, and the height, may be off.
    normal_error: f64,
    height_error: f64,
}

impl Facet {
    /// `None` for a piece that hides nothing.
    fn new(scene: &Scene, piece: PieceRef<'_>, eye: DVec3) -> Option<Self> {
        let plane = match piece.plane() {
            SupportingPlane::Points(vertices) => vertices.map(|v| scene.vertex(v)),
            SupportingPlane::Axis { axis, value } => {
                let axis = axis as usize;
                let point = DVec3::AXES[axis] * value;
                [point, point + DVec3::AXES[(axis + 1) % 3], point + DVec3::AXES[(axis + 2) % 3]]
            }
        };
        if integers::height_sign(plane, eye).is_zero() {
            return None;
        }
        let points: Vec<DVec3> = piece.points().collect();
        let &first = points.first()?;
        let spans = points.windows(2).map(|pair| [pair[0] - first, pair[1] - first]);
        let [b, c] =
            spans.max_by(|[a, b], [c, d]| a.cross(*b).length_squared().total_cmp(&c.cross(*d).length_squared()))?;
        let (normal, towards) = (b.cross(c), first - eye);
        // A few roundings of each product, with room.
        let normal_error = 4.0 * f64::EPSILON * b.length() * c.length();
        let height_error = (normal_error * 3.0 + normal.length() * 4.0 * f64::EPSILON) * towards.length();
        let height = -normal.dot(towards);
        let corners = points.iter().map(|&p| p - eye).collect();
        Some(Self { id: piece.id(), corners, plane, normal, height, normal_error, height_error })
    }
}

/// The facets of a scene, once for all faces.
pub(super) struct Lines {
    facets: Vec<Facet>,
}

/// A facet as it appears on a face.
struct Seen<'a> {
    facet: &'a Facet,
    outline: Vec<DVec2>,
    low: DVec2,
    high: DVec2,
}

impl Lines {
    pub(super) fn new(scene: &Scene, eye: DVec3) -> Self {
        Self { facets: scene.pieces().filter_map(|piece| Facet::new(scene, piece, eye)).collect() }
    }

    /// The segments on a face, its own four sides included, on the grid.
    pub(super) fn on(&self, face: CubeFace) -> Result<Vec<[Point; 2]>, NoVerdict> {
        let corners = [[-LARGEST, -LARGEST], [LARGEST, -LARGEST], [LARGEST, LARGEST], [-LARGEST, LARGEST]];
        let mut segments: Vec<[Point; 2]> = (0..4).map(|k| [corners[k], corners[(k + 1) % 4]]).collect();
        let mut seen = Vec::new();
        for facet in &self.facets {
            let corners: Vec<DVec3> = facet.corners.iter().map(|&p| face.local(p)).collect();
            for (k, &a) in corners.iter().enumerate() {
                let whole = [a, corners[(k + 1) % corners.len()]];
                let Some(ends) = clip_segment(whole) else { continue };
                // A cut end is off by a few roundings of the numbers it was made of, seen from as far as it is.
                let size = whole[0].abs().max_element().max(whole[1].abs().max_element());
                let error = ends.iter().map(|end| 32.0 * f64::EPSILON * size / end.z).fold(0.0, f64::max);
                if !(error <= PROJECTED || ends == whole && ends.iter().all(|end| end.z.is_normal())) {
                    return Err(NoVerdict::Imprecise { piece: facet.id });
                }
                segments.push(ends.map(|end| on_grid(project(end))));
            }
            let outline: Vec<DVec2> = clip_polygon(&corners).into_iter().map(project).collect();
            let low = outline.iter().copied().fold(DVec2::INFINITY, DVec2::min);
            let high = outline.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
            if !outline.is_empty() {
                seen.push(Seen { facet, outline, low, high });
            }
        }
        for (k, one) in seen.iter().enumerate() {
            for other in &seen[k + 1..] {
                segments.extend(crease(face, one, other)?);
            }
        }
        Ok(segments)
    }
}

fn on_grid(p: DVec2) -> Point {
    [p.x, p.y].map(|x| (x * LARGEST as f64).round() as i64)
}

/// The segment on a face along which two pieces pass through each other, or come close to it.
fn crease(face: CubeFace, one: &Seen<'_>, other: &Seen<'_>) -> Result<Option<[Point; 2]>, NoVerdict> {
    if (one.high.cmplt(other.low) | other.high.cmplt(one.low)).any() {
        return Ok(None);
    }
    let [p, q] = [one.facet, other.facet];
    if let [a, b, ..] = shared(p, q)[..] {
        // If the planes differ, they meet in the line through both.
        return Ok(clip_segment([a, b].map(|p| face.local(p))).map(|ends| ends.map(|end| on_grid(project(end)))));
    }
    let normal = face.local(p.normal * q.height - q.normal * p.height);
    let size = |facet: &Facet| facet.normal.length();
    let error = size(p) * q.height_error
        + size(q) * p.height_error
        + q.height.abs() * (p.normal_error + size(p) * f64::EPSILON)
        + p.height.abs() * (q.normal_error + size(q) * f64::EPSILON);
    // False also for what is not a number.
    let is_good = error <= normal.abs().max_element() * GOOD_CREASE && error.is_normal();
    if !is_good {
        // Coordinates on the face are 1 at most.
        let least = 3.0 * (error + normal.length() * 2.0 * f64::EPSILON);
        let is_one_side = |outline: &[DVec2]| {
            let heights = || outline.iter().map(|p| normal.dot(p.extend(1.0)));
            heights().all(|height| height > least) || heights().all(|height| height < -least)
        };
        let never_cross = is_one_side(&one.outline)
            || is_one_side(&other.outline)
            || are_apart(&one.outline, &other.outline)
            || integers::is_same_plane(p.plane, q.plane);
        return if never_cross {
            Ok(None)
        } else if error.is_normal() {
            Err(NoVerdict::NearlyCoplanar { pieces: [p.id, q.id] })
        } else {
            Err(NoVerdict::Imprecise { piece: p.id })
        };
    }
    let [Some(first), Some(second)] = [stretch(normal, &one.outline), stretch(normal, &other.outline)] else {
        return Ok(None);
    };
    let direction = normal.truncate().perp();
    let later = |a: DVec2, b: DVec2| if direction.dot(a) > direction.dot(b) { a } else { b };
    let sooner = |a: DVec2, b: DVec2| if direction.dot(a) < direction.dot(b) { a } else { b };
    let (from, to) = (later(first[0], second[0]), sooner(first[1], second[1]));
    Ok((direction.dot(from) < direction.dot(to)).then(|| [from, to].map(on_grid)))
}

/// True if two convex polygons overlap by no more than the pitch in the direction across some side, so that only
/// slivers can be in both.
fn are_apart(one: &[DVec2], other: &[DVec2]) -> bool {
    let sides = |polygon: &[DVec2]| -> Vec<DVec2> {
        (0..polygon.len()).map(|k| (polygon[(k + 1) % polygon.len()] - polygon[k]).perp()).collect()
    };
    sides(one).into_iter().chain(sides(other)).filter_map(DVec2::try_normalize).any(|across| {
        let [a, b] = [one, other].map(|polygon| {
            let along = polygon.iter().map(|&p| across.dot(p));
            along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        });
        a[1] <= b[0] + PITCH || b[1] <= a[0] + PITCH
    })
}

/// The corners that two pieces have in common.
fn shared(p: &Facet, q: &Facet) -> Vec<DVec3> {
    p.corners.iter().copied().filter(|corner| q.corners.contains(corner)).collect()
}

/// The stretch of a line, given by `normal . (x, y, 1) = 0`, in a convex polygon.
fn stretch(normal: DVec3, outline: &[DVec2]) -> Option<[DVec2; 2]> {
    let height = |p: DVec2| normal.dot(p.extend(1.0));
    let direction = normal.truncate().perp();
    let mut ends: Option<[DVec2; 2]> = None;
    for (k, &a) in outline.iter().enumerate() {
        let b = outline[(k + 1) % outline.len()];
        let (height_a, height_b) = (height(a), height(b));
        let fall = height_a - height_b;
        if height_a * height_b > 0.0 || fall == 0.0 {
            continue;
        }
        let point = a + (b - a) * (height_a / fall);
        let [from, to] = ends.get_or_insert([point; 2]);
        if direction.dot(point) < direction.dot(*from) {
            *from = point;
        } else if direction.dot(point) > direction.dot(*to) {
            *to = point;
        }
    }
    ends
}
