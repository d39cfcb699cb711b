//! The judgement: labels in the middle of triangles, areas over all of them.

use super::cube::{CubeFace, area, clip_polygon, project};
use super::lines::{Lines, PITCH};
use super::snap::{Snapped, snap};
use super::{Agreement, Claim, Disagreement, FaceOpinion, NoVerdict, Outline};
use crate::scene::{PolygonId, Scene};
use crate::verify::{RayAnswer, RayOracle};
use glam::{DVec2, DVec3};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The most crossings on a face: about 20 million rays follow, for that many triangles.
const MOST_CROSSINGS: usize = 1 << 22;

/// How far a line along which something changes may be from the edge of the triangulation that stands for it:
/// sqrt(1/2) of the pitch when its ends are put on the grid, as much again when crossings are, and a
/// quarter for the errors before that.
const MARGIN: f64 = 1.75 * PITCH;

/// The least height of a triangle that is not skipped as a sliver: the points of [`MIDDLES`] are then more than
/// [`MARGIN`] away from every side, so that no line goes between them and what is farther in than the margin.
const LEAST_HEIGHT: f64 = 6.0 * PITCH;

/// The middle of a triangle by its weights, and what stands for it where that lies exactly on a boundary, as it
/// often does on the quadtree of an image.
const MIDDLES: [DVec3; 3] = [DVec3::splat(1.0 / 3.0), DVec3::new(0.31, 0.33, 0.36), DVec3::new(0.34, 0.36, 0.30)];

/// A larger tolerance of areas makes no verdict: a hundred thousandth of the face.
const LARGEST_TOLERANCE: f64 = 4e-5;

/// Compares an image of all directions around an eye with triangulated faces of a cube.
///
/// `outlines` are its cells, `locate` tells what it says of a direction, which is to be taken exactly.
///
/// - *Labels*: in the middle of every triangle, or near it if that lies exactly on a boundary, whose least height is at least 6 pitches, the pitch being 2^-30 of the
///   face's half side, a [`RayOracle`] must see what `locate` says. Both answer for one and the same
///   direction, so there is no tolerance.
/// - *Areas*: the area on the face of every polygon's cells must be that of the triangles in which the ray sees it. Lines along
///   which what is seen changes are at most 1.75 pitches from edges of triangles, so only such a
///   margin of a triangle can show anything else than its middle: the sum of all perimeters times that, and the
///   area of what was skipped, is the tolerance.
///
/// The cost is that of a ray, tried on every piece, for each triangle; and there are about as many triangles
/// as edges of pieces have crossings, hidden edges included: this is for scenes of some hundred polygons.
pub fn second_opinion(
    scene: &Scene,
    eye: DVec3,
    outlines: &[Outline],
    locate: impl Fn(DVec3) -> Claim,
) -> [FaceOpinion; 6] {
    let lines = Lines::new(scene, eye);
    let oracle = RayOracle::new(scene);
    CubeFace::ALL.map(|face| {
        let judge = Judge { face, eye, outlines, locate: &locate, oracle: &oracle };
        match triangles(&lines, face) {
            Ok(triangles) => judge.judge(&triangles),
            Err(reason) => FaceOpinion::NoVerdict(reason),
        }
    })
}

type Triangle = [DVec2; 3];

fn triangles(lines: &Lines, face: CubeFace) -> Result<Vec<Triangle>, NoVerdict> {
    let segments = lines.on(face)?;
    let Some(Snapped { points, edges }) = snap(segments, MOST_CROSSINGS) else {
        return Err(NoVerdict::TooManyCrossings { limit: MOST_CROSSINGS });
    };
    let points: Vec<Point2<f64>> =
        points.iter().map(|&[x, y]| Point2::new(x as f64 * PITCH, y as f64 * PITCH)).collect();
    let count = points.len();
    let triangulate = || {
        let mut refused = 0;
        let made = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(points, edges, |_| refused += 1);
        (made, refused)
    };
    let Ok((made, refused)) = catch_unwind(AssertUnwindSafe(triangulate)) else { return Err(NoVerdict::Panicked) };
    let Ok(made) = made else { return Err(NoVerdict::Refused { count: 1 }) };
    let refused = refused + (count - made.num_vertices());
    if refused > 0 {
        return Err(NoVerdict::Refused { count: refused });
    }
    let corners = |triangle: [Point2<f64>; 3]| triangle.map(|p| DVec2::new(p.x, p.y));
    Ok(made.inner_faces().map(|triangle| corners(triangle.positions())).collect())
}

struct Judge<'a, F> {
    face: CubeFace,
    eye: DVec3,
    outlines: &'a [Outline],
    locate: &'a F,
    oracle: &'a RayOracle,
}

impl<F: Fn(DVec3) -> Claim> Judge<'_, F> {
    fn judge(&self, triangles: &[Triangle]) -> FaceOpinion {
        let mut areas: BTreeMap<Option<PolygonId>, [f64; 2]> = BTreeMap::new();
        let mut solid_angles = BTreeMap::new();
        let (mut judged, mut skipped, mut tolerance) = (0, 0, 0.0);
        for triangle in triangles {
            let size = area(triangle);
            let sides = [0, 1, 2].map(|k| triangle[k].distance(triangle[(k + 1) % 3]));
            let longest = sides.into_iter().fold(0.0, f64::max);
            let label = if 2.0 * size < LEAST_HEIGHT * longest { Ok(Claim::Boundary) } else { self.label(triangle) };
            match label {
                Ok(Claim::Shows(polygon)) => {
                    judged += 1;
                    tolerance += sides.iter().sum::<f64>() * MARGIN;
                    areas.entry(polygon).or_default()[0] += size;
                    *solid_angles.entry(polygon).or_default() += solid_angle(triangle);
                }
                Ok(Claim::Boundary | Claim::Outside) => {
                    skipped += 1;
                    tolerance += size;
                }
                Err(disagreement) => return FaceOpinion::Disagreement(disagreement),
            }
        }
        let is_telling = tolerance <= LARGEST_TOLERANCE;
        if !is_telling {
            return FaceOpinion::NoVerdict(NoVerdict::TooVague { tolerance });
        }
        for outline in self.outlines {
            let corners: Vec<DVec3> = outline.corners.iter().map(|&d| self.face.local(d)).collect();
            let clipped: Vec<DVec2> = clip_polygon(&corners).into_iter().filter(|d| d.z > 0.0).map(project).collect();
            let size = area(&clipped);
            if size > 0.0 {
                areas.entry(outline.polygon).or_default()[1] += size;
            }
        }
        let mut difference: f64 = 0.0;
        for (polygon, [triangles, cells]) in areas {
            let here = (triangles - cells).abs();
            difference = difference.max(here);
            let is_excused = here <= tolerance;
            if !is_excused {
                return FaceOpinion::Disagreement(Disagreement::Area { polygon, triangles, cells, tolerance });
            }
        }
        FaceOpinion::Agreement(Agreement { triangles: judged, skipped, difference, tolerance, solid_angles })
    }

    /// What is seen in the middle of a triangle.
    fn label(&self, triangle: &Triangle) -> Result<Claim, Disagreement> {
        for weights in MIDDLES {
            let middle = triangle[0] * weights.x + triangle[1] * weights.y + triangle[2] * weights.z;
            let direction = self.face.direction(middle);
            let claim = (self.locate)(direction);
            let ray = self.oracle.cast(self.eye, direction);
            let expected = match ray {
                RayAnswer::Hit { polygon, .. } => Some(polygon),
                RayAnswer::Miss => None,
                RayAnswer::Boundary => continue,
            };
            match claim {
                Claim::Boundary => {}
                Claim::Shows(polygon) if polygon == expected => return Ok(claim),
                Claim::Shows(_) | Claim::Outside => return Err(Disagreement::Label { direction, ray, claim }),
            }
        }
        Ok(Claim::Boundary)
    }
}

/// The solid angle of a triangle of the face (A. van Oosterom and J. Strackee, "The solid angle of a plane
/// triangle", 1983).
fn solid_angle(triangle: &Triangle) -> f64 {
    let [a, b, c] = triangle.map(|p| p.extend(1.0));
    let [la, lb, lc] = [a.length(), b.length(), c.length()];
    // det[a, b, c] is twice the area.
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * (2.0 * area(triangle)).atan2(below)
}
